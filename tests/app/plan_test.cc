#include "app/plan/plan.h"
#include "app/model/gear_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <ctime>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>

#include "app/plan/cost_plan.h"
#include "app/scene/overrides.h"
#include "app/study/studies.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/stopwatch.h"
#include "core/units.h"
#include "fem/loaded_mesh.h"
#include "tests/app/fault_scenes.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

app::Plan plan_of(const std::string& text) {
  const auto scene = app::parse_scene(text, "scene.toml");
  return app::make_plan(scene);
}

nlohmann::json ring_types() {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  return nlohmann::json(app::to_json(app::make_plan(scene)));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(plan)

BOOST_AUTO_TEST_CASE(operating_point_of_the_ring_paper) {
  const auto json = ring_types();
  const auto& stage = json["stage"];
  // By hand from tables 1 and 2 of the ring paper; the tolerance is half a unit of the last digit given there.
  BOOST_TEST(stage["carrier_speed_rpm"].get<double>() == 1128.0 * 48 / (48 + 162), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::abs(stage["sun_torque_N_m"].get<double>() - 25048) < 0.5);
  BOOST_TEST(std::abs(stage["mesh_frequency_Hz"].get<double>() - 696.1) < 0.05);
  BOOST_TEST(std::abs(stage["mean_mesh_force_kN"].get<double>() - 59.46) < 0.005);
  BOOST_TEST(std::abs(stage["sun_mesh_working_pressure_angle_deg"].get<double>() - 25.905148) < 5e-7);
  BOOST_TEST(std::abs(json["rings"]["pinned"]["ring_mesh_working_pressure_angle_deg"].get<double>() - 20.860323) <
             5e-7);
}

BOOST_AUTO_TEST_CASE(carrier_speed_gives_the_same_operating_point) {
  const auto by_sun = app::make_geometry(app::parse_scene(test::quick_scene(), "s"));
  const auto text =
      test::replaced(test::quick_scene(), "sun_speed_rpm = 1128", "carrier_speed_rpm = 257.82857142857142");
  const auto by_carrier = app::make_geometry(app::parse_scene(text, "s"));
  // Both go through the same handful of products; the decimal speed carries its own rounding.
  BOOST_TEST(by_sun.operating_point.sun_torque == by_carrier.operating_point.sun_torque,
             boost::test_tools::tolerance(1e-14));
  BOOST_TEST(by_sun.operating_point.mesh_frequency == by_carrier.operating_point.mesh_frequency,
             boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(rungs_and_positions) {
  const auto json = ring_types();
  const auto& meshes = json["meshes"];
  BOOST_TEST_REQUIRE(meshes.size() == 4U);
  BOOST_TEST(meshes[0]["mesh"] == "sun_planet");
  BOOST_TEST(meshes[0]["model"] == "plane");
  BOOST_TEST(meshes[1]["model"] == "plane");  // traditional
  BOOST_TEST(meshes[2]["model"] == "solid");  // thin-walled
  BOOST_TEST(meshes[3]["model"] == "plane");  // pinned
  BOOST_TEST(meshes[1]["ring_positions"] == 1);
  BOOST_TEST(meshes[3]["ring_positions"] == 27);  // 162 / gcd(162, 24)
  for (const auto& mesh : meshes) BOOST_TEST(!mesh["reason"].get<std::string>().empty());
  // The nominal load is among the tabulated ones, with others on both sides.
  const double nominal = 1e3 * json["stage"]["mean_mesh_force_kN"].get<double>();
  BOOST_TEST(meshes[0]["loads_N"][fem::nominal_load_index].get<double>() == nominal,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(the_accuracy_decides_how_finely_tables_are_resolved) {
  const std::string text = read_file(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  int phases = 0;
  for (const auto& [accuracy, loads] : {std::pair{"0.1", 3U}, {"0.03", 3U}, {"0.01", 5U}, {"0.001", 5U}}) {
    const auto changed = test::replaced(text, "accuracy = 0.01", std::string("accuracy = ") + accuracy);
    const auto scene = app::parse_scene(changed, std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
    const auto plan = app::make_plan(scene);
    for (const auto& mesh : plan.meshes) {
      BOOST_TEST(mesh.problem->loads.size() == loads);
      BOOST_TEST(mesh.problem->phases >= phases);
      BOOST_TEST(mesh.problem->phases % 2 == 0);  // every second one tells the error of interpolation
      BOOST_TEST(mesh.problem->loads[mesh.nominal_load()] == 59.46e3, boost::test_tools::tolerance(1e-3));
    }
    phases = plan.meshes.front().problem->phases;
    BOOST_TEST(app::to_text(plan).find(plan.meshes.front().phases) != std::string::npos);
  }
  BOOST_TEST(phases == 256);
  // A light load is taken up within a short way, which the positions must not step over: root of the deflection.
  BOOST_TEST(fem::load_uptake(4 * 140.0, 0.1, 0.004, 206e9) == 2 * fem::load_uptake(140.0, 0.1, 0.004, 206e9));
  BOOST_TEST(fem::load_uptake(140e3, 0.01, 0.001, 206e9) == 1.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(fem::table_resolution(0.1, 1.0 / 32, 0).phases == 32);
  BOOST_TEST(fem::table_resolution(0.1, 1.0 / 33, 0).phases == 64);
  BOOST_TEST(fem::table_resolution(0.2, 1e-9, 0).phases == 128);
  BOOST_TEST(fem::table_resolution(0.03, 1.0 / 64, 0).phases == 64);
  BOOST_TEST(fem::table_resolution(0.03, 1.0 / 65, 0.9).phases == 128);
  BOOST_TEST(fem::table_resolution(0.01, 1.0 / 65, 0).phases == 128);
  BOOST_TEST(fem::table_resolution(0.01, 1e-9, 0).phases == 256);
  BOOST_TEST(fem::table_resolution(0.005, 1.0 / 65, 0).phases == 128);
  BOOST_TEST(fem::table_resolution(0.003, 1.0 / 64, 0).phases == 256);
  BOOST_TEST(fem::table_resolution(0.01, 1e-9, 1).phases == 32);  // helical teeth
  BOOST_TEST(fem::table_resolution(0.003, 1.0 / 64, 1).phases == 64);
}

BOOST_AUTO_TEST_CASE(solid_meshes_tell_what_of_the_face_they_solve) {
  const std::string file = std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml";
  const std::string text = read_file(file);
  const auto planned = [&](const std::string& more, const std::string& error = "") {
    auto changed = test::replaced(text, "accuracy = 0.01", "accuracy = 0.01\n" + more);
    changed = test::replaced(changed, "[errors]", "[errors]\n" + error);
    const auto scene = app::parse_scene(changed, file);
    return app::make_plan(scene);
  };
  const auto symmetry = [](const app::MeshModel& mesh) -> app::Decision {
    for (const auto& d : app::decisions(mesh))
      if (d.subject == "symmetry") return d;
    return {"", "nothing", ""};
  };
  const auto usual = planned("");
  BOOST_TEST(symmetry(usual.meshes[0]).choice == "nothing");  // a plane has no face
  BOOST_TEST(symmetry(usual.meshes[2]).choice == "whole face");
  BOOST_TEST(symmetry(usual.meshes[2]).reason == "fixed at one end face");
  const auto solid = planned("model = \"solid\"");
  for (const std::size_t mesh : {0U, 1U, 3U}) {  // sun, traditional, pinned
    BOOST_TEST(symmetry(solid.meshes[mesh]).choice == "half of the face");
    BOOST_TEST(symmetry(solid.meshes[mesh]).reason.find("symmetric about") != std::string::npos);
  }
  BOOST_TEST(app::to_text(solid).find("half of the face") != std::string::npos);
  BOOST_TEST(text_of(app::to_json(solid)).find("\"half of the face\"") != std::string::npos);
  const auto misaligned = planned("model = \"solid\"", "sun_planet_misalignment_um = 5");
  BOOST_TEST(symmetry(misaligned.meshes[0]).reason == "misaligned flanks");
  BOOST_TEST(symmetry(misaligned.meshes[1]).choice == "half of the face");

  // The cost counts what is solved.
  auto half_face = solid.meshes[1], whole = half_face;
  half_face.settings.degree = whole.settings.degree = 2;
  whole.settings.symmetry = false;
  BOOST_TEST(symmetry(whole).choice == "whole face");
  const auto half_size = app::mesh_size(half_face), whole_size = app::mesh_size(whole);
  // Of 8 quadratic cells: 9 of 17 layers of nodes, the last one without axial DOFs.
  BOOST_TEST(half_size.unknowns / whole_size.unknowns == 26.0 / 51, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(app::processor_seconds(half_size) < app::processor_seconds(whole_size));
}

BOOST_AUTO_TEST_CASE(more_than_the_finest_solid_gives_is_told_beforehand) {
  const std::string text = read_file(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/helical_set.toml");
  const auto cost_of = [&](double accuracy) {
    const auto scene = app::with_accuracy(app::parse_scene(text, "scene.toml"), accuracy, "asked here");
    return app::to_text(app::make_plan(scene));
  };
  BOOST_TEST(cost_of(0.02).find("the run may be refused") == std::string::npos);
  BOOST_TEST(cost_of(0.002).find("more than the wanted 0.2 %; the run may be refused at its end") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_accuracy_decides_fidelity_elements_and_motion) {
  const std::string text = read_file(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  const auto planned = [&](const std::string& top) {
    const auto scene = app::parse_scene(test::replaced(text, "accuracy = 0.01", top),
                                        std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
    return app::make_plan(scene);
  };
  const auto decided = [](const std::vector<app::Decision>& list, const std::string& what) {
    for (const auto& d : list) {
      BOOST_TEST(!d.reason.empty(), d.subject);
      if (d.subject == what) return d.choice;
    }
    return std::string("nothing");
  };
  const auto coupled = [](const app::Plan& plan) {
    const auto& steps = plan.cost.steps;
    return std::any_of(steps.begin(), steps.end(), [&](const auto& s) {
      return s.kind == app::CostKind::coupling && s.variant == plan.meshes[3].variant;
    });
  };
  // Formulas where their error is within the accuracy; the thin-walled ring needs a solid. How planets act on each
  // other through the pinned ring takes elements, which counts below 10 %.
  const auto rough = planned("accuracy = 0.1");
  BOOST_TEST(rough.meshes[0].fidelity == "closed_form");
  BOOST_TEST(rough.meshes[1].fidelity == "closed_form");
  BOOST_TEST(rough.meshes[2].fidelity == "solid");
  BOOST_TEST(rough.meshes[3].fidelity == "closed_form");
  BOOST_TEST(!coupled(rough));
  const double held = fem::closed_form_error(*rough.meshes[1].problem);
  const double pinned = fem::closed_form_error(*rough.meshes[3].problem);
  BOOST_TEST(held == fem::least_closed_form_error);
  BOOST_TEST(pinned > held);
  BOOST_TEST(decided(app::decisions(rough.meshes[0]), "elements") == "nothing");
  const auto enough = planned(fmt::format("accuracy = {}", 1.02 * pinned));
  BOOST_TEST(enough.meshes[3].fidelity == "closed_form");
  BOOST_TEST(coupled(enough));
  const auto less_rough = planned(fmt::format("accuracy = {}", 0.98 * pinned));
  BOOST_TEST(less_rough.meshes[0].fidelity == "closed_form");
  BOOST_TEST(less_rough.meshes[3].fidelity == "plane");
  BOOST_TEST(coupled(less_rough));
  BOOST_TEST(decided(app::decisions(less_rough.meshes[3]), "elements") == "linear");
  BOOST_TEST(decided(rough.motion, "confirmation") == "where needed");
  BOOST_TEST(decided(rough.motion, "tolerance") == "1e-04");
  // No model but the one the scene asks for.
  BOOST_TEST(planned("accuracy = 0.1\nmodel = \"solid\"").meshes[0].fidelity == "solid");
  const auto usual = planned("accuracy = 0.01");
  for (const auto& mesh : usual.meshes) {
    BOOST_TEST(mesh.fidelity != "closed_form");
    // Linear ones meet 1 % where no edges of supports nor solids are in the way.
    const bool linear = mesh.variant.empty() || mesh.variant == rough.meshes[1].variant;
    BOOST_TEST(decided(app::decisions(mesh), "elements") == (linear ? "linear" : "quadratic"));
    BOOST_TEST(decided(app::decisions(mesh), "refinement") == "until 1 %");
    BOOST_TEST(decided(app::decisions(mesh), "positions per mesh cycle") == "128");
  }
  BOOST_TEST(decided(usual.motion, "confirmation") == "by time integration");
  BOOST_TEST(decided(usual.motion, "tolerance") == "1e-05");
  // The same in the text and in JSON.
  const auto json = nlohmann::json(app::to_json(usual));
  const auto shown = app::to_text(usual);
  for (const auto& mesh : json["meshes"]) {
    BOOST_TEST(mesh["decisions"].size() >= 8U);
    for (const auto& d : mesh["decisions"])
      BOOST_TEST(shown.find(d["reason"].get<std::string>()) != std::string::npos, d["reason"]);
  }
  BOOST_TEST(json["motion"].size() == usual.motion.size());
}

BOOST_AUTO_TEST_CASE(structures_their_fidelity_and_why) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_structures.toml");
  const auto plan = app::make_plan(scene);
  const auto mesh = [&](const std::string& ring) {
    for (const auto& m : plan.meshes) {
      if (m.variant == ring) return m;
    }
    throw std::logic_error(ring);
  };
  const auto check = [&](const std::string& ring, const std::string& fidelity, int positions, const std::string& word) {
    const auto m = mesh(ring);
    BOOST_TEST(m.fidelity == fidelity, ring);
    BOOST_TEST(m.positions == positions, ring << ": " << m.positions);
    BOOST_TEST(m.reason.find(word) != std::string::npos, m.reason);
  };
  check("traditional", "plane", 1, "fixed over the full width");
  check("flange", "solid", 1, "flange");
  check("thin-walled", "solid", 1, "one end face");
  check("thin-walled-hoop", "solid", 1, "hoop");
  check("clamped", "solid", 1, "clamped at both end faces");
  check("pins24", "plane", 27, "pins");
  check("bolts24", "plane", 27, "bolts");
  check("irregular-pins", "plane", 54, "pins");  // a third of 162
  check("one-pin", "plane", 162, "pins");
  check("splined", "plane", 3, "splines");  // 162 / gcd(162, 54)
  const auto text = app::to_text(plan);
  BOOST_TEST(text.find("Ring 'one-pin' has a single pin") != std::string::npos);
  BOOST_TEST(text.find("radial play of 30 µm (housing_clearance_um)") != std::string::npos);
  BOOST_TEST(text.find("ring.pin_free_span_mm") != std::string::npos);
  BOOST_TEST(text.find("162 teeth on 24 supports at given angles: the ring repeats after 54 teeth") !=
             std::string::npos);

  const auto structure = [&](const std::string& ring) { return mesh(ring).problem->structure; };
  const auto flange = *structure("flange").as<fem::FlangeHeld>();
  BOOST_TEST(flange.outside_radius == 0.37, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(structure("thin-walled-hoop").as<fem::EndFaceHeld>()->hoop.has_value());
  BOOST_TEST(!structure("thin-walled").as<fem::EndFaceHeld>()->hoop.has_value());
  const auto pin = *structure("one-pin").as<fem::PinHeld>();
  BOOST_TEST(*pin.housing_clearance == 30e-6, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(!structure("bolts24").as<fem::PinHeld>()->unilateral);
  const auto spline = *structure("splined").as<fem::SplineHeld>();
  BOOST_TEST(spline.teeth == 54);
  const auto clamped = *structure("clamped").as<fem::Clamped>();
  BOOST_TEST(clamped.inner_radius == 0.32, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(clamped.bolts == 36);
  BOOST_TEST(spline.clearance == 5e-6, boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(misalignment_and_lead_need_solids) {
  auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/misaligned_set.toml");
  const auto geometry = app::make_geometry(scene);
  const auto sun = app::sun_mesh_model(scene, geometry), ring = app::ring_mesh_model(scene, geometry, 0);
  for (const auto* mesh : {&sun, &ring}) {
    BOOST_TEST(mesh->fidelity == "solid");
    BOOST_TEST(mesh->reason.find("lead of the planet is modified") != std::string::npos, mesh->reason);
    BOOST_TEST(mesh->reason.find("misaligned") != std::string::npos, mesh->reason);
    BOOST_TEST(mesh->problem->pair.pinion().parameters().lead_crowning == 8e-6, boost::test_tools::tolerance(1e-15));
  }
  BOOST_TEST(sun.problem->misalignment == 10e-6, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(ring.problem->misalignment == 20e-6, boost::test_tools::tolerance(1e-15));
  scene.stage.helix_angle = 0.2;
  BOOST_TEST(app::solid_reason(scene).find("helical") == 0U);
  const auto sloped = app::ring_mesh_model(scene, geometry, 2);
  BOOST_TEST(sloped.problem->pair.wheel().parameters().lead_slope == -20e-6, boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(helical_sets_are_solid) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/helical_set.toml");
  const auto geometry = app::make_geometry(scene);
  const double beta = 12 * units::deg;
  for (const auto& mesh : {app::sun_mesh_model(scene, geometry), app::ring_mesh_model(scene, geometry, 0)}) {
    BOOST_TEST(mesh.fidelity == "solid");
    BOOST_TEST(mesh.reason.find("helical") != std::string::npos, mesh.reason);
    const auto &planet = mesh.problem->pair.pinion(), &wheel = mesh.problem->pair.wheel();
    BOOST_TEST(planet.helix_angle() == beta, boost::test_tools::tolerance(1e-15));
    BOOST_TEST(wheel.helix_angle() == (mesh.problem->pair.internal() ? beta : -beta),
               boost::test_tools::tolerance(1e-15));
  }
}

BOOST_AUTO_TEST_CASE(linear_helical_solids_do_down_to_three_per_cent) {
  auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/helical_set.toml");
  const auto geometry = app::make_geometry(scene);
  for (const auto& [accuracy, degree, level] :
       {std::tuple{0.1, 1, 1}, std::tuple{0.03, 1, 1}, std::tuple{0.01, 2, 1}}) {
    scene.accuracy = accuracy;
    const auto size = app::mesh_size(app::sun_mesh_model(scene, geometry));
    BOOST_TEST(size.degree == degree);
    BOOST_TEST(size.level == level);
  }
}

BOOST_AUTO_TEST_CASE(asked_fidelities) {
  auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  const auto geometry = app::make_geometry(scene);
  const auto fidelity = [&](std::size_t ring) { return app::ring_mesh_model(scene, geometry, ring); };
  scene.fidelity = app::Fidelity::resolved;
  BOOST_TEST(fidelity(0).fidelity == "resolved_plane");
  BOOST_TEST(fidelity(1).fidelity == "resolved_solid");  // thin-walled
  BOOST_CHECK(fidelity(1).settings.fidelity == fem::Fidelity::resolved_solid);
  BOOST_TEST(fidelity(1).reason.find("the scene asks for it") == 0U);
  scene.fidelity = app::Fidelity::closed_form;
  BOOST_CHECK(fidelity(2).settings.fidelity == fem::Fidelity::closed_form);
  const auto warnings = app::make_plan(scene).warnings;
  BOOST_TEST(
      std::any_of(warnings.begin(), warnings.end(), [](const auto& w) { return w.key == "accuracy_not_controlled"; }));
  scene.fidelity = app::Fidelity::solid;
  BOOST_CHECK(fidelity(0).settings.fidelity == fem::Fidelity::solid);
}

BOOST_AUTO_TEST_CASE(every_input_has_an_origin) {
  const auto json = ring_types();
  int derived = 0, assumed = 0;
  for (const auto& input : json["inputs"]) {
    const std::string origin = input["origin"];
    BOOST_TEST((origin == "scene" || origin == "default" || origin == "derived"));
    BOOST_TEST(!input["value"].is_null(), input["key"]);
    derived += origin == "derived";
    assumed += input.contains("assumed");
  }
  BOOST_TEST(derived > 0);
  BOOST_TEST(assumed > 10);
}

BOOST_AUTO_TEST_CASE(rigid_supports_drop_their_dofs) {
  const auto plan = plan_of(test::quick_scene());
  const auto retained = [&](const std::string& name) {
    for (const auto& f : plan.dofs) {
      if (f.name == name) return f.retained;
    }
    throw std::logic_error(name);
  };
  BOOST_TEST(retained("sun x, y"));
  BOOST_TEST(retained("sun u"));
  BOOST_TEST(!retained("ring x, y"));
  BOOST_TEST(!retained("ring u"));
  BOOST_TEST(!retained("carrier x, y"));
  BOOST_TEST(plan.contact_problems() == 0L);
  BOOST_TEST(plan.meshes.front().fidelity == "prescribed");
}

// 82 splines: each choice of a model solves the ring by formulas. The plan looks at some loads of a long sweep alone.
BOOST_AUTO_TEST_CASE(planning_costs_a_fraction_of_what_it_plans) {
  auto scene = app::read_scene(test::fault_scene_file("many_splines"));
  const auto planned = [](const app::Scene& of) {
    const ProcessorStopwatch watch;
    app::check_studies(of);
    auto plan = app::make_plan(of);
    return std::pair(std::move(plan), watch.seconds());
  };
  BOOST_REQUIRE(scene.sweeps.size() == 1U);
  auto& sweep = scene.sweeps.front();
  BOOST_REQUIRE(sweep.points().size() == 7U);
  const auto [few, seconds_of_few] = planned(scene);
  BOOST_TEST(few.studies.front().tables_counted);
  sweep.count = 200;
  const auto [many, seconds_of_many] = planned(scene);
  BOOST_TEST(!many.studies.front().tables_counted);
  // As many in proportion: what the sweep changes needs its table at every load or at none.
  const double per_load = many.studies.front().tables / 200.0, expected = few.studies.front().tables / 7.0;
  BOOST_TEST(std::abs(per_load - expected) <= 0.15);
  BOOST_TEST_MESSAGE("planned in " << seconds_of_few << " s of processor time, with 200 loads in " << seconds_of_many);
}

BOOST_AUTO_TEST_CASE(a_ring_without_room_for_its_fillet_is_refused_with_the_remedy) {
  const auto scene = app::read_scene(test::fault_scene_file("narrow_ring_root"));
  BOOST_CHECK_EXCEPTION(app::check_stage(scene), GeometryError, [](const auto& error) {
    const std::string what = error.what();
    BOOST_TEST(what.find("too narrow at the root diameter") != std::string::npos, what);
    BOOST_TEST(what.find("the root fillet factor is 0.38") != std::string::npos, what);
    BOOST_TEST(what.find("a fillet factor of at least") == std::string::npos, what);
    return true;
  });
}

BOOST_AUTO_TEST_CASE(impossible_geometry_names_the_body) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      (void)app::make_geometry(app::parse_scene(text, "s"));
    } catch (const GeometryError& error) {
      return error.what();
    }
    return "";
  };
  const auto four =
      test::replaced(test::quick_scene(), test::quick_errors(), "planet_eccentricity_um = [15, 36, 17, 38]\n");
  BOOST_TEST(!message(test::replaced(four, "planets = 5", "planets = 4")).empty());  // (48 + 162) / 4 is not whole
  BOOST_TEST(message(test::replaced(test::quick_scene(), "outside_diameter_mm = 663.6", "outside_diameter_mm = 620"))
                 .find("ring 'held'") == 0U);
  BOOST_TEST(
      !message(test::replaced(test::quick_scene(), "centre_distance_mm = 201", "centre_distance_mm = 230")).empty());
}

BOOST_AUTO_TEST_CASE(identity_follows_the_inputs_that_matter) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  const auto geometry = app::make_geometry(scene);
  const auto id = [&](const app::Scene& s) { return app::ring_mesh_model(s, app::make_geometry(s), 1).id(); };
  auto other = scene;
  other.title = "another title";
  planetary(other).supports.sun = 2e7;
  BOOST_TEST(id(other) == id(scene));  // no influence on the mesh
  planetary(other).rings[1].free_length = 19e-3;
  BOOST_TEST(id(other) != id(scene));
  other = scene;
  planetary(other).rings[0].outside_diameter = 0.7;
  BOOST_TEST(id(other) == id(scene));  // another ring
  other = scene;
  *planetary(other).stage.power *= 1.0 + 1e-15;
  BOOST_TEST(id(other) != id(scene));  // the last bit of a load counts
  BOOST_TEST(app::sun_mesh_model(scene, geometry).id() != id(scene));
}

BOOST_AUTO_TEST_CASE(identity_follows_every_structure_key) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_structures.toml");
  const auto changed = [&](const std::string& ring, auto change) {
    auto other = scene;
    std::size_t i = 0;
    while (planetary(other).rings.at(i).name != ring) ++i;
    change(planetary(other).rings[i]);
    const auto id = [&](const app::Scene& s) { return app::ring_mesh_model(s, app::make_geometry(s), i).id(); };
    return id(other) != id(scene);
  };
  BOOST_TEST(changed("flange", [](auto& r) { r.flange_width = 21e-3; }));
  BOOST_TEST(changed("flange", [](auto& r) { r.flange_diameter = 0.75; }));
  BOOST_TEST(changed("flange", [](auto& r) { r.flange_width.reset(); }));
  BOOST_TEST(changed("thin-walled-hoop", [](auto& r) { r.hoop_width = 16e-3; }));
  BOOST_TEST(changed("thin-walled-hoop", [](auto& r) { r.hoop_thickness = 16e-3; }));
  BOOST_TEST(changed("irregular-pins", [](auto& r) { r.pin_angles[3] += 1e-3; }));
  BOOST_TEST(changed("pins24", [](auto& r) { r.pin_free_span = 5e-3; }));
  BOOST_TEST(changed("pins24", [](auto& r) { r.pin_tangential_stiffness = 1e9; }));
  BOOST_TEST(changed("pins24", [](auto& r) { r.housing_clearance = 0; }));
  BOOST_TEST(changed("pins24", [](auto& r) { r.structure = app::Structure::bolted; }));
  BOOST_TEST(changed("clamped", [](auto& r) { r.clamp_inner_diameter = 0.645; }));
  BOOST_TEST(changed("splined", [](auto& r) { r.splines = 27; }));
  BOOST_TEST(changed("splined", [](auto& r) { r.spline_flank_angle = 0.6; }));
  BOOST_TEST(changed("splined", [](auto& r) { r.spline_clearance = 0; }));
  BOOST_TEST(changed("splined", [](auto& r) { r.spline_stiffness = 1e9; }));
  BOOST_TEST(changed("splined", [](auto& r) { r.first_spline_angle = 0.01; }));
  BOOST_TEST(changed("traditional", [](auto& r) { r.lead_slope = 1e-6; }));
  BOOST_TEST(changed("traditional", [](auto& r) { r.lead_crowning = 1e-6; }));
  auto misaligned = scene;
  planetary(misaligned).errors.ring_planet_misalignment = 1e-6;
  const auto geometry = app::make_geometry(scene);
  BOOST_TEST(app::ring_mesh_model(misaligned, geometry, 2).id() != app::ring_mesh_model(scene, geometry, 2).id());
  BOOST_TEST(app::sun_mesh_model(misaligned, geometry).id() == app::sun_mesh_model(scene, geometry).id());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
