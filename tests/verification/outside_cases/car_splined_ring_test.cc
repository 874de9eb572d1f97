#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/csv.h"
#include "core/units.h"
#include "tests/verification/outside_cases/outside_case.h"
#include "tests/verification_record.h"

namespace {

using namespace annulus;
using test::OutsideCase;
using test::Verification;

/// Mean over the positions of a table at the load next to `force`.
double mean_tangent_stiffness(const std::filesystem::path& table, double force) {
  const auto csv = Csv::read(table);
  const auto load = csv.column("load_N"), tangent = csv.column("stiffness_tangent_N_per_m");
  double nearest = std::numeric_limits<double>::max();
  for (const auto& row : csv.rows)
    if (std::abs(row[load] - force) < std::abs(nearest - force)) nearest = row[load];
  double sum = 0;
  int count = 0;
  for (const auto& row : csv.rows)
    if (std::abs(row[load] - nearest) < 1e-9 * nearest) sum += row[tangent], ++count;
  return sum / count;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(car_splined_ring)

BOOST_AUTO_TEST_CASE(closed_form_of_ligata_kahraman_singh) {
  Verification record(
      "Load sharing of four and five planets with one pin out of position, rings in splines",
      "Ligata, Kahraman, Singh, J. Mech. Des. 131(2) (2009), closed form: 1/N + k_e r_s e / (2 N T_s) x "
      "pattern (data/cases/car_splined_ring)");
  const OutsideCase published("car_splined_ring");
  for (const auto& [name, planets] : {std::pair{"four", 4}, {"five", 5}}) {
    const std::string file = std::string(name) + "_planets.toml";
    const auto scene = app::read_scene(published.scene(file));
    const auto geometry = app::make_geometry(scene);
    const auto out = published.run(file);
    std::vector<double> pattern;
    for (int i = 1; i <= planets; ++i)
      pattern.push_back(published.printed(std::string(name) + "_planets_" + std::to_string(i)).value);

    for (const auto& ring : geometry.rings) {
      // Share of each planet in multiples of 1/N, less 1, mean of all mesh cycles.
      const auto csv = Csv::read(out / ring.name / "dynamics" / "load_sharing.csv");
      std::vector<double> excess(pattern.size(), -1);
      for (std::size_t i = 0; i < pattern.size(); ++i)
        for (const auto& row : csv.rows)
          excess[i] += row[csv.column("sun_planet" + std::to_string(i + 1) + "_averaged")] /
                       static_cast<double>(csv.rows.size());
      double product = 0, square = 0;
      for (std::size_t i = 0; i < pattern.size(); ++i)
        product += excess[i] * pattern[i], square += pattern[i] * pattern[i];
      const double factor = product / square;
      for (std::size_t i = 0; i < pattern.size(); ++i)
        record.near(std::string(name) + " planets: excess share over the factor of the pattern", "", excess[i] / factor,
                    pattern[i], planets == 4 ? 1e-3 : 2e-3,
                    planets == 4 ? "statics; window of the motion"
                                 : "printed digits; stiffness that changes with the load of a planet");

      const double force = geometry.operating_point.mean_mesh_force;
      const double meshes = mean_tangent_stiffness(out / "stiffness_sun_planet.csv", force) +
                            mean_tangent_stiffness(out / ring.name / "stiffness_ring_planet.csv", force);
      const double stiffness = 1 / (1 / 1e8 + 1 / meshes);  // the scene has planet bearings of 1e8 N/m
      const double sun_radius = scene.stage.module * sun_and_planets(scene).sun.teeth / 2, error = 70 * units::um;
      record.close(
          std::string(name) + " planets: K_gamma - 1", "", factor * pattern[0],
          stiffness * sun_radius * error / (2 * geometry.operating_point.sun_torque) * pattern[0], 0.03,
          "the meshes are an eighth of the compliance; side by side instead of in series they are stiffer by a "
          "sixth, and one mesh alone moves the ring in its splines");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
