#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "core/files.h"
#include "tests/app/bad_scenes.h"
#include "tests/app/run_program.h"

/// The program itself on bad input: exit status 2, one message, nothing written; limits; texts that would be code.
namespace annulus {

namespace {

std::set<std::string> content_of(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) names.insert(entry.path().string());
  return names;
}

/// Refused with this status, a message that holds `word`, nothing said as if it had worked, and no file more than
/// before.
void check_program_refused(const std::filesystem::path& folder, const std::string& arguments, const std::string& word,
                           int status = 2) {
  const auto before = content_of(folder);
  const auto outcome = test::run_program(folder, arguments);
  BOOST_TEST_CONTEXT(arguments.substr(0, 100)) {
    BOOST_TEST(outcome.status == status, outcome.status << ": " << outcome.err);
    BOOST_TEST(outcome.err.find(word) != std::string::npos, outcome.err);
    BOOST_TEST(outcome.err.find("defect") == std::string::npos);
    if (status == 2) BOOST_TEST(outcome.out == "");
    BOOST_TEST((content_of(folder) == before));
  }
}

constexpr const char* commands_with_out[] = {"run", "solve", "dynamics", "tradeoff"};

}  // namespace

BOOST_AUTO_TEST_SUITE(bad_program)

BOOST_AUTO_TEST_CASE(every_command_refuses_a_bad_scene_and_writes_nothing) {
  const test::TemporaryFolder folder("bad_program");
  write_file(folder.path() / "scene.toml", test::replaced(test::quick_scene(), "module_mm = 3.8", "module_mm = 1e300"));
  for (const std::string command : {"run", "solve", "dynamics", "tradeoff", "plan", "check"}) {
    const bool out = command != "plan" && command != "check";
    check_program_refused(folder.path(), command + " scene.toml" + (out ? " -o out" : ""),
                          "scene.toml:5:1: stage.module_mm = 1e300: must be in range: 0.05 <= value <= 100 mm\n");
  }
  check_program_refused(folder.path(), "run scene.toml", "scene.toml:5:1:");  // its own OUT
}

