#include <fmt/format.h>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "core/files.h"
#include "core/json.h"
#include "core/units.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/app/statics_scenes.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// Helical pairs whose gears lie in bearings with places, from a scene to its files.
BOOST_AUTO_TEST_SUITE(pair_in_space)

using namespace annulus;
using test::statics::bearing;

namespace {

std::string pair_scene(const std::string& helix = "14", const std::string& wave = "stiffness = \"constant\"\n",
                       const std::string& supports = "") {
  return "title = \"Pair\"\naccuracy = 0.001\n[stage]\nkind = \"helical_pair\"\nmodule_mm = 15\npressure_angle_deg = "
         "20\n"
         "helix_angle_deg = " +
         helix +
         "\nface_width_mm = 150\npinion_torque_Nm = 20000\npinion_speed_rpm = 1500\n[material]\n"
         "youngs_modulus_GPa = 206\n[pinion]\nteeth = 21\nprofile_shift = 0\nmass_kg = 205\n" +
         supports + "[wheel]\nteeth = 37\nprofile_shift = 0\nmass_kg = 289\n" + supports + "[mesh.pinion_wheel]\n" +
         wave +
         "mean_N_per_m = 2.9e9\n[dynamics]\nhalf_backlash_um = 150\nmesh_damping_ratio = 0.08\n"
         "support_damping_ratio = 0.05\n";
}

/// An overhung pinion and a wheel between its bearings.
std::string bearings() {
  return bearing("near", "pinion", "at_mm = 130\nradial_N_per_m = 3e9\naxial_N_per_m = 1e9\n") +
         bearing("far", "pinion", "at_mm = 400\nradial_N_per_m = 2e9\n") +
         bearing("left", "wheel", "at_mm = -180\nradial_N_per_m = 3e9\naxial_N_per_m = 1e9\n") +
         bearing("right", "wheel", "at_mm = 220\nradial_N_per_m = 3e9\n") +
         "[tilt_inertia]\npinion_kg_m2 = 3\nwheel_kg_m2 = 9\n";
}

Json response_of(const test::TemporaryFolder& folder, const std::string& scene) {
  write_file(folder.path() / "scene.toml", scene);
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  return Json::parse(read_file(folder.path() / "out/summary.json")).at("response");
}

}  // namespace

// A pair of constant stiffness stands still in its bearings: forces of the gears' equilibrium.
BOOST_AUTO_TEST_CASE(forces_of_bearings) {
  test::Verification record("A helical pair in its bearings", "statics of the gears");
  const test::TemporaryFolder folder("pair_in_space_1");
  const double beta = 14 * units::deg, normal = 20 * units::deg;
  const double transverse = std::atan(std::tan(normal) / std::cos(beta)), module = 15e-3 / std::cos(beta);
  for (const int hand : {1, -1}) {
    const auto json = response_of(folder, pair_scene(fmt::format("{}", hand * 14)) + bearings());
    const auto& found = json.at("bearings_in_space");
    const double radius = module * 21 / 2, tangential = 20e3 / radius;
    const double thrust = tangential * std::tan(beta), radial = tangential * std::tan(transverse);
    const double place = json.at("places_of_mesh_forces").at("mesh").at("mean_m");
    // On the pinion, from the wheel at its pitch point; x to the wheel. A right-handed pinion is pushed along +z.
    const Eigen::Vector3d force(-radial, -tangential, hand * thrust);
    const auto share = [&](double own, double other) {  // of a radial bearing; moments about the other one
      const Eigen::Vector2d transverse_force = (place - other) / (own - other) * force.head<2>();
      const Eigen::Vector2d by_thrust(-radius * force.z() / (own - other), 0);
      return (transverse_force + by_thrust).norm();
    };
    for (const auto& [name, expected] :
         {std::pair{"pinion_near", share(0.13, 0.4)}, {"pinion_far", share(0.4, 0.13)}}) {
      record.close("radial force of an overhung pinion's bearings", "N", found.at(name).at("radial_mean_N"), expected,
                   1e-6, "residual of the motion");
    }
    record.close("axial force of the pinion", "N", found.at("pinion_near").at("axial_mean_N"), -force.z(), 1e-6,
                 "residual of the motion");
    record.close("axial force of the wheel", "N", found.at("wheel_left").at("axial_mean_N"), force.z(), 1e-6,
                 "residual of the motion");
    BOOST_TEST(std::abs(place) > 1e-3);  // gears tilt
    BOOST_TEST(json.at("natural_frequencies_Hz").size() == 12U);
  }
  const auto report = read_file(folder.path() / "out/report.html");
  BOOST_TEST(report.find("Bearings and faces in space") != std::string::npos);
  BOOST_TEST(std::filesystem::exists(folder.path() / "out/dynamics/bearings_in_space.csv"));
}

