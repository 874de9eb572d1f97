#include "app/run/divided_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>
#include <regex>
#include <thread>

#include "app/study/study_parts.h"
#include "app/study/study_points.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/result_store.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

namespace fs = std::filesystem;

/// Studies of every kind on prescribed stiffnesses: a second of work.
std::string scene_of_all_studies() {
  auto stage = test::replaced(test::quick_scene(), "planet_eccentricity_um", "planet_pin_position_error_um");
  stage = test::replaced(stage, "planet_eccentricity_phase_deg", "planet_pin_position_error_phase_deg");
  return test::replaced(stage, "mesh_cycles = 110\n", "") + R"(
[[sweep]]
input = "supports.sun_N_per_m"
values = [1e7, 2e7, 4e7]
[[sweep]]
input = "stage.sun_speed_rpm"
values = [1000, 1100, 1200]
direction = "both"
[[grid]]
x_input = "supports.sun_N_per_m"
x_from = 1e7
x_to = 3e7
x_count = 2
y_input = "stage.power_kW"
y_from = 1000
y_to = 2000
y_count = 2
[[transient]]
name = "a little faster"
time_s = [0, 0.02, 0.04]
speed_factor = [1, 1, 1.1]
[monte_carlo]
samples = 45
seed = 3
[[monte_carlo.input]]
input = "supports.sun_N_per_m"
distribution = "uniform"
low = 1e7
high = 3e7
[sensitivity]
inputs = ["supports.planet_N_per_m"]
[optimise]
objective = ["sun_planet_load_sharing_averaged"]
optimisers = ["genetic", "differential_evolution"]
generations = 2
population = 8
initial_conditions = 0
[[optimise.variable]]
input = "supports.sun_N_per_m"
low = 1e6
high = 1e8
)";
}

/// The content of every file below a folder, by name. owner.txt names the process.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "owner.txt")
      files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

void check_equal_files(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  BOOST_TEST(a.size() == b.size());
  for (const auto& [name, content] : a) {
    BOOST_TEST_CONTEXT(name) {
      BOOST_REQUIRE(b.count(name) == 1);
      BOOST_TEST((b.at(name) == content));
    }
  }
}

test::ProgramOutcome done(const fs::path& folder, const std::string& arguments) {
  auto outcome = test::run_program(folder, arguments);
  BOOST_TEST_REQUIRE(outcome.status == 0, arguments << ": " << outcome.err);
  return outcome;
}

/// A folder with a scene and its study planned for so many workers.
class Planned {
 public:
  Planned(const std::string& name, int shards, const std::string& scene = scene_of_all_studies()) : folder_(name) {
    write_file(folder_.path() / "scene.toml", scene);
    (void)done(folder_.path(), fmt::format("study plan scene.toml -o study --shards {}", shards));
  }

  [[nodiscard]] const fs::path& path() const { return folder_.path(); }
  void run(int number, int count) const {
    (void)done(path(), fmt::format("study run study --shard {}/{} --threads 1 --quiet", number, count));
  }
  /// Starts a worker and kills it after a while; false where it had ended before.
  [[nodiscard]] bool kill(int number, int count, double seconds) const {
    const int status = std::system(fmt::format("cd '{}' && ANNULUS_CACHE= timeout --signal=KILL {} '" ANNULUS_PROGRAM
                                               "' study run study --shard {}/{} --threads 1 --quiet >/dev/null 2>&1",
                                               path().string(), seconds, number, count)
                                       .c_str());
    return status != 0;
  }
  [[nodiscard]] std::map<std::string, std::string> collected() const {
    (void)done(path(), "study collect study");
    return contents(path() / "study/results");
  }

 private:
  test::TemporaryFolder folder_;
};

