// Cost of the answers users wait for on the helical pair, the 2K-H and the 2K-V reducer: the errors of a pair, a grid
// of torque and speed, a search over designs, modes over the crank angle.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "benchmarks/stopwatch.h"
#include "core/units.h"
#include "dynamics/pairs.h"
#include "dynamics/stages.h"
#include "dynamics/systems/helical_pair/manufacturing_error.h"
#include "dynamics/systems/helical_pair/pair_response.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/systems/planetary/study_point.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "dynamics/two_k_v_stages.h"

namespace {

using namespace annulus;
using namespace annulus::dynamics;
using annulus::benchmarks::Stopwatch;

struct Options {
  int samples = 10'000;    ///< of manufacturing errors
  int grid = 20;           ///< torques, and speeds
  int evaluations = 1000;  ///< of the objective
};

void errors(int samples) {
  ErrorProblem problem{.gears = {{{21, 48.927e-6, 12.927e-6}, {37, 48.927e-6, 12.927e-6}}}};
  problem.samples = samples;
  const Stopwatch watch;
  const auto result = manufacturing_error(problem);
  const double time = watch.cpu();
  fmt::print("{} samples of manufacturing errors, all readings: {:.1f} ms; envelope at 95 %: {:.3f} um, exact {:.3f}\n",
             samples, 1e3 * time, result.amplitude().sample.value / units::um, result.amplitude().exact / units::um);
}

/// Torques and speeds of the paper's figures; one of the points by time integration for comparison.
void pair_grid(int points) {
  SimulationOptions direct;
  direct.confirmation = Confirmation::where_needed;
  direct.keep_series = direct.estimate_error = false;
  SimulationOptions integrated = direct;
  integrated.steady_state = SteadyState::time_integration;
  for (const double half_backlash : {0.0, 100e-6}) {
    auto pair = pairs::error_paper();
    pair.half_backlash.reset();
    if (half_backlash > 0) pair.half_backlash = half_backlash;
    double time = 0, compared = 0, integrated_s = 0;
    int parted = 0;
    for (int i = 0; i < points * points; ++i) {
      pair.pinion_torque = 1000.0 * (1 + i % points);
      pair.pinion_speed = 200 * units::rpm * (1 + i / points);
      const Stopwatch watch;
      const auto response = evaluate_pair(pair, direct);
      const double once = watch.cpu();
      time += once;
      parted += response.contact_loss.value > 0;
      if (i % (points * points / 8 + 1) != 0) continue;
      const Stopwatch integration;
      (void)evaluate_pair(pair, integrated);
      integrated_s += integration.cpu();
      compared += once;
    }
    fmt::print(
        "{0} x {0} torques and speeds, half backlash {1:.0f} um: {2:.2f} s, loss of contact at {3} points; time "
        "integration "
        "costs {4:.0f} times as much\n",
        points, half_backlash / units::um, time, parted, integrated_s / compared);
  }
}

/// The objective of the backlash search. At the paper's load contact is not lost; above 5000 r/min it is.
void reducer_search(int evaluations) {
  SimulationOptions integrated;
  integrated.steady_state = SteadyState::time_integration;
  integrated.estimate_error = integrated.keep_series = false;
  for (const double rpm : {1500.0, 5200.0}) {
    auto stage = stages::backlash_paper();
    stage.carrier_speed *= rpm / 1500;
    PointOptions point;
    point.motion = false;
    int count = rpm > 2000 ? std::max(1, evaluations / 20) : evaluations, parted = 0;
    const Stopwatch watch;
    for (int i = 0; i < count; ++i) {
      stage.set_half_backlash(10e-6 * std::pow(100.0, static_cast<double>(i) / count));
      const auto figures = evaluate_point(stage, point).figures;
      parted += std::max(figures.value("sun_planet_contact_loss"), figures.value("ring_planet_contact_loss")) > 0;
    }
    const double each = watch.cpu() / count;
    const Stopwatch integration;
    (void)simulate(stage, integrated);
    fmt::print(
        "objective of the backlash search at {:.0f} r/min: {:.2f} ms, {} evaluations {:.1f} s, loss of contact in {} "
        "of "
        "{}; time integration costs {:.0f} times as much\n",
        rpm, 1e3 * each, evaluations, each * evaluations, parted, count, integration.cpu() / each);
  }
}

void crank_modes() {
  constexpr int angles = 1000;
  auto stage = stages::reducer();
  double first = 0;
  const Stopwatch watch;
  for (int i = 0; i < angles; ++i) {
    stage.crank_angle = 2 * std::numbers::pi * i / angles;
    first = modes(stage).modes.front().frequency;
  }
  fmt::print("modes of the 2K-V reducer: {:.3f} ms per crank angle, first {:.2f} Hz\n", 1e3 * watch.cpu() / angles,
             first);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Cost of the answers on the helical pair and the two reducers");
  app.add_option("--samples", options.samples, "Samples of manufacturing errors")->capture_default_str();
  app.add_option("--grid", options.grid, "Torques, and speeds")->capture_default_str();
  app.add_option("--evaluations", options.evaluations, "Evaluations of the objective")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    errors(options.samples);
    pair_grid(options.grid);
    reducer_search(options.evaluations);
    crank_modes();
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
