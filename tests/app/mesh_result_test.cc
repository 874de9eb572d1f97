#include "app/model/mesh_result.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "app/model/mesh_figures.h"
#include "app/run/pipeline.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/files.h"
#include "core/log.h"
#include "core/result_store.h"
#include "tests/app/made_up_solution.h"
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
  result.nominal = fem::nominal_load_index;
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(mesh_result)

BOOST_AUTO_TEST_CASE(a_mean_knows_what_lies_between_its_positions) {
  // A stiffness that jumps twice, as that of tooth formulas does: its mean is known, wherever the jumps fall.
  const auto model = some_model();
  const auto& loads = model.problem->loads;
  constexpr double low = 1e9, high = 1.6e9;
  int covered = 0, tried = 0;
  for (const int phases : {8, 12, 16, 32})
    for (double duty = 0.11; duty < 0.9; duty += 0.0317, ++tried) {
      std::vector<StiffnessEntry> entries;
      for (int phase = 0; phase < phases; ++phase)
        for (const double load : loads) {
          const double k = static_cast<double>(phase) / phases < duty ? high : low;
          entries.push_back({0, load / k, k, k, 0});
        }
      app::MeshResult result{.model = model, .table = StiffnessTable("ring_planet", phases, {0.0}, loads, entries)};
      result.nominal = fem::nominal_load_index;
      const auto mean = result.mean_stiffness();
      const double exact = low + duty * (high - low);
      BOOST_TEST(mean.error_relative == mean.parts.interpolation);
      covered += std::abs(mean.value - exact) <= mean.error_relative * mean.value;
      // No more than a jump at one position may change.
      BOOST_TEST(mean.error_relative * mean.value <= 2 * (high - low) / phases);
      result.tabulated = false;
      BOOST_TEST(result.mean_stiffness().error_relative == 0.0);
    }
  BOOST_TEST(covered == tried);
}

BOOST_AUTO_TEST_CASE(a_range_knows_what_lies_between_its_positions) {
  // A saw with its kinks between the positions: from 0 at phase 0.05 up to 1 at 0.55, down again. The sampled range is
  // too small by what its error says, to the last bit for straight flanks.
  const auto model = some_model();
  const auto entry = [](double lte, double load) { return StiffnessEntry{0, lte, load / lte, load / lte, 0}; };
  const auto ranged = [&](int phases, const auto& shape) {
    std::vector<StiffnessEntry> entries;
    for (int i = 0; i < phases; ++i) {
      for (std::size_t load = 0; load < model.problem->loads.size(); ++load)
        entries.push_back(entry(shape(static_cast<double>(i) / phases), model.problem->loads[load]));
    }
    app::MeshResult result{.model = model,
                           .contact_ratio = 1.58,
                           .table = StiffnessTable("ring_planet", phases, {0.0}, model.problem->loads, entries)};
    result.nominal = model.nominal_load();
    return result.lte_peak_to_peak();
  };
  const auto saw = [](double phase) {
    const double x = phase - 0.05 - std::floor(phase - 0.05);
    return x < 0.5 ? 1 + 2 * x : 3 - 2 * x;
  };
  for (const int phases : {8, 16, 32}) {
    const auto range = ranged(phases, saw);
    BOOST_TEST(range.value < 1);
    BOOST_TEST(range.value * (1 + range.error_relative) == 1, boost::test_tools::tolerance(1e-10));
  }
  // The same of the stiffness, whose mean is known to its own error.
  for (const int phases : {8, 16, 32}) {
    std::vector<StiffnessEntry> entries;
    for (int i = 0; i < phases; ++i)
      for (const double load : model.problem->loads) {
        const double k = 1e9 * saw(static_cast<double>(i) / phases);
        entries.push_back({0, load / k, k, k, 0});
      }
    app::MeshResult result{.model = model,
                           .contact_ratio = 1.58,
                           .table = StiffnessTable("ring_planet", phases, {0.0}, model.problem->loads, entries)};
    result.nominal = model.nominal_load();
    const auto ripple = result.stiffness_ripple(), mean = result.mean_stiffness();
    BOOST_TEST(ripple.value * mean.value < 1e9);
    BOOST_TEST(ripple.value * (1 + ripple.error_relative) * mean.value == 1e9, boost::test_tools::tolerance(1e-10));
  }
  // A branch that rises up to a jump: the range is known as well as its slope, wherever the jump falls.
  for (const double jump : {0.3, 0.41, 0.77}) {
    const auto range = ranged(16, [jump](double phase) { return 1 + phase - jump - std::floor(phase - jump); });
    BOOST_TEST(range.value < 1);
    BOOST_TEST(range.value * (1 + range.error_relative) >= 1);
    BOOST_TEST(range.value * (1 + range.error_relative) <= 1 + 2.0 / 16);
  }
  // A smooth top: on the safe side, and of second order.
  const auto wave = [](double phase) { return 2 + 0.5 * std::cos(2 * M_PI * (phase - 0.013)); };
  const auto coarse = ranged(16, wave), fine = ranged(32, wave);
  BOOST_TEST(coarse.value * (1 + coarse.error_relative) >= 1);
  BOOST_TEST(fine.value * (1 + fine.error_relative) >= 1);
  BOOST_TEST(fine.error_relative <= coarse.error_relative / 2.5);
}

