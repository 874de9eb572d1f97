#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/systems/shared/space_results.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

using app::Severity;

/// The severity of a warning about a scene; nothing where it has none of this key.
std::optional<Severity> severity_of(const std::string& text, const std::string& key) {
  const auto warnings = app::make_plan(app::parse_scene(text, "scene.toml")).warnings;
  BOOST_TEST(std::is_sorted(warnings.begin(), warnings.end(),
                            [](const auto& a, const auto& b) { return a.severity > b.severity; }));
  for (const auto& w : warnings) {
    BOOST_TEST(!w.text.empty());
    if (w.key == key) return w.severity;
  }
  return std::nullopt;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(warnings)

BOOST_AUTO_TEST_CASE(scenes_say_what_is_doubtful) {
  const auto scene = test::small_stage();
  const std::string model = "title = \"Promise\"\n";
  // The geometry leaves no backlash; ring and carrier are not mentioned.
  BOOST_CHECK(severity_of(scene, "backlash_beyond_geometry") == Severity::warning);
  BOOST_CHECK(severity_of(scene, "supports_left_out") == Severity::warning);
  const auto mentioned =
      test::replaced(scene, "[supports]\n", "[supports]\nring_N_per_m = \"rigid\"\ncarrier_N_per_m = 1e9\n");
  BOOST_CHECK(!severity_of(mentioned, "supports_left_out"));
  BOOST_CHECK(
      !severity_of(test::replaced(scene, "half_backlash_um = 50", "half_backlash_um = 0"), "backlash_beyond_geometry"));
  BOOST_CHECK(!severity_of(scene, "accuracy_not_controlled"));
  BOOST_CHECK(severity_of(test::replaced(scene, model, model + "model = \"closed_form\"\n"),
                          "accuracy_not_controlled") == Severity::warning);
  BOOST_CHECK(!severity_of(scene, "assumed_inputs"));
  BOOST_CHECK(severity_of(scene + "[assumed]\nsupports.sun_N_per_m = \"not printed\"\n", "assumed_inputs") ==
              Severity::note);
}

BOOST_AUTO_TEST_CASE(phases_that_nobody_states_are_reported) {
  const auto scene = test::small_stage();
  const auto unstated = test::replaced(scene, "planet_pin_position_error_phase_deg = [90, 0, 0, 0]\n", "");
  BOOST_CHECK(!severity_of(scene, "unstated_phases"));
  BOOST_CHECK(severity_of(unstated, "unstated_phases") == Severity::note);
  // Without samples the results are those of one arbitrary choice.
  BOOST_CHECK(severity_of(unstated + "[monte_carlo]\nsamples = 0\n", "unstated_phases") == Severity::warning);
}

BOOST_AUTO_TEST_CASE(tips_near_roots_are_reported) {
  const auto scene = test::small_stage();
  BOOST_CHECK(!severity_of(scene, "tip_clearance"));
  // A root circle of the ring that leaves 0.05 modules above the tips of the planets: 2 (96 + 52 + 0.2) mm.
  BOOST_CHECK(
      severity_of(test::replaced(scene, "tip_diameter_mm = 282\n",
                                 "tip_diameter_mm = 282\nroot_diameter_mm = 296.4\nroot_fillet_factor = 0.05\n"),
                  "tip_clearance") == Severity::warning);
}

BOOST_AUTO_TEST_CASE(faces_that_tilt_further_than_their_tables_know) {
  const auto warnings = [](double place, bool solid) {
    app::SpaceResults results;
    results.meshes = {{"sun_planet1", 0, -place / 2, place, 0.1, solid}};
    return app::space_result_warnings(results, 0.02, "held", "annulus statics has it");
  };
  BOOST_TEST(warnings(0.0003, true).empty());  // 1.8 % more load at an end
  BOOST_TEST(warnings(0.01, false).empty());
  BOOST_TEST(warnings(not_known, true).empty());
  const auto text = [&](double place) { return warnings(place, true).at(0).text; };
  BOOST_TEST(text(0.005).find("up to 5 mm from the middle of its face, which is 100 mm wide") != std::string::npos);
  BOOST_TEST(text(0.005).find("do not tilt; annulus statics has it") != std::string::npos);
  BOOST_TEST(text(0.005).find("Error bars") == std::string::npos);
  BOOST_TEST(text(0.01).find("Error bars contain the change of the face up to 8.3 mm alone") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(severe_ones_come_first) {
  const auto sorted =
      app::by_severity({{"a", Severity::note, "x"}, {"b", Severity::severe, "y"}, {"c", Severity::warning, "z"}});
  BOOST_TEST((sorted[0].key == "b" && sorted[1].key == "c" && sorted[2].key == "a"));
  BOOST_TEST(app::any_warning(sorted));
  BOOST_TEST(!app::any_warning({{"a", Severity::note, "x"}}));
  BOOST_TEST(app::to_text({"a", Severity::severe, "text", "ring"}) == "severe: ring: text");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
