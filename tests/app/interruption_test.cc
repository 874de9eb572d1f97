#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "core/files.h"
#include "tests/app/scenes.h"

extern char** environ;

namespace annulus {
namespace {

namespace fs = std::filesystem;

/// Elements, supports that open, a sweep, random draws and a search: every kind of result that is kept.
std::string whole_scene() {
  return R"(title = "Interrupted"
accuracy = 0.1
rung = "plane"
[stage]
kind = "planetary"
planets = 3
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 60
centre_distance_mm = 96
power_kW = 200
sun_speed_rpm = 1500
[material]
youngs_modulus_GPa = 206
[sun]
teeth = 24
profile_shift = 0
bore_diameter_mm = 40
mass_kg = 3.3
inertia_kg_m2 = 0.0038
[planet]
teeth = 24
profile_shift = 0
bore_diameter_mm = 45
mass_kg = 2.9
inertia_kg_m2 = 0.0036
[carrier]
mass_kg = 18
inertia_kg_m2 = 0.15
[[ring]]
name = "held"
structure = "traditional"
teeth = 72
tip_diameter_mm = 282
profile_shift = 0
rim_thickness_mm = 24
mass_kg = 14
inertia_kg_m2 = 0.35
[[ring]]
name = "pinned"
structure = "pinned"
pins = 12
pin_diameter_mm = 10
teeth = 72
tip_diameter_mm = 282
profile_shift = 0
rim_thickness_mm = 16
mass_kg = 12
inertia_kg_m2 = 0.3
[errors]
planet_installation_um = [10, 0, 0]
planet_installation_phase_deg = [90, 0, 0]
[supports]
sun_N_per_m = 1e8
planet_N_per_m = 1e9
[dynamics]
half_backlash_um = 50
mesh_damping_ratio = 0.07
support_damping_ratio = 0.03
[[sweep]]
input = "stage.sun_speed_rpm"
from = 1000
to = 2000
count = 6
[monte_carlo]
samples = 10
seed = 1
[optimise]
objective = ["sun_planet_dynamic_factor"]
optimisers = ["genetic"]
generations = 3
population = 6
[[optimise.variable]]
input = "supports.planet_N_per_m"
low = 3e8
high = 3e9
scale = "logarithmic"
)";
}

/// `annulus run scene.toml -o <out>` in a folder.
class RunningProgram {
 public:
  RunningProgram(const fs::path& folder, const std::string& out, int threads = 2)
      : messages_(folder / (out + "." + std::to_string(threads) + ".err")) {
    const auto scene = (folder / "scene.toml").string(), results = (folder / out).string();
    const auto threads_text = std::to_string(threads);
    std::vector<const char*> words = {ANNULUS_PROGRAM, "run",       scene.c_str(),        "-o",
                                      results.c_str(), "--threads", threads_text.c_str(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, messages_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    BOOST_REQUIRE(::posix_spawn(&id_, words.front(), &actions, nullptr, const_cast<char**>(words.data()), environ) ==
                  0);
    posix_spawn_file_actions_destroy(&actions);
  }
  /// What it said so far.
  [[nodiscard]] std::string messages() const {
    std::ifstream in(messages_);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  void send(int signal) const { ::kill(id_, signal); }
  /// Exit status; minus the signal that ended it.
  [[nodiscard]] int wait() const {
    int raw = 0;
    ::waitpid(id_, &raw, 0);
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw);
  }

 private:
  fs::path messages_;
  pid_t id_ = 0;
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Without what tells how long things took and what was reused.
void forget_times(nlohmann::json& json) {
  static const std::regex cost("_seconds|^(condensed|reused)_teeth$|^reused$");
  if (json.is_object()) {
    for (const auto* key : {"timings_s", "reuse", "cost", "peak_memory_MB"}) json.erase(key);
    for (auto it = json.begin(); it != json.end();)
      it = std::regex_search(it.key(), cost) ? json.erase(it) : std::next(it);
  }
  if (json.is_structured())
    for (auto& value : json) forget_times(value);
}

/// Every result of a run by its place, without times. The report repeats them with times all over.
std::map<std::string, std::string> results_in(const fs::path& out) {
  static const std::regex times("# ([a-z_]*_seconds|(condensed|reused)_teeth): [^\n]*\n");
  std::map<std::string, std::string> results;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    const auto place = entry.path().lexically_relative(out);
    if (!entry.is_regular_file() || *place.begin() == "condensed" || place == "run.json" || place == "report.html" ||
        is_unfinished(place))
      continue;
    auto text = text_of(entry.path());
    if (place.extension() == ".csv") text = std::regex_replace(text, times, "");
    if (place.extension() == ".json") {
      auto json = nlohmann::json::parse(text);
      forget_times(json);
      text = json.dump();
    }
    results[place.generic_string()] = std::move(text);
  }
  return results;
}

/// Where two results differ, for messages.
std::string difference(const std::string& place, const std::string& expected, const std::string& found) {
  if (place.ends_with(".json"))
    return nlohmann::json::diff(nlohmann::json::parse(expected), nlohmann::json::parse(found)).dump().substr(0, 500);
  const auto at = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end()).first - expected.begin();
  return "at byte " + std::to_string(at);
}

void check_same(const std::map<std::string, std::string>& expected, const std::map<std::string, std::string>& found) {
  for (const auto& [place, text] : expected) {
    const auto it = found.find(place);
    BOOST_TEST((it != found.end()), place << " is missing");
    if (it != found.end() && it->second != text)
      BOOST_ERROR(place << " differs: " << difference(place, text, it->second));
  }
  BOOST_TEST(found.size() == expected.size());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(interruption)

BOOST_AUTO_TEST_CASE(killed_at_any_moment_the_next_run_goes_on_and_ends_with_the_same_bits) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("killed");
  write_file(folder.path() / "scene.toml", whole_scene());
  const auto start = std::chrono::steady_clock::now();
  BOOST_REQUIRE(RunningProgram(folder.path(), "whole").wait() == 0);
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto expected = results_in(folder.path() / "whole");
  BOOST_TEST_REQUIRE(expected.size() > 20U);

  constexpr int kills_wanted = 50;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> moment(0.04, 0.4);  // of the time of an undisturbed run
  const int signals[] = {SIGKILL, SIGKILL, SIGINT, SIGTERM};
  int kills = 0, finished = 0;
  for (int campaign = 0; kills < kills_wanted; ++campaign) {
    const auto name = "out" + std::to_string(campaign);
    const fs::path out = folder.path() / name;
    for (bool done = false; !done;) {
      const RunningProgram run(folder.path(), name);
      std::this_thread::sleep_for(std::chrono::duration<double>(moment(random) * whole));
      const int signal = signals[random() % 4];
      run.send(signal);
      const int status = run.wait();
      // Before main() has begun a signal does what it does to every program.
      const bool told = status == -signal || (signal != SIGKILL && status == 130);
      BOOST_TEST((told || status == 0), "status " << status << " after signal " << signal << ": " << run.messages());
      done = status == 0;
      kills += !done;
      finished += done;
      // Nothing half-written under a name of its own.
      if (!fs::exists(out)) continue;
      for (const auto& [place, text] : results_in(out)) {
        BOOST_TEST(!text.empty(), place);
        const auto it = expected.find(place);
        if (it != expected.end() && place != "summary.json") BOOST_TEST((it->second == text), place << " differs");
      }
    }
    check_same(expected, results_in(out));
    BOOST_TEST(text_of(out / "report.html").find("</html>") != std::string::npos);
    fs::remove_all(out);
  }
  BOOST_TEST_MESSAGE(kills << " kills in " << finished << " runs, all ended with the same results");
}

BOOST_AUTO_TEST_CASE(on_a_full_disk_the_earlier_results_stay_and_the_next_run_goes_on) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("full_disk");
  write_file(folder.path() / "scene.toml", whole_scene());
  // No file may grow beyond so many blocks of 512 bytes: writing fails as it does on a full disk.
  const auto run = [&](const std::string& limit) {
    const auto command = "cd '" + folder.path().string() + "' && " + limit +
                         "'" ANNULUS_PROGRAM "' run scene.toml -o out >stdout.txt 2>stderr.txt";
    const int raw = std::system(command.c_str());
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
  };
  std::map<std::string, std::string> before;
  for (const int blocks : {8, 40, 120, 400, 1200}) {
    const int status = run("trap '' XFSZ && ulimit -f " + std::to_string(blocks) + " && ");
    const auto message = text_of(folder.path() / "stderr.txt");
    BOOST_TEST(status == 2, blocks << " blocks: " << message);
    BOOST_TEST(message.find("cannot write") != std::string::npos, message);
    BOOST_TEST(message.find("not full") != std::string::npos, message);
    const auto after = results_in(folder.path() / "out");
    for (const auto& [place, text] : before) BOOST_TEST((after.at(place) == text), place);
    before = after;
  }
  BOOST_TEST(!before.empty());
  BOOST_TEST(run("") == 0);
  BOOST_REQUIRE(RunningProgram(folder.path(), "alone").wait() == 0);
  check_same(results_in(folder.path() / "alone"), results_in(folder.path() / "out"));
}

BOOST_AUTO_TEST_CASE(without_room_for_its_libraries_a_run_is_refused) {
  const test::TemporaryFolder folder("address_space");
  write_file(folder.path() / "scene.toml", whole_scene());
  const auto command = "cd '" + folder.path().string() +
                       "' && ulimit -v 800000 && '" ANNULUS_PROGRAM "' run scene.toml -o out >/dev/null 2>stderr.txt";
  const int raw = std::system(command.c_str());
  BOOST_TEST(WEXITSTATUS(raw) == 3);
  const auto message = text_of(folder.path() / "stderr.txt");
  BOOST_TEST(message.find("refused: predicted to need") != std::string::npos, message);
  BOOST_TEST(!fs::exists(folder.path() / "out"));
}

BOOST_AUTO_TEST_CASE(two_runs_into_one_folder_do_not_disturb_each_other) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("two_runs");
  write_file(folder.path() / "scene.toml", whole_scene());
  BOOST_REQUIRE(RunningProgram(folder.path(), "alone").wait() == 0);
  const RunningProgram one(folder.path(), "shared"), two(folder.path(), "shared", 1);
  BOOST_TEST(one.wait() == 0, one.messages());
  BOOST_TEST(two.wait() == 0, two.messages());
  check_same(results_in(folder.path() / "alone"), results_in(folder.path() / "shared"));
  BOOST_TEST(RunningProgram(folder.path(), "shared").wait() == 0);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
