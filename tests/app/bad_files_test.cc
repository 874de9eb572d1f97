#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <ctime>
#include <numbers>

#include "app/model/gear_system.h"
#include "app/scene/scene_files.h"
#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "app/study/studies.h"
#include "core/errors.h"
#include "core/files.h"
#include "tests/app/bad_scenes.h"
#include "tests/app/run_program.h"

/// Scenes that are no text or no end of text, keys that contradict each other, and the files a scene names.
namespace annulus {

namespace {

std::string refusal(const std::string& text, const std::filesystem::path& file = "scene.toml") {
  try {
    const auto scene = app::parse_scene(text, file);
    app::check_stage(scene);
    app::check_files(scene);
    app::check_studies(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string times(int n, const std::string& text) {
  std::string result;
  for (int i = 0; i < n; ++i) result += text;
  return result;
}

void check_refused(const std::string& text, const std::vector<std::string>& words,
                   const std::filesystem::path& file = "scene.toml") {
  const auto start = std::clock();
  const auto message = refusal(text, file);
  const double processor_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const auto head = text.substr(0, 40);
  BOOST_TEST(message.starts_with(file.string() + ":"), head << ": " << message);
  for (const auto& word : words) BOOST_TEST(message.find(word) != std::string::npos, message << " lacks " << word);
  // On one screen, and with nothing that moves the cursor.
  BOOST_TEST(message.size() < 30000U);
  for (const char c : message) BOOST_TEST_REQUIRE((static_cast<unsigned char>(c) >= 0x20 || c == '\n'));
  BOOST_TEST(processor_seconds < 5.0, head);  // a second at most, sanitizers some
}

std::string with(const std::string& what, const std::string& by) {
  return test::replaced(test::quick_scene(), what, by);
}

/// The scene whose ring mesh is given by a file.
std::string table_scene(const std::string& file) {
  return with("stiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294",
              "stiffness = \"table\"\nfile = \"" + file + "\"");
}

std::string good_table(const std::string& mesh = "ring_planet") {
  std::string text = "# mesh: " + mesh +
                     "\n# rows: 12\nmesh_phase,ring_angle_deg,load_N,unloaded_te_m,lte_m,stiffness_secant_N_per_m,"
                     "stiffness_tangent_N_per_m,error_relative\n";
  for (int phase = 0; phase < 4; ++phase)
    for (const double load : {3e4, 6e4, 9e4})
      text += fmt::format("{},0,{},0,{:.17g},1.87e9,1.87e9,0.01\n", phase / 4.0, load, load / 1.87e9);
  return text;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(bad_files)

BOOST_AUTO_TEST_CASE(what_is_no_scene) {
  check_refused("", {"[stage] is missing", "[material] is missing"});
  check_refused("\n\n# nothing\n", {"[stage] is missing"});
  check_refused("\xff\xfe[stage]\n", {"scene.toml:1:", "not valid TOML"});
  check_refused(with("\"Quick\"", "\"Qu\xffick\""), {"scene.toml:1:", "not valid TOML"});
  check_refused(with("\"Quick\"", "\"Qu\xc0\x80ick\""), {"scene.toml:1:", "not valid TOML"});
  check_refused(with("\"Quick\"", "\"\xed\xa0\x80\""), {"scene.toml:1:", "not valid TOML"});
  check_refused(with("\"Quick\"", std::string("\"Qu\0ick\"", 8)), {"scene.toml:1:", "not valid TOML"});
  check_refused(std::string("\0\0\0\0", 4) + test::quick_scene(), {"scene.toml:1:", "not valid TOML"});
  check_refused("\x7f\x45LF\x02\x01\x01", {"scene.toml:1:", "not valid TOML"});
  check_refused("<html><body>Not found</body></html>\n", {"scene.toml:1:", "not valid TOML"});
  check_refused("{\"title\": \"json\"}\n", {"scene.toml:1:", "not valid TOML"});
  check_refused(test::quick_scene().substr(0, 200), {"scene.toml:"});
  check_refused(with("\"Quick\"", "\"Quick"), {"scene.toml:1:", "not valid TOML"});
  // A mark of UTF-8 and the line ends of another system are no errors.
  BOOST_TEST(refusal("\xef\xbb\xbf" + test::quick_scene()) == "");
  std::string dos;
  for (const char c : test::quick_scene()) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  BOOST_TEST(refusal(dos) == "");
}

BOOST_AUTO_TEST_CASE(scenes_without_end) {
  const auto scene = test::quick_scene();
  check_refused(scene + "# " + std::string(10'000'000, 'x'), {"1000000 bytes"});
  check_refused(scene + std::string(10'000'000, '\n'), {"1000000 bytes"});
  check_refused(std::string(20'000'000, '\0'), {"1000000 bytes"});
  BOOST_TEST(refusal(scene + "# " + std::string(app::largest_scene - scene.size() - 3, 'x') + "\n") == "");
  // One byte below the limit, of all sorts.
  const int much = 190'000;
  check_refused("a = " + times(much, "[") + times(much, "]"), {"scene.toml:1:", "not valid TOML"});
  check_refused("a = " + times(much, "{a="), {"scene.toml:1:", "not valid TOML"});
  check_refused("a = " + times(much, "[{a="), {"scene.toml:1:", "not valid TOML"});
  check_refused("a" + times(much, ".a") + " = 1", {"scene.toml:1:1:", "more than 16 parts"});
  check_refused("a" + times(150'000, " . \"a\"") + " = 1", {"scene.toml:1:1:", "more than 16 parts"});
  check_refused("[a" + times(much, ".a") + "]\n", {"scene.toml:1:1:", "more than 16 parts"});
  check_refused("[[a" + times(150'000, ".'a.b'") + "]]\n", {"scene.toml:1:1:", "more than 16 parts"});
  check_refused("x = {a" + times(much, ".a") + "=1}\n", {"scene.toml:1:1:", "more than 16 parts"});
  check_refused(scene + "[x]\n" + std::string(900'000, 'k') + " = 1\n", {"unknown"});
  check_refused("title = \"" + std::string(900'000, 'k') + "\"\n", {"title", "at most 1000"});
  std::string keys, rings, tables;
  for (int i = 0; i < 60'000; ++i) keys += fmt::format("key{} = 1\n", i);
  check_refused(keys, {"key0: unknown key", "there are more problems"});
  check_refused("[stage]\n" + keys, {"stage.key0 = 1: unknown key", "there are more problems"});
  check_refused("[assumed]\n" + keys, {"there are more problems"});
  check_refused("[mesh]\n" + keys, {"there are more problems"});
  for (int i = 0; i < 20'000; ++i) rings += fmt::format("[[ring]]\nname = \"r{}\"\n", i);
  check_refused(rings, {"[[ring]]: there are 20000, at most 100"});
  for (int i = 0; i < 60'000; ++i) tables += fmt::format("[t{}]\n", i);
  check_refused(tables, {"t0: unknown table", "there are more problems"});
  check_refused(with("[15, 36, 17, 38, 19]", "[" + times(300'000, "1,") + "1]"), {"at most 1000"});
  // Dots in texts, numbers and comments are none of keys.
  const auto dots = times(30, ".");
  BOOST_TEST(refusal(with("\"Quick\"", "\"" + dots + "\\\"" + dots + "\" # " + dots)) == "");
  BOOST_TEST(refusal(with("\"Quick\"", "'''" + dots + "''" + dots + "'''")) == "");
}

BOOST_AUTO_TEST_CASE(messages_show_no_control_characters) {
  check_refused("\"a\\u001b[31m\\nb\" = 1\n", {"a\\u001b[31m\\nb: unknown key"});
  check_refused("[stage]\nkind = \"\\u001b[2J\"\n", {"scene.toml:2:1: stage.kind = \"\\u001b[2J\""});
  check_refused("[assumed]\n\"a\\nb\" = 3\n", {"assumed.a\\nb"});
  check_refused(with("name = \"held\"", "name = \"a\\u001b[2Jb\""), {"ring.name"});
}

BOOST_AUTO_TEST_CASE(contradictions) {
  check_refused(with("sun_speed_rpm = 1128", "sun_speed_rpm = 1128\ncarrier_speed_rpm = 257"),
                {"scene.toml:11:1:", "stage.carrier_speed_rpm = 257", "is given beside stage.sun_speed_rpm"});
  check_refused(with("power_kW = 2958.8", "power_kW = 2958.8\npinion_torque_Nm = 3"),
                {"scene.toml:10:1:", "stage.pinion_torque_Nm = 3", "has no meaning", "helical_pair"});
  check_refused(with("outside_diameter_mm = 663.6", "outside_diameter_mm = 663.6\nrim_thickness_mm = 3"),
                {"scene.toml:32:1:", "ring.rim_thickness_mm", "either"});
  // Centre distance against profile shifts: no backlash left, and no mesh at all.
  check_refused(with("centre_distance_mm = 201", "centre_distance_mm = 200"), {"scene.toml:", "centre distance"});
  check_refused(with("centre_distance_mm = 201", "centre_distance_mm = 20"), {"scene.toml:"});
  check_refused(with("centre_distance_mm = 201", "centre_distance_mm = 2010"), {"scene.toml:"});
  check_refused(with("profile_shift = 0.7608", "profile_shift = 1.2"), {"scene.toml:"});
  check_refused(test::replaced(with("planets = 5", "planets = 4"), test::quick_errors(), ""),
                {"scene.toml:", "assembly condition"});
  check_refused(with("outside_diameter_mm = 663.6", "outside_diameter_mm = 600"),
                {"scene.toml:27:", "ring 'held'", "outside_diameter_mm"});
  // Tip and root exchanged, bore through the teeth, a sleeve thicker than the rim, no rim at all.
  check_refused(with("[planet]", "tip_diameter_mm = 180\nroot_diameter_mm = 200\n[planet]"), {"scene.toml:"});
  const auto computed = test::computed_set();
  BOOST_TEST(refusal(computed) == "");
  check_refused(test::replaced(computed, "bore_diameter_mm = 60", "bore_diameter_mm = 190"),
                {"scene.toml:14:1:", "sun.bore_diameter_mm = 190", "0 < value <=", "mm"});
  check_refused(test::replaced(computed, "bore_diameter_mm = 90", "bore_diameter_mm = 205"),
                {"planet.bore_diameter_mm = 205", "0 < value <="});
  check_refused(test::replaced(computed, "sleeve_thickness_mm = 10", "sleeve_thickness_mm = 25"),
                {"ring 'sleeve'", "sleeve_thickness_mm = 25", "0 < value <= 19.62 mm"});
  check_refused(test::replaced(computed, "hoop_thickness_mm = 5\n", ""), {"ring.hoop_width_mm", "hoop_thickness_mm"});
  check_refused(test::replaced(computed, "outside_diameter_mm = 663.6", "rim_thickness_mm = 0.1"),
                {"ring 'held'", "rim_thickness_mm = 0.1", "at least"});
  check_refused(test::replaced(computed, "pins = 24\n", "pins = 24\npin_angles_deg = [0, 10]\n"),
                {"ring.pin_angles_deg", "either"});
  check_refused(test::replaced(computed, "pins = 24\n", "pins = 2000\n"), {"ring.pins = 2000", "overlap"});
  // Studies against the keys they vary.
  const auto given = test::good_scenes().front().text;
  check_refused(test::replaced(given, "values = [0.05, 0.06]\n[[grid]]", "values = [0.05, 3]\n[[grid]]"),
                {"sweep.values", "dynamics.mesh_damping_ratio = 3", "0 <= value <= 2"});
  check_refused(test::replaced(given, "values = [0.05, 0.06]\n[[grid]]", "from = 0\nto = 1\nvalues = [0.05]\n[[grid]]"),
                {"sweep.values", "either"});
  check_refused(
      test::replaced(test::replaced(given, "y_values = [0.03, 0.04]", "y_from = 0\ny_to = 1\ny_count = 10000"),
                     "x_values = [0.05, 0.06]", "x_from = 0\nx_to = 1\nx_count = 10000"),
      {"grid.x_input", "10000 x 10000 points", "at most 100000"});
  check_refused(test::replaced(given, "high = 0.06\n[sensitivity]", "high = 6\n[sensitivity]"),
                {"monte_carlo.input", "dynamics.mesh_damping_ratio", "0 <= value <= 2"});
}

BOOST_AUTO_TEST_CASE(tables_that_are_none) {
  const test::TemporaryFolder folder("bad_tables");
  const auto scene = folder.path() / "scene.toml", table = folder.path() / "ring.csv";
  const auto place = scene.string() + ":46:1: mesh.ring_planet.file = \"ring.csv\": ";
  const auto refused = [&](const std::string& text, const std::string& word) {
    write_file(table, text);
    check_refused(table_scene("ring.csv"), {place, word}, scene);
  };
  write_file(table, good_table());
  BOOST_TEST(refusal(table_scene("ring.csv"), scene) == "");
  const auto good = good_table();
  int tried = 0;
  // Cut short anywhere: never read as another table.
  for (std::size_t length = 0; length < good.size(); length += 3, ++tried) {
    write_file(table, good.substr(0, length));
    const auto message = refusal(table_scene("ring.csv"), scene);
    BOOST_TEST(message.starts_with(place), "cut at " << length << ": " << message);
  }
  refused("", "no line with column names");
  refused("mesh_phase\n", "is not a stiffness table");
  refused(good_table("sun_planet"), "table of the mesh sun_planet");
  refused(good_table("other"), "table of the mesh other");
  refused("a,b\n1,2\n", "is not a stiffness table");
  refused("{\"json\": 1}\n", "is not a stiffness table");
  refused(std::string(100'000, '\0') + "\n", "is not a stiffness table");
  refused("\xff\xfe\x01\n", "is not a stiffness table");
  refused(good + "0.5,0", "the last line has no end");
  refused(good.substr(good.find('\n') + 1), "no line '# mesh:");
  for (const auto* cell :
       {"nan", "-nan", "inf", "-inf", "NaN", "1e999", "", "x", "1.87e9x", "-1.87e9", "0", "1e300", "0x1p3", "1,2"})
    for (const auto* at : {"1.87e9,1.87e9,0.01\n0.25", "30000,0", "0,0,60000", "0.01\n0.5", "0,1.6042"}) {
      auto text = good;
      const auto where = text.find(at);
      BOOST_TEST_REQUIRE(where != std::string::npos, at);
      const auto end = text.find_first_of(",\n", where);
      // Zero is a good phase, angle, unloaded error and error estimate.
      const bool fine = std::string(cell) == "0" && (text[where] == '0');
      text.replace(where, end - where, cell);
      write_file(table, text);
      const auto message = refusal(table_scene("ring.csv"), scene);
      BOOST_TEST((fine || message.starts_with(place)), cell << " for " << at << ": " << message);
      ++tried;
    }
  refused(good + good.substr(good.find("\n0,") + 1), "rows");
  refused(good + "\n1,2\n", "data after an empty line");
  refused(good.substr(0, good.rfind("0.75,0,90000")), "11 rows where the header has 12");
  // Without its number of rows a table tells by its axes.
  auto bare = good;
  bare.erase(bare.find("# rows"), bare.find("mesh_phase") - bare.find("# rows"));
  write_file(table, bare);
  BOOST_TEST(refusal(table_scene("ring.csv"), scene) == "");
  refused(bare.substr(0, bare.rfind("0.75,0,90000")), "rows do not fill");
  refused(bare.substr(0, bare.rfind("0.75,0,30000")), "mesh_phase");
  BOOST_TEST_MESSAGE(tried << " damaged tables tried");
}

BOOST_AUTO_TEST_CASE(a_scene_reads_below_its_own_folder_only) {
  const test::TemporaryFolder folder("reading");
  const auto inside = folder.path() / "scenes";
  std::filesystem::create_directories(inside / "deeper");
  write_file(folder.path() / "outside.csv", good_table());
  write_file(inside / "ring.csv", good_table());
  write_file(inside / "deeper" / "ring.csv", good_table());
  std::filesystem::create_symlink(folder.path() / "outside.csv", inside / "link.csv");
  std::filesystem::create_symlink(folder.path(), inside / "up");
  const auto scene = inside / "scene.toml";
  for (const auto* good : {"ring.csv", "./ring.csv", "deeper/ring.csv", "deeper/../ring.csv", "../scenes/ring.csv"})
    BOOST_TEST(refusal(table_scene(good), scene) == "", good);
  for (const auto* bad : {"../outside.csv", "deeper/../../outside.csv", "link.csv", "up/outside.csv", "..",
                          "../../../../../../etc/passwd"})
    check_refused(table_scene(bad),
                  {"mesh.ring_planet.file = \"" + std::string(bad) + "\"", "out of the scene's folder"}, scene);
  for (const auto* bad : {"/etc/passwd", "/dev/zero", "/dev/stdin", ""})
    check_refused(table_scene(bad), {"mesh.ring_planet.file", "relative to the scene"}, scene);
  for (const auto* bad : {"missing.csv", "deeper/missing.csv", "ring.csv/x"})
    check_refused(table_scene(bad), {scene.string() + ":46:1: mesh.ring_planet.file", "no such file"}, scene);
  for (const auto* bad : {".", "deeper", "deeper/"}) check_refused(table_scene(bad), {"is not a file"}, scene);
  const auto referring = [](const std::string& file) { return "reference = \"" + file + "\"\n" + test::quick_scene(); };
  check_refused(referring("/etc/passwd"), {scene.string() + ":1:1: reference = \"/etc/passwd\"", "relative"}, scene);
  check_refused(referring("missing.toml"), {":1:1: reference", "no such file"}, scene);
  check_refused(referring("deeper"), {":1:1: reference", "is not a file"}, scene);
  // No scene in the current folder may escape it either.
  check_refused(table_scene("../x.csv"), {"out of the scene's folder"}, "scene.toml");
}

BOOST_AUTO_TEST_CASE(references_that_are_none) {
  const test::TemporaryFolder folder("bad_reference");
  const auto scene = folder.path() / "scene.toml", file = folder.path() / "ref.toml";
  const auto text = "reference = \"ref.toml\"\n" + test::quick_scene();
  const std::string order = "source = \"s\"\n[[order]]\nquantity = \"q\"\nvariants = [\"held\"]\nstatement = \"s\"\n";
  write_file(file, order);
  BOOST_TEST(refusal(text, scene) == "");
  for (const auto& bad :
       {std::string(),
        std::string("source = 3"),
        std::string("\xff"),
        std::string("source = \"a"),
        std::string("source = \"s\"\norder = 3"),
        std::string("source = \"s\"\norder = [1]"),
        std::string("source = \"s\"\n[order]"),
        std::string("source = \"s\"\nvalue = [1]"),
        std::string("source = \"s\"\nat_pin = \"x\""),
        order + "values = [\"a\"]",
        order + "values = [nan]",
        order + "values = [1, 2]",
        order + "margin = nan",
        order + "margin = \"a\"",
        order + "margin = -1",
        order + "margins = 1",
        std::string("source = \"s\"\n[[order]]\nquantity = \"q\"\nvariants = [1]\nstatement = \"s\""),
        std::string("source = \"s\"\n[[value]]\nquantity = \"q\"\nvalue = inf\nstatement = \"s\""),
        std::string("source = \"s\"\n[[value]]\nquantity = \"q\"\nvalue = 1\nwithin = -1\nstatement = \"s\""),
        "source = \"s\"\na" + times(190'000, ".a") + " = 1",
        "source = \"s\"\n# " + std::string(2'000'000, 'x')}) {
    write_file(file, bad);
    check_refused(text, {scene.string() + ":1:1: reference = \"ref.toml\": " + file.string() + ":"}, scene);
  }
}

BOOST_AUTO_TEST_CASE(the_dictionary_of_the_fuzz_target_knows_every_key) {
  const auto words = read_file(std::string(ANNULUS_SOURCE_DIR) + "/tests/fuzz/scene.dict");
  for (const auto& table : app::schema())
    for (const auto& p : table.parameters) BOOST_TEST(words.find('"' + p.name + " = \"") != std::string::npos, p.key());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