BOOST_AUTO_TEST_CASE(figures) {
  const auto result = some_result();
  const double load = result.model.problem->loads[fem::nominal_load_index];
  // Sums of two numbers: a few roundings.
  const auto tolerance = boost::test_tools::tolerance(1e-14);
  BOOST_TEST(result.mean_stiffness().value == 1.5e9, tolerance);
  BOOST_TEST(result.mean_stiffness().error_relative - result.mean_stiffness().parts.interpolation == 0.01, tolerance);
  BOOST_TEST(result.lte_mean().value == 1e-6 + load * 0.75e-9, tolerance);
  BOOST_TEST(result.lte_peak_to_peak().value == load * 0.5e-9, boost::test_tools::tolerance(1e-10));  // a difference
  BOOST_TEST(result.lte_peak_to_peak().error_relative == 0.01, boost::test_tools::tolerance(1e-10));
  BOOST_TEST(std::isnan(result.fact("no such fact")));
}

BOOST_AUTO_TEST_CASE(survives_the_round_trip_through_bytes) {
  const auto result = some_result();
  const auto kept = from_bytes<app::MeshResult>(to_bytes(result));
  BOOST_TEST(kept.contact_ratio == result.contact_ratio);
  BOOST_TEST(kept.mean_stiffness().value == result.mean_stiffness().value);
  BOOST_TEST(kept.positions.rows.at(0).at(1) == 12.5);
  BOOST_TEST(std::isnan(kept.positions.rows.at(1).at(1)));
  BOOST_TEST(kept.pins.rows.size() == 1U);
  BOOST_TEST(kept.fact("unknowns") == 1234);
  BOOST_TEST(kept.picture == result.picture);
}

BOOST_AUTO_TEST_CASE(everything_known_is_kept) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/misaligned_set.toml");
  const auto geometry = app::make_geometry(scene);
  auto model = app::ring_mesh_model(scene, geometry, 1);
  model.problem->phases = 4;
  auto solved = test::made_up_solution(model);
  solved.face_load_factor_error = 0.03;
  auto result = app::pack(model, solved);
  result.picture = "<svg/>";
  BOOST_TEST(result.positions.columns.size() == result.positions.rows.front().size());
  const auto check_peaks = [](const app::MeshResult& r) {
    const auto tolerance = boost::test_tools::tolerance(1e-12);
    BOOST_TEST_REQUIRE(r.peak("face_load_factor").has_value());
    BOOST_TEST(r.peak("face_load_factor")->value == 1.5, tolerance);
    BOOST_TEST(r.peak("face_load_factor")->at.mesh_phase == 0.0);
    BOOST_TEST(r.face_load_factor()->value == 1.5, tolerance);
    BOOST_TEST(r.face_load_factor()->parts.discretisation == 0.03 / 1.5, tolerance);
    BOOST_TEST(r.face_load_factor()->error_relative >= 0.03 / 1.5);
    BOOST_TEST(r.peak("planet_root_tension_MPa")->value == 150, tolerance);
    BOOST_TEST(r.peak("planet_root_compression_MPa")->value == -180, tolerance);  // by magnitude, with its sign
    BOOST_TEST(r.peak("ring_rim_von_mises_MPa")->value == 50, tolerance);
    BOOST_TEST(!r.peak("no such column").has_value());
    BOOST_TEST(!r.peak("sun_root_tension_MPa").has_value());
  };
  check_peaks(result);
  BOOST_TEST(result.line_load.rows.size() == 4U * 12);
  BOOST_TEST(result.pressure.rows.size() == 4U * 12 * 2 * 12);
  // Line load times slice width adds up to the load; half a unit of six digits.
  double force = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const auto& row = result.line_load.rows[i];
    force += row[4] * (row[3] - row[2]);
  }
  BOOST_TEST(force == model.problem->loads[fem::nominal_load_index], boost::test_tools::tolerance(5e-6));

  const test::TemporaryFolder folder("everything");
  app::save(result, folder.path());
  const auto kept = from_bytes<app::MeshResult>(to_bytes(result));
  check_peaks(kept);
  for (const auto& [name, table] : app::side_tables) {
    BOOST_TEST((kept.*table).rows.size() == (result.*table).rows.size(), name);
    BOOST_TEST(std::filesystem::exists(folder.path() / (std::string(name) + "_ring_planet.csv")) ==
                   !(result.*table).rows.empty(),
               name);
  }
  BOOST_TEST((kept.stress.header == result.stress.header));
  BOOST_TEST(kept.stress.header.at(1).second == "ring root");
  // Tables and figures have the names of the bodies in common.
  auto named = model;
  named.pinion_body = "pinion";
  named.wheel_body = "wheel";
  const auto pair = app::pack(named, test::made_up_solution(named));
  BOOST_TEST_REQUIRE(pair.peak("pinion_root_tension_MPa").has_value());
  BOOST_TEST(app::mesh_figures(pair).value("ring_planet_pinion_root_tension_Pa") == 150e6,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(pair.stress.header.at(0).second == "pinion root");
  BOOST_TEST(pair.stress.header.at(1).second == "wheel root");
  // A later result without these tables leaves none behind.
  for (const auto& [name, table] : app::side_tables) (result.*table).rows.clear();
  app::save(result, folder.path());
  BOOST_TEST(!std::filesystem::exists(folder.path() / "pressure_ring_planet.csv"));
}

