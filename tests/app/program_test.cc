#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "core/csv.h"
#include "core/files.h"
#include "core/stiffness_table.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

std::filesystem::path put_scene(const std::filesystem::path& folder, const std::string& text) {
  write_file(folder / "scene.toml", text);
  return folder / "scene.toml";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(program)

BOOST_AUTO_TEST_CASE(help_version_and_wrong_arguments) {
  const test::TemporaryFolder folder("arguments");
  BOOST_TEST(test::run_program(folder.path(), "--help").status == 0);
  BOOST_TEST(test::run_program(folder.path(), "run --help").status == 0);
  const auto version = test::run_program(folder.path(), "--version");
  BOOST_TEST(version.status == 0);
  BOOST_TEST(version.out.find("annulus ") == 0U);
  BOOST_TEST(test::run_program(folder.path(), "").status == 2);
  BOOST_TEST(test::run_program(folder.path(), "walk scene.toml").status == 2);
  BOOST_TEST(test::run_program(folder.path(), "run scene.toml --threads 0").status == 2);
  for (const auto* arguments : {"frob", "frob scene.toml", "--quiet frob"}) {
    const auto unknown = test::run_program(folder.path(), arguments);
    BOOST_TEST(unknown.status == 2);
    BOOST_TEST(unknown.err.find("frob: there is no such command") == 0U, unknown.err);
    for (const auto* known : {"run", "solve", "dynamics", "plan", "check", "explain"})
      BOOST_TEST(unknown.err.find(known) != std::string::npos, known);
  }
  BOOST_TEST(test::run_program(folder.path(), "pln scene.toml").err.find("did you mean plan?") != std::string::npos);
  const auto missing = test::run_program(folder.path(), "check nowhere.toml");
  BOOST_TEST(missing.status == 2);
  BOOST_TEST(missing.err.find("nowhere.toml") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(large_libraries_are_loaded_on_first_use) {
  const test::TemporaryFolder folder("libraries");
  put_scene(folder.path(), test::quick_scene());
  // The loader itself says which files it opens.
  const auto opened = [&](const std::string& arguments) {
    const auto log = folder.path() / "opened";
    std::filesystem::remove_all(log);
    std::filesystem::create_directory(log);
    const auto environment = "LD_DEBUG=files LD_DEBUG_OUTPUT='" + (log / "by").string() + "'";
    BOOST_TEST(test::run_program(folder.path(), arguments, environment).status == 0, arguments);
    std::string text;
    for (const auto& entry : std::filesystem::directory_iterator(log)) text += read_file(entry.path());
    BOOST_TEST(text.find("libannulus_core") != std::string::npos, arguments);
    return text;
  };
  const std::vector<std::string> large = {
      "libannulus_meshing", "libannulus_elements", "libannulus_optimisers", "libgmsh", "libdeal", "libpagmo"};
  for (const auto* arguments : {"--version", "check scene.toml", "plan scene.toml", "new planetary"}) {
    const auto text = opened(arguments);
    for (const auto& library : large) BOOST_TEST(text.find(library) == std::string::npos, arguments << ": " << library);
  }
  put_scene(folder.path(), "model = \"plane\"\n" + test::pinned_scene());
  const auto solving = opened("solve scene.toml --out results --quiet");
  for (const auto* library : {"libannulus_meshing", "libannulus_elements", "libgmsh", "libdeal"})
    BOOST_TEST(solving.find(library) != std::string::npos, library);
  BOOST_TEST(solving.find("libannulus_optimisers") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(check_plan_and_explain) {
  const test::TemporaryFolder folder("check");
  put_scene(folder.path(), test::quick_scene());
  BOOST_TEST(test::run_program(folder.path(), "check scene.toml").status == 0);
  const auto screen = test::run_program(folder.path(), "plan scene.toml");
  BOOST_TEST(screen.status == 0);
  BOOST_TEST(std::count(screen.out.begin(), screen.out.end(), '\n') <= 50);
  const auto plan = test::run_program(folder.path(), "plan scene.toml --inputs");
  BOOST_TEST(plan.status == 0);
  BOOST_TEST(plan.out.find("696.13714 Hz") != std::string::npos);
  const auto json = test::run_program(folder.path(), "plan scene.toml --json");
  BOOST_TEST(nlohmann::json::parse(json.out)["stage"].contains("mesh_frequency_Hz"));
  BOOST_TEST(test::run_program(folder.path(), "explain ring.pins").out.find("ring.pins") == 0U);
  const auto unknown = test::run_program(folder.path(), "explain ring.pinz");
  BOOST_TEST(unknown.status == 2);
  BOOST_TEST(unknown.err.find("ring.pins") != std::string::npos);

  put_scene(folder.path(), test::replaced(test::quick_scene(), "module_mm = 3.8", "module_mm = -3.8"));
  const auto wrong = test::run_program(folder.path(), "check scene.toml");
  BOOST_TEST(wrong.status == 2);
  BOOST_TEST(wrong.err.find("scene.toml:5:1: stage.module_mm = -3.8") == 0U, wrong.err);
}

// The smallest scene of the README, and what it prints there.
BOOST_AUTO_TEST_CASE(the_readme_shows_the_minimal_scene) {
  const test::TemporaryFolder folder("minimal");
  const auto readme = read_file(ANNULUS_SOURCE_DIR "/README.md");
  const auto fresh = test::run_program(folder.path(), "new --minimal");
  BOOST_TEST(std::count(fresh.out.begin(), fresh.out.end(), '\n') == 25);
  BOOST_TEST(readme.find("```toml\n" + fresh.out + "```") != std::string::npos);
  write_file(folder.path() / "my.toml", fresh.out);
  const auto run = test::run_program(folder.path(), "run my.toml --threads 2");
  BOOST_TEST_REQUIRE(run.status == 0, run.err);
  const auto table = run.out.substr(0, run.out.find("\n\n") + 1);
  BOOST_TEST(readme.find("```\n" + table + "```") != std::string::npos, table);
}

// Quiet means no table; what must be known before a number is trusted is still said, the second time too.
BOOST_AUTO_TEST_CASE(quiet_runs_still_warn) {
  const test::TemporaryFolder folder("quiet");
  put_scene(folder.path(), test::quick_scene());
  for (int i = 0; i < 2; ++i) {
    const auto quiet = test::run_program(folder.path(), "run scene.toml -q -o out");
    BOOST_TEST(quiet.status == 0, quiet.err);
    BOOST_TEST(quiet.out.empty(), quiet.out);
    BOOST_TEST(quiet.err.find("warning: sun mesh: the dynamics uses the prescribed half backlash") != std::string::npos,
               quiet.err);
  }
  const auto json = test::run_program(folder.path(), "run scene.toml --json -o out");
  BOOST_TEST(nlohmann::json::parse(json.out).contains("warnings"));
}

// What a command does not have is named, with what it has.
BOOST_AUTO_TEST_CASE(unknown_options_are_named) {
  const test::TemporaryFolder folder("options");
  put_scene(folder.path(), test::quick_scene());
  for (const auto& [arguments, name] : {std::pair{"run --thread 2 scene.toml", "--thread"},
                                        {"--frob", "--frob"},
                                        {"check scene.toml --strct", "--strct"}}) {
    const auto outcome = test::run_program(folder.path(), arguments);
    BOOST_TEST(outcome.status == 2);
    BOOST_TEST(outcome.err.find(std::string(name) + ": annulus") == 0U, outcome.err);
    BOOST_TEST(outcome.err.find("has no such option") != std::string::npos, outcome.err);
  }
}

// As if the file had other values; what is computed and what is shown are those.
BOOST_AUTO_TEST_CASE(settings_change_a_scene) {
  const test::TemporaryFolder folder("settings");
  put_scene(folder.path(), test::quick_scene());
  const auto plan =
      test::run_program(folder.path(), "plan scene.toml --json --set stage.power_kW=1000 --set title=Other");
  BOOST_TEST_REQUIRE(plan.status == 0, plan.err);
  const auto json = nlohmann::json::parse(plan.out);
  BOOST_TEST(json["title"] == "Other");
  for (const auto& input : json["inputs"])
    if (input["key"] == "stage.power_kW") BOOST_TEST(input["value"] == 1000);
  const auto wrong = test::run_program(folder.path(), "check scene.toml --set stage.powr_kW=1");
  BOOST_TEST(wrong.status == 2);
  BOOST_TEST(wrong.err.find("did you mean stage.power_kW?") != std::string::npos, wrong.err);
  BOOST_TEST(test::run_program(folder.path(), "check scene.toml --set stage.power_kW=-1").status == 2);
  const auto two = test::run_program(folder.path(), "check scene.toml --set 'accuracy=0.05\nmodel=\"plane\"'");
  BOOST_TEST(two.status == 2);
  BOOST_TEST(two.err.find("has several keys") != std::string::npos, two.err);
  BOOST_TEST(test::run_program(folder.path(), "check scene.toml --set ring.held.teeth=162").status == 0);
  BOOST_TEST(test::run_program(folder.path(), "check scene.toml --set ring.other.teeth=162").status == 2);
  // One value of a list.
  const std::string list = "errors.planet_eccentricity_um";
  const auto entry = test::run_program(folder.path(), "new --scene scene.toml --set '" + list + "[2]=30'");
  BOOST_TEST(entry.out.find("planet_eccentricity_um = [ 15, 30, 17, 38, 19 ]") != std::string::npos, entry.out);
  const auto beyond = test::run_program(folder.path(), "check scene.toml --set '" + list + "[6]=30'");
  BOOST_TEST(beyond.status == 2);
  BOOST_TEST(beyond.err.find("[6] must be a number from 1 to 5") != std::string::npos, beyond.err);
  BOOST_TEST(test::run_program(folder.path(), "check scene.toml --set 'stage.power_kW[1]=3'").status == 2);
}

BOOST_AUTO_TEST_CASE(run_writes_what_the_design_promises) {
  const test::TemporaryFolder folder("run");
  put_scene(folder.path(), test::quick_scene());
  const auto run = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST_REQUIRE(run.status == 0, run.err);
  BOOST_TEST(run.out.find("out/report.html") != std::string::npos);

  const auto json = nlohmann::json::parse(read_file(folder.path() / "out/summary.json"));
  BOOST_TEST(json["title"] == "Quick");
  const auto& ring = json["rings"]["held"];
  BOOST_TEST(ring["model"] == "prescribed");
  BOOST_TEST(ring["ring_planet"]["mean_stiffness_N_per_m"]["value"].get<double>() == 1.87e9,
             boost::test_tools::tolerance(1e-13));
  BOOST_TEST(std::abs(ring["ring_planet"]["contact_ratio"].get<double>() - 1.5826) < 5e-5);
  for (const auto* mesh : {"sun_planet", "ring_planet"}) {
    for (const auto* factor : {"dynamic_factor", "peak_factor"}) BOOST_TEST(ring[factor][mesh].size() == 5U);
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
  const auto modes = read_file(dynamics / "modes.csv");
  BOOST_TEST(modes.find("\nindex,frequency_Hz,kind,damped_frequency_Hz,damping_ratio,strain_sun_planet,") !=
             std::string::npos);
  for (const auto* name : {"load_sharing.csv", "force_factors.csv", "spectrum.csv"})
    BOOST_TEST(std::filesystem::exists(dynamics / name), name);

  // Each table of the motion against another one, or against what is known of it.
  constexpr double digits = 5e-6;  // half a unit of the sixth, which tables have
  const auto spectrum = Csv::read(dynamics / "spectrum.csv");
  BOOST_TEST(spectrum.columns.front() == "frequency_Hz");
  const auto mesh_frequency = json["operating_point"]["mesh_frequency_Hz"].get<double>();
  for (const auto& row : spectrum.rows)
    BOOST_TEST(std::abs(row[0] - row[spectrum.column("mesh_order")] * mesh_frequency) <= digits * row[0]);

  const auto& bearings = ring["bearing_forces"];
  const auto forces = Csv::read(dynamics / "bearing_forces.csv");
  BOOST_TEST(forces.rows.size() == 55U);
  double largest = 0;
  for (const auto& row : forces.rows) {
    BOOST_TEST(row[forces.column("planet2_resultant_max_N")] >= row[forces.column("planet2_resultant_min_N")]);
    largest = std::max(largest, row[forces.column("planet2_resultant_max_N")]);
  }
  // The top of a parabola through the samples lies above them, by its error at most.
  const double top = bearings["planet_max_N"][1], below = bearings["planet_max_error_N"][1];
  BOOST_TEST(largest <= top * (1 + digits));
  BOOST_TEST(largest >= top * (1 - digits) - below);
  // All pins carry the torque of the carrier, T_s (1 + z_r/z_s), over a = 201 mm; the ring takes T_s z_r/z_s. The
  // response repeats to 1e-3 of the mesh force.
  const double torque = json["operating_point"]["sun_torque_N_m"].get<double>();
  double tangential = 0;
  for (const auto& force : bearings["planet_mean_tangential_N"]) tangential += force.get<double>();
  BOOST_TEST(std::abs(tangential * 0.201 / (torque * (1 + 162.0 / 48)) - 1) <= 1e-3);
  BOOST_TEST(std::abs(bearings["held_torque_mean_N_m"].get<double>() / (-torque * 162 / 48) - 1) <= 1e-3);

  const auto orbit = Csv::read(dynamics / "sun_orbit.csv"), section = Csv::read(dynamics / "poincare.csv");
  BOOST_TEST(orbit.rows.size() == series.rows.size());
  BOOST_TEST(section.rows.size() == 55U);
  double farthest = 0;
  for (const auto& row : orbit.rows) farthest = std::max(farthest, std::hypot(row[3], row[4]));
  const auto& distance = json["variants"][0]["figures"]["sun_distance_m"];
  BOOST_TEST(distance["value"] == ring["sun_orbit"]["largest_m"]);
  BOOST_TEST(std::abs(farthest - distance["value"].get<double>()) <=
             digits * farthest + distance["error"].get<double>());
  for (std::size_t i = 0; i < section.rows.size(); ++i) {
    BOOST_TEST(section.rows[i][section.column("sun_x_m")] == orbit.rows[64 * i][1]);
    BOOST_TEST(section.rows[i][section.column("ring_planet5_force_N")] ==
               series.rows[64 * i][series.column("ring_planet5_force_N")]);
  }
  // The window is one error period; whether it repeats is known from the window before.
  BOOST_TEST(ring["poincare"]["section"] == (ring["dynamics"]["steady"].get<bool>() ? "period_1" : "undecided"));

  const auto shapes = Csv::read(dynamics / "mode_shapes.csv"), campbell = Csv::read(dynamics / "campbell.csv");
  BOOST_TEST(shapes.columns.size() == shapes.rows.size() + 2);  // one mode per DOF
  BOOST_TEST(campbell.columns.size() == shapes.rows.size() + 4);
  for (std::size_t i = 0; i < shapes.rows.size(); ++i)  // at rest, to the rounding of the unsymmetric solver
    BOOST_TEST(std::abs(campbell.rows.front()[i + 4] - shapes.rows[i][1]) <= digits * shapes.rows.back()[1]);
  const auto critical = Csv::read(dynamics / "critical_speeds.csv");
  BOOST_TEST(!critical.rows.empty());
  for (const auto& row : critical.rows)  // on its mesh order: the mesh frequency is 162 turns of the carrier
    BOOST_TEST(std::abs(row[critical.column("frequency_Hz")] / (row[critical.column("mesh_order")] * 162 *
                                                                row[critical.column("carrier_speed_rpm")] / 60) -
                        1) <= 2 * digits);
  // No temporary file is left behind.
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder.path() / "out"))
    BOOST_TEST(!is_unfinished(file.path()));
}

BOOST_AUTO_TEST_CASE(report_is_self_contained) {
  const test::TemporaryFolder folder("report");
  put_scene(folder.path(),
            test::replaced(test::quick_scene(), "title = \"Quick\"", "title = \"Quick <&> \\\"one\\\"\""));
  BOOST_TEST_REQUIRE(test::run_program(folder.path(), "run scene.toml -o out").status == 0);
  const auto page = read_file(folder.path() / "out/report.html");
  BOOST_TEST(page.find("Quick &lt;&amp;&gt;") != std::string::npos);
  for (const auto* outside : {"src=\"http", "href=\"http", "url(http", "@import", "<script src", "<link"}) {
    BOOST_TEST(page.find(outside) == std::string::npos, outside);
  }
  BOOST_TEST(page.find(">nan<") == std::string::npos);
  BOOST_TEST(page.find("</html>") != std::string::npos);
  for (const auto* part : {"Campbell diagram", "Mode shapes", "free rotation", "Sun orbit", "Poincaré section",
                           "Largest force of a planet bearing", "order, multiples of the mesh frequency"})
    BOOST_TEST(page.find(part) != std::string::npos, part);
}

BOOST_AUTO_TEST_CASE(unchanged_results_are_reused_and_changed_ones_are_not) {
  const test::TemporaryFolder folder("reuse");
  put_scene(folder.path(), test::quick_scene());
  BOOST_TEST_REQUIRE(test::run_program(folder.path(), "run scene.toml -o out").status == 0);
  const auto before = read_file(folder.path() / "out/held/dynamics/figures.json");
  const auto page = read_file(folder.path() / "out/report.html");
  std::filesystem::remove(folder.path() / "out/run.json");  // forget that the whole run is done
  const auto again = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(again.err.find("dynamics of 'held': unchanged, reused") != std::string::npos, again.err);
  BOOST_TEST(read_file(folder.path() / "out/held/dynamics/figures.json") == before);
  // The report of what was read back tells the same as the one of what was computed.
  const auto part = [](const std::string& text) {
    const auto begin = text.find("id=\"dynamics\"");
    return text.substr(begin, text.find("id=\"model\"") - begin);
  };
  BOOST_TEST((part(read_file(folder.path() / "out/report.html")) == part(page)));
  put_scene(folder.path(), test::replaced(test::quick_scene(), "half_backlash_um = 50", "half_backlash_um = 40"));
  const auto changed = test::run_program(folder.path(), "run scene.toml -o out --quiet");
  BOOST_TEST(changed.status == 0);
  BOOST_TEST(changed.out.empty());
  std::istringstream messages(changed.err);
  for (std::string line; std::getline(messages, line);) BOOST_TEST(line.starts_with("warning: "), line);
  BOOST_TEST(read_file(folder.path() / "out/held/dynamics/figures.json") != before);
}

BOOST_AUTO_TEST_CASE(an_identical_run_does_nothing_and_what_is_missing_is_made_again) {
  const test::TemporaryFolder folder("identical");
  put_scene(folder.path(), test::quick_scene());
  const auto out = folder.path() / "out";
  const auto run = [&](const std::string& more = "") {
    const auto done = test::run_program(folder.path(), "run scene.toml -o out" + more);
    BOOST_TEST(done.status == 0, done.err);
    return done.out.find("nothing has changed") != std::string::npos;
  };
  BOOST_TEST(!run());
  const auto report = out / "report.html", figures = out / "held/dynamics/figures.json";
  const auto written = std::filesystem::last_write_time(report);
  BOOST_TEST(run());
  BOOST_TEST((std::filesystem::last_write_time(report) == written));
  // Threads change no result.
  BOOST_TEST(run(" --threads 1"));
  const auto text = read_file(figures);
  std::filesystem::remove(figures);
  BOOST_TEST(!run());
  BOOST_TEST(read_file(figures) == text);
  BOOST_TEST(run());
  std::ofstream(report, std::ios::app) << "changed by hand";
  BOOST_TEST(!run());
  BOOST_TEST(read_file(report).find("changed by hand") == std::string::npos);
  std::ofstream(out / "run.json") << "{\"inputs_id\": 1";
  BOOST_TEST(!run());
  BOOST_TEST(run());
  // Another command on the same folder leaves something else behind.
  BOOST_TEST(test::run_program(folder.path(), "solve scene.toml -o out").status == 0);
  BOOST_TEST(!run());
}

BOOST_AUTO_TEST_CASE(dynamics_needs_its_table_and_solve_needs_none) {
  const test::TemporaryFolder folder("no_dynamics");
  const auto text = test::quick_scene();
  put_scene(folder.path(), text.substr(0, text.find("[dynamics]")));
  const auto dynamics = test::run_program(folder.path(), "dynamics scene.toml -o out");
  BOOST_TEST(dynamics.status == 2);
  BOOST_TEST(dynamics.err.find("[dynamics]") != std::string::npos);
  BOOST_TEST(test::run_program(folder.path(), "solve scene.toml -o out").status == 0);
  BOOST_TEST(test::run_program(folder.path(), "run scene.toml -o out").status == 0);
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
  const auto run = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(run.status == 0, run.err);
  put_scene(folder.path(), test::replaced(text, "ring.csv", "missing.csv"));
  const auto missing = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(missing.status == 2);
  BOOST_TEST(missing.err.find("missing.csv") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
