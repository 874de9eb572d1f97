// What a user waits for, by two versions of the program: processor time, wall time and memory of whole commands.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/files.h"

namespace annulus::benchmarks {
namespace {

namespace fs = std::filesystem;

/// A version of the program with the scenes written for it.
struct Version {
  std::string name;
  fs::path program, scenes;
};

struct Cost {
  double cpu = 0, wall = 0, memory_MB = 0;
};

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

/// One command in its own process, in a folder. Throws Error when it fails.
Cost run(const Version& version, const std::vector<std::string>& arguments, const fs::path& folder) {
  const auto begin = std::chrono::steady_clock::now();
  const pid_t process = ::fork();
  if (process == 0) {
    ::setenv("ANNULUS_CACHE", "", 1);  // nothing is taken from earlier runs
    std::vector<char*> words = {const_cast<char*>(version.program.c_str())};
    for (const auto& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
    words.push_back(nullptr);
    if (::chdir(folder.c_str()) == 0 && std::freopen("printed.txt", "w", stdout) != nullptr)
      ::execv(version.program.c_str(), words.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  ::wait4(process, &status, 0, &usage);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(fmt::format("{}: annulus {} ended with {}", version.name, fmt::join(arguments, " "), status));
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime),
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          static_cast<double>(usage.ru_maxrss) * 1024e-6};
}

/// The three rings of the version with one of them alone, without samples.
std::string with_ring(const Version& version, const std::string& ring) {
  const auto text = read_file(version.scenes / "ring_types.toml");
  std::string kept;
  for (std::size_t from = 0; from < text.size();) {
    const auto to = std::min(text.find("\n[", from), text.size() - 1) + 1;
    const auto table = text.substr(from, to - from);
    const bool other_ring = table.starts_with("[[ring]]") && table.find("name = \"" + ring + "\"") == std::string::npos;
    // Reasons of assumed inputs name keys of the other rings.
    if (!other_ring && !table.starts_with("[monte_carlo]") && !table.starts_with("[assumed]")) kept += table;
    from = to;
  }
  return kept;
}

struct Work {
  std::string name, goal;
  std::function<std::string(const Version&)> scene;
  std::vector<std::string> before, measured;  ///< commands; `before` is not measured
  int repeats = 1;                            ///< of short ones: the least counts
};

std::vector<Work> works() {
  const auto shipped = [](const std::string& name) {
    return [name](const Version& v) { return read_file(v.scenes / (name + ".toml")); };
  };
  // The key that chooses the model was called otherwise in the first versions.
  const auto thin_walled_solid = [](const Version& v) {
    const bool first = read_file(v.scenes / "tip_relief_optimisation.toml").find("\nrung ") != std::string::npos;
    return fmt::format("{} = \"solid\"\n", first ? "rung" : "model") + with_ring(v, "thin-walled");
  };
  const auto helical = [](const Version&) {
    return "accuracy = 0.01\n" + read_file(fs::path(ANNULUS_SOURCE_DIR) / "tests/benchmarks/waiting/helical.toml");
  };
  const auto pinned = [](const Version& v) { return with_ring(v, "pinned"); };
  const std::vector<std::string> everything = {"run", "scene.toml", "-q", "-o", "out"};
  const std::vector<std::string> tables = {"solve", "scene.toml", "-q", "-o", "out"};
  return {
      {"version", "1/10", shipped("ring_types"), {}, {"--version"}, 5},
      {"check", "1/10", shipped("ring_types"), {}, {"check", "scene.toml"}, 5},
      {"plan", "1/10", shipped("ring_types"), {}, {"plan", "scene.toml"}, 5},
      {"ring_types", "1/4", shipped("ring_types"), {}, everything},
      {"helical_solid_stage", "1/5, 0.7 GB", helical, {}, everything},
      {"pinned_dynamics", "1/10", pinned, tables, {"dynamics", "scene.toml", "-q", "-o", "out"}},
      {"thin_walled_solid", "1/4", thin_walled_solid, {}, tables},
      {"tip_relief_optimisation", "1/5", shipped("tip_relief_optimisation"), {}, everything},
      {"ring_types_uncertainty", "1/10", shipped("ring_types_uncertainty"), {}, everything},
  };
}

Cost measure(const Work& work, const Version& version, const fs::path& folder) {
  Cost least;
  for (int i = 0; i < work.repeats; ++i) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    const fs::path reference = version.scenes / "reference";
    if (fs::exists(reference)) fs::copy(reference, folder / "reference", fs::copy_options::recursive);
    write_file(folder / "scene.toml", work.scene(version));
    if (!work.before.empty()) run(version, work.before, folder);
    const auto cost = run(version, work.measured, folder);
    least = i == 0 ? cost
                   : Cost{std::min(least.cpu, cost.cpu), std::min(least.wall, cost.wall),
                          std::min(least.memory_MB, cost.memory_MB)};
  }
  return least;
}

void compare(const Version& earlier, const Version& later, const std::vector<std::string>& names,
             const fs::path& folder) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // forked processes have nothing to repeat
  fmt::print("{:<26}{:>12}{:>12}{:>8}{:>9}{:>9}{:>10}{:>10}{:>14}\n", "work", "earlier, s", "later, s", "ratio",
             "wall, s", "wall, s", "MB", "MB", "goal");
  for (const auto& work : works()) {
    if (!names.empty() && std::find(names.begin(), names.end(), work.name) == names.end()) continue;
    const auto a = measure(work, earlier, folder / "earlier" / work.name);
    const auto b = measure(work, later, folder / "later" / work.name);
    fmt::print("{:<26}{:>12.2f}{:>12.2f}{:>8}{:>9.2f}{:>9.2f}{:>10.0f}{:>10.0f}{:>14}\n", work.name, a.cpu, b.cpu,
               fmt::format("1/{:.1f}", a.cpu / b.cpu), a.wall, b.wall, a.memory_MB, b.memory_MB, work.goal);
  }
}

}  // namespace
}  // namespace annulus::benchmarks

int main(int argc, char** argv) {
  using namespace annulus::benchmarks;
  std::vector<std::string> earlier, later, names;
  std::string folder = (std::filesystem::temp_directory_path() / "annulus_waiting").string();
  CLI::App app("Processor time, wall time and memory of whole commands by two versions of the program.");
  app.add_option("--earlier", earlier, "Program and folder of its scenes")->expected(2);
  app.add_option("--later", later, "Program and folder of its scenes")->expected(2)->required();
  app.add_option("--works", names, "Names of works; default all");
  app.add_option("--folder", folder, "Where to work; default a temporary one");
  CLI11_PARSE(app, argc, argv);
  if (earlier.empty()) {
    fmt::print("no earlier version to compare with (--earlier): scripts/compare_versions.sh builds one\n");
    return 77;
  }
  try {
    const auto version = [](const char* name, const std::vector<std::string>& paths) {
      return Version{name, std::filesystem::absolute(paths[0]), std::filesystem::absolute(paths[1])};
    };
    compare(version("earlier", earlier), version("later", later), names, folder);
  } catch (const std::exception& e) {
    fmt::print(stderr, "waiting_benchmark: {}\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