/// The results of one worker.
const std::map<std::string, std::string>& of_one_worker() {
  static const auto results = [] {
    const Planned study("divided_by_one", 1);
    study.run(1, 1);
    return study.collected();
  }();
  return results;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(divided_study)

BOOST_AUTO_TEST_CASE(shares_are_whole_and_even) {
  std::vector<app::StudyPart> parts(100);
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].seconds = 1 + static_cast<double>(i % 7);
  const auto list = app::shares(parts, 7);
  BOOST_REQUIRE(list.size() == 7U);
  std::vector<std::size_t> all;
  double least = 1e9, most = 0;
  for (const auto& share : list) {
    BOOST_TEST(std::is_sorted(share.begin(), share.end()));
    double sum = 0;
    for (const std::size_t i : share) sum += parts[i].seconds;
    least = std::min(least, sum);
    most = std::max(most, sum);
    all.insert(all.end(), share.begin(), share.end());
  }
  std::sort(all.begin(), all.end());
  std::vector<std::size_t> expected(parts.size());
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  BOOST_TEST((all == expected));
  BOOST_TEST(most - least <= 7);  // the longest part
  BOOST_TEST(app::longest_share(parts, 7) == most);
  parts.resize(2);
  BOOST_TEST(app::shares(parts, 5).back().empty());
  // All workers take part in a search, each in its share of the points.
  parts.push_back({.study = "[optimise]", .description = "search", .seconds = 60, .workers = 20});
  for (const auto& share : app::shares(parts, 5)) BOOST_TEST(share.back() == 2U);
  BOOST_TEST(app::longest_share(parts, 5) == 60. / 5 + 2);
}

// Later workers read the points of earlier ones and do not keep them again: packs do not grow with their number.
BOOST_AUTO_TEST_CASE(a_pack_has_its_own_points) {
  const test::TemporaryFolder folder("divided_points");
  const auto first = folder.path() / "first", second = folder.path() / "second";
  const std::vector<FigureSpec> none;
  const auto table = [&](const ResultStore& store) {
    return app::PointTable(&store, "samples", "id", {.header = {}, .inputs = {"x"}, .results = {}}, none);
  };
  const auto make = [] { return app::StudyPoint{.failure = "none"}; };
  const ResultStore of_first(first, "program"), of_second(second, "program", ResultStore::usual_most_bytes, {first});
  {
    auto points = table(of_first);
    for (const double x : {1.0, 2.0, 3.0}) (void)points.point({x}, make);
    points.save();
  }
  auto points = table(of_second);
  for (const double x : {2.0, 4.0}) (void)points.point({x}, make);
  points.save();
  BOOST_TEST(points.reused() == 1);
  BOOST_TEST(points.table().rows.size() == 4U);
  const ResultStore alone(second, "program");
  const auto own = table(alone).table();
  BOOST_REQUIRE(own.rows.size() == 1U);
  BOOST_TEST(own.rows.front().front() == 4);
}

// Workers at the same table: what one has found the other does not compute, although it began before.
BOOST_AUTO_TEST_CASE(workers_together_read_what_others_find) {
  const test::TemporaryFolder folder("divided_together");
  const auto first = folder.path() / "first", second = folder.path() / "second";
  const std::vector<FigureSpec> none;
  const ResultStore of_first(first, "program", ResultStore::usual_most_bytes, {second}),
      of_second(second, "program", ResultStore::usual_most_bytes, {first});
  const app::PointColumns columns{.header = {}, .inputs = {"x"}, .results = {}};
  app::PointTable one(&of_first, "searches", "id", columns, none, app::PointTable::Work::together),
      other(&of_second, "searches", "id", columns, none, app::PointTable::Work::together);
  int made = 0;
  const auto make = [&] {
    ++made;
    return app::StudyPoint{.failure = "none"};
  };
  for (const double x : {1.0, 2.0}) (void)one.point({x}, make);
  one.save();
  // Reading takes at most a twentieth of the time.
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(100)); };
  wait();
  for (const double x : {3.0, 2.0, 1.0}) (void)other.point({x}, make);
  other.save();
  wait();
  (void)one.point({3.0}, make);
  BOOST_TEST(made == 3);
  BOOST_TEST(one.reused() == 1);
  BOOST_TEST(other.reused() == 2);
}

BOOST_AUTO_TEST_CASE(names_of_workers) {
  const auto worker = app::worker_of("3/7");
  BOOST_TEST(worker.number == 3);
  BOOST_TEST(worker.count == 7);
  for (const char* wrong : {"", "3", "0/7", "8/7", "3/", "/7", "3/7x", "-1/7", "3/0", "a/b"})
    BOOST_CHECK_THROW((void)app::worker_of(wrong), InputError);
}

