#include "app/systems/planetary/comparison.h"
#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"

#include <boost/test/unit_test.hpp>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/mesh_names.h"
#include "core/files.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

/// A run of two rings with prescribed constant stiffnesses, without dynamics; `error` is that of every table entry.
app::RunResult run_of(double stiff, double soft, double error) {
  auto text = test::quick_scene();
  const auto begin = text.find("[[ring]]"), end = text.find("[errors]");
  text.insert(end, test::replaced(text.substr(begin, end - begin), "held", "soft"));
  const auto scene = app::parse_scene(test::replaced(text, "held", "stiff"), "s");
  auto geometry = app::make_geometry(scene);
  const auto mesh = [&](std::size_t ring, double k) {
    StiffnessTable table(
        "ring_planet", 1, {0.0}, {1e4},
        {{.unloaded_te = 0, .lte = 1e4 / k, .stiffness_secant = k, .stiffness_tangent = k, .error_relative = error}});
    return app::MeshResult{
        .model = app::ring_mesh_model(scene, geometry, ring), .contact_ratio = 1.5, .table = std::move(table)};
  };
  const auto run = std::make_shared<app::SystemRun>(scene);
  run->plan = app::make_plan(scene);
  run->tables = {mesh(0, 2e9), mesh(0, stiff), mesh(1, soft)};
  run->tables.front().model.mesh = app::sun_planet;
  return app::RunResult(*run);
}

app::Reference published(double margin = 0) {
  app::Reference reference;
  reference.orders.push_back({.quantity = "ring_stiffness",
                              .variants = {"stiff", "soft"},
                              .values = {},
                              .margin = margin,
                              .statement = "stiff is stiffer",
                              .where = ""});
  return reference;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(comparison)

BOOST_AUTO_TEST_CASE(outcomes_follow_the_numbers) {
  using Outcome = app::Verdict::Outcome;
  const auto outcome = [](double stiff, double soft, double error, double margin = 0) {
    const auto verdicts = app::compare(published(margin), run_of(stiff, soft, error));
    BOOST_TEST_REQUIRE(verdicts.size() == 1U);
    BOOST_TEST((verdicts[0].outcome == Outcome::agrees) == verdicts[0].why.empty());
    return verdicts[0].outcome;
  };
  BOOST_CHECK(outcome(3e9, 1e9, 0.01) == Outcome::agrees);
  BOOST_CHECK(outcome(1e9, 3e9, 0.01) == Outcome::disagrees);
  BOOST_CHECK(outcome(1.01e9, 1e9, 0.01) == Outcome::undecided);
  BOOST_CHECK(outcome(1.01e9, 1e9, 0.001) == Outcome::agrees);
  BOOST_CHECK(outcome(1.01e9, 1e9, 0.001, 0.05) == Outcome::disagrees);  // larger, but not clearly
}

BOOST_AUTO_TEST_CASE(missing_variants_are_not_judged) {
  auto reference = published();
  reference.orders[0].variants = {"stiff", "pinned"};
  reference.at_pins.push_back({"pinned", "stiffer at a pin", ""});
  for (const auto& v : app::compare(reference, run_of(3e9, 1e9, 0.01))) {
    BOOST_CHECK(v.outcome == app::Verdict::Outcome::undecided);
    BOOST_TEST(v.why.find("pinned") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(parts_of_the_path_add_up) {
  const auto path = app::path_stiffness(run_of(3e9, 1e9, 0), 1);
  BOOST_TEST(path.ring_part + path.sun_part + path.bearing_part == 1.0, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(path.ring_part * 1e9 == path.total, boost::test_tools::tolerance(1e-14));  // compliances in series
}

BOOST_AUTO_TEST_CASE(shipped_reference_reads) {
  const auto reference =
      app::read_reference(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/reference/ring_types.toml");
  BOOST_TEST(!reference.source.empty());
  BOOST_TEST(reference.orders.size() > 2U);
  BOOST_TEST(reference.at_pins.size() == 1U);
  const test::TemporaryFolder folder("reference");
  write_file(folder.path() / "r.toml", "source = \"x\"\n[[order]]\nquantity = \"load_sharing\"\nstatement = \"s\"\n");
  BOOST_CHECK_THROW((void)app::read_reference(folder.path() / "r.toml"), InputError);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