BOOST_AUTO_TEST_CASE(bad_scenes_of_every_class) {
  const test::TemporaryFolder folder("bad_classes");
  const auto refuse = [&](const std::string& text, const std::string& word) {
    write_file(folder.path() / "scene.toml", text);
    check_program_refused(folder.path(), "run scene.toml -o out", word);
  };
  const auto with = [](const std::string& what, const std::string& by) {
    return test::replaced(test::quick_scene(), what, by);
  };
  refuse("", "[stage] is missing");
  refuse("\xff\xfe", "scene.toml:1:1: not valid TOML");
  refuse(with("planets = 5", "planets = 5.5"), "scene.toml:4:1: stage.planets = 5.5: must be a whole number");
  refuse(with("planets = 5", "planets = 5\nplanets = 5"), "scene.toml:5:");
  refuse(with("power_kW", "powr_kW"), "did you mean stage.power_kW?");
  refuse(with("power_kW = 2958.8", "power_kW = nan"), "scene.toml:9:1: stage.power_kW = nan");
  refuse(with("[15, 36, 17, 38, 19]", "[15, 36]"), "2 values for 5 planets");
  refuse(with("sun_speed_rpm = 1128", "sun_speed_rpm = 1\ncarrier_speed_rpm = 1"), "give one of");
  refuse(with("teeth = 48", "teeth = 47"), "scene.toml:");  // cannot be assembled
  refuse(with("name = \"held\"", "name = \"../held\""), "ring.name = ../held");
  refuse(with("name = \"held\"", "name = \"/tmp/held\""), "ring.name = /tmp/held");
  refuse(with("stiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294",
              "stiffness = \"table\"\nfile = \"no.csv\""),
         "no such file");
  refuse("reference = \"../x.toml\"\n" + test::quick_scene(), "out of the scene's folder");
  refuse(test::quick_scene() + "# " + std::string(10'000'000, 'x'), "1000000 bytes");
  refuse("a = " + std::string(400'000, '['), "not valid TOML");
  refuse(test::quick_scene() + "[[sweep]]\ninput = \"dynamics.mesh_damping_ratio\"\nvalues = [0.1, 5]\n",
         "dynamics.mesh_damping_ratio = 5 must be in range");
}

BOOST_AUTO_TEST_CASE(what_is_no_scene_file) {
  const test::TemporaryFolder folder("no_scene");
  std::filesystem::create_directories(folder.path() / "deeper");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  write_file(folder.path() / "taken", "");
  for (const std::string command : commands_with_out) {
    check_program_refused(folder.path(), command + " nowhere.toml -o out", "nowhere.toml: cannot be read");
    check_program_refused(folder.path(), command + " deeper -o out", "deeper: cannot be read");
    check_program_refused(folder.path(), command + " -o out", "scene is required");
  }
  check_program_refused(folder.path(), "run scene.toml -o taken", "--out taken: ");
  check_program_refused(folder.path(), "run scene.toml -o taken/out", "is not a folder");
  check_program_refused(folder.path(), "run scene.toml -o /proc/out", "/proc");
  check_program_refused(folder.path(), "run scene.toml -o out --budget soon", "--budget soon");
  check_program_refused(folder.path(), "run scene.toml -o out --max-time 0s", "--max-time 0s");
  check_program_refused(folder.path(), "run scene.toml -o out --max-memory much", "--max-memory much");
  check_program_refused(folder.path(), "run scene.toml -o out --max-memory nanGB", "--max-memory nanGB");
  check_program_refused(folder.path(), "run scene.toml -o out --threads x", "--threads");
  check_program_refused(folder.path(), "run scene.toml -o out --no-such-option", "--no-such-option");
  check_program_refused(folder.path(), "run /dev/zero -o out", "1000000 bytes");
}

BOOST_AUTO_TEST_CASE(too_much_is_refused_with_the_figures) {
  const test::TemporaryFolder folder("too_much");
  const auto refuse = [&](const std::string& text, const std::string& arguments,
                          const std::vector<std::string>& words) {
    write_file(folder.path() / "scene.toml", text);
    for (const auto& word : words) check_program_refused(folder.path(), "run scene.toml -o out" + arguments, word, 3);
    check_program_refused(folder.path(), "plan scene.toml" + arguments, words.front(), 3);
  };
  // Searches of ten thousand million points, tens of milliseconds each.
  refuse(test::quick_scene() +
             "[optimise]\nobjective = [\"sun_planet_load_sharing_instantaneous\"]\ngenerations = 100000\npopulation = "
             "100000\n[[optimise.variable]]\ninput = \"dynamics.mesh_damping_ratio\"\nlow = 0.05\nhigh = 0.06\n",
         "", {"the limit is 7 days (--max-time)", "for the [optimise]: it asks for 20000200000 responses"});
  refuse(test::quick_scene() + "[monte_carlo]\nsamples = 1000000\n", " --max-memory 200MB",
         {"of memory, the limit is 200 MB (--max-memory)", "[monte_carlo]: it asks for 1000000 responses"});
  // A mesh: the keys that make it so large.
  const auto finest = test::replaced(test::computed_set(), "title = \"Quick\"", "accuracy = 0.00001");
  refuse(finest, " --max-memory 100MB", {"of memory, the limit is 100 MB", "follows from `accuracy` and `model`"});
  refuse(finest, " --max-time 1s", {"the limit is 1.0 s (--max-time)"});
}

BOOST_AUTO_TEST_CASE(texts_stay_texts) {
  const std::string evil = "<script>alert(1)</script> \\\"'&amp;<img src=x onerror=alert(1)> ]]> {{x}} ../../../x %s";
  const std::string shown = "<script>alert(1)</script> \"'&amp;<img src=x onerror=alert(1)> ]]> {{x}} ../../../x %s";
  const auto evil_of = [&](const std::string& scene, const std::string& title) {
    return "reference = \"ref.toml\"\n" +
           test::replaced(scene, "title = \"" + title + "\"", "title = \"" + evil + "\"") +
           "[assumed]\n\"dynamics.mesh_damping_ratio\" = \"" + evil + "\"\n";
  };
  for (const auto& [name, scene, quantity] :
       {std::tuple{"planetary", evil_of(test::quick_scene(), "Quick"), "load_sharing"},
        {"pair", evil_of(test::quick_pair(), "Quick pair"), "dynamic_factor"},
        {"reducer", evil_of(test::reducer_scene(), "Reducer"), "frequency_1_Hz"}}) {
    const test::TemporaryFolder folder(std::string("texts_") + name);
    const auto inner = folder.path() / "inner";
    std::filesystem::create_directories(inner);
    write_file(inner / "scene.toml", scene);
    std::string reference;
    for (const auto* key : {"source", "doi", "note"}) reference += std::string(key) + " = \"" + evil + "\"\n";
    reference += std::string("[[value]]\nquantity = \"") + quantity + "\"\nvalue = 1\nstatement = \"" + evil +
                 "\"\nwhere = \"" + evil + "\"\n[[order]]\nquantity = \"" + evil + "\"\nvariants = [\"" + evil +
                 "\"]\nstatement = \"" + evil + "\"\n[[order]]\nquantity = \"" + quantity +
                 "\"\nvariants = [\"held\"]\nstatement = \"" + evil + "\"\nwhere = \"" + evil + "\"\n";
    write_file(inner / "ref.toml", reference);
    const auto run = test::run_program(inner, "run scene.toml -o out --quiet");
    BOOST_TEST_REQUIRE(run.status == 0, name << ": " << run.err);
    // Nothing beside OUT.
    std::set<std::string> beside;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) beside.insert(entry.path().filename());
    for (const auto& entry : std::filesystem::directory_iterator(inner)) beside.insert(entry.path().filename());
    BOOST_TEST((beside == std::set<std::string>{"inner", "out", "ref.toml", "scene.toml"}));
    BOOST_TEST(nlohmann::json::parse(read_file(inner / "out/summary.json"))["title"] == shown);
    int pages = 0, tables = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(inner / "out")) {
      const auto kind = entry.path().extension();
      const auto text = entry.is_regular_file() ? read_file(entry.path()) : "";
      if (kind == ".html" || kind == ".svg" || kind == ".vtu") {
        ++pages;
        for (const auto* code : {"<script>alert", "<img src=x", "\"'&amp;<"})
          BOOST_TEST(text.find(code) == std::string::npos, entry.path() << " holds " << code);
      }
      if (kind == ".html") {
        BOOST_TEST(text.find("&lt;script&gt;alert(1)&lt;/script&gt;") != std::string::npos);
        BOOST_TEST(text.find("&amp;amp;") != std::string::npos);
      }
      if (kind == ".csv" && entry.path().filename() != "modes.csv" && text.find("# ") == 0) {
        ++tables;
        BOOST_TEST(text.find("alert") == std::string::npos);
      }
      if (kind == ".json") BOOST_TEST(nlohmann::json::accept(text), entry.path());
    }
    BOOST_TEST(pages > 0);
    BOOST_TEST(tables > 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