// The merged results are those of a run, to the last byte of every table.
BOOST_AUTO_TEST_CASE(one_worker_finds_what_a_run_finds) {
  const test::TemporaryFolder folder("divided_not");
  write_file(folder.path() / "scene.toml", scene_of_all_studies());
  (void)done(folder.path(), "run scene.toml -o out --quiet");
  const auto run = contents(folder.path() / "out");
  std::size_t compared = 0;
  for (const auto& [name, content] : of_one_worker())
    if (name.ends_with(".csv")) {
      BOOST_TEST_CONTEXT(name) {
        BOOST_REQUIRE(run.count(name) == 1);
        BOOST_TEST((run.at(name) == content));
      }
      ++compared;
    }
  BOOST_TEST(compared > 10U);
}

BOOST_AUTO_TEST_CASE(two_workers_in_any_order_one_of_them_twice) {
  const Planned study("divided_by_two", 2);
  study.run(2, 2);
  study.run(1, 2);
  study.run(2, 2);
  check_equal_files(of_one_worker(), study.collected());
}

BOOST_AUTO_TEST_CASE(seven_workers_some_killed_and_repeated) {
  const Planned study("divided_by_seven", 7);
  int killed = 0;
  for (const auto& [number, seconds] : {std::pair{5, 0.15}, {2, 0.3}, {7, 0.5}})
    killed += study.kill(number, 7, seconds) ? 1 : 0;
  BOOST_TEST(killed > 0);
  for (const int number : {7, 1, 3, 5, 4, 2, 6}) study.run(number, 7);
  check_equal_files(of_one_worker(), study.collected());
}

// Points with stiffness tables of their own: how long they took, and whose superelements they used, leaves no trace.
BOOST_AUTO_TEST_CASE(points_with_tables_of_their_own) {
  const auto scene = test::pinned_scene() + "[[sweep]]\ninput = \"ring.outside_diameter_mm\"\nvalues = [658, 668]\n";
  std::vector<std::map<std::string, std::string>> results;
  for (const int workers : {1, 2}) {
    const Planned study(fmt::format("divided_tables_{}", workers), workers, scene);
    for (int number = workers; number > 0; --number) study.run(number, workers);
    results.push_back(study.collected());
  }
  BOOST_TEST(results.front().count("sweep/ring_outside_diameter_mm/658/held/stiffness_ring_planet.csv") == 1U);
  check_equal_files(results.front(), results.back());
}

BOOST_AUTO_TEST_CASE(by_gnu_parallel) {
  const Planned study("divided_by_parallel", 4);
  const auto command =
      fmt::format("cd '{}' && ANNULUS_CACHE= ANNULUS='" ANNULUS_PROGRAM "' JOBS=2 study/study.sh >parallel.log 2>&1",
                  study.path().string());
  if (std::system("command -v parallel >/dev/null") != 0) {
    BOOST_TEST_MESSAGE("skipped: no parallel");
    return;
  }
  const int status = std::system(command.c_str());
  BOOST_TEST_REQUIRE(status == 0, read_file(study.path() / "parallel.log"));
  check_equal_files(of_one_worker(), contents(study.path() / "study/results"));
}

