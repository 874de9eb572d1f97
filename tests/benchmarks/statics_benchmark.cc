// Cost of the equilibrium of a whole stage: a plane one over all its planet errors, and a helical one of solid gears
// that tilt. From nothing, and under another load, for which the meshes are there.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "app/model/reuse.h"
#include "app/scene/overrides.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/statics.h"
#include "benchmarks/stopwatch.h"
#include "core/errors.h"
#include "core/log.h"

namespace {

using namespace annulus;
using benchmarks::Stopwatch;

struct Case {
  std::string name;
  std::filesystem::path scene;
  std::vector<std::string> settings;
  std::string other_load;  ///< one more setting, which leaves the meshes as they are
};

struct Solved {
  double wall = 0, cpu = 0;  // s
  std::size_t positions = 0;
  double worst_residual = 0;
};

Solved solve(const Case& c, bool other_load, const app::RunOptions& options) {
  auto settings = c.settings;
  if (other_load) settings.push_back(c.other_load);
  auto scene = app::read_scene_with(c.scene, settings);
  planetary(scene).rings.resize(1);  // the others are no part of it
  const Stopwatch watch;
  const auto statics = app::solve_statics(scene, app::make_geometry(scene), app::with_reuse(options));
  Solved solved{watch.wall(), watch.cpu()};
  for (const auto& ring : statics.rings) {
    solved.positions += ring.turn.positions.size();
    solved.worst_residual = std::max(solved.worst_residual, ring.worst_residual);
  }
  return solved;
}

/// From nothing, and again under another load: the meshes are there, the equilibrium is new.
void measure(const Case& c, const std::filesystem::path& out, int threads) {
  app::RunOptions options;
  options.out = out / c.name;
  options.threads = threads;
  std::filesystem::remove_all(options.out);
  const auto first = solve(c, false, options), again = solve(c, true, options);
  fmt::print(
      "{}: {} positions of the stage; with its meshes {:.1f} s (processor {:.1f} s), under another load {:.1f} s "
      "(processor {:.1f} s, {:.1f} ms a position); the meshes cost {:.1f} times as much\n",
      c.name, again.positions, first.wall, first.cpu, again.wall, again.cpu,
      1e3 * again.cpu / static_cast<double>(again.positions), (first.cpu - again.cpu) / again.cpu);
  constexpr double allowed = 1e-9;
  for (const auto& solved : {first, again})
    if (!(solved.worst_residual <= allowed))
      throw SolverError(fmt::format("{}: {:.2g} of the forces are left over in a position, more than {:.0e}", c.name,
                                    solved.worst_residual, allowed));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App cli("Cost of the equilibrium of whole planetary stages");
  std::filesystem::path data = "data", out = "statics_benchmark";
  int threads = 2;
  double accuracy = 0.05;
  cli.add_option("--data", data, "Folder of the shipped scenes");
  cli.add_option("-o,--out", out, "Where the stages are computed");
  cli.add_option("--threads", threads, "Threads");
  cli.add_option("--accuracy", accuracy, "Of the helical stage");
  CLI11_PARSE(cli, argc, argv);
  try {
    log::set_level(log::Level::quiet);
    // 64 positions of every mesh cycle until the 55 teeth of the eccentric planets meet the same ones again.
    measure({"plane",
             data / "scenes" / "ring_types.toml",
             {"supports.sun_N_per_m=1e8", "statics.carrier_positions=55", "statics.mesh_phases=64"},
             "errors.planet_pin_position_error_um=[0, 32, 13, 34, 15]"},
            out, threads);
    measure({"tilting",
             data / "cases" / "grc_750kw" / "in_space.toml",
             {fmt::format("accuracy={}", accuracy), "load.moment_Nm=[0, 300e3, 0]"},
             "load.moment_Nm=[0, 250e3, 0]"},
            out, threads);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
