#include "app/plan/cost_model.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "app/model/gear_system.h"
#include "app/model/run_limits.h"
#include "app/plan/plan.h"
#include "app/process/progress.h"
#include "app/systems/planetary/planetary_model.h"
#include "core/errors.h"
#include "core/files.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

/// No test reads or writes the costs of the user, whatever it runs.
struct NoUserCosts {
  NoUserCosts() { ::setenv("ANNULUS_CACHE", "", 1); }
};
BOOST_TEST_GLOBAL_FIXTURE(NoUserCosts);

app::CostRun plane_size() {
  return {.work = app::Work::plane, .level = 1, .levels = 2, .unknowns = 37000, .contacts = 330, .tasks = 5};
}

/// A mesh that took `factor` times as long as by its law, on some processor.
app::CostRun run_of(app::CostRun size, double factor) {
  size.processor_s = factor * app::processor_seconds(size);
  return size;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

/// A user cache of its own while it lives.
struct UserCache {
  explicit UserCache(const std::filesystem::path& folder) { ::setenv("ANNULUS_CACHE", folder.c_str(), 1); }
  ~UserCache() { ::setenv("ANNULUS_CACHE", "", 1); }
  UserCache(const UserCache&) = delete;
  UserCache& operator=(const UserCache&) = delete;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(cost_model)

BOOST_AUTO_TEST_CASE(levels_follow_from_expected_errors) {
  using app::Work;
  BOOST_TEST(app::expected_level(Work::plane, 2, 0.1, 6) == 1);
  BOOST_TEST(app::expected_level(Work::plane, 2, 0.0015, 6) == 2);
  BOOST_TEST(app::expected_level(Work::plane, 2, 1e-9, 6) == 6);  // no further than there are levels
  BOOST_TEST(app::expected_level(Work::closed_form, 2, 1e-9, 0) == 0);
  // Cubic elements were not measured, formulas have no level.
  BOOST_TEST(app::expected_error(Work::plane, 3, 2) == app::expected_error(Work::plane, 2, 2));
  BOOST_TEST(std::isnan(app::expected_error(Work::closed_form, 2, 1)));
}

BOOST_AUTO_TEST_CASE(predictions_grow_with_the_work) {
  using app::Work;
  for (const auto work :
       {Work::plane, Work::solid, Work::solid_half, Work::solid_helical, Work::resolved_plane, Work::resolved_solid}) {
    auto size = plane_size();
    size.work = work;
    const auto base = app::predicted_cost(size, 1);
    const auto more = [&](auto change) {
      auto larger = size;
      change(larger);
      return app::predicted_cost(larger, 1);
    };
    BOOST_TEST(more([](auto& s) { s.unknowns *= 2; }).seconds > base.seconds);
    BOOST_TEST(more([](auto& s) { s.supports = 500; }).seconds > base.seconds);
    BOOST_TEST(more([](auto& s) { s.unknowns *= 2; }).peak_MB > base.peak_MB);
    BOOST_TEST(more([](auto& s) { s.levels += 1; }).seconds > base.seconds);
    BOOST_TEST(more([](auto& s) { s.contacts *= 2; }).seconds > base.seconds);
    BOOST_TEST(app::predicted_cost(size, 2).seconds < base.seconds);
    BOOST_TEST(app::predicted_cost(size, 2).seconds > base.seconds / 2.01);
    BOOST_TEST(app::predicted_cost(size, 2).peak_MB > base.peak_MB);
    BOOST_TEST(more([](auto& s) { s.motion_s = 3; }).seconds == base.seconds + 3, boost::test_tools::tolerance(1e-12));
    size.tasks = 1;
    BOOST_TEST(app::predicted_cost(size, 2).seconds == base.seconds);
  }
}

BOOST_AUTO_TEST_CASE(unknowns_are_counted_without_meshing) {
  // Counts of solved meshes, as the solver told them.
  auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  const auto geometry = app::make_geometry(scene);
  const auto counted = [&](app::MeshModel mesh, int degree, int level) {
    mesh.settings.degree = degree;
    mesh.settings.level = level;
    return app::mesh_size(mesh).unknowns;
  };
  const auto sun = app::sun_mesh_model(scene, geometry), ring = app::ring_mesh_model(scene, geometry, 0),
             sleeve = app::ring_mesh_model(scene, geometry, 1), pins = app::ring_mesh_model(scene, geometry, 2);
  // DOFs on held boundaries are not taken off: 3 % in the plane; a solid has more of them, and its sleeve is
  // counted roughly: 8 %.
  const auto plane = boost::test_tools::tolerance(0.03), solid = boost::test_tools::tolerance(0.08);
  BOOST_TEST(counted(sun, 1, 1) == 12924.0, plane);
  BOOST_TEST(counted(sun, 2, 1) == 37560.0, plane);
  BOOST_TEST(counted(sun, 2, 4) == 320912.0, plane);
  BOOST_TEST(counted(sun, 3, 1) == 84132.0, plane);
  BOOST_TEST(counted(ring, 2, 2) == 73200.0, plane);
  BOOST_TEST(counted(pins, 2, 1) == 36794.0, plane);
  BOOST_TEST(counted(sleeve, 2, 1) == 55632.0, solid);
  auto resolved = ring;
  resolved.settings.fidelity = fem::Fidelity::resolved_plane;
  BOOST_TEST(counted(resolved, 2, 2) == 73200.0, plane);
  resolved.settings.fidelity = fem::Fidelity::resolved_solid;
  resolved.settings.symmetry = false;
  BOOST_TEST(counted(resolved, 2, 1) == 64872.0, solid);
  // Half of the face.
  auto half_sun = sun, half_pins = pins;
  half_sun.settings.fidelity = half_pins.settings.fidelity = fem::Fidelity::solid;
  BOOST_CHECK(app::work_of(half_sun) == app::Work::solid_half);
  BOOST_TEST(counted(half_sun, 2, 1) == 25792.0, solid);
  BOOST_TEST(counted(half_sun, 2, 2) == 70376.0, solid);
  BOOST_TEST(counted(half_pins, 2, 1) == 26338.0, solid);
  half_sun.settings.symmetry = false;
  BOOST_CHECK(app::work_of(half_sun) == app::Work::solid);
  BOOST_TEST(counted(half_sun, 2, 1) == 50592.0, solid);
}

BOOST_AUTO_TEST_CASE(the_pace_of_the_machine_is_the_median_of_its_meshes) {
  const test::TemporaryFolder folder("pace");
  const UserCache cache(folder.path() / "cache");
  const auto size = plane_size();
  BOOST_TEST(app::machine_pace() == 1.0);
  app::learn_pace({run_of(size, 3), run_of(size, 3)});
  BOOST_TEST(app::machine_pace() == 1.0);  // two could both be chance
  auto small = size;
  small.unknowns = 10, small.contacts = 1;
  app::learn_pace({run_of(size, 1000), run_of(small, 1e-3), size});  // the lid was closed; too short; not measured
  BOOST_TEST(app::machine_pace() == 3.0, boost::test_tools::tolerance(1e-9));
  for (int i = 0; i < 60; ++i) app::learn_pace({run_of(size, 2)});
  BOOST_TEST(app::machine_pace() == 2.0, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(read_file(folder.path() / "cache" / "pace.json").size() < 2000U);  // the list does not grow for ever
}

BOOST_AUTO_TEST_CASE(the_pace_scales_what_is_shown_and_nothing_that_is_chosen) {
  const test::TemporaryFolder folder("pace_of_plans");
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  const auto plan = app::make_plan(scene, 1);
  const double budget = 1.01 * plan.cost.seconds();
  const double at_worst = plan.cost.at_worst().seconds();  // quadratic elements may follow the linear ones of a sleeve
  BOOST_TEST(at_worst > plan.cost.seconds());
  const auto choice = app::fit_budget(scene, budget, 1);
  {
    const UserCache cache(folder.path());
    app::learn_pace(std::vector<app::CostRun>(3, run_of(plane_size(), 4)));
    const auto slow = app::make_plan(scene, 1);
    BOOST_TEST(slow.cost.seconds() == 4 * plan.cost.seconds(), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(slow.cost.peak_MB() == plan.cost.peak_MB());
    BOOST_TEST(app::to_text(slow).find("Times are 4 times those of the cost laws") != std::string::npos);
    BOOST_TEST(app::fit_budget(scene, budget, 1).sentence == choice.sentence);
    BOOST_TEST(app::fit_budget(scene, budget, 1).scene.accuracy == choice.scene.accuracy);
    BOOST_CHECK_NO_THROW(app::check_limits(scene, {1e6, 1.01 * at_worst}, 1));
  }
  BOOST_CHECK_THROW(app::check_limits(scene, {1e6, 0.99 * at_worst}, 1), SolverError);
}

BOOST_AUTO_TEST_CASE(a_damaged_pace_does_no_harm) {
  const test::TemporaryFolder folder("damaged_pace");
  const auto size = plane_size();
  const UserCache cache(folder.path() / "cache");
  for (const auto* bad : {"", "[1, 2", "{}", "3", "[1, 2, \"x\"]", "[1, 2, -3]", "[1, 2, null]",
                          "\x7f"
                          "ELF"}) {
    write_text(folder.path() / "cache" / "pace.json", bad);
    BOOST_TEST(app::machine_pace() == 1.0, bad);
    app::learn_pace(std::vector<app::CostRun>(3, run_of(size, 2)));  // and begins anew
    BOOST_TEST(app::machine_pace() == 2.0, boost::test_tools::tolerance(1e-9));
  }
  // A folder that cannot be made, or a name that no file system takes: nothing happens.
  write_text(folder.path() / "plain_file", "x");
  for (const auto& place :
       {(folder.path() / "plain_file" / "deeper").string(), std::string(5000, 'x'), std::string()}) {
    const UserCache nowhere(place);
    app::learn_pace(std::vector<app::CostRun>(3, run_of(size, 2)));
    BOOST_TEST(app::machine_pace() == 1.0);
  }
}

BOOST_AUTO_TEST_CASE(time_left_moves_from_the_prediction_to_the_measured_pace) {
  BOOST_TEST(std::isnan(app::time_left(0, 1, 0)));
  BOOST_TEST(app::time_left(0, 0, 10) == 10.0);
  BOOST_TEST(app::time_left(0, 4, 10) == 6.0);
  BOOST_TEST(app::time_left(0, 40, 10) == 0.0);
  BOOST_TEST(app::time_left(0.25, 5, 0) == 15.0);
  // A quarter took 5 s: 15 s by that pace, 5 s by the prediction; a quarter of one and three of the other.
  BOOST_TEST(app::time_left(0.25, 5, 10) == 0.25 * 15 + 0.75 * 5);
  BOOST_TEST(app::time_left(1, 12, 10) == 0.0);
  BOOST_TEST(app::time_left(0.5, 3, std::nan("")) == 3.0);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
