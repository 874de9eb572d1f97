#include "app/model/run_limits.h"
#include "app/run/pipeline.h"
#include "app/scene/overrides.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/model/cost_actual.h"
#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/scene/overrides.h"
#include "core/files.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

namespace annulus {

namespace {

/// One ring whose meshes are computed.
std::string computed_scene(const std::string& top = "") {
  auto text = test::replaced(test::quick_scene(), "teeth = 48\n", "teeth = 48\nbore_diameter_mm = 130\n");
  text = test::replaced(text, "teeth = 55\n", "teeth = 55\nbore_diameter_mm = 172\n");
  text.erase(text.find("[mesh.sun_planet]"), text.find("[dynamics]") - text.find("[mesh.sun_planet]"));
  return top + text;
}

/// The built program, with its own list of costs in `folder`/cache.
test::ProgramOutcome program_with_cache(const std::filesystem::path& folder, const std::string& arguments) {
  return test::run_program(folder, arguments, "ANNULUS_CACHE='" + (folder / "cache").string() + "'");
}

app::BudgetChoice fitted(const app::Scene& scene, double budget) { return app::fit_budget(scene, budget, 2); }

}  // namespace

BOOST_AUTO_TEST_SUITE(cost_budget)

BOOST_AUTO_TEST_CASE(durations) {
  BOOST_TEST(app::parse_duration("30s") == 30.0);
  BOOST_TEST(app::parse_duration("30") == 30.0);
  BOOST_TEST(app::parse_duration("2min") == 120.0);
  BOOST_TEST(app::parse_duration("1.5 min") == 90.0);
  BOOST_TEST(app::parse_duration("500ms") == 0.5);
  BOOST_TEST(app::parse_duration("1h") == 3600.0);
  for (const auto* bad : {"", "s", "30 seconds", "-3s", "0", "nan", "inf", "1e999", "3s4", "30S", " 30"}) {
    BOOST_CHECK_EXCEPTION((void)app::parse_duration(bad), InputError, [&](const InputError& e) {
      return std::string(e.what()).find("--budget " + std::string(bad) + ":") == 0;
    });
  }
}

BOOST_AUTO_TEST_CASE(less_time_buys_less_accuracy) {
  const auto scene = app::parse_scene(computed_scene("accuracy = 0.02\n"), "s.toml");
  const auto predicted = [&](double accuracy) {
    const auto with = app::with_accuracy(scene, accuracy, "");
    return app::make_plan(with, 2).cost.seconds();
  };
  const double finest = predicted(0.001), coarsest = predicted(0.1);
  BOOST_REQUIRE(finest > 1.1 * coarsest);
  double last_accuracy = 0;
  for (const double budget : {3600.0, 1.01 * finest, 0.99 * finest, (finest + coarsest) / 2, 1.01 * coarsest}) {
    const auto choice = fitted(scene, budget);
    BOOST_TEST(choice.cost.seconds() <= budget);
    BOOST_TEST(choice.scene.accuracy >= last_accuracy);
    BOOST_TEST(choice.cost.expected_error() <= choice.scene.accuracy);
    BOOST_TEST(choice.sentence.find("budget") == 0U);
    last_accuracy = choice.scene.accuracy;
  }
  BOOST_TEST(fitted(scene, 1.01 * finest).scene.accuracy == 0.001);
  BOOST_TEST(fitted(scene, 0.99 * finest).scene.accuracy > 0.001);
  BOOST_CHECK_THROW((void)fitted(scene, 0.99 * coarsest), SolverError);
  BOOST_TEST(fitted(scene, 3600).scene.accuracy == 0.001);
}

BOOST_AUTO_TEST_CASE(a_budget_too_small_is_refused_with_the_figures) {
  const auto scene = app::parse_scene(computed_scene(), "s.toml");
  BOOST_CHECK_EXCEPTION((void)fitted(scene, 0.1), SolverError, [](const SolverError& e) {
    const std::string text = e.what();
    return text.find("within 10 %") != std::string::npos && text.find(" MB") != std::string::npos &&
           text.find("budget of 0.1 s") != std::string::npos;
  });
  // Nothing to refine: the scene stays as it is, or is refused.
  const auto given = app::parse_scene(test::quick_scene(), "s.toml");
  BOOST_TEST(fitted(given, 1e4).scene.accuracy == given.accuracy);
  BOOST_CHECK_THROW((void)fitted(given, 0.01), SolverError);
}

BOOST_AUTO_TEST_CASE(every_kind_and_fidelity_has_a_budget) {
  for (const auto& text : {computed_scene("model = \"resolved\"\n"), test::solved_pair(), test::reducer_scene()}) {
    const auto scene = app::parse_scene(text, "s.toml");
    const auto system = app::make_system(scene);
    const auto cost = system->cost(2);
    BOOST_TEST(cost.seconds() > 0);
    // The libraries of finite elements, or the program alone.
    const auto meshes = system->meshes();
    const bool elements = std::any_of(meshes.begin(), meshes.end(), [](const auto& m) { return m.has_elements(); });
    BOOST_TEST(cost.peak_MB() > (elements ? app::loaded_elements_MB : 40));
    const auto choice = fitted(scene, 1e6);
    BOOST_TEST(choice.cost.seconds() > 0);
    BOOST_TEST(choice.sentence.find("budget") == 0U);
    const bool given = scene.stage.kind == "two_k_v";
    BOOST_TEST((choice.sentence.find("no mesh of this scene is refined") != std::string::npos) == given,
               choice.sentence);
    BOOST_TEST((choice.scene.accuracy == scene.accuracy) == given);
    BOOST_CHECK_THROW((void)fitted(scene, 0.001), SolverError);
  }
  // The same accuracy costs many times as much where every contact has a mesh of its own.
  const auto seconds = [](const std::string& top) {
    const auto scene = app::parse_scene(computed_scene(top), "s.toml");
    return app::make_system(scene)->cost(2).seconds();
  };
  BOOST_TEST(seconds("model = \"resolved\"\naccuracy = 0.01\n") > 10 * seconds("model = \"plane\"\naccuracy = 0.01\n"));
}

BOOST_AUTO_TEST_CASE(the_rest_of_the_scene_stays) {
  const auto scene =
      app::parse_scene(computed_scene() + "[monte_carlo]\nsamples = 20\nseed = 1\nphases = \"unknown\"\n", "s.toml");
  const auto changed = app::with_accuracy(scene, 0.03, "said so");
  BOOST_TEST(changed.accuracy == 0.03);
  BOOST_REQUIRE(changed.monte_carlo.has_value());
  BOOST_TEST(changed.monte_carlo->samples == 20);
  BOOST_TEST(changed.inputs.size() == scene.inputs.size());
  for (const auto& input : changed.inputs) {
    if (input.key != "accuracy") continue;
    BOOST_TEST((input.origin == app::Origin::derived));
    BOOST_TEST(input.note == "said so");
  }
}

BOOST_AUTO_TEST_CASE(the_plan_tells_time_and_memory) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
  const auto plan = app::make_plan(scene, 2);
  const auto json = app::to_json(plan);
  for (const auto& mesh : json["meshes"]) {
    BOOST_TEST(mesh["predicted_s"].get<double>() > 0);
    BOOST_TEST(mesh["predicted_peak_MB"].get<double>() > 0);
  }
  double in_turn = 0, responses = 0, peak = 0;
  for (const auto& step : json["cost"]) {
    const double seconds = step["predicted_s"];
    (step["step"] == "response" ? responses : in_turn) += seconds;
    if (step["step"] == "mesh") peak = std::max(peak, step["predicted_peak_MB"].get<double>());
  }
  const double total = json["predicted_s"];
  BOOST_TEST(total >= in_turn + responses / 2);
  BOOST_TEST(total <= in_turn + responses);
  BOOST_TEST(json["predicted_peak_MB"].get<double>() >= peak);
  const auto text = app::to_text(plan);
  BOOST_TEST(text.find("Predicted cost on 2 threads") != std::string::npos);
  BOOST_TEST(text.find("not predicted") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(plans_of_all_kinds_tell_time_and_memory) {
  for (const auto* name : {"helical_pair", "helical_pair_solid", "arc_tooth_2kv", "helical_set", "misaligned_set"}) {
    const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/" + name + ".toml");
    const auto json = app::to_json(app::make_plan(scene, 2));
    BOOST_TEST(json["predicted_s"].is_number(), name);
    BOOST_TEST(json["predicted_peak_MB"].is_number(), name);
    BOOST_TEST(app::to_text(app::make_plan(scene, 2)).find("not known") == std::string::npos, name);
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(cost_of_a_run)

BOOST_AUTO_TEST_CASE(predicted_and_actual_of_other_kinds) {
  const test::TemporaryFolder folder("cost_of_other_kinds");
  for (const auto& text : {test::quick_pair(), test::solved_pair(), test::reducer_scene()}) {
    const auto scene = app::parse_scene(text, folder.path() / "s.toml");
    const app::RunOptions options{.out = folder.path() / std::to_string(text.size()), .threads = 2};
    const std::string told = app::run_text(*app::run_system(scene, options));
    BOOST_TEST(told.find("cost    predicted ") != std::string::npos, told);
    const auto json = nlohmann::json::parse(read_file(options.out / "summary.json"));
    BOOST_TEST(json["cost"]["predicted_s"].get<double>() > 0);
    BOOST_TEST(json["cost"]["actual_s"].get<double>() > 0);
    // Response and files, samples of a phase that is not stated, and a computed mesh.
    BOOST_TEST(json["cost"]["steps"].size() == (text == test::reducer_scene() ? 2U
                                                : text == test::solved_pair() ? 4U
                                                                              : 3U));
    BOOST_TEST(read_file(options.out / "report.html").find("as predicted before the run") != std::string::npos);
  }
}

// The second run finds two of four responses in its folder: half of the prediction is compared with the time.
BOOST_AUTO_TEST_CASE(studies_reused_in_part) {
  const test::TemporaryFolder folder("cost_of_a_reused_study");
  const auto studies = [&](const std::string& powers) {
    const auto text = test::quick_pair() + "[[sweep]]\ninput = \"stage.pinion_torque_Nm\"\nvalues = " + powers + "\n";
    const auto scene = app::parse_scene(text, folder.path() / "s.toml");
    const auto result = app::run_system(scene, {.out = folder.path() / "out", .threads = 1});
    const auto is_sweep = [](const app::CostStep& step) { return step.label == "[[sweep]] 1"; };
    const auto planned = std::find_if(result->plan.cost.steps.begin(), result->plan.cost.steps.end(), is_sweep);
    const auto done = std::find_if(result->cost.steps.begin(), result->cost.steps.end(), is_sweep);
    BOOST_REQUIRE(planned != result->plan.cost.steps.end());
    BOOST_REQUIRE(done != result->cost.steps.end());
    BOOST_TEST(done->actual->seconds() > 0);
    return done->predicted.seconds / planned->predicted.seconds;
  };
  BOOST_TEST(studies("[21000, 22000]") == 1.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(studies("[21000, 22000, 23000, 24000]") == 0.5, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(predicted_and_actual_of_small_scenes) {
  const test::TemporaryFolder folder("cost_of_a_run");
  for (const std::string top : {"model = \"closed_form\"\n", "accuracy = 0.1\n"}) {
    const auto scene = app::parse_scene(computed_scene(top), folder.path() / "s.toml");
    const app::RunOptions options{.out = folder.path() / ("out" + std::to_string(top.size())), .threads = 2};
    const auto result = app::run(scene, options);
    BOOST_REQUIRE(result.cost.steps.size() >= 3U);
    // Times are told, never judged.
    BOOST_TEST_MESSAGE(top << "  " << app::cost_sentence(result));
    auto json = nlohmann::json::parse(read_file(options.out / "summary.json"));
    BOOST_TEST(json["cost"]["predicted_s"].get<double>() > 0);
    BOOST_TEST(json["cost"]["actual_s"].get<double>() > 0);
    BOOST_TEST(json["cost"]["steps"].size() == result.cost.steps.size());
    for (const auto& step : result.cost.steps) {
      BOOST_CHECK(step.actual->work == step.size.work);
      BOOST_TEST((step.actual->processor_s > 0) == (step.kind == app::CostKind::mesh));
      if (step.size.work == app::Work::plane) BOOST_TEST(step.actual->level == step.size.level);
    }
    BOOST_TEST(read_file(options.out / "report.html").find("as predicted before the run") != std::string::npos);
    // All is reused: nothing to compare.
    BOOST_TEST(app::run(scene, options).cost.empty());
    json = nlohmann::json::parse(read_file(options.out / "summary.json"));
    BOOST_TEST(!json.contains("cost"));
  }
}

BOOST_AUTO_TEST_CASE(progress_of_a_solve_rises_from_nothing_to_all) {
  const auto scene = app::parse_scene(computed_scene(), "s.toml");
  auto model = app::sun_mesh_model(scene, app::make_geometry(scene));
  model.settings.degree = 1;
  model.settings.level = 1;
  model.problem->phases = 2;
  std::vector<double> fractions;
  model.settings.progress = [&](double fraction) { fractions.push_back(fraction); };
  (void)fem::solve_loaded_mesh(*model.problem, model.settings);
  BOOST_REQUIRE(fractions.size() >= 4U);
  BOOST_TEST(fractions.front() > 0);
  BOOST_TEST(std::is_sorted(fractions.begin(), fractions.end()));
  BOOST_TEST(fractions.back() == 1.0, boost::test_tools::tolerance(1e-12));
  // Of work that grows by 2.25 from level 0 to 1, the first loads are a small part.
  BOOST_TEST(fractions.front() < 0.31);
}

BOOST_AUTO_TEST_CASE(the_program_learns_its_pace_and_keeps_budgets) {
  const test::TemporaryFolder folder("budget_program");
  write_file(folder.path() / "s.toml", computed_scene("model = \"closed_form\"\n"));
  write_file(folder.path() / "c.toml", computed_scene());
  const auto pace = folder.path() / "cache" / "pace.json";
  const auto first = program_with_cache(folder.path(), "run s.toml -o out");
  BOOST_TEST(first.status == 0, first.err);
  BOOST_TEST(first.out.find("cost    predicted ") != std::string::npos);
  // Formulas are over before their time says anything, but for sanitizers.
  BOOST_TEST((ANNULUS_SLOWDOWN > 1 || !std::filesystem::exists(pace)));
  const auto before = program_with_cache(folder.path(), "plan c.toml --json --budget 1h");
  BOOST_TEST(program_with_cache(folder.path(), "run c.toml -q -o solved").status == 0);
  BOOST_REQUIRE(std::filesystem::exists(pace));
  const auto learned = read_file(pace);
  BOOST_TEST(program_with_cache(folder.path(), "run c.toml -q -o solved").status == 0);
  BOOST_TEST(read_file(pace) == learned);  // all was reused

  for (const auto* command : {"run", "plan"}) {
    const auto bad = program_with_cache(folder.path(), std::string(command) + " c.toml --budget soon");
    BOOST_TEST(bad.status == 2);
    BOOST_TEST(bad.err.find("--budget soon: ") == 0U, bad.err);
    const auto refused = program_with_cache(folder.path(), std::string(command) + " c.toml --budget 10ms");
    BOOST_TEST(refused.status == 3);
    BOOST_TEST(refused.err.find("more than the budget of 0.01 s") != std::string::npos, refused.err);
  }
  BOOST_TEST(program_with_cache(folder.path(), "plan c.toml --budget ''").status == 2);
  BOOST_TEST(!std::filesystem::exists(folder.path() / "out" / "c"));
  const auto plan = program_with_cache(folder.path(), "plan c.toml --json --budget 1h");
  BOOST_REQUIRE(plan.status == 0);
  const auto json = nlohmann::json::parse(plan.out);
  BOOST_TEST(json["budget"] == nlohmann::json::parse(before.out)["budget"]);
  BOOST_TEST(json["predicted_s"].get<double>() < 3600);
  BOOST_TEST(json["budget"].get<std::string>().find("within 0.1 %") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