// One search, three workers at once, however they share its points.
BOOST_AUTO_TEST_CASE(workers_share_a_search) {
  if (std::system("command -v parallel >/dev/null") != 0) {
    BOOST_TEST_MESSAGE("skipped: no parallel");
    return;
  }
  const auto all = scene_of_all_studies();
  auto scene = all.substr(0, all.find("[[sweep]]")) + all.substr(all.find("[optimise]"));
  scene = test::replaced(scene, "[\"sun_planet_load_sharing_averaged\"]", "[\"sun_planet_peak_factor\"]");
  scene = test::replaced(scene, "[\"genetic\", \"differential_evolution\"]", "[\"differential_evolution\"]");
  const Planned alone("search_of_one", 1, scene), study("search_of_three", 3, scene);
  alone.run(1, 1);
  const int status = std::system(fmt::format("cd '{}' && ANNULUS_CACHE= ANNULUS='" ANNULUS_PROGRAM
                                             "' JOBS=3 study/study.sh >parallel.log 2>&1",
                                             study.path().string())
                                     .c_str());
  BOOST_TEST_REQUIRE(status == 0, read_file(study.path() / "parallel.log"));
  const auto results = alone.collected();
  check_equal_files(results, contents(study.path() / "study/results"));
  const auto answers = std::find_if(results.begin(), results.end(), [](const auto& file) {
    return file.first.ends_with("optimise/differential_evolution_1.csv");
  });
  BOOST_REQUIRE((answers != results.end()));
  const auto points = static_cast<long>(Csv::parse(answers->second, "points").rows.size());
  // Each worker says how many it has computed itself.
  const std::regex said("with ([0-9]+) points of searches");
  const auto log = read_file(study.path() / "parallel.log");
  long computed = 0;
  for (std::sregex_iterator match(log.begin(), log.end(), said), end; match != end; ++match)
    computed += std::stol((*match)[1]);
  BOOST_TEST(computed >= points);
  BOOST_TEST_MESSAGE(points << " points, " << computed << " computed by three workers");
}

BOOST_AUTO_TEST_CASE(by_slurm) {
  const Planned study("divided_by_slurm", 3);
  const int status =
      std::system(fmt::format("cd '{}' && ANNULUS_CACHE= ANNULUS='" ANNULUS_PROGRAM "' '" ANNULUS_SOURCE_DIR
                              "/tests/app/one_node_slurm.sh' timeout 200 sbatch --wait "
                              "study/study.sbatch >slurm.log 2>&1",
                              study.path().string())
                      .c_str());
  constexpr int cannot_start = 77;
  if (WEXITSTATUS(status) == cannot_start) {
    BOOST_TEST_MESSAGE("skipped: " << read_file(study.path() / "slurm.log"));
    return;
  }
  BOOST_TEST_REQUIRE(status == 0, read_file(study.path() / "slurm.log"));
  for (int number = 1; number <= 3; ++number)
    BOOST_TEST(fs::exists(study.path() / fmt::format("study/packs/{}_of_3", number)));
  check_equal_files(of_one_worker(), study.collected());
}

BOOST_AUTO_TEST_CASE(what_is_wrong_is_said) {
  const Planned study("divided_refused", 2);
  study.run(1, 2);
  const auto early = test::run_program(study.path(), "study collect study");
  BOOST_TEST(early.status == 3);
  BOOST_TEST(early.err.find("parts are missing") != std::string::npos, early.err);
  const auto shard = test::run_program(study.path(), "study run study --shard 3/2");
  BOOST_TEST(shard.status == 2);
  BOOST_TEST(shard.err.find("--shard 3/2") != std::string::npos, shard.err);
  fs::create_directories(study.path() / "out");
  write_file(study.path() / "out/run.json", "{}");
  const auto taken = test::run_program(study.path(), "study plan scene.toml -o out");
  BOOST_TEST(taken.status == 2);
  BOOST_TEST(taken.err.find("holds the results of a run") != std::string::npos, taken.err);
  for (const char* command : {"run", "tradeoff"}) {
    const auto into = test::run_program(study.path(), std::string(command) + " scene.toml -o study");
    BOOST_TEST(into.status == 2);
    BOOST_TEST(into.err.find("holds a planned study") != std::string::npos, into.err);
  }
  BOOST_TEST(fs::exists(study.path() / "study/points.csv"));
  const auto nothing = test::run_program(study.path(), "study run . --shard 1/1");
  BOOST_TEST(nothing.status == 2);
  BOOST_TEST(nothing.err.find("holds no planned study") != std::string::npos, nothing.err);
  const auto word = test::run_program(study.path(), "study pln scene.toml");
  BOOST_TEST(word.status == 2);
  BOOST_TEST(word.err.find("did you mean plan?") != std::string::npos, word.err);
  const auto option = test::run_program(study.path(), "study plan scene.toml -o study --shard 2");
  BOOST_TEST(option.status == 2);
  BOOST_TEST(option.err.find("--shards") != std::string::npos, option.err);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