// At rest a bearing with clearance does what its tangent says; a vibration leaves the tangent, which the run measures.
BOOST_AUTO_TEST_CASE(bearings_by_their_tangents_and_by_their_laws) {
  test::Verification record("A helical pair in its bearings", "bearings by their laws");
  const test::TemporaryFolder folder("pair_in_space_5");
  const auto loose = test::replaced(bearings(), "at_mm = 130\n", "at_mm = 130\nclearance_um = 40\n");
  const auto whole = [](const std::string& scene) {
    return test::replaced(scene, "[dynamics]\n", "[dynamics]\nbearing_laws = \"whole\"\n");
  };
  const auto near = [](const Json& response) { return response.at("bearings_in_space").at("pinion_near"); };
  const auto deviation = [&](const Json& response) {
    return near(response).at("law_deviation_of_mesh_force").get<double>();
  };
  const auto still = pair_scene() + loose,
             moving = pair_scene("14", "stiffness = \"harmonic\"\nripple = 0.3\n") + loose;
  const auto at_rest = response_of(folder, still), at_rest_by_law = response_of(folder, whole(still));
  record.at_most("deviation of the tangents at rest", "", deviation(at_rest), 1e-6, "residual of the motion");
  record.close("radial force at rest", "N", near(at_rest).at("radial_mean_N"), near(at_rest_by_law).at("radial_mean_N"),
               1e-6, "residual of the motion");
  const auto tangents = response_of(folder, moving), laws = response_of(folder, whole(moving));
  BOOST_TEST(deviation(tangents) > 1e-4);
  BOOST_TEST(deviation(laws) == 0);
}

// The mirror image along the axis has the other hand and its bearings on the other side.
BOOST_AUTO_TEST_CASE(mirror_image) {
  test::Verification record("A helical pair in its bearings", "symmetry");
  const test::TemporaryFolder folder("pair_in_space_2");
  const std::string wave = "stiffness = \"harmonic\"\nripple = 0.05\n";
  const auto one = response_of(folder, pair_scene("14", wave) + bearings());
  auto mirrored = bearings();
  for (const auto& [from, to] : {std::pair{"at_mm = 130", "at_mm = -130"},
                                 {"at_mm = 400", "at_mm = -400"},
                                 {"at_mm = -180", "at_mm = 180"},
                                 {"at_mm = 220", "at_mm = -220"}})
    mirrored = test::replaced(mirrored, from, to);
  const auto other = response_of(folder, pair_scene("-14", wave) + mirrored);
  const auto &a = one.at("natural_frequencies_Hz"), &b = other.at("natural_frequencies_Hz");
  for (std::size_t i = 1; i < a.size(); ++i)
    record.close("natural frequencies", "Hz", b.at(i).get<double>(), a.at(i).get<double>(), 1e-9, "rounding");
  for (const auto* key : {"mesh_force_max_N", "dynamic_factor"})
    record.close(key, "", other.at(key).at("value").get<double>(), one.at(key).at("value").get<double>(), 1e-8,
                 "residual of the motion");
}

