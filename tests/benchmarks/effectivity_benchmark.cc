// How the error estimates of the stiffness tables compare with the errors against a much finer solution.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "benchmarks/stopwatch.h"
#include "fem/loaded_mesh.h"
#include "fem/ring_paper.h"
#include "fem/ring_paper_problems.h"

namespace {

using namespace annulus;

constexpr double load = 59460, face_width = 88e-3, bore = 86e-3, outside = 331.8e-3;  // N, m: ring paper
/// Smaller errors are of the size of the reference's own: nothing can be said about them.
constexpr double smallest_error = 1e-4;
constexpr double least_effectivity = 0.3, largest_effectivity = 5;

struct Case {
  std::string name;
  fem::RingStructure structure;
  fem::Fidelity fidelity = fem::Fidelity::plane;
  int phases = 16;
  std::vector<int> levels;  ///< 0: as many as 0.15 % takes, which then measure how fast their differences shrink
  int reference_level = 0, reference_degree = 2;
};

fem::PinHeld pins(int count) {
  fem::PinHeld held;
  held.angles = fem::equal_angles(count, 0);
  held.pin_diameter = 15.5e-3;
  return held;
}

fem::LoadedMeshResult solve(const Case& c, int level, int degree) {
  fem::LoadedMeshProblem problem{tests::ring_paper_pair(true), {}, face_width, bore, outside, c.structure};
  problem.loads = {load};
  problem.phases = c.phases;
  fem::LoadedMeshSettings settings;
  settings.fidelity = c.fidelity;
  if (level > 0) settings.level = level;
  settings.accuracy = 1.5e-3;
  settings.degree = degree;
  settings.threads = 2;
  return solve_loaded_mesh(problem, settings);
}

/// Whether the largest estimate is of the size of the largest error, and the estimate of that entry as well.
bool measure(const Case& c) {
  const benchmarks::Stopwatch watch;
  const auto reference = solve(c, c.reference_level, c.reference_degree);
  const auto entries = static_cast<std::size_t>(reference.table.phases() * reference.table.positions());
  fmt::print(
      "{}, {} entries, reference: level {} of degree {} (estimates its own error at {:.1e}), {:.1f} s, "
      "{:.1f} s of processor time\n",
      c.name, entries, c.reference_level, c.reference_degree, reference.worst_error_relative, watch.wall(),
      watch.cpu());
  bool good = true;
  for (const int level : c.levels) {
    const auto result = solve(c, level, 2);
    double worst_error = 0, worst_estimate = 0, at_worst = 0;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < entries; ++i) {
      const auto& entry = result.positions[i].entry;
      const double error = std::abs(entry.stiffness_secant / reference.positions[i].entry.stiffness_secant - 1);
      worst_estimate = std::max(worst_estimate, tests::numeric_error(entry));
      if (error > worst_error) worst_error = error, at_worst = tests::numeric_error(entry) / error;
      if (error > smallest_error) ratios.push_back(tests::numeric_error(entry) / error);
    }
    std::sort(ratios.begin(), ratios.end());
    const double effectivity = worst_estimate / worst_error;
    const bool within =
        std::min(effectivity, at_worst) >= least_effectivity && std::max(effectivity, at_worst) <= largest_effectivity;
    good = good && within;
    fmt::print(
        "  {}level {}: worst error {:.2e}, worst estimate {:.2e}, effectivity {:.2f}, at the worst error {:.2f}{}; ",
        level == 0 ? "as planned, " : "", result.level, worst_error, worst_estimate, effectivity, at_worst,
        within ? "" : " OUT OF BOUNDS");
    if (ratios.empty())
      fmt::print("no error above {:.0e}\n", smallest_error);
    else
      fmt::print("{} errors above {:.0e}: {:.2f} / {:.2f} / {:.2f} (min / median / max)\n", ratios.size(),
                 smallest_error, ratios.front(), ratios[ratios.size() / 2], ratios.back());
    std::fflush(stdout);
  }
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Effectivity of the error estimate: estimate over error"};
  bool finer = false;
  app.add_flag("--finer", finer, "finer references and more positions: a quarter of an hour");
  CLI11_PARSE(app, argc, argv);
  // The levels the program uses.
  const Case traditional{
      "traditional, plane", fem::OutsideHeld{}, fem::Fidelity::plane, 16, {1, 2, 0}, finer ? 6 : 4, 2};
  const Case pinned{"24 pins, plane", pins(24), fem::Fidelity::plane, finer ? 16 : 4, {1, 2, 0}, finer ? 5 : 4, 2};
  const Case thin_walled{
      "thin-walled, solid", fem::EndFaceHeld{18e-3, 10.6e-3}, fem::Fidelity::solid, 4, {1}, finer ? 2 : 1, 3};
  bool good = true;
  for (const Case& c : {traditional, pinned, thin_walled}) good = measure(c) && good;
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
