#include "app/model/reuse.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/run/pipeline.h"
#include "app/systems/planetary/planetary_run.h"
#include "core/csv.h"
#include "core/log.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

app::RunResult run_reusing(const std::string& text, const std::filesystem::path& out) {
  log::set_level(log::Level::quiet);
  return app::run(app::parse_scene(text, "scene.toml"), {.out = out, .threads = 2});
}

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::string mesh_of_ring = "ring-planet mesh of 'held'", dynamics_of = "dynamics of 'held'";

}  // namespace

BOOST_AUTO_TEST_SUITE(reuse)

BOOST_AUTO_TEST_CASE(a_second_run_computes_nothing) {
  const test::TemporaryFolder folder("reuse_second");
  const auto text = test::pinned_scene() + "[[sweep]]\ninput = \"supports.sun_N_per_m\"\nvalues = [1e7, 2e7]\n";
  const auto first = run_reusing(text, folder.path());
  BOOST_TEST(has(first.reuse->computed(), mesh_of_ring));
  BOOST_TEST(has(first.reuse->computed(), dynamics_of));
  BOOST_TEST(first.reuse->reused().empty());
  BOOST_TEST(first.reuse->counted(app::condensed_teeth).computed > 0);
  BOOST_TEST(first.reuse->counted(app::study_responses).computed == 2);

  const auto second = run_reusing(text, folder.path());
  BOOST_TEST(second.reuse->computed().empty());
  BOOST_TEST((second.reuse->reused() == first.reuse->computed()));
  for (const auto& [things, count] : second.reuse->counts()) BOOST_TEST(count.computed == 0, things);
  BOOST_TEST(second.reuse->counted(app::study_responses).reused == 2);
  BOOST_TEST(app::run_text(second).find("computed ") == std::string::npos);
  BOOST_TEST(app::run_text(second).find("reused   ") != std::string::npos);

  std::ifstream in(folder.path() / "summary.json");
  const auto json = nlohmann::json::parse(in)["reuse"];
  BOOST_TEST(has(json["reused"].get<Names>(), mesh_of_ring));
  BOOST_TEST(json["computed"].empty());
  BOOST_TEST(json["counts"][app::study_responses]["reused"] == 2);
}

BOOST_AUTO_TEST_CASE(an_input_of_the_dynamics_solves_no_mesh) {
  const test::TemporaryFolder folder("reuse_dynamics");
  (void)run_reusing(test::pinned_scene(), folder.path());
  for (const auto& [what, by] : {std::pair{"half_backlash_um = 50", "half_backlash_um = 60"},
                                 {"sun_N_per_m = 1e7", "sun_N_per_m = 3e7"},
                                 {"planet_pin_position_error_um = [15", "planet_pin_position_error_um = [25"}}) {
    const auto changed = run_reusing(test::replaced(test::pinned_scene(), what, by), folder.path());
    BOOST_TEST(has(changed.reuse->reused(), mesh_of_ring), by);
    BOOST_TEST(has(changed.reuse->computed(), dynamics_of), by);
    BOOST_TEST(changed.reuse->counted(app::condensed_teeth).computed == 0, by);
    BOOST_TEST(changed.reuse->counted(app::condensed_teeth).reused == 0, by);  // not even asked for
  }
}

BOOST_AUTO_TEST_CASE(other_pins_condense_no_tooth) {
  const test::TemporaryFolder folder("reuse_pins"), fresh("reuse_fresh");
  (void)run_reusing(test::pinned_scene(), folder.path());
  int case_number = 0;
  for (const auto& [what, by] :
       {std::pair{"pins = 81", "pins = 54\nfirst_pin_angle_deg = 0.7\npin_clearance_um = 3"},
        {"structure = \"pinned\"", "structure = \"bolted\"\npin_radial_stiffness_N_per_m = 4e9"}}) {
    const auto text = test::replaced(test::pinned_scene(), what, by);
    const auto changed = run_reusing(text, folder.path());
    BOOST_TEST(has(changed.reuse->computed(), mesh_of_ring), by);
    BOOST_TEST(changed.reuse->counted(app::condensed_teeth).computed == 0, by);
    BOOST_TEST(changed.reuse->counted(app::condensed_teeth).reused > 0, by);
    const auto alone_in = fresh.path() / std::to_string(case_number++);
    const auto alone = run_reusing(text, alone_in);
    BOOST_TEST(alone.reuse->counted(app::condensed_teeth).computed > 0, by);
    const auto rows = [](const std::filesystem::path& out) {
      return Csv::read(out / "held/stiffness_ring_planet.csv").rows;
    };
    BOOST_TEST((rows(folder.path()) == rows(alone_in)), by);
  }
}

BOOST_AUTO_TEST_CASE(lists_are_told_in_words) {
  log::set_level(log::Level::quiet);
  app::Reuse reuse;
  BOOST_TEST(reuse.text().empty());
  reuse.note("b", app::ResultSource::reused);
  reuse.note("a", app::ResultSource::reused);
  reuse.note("c", app::ResultSource::computed);
  reuse.note("c", app::ResultSource::reused);  // computed, then read back by a later step
  reuse.count(app::condensed_teeth, 2, 1);
  reuse.count(app::study_responses, 0, 0);
  BOOST_TEST(reuse.text() == "reused   a, b, 2 tooth superelements\ncomputed c, 1 tooth superelements\n");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
