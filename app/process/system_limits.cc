#include "app/process/system_limits.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <vector>

#include "core/errors.h"

namespace annulus::app {

namespace {

constexpr double bytes_per_MB = 1e6;

/// Bytes; infinite without a limit.
double address_space_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

bool can_map(std::size_t bytes) {
  void* trial = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial == MAP_FAILED) return false;
  ::munmap(trial, bytes);
  return true;
}

}  // namespace

double free_address_space_MB() {
  const double limit = address_space_limit();
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return std::max(0.0, limit - pages * static_cast<double>(::sysconf(_SC_PAGESIZE))) / bytes_per_MB;
}

void ensure_stack() {
  constexpr rlim_t needed = 2U << 20U, usual = 8U << 20U;  // bytes; 1 MiB was always enough
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= usual) return;  // RLIM_INFINITY is the largest
  limit.rlim_cur = std::min(limit.rlim_max, usual);
  ::setrlimit(RLIMIT_STACK, &limit);
  if (limit.rlim_cur < needed)
    throw SolverError(
        fmt::format("refused: the limit of the stack is {} kB, computing needs {}; raise it (ulimit -s {})",
                    limit.rlim_cur / 1024, needed / 1024, usual / 1024));
  // That of new threads was fixed when the program started.
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, limit.rlim_cur);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

void reserve_blas_memory(int threads) {
  if (address_space_limit() == std::numeric_limits<double>::infinity()) return;
  // Resolved at run time: of another BLAS there is nothing to fear.
  using Allocate = void* (*)(int);
  using Free = void (*)(void*);
  auto* allocate = reinterpret_cast<Allocate>(::dlsym(RTLD_DEFAULT, "blas_memory_alloc"));
  auto* release = reinterpret_cast<Free>(::dlsym(RTLD_DEFAULT, "blas_memory_free"));
  if (allocate == nullptr || release == nullptr) return;
  constexpr std::size_t buffer = 136'000'000;  // bytes: 128 MiB and what surrounds them
  const auto count = static_cast<std::size_t>(threads);
  if (!can_map(count * buffer))
    throw SolverError(
        fmt::format("refused: {:.0f} MB of address space are left, and linear algebra on {} thread{} needs {:.0f} MB; "
                    "raise its limit "
                    "(ulimit -v){}",
                    free_address_space_MB(), threads, threads == 1 ? "" : "s",
                    static_cast<double>(count * buffer) / bytes_per_MB, threads == 1 ? "" : " or use fewer --threads"));
  // All at once, so that they are different ones; they stay mapped.
  std::vector<void*> buffers(count);
  for (auto& b : buffers) b = allocate(1);
  for (auto* b : buffers) release(b);
}

}  // namespace annulus::app
