#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "app/export/rexs.h"
#include "app/model/gear_system.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/stage_response.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/units.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// Face widths, axial offsets and bearings that gears of a stage have of their own.
BOOST_AUTO_TEST_SUITE(gear_keys)

using namespace annulus;

namespace {

app::Scene scene_of(const std::string& text) { return app::parse_scene(text, "scene.toml"); }

/// The quick scene with more keys of the sun, the planets and the ring.
std::string with_keys(const std::string& sun, const std::string& planet, const std::string& ring) {
  auto text = test::replaced(test::quick_scene(), "[sun]\n", "[sun]\n" + sun);
  text = test::replaced(text, "[planet]\n", "[planet]\n" + planet);
  return test::replaced(text, "name = \"held\"\n", "name = \"held\"\n" + ring);
}

std::string refusal(const std::string& text) {
  try {
    (void)app::make_geometry(scene_of(text));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(flanks_touch_on_the_common_face) {
  // 88 mm of the stage; the planets are 84 mm wide and stand 1 mm to one side, the ring is 100 mm wide.
  const auto text = test::replaced(
      with_keys("bore_diameter_mm = 130\n", "bore_diameter_mm = 172\nface_width_mm = 84\naxial_offset_mm = 1\n",
                "face_width_mm = 100\n"),
      "[mesh.sun_planet]\nstiffness = \"harmonic\"\nmean_N_per_m = 1.364e9\nripple = 0.2258\n", "");
  const auto scene = scene_of(test::replaced(
      text, "[mesh.ring_planet]\nstiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294\n", ""));
  const auto geometry = app::make_geometry(scene);
  const auto sun_model = app::sun_mesh_model(scene, geometry), ring_model = app::ring_mesh_model(scene, geometry, 0);
  const auto &sun = sun_model.problem.value(), &ring = ring_model.problem.value();
  const auto is = [](double value, double mm) { return std::abs(value - mm * units::mm) < 1e-12; };
  BOOST_TEST((is(sun.face_width, 84) && is(sun.wheel_overhang.below, 3) && is(sun.wheel_overhang.above, 1)));
  BOOST_TEST(sun.pinion_overhang.total() == 0);
  BOOST_TEST((is(ring.face_width, 84) && is(ring.wheel_overhang.below, 9) && is(ring.wheel_overhang.above, 7)));
  BOOST_TEST(app::solid_reason(scene).empty());
  // Farther apart the load varies along the face.
  const auto apart = scene_of(test::replaced(text, "axial_offset_mm = 1\n", "axial_offset_mm = 6\n"));
  BOOST_TEST(app::solid_reason(apart).find("middles of the faces are apart") != std::string::npos);
  BOOST_TEST(refusal(test::replaced(text, "axial_offset_mm = 1\n", "axial_offset_mm = 90\n"))
                 .find("90.0000 mm apart along the axis") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(helical_sets_have_all_middles_in_one_plane) {
  const auto text = with_keys("face_width_mm = 60\naxial_offset_mm = 14\n", "", "");
  const auto check = [](const std::string& scene) { app::check_stage(scene_of(scene)); };
  BOOST_CHECK_NO_THROW(check(text));
  const auto helical = test::replaced(text, "planets = 5\n", "planets = 5\nhelix_angle_deg = 0.1\n");
  BOOST_CHECK_EXCEPTION(check(helical), GeometryError, [](const GeometryError& error) {
    return std::string(error.what()).find("14 mm apart along the axis") != std::string::npos;
  });
}

// The load is compared with the face that carries it, not with the width that no gear has.
BOOST_AUTO_TEST_CASE(loads_belong_to_the_common_face) {
  const auto scene = [](const std::string& stage, const std::string& sun) {
    auto text = test::replaced(test::small_stage(), "face_width_mm = 60\n", "face_width_mm = " + stage + "\n");
    for (const auto& [gear, width] : {std::pair{"[sun]\n", sun}, {"[planet]\n", "60"}, {"[[ring]]\n", "60"}})
      text = test::replaced(text, gear, gear + ("face_width_mm = " + std::string(width)) + "\n");
    return scene_of(text);
  };
  BOOST_CHECK_NO_THROW(app::check_stage(scene("0.5", "60")));
  BOOST_CHECK_EXCEPTION(app::check_stage(scene("60", "0.5")), InputError, [](const InputError& error) {
    return std::string(error.what()).find("stage.power_kW: each mesh carries") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(bearings_of_each_planet) {
  const auto stage_of = [](const std::string& bearings) {
    const auto scene = scene_of(test::replaced(test::quick_scene(), "planet_N_per_m = 1e9\n", bearings));
    const auto geometry = app::make_geometry(scene);
    const auto model = app::sun_mesh_model(scene, geometry);
    const app::MeshResult none{.model = model, .table = {}, .tabulated = false};
    return app::make_stage(scene, geometry, 0, none, none);
  };
  const auto own = stage_of("planet_radial_N_per_m = [1e9, 2e9, 3e8, inf, 5e8]\nplanet_N_per_m = 7e8\n");
  BOOST_TEST(own.planet_bearing(2).radial == 3e8);
  BOOST_TEST(std::isinf(own.planet_bearing(3).radial));
  BOOST_TEST(own.planet_bearing(4).tangential == 7e8);
  const auto text = test::replaced(test::quick_scene(), "planet_N_per_m = 1e9\n", "planet_radial_N_per_m = [1e9]\n");
  BOOST_CHECK_EXCEPTION((void)scene_of(text), Error, [](const Error& error) {
    return std::string(error.what()).find("1 values for 5 planets") != std::string::npos;
  });
  // Equal bearings in a list are those of one number, to the last bit.
  const auto listed = stage_of(
      "planet_radial_N_per_m = [1e9, 1e9, 1e9, 1e9, 1e9]\nplanet_tangential_N_per_m = [1e9, 1e9, 1e9, 1e9, 1e9]\n");
  const auto common = stage_of("planet_N_per_m = 1e9\n");
  for (int n = 0; n < 5; ++n) {
    BOOST_TEST(listed.planet_bearing(n).radial == common.planet_bearing(n).radial);
    BOOST_TEST(listed.planet_bearing(n).tangential == common.planet_bearing(n).tangential);
  }
}

BOOST_AUTO_TEST_CASE(face_widths_go_through_rexs) {
  const test::TemporaryFolder folder("faces");
  const auto scene = scene_of(with_keys("face_width_mm = 90\n", "", "face_width_mm = 100\n"));
  const auto file = folder.path() / "stage.rexs";
  write_file(file, app::rexs_text(scene, "held"));
  const auto read = app::read_rexs(file);
  BOOST_TEST(read.values.at("stage.face_width_mm").text == "90");  // of the sun, which is read first
  BOOST_TEST(read.values.at("planet.face_width_mm").text == "88");
  BOOST_TEST(read.values.at("ring.face_width_mm").text == "100");
  BOOST_TEST(read.values.count("sun.face_width_mm") == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
