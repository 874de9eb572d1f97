#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/csv.h"
#include "core/stiffness_table.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

struct Outcome {
  int status = -1;
  std::string out, err;
};

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Runs the built program in `folder`.
Outcome annulus_program(const std::filesystem::path& folder, const std::string& arguments) {
  const std::string command =
      "cd '" + folder.string() + "' && '" ANNULUS_PROGRAM "' " + arguments + " >stdout.txt 2>stderr.txt";
  const int raw = std::system(command.c_str());
  return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, text_of(folder / "stdout.txt"), text_of(folder / "stderr.txt")};
}

std::filesystem::path put_scene(const std::filesystem::path& folder, const std::string& text) {
  write_file(folder / "scene.toml", text);
  return folder / "scene.toml";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(program)

BOOST_AUTO_TEST_CASE(help_version_and_wrong_arguments) {
  const test::TemporaryFolder folder("arguments");
  BOOST_TEST(annulus_program(folder.path(), "--help").status == 0);
  BOOST_TEST(annulus_program(folder.path(), "run --help").status == 0);
  const auto version = annulus_program(folder.path(), "--version");
  BOOST_TEST(version.status == 0);
  BOOST_TEST(version.out.find("annulus ") == 0U);
  BOOST_TEST(annulus_program(folder.path(), "").status == 2);
  BOOST_TEST(annulus_program(folder.path(), "walk scene.toml").status == 2);
  BOOST_TEST(annulus_program(folder.path(), "run scene.toml --threads 0").status == 2);
  for (const auto* arguments : {"frob", "frob scene.toml", "--quiet frob"}) {
    const auto unknown = annulus_program(folder.path(), arguments);
    BOOST_TEST(unknown.status == 2);
    BOOST_TEST(unknown.err.find("frob: there is no such command") == 0U, unknown.err);
    for (const auto* known : {"run", "solve", "dynamics", "plan", "check", "explain"})
      BOOST_TEST(unknown.err.find(known) != std::string::npos, known);
  }
  BOOST_TEST(annulus_program(folder.path(), "pln scene.toml").err.find("did you mean plan?") != std::string::npos);
  const auto missing = annulus_program(folder.path(), "check nowhere.toml");
  BOOST_TEST(missing.status == 2);
  BOOST_TEST(missing.err.find("nowhere.toml") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(check_plan_and_explain) {
  const test::TemporaryFolder folder("check");
  put_scene(folder.path(), test::quick_scene());
  BOOST_TEST(annulus_program(folder.path(), "check scene.toml").status == 0);
  const auto plan = annulus_program(folder.path(), "plan scene.toml");
  BOOST_TEST(plan.status == 0);
  BOOST_TEST(plan.out.find("696.13714 Hz") != std::string::npos);
  const auto json = annulus_program(folder.path(), "plan scene.toml --json");
  BOOST_TEST(nlohmann::json::parse(json.out)["stage"].contains("mesh_frequency_Hz"));
  BOOST_TEST(annulus_program(folder.path(), "explain ring.pins").out.find("ring.pins") == 0U);
  const auto unknown = annulus_program(folder.path(), "explain ring.pinz");
  BOOST_TEST(unknown.status == 2);
  BOOST_TEST(unknown.err.find("ring.pins") != std::string::npos);

  put_scene(folder.path(), test::replaced(test::quick_scene(), "module_mm = 3.8", "module_mm = -3.8"));
  const auto wrong = annulus_program(folder.path(), "check scene.toml");
  BOOST_TEST(wrong.status == 2);
  BOOST_TEST(wrong.err.find("scene.toml:5:1: stage.module_mm = -3.8") == 0U, wrong.err);
}

BOOST_AUTO_TEST_CASE(run_writes_what_the_design_promises) {
  const test::TemporaryFolder folder("run");
  put_scene(folder.path(), test::quick_scene());
  const auto run = annulus_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST_REQUIRE(run.status == 0, run.err);
  BOOST_TEST(run.out.find("out/report.html") != std::string::npos);

  const auto json = nlohmann::json::parse(text_of(folder.path() / "out/summary.json"));
  BOOST_TEST(json["title"] == "Quick");
  const auto& ring = json["rings"]["held"];
  BOOST_TEST(ring["rung"] == "given");
  BOOST_TEST(ring["ring_planet"]["mean_stiffness_N_per_m"]["value"].get<double>() == 1.87e9,
             boost::test_tools::tolerance(1e-13));
  BOOST_TEST(std::abs(ring["ring_planet"]["contact_ratio"].get<double>() - 1.5826) < 5e-5);
  for (const auto* mesh : {"sun_planet", "ring_planet"}) {
    BOOST_TEST(ring["dynamic_factor"][mesh].size() == 5U);
    for (const auto* kind : {"instantaneous", "averaged", "quasi_static"}) {
      const auto& figure = ring["load_sharing"][mesh][kind];
      BOOST_TEST(figure["value"].get<double>() >= 1.0);  // the most loaded of N planets carries at least its share
      BOOST_TEST(figure["value"].get<double>() < 5.0);
      BOOST_TEST(figure.contains("error"));
    }
    // Averaging over a mesh cycle can only take peaks away.
    BOOST_TEST(ring["load_sharing"][mesh]["averaged"]["value"].get<double>() <=
               ring["load_sharing"][mesh]["instantaneous"]["value"].get<double>());
  }
  for (const auto* stage : {"mesh", "condense", "contact", "dynamics", "total"})
    BOOST_TEST(json["timings_s"].contains(stage));
  BOOST_TEST(json["peak_memory_MB"].get<double>() > 1);

  const auto dynamics = folder.path() / "out/held/dynamics";
  const auto series = Csv::read(dynamics / "time_series.csv");
  BOOST_TEST(series.columns.front() == "time_s");
  BOOST_CHECK_NO_THROW((void)series.column("sun_x_m"));
  BOOST_CHECK_NO_THROW((void)series.column("planet1_u_m"));
  BOOST_CHECK_NO_THROW((void)series.column("sun_planet1_force_N"));
  BOOST_CHECK_NO_THROW((void)series.column("ring_planet5_force_N"));
  const auto modes = text_of(dynamics / "modes.csv");
  BOOST_TEST(modes.find("index,frequency_Hz,kind\n") != std::string::npos);
  for (const auto* name : {"load_sharing.csv", "dynamic_factor.csv", "spectrum.csv"})
    BOOST_TEST(std::filesystem::exists(dynamics / name), name);
  // No temporary file is left behind.
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder.path() / "out"))
    BOOST_TEST(file.path().extension() != ".tmp");
}

BOOST_AUTO_TEST_CASE(report_is_self_contained) {
  const test::TemporaryFolder folder("report");
  put_scene(folder.path(),
            test::replaced(test::quick_scene(), "title = \"Quick\"", "title = \"Quick <&> \\\"one\\\"\""));
  BOOST_TEST_REQUIRE(annulus_program(folder.path(), "run scene.toml -o out").status == 0);
  const auto page = text_of(folder.path() / "out/report.html");
  BOOST_TEST(page.find("Quick &lt;&amp;&gt;") != std::string::npos);
  for (const auto* outside : {"src=\"http", "href=\"http", "url(http", "@import", "<script", "<link"}) {
    BOOST_TEST(page.find(outside) == std::string::npos, outside);
  }
  BOOST_TEST(page.find(">nan<") == std::string::npos);
  BOOST_TEST(page.find("</html>") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(unchanged_results_are_reused_and_changed_ones_are_not) {
  const test::TemporaryFolder folder("reuse");
  put_scene(folder.path(), test::quick_scene());
  BOOST_TEST_REQUIRE(annulus_program(folder.path(), "run scene.toml -o out").status == 0);
  const auto before = text_of(folder.path() / "out/held/dynamics/figures.json");
  const auto again = annulus_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(again.err.find("dynamics of 'held': unchanged, reused") != std::string::npos, again.err);
  BOOST_TEST(text_of(folder.path() / "out/held/dynamics/figures.json") == before);
  put_scene(folder.path(), test::replaced(test::quick_scene(), "half_backlash_um = 50", "half_backlash_um = 40"));
  const auto changed = annulus_program(folder.path(), "run scene.toml -o out --quiet");
  BOOST_TEST(changed.status == 0);
  BOOST_TEST(changed.err.empty());
  BOOST_TEST(text_of(folder.path() / "out/held/dynamics/figures.json") != before);
}

BOOST_AUTO_TEST_CASE(dynamics_needs_its_table_and_solve_needs_none) {
  const test::TemporaryFolder folder("no_dynamics");
  const auto text = test::quick_scene();
  put_scene(folder.path(), text.substr(0, text.find("[dynamics]")));
  const auto dynamics = annulus_program(folder.path(), "dynamics scene.toml -o out");
  BOOST_TEST(dynamics.status == 2);
  BOOST_TEST(dynamics.err.find("[dynamics]") != std::string::npos);
  BOOST_TEST(annulus_program(folder.path(), "solve scene.toml -o out").status == 0);
  BOOST_TEST(annulus_program(folder.path(), "run scene.toml -o out").status == 0);
}

BOOST_AUTO_TEST_CASE(stiffness_from_a_table_file) {
  const test::TemporaryFolder folder("table");
  std::vector<StiffnessEntry> entries;
  for (int phase = 0; phase < 8; ++phase) {
    const double k = 1.87e9 * (1 + 0.1 * std::cos(2 * std::numbers::pi * phase / 8));
    for (const double load : {3e4, 6e4, 9e4})
      entries.push_back(
          {.unloaded_te = 0, .lte = load / k, .stiffness_secant = k, .stiffness_tangent = k, .error_relative = 0.01});
  }
  StiffnessTable("ring_planet", 8, {0.0}, {3e4, 6e4, 9e4}, entries).write_csv(folder.path() / "ring.csv");
  const auto text =
      test::replaced(test::quick_scene(), "stiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294",
                     "stiffness = \"table\"\nfile = \"ring.csv\"");
  put_scene(folder.path(), text);
  const auto run = annulus_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(run.status == 0, run.err);
  put_scene(folder.path(), test::replaced(text, "ring.csv", "missing.csv"));
  const auto missing = annulus_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(missing.status == 2);
  BOOST_TEST(missing.err.find("missing.csv") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
