#include "app/mesh_result.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/app/scenes.h"

namespace annulus {

namespace {

/// A model of the ring paper's traditional ring, and a made-up solution of it.
app::MeshModel some_model() {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  return app::ring_mesh_model(scene, app::make_geometry(scene), 0);
}

app::MeshResult some_result() {
  const auto model = some_model();
  const auto& loads = model.problem->loads;
  std::vector<StiffnessEntry> entries;
  for (int phase = 0; phase < 2; ++phase) {
    for (const double load : loads) {
      const double k = phase == 0 ? 1e9 : 2e9;
      entries.push_back({.unloaded_te = 1e-6,
                         .lte = 1e-6 + load / k,
                         .stiffness_secant = k,
                         .stiffness_tangent = k,
                         .error_relative = 0.01});
    }
  }
  app::MeshResult result{
      .model = model, .contact_ratio = 1.58, .table = StiffnessTable("ring_planet", 2, {0.0}, loads, entries)};
  result.table.provenance = {{"inputs_id", model.id()}};
  result.positions.columns = {"mesh_phase", "pair1_roll_mm"};
  result.positions.rows = {{0.0, 12.5}, {0.5, std::nan("")}};
  result.pins.columns = {"pin"};
  result.pins.rows = {{1.0}};
  result.picture = "<svg/>";
  result.facts = {{"max_penetration_m", 1e-12}, {"unknowns", 1234}};
  result.nominal = app::nominal_load_index;
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(mesh_result)

BOOST_AUTO_TEST_CASE(figures) {
  const auto result = some_result();
  const double load = result.model.problem->loads[app::nominal_load_index];
  // Sums of two numbers: a few roundings.
  const auto tolerance = boost::test_tools::tolerance(1e-14);
  BOOST_TEST(result.mean_stiffness().value == 1.5e9, tolerance);
  BOOST_TEST(result.mean_stiffness().error_relative == 0.01, tolerance);
  BOOST_TEST(result.lte_mean().value == 1e-6 + load * 0.75e-9, tolerance);
  BOOST_TEST(result.lte_peak_to_peak().value == load * 0.5e-9, boost::test_tools::tolerance(1e-10));  // a difference
  BOOST_TEST(result.lte_peak_to_peak().error_relative == 0.01, boost::test_tools::tolerance(1e-10));
  BOOST_TEST(std::isnan(result.fact("no such fact")));
}

BOOST_AUTO_TEST_CASE(survives_the_round_trip_through_files) {
  const test::TemporaryFolder folder("mesh_result");
  const auto result = some_result();
  app::save(result, folder.path());
  const auto kept = app::load(result.model, folder.path());
  BOOST_TEST_REQUIRE(kept.has_value());
  BOOST_TEST(kept->reused);
  BOOST_TEST(kept->contact_ratio == result.contact_ratio);
  BOOST_TEST(kept->mean_stiffness().value == result.mean_stiffness().value);
  BOOST_TEST(kept->positions.rows.at(0).at(1) == 12.5);
  BOOST_TEST(std::isnan(kept->positions.rows.at(1).at(1)));
  BOOST_TEST(kept->pins.rows.size() == 1U);
  BOOST_TEST(kept->fact("unknowns") == 1234);
  BOOST_TEST(kept->picture == result.picture);
}

BOOST_AUTO_TEST_CASE(is_not_reused_for_other_inputs_or_when_damaged) {
  const test::TemporaryFolder folder("mesh_result_other");
  auto result = some_result();
  app::save(result, folder.path());
  auto other = result.model;
  other.problem->face_width *= 1.001;
  BOOST_TEST(!app::load(other, folder.path()).has_value());
  write_file(folder.path() / "lte_ring_planet.csv", "not a table");
  BOOST_TEST(!app::load(result.model, folder.path()).has_value());
  std::filesystem::remove(folder.path() / "lte_ring_planet.csv");
  BOOST_TEST(!app::load(result.model, folder.path()).has_value());
}

BOOST_AUTO_TEST_CASE(given_waves_are_sampled) {
  const auto scene = app::parse_scene(test::quick_scene(), "s");
  const auto geometry = app::make_geometry(scene);
  const auto model = app::sun_mesh_model(scene, geometry);
  auto input = scene.sun_planet;
  const auto harmonic = app::given_stiffness(model, input, scene, 1.5, 1e4);
  // The mean of a cosine over equidistant samples of its period vanishes to rounding.
  BOOST_TEST(harmonic.mean_stiffness().value == 1.364e9, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(harmonic.table.at(0, 0, 0).stiffness_secant == 1.364e9 * 1.2258, boost::test_tools::tolerance(1e-14));
  input.stiffness = app::StiffnessShape::rectangular;
  input.duty = 0.5;
  const auto rectangular = app::given_stiffness(model, input, scene, 1.5, 1e4);
  BOOST_TEST(rectangular.mean_stiffness().value == 1.364e9, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
