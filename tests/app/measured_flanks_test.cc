#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/run/finished_run.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/units.h"
#include "geometry/profile.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// Flanks that a scene reads from files.
BOOST_AUTO_TEST_SUITE(measured_flanks)

using namespace annulus;

namespace {

/// The small stage in the plane, with more keys of its planets and other lines of its speed.
std::string stage(const std::string& planet, const std::string& flow = "") {
  auto text = test::replaced(test::small_stage(), "[planet]\n", "[planet]\n" + planet);
  if (!flow.empty()) text = test::replaced(text, "sun_speed_rpm = ", flow);
  return "model = \"plane\"\naccuracy = 0.03\n" + text;
}

class Scenes {
 public:
  Scenes() : folder_("measured_flanks") {}

  void file(const std::string& name, const std::string& text) const { write_file(folder_.path() / name, text); }
  [[nodiscard]] app::Scene read(const std::string& text) const {
    return app::parse_scene(text, folder_.path() / "scene.toml");
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  /// Table of the sun mesh or the ring mesh.
  [[nodiscard]] StiffnessTable table(const std::string& text, bool ring) const {
    const auto scene = read(text);
    const auto geometry = app::make_geometry(scene);
    app::RunOptions options;
    options.out = folder_.path();
    options.for_study = true;
    const auto model = ring ? app::ring_mesh_model(scene, geometry, 0) : app::sun_mesh_model(scene, geometry);
    return app::mesh_stiffness(scene, geometry, model, options).table;
  }

 private:
  test::TemporaryFolder folder_;
};

/// Largest relative difference of the deflections of two tables.
double difference(const StiffnessTable& a, const StiffnessTable& b) {
  double largest = 0;
  for (int phase = 0; phase < a.phases(); ++phase)
    for (int load = 0; load < static_cast<int>(a.loads().size()); ++load)
      largest = std::max(largest, std::abs(a.at(0, phase, load).lte / b.at(0, phase, load).lte - 1));
  return largest;
}

/// A profile of the small stage's planet with this slope, um, between the ends of its flanks; positive: as
/// profile_slope_um.
std::string sloped(const Scenes& scenes, double slope) {
  const auto planet = app::make_geometry(scenes.read(stage(""))).sun_mesh().pinion();
  auto parameters = planet.parameters();
  parameters.profile_slope = slope * units::um;
  const geometry::ToothProfile shape{geometry::Gear(parameters)};
  std::string text = "diameter_mm,position_mm,removed_um\n";
  constexpr int points = 21;
  for (int i = 0; i < points; ++i) {
    const double r =
        planet.form_radius() + (planet.tip_radius() - planet.form_radius()) * static_cast<double>(i) / (points - 1);
    text +=
        fmt::format("{:.9f},0,{:.9f}\n", 2 * r / units::mm, shape.modification(shape.roll_length_at(r)) / units::um);
  }
  return text;
}

}  // namespace

// The planets meet the sun with the left flanks of their teeth and the ring with the right ones; driven the other way
// round it is the other way round.
BOOST_AUTO_TEST_CASE(files_of_a_scene_are_the_flanks_of_their_side) {
  const Scenes scenes;
  scenes.file("left.csv", sloped(scenes, 8));
  scenes.file("right.csv", sloped(scenes, -8));
  const std::string files = "left_topography = \"left.csv\"\nright_topography = \"right.csv\"\n";
  for (const bool ring : {false, true}) {
    const auto by_files = scenes.table(stage(files), ring),
               by_key = scenes.table(stage(fmt::format("profile_slope_um = {}\n", ring ? -8 : 8)), ring),
               other = scenes.table(stage(fmt::format("profile_slope_um = {}\n", ring ? 8 : -8)), ring),
               reversed = scenes.table(stage(files, "drives = \"carrier\"\nsun_speed_rpm = "), ring);
    // 21 points: near the base circle the roll length begins like a square root of the radius.
    constexpr double interpolation = 1e-3;
    BOOST_TEST(difference(by_files, by_key) < interpolation);
    BOOST_TEST(difference(by_key, other) > 0.01);
    BOOST_TEST(difference(reversed, other) < interpolation);
  }
}

BOOST_AUTO_TEST_CASE(other_files_are_other_results) {
  const Scenes scenes;
  const auto id = [&] {
    const auto scene = scenes.read(stage("left_topography = \"flank.csv\"\n"));
    return app::sun_mesh_model(scene, app::make_geometry(scene)).id() + app::run_id(scene, {});
  };
  scenes.file("flank.csv", sloped(scenes, 8));
  const auto first = id();
  BOOST_TEST(id() == first);
  scenes.file("flank.csv", sloped(scenes, 8.001));
  BOOST_TEST(id() != first);
}

BOOST_AUTO_TEST_CASE(files_that_cannot_be_used_are_refused_with_line_and_key) {
  const Scenes scenes;
  const auto refused = [&](const std::string& keys, const std::string& part) {
    const auto message = scenes.refusal(stage(keys));
    BOOST_TEST(message.find(part) != std::string::npos, message);
    BOOST_TEST(message.find("scene.toml:") != std::string::npos, message);
  };
  refused("left_topography = \"absent.csv\"\n", "planet.left_topography = absent.csv: there is no such file");
  refused("right_topography = \"../flank.csv\"\n", "planet.right_topography = ../flank.csv: leads out of the");
  scenes.file("flank.csv", "diameter_mm,position_mm,removed_um\n30,0,1\n31,0,x\n");
  refused("left_topography = \"flank.csv\"\n", "flank.csv:3");
  scenes.file("flank.csv", sloped(scenes, 8));
  const auto formulas =
      test::replaced(stage("left_topography = \"flank.csv\"\n"), "model = \"plane\"", "model = \"closed_form\"");
  BOOST_TEST(scenes.refusal(formulas).find("do not cover measured flanks") != std::string::npos,
             scenes.refusal(formulas));
  // Flanks that change along the face have no plane section.
  std::string uneven = "diameter_mm,position_mm,removed_um\n";
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) uneven += fmt::format("{},{},{}\n", 40 + 3 * i, 5 * j - 7.5, i + j);
  scenes.file("uneven.csv", uneven);
  refused("left_topography = \"uneven.csv\"\n", "cannot represent the sun-planet mesh");
}

BOOST_AUTO_TEST_CASE(what_a_topography_leaves_out_is_a_warning) {
  const Scenes scenes;
  const auto warnings = [&](const std::string& keys) {
    std::string all;
    for (const auto& w : app::make_plan(scenes.read(stage(keys))).warnings)
      if (w.key == "measured_flanks") all += w.text + " (" + w.where + ")\n";
    return all;
  };
  scenes.file("flank.csv", sloped(scenes, 8));
  const std::string both = "left_topography = \"flank.csv\"\nright_topography = \"flank.csv\"\n";
  BOOST_TEST(warnings(both) == "");
  const auto one = warnings("left_topography = \"flank.csv\"\n");
  BOOST_TEST(one.find("flanks that do not carry here") != std::string::npos, one);
  BOOST_TEST(one.find("ring mesh") != std::string::npos, one);
  BOOST_TEST(one.find("(sun mesh)") == std::string::npos, one);
  auto text = sloped(scenes, 8);
  const auto lines = [&](int count) {  // of the profile
    std::size_t end = 0;
    for (int i = 0; i <= count; ++i) end = text.find('\n', end) + 1;
    return text.substr(0, end);
  };
  scenes.file("flank.csv", lines(15));
  const auto part = warnings(both);
  BOOST_TEST(part.find("its topography reaches from") != std::string::npos, part);
}

BOOST_AUTO_TEST_SUITE_END()