// One bearing per gear that does not tilt is what the tables of the gears say.
BOOST_AUTO_TEST_CASE(the_model_of_the_paper_is_a_setting) {
  test::Verification record("A helical pair in its bearings", "the same pair without bearing tables");
  const test::TemporaryFolder folder("pair_in_space_3");
  const std::string wave = "stiffness = \"harmonic\"\nripple = 0.05\n";
  const auto plane =
      response_of(folder, pair_scene("14", wave, "bearing_transverse_N_per_m = 2e9\nbearing_axial_N_per_m = 1e9\n"));
  const std::string held = "radial_N_per_m = 2e9\naxial_N_per_m = 1e9\ntilt_Nm_per_rad = \"rigid\"\n";
  const auto space =
      response_of(folder, pair_scene("14", wave) + bearing("p", "pinion", held) + bearing("w", "wheel", held));
  for (const auto* key : {"mesh_force_max_N", "dynamic_factor"})
    record.close(key, "", space.at(key).at("value").get<double>(), plane.at(key).at("value").get<double>(), 1e-6,
                 "residual of the motion");
  for (const auto& frequency : plane.at("natural_frequencies_Hz")) {
    double nearest = 0;
    for (const auto& other : space.at("natural_frequencies_Hz"))
      if (std::abs(other.get<double>() - frequency.get<double>()) < std::abs(nearest - frequency.get<double>()))
        nearest = other.get<double>();
    record.near("natural frequencies", "Hz", nearest, frequency.get<double>(), 1e-6, "rounding");
  }
}

BOOST_AUTO_TEST_CASE(plan_warnings_and_refusals) {
  const test::TemporaryFolder folder("pair_in_space_4");
  write_file(folder.path() / "scene.toml", pair_scene() +
                                               bearing("near", "pinion",
                                                       "at_mm = 130\nradial_N_per_m = 3e9\nclearance_um = 20\n"
                                                       "axial_N_per_m = 1e9\n") +
                                               bearing("far", "pinion", "at_mm = 400\nradial_N_per_m = 2e9\n"));
  const auto plan = test::run_program(folder.path(), "plan scene.toml --inputs");
  BOOST_TEST_REQUIRE(plan.status == 0, plan.err);
  for (const auto* text : {"retained pinion x, y", "retained pinion tilts", "dropped  wheel tilts",
                           "tilt_inertia.pinion_kg_m2", "no [[bearing]] holds the wheel"})
    BOOST_TEST(plan.out.find(text) != std::string::npos, std::string(text) + " is not in: " + plan.out);
  const auto expect_refusal = [](const std::string& scene, const std::string& words) {
    const auto refusal = test::scene_refusal(scene);
    BOOST_TEST(refusal.find(words) != std::string::npos, words + " is not in: " + refusal);
  };
  expect_refusal(test::replaced(pair_scene(), "pinion_torque_Nm = 20000", "pinion_torque_Nm = -20000") + bearings(),
                 "driving flanks alone");
  expect_refusal(pair_scene() + bearing("a", "sun", "radial_N_per_m = 1e9\n"), "must be one of \"pinion\", \"wheel\"");
  expect_refusal(pair_scene() + bearing("a", "pinion", "on = \"housing\"\nradial_N_per_m = 1e9\n"), "on");
  write_file(folder.path() / "scene.toml",
             pair_scene() + bearing("near", "pinion", "radial_N_per_m = 3e9\naxial_N_per_m = 1e9\n"));
  for (const auto* command : {"check scene.toml", "run scene.toml --out out --quiet"}) {
    const auto loose = test::run_program(folder.path(), command);
    BOOST_TEST(loose.status == 2, command);
    BOOST_TEST(loose.err.find("nothing resists a motion of pinion about y") != std::string::npos, loose.err);
  }
}

BOOST_AUTO_TEST_SUITE_END()
