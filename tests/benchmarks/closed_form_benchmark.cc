// How far the stiffness by formulas is from plane finite elements, on suns and held rings drawn at random.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <random>
#include <string>

#include "core/errors.h"
#include "fem/closed_form/closed_form_error.h"
#include "fem/closed_form/closed_form_mesh.h"
#include "fem/loaded_mesh.h"

namespace {

using namespace annulus;
using geometry::Gear;
using geometry::GearKind;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * random_() / 4294967296.0; }
  int whole(int low, int high) { return static_cast<int>(between(low, high + 1)); }
  bool chance(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937 random_;
};

/// 17.5 to 27.5 degrees (half of them 20), 14 to 190 teeth, rims of 1 to 8 modules; three in ten with tip relief.
/// Throws GeometryError where such gears cannot mesh.
fem::LoadedMeshProblem drawn_mesh(Draw& draw, bool internal) {
  const double module = std::exp(draw.between(std::log(1e-3), std::log(8e-3)));
  geometry::GearParameters planet;
  planet.kind = GearKind::external;
  planet.module = module;
  planet.pressure_angle = (draw.chance(0.5) ? 20 : draw.between(17.5, 27.5)) * std::numbers::pi / 180;
  planet.teeth = draw.whole(16, 60);
  planet.face_width = 10 * module;
  planet.root_fillet_factor = draw.between(0.25, 0.4);
  planet.profile_shift = draw.between(-0.2, 0.6);
  auto wheel = planet;
  wheel.kind = internal ? GearKind::internal : GearKind::external;
  wheel.teeth = internal ? 2 * planet.teeth + draw.whole(14, 70) : draw.whole(14, 70);
  wheel.profile_shift = internal ? draw.between(-0.3, 1) : draw.between(-0.2, 0.6);
  if (draw.chance(0.3)) {
    planet.tip_relief = wheel.tip_relief = draw.between(0.5e-3, 6e-3) * module;
    planet.tip_relief_length = wheel.tip_relief_length = draw.between(0.3, 0.8) * module;
  }
  // Centre distance of the shifts, and some backlash.
  const double sign = internal ? -1 : 1, alpha = planet.pressure_angle, teeth = wheel.teeth + sign * planet.teeth;
  const double shift = wheel.profile_shift + sign * planet.profile_shift;
  const double involute = geometry::involute(alpha) + 2 * std::tan(alpha) * shift / teeth;
  if (!(involute > 1e-4)) throw GeometryError("a working pressure angle below four degrees");
  const double working = geometry::inverse_involute(involute);
  const double centre_distance =
      module * (teeth / 2 * std::cos(alpha) / std::cos(working) + sign * draw.between(0, 0.03));
  if (internal) wheel.tip_diameter = module * (wheel.teeth + 2 * wheel.profile_shift - draw.between(1.6, 2));
  const double bore = draw.between(0.3, 0.75), rim = draw.between(1, 8), sun_bore = draw.between(0.2, 0.7);
  const geometry::GearPair pair(Gear(planet), Gear(wheel), centre_distance);
  const double root = pair.wheel().root_radius();
  fem::LoadedMeshProblem problem{pair,
                                 {},
                                 planet.face_width,
                                 bore * pair.pinion().root_radius(),
                                 internal ? root + rim * module : sun_bore * root};
  const double usual = 30e6 * planet.face_width * module;
  problem.loads = {0.1 * usual, usual, 3 * usual};
  problem.phases = 16;
  return problem;
}

/// What gears of one kind leave, relative to plane finite elements.
struct Differences {
  int gears = 0;
  double least = 0, most = 0, sum_of_means = 0, used = 0;

  void add(const fem::LoadedMeshResult& formulas, const fem::LoadedMeshResult& elements) {
    double mean = 0;
    for (std::size_t i = 0; i < elements.positions.size(); ++i) {
      const auto &f = formulas.positions[i].entry, &e = elements.positions[i].entry;
      const double difference = f.stiffness_secant / e.stiffness_secant - 1;
      least = std::min(least, difference), most = std::max(most, difference);
      mean += difference / static_cast<double>(elements.positions.size());
      const double stated = fem::least_closed_form_error + e.error_relative - e.error_parts.model;
      used = std::max(used, std::abs(difference) / stated);
    }
    ++gears;
    sum_of_means += mean;
  }
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App cli("Stiffness by formulas against plane finite elements, on suns and held rings drawn at random");
  int count = 24;
  unsigned seed = 1;
  cli.add_option("--count", count, "Meshes drawn");
  cli.add_option("--seed", seed, "Of the draws");
  CLI11_PARSE(cli, argc, argv);
  try {
    Draw draw(seed);
    Differences differences[2][2];  // internal, with tip relief
    int impossible = 0;
    for (int i = 0; i < count; ++i) {
      const bool internal = i % 2 == 1;
      try {
        const auto problem = drawn_mesh(draw, internal);
        fem::LoadedMeshSettings settings;
        settings.level = 1;
        settings.threads = 1;
        differences[internal][problem.pair.pinion().parameters().tip_relief > 0].add(
            fem::solve_closed_form(problem, {}), fem::solve_loaded_mesh(problem, settings));
      } catch (const InputError&) {
        ++impossible;  // undercut, interference
      }
    }
    fmt::print("stiffness by formulas against plane finite elements, 16 positions, 0.1, 1 and 3 times a usual load\n");
    bool covered = true;
    for (const bool internal : {false, true})
      for (const bool relieved : {false, true}) {
        const auto& d = differences[internal][relieved];
        if (d.gears == 0) continue;
        covered = covered && d.used <= 1;
        fmt::print("{:4} {}{}: positions {:+.2f} to {:+.2f} %, mean {:+.2f} %; at most {:.2f} of the stated error\n",
                   d.gears, internal ? "held rings" : "suns", relieved ? " with tip relief" : "", 100 * d.least,
                   100 * d.most, 100 * d.sum_of_means / d.gears, d.used);
      }
    fmt::print("{} drawn gears that cannot mesh\n", impossible);
    return covered ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
