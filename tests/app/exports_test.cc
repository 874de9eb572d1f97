#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/scene/new_scene.h"
#include "app/scene/scene.h"
#include "app/scene/scene_kind.h"
#include "app/scene/scene_schema.h"
#include "core/csv.h"
#include "core/files.h"
#include "core/stiffness_table.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// `annulus export` and `annulus new`, read back by readers that are not annulus' own: Python (csv, xml, h5py) and
/// Octave.
namespace annulus {

namespace {

/// Any numbers will do, as long as no two are the same.
StiffnessTable some_table(int positions, int phases, const std::vector<double>& loads) {
  std::vector<double> angles;
  std::vector<StiffnessEntry> entries;
  for (int r = 0; r < positions; ++r) {
    angles.push_back(2 * std::numbers::pi * (r + 0.1) / 162);
    for (int p = 0; p < phases; ++p)
      for (const double load : loads) {
        const double secant = 1e9 * (1 + 0.1 * std::sin(r + 0.3 * p)) + load, unloaded = 1e-6 * std::cos(p + r);
        entries.push_back({.unloaded_te = unloaded,
                           .lte = unloaded + load / secant,
                           .stiffness_secant = secant,
                           .stiffness_tangent = 1.1 * secant,
                           .error_relative = 0.01});
      }
  }
  StiffnessTable table("ring_planet", phases, std::move(angles), loads, std::move(entries));
  table.provenance = {{"annulus_version", "test"}, {"model", "plane"}};
  return table;
}

/// Runs a reader; what it prints.
std::string read_with(const std::string& command, const std::filesystem::path& folder) {
  const auto out = folder / "reader.txt";
  const int status =
      std::system(("cd '" + folder.string() + "' && { " + command + "; } >reader.txt 2>reader_errors.txt").c_str());
  const auto text = read_file(out);
  BOOST_TEST(status == 0, command << ": " << text << read_file(folder / "reader_errors.txt"));
  return text;
}

const std::string python = "'" ANNULUS_PYTHON "' '" ANNULUS_SOURCE_DIR "/tests/app/read_exports.py' ";

void export_to(const std::filesystem::path& folder, const std::string& arguments) {
  const auto outcome = test::run_program(folder, "export " + arguments);
  BOOST_TEST(outcome.status == 0, arguments << ": " << outcome.err);
}

std::string refusal(const std::filesystem::path& folder, const std::string& arguments) {
  const auto outcome = test::run_program(folder, arguments);
  BOOST_TEST(outcome.status == 2, arguments);
  return outcome.err;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(exports)

BOOST_AUTO_TEST_CASE(every_format_of_a_table_is_read_back_by_others) {
  const test::TemporaryFolder folder("exports");
  for (const auto& [positions, phases, loads] :
       {std::tuple{3, 8, std::vector<double>{1e3, 5e4, 1.234567890123e5}}, {1, 5, std::vector<double>{2e4}}}) {
    const auto table = some_table(positions, phases, loads);
    table.write_csv(folder.path() / "stiffness.csv");
    for (const auto& [format, file] : {std::pair{"csv", "table.csv"},
                                       {"hdf5", "table.h5"},
                                       {"matlab", "table.mat"},
                                       {"modelica", "table.txt"},
                                       {"adams", "table.adm"},
                                       {"simpack", "table.afs"}})
      export_to(folder.path(), fmt::format("stiffness.csv --to {} -o {}", format, file));
    const int rows = positions * phases * static_cast<int>(loads.size());
    const int numbers = std::stoi(read_with(python + "table stiffness.csv .", folder.path()));
    BOOST_TEST(numbers > 4 * 4 * rows);  // four quantities in four formats at least
    const auto octave =
        read_with("octave-cli --no-init-file '" ANNULUS_SOURCE_DIR "/tests/app/read_matlab.m' table.mat stiffness.csv",
                  folder.path());
    BOOST_TEST(octave == fmt::format("{}\n", 7 * rows));
  }
  export_to(folder.path(), "stiffness.csv --to adams --base-id 101 -o numbered.adm");
  const auto numbered = read_file(folder.path() / "numbered.adm");
  for (const auto* id : {"SPLINE/101,", "SPLINE/102,", "SPLINE/103,", "SPLINE/104,"})
    BOOST_TEST(numbered.find(id) != std::string::npos, id);
  BOOST_TEST(refusal(folder.path(), "export stiffness.csv --to simpack --base-id 5").find("no numbered statements") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_ring_matrix_is_inverted) {
  const test::TemporaryFolder folder("exports_matrix");
  Csv csv;
  csv.columns = {"tooth"};
  constexpr int teeth = 12;
  for (int j = 0; j < teeth; ++j) csv.columns.push_back(fmt::format("compliance_tooth_{}_m_per_N", j));
  for (int i = 0; i < teeth; ++i) {
    csv.rows.push_back({static_cast<double>(i)});
    for (int j = 0; j < teeth; ++j) csv.rows.back().push_back(1e-9 * std::exp(-std::abs(i - j)));  // positive definite
  }
  csv.write(folder.path() / "ring_compliance.csv");
  export_to(folder.path(), "ring_compliance.csv --to hdf5 -o ring.h5");
  export_to(folder.path(), "ring_compliance.csv --to csv -o ring.csv");
  BOOST_TEST(read_with(python + "matrix ring_compliance.csv .", folder.path()) ==
             fmt::format("{}\n", 3 * teeth * teeth));
  BOOST_TEST(refusal(folder.path(), "export ring_compliance.csv --to adams").find("is not a stiffness table") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(any_table_goes_as_columns) {
  const test::TemporaryFolder folder("exports_columns");
  const Csv csv{{{"content", "a test"}}, {"time_s", "sun_u_m"}, {{0, 1e-6}, {0.5, 2e-6}}};
  csv.write(folder.path() / "series.csv");
  export_to(folder.path(), "series.csv --to matlab");
  BOOST_TEST(read_with("octave-cli --no-init-file --eval \"s = load('series.mat'); printf('%g %g %s', s.time_s(2), "
                       "s.sun_u_m(2) * 1e6, s.provenance.content)\"",
                       folder.path()) == "0.5 2 a test");
  export_to(folder.path(), "series.csv --to csv");
  BOOST_TEST(read_file(folder.path() / "series.plain.csv").starts_with("time_s,sun_u_m\n"));
}

BOOST_AUTO_TEST_CASE(gear_data_as_rexs_and_back) {
  const test::TemporaryFolder folder("exports_rexs");
  const auto made = test::run_program(folder.path(), "new planetary");
  BOOST_REQUIRE(made.status == 0);
  write_file(folder.path() / "stage.toml", made.out);
  export_to(folder.path(), "stage.toml --to rexs");
  // Of data/scenes/ring_types.toml; diameters by hand: d = m z, and for the ring d_f as the scene's rules give it.
  const auto read = read_with(python +
                                  "rexs stage.rexs ring_gear.number_of_teeth@none=-162 "
                                  "cylindrical_gear.number_of_teeth@none=48 cylindrical_gear.normal_module@mm=3.8 "
                                  "cylindrical_gear.reference_circle_diameter@mm=182.4 "
                                  "ring_gear.reference_circle_diameter@mm=-615.6 ring_gear.mass_of_component@kg=31.25 "
                                  "cylindrical_gear_flank.addendum_modification_coefficient@none=0.7608 "
                                  "cylindrical_gear_flank.normal_pressure_angle@deg=22.5 "
                                  "cylindrical_stage.center_distance@mm=201 material.elastic_modulus@N_/_mm^2=206000 "
                                  "material.density@kg_/_dm^3=7.85 planet_carrier.mass_of_component@kg=400.1 "
                                  "ring_gear.custom_annulus_outside_diameter_mm@mm=663.6 "
                                  "planetary_stage.custom_annulus_supports.sun_N_per_m@N/m=1e7",
                              folder.path());
  BOOST_TEST(read ==
             "14 cylindrical_gear:6 cylindrical_gear_flank:14 cylindrical_stage:10 gear_unit:1 material:1 "
             "planet_carrier:1 planetary_stage:1 ring_gear:1\n");

  const auto back = test::run_program(folder.path(), "new --rexs stage.rexs");
  BOOST_REQUIRE(back.status == 0);
  const auto first = app::parse_scene(made.out, "stage.toml"), second = app::parse_scene(back.out, "back.toml");
  std::map<std::string, std::string> values;
  for (const auto& input : second.inputs) values[input.key] = app::to_text(input.value);
  int compared = 0;
  for (const auto& input : first.inputs) {
    if (input.origin != app::Origin::scene || input.key == "ring.name") continue;
    BOOST_TEST(values[input.key] == app::to_text(input.value), input.key);
    ++compared;
  }
  BOOST_TEST(compared > 40);
}

BOOST_AUTO_TEST_CASE(rexs_of_others) {
  const test::TemporaryFolder folder("exports_rexs_others");
  // What another program might write: metres, no custom attributes, one planet listed twice, positive ring teeth.
  const auto gear = [](int id, const char* type, int teeth) {
    return fmt::format(
        R"(<component id="{0}" type="{1}"><attribute id="number_of_teeth" unit="none">{2}</attribute>)"
        R"(<attribute id="normal_module" unit="m">0.002</attribute><attribute id="face_width" unit="mm">20</attribute>)"
        R"(</component><component id="{3}" type="cylindrical_gear_flank"><attribute id="normal_pressure_angle" unit="rad">)"
        R"({4}</attribute><attribute id="profile_shift_coefficient">0.1</attribute></component>)",
        id, type, teeth, id + 10, std::numbers::pi / 9);
  };
  const auto relation = [](int id, const char* type, const std::string& refs) {
    return fmt::format(R"(<relation id="{}" type="{}">{}</relation>)", id, type, refs);
  };
  const auto ref = [](int id, const char* role) { return fmt::format(R"(<ref id="{}" role="{}"/>)", id, role); };
  const auto text = [&](const char* version, const std::string& more) {
    return fmt::format(
               R"(<?xml version="1.0"?><model version="{}" applicationId="x" applicationVersion="1" date="2026-01-01"><relations>)",
               version) +
           relation(1, "stage", ref(30, "stage") + ref(1, "gear_1") + ref(2, "gear_2")) +
           relation(2, "stage", ref(31, "stage") + ref(2, "gear_1") + ref(3, "gear_2")) +
           relation(3, "flank", ref(1, "gear") + ref(11, "left")) +
           relation(4, "flank", ref(2, "gear") + ref(12, "left")) +
           relation(5, "flank", ref(3, "gear") + ref(13, "left")) + more + "</relations><components>" +
           gear(1, "cylindrical_gear", 20) + gear(2, "cylindrical_gear", 30) + gear(3, "ring_gear", 80) +
           R"(<component id="30" type="cylindrical_stage"><attribute id="center_distance" unit="mum">50200</attribute></component>)"
           R"(<component id="31" type="cylindrical_stage"/></components></model>)";
  };
  write_file(folder.path() / "other.rexs", text("1.2", ""));
  const auto outcome = test::run_program(folder.path(), "new --rexs other.rexs");
  BOOST_TEST(outcome.status == 0, outcome.err);
  for (const char* line : {"\nmodule_mm = 2\n", "\nface_width_mm = 20\n", "\nplanets = 1\n", "\nteeth = 80\n",
                           "\ncentre_distance_mm = 50.2\n", "check it"})
    BOOST_TEST(outcome.out.find(line) != std::string::npos, line);
  BOOST_TEST(outcome.out.find("power_kW =      <- to be filled in") != std::string::npos);
  // 20 degrees, but for rounding of the unit.
  BOOST_TEST(outcome.out.find("\npressure_angle_deg = 20") != std::string::npos);
  // Speed and torque at the shaft of the sun, angles in the sign of versions up to 1.3.
  auto loaded = text("1.2", relation(6, "assembly", ref(40, "assembly") + ref(1, "part")) +
                                relation(7, "assembly", ref(40, "assembly") + ref(41, "part")));
  loaded = test::replaced(
      loaded, "</components>",
      R"(<component id="40" type="shaft"><attribute id="rotational_speed" unit="1 / min">-1500</attribute></component>)"
      R"(<component id="41" type="external_load"><attribute id="torque_around_u_axis" unit="N m">75</attribute>)"
      "</component></components>");
  for (const auto& [old, with] : {std::pair{std::string("unit=\"rad\""), std::string("unit=\"°\"")},
                                  {fmt::format("{}", std::numbers::pi / 9), "20"}})
    for (std::size_t at = 0; (at = loaded.find(old, at)) != std::string::npos;) loaded.replace(at, old.size(), with);
  write_file(folder.path() / "loaded.rexs", loaded);
  const auto moved = test::run_program(folder.path(), "new --rexs loaded.rexs");
  BOOST_TEST(moved.status == 0, moved.err);
  for (const char* line : {"\nsun_speed_rpm = 1500\n", "\nsun_torque_Nm = 75\n", "\npressure_angle_deg = 20\n"})
    BOOST_TEST(moved.out.find(line) != std::string::npos, line);
  // A character that TOML wants escaped, in the title.
  write_file(folder.path() / "dele\x7fte.rexs", text("1.2", ""));
  const auto odd = test::run_program(folder.path(), "new --rexs dele\x7fte.rexs");
  BOOST_TEST(odd.out.find(R"(title = "dele\u007fte")") != std::string::npos, odd.err);

  const auto refused = [&](const std::string& content, const std::string& what) {
    write_file(folder.path() / "bad.rexs", content);
    const auto message = refusal(folder.path(), "new --rexs bad.rexs");
    BOOST_TEST(message.find(what) != std::string::npos, message);
  };
  refused("no xml", "cannot be read as XML");
  refused("<model version=\"1.4\" name=\"caf\xe9\"/>", "is not UTF-8 (byte 30) and declares no other encoding");
  refused("<?xml version=\"1.0\"?><html/>", "no element 'model'");
  refused(text("2.0", ""), "REXS version '2.0'");
  refused(text("1.2", relation(6, "stage", ref(30, "stage") + ref(2, "gear_1") + ref(77, "gear_2"))), "component 77");
  refused(text("1.2", relation(6, "stage", ref(30, "stage") + ref(2, "gear_1") + ref(11, "gear_2"))), "one sun");
  auto spoilt = text("1.2", "");
  spoilt.replace(spoilt.find(">20<"), 4, ">two<");
  refused(spoilt, "number_of_teeth = 'two' is not a number");
  for (const char* blank : {"", "  "}) {
    spoilt = text("1.2", "");
    spoilt.replace(spoilt.find(">20<"), 4, std::string(">") + blank + "<");
    refused(spoilt, "is not a number");
  }
  spoilt = text("1.2", "");
  spoilt.replace(spoilt.find("unit=\"m\""), 8, "unit=\"inch\"");
  refused(spoilt, "normal_module is in 'inch'");
}

BOOST_AUTO_TEST_CASE(what_cannot_be_exported) {
  const test::TemporaryFolder folder("exports_refused");
  write_file(folder.path() / "stage.toml", test::run_program(folder.path(), "new two_k_v").out);
  some_table(1, 4, {1e3}).write_csv(folder.path() / "stiffness.csv");
  const auto message = [&](const std::string& arguments) { return refusal(folder.path(), "export " + arguments); };
  BOOST_TEST(message("stiffness.csv --to mathlab").find("did you mean matlab?") != std::string::npos);
  BOOST_TEST(message("stiffness.csv --to rexs").find("rexs takes a scene") != std::string::npos);
  BOOST_TEST(message("stage.toml --to simpack").find("takes a table of a run") != std::string::npos);
  BOOST_TEST(message("stage.toml --to rexs")
                 .find("REXS does not describe its gears, only those of planetary and helical_pair") !=
             std::string::npos);
  BOOST_TEST(message("nowhere.csv --to hdf5").find("cannot read nowhere.csv") != std::string::npos);
  BOOST_TEST(message("stiffness.csv --to hdf5 -o nowhere/x.h5").find("cannot write nowhere/x.h5") != std::string::npos);
  BOOST_TEST(message("stiffness.csv --to matlab -o nowhere/x.mat").find("cannot write nowhere/x.mat") !=
             std::string::npos);
  BOOST_TEST(message("stiffness.csv --to csv -o stiffness.csv").find("the file to be exported itself") !=
             std::string::npos);
}

// One digit of a table that a run wrote: its values are no longer those of the scene.
BOOST_AUTO_TEST_CASE(altered_results_are_not_exported) {
  const test::TemporaryFolder folder("exports_altered");
  write_file(folder.path() / "scene.toml", test::pinned_scene());
  BOOST_REQUIRE(test::run_program(folder.path(), "solve scene.toml --out out --quiet").status == 0);
  const auto table = folder.path() / "out/held/stiffness_ring_planet.csv";
  export_to(folder.path(), "out/held/stiffness_ring_planet.csv --to csv -o before.csv");
  auto text = read_file(table);
  const auto last = text.find_last_of("12345678");
  text[last] = static_cast<char>(text[last] + 1);
  write_file(table, text);
  BOOST_TEST(refusal(folder.path(), "export out/held/stiffness_ring_planet.csv --to csv -o after.csv")
                 .find("has changed since the run that wrote it") != std::string::npos);
  BOOST_TEST(!std::filesystem::exists(folder.path() / "after.csv"));
  std::filesystem::copy(table, folder.path() / "own.csv");
  export_to(folder.path(), "own.csv --to csv -o after.csv");
}

BOOST_AUTO_TEST_CASE(new_scenes_are_good_and_tell_every_key) {
  const test::TemporaryFolder folder("new_scenes");
  for (const auto& kind : app::stage_kinds()) {
    const auto made = test::run_program(folder.path(), std::string("new ") + kind);
    BOOST_REQUIRE(made.status == 0);
    write_file(folder.path() / "scene.toml", made.out);
    // The parts of a train are files of its user.
    BOOST_TEST((test::run_program(folder.path(), "check scene.toml").status == 0) == app::scene_kind(kind).gears);
    for (const auto& table : app::schema()) {
      for (const auto& p : table.parameters)
        if (table.applies_to(kind) && p.applies_to(kind))
          BOOST_TEST((made.out.find("\n" + p.name + " = ") != std::string::npos ||
                      made.out.find("\n# " + p.name + " =") != std::string::npos),
                     kind << ": " << p.key());
    }
  }
  BOOST_TEST(refusal(folder.path(), "new planetry").find("did you mean planetary?") != std::string::npos);
  BOOST_TEST(refusal(folder.path(), "new").find("the kinds are planetary") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_stiffness_of_another_program_drives_the_dynamics) {
  // The harmonic wave of a scene as another program might give it: as a transmission error under one load, uneven
  // phases.
  const test::TemporaryFolder folder("imports");
  constexpr double mean = 1.364e9, ripple = 0.2258, load = 40000;
  std::string curve = "# program: elsewhere\nmesh_phase,lte_um,load_N\n";
  constexpr int points = 150;
  for (int i = 0; i < points; ++i) {
    const double phase = (i + 0.3 * std::sin(0.7 * i)) / points + 0.002;
    const double stiffness = mean * (1 + ripple * std::cos(2 * std::numbers::pi * phase));
    curve += fmt::format("{:.12g},{:.12g},{}\n", phase, 1e6 * load / stiffness, load);
  }
  write_file(folder.path() / "other.csv", curve);
  write_file(folder.path() / "given.toml", test::quick_scene());
  write_file(folder.path() / "imported.toml",
             test::replaced(test::quick_scene(),
                            "[mesh.sun_planet]\nstiffness = \"harmonic\"\nmean_N_per_m = 1.364e9\nripple = 0.2258\n",
                            "[mesh.sun_planet]\nstiffness = \"table\"\nfile = \"other.csv\"\n"));
  const auto figures = [&](const std::string& name) {
    const auto outcome = test::run_program(folder.path(), "run " + name + ".toml -o " + name);
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const auto ring = nlohmann::json::parse(read_file(folder.path() / name / "summary.json"))["rings"]["held"];
    std::vector<double> values = {ring["load_sharing"]["sun_planet"]["averaged"]["value"],
                                  ring["load_sharing"]["ring_planet"]["instantaneous"]["value"]};
    for (const auto& factor : ring["dynamic_factor"]["sun_planet"]) values.push_back(factor);
    return values;
  };
  const auto given = figures("given"), imported = figures("imported");
  BOOST_TEST_REQUIRE(given.size() == imported.size());
  // Cubics through 150 uneven points miss the wave by 1e-4 of it; dynamic factors follow by some times that.
  for (std::size_t i = 0; i < given.size(); ++i)
    BOOST_TEST(given[i] == imported[i], boost::test_tools::tolerance(5e-4));
  BOOST_TEST(given != imported);

  write_file(folder.path() / "other.csv", "mesh_phase,lte_um\n0,1\n");
  const auto bad = test::run_program(folder.path(), "check imported.toml");
  BOOST_TEST(bad.status == 2);
  BOOST_TEST(bad.err.find("lte needs a column load_N") != std::string::npos, bad.err);
  BOOST_TEST(bad.err.find("mesh.sun_planet.file") != std::string::npos, bad.err);
}

BOOST_AUTO_TEST_CASE(completion_completes) {
  const test::TemporaryFolder folder("completion");
  write_file(folder.path() / "bash", test::run_program(folder.path(), "completion bash").out);
  const auto complete = [&](const std::string& words, int at) {
    return read_with(
        fmt::format("bash -c 'source ./bash; COMP_WORDS=({}); COMP_CWORD={}; _annulus; echo ${{COMPREPLY[*]}}'", words,
                    at),
        folder.path());
  };
  BOOST_TEST(complete("annulus exp", 1) == "export explain\n");
  BOOST_TEST(complete("annulus run --bud", 2) == "--budget\n");
  BOOST_TEST(complete("annulus export --t", 2) == "--to --threads\n");
  for (const char* shell : {"zsh", "fish"})
    BOOST_TEST(test::run_program(folder.path(), std::string("completion ") + shell).out.find("tradeoff") !=
               std::string::npos);
  BOOST_TEST(refusal(folder.path(), "completion tcsh").find("bash, zsh and fish") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(colours_are_for_terminals) {
  const test::TemporaryFolder folder("colours");
  // `script` runs a command on a terminal of its own.
  const std::string command = "script -qec \"'" ANNULUS_PROGRAM "' check nowhere.toml\" /dev/null || true";
  BOOST_TEST(test::run_program(folder.path(), "check nowhere.toml").err.find('\x1b') == std::string::npos);
  BOOST_TEST(read_with("env -u NO_COLOR TERM=xterm " + command, folder.path()).find("\x1b[31m") != std::string::npos);
  BOOST_TEST(read_with("env NO_COLOR=1 TERM=xterm " + command, folder.path()).find('\x1b') == std::string::npos);
}

BOOST_AUTO_TEST_CASE(vtk_reads_the_bodies_of_a_mesh_cycle) {
  const test::TemporaryFolder folder("exports_fields");
  write_file(folder.path() / "scene.toml", "accuracy = 0.03\nmodel = \"plane\"\n" + test::small_stage());
  export_to(folder.path(), "scene.toml --to paraview -o cycle.pvd");
  const auto read = read_with("'" ANNULUS_PYTHON "' '" ANNULUS_SOURCE_DIR
                              "/tests/app/read_fields.py' cycle.pvd sun_planet=planet,sun ring_planet=planet,ring",
                              folder.path());
  BOOST_TEST(read == "16 2\n");
  BOOST_TEST(refusal(folder.path(), "export scene.toml --to paraview -o cycle").find("must end with .pvd") !=
             std::string::npos);
  write_file(folder.path() / "prescribed.toml", test::quick_scene());
  BOOST_TEST(refusal(folder.path(), "export prescribed.toml --to paraview").find("no mesh of this scene has fields") !=
             std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
