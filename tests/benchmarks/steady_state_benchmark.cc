// Cost of the answers users wait for, on the ring paper's stage with tabulated stiffness: time integration, the direct
// steady state, samples over error phases.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "benchmarks/stopwatch.h"
#include "dynamics/stages.h"
#include "dynamics/statistics/sampling.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/systems/planetary/study_point.h"
#include "dynamics/tables.h"

namespace {

using namespace annulus::dynamics;
using annulus::benchmarks::Stopwatch;

struct Options {
  int cycles = 200;   ///< mesh cycles integrated
  int samples = 100;  ///< over the error phases
};

constexpr double wanted = 1e-3;  // accuracy of the load sharing coefficient

/// The stage with tables in the shape of its harmonic stiffness that stiffen with the load.
PlanetaryStage tabulated_stage() {
  PlanetaryStage stage = stages::ring_paper();
  const double force = stage.mean_mesh_force();
  for (auto* mesh : {&stage.sun_mesh, &stage.ring_mesh}) {
    const auto wave = std::get<HarmonicStiffness>(*mesh);
    const tables::BentTable table{.mesh = mesh == &stage.sun_mesh ? "sun_planet" : "ring_planet",
                                  .mean = wave.mean,
                                  .ripple = wave.ripple,
                                  .bend = 0.05,  // line contact
                                  .nominal = force,
                                  .shares = {0.25, 0.5, 1, 1.5, 2},
                                  .phases = 32};
    *mesh = table_stiffness(table.table(), force, 0, LoadDependence::table);
  }
  return stage;
}

DynamicResponse directly(const PlanetaryStage& stage, int samples_per_cycle) {
  SimulationOptions options;
  options.confirmation = Confirmation::never;
  options.keep_series = false;
  options.samples_per_cycle = samples_per_cycle;
  return simulate(stage, options);
}

int measure(const Options& options) {
  const PlanetaryStage stage = tabulated_stage();
  {
    SimulationOptions integrated;
    integrated.mesh_cycles = options.cycles;
    integrated.estimate_error = false;
    integrated.keep_series = false;
    const Stopwatch watch;
    (void)simulate(stage, integrated);
    fmt::print("{} mesh cycles integrated, relative tolerance 1e-6, figures included: {:.3f} s\n", options.cycles,
               watch.cpu());
  }
  const double exact = directly(stage, 128).sun_planet.load_sharing.averaged.value;
  double error = 0;
  for (const int samples : {8, 16, 32, 64}) {
    const Stopwatch watch;
    const auto response = directly(stage, samples);
    const auto& sharing = response.sun_planet.load_sharing.averaged;
    if (samples == 8) error = std::abs(sharing.value - exact);
    fmt::print("steady state directly, {:2d} samples per cycle: load sharing {:.5f}, error {:.1e}, {:.1f} ms\n",
               samples, sharing.value, std::abs(sharing.value - exact), 1e3 * watch.cpu());
  }
  const Stopwatch watch;
  for (int i = 0; i < options.samples; ++i) {
    PlanetaryStage sample = stage;
    for (int n = 0; n < sample.planets(); ++n) {
      const auto draw = [&](const char* what) {
        return 2 * std::numbers::pi * uniform_draw(1, static_cast<std::uint64_t>(i), fmt::format("{} {}", what, n));
      };
      sample.planet_errors[n].eccentricity.phase = draw("eccentricity");
      sample.planet_errors[n].position.phase = draw("installation");
    }
    PointOptions point;
    point.motion = false;
    (void)evaluate_point(sample, point);
  }
  fmt::print("samples over error phases: {:.1f} ms each, a thousand on two cores in {:.0f} s\n",
             1e3 * watch.cpu() / options.samples, 1e3 * watch.cpu() / options.samples / 2);
  if (error > wanted) {
    fmt::print(stderr, "load sharing with 8 samples per cycle is off by {:.1e}\n", error);
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Cost of the dynamics of the ring paper's stage");
  app.add_option("--cycles", options.cycles, "Mesh cycles integrated")->capture_default_str();
  app.add_option("--samples", options.samples, "Samples over the error phases")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return measure(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
