#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/units.h"
#include "tests/verification/outside_cases/outside_case.h"
#include "tests/verification_record.h"

namespace {

using namespace annulus;
using test::OutsideCase;
using test::Verification;

constexpr const char* repository = "repository COMPAct (data/cases/actuator_plastic_ring)";

}  // namespace

BOOST_AUTO_TEST_SUITE(actuator_plastic_ring)

BOOST_AUTO_TEST_CASE(geometry_of_the_models) {
  Verification record("Geometry of a 3-D printed actuator with a plastic ring", repository);
  const OutsideCase published("actuator_plastic_ring");
  const auto geometry = app::make_geometry(app::read_scene(published.scene("stage.toml")));
  const auto& set = geometry.rings.front().set;
  const auto exactly = [&](const char* quantity, double computed) {
    const auto& printed = published.printed(quantity);
    record.close(quantity, printed.unit, computed, printed.value, 1e-12, "rounding");
  };
  const auto to_digits = [&](const char* quantity, double computed) {
    const auto& printed = published.printed(quantity);
    record.near(quantity, printed.unit, computed, printed.value, printed.half_unit, "printed digits");
  };
  const auto& speed = geometry.operating_point.flow.speed;
  exactly("ratio", speed[geometry::StageMember::sun] / speed[geometry::StageMember::carrier]);
  exactly("base_diameter_sun", 2 * set.sun().base_radius() / units::mm);
  exactly("base_diameter_planet", 2 * set.planet().base_radius() / units::mm);
  exactly("base_diameter_ring", 2 * set.ring().base_radius() / units::mm);
  to_digits("tip_diameter_planet", 2 * set.planet().tip_radius() / units::mm);
  to_digits("root_diameter_planet", 2 * set.planet().root_radius() / units::mm);
}

BOOST_AUTO_TEST_CASE(meshes_are_stiffer_than_the_actuator) {
  Verification record("Stiffness of a 3-D printed actuator at its output",
                      "Singh, Kapa, Joshi, Kolathaya, arXiv:2510.07197: measured stiffness of the whole actuator "
                      "(data/cases/actuator_plastic_ring: why the meshes are far stiffer)");
  const OutsideCase published("actuator_plastic_ring");
  std::ifstream file(published.run("stage.toml") / "summary.json");
  const auto ring = nlohmann::json::parse(file).at("rings").at("outside_held");
  const auto stiffness = [&](const char* mesh) {
    return ring.at(mesh).at("mean_stiffness_N_per_m").at("value").get<double>();
  };
  const auto scene = app::read_scene(published.scene("stage.toml"));
  const double base_radius = app::make_geometry(scene).rings.front().set.sun().base_radius();
  const double ratio = published.printed("ratio").value;
  const double meshes = std::pow(ratio * base_radius, 2) * scene.stage.planets /
                        (1 / stiffness("sun_planet") + 1 / stiffness("ring_planet"));
  record.at_least("stiffness of the meshes alone", "N m/rad", meshes, published.printed("output_stiffness").value,
                  "pins, carrier, shaft and casing are in series with them");
}

BOOST_AUTO_TEST_SUITE_END()
