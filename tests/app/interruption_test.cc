#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/files.h"
#include "tests/app/run_results.h"
#include "tests/app/scenes.h"

extern char** environ;

namespace annulus {
namespace {

namespace fs = std::filesystem;
using test::check_same;
using test::results_in;

/// Elements, supports that open, a sweep, random draws and a search: every kind of result that is kept. Without a look
/// for other motions, which takes most of the time and keeps nothing of its own.
std::string whole_scene() {
  return "accuracy = 0.1\nmodel = \"plane\"\n" + test::small_stage() + R"(starts = 0
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
[[sweep]]
input = "stage.sun_speed_rpm"
from = 1000
to = 2000
count = 6
[monte_carlo]
samples = 10
seed = 1
[optimise]
objective = ["sun_planet_peak_factor"]
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

/// The program, started; its messages go to a file.
class RunningProgram {
 public:
  RunningProgram(const std::vector<std::string>& arguments, fs::path messages) : messages_(std::move(messages)) {
    std::vector<const char*> words = {ANNULUS_PROGRAM};
    for (const auto& argument : arguments) words.push_back(argument.c_str());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, messages_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    BOOST_REQUIRE(::posix_spawn(&id_, words.front(), &actions, nullptr, const_cast<char**>(words.data()), environ) ==
                  0);
    posix_spawn_file_actions_destroy(&actions);
  }
  /// `annulus run scene.toml -o <out>` in a folder.
  RunningProgram(const fs::path& folder, const std::string& out, int threads = 2)
      : RunningProgram({"run", (folder / "scene.toml").string(), "-o", (folder / out).string(), "--threads",
                        std::to_string(threads)},
                       folder / (out + "." + std::to_string(threads) + ".err")) {}
  /// What it said so far.
  [[nodiscard]] std::string messages() const { return read_file(messages_); }
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
    BOOST_TEST(read_file(out / "report.html").find("</html>") != std::string::npos);
    fs::remove_all(out);
  }
  BOOST_TEST_MESSAGE(kills << " kills in " << finished << " runs, all ended with the same results");
}

BOOST_AUTO_TEST_CASE(exports_killed_at_any_moment_leave_whole_files_or_none) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("killed_exports");
  write_file(folder.path() / "scene.toml", "accuracy = 0.1\nmodel = \"closed_form\"\n" + test::small_stage());
  BOOST_REQUIRE(RunningProgram(folder.path(), "out").wait() == 0);
  const auto table = folder.path() / "table.csv";
  fs::copy_file(folder.path() / "out" / "ring" / "stiffness_ring_planet.csv", table);
  const auto export_to = [&](const char* format) {
    return RunningProgram({"export", table.string(), "--to", format}, folder.path() / "export.err");
  };
  std::mt19937 random(11);
  int kills = 0, whole_files = 0;
  for (const auto& [format, file] :
       {std::pair{"hdf5", "table.h5"}, {"matlab", "table.mat"}, {"modelica", "table.txt"}}) {
    const auto written = folder.path() / file;
    const auto start = std::chrono::steady_clock::now();
    BOOST_REQUIRE(export_to(format).wait() == 0);
    const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    BOOST_REQUIRE(fs::exists(written));
    const auto size = fs::file_size(written);  // headers may tell the time, in as many bytes
    // Most of its time the program only loads its libraries.
    std::uniform_real_distribution<double> moment(0.5, 1.1);
    for (int i = 0; i < 20; ++i) {
      fs::remove(written);
      const auto run = export_to(format);
      std::this_thread::sleep_for(std::chrono::duration<double>(moment(random) * whole));
      run.send(SIGKILL);
      kills += run.wait() == -SIGKILL;
      if (!fs::exists(written)) continue;
      ++whole_files;
      BOOST_TEST(fs::file_size(written) == size, file);
    }
    BOOST_REQUIRE(export_to(format).wait() == 0);
    BOOST_TEST(fs::file_size(written) == size, file);
  }
  BOOST_TEST_MESSAGE(kills << " kills of 60 exports, " << whole_files << " files, all whole");
  BOOST_TEST(kills > 0);
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
    const auto message = read_file(folder.path() / "stderr.txt");
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

BOOST_AUTO_TEST_CASE(under_limits_of_the_system_every_command_ends_with_a_message) {
  const test::TemporaryFolder folder("system_limits");
  write_file(folder.path() / "scene.toml", whole_scene());
  const auto ends = [&](const std::string& limit, const std::string& command) {
    const auto line = "cd '" + folder.path().string() + "' && ANNULUS_CACHE= && export ANNULUS_CACHE && ulimit " +
                      limit + " && timeout -s KILL 120 '" ANNULUS_PROGRAM "' " + command + " >/dev/null 2>stderr.txt";
    const int raw = std::system(line.c_str());
    const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw);
    const auto message = read_file(folder.path() / "stderr.txt");
    BOOST_TEST_MESSAGE("ulimit " << limit << ", " << command << ": " << status << " " << message);
    // 127: the loader of the system found no room for the libraries.
    BOOST_TEST((status == 0 || status == 2 || status == 3 || status == 127),
               "ulimit " << limit << ", " << command << ": " << status << " " << message);
    if (status != 0) BOOST_TEST(!message.empty());
    fs::remove_all(folder.path() / "out");
    return status;
  };
  // kB: from less than the libraries to enough.
  for (int address_space = 400'000; address_space <= 1'400'000; address_space += 50'000) {
    const auto limit = "-v " + std::to_string(address_space);
    (void)ends(limit, "plan scene.toml");
    (void)ends(limit, "solve scene.toml -o out --threads 3");
  }
  BOOST_TEST(ends("-v 4000000", "solve scene.toml -o out --threads 3") == 0);
  for (const int stack : {64, 256, 1024}) {
    const int status = ends("-s " + std::to_string(stack), "solve scene.toml -o out");
    BOOST_TEST(status == 3);
    BOOST_TEST(read_file(folder.path() / "stderr.txt").find("limit of the stack is") != std::string::npos);
  }
  BOOST_TEST(ends("-s 2048", "solve scene.toml -o out") == 0);
  BOOST_TEST(ends("-f 20", "solve scene.toml -o out") == 2);  // without a handler of the shell
  BOOST_TEST(read_file(folder.path() / "stderr.txt").find("ulimit -f") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(without_room_for_its_libraries_a_run_is_refused) {
  const test::TemporaryFolder folder("address_space");
  write_file(folder.path() / "scene.toml", whole_scene());
  const auto command = "cd '" + folder.path().string() +
                       "' && ulimit -v 800000 && '" ANNULUS_PROGRAM "' run scene.toml -o out >/dev/null 2>stderr.txt";
  const int raw = std::system(command.c_str());
  BOOST_TEST(WEXITSTATUS(raw) == 3);
  const auto message = read_file(folder.path() / "stderr.txt");
  BOOST_TEST(message.find("refused: ") != std::string::npos, message);
  BOOST_TEST(!fs::exists(folder.path() / "out"));
}

BOOST_AUTO_TEST_CASE(of_two_runs_into_one_folder_the_second_is_refused) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("two_runs");
  write_file(folder.path() / "scene.toml", whole_scene());
  BOOST_REQUIRE(RunningProgram(folder.path(), "alone").wait() == 0);
  const RunningProgram one(folder.path(), "shared"), two(folder.path(), "shared", 1);
  const int first = one.wait(), second = two.wait();
  BOOST_TEST(std::min(first, second) == 0, one.messages() << two.messages());
  BOOST_TEST(std::max(first, second) == 3, one.messages() << two.messages());
  BOOST_TEST((one.messages() + two.messages()).find("is writing the results of") != std::string::npos);
  check_same(results_in(folder.path() / "alone"), results_in(folder.path() / "shared"));
  BOOST_TEST(RunningProgram(folder.path(), "shared").wait() == 0);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
