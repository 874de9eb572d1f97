#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/compare/compared_quantities.h"
#include "app/compare/compared_run.h"
#include "app/compare/comparison_page.h"
#include "app/run/finished_run.h"
#include "core/errors.h"
#include "core/files.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"
#include "tests/temporary_folder.h"

namespace annulus {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json result(double value, const json& error) { return {{"value", value}, {"error", error}}; }

json ring_of(double stiffness, double error_relative, double sharing, double sharing_error) {
  return {{"ring_planet_mean_stiffness_N_per_m", result(stiffness, stiffness * error_relative)},
          {"sun_planet_load_sharing_averaged", result(sharing, sharing_error)},
          {"sun_planet_dynamic_factor", result(1.3, 0.01)},
          {"frequency_1_Hz", result(400, 2)},
          {"frequency_2_Hz", result(500, nullptr)}};
}

/// A summary as docs/results.md describes it, without what a comparison does not read.
json summary_of(const json& rings, double tip_relief = 0) {
  json variants = json::array();
  for (const auto& [name, figures] : rings.items()) variants.push_back({{"name", name}, {"figures", figures}});
  return {{"title", "Set <1>"},
          {"annulus_version", "0.1.0"},
          {"kind", "planetary"},
          {"accuracy_wanted", 0.01},
          {"variants", variants},
          {"inputs",
           {{{"key", "title"}, {"value", tip_relief > 0 ? "a" : "b"}},
            {{"key", "stage.planets"}, {"value", 5}},
            {{"key", "planet.tip_relief_um"}, {"value", tip_relief}},
            {{"key", "ring.pins"}, {"value", 24}, {"ring", "pinned"}}}},
          {"timings_s", {{"mesh", 1.0}, {"total", 12.5}}},
          {"peak_memory_MB", 345.6},
          {"reuse", {{"reused", {"x"}}}}};
}

/// A folder as a finished run leaves it.
std::string finished(const fs::path& folder, const json& summary) {
  fs::create_directories(folder);
  write_file(folder / "summary.json", summary.dump(1));
  app::keep_finished_run(folder, "id", "text", {"summary.json"});
  return folder.string();
}

void check_comparison_refused(const std::vector<std::string>& folders, const std::vector<std::string>& words) {
  BOOST_CHECK_EXCEPTION((void)app::read_finished_runs(folders), InputError, [&](const InputError& error) {
    bool all = true;
    for (const auto& word : words) {
      const bool there = std::string(error.what()).find(word) != std::string::npos;
      BOOST_TEST(there, "'" << word << "' is missing in: " << error.what());
      all = all && there;
    }
    return all;
  });
}

bool has_text(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

std::vector<std::string> rows_with(const std::string& csv, const std::string& head) {
  std::vector<std::string> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(head)) rows.push_back(line);
  return rows;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(compare)

// 1.05e9 against 1e9 N/m with 1 % each: 5e7 apart, bars of 2.05e7 together. 1.015e9: 1.5e7 against 2.015e7.
BOOST_AUTO_TEST_CASE(differences_are_held_against_the_error_bars_together) {
  const test::TemporaryFolder folder("compare_errors");
  const auto at = [&](const char* name, double k, double error) {
    return finished(folder.path() / name, summary_of({{"r", ring_of(k, error, 1.05, 0.01)}}));
  };
  auto unknown = summary_of({{"r", ring_of(2e9, 0.01, 1.05, 0.01)}});
  unknown["variants"][0]["figures"]["ring_planet_mean_stiffness_N_per_m"]["error"] = nullptr;
  const auto runs =
      app::read_finished_runs({at("first", 1e9, 0.01), at("apart", 1.05e9, 0.01), at("near", 1.015e9, 0.01),
                               at("equal", 1e9, 0.02), finished(folder.path() / "unknown", unknown)});
  const auto text = app::comparison_text(runs);
  const std::string what = "  Mean stiffness of the ring mesh, kN/µm: ";
  BOOST_TEST(has_text(text, what + "'apart' 1.05 is 5 % larger than 'first' 1, more than the error bars together"));
  BOOST_TEST(has_text(text, what + "'first' 1 and 'near' 1.015 differ by less than the error bars"));
  BOOST_TEST(has_text(text, what + "'first' and 'equal' are the same"));
  BOOST_TEST(has_text(text, what + "'first' 1 and 'unknown' 2 have no known error"));
  BOOST_TEST(has_text(text, "1.000 ± 0.010"));
  BOOST_TEST(has_text(text, "12.50 s, 346 MB, 1 results read back"));

  // In files the key states the unit.
  const auto results = app::comparison_json(runs).at("results");
  const auto stiffness = std::find_if(results.begin(), results.end(), [](const Json& item) {
    return item.at("key") == "ring_planet_mean_stiffness_N_per_m";
  });
  BOOST_TEST_REQUIRE((stiffness != results.end()));
  BOOST_TEST(stiffness->at("values").at(1).at("value").get<double>() == 1.05e9, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(stiffness->at("values").at(1).at("error").get<double>() == 1.05e7, boost::test_tools::tolerance(1e-12));

  const auto csv = app::comparison_csv(runs);
  const auto rows = rows_with(csv, "Mean stiffness of the ring mesh,kN/µm,");
  BOOST_TEST_REQUIRE(rows.size() == 5U);
  BOOST_TEST(has_text(rows[0], ",first,1,0.01,,,"));
  BOOST_TEST(has_text(rows[4], ",unknown,2,,1,,"));
  BOOST_TEST(has_text(rows_with(csv, "Dynamic factor of the sun meshes,").at(0), ",first,1.3,0.01,"));
  BOOST_TEST(has_text(rows_with(csv, "Natural frequency 1,Hz").at(0), ",first,400,2,"));
  BOOST_TEST(has_text(rows_with(csv, "Natural frequency 2,Hz").at(0), ",first,500,,"));
  BOOST_TEST(rows_with(csv, "Natural frequency 3,Hz").empty());
}

BOOST_AUTO_TEST_CASE(inputs_that_differ_are_listed_and_no_others) {
  const test::TemporaryFolder folder("compare_inputs");
  const auto a =
      finished(folder.path() / "a",
               summary_of({{"held", ring_of(1e9, 0.01, 1.2, 0.01)}, {"pinned", ring_of(9e8, 0.01, 1.1, 0.01)}}));
  const auto b = finished(folder.path() / "b", summary_of({{"held", ring_of(1e9, 0.01, 1.2, 0.01)}}, 20));
  const auto runs = app::read_finished_runs({a, b});
  const auto inputs = app::differing_inputs(runs);
  BOOST_TEST_REQUIRE(inputs.size() == 2U);
  BOOST_TEST(inputs[0].key == "planet.tip_relief_um");
  BOOST_TEST((inputs[0].values == std::vector<std::string>{"0", "0", "20"}));
  BOOST_TEST(inputs[1].key == "ring.pins");
  BOOST_TEST((inputs[1].values == std::vector<std::string>{"–", "24", "–"}));
  // Rings are named where a run has several.
  const auto page = app::comparison_html(runs);
  for (const char* name : {"a: held", "a: pinned", ">b<", "Set &lt;1&gt;"}) BOOST_TEST(has_text(page, name), name);
  BOOST_TEST(!has_text(page, "<1>"));
  BOOST_TEST(has_text(page, "Above the ideal"));
  BOOST_TEST(has_text(page, "load sharing K_γ, a: pinned"));
  // Nothing from outside.
  for (const char* outside : {"src=\"", "href=\"http", "url("}) BOOST_TEST(!has_text(page, outside), outside);
}

BOOST_AUTO_TEST_CASE(runs_are_named_as_shortly_as_tells_them_apart) {
  const test::TemporaryFolder folder("compare_names");
  const auto summary = summary_of({{"r", ring_of(1e9, 0.01, 1.2, 0.01)}});
  const auto x = finished(folder.path() / "x" / "out", summary), y = finished(folder.path() / "y" / "out", summary);
  const auto runs = app::read_finished_runs({x, y + "/"});
  BOOST_TEST(runs[0].name == "x/out");
  BOOST_TEST(runs[1].variants.front().name == "y/out");
}

BOOST_AUTO_TEST_CASE(folders_that_cannot_be_compared_are_refused) {
  const test::TemporaryFolder folder("compare_refused");
  const auto summary = summary_of({{"r", ring_of(1e9, 0.01, 1.2, 0.01)}});
  const auto good = finished(folder.path() / "good", summary);
  const auto with = [&](const char* name, const std::string& text) {
    const auto place = finished(folder.path() / name, summary);
    write_file(fs::path(place) / "summary.json", text);
    app::keep_finished_run(place, "id", "text", {"summary.json"});
    return place;
  };
  check_comparison_refused({}, {"two finished runs"});
  check_comparison_refused({good}, {"good", "two finished runs"});
  check_comparison_refused({good, good + "/../good/"}, {"good/", "twice"});
  check_comparison_refused({good, "/nowhere/out"}, {"/nowhere/out", "no such folder", "annulus run"});
  check_comparison_refused({good, good + "/summary.json"}, {"summary.json", "not a folder"});
  fs::create_directories(folder.path() / "empty");
  check_comparison_refused({good, (folder.path() / "empty").string()}, {"empty", "contains no run"});
  fs::create_directories(folder.path() / "begun" / "cache");
  check_comparison_refused({(folder.path() / "begun").string(), good}, {"begun", "not finished", "continue it with"});
  const auto text = summary.dump(1);
  check_comparison_refused({good, with("cut", text.substr(0, text.size() / 2))},
                           {"cut/summary.json", "damaged", "again"});
  check_comparison_refused({good, with("none", "")}, {"none/summary.json", "damaged"});
  for (
      const char* foreign :
      {"[]", "5", "null", "{}", R"({"name": "package", "version": "1"})",
       R"({"title": "t", "annulus_version": "1", "accuracy_wanted": 1, "kind": "planetary", "variants": 5})",
       R"({"title": "t", "annulus_version": "1", "accuracy_wanted": 1, "kind": "planetary", "variants": [{"name": "r", "figures": 5}], "timings_s": {}, "peak_memory_MB": 1})",
       R"({"title": "t", "annulus_version": "1", "accuracy_wanted": 1, "kind": "turbine"})"})
    check_comparison_refused({good, with("foreign", foreign)},
                             {"foreign/summary.json", "not a summary of annulus", "annulus run"});
  auto wrong = summary;
  wrong["variants"][0]["figures"]["sun_planet_load_sharing_averaged"]["value"] = "much";
  check_comparison_refused({good, with("wrong", wrong.dump())}, {"wrong/summary.json", "must be number"});
  // A note that is missing, and files that a later run has begun to change.
  const auto no_note = finished(folder.path() / "no_note", summary);
  fs::remove(fs::path(no_note) / "run.json");
  check_comparison_refused({good, no_note}, {"no_note", "not finished", "no run.json"});
  const auto changed = finished(folder.path() / "changed", summary);
  write_file(fs::path(changed) / "stiffness.csv", "old");
  app::keep_finished_run(changed, "id", "text", {"summary.json", "stiffness.csv"});
  BOOST_CHECK_NO_THROW((void)app::read_finished_runs({good, changed}));
  write_file(fs::path(changed) / "stiffness.csv", "longer");
  check_comparison_refused({good, changed}, {"changed", "stiffness.csv has changed since"});
  fs::remove(fs::path(changed) / "stiffness.csv");  // room was made: nothing is unfinished
  BOOST_CHECK_NO_THROW((void)app::read_finished_runs({good, changed}));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(compare_program)

BOOST_AUTO_TEST_CASE(finished_runs_of_the_program) {
  const test::TemporaryFolder folder("compare_program");
  const auto run = [&](const std::string& name, const std::string& scene) {
    write_file(folder.path() / (name + ".toml"), scene);
    const auto outcome = test::run_program(folder.path(), "run " + name + ".toml -o " + name + " --quiet");
    BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  };
  run("soft", test::quick_scene());
  run("stiff", test::replaced(test::quick_scene(), "planet_N_per_m = 1e9", "planet_N_per_m = 2e9"));
  const auto outcome = test::run_program(folder.path(), "compare soft stiff -o pages/both.html");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  BOOST_TEST(has_text(outcome.out, "pages/both.html"));
  BOOST_TEST(has_text(outcome.out, "supports.planet_N_per_m"));
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "pages" / "both_pictures")) {
    if (entry.path().filename() == "owner.txt") continue;
    ++pictures;
    BOOST_TEST(read_file(entry.path()).starts_with("<svg xmlns="));
  }
  BOOST_TEST(pictures == 1);  // the answer
  const auto page = read_file(folder.path() / "pages" / "both.html");
  const auto csv = read_file(folder.path() / "pages" / "both.csv");
  // The numbers are those of the summaries, the only input that differs is the one that was changed.
  for (const std::string name : {"soft", "stiff"}) {
    const auto summary = json::parse(read_file(folder.path() / name / "summary.json"));
    const double sharing = summary["variants"][0]["figures"]["sun_planet_load_sharing_averaged"]["value"].get<double>();
    bool found = false;
    for (const auto& row :
         rows_with(csv, "\"Load sharing of the sun meshes, averaged over a mesh cycle\",," + name + ","))
      found = std::abs(std::stod(row.substr(row.find("," + name + ",") + name.size() + 2)) - sharing) < 1e-12;
    BOOST_TEST(found, name);
  }
  const auto begin = page.find("id=\"inputs\""), end = page.find("id=\"cost\"");
  const auto inputs = page.substr(begin, end - begin);
  BOOST_TEST(has_text(inputs, "supports.planet_N_per_m"));
  std::size_t keys = 0;
  for (auto at = inputs.find("<code>"); at != std::string::npos; at = inputs.find("<code>", at + 1)) ++keys;
  BOOST_TEST(keys == 1U);

  // Pairs and reducers with their own kind; never across kinds.
  run("pair", test::quick_pair());
  run("pair2", test::replaced(test::quick_pair(), "pinion_torque_Nm = 20000", "pinion_torque_Nm = 25000"));
  run("reducer", test::reducer_scene());
  run("reducer2", "accuracy = 0.02\n" + test::reducer_scene());
  const auto pairs = test::run_program(folder.path(), "compare pair pair2 -o pairs.html");
  BOOST_TEST(pairs.status == 0, pairs.err);
  BOOST_TEST(has_text(pairs.out, "Largest mesh force, kN"));
  BOOST_TEST(has_text(pairs.out, "stage.pinion_torque_Nm"));
  const auto reducers = test::run_program(folder.path(), "compare reducer reducer2 -o reducers.html");
  BOOST_TEST(reducers.status == 0, reducers.err);
  BOOST_TEST(has_text(reducers.out, "Torsional stiffness from the output, kN m/rad"));

  const auto refused = [&](const std::string& arguments, const std::string& word) {
    const auto bad = test::run_program(folder.path(), "compare " + arguments);
    BOOST_TEST(bad.status == 2, arguments);
    BOOST_TEST(has_text(bad.err, word), bad.err);
    BOOST_TEST(std::count(bad.err.begin(), bad.err.end(), '\n') == 1, bad.err);
    BOOST_TEST(bad.out.empty());
    BOOST_TEST(!fs::exists(folder.path() / "bad.html"));
    BOOST_TEST(!fs::exists(folder.path() / "bad.csv"));
    BOOST_TEST(!fs::exists(folder.path() / "comparison.html"));
  };
  refused("soft pair -o bad.html", "have no common results");
  refused("soft -o bad.html", "two finished runs");
  refused("-o bad.html", "two finished runs");
  refused("soft soft -o bad.html", "twice");
  refused("soft nowhere -o bad.html", "no such folder");
  refused("soft nowhere", "no such folder");
  refused("soft stiff -o bad.csv", "the ending .html");
  refused("soft stiff -o soft.toml/bad.html", "is not a folder");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