BOOST_AUTO_TEST_CASE(pins_and_splines_carry_their_angle) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_structures.toml");
  const auto run = test::made_up_run(scene, 2);
  const auto angle = [&](const std::string& ring, std::size_t row) {
    for (const auto& r : run.rings) {
      if (r.name == ring) return r.mesh.pins.rows.at(row)[r.mesh.pins.column("pin_angle_deg")];
    }
    throw std::logic_error(ring);
  };
  const auto tolerance = boost::test_tools::tolerance(1e-5);  // digits of the table
  BOOST_TEST(angle("irregular-pins", 2) == 31, tolerance);
  BOOST_TEST(angle("splined", 1) == 360.0 / 54, tolerance);
  BOOST_TEST(angle("one-pin", 5) == 0, tolerance);
  for (const auto& ring : run.rings) {
    BOOST_TEST(ring.mesh.line_load.rows.empty() == (ring.mesh.model.fidelity == "plane"), ring.name);
    BOOST_TEST(ring.mesh.peak("face_load_factor").has_value() == (ring.mesh.model.fidelity == "solid"), ring.name);
  }
}

BOOST_AUTO_TEST_CASE(a_closed_form_has_no_mesh) {
  auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  scene.fidelity = app::Fidelity::closed_form;
  const auto model = app::ring_mesh_model(scene, app::make_geometry(scene), 0);
  const auto result = app::pack(model, fem::solve_loaded_mesh(*model.problem, model.settings));
  BOOST_TEST(result.picture.empty());
  BOOST_TEST(result.mean_stiffness().error_relative > 0.02);  // an estimate of its own, not of a discretisation
}

BOOST_AUTO_TEST_CASE(files_are_those_of_the_inputs_whatever_happened_to_them) {
  const test::TemporaryFolder folder("mesh_result_other"), elsewhere("mesh_result_elsewhere");
  log::set_level(log::Level::quiet);
  auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  scene.fidelity = app::Fidelity::closed_form;
  const auto geometry = app::make_geometry(scene);
  const auto model = app::ring_mesh_model(scene, geometry, 0);
  const auto options = app::with_reuse({.out = folder.path() / "out", .cache = folder.path() / "cache"});
  const auto first = app::computed_stiffness(model, "", options);
  BOOST_TEST(!first.reused);
  const auto table = folder.path() / "out" / "lte_ring_planet.csv";
  const auto right = read_file(table);
  for (const auto* wrong : {"not a table", ""}) {
    write_file(table, wrong);
    BOOST_TEST(app::computed_stiffness(model, "", options).reused);
    BOOST_TEST(read_file(table) == right);
  }
  // A table of the results of another mesh.
  write_file(folder.path() / "out" / "pins_ring_planet.csv", right);
  BOOST_TEST(app::computed_stiffness(model, "", options).pins.rows.empty());
  auto other = model;
  other.problem->face_width *= 1.001;
  BOOST_TEST(!app::computed_stiffness(other, "", options).reused);
  // The cache serves another folder of results, but no other program.
  const auto shared = app::with_reuse({.out = elsewhere.path(), .cache = folder.path() / "cache"});
  BOOST_TEST(app::computed_stiffness(model, "", shared).reused);
  BOOST_TEST(read_file(elsewhere.path() / "lte_ring_planet.csv") == right);
  auto foreign = shared;
  foreign.store = std::make_shared<ResultStore>(folder.path() / "cache", "another program");
  BOOST_TEST(!app::computed_stiffness(model, "", foreign).reused);
}

BOOST_AUTO_TEST_CASE(prescribed_waves_are_sampled) {
  const auto scene = app::parse_scene(test::quick_scene(), "s");
  const auto geometry = app::make_geometry(scene);
  const auto model = app::sun_mesh_model(scene, geometry);
  auto input = sun_and_planets(scene).sun_planet;
  const auto harmonic = app::prescribed_stiffness(model, input, scene, 1.5, 1e4);
  // The mean of a cosine over equidistant samples of its period vanishes to rounding.
  BOOST_TEST(harmonic.mean_stiffness().value == 1.364e9, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(harmonic.table.at(0, 0, 0).stiffness_secant == 1.364e9 * 1.2258, boost::test_tools::tolerance(1e-14));
  input.stiffness = app::StiffnessShape::rectangular;
  input.duty = 0.5;
  const auto rectangular = app::prescribed_stiffness(model, input, scene, 1.5, 1e4);
  BOOST_TEST(rectangular.mean_stiffness().value == 1.364e9, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
