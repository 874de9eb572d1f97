#pragma once

#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <string>

namespace annulus::benchmarks {

/// Wall time and processor time, of this process and of the finished children it has waited for. On a machine that is
/// busy with other things the ratio of processor times is the one to trust.
class Stopwatch {
 public:
  [[nodiscard]] double wall() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }
  [[nodiscard]] double cpu() const { return cpu_now() - cpu_; }

 private:
  static double cpu_now() {
    double sum = 0;
    for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
      rusage usage{};
      getrusage(who, &usage);
      for (const timeval& t : {usage.ru_utime, usage.ru_stime})
        sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    }
    return sum;
  }
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = cpu_now();
};

/// Peak resident memory of this program since it was started, MB (10^6 bytes); unlike getrusage() without what its
/// parent had before.
inline double peak_resident_MB() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kibibytes = 0;
  while (status >> word)
    if (word == "VmHWM:") status >> kibibytes;
  return kibibytes * 1024e-6;
}

}  // namespace annulus::benchmarks
