#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// Runs and sweeps where several motions exist.
BOOST_AUTO_TEST_SUITE(motions)

using namespace annulus;

/// A spur pair on rigid bearings with constant mean stiffness and a harmonic ripple; its natural frequency is met at
/// some 1800 r/min.
std::string spur_pair(double speed, const std::string& more = "") {
  return fmt::format(R"(title = "Spur pair"
[stage]
kind = "helical_pair"
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 40
pinion_torque_Nm = 300
pinion_speed_rpm = {}
[material]
youngs_modulus_GPa = 206
[pinion]
teeth = 30
profile_shift = 0
mass_kg = 3
bore_diameter_mm = 40
[wheel]
teeth = 30
profile_shift = 0
mass_kg = 3
bore_diameter_mm = 40
[mesh.pinion_wheel]
stiffness = "harmonic"
mean_N_per_m = 3e8
ripple = 0.2
[dynamics]
half_backlash_um = 30
mesh_damping_ratio = 0.03
support_damping_ratio = 0.03
)",
                     speed) +
         more;
}

Json run(const test::TemporaryFolder& folder, const std::string& scene) {
  write_file(folder.path() / "scene.toml", scene);
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  return Json::parse(read_file(folder.path() / "out/summary.json"));
}

const Json* warning(const Json& summary, const std::string& key) {
  for (const auto& w : summary.at("warnings"))
    if (w.at("key") == key) return &w;
  return nullptr;
}

BOOST_AUTO_TEST_SUITE_END()
