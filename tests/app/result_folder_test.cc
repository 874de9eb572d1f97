#include "app/results/result_folder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/files.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// OUT as a place where others put files too: other scenes, other processes, the user.
namespace annulus {

namespace {

namespace fs = std::filesystem;

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

std::string scene_with_ring(const std::string& ring) {
  return test::replaced(test::quick_scene(), "name = \"held\"", "name = \"" + ring + "\"");
}

std::string titled(const std::string& title, const std::string& scene) {
  return test::replaced(scene, "title = \"Quick\"", "title = \"" + title + "\"");
}

/// The program with a cache of its own that all its runs share.
test::ProgramOutcome run_with_cache(const fs::path& folder, const std::string& arguments) {
  return test::run_program(folder, arguments, "ANNULUS_CACHE='" + folder.string() + "/store'");
}

void check_done(const test::ProgramOutcome& outcome) { BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err); }

void check_refused(const test::ProgramOutcome& outcome, int status, const std::vector<std::string>& words) {
  BOOST_TEST(outcome.status == status, outcome.status << ": " << outcome.err);
  for (const auto& word : words) BOOST_TEST(says(outcome.err, word), "'" << word << "' is missing in: " << outcome.err);
  BOOST_TEST(!says(outcome.err, "defect"));
}

/// `annulus run SCENE -o out`, started.
pid_t start(const fs::path& folder, const std::string& scene, const std::string& messages) {
  const pid_t id = ::fork();
  if (id != 0) return id;
  const int out = ::open((folder / messages).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::dup2(out, 2);
  ::dup2(::open("/dev/null", O_WRONLY), 1);
  ::setenv("ANNULUS_CACHE", (folder / "store").c_str(), 1);
  if (::chdir(folder.c_str()) == 0)
    ::execl(ANNULUS_PROGRAM, ANNULUS_PROGRAM, "run", scene.c_str(), "-o", "out", static_cast<char*>(nullptr));
  ::_exit(127);
}

int status_of(pid_t process) {
  int status = 0;
  ::waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string title_of(const fs::path& out) {
  return nlohmann::json::parse(read_file(out / "summary.json"))["title"].get<std::string>();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(result_folder)

BOOST_AUTO_TEST_CASE(two_scenes_started_at_once_never_mix) {
  const test::TemporaryFolder folder("two_scenes");
  write_file(folder.path() / "one.toml", titled("one", scene_with_ring("first")));
  write_file(folder.path() / "two.toml", titled("two", scene_with_ring("second")));
  const auto out = folder.path() / "out";
  int done = 0;
  for (int round = 0; round < 6; ++round) {
    const pid_t one = start(folder.path(), "one.toml", "one.err");
    std::this_thread::sleep_for(std::chrono::milliseconds(40 * round));
    const pid_t two = start(folder.path(), "two.toml", "two.err");
    const int first = status_of(one), second = status_of(two);
    const bool one_won = first == 0;
    BOOST_TEST((one_won ? second : first) > 1, first << " and " << second);
    BOOST_TEST((one_won || second == 0));
    ++done;
    // 3: while the other was running; 2: after it had ended.
    const auto message = read_file(folder.path() / (one_won ? "two.err" : "one.err"));
    BOOST_TEST(says(message, one_won ? "one.toml (\"one\")" : "two.toml (\"two\")"), message);
    BOOST_TEST(says(message, "(-o)"), message);
    BOOST_TEST(title_of(out) == (one_won ? "one" : "two"));
    BOOST_TEST(fs::exists(out / "first") == one_won);
    BOOST_TEST(fs::exists(out / "second") == !one_won);
    const auto again = run_with_cache(folder.path(), one_won ? "run one.toml -o out" : "run two.toml -o out");
    BOOST_TEST(says(again.out, "nothing has changed"), again.out);
    fs::remove_all(out);
    fs::remove_all(folder.path() / "store");
  }
  BOOST_TEST(done == 6);
}

BOOST_AUTO_TEST_CASE(the_lock_ends_with_its_process_however_that_ends) {
  const test::TemporaryFolder folder("lock");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  const auto out = folder.path() / "out";
  const pid_t holder = ::fork();
  if (holder == 0) {
    app::ResultFolder held(out, {folder.path() / "scene.toml", "Quick"});
    held.begin();
    for (;;) ::pause();
  }
  const auto owner = out / "owner.txt";
  for (int i = 0; i < 1000 && !(fs::exists(owner) && says(read_file(owner), "process ")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  for (const std::string command : {"run", "solve", "tradeoff"})
    check_refused(run_with_cache(folder.path(), command + " scene.toml -o out"), 3,
                  {"out: process " + std::to_string(holder) + " is writing the results of ", "scene.toml (\"Quick\")",
                   "wait until it ends"});
  ::kill(holder, SIGKILL);
  BOOST_TEST(status_of(holder) == -SIGKILL);
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
}

BOOST_AUTO_TEST_CASE(a_killed_run_leaves_nothing_unlisted) {
  const test::TemporaryFolder folder("killed_listed");
  write_file(folder.path() / "scene.toml", scene_with_ring("first"));
  write_file(folder.path() / "other.toml", titled("other", scene_with_ring("second")));
  const auto out = folder.path() / "out";
  const pid_t run = start(folder.path(), "scene.toml", "err");
  for (int i = 0; i < 4000 && !fs::exists(out / "first"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ::kill(run, SIGKILL);
  (void)status_of(run);
  check_refused(run_with_cache(folder.path(), "run other.toml -o out"), 2,
                {"out: holds the results of ", "scene.toml (\"Quick\")", "other.toml (\"other\")", "(-o)"});
  // The scene goes on with another ring; what the killed run wrote of the first is removed.
  write_file(folder.path() / "scene.toml", scene_with_ring("third"));
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  // An empty folder may be left, and a file in the middle of being written, which goes when it is ten minutes old.
  std::error_code none;
  for (fs::recursive_directory_iterator at(out / "first", none), end; at != end; at.increment(none))
    BOOST_TEST((at->is_directory() || is_unfinished(at->path())), at->path());
  BOOST_TEST(fs::exists(out / "third"));
}

BOOST_AUTO_TEST_CASE(a_changed_scene_leaves_none_of_its_old_results_and_all_files_of_the_user) {
  const test::TemporaryFolder folder("changed_scene");
  const std::string sweep = "[[sweep]]\ninput = \"stage.sun_speed_rpm\"\nvalues = [1000, 1100]\n";
  const auto out = folder.path() / "out";
  write_file(folder.path() / "scene.toml", scene_with_ring("first") + sweep);
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  BOOST_TEST_REQUIRE(fs::exists(out / "first/dynamics/sweep_1.csv"));
  fs::create_directories(out / "second");
  const std::vector<std::string> own = {"notes.txt", "pictures/00_mine.svg", "first/dynamics/mine.csv",
                                        "second/mine.csv"};
  for (const auto& name : own) write_file(out / name, "mine");
  write_file(folder.path() / "scene.toml", scene_with_ring("second"));
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  for (const auto& name : own) BOOST_TEST(read_file(out / name) == "mine", name);
  BOOST_TEST(std::distance(fs::recursive_directory_iterator(out / "first"), {}) == 2);  // dynamics/mine.csv
  BOOST_TEST(fs::exists(out / "second/dynamics/modes.csv"));
  const auto fresh = run_with_cache(folder.path(), "run scene.toml -o fresh");
  check_done(fresh);
  const auto files = [](const fs::path& place) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(place))
      if (entry.is_regular_file() && read_file(entry.path()) != "mine")
        names.push_back(entry.path().lexically_relative(place).string());
    std::sort(names.begin(), names.end());
    return names;
  };
  BOOST_TEST(files(out) == files(folder.path() / "fresh"), boost::test_tools::per_element());
  // Without its second command, a folder holds what the first left.
  check_done(run_with_cache(folder.path(), "solve scene.toml -o out"));
  BOOST_TEST(!fs::exists(out / "second/dynamics/modes.csv"));
  // A file of the user where a result would stand.
  write_file(folder.path() / "scene.toml", scene_with_ring("third"));
  fs::create_directories(out / "third/dynamics");
  write_file(out / "third/dynamics/modes.csv", "mine");
  check_refused(run_with_cache(folder.path(), "run scene.toml -o out"), 2,
                {"out/third/dynamics/modes.csv", "annulus did not write", "move it away"});
  BOOST_TEST(read_file(out / "third/dynamics/modes.csv") == "mine");
  fs::remove(out / "third/dynamics/modes.csv");
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
}

BOOST_AUTO_TEST_CASE(scenes_that_were_renamed_moved_copied) {
  const test::TemporaryFolder folder("renamed");
  const auto inner = folder.path() / "inner";
  fs::create_directories(inner);
  write_file(inner / "scene.toml", test::quick_scene());
  const auto run = [&](const fs::path& where, const std::string& arguments) {
    return test::run_program(where, "run " + arguments, "ANNULUS_CACHE='" + (folder.path() / "store").string() + "'");
  };
  check_done(run(inner, "scene.toml -o out"));
  const auto changed = test::replaced(test::quick_scene(), "half_backlash_um = 50", "half_backlash_um = 40");
  write_file(inner / "copy.toml", changed);
  check_refused(run(inner, "copy.toml -o out"), 2, {"holds the results of ", "inner/scene.toml", "inner/copy.toml"});
  write_file(inner / "copy.toml", test::quick_scene());
  BOOST_TEST(says(run(inner, "copy.toml -o out").out, "nothing has changed"));  // nothing is mixed
  // The same file by another path, and accuracy, which is no other scene.
  check_done(run(folder.path(), "inner/../inner/scene.toml -o inner/out --budget 1h"));
  fs::rename(inner / "scene.toml", inner / "renamed.toml");
  write_file(inner / "renamed.toml", changed);
  check_done(run(inner, "renamed.toml -o out"));
  write_file(inner / "other.toml", titled("other", changed));
  fs::remove(inner / "renamed.toml");
  check_refused(run(inner, "other.toml -o out"), 2, {"renamed.toml (\"Quick\")", "other.toml (\"other\")"});
  write_file(inner / "renamed.toml", changed);
  fs::rename(inner, folder.path() / "moved");
  write_file(folder.path() / "moved/renamed.toml", test::quick_scene());
  check_done(run(folder.path(), "moved/renamed.toml -o moved/out"));
}

BOOST_AUTO_TEST_CASE(folders_that_annulus_did_not_make) {
  const test::TemporaryFolder folder("not_made");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  for (const std::string name : {"report.html", "summary.json", "run.json", "owner.txt"}) {
    const auto out = folder.path() / ("with_" + name);
    fs::create_directories(out);
    write_file(out / name, "mine");
    check_refused(run_with_cache(folder.path(), "run scene.toml -o with_" + name), 2,
                  {"with_" + name + "/" + name, "exists already, and annulus did not write it"});
    BOOST_TEST(read_file(out / name) == "mine");
    BOOST_TEST(std::distance(fs::directory_iterator(out), {}) == 1);
  }
  // Others are let alone: the folder of the scene itself is one.
  fs::create_directories(folder.path() / "pictures");
  write_file(folder.path() / "pictures/01_mine.svg", "mine");
  check_done(run_with_cache(folder.path(), "run scene.toml -o ."));
  BOOST_TEST(read_file(folder.path() / "pictures/01_mine.svg") == "mine");
  BOOST_TEST(read_file(folder.path() / "scene.toml") == test::quick_scene());
}

BOOST_AUTO_TEST_CASE(links_are_never_written_through) {
  const test::TemporaryFolder folder("links");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  write_file(folder.path() / "target", "mine");
  const auto out = folder.path() / "out";
  for (const std::string name : {"report.html", "owner.txt", "held/dynamics/modes.csv"}) {
    fs::create_directories((out / name).parent_path());
    fs::create_symlink(folder.path() / "target", out / name);
    check_refused(run_with_cache(folder.path(), "run scene.toml -o out"), 2, {"out/" + name});
    BOOST_TEST(read_file(folder.path() / "target") == "mine");
    fs::remove_all(out);
  }
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  for (const std::string name : {"report.html", "run.json", "held/dynamics/modes.csv"}) {
    fs::remove(out / name);
    fs::create_symlink(folder.path() / "target", out / name);
  }
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  BOOST_TEST(read_file(folder.path() / "target") == "mine");
  BOOST_TEST(!fs::is_symlink(out / "report.html"));
  BOOST_TEST(!fs::is_symlink(out / "held/dynamics/modes.csv"));
  // Folders behind a link: nothing is written or removed there.
  const auto archived = folder.path() / "archive/dynamics/modes.csv";
  fs::create_directories(archived.parent_path());
  write_file(archived, "mine");
  fs::remove_all(out / "held");
  fs::create_directory_symlink(folder.path() / "archive", out / "held");
  check_refused(run_with_cache(folder.path(), "run scene.toml -o out"), 2, {"out/held is a link to another folder"});
  BOOST_TEST(read_file(archived) == "mine");
  write_file(folder.path() / "scene.toml", scene_with_ring("other"));
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  BOOST_TEST(read_file(archived) == "mine");
  BOOST_TEST(fs::is_symlink(out / "held"));
  write_file(folder.path() / "scene.toml", test::quick_scene());
  // Links that lead nowhere.
  fs::create_symlink("nowhere", folder.path() / "dangling");
  check_refused(run_with_cache(folder.path(), "run scene.toml -o dangling"), 2, {"dangling is a link to nowhere"});
  fs::create_directories(folder.path() / "inside");
  fs::create_symlink("nowhere", folder.path() / "inside/held");
  check_refused(run_with_cache(folder.path(), "run scene.toml -o inside"), 2,
                {"inside/held: is a link to nowhere, which does not exist"});
}

BOOST_AUTO_TEST_CASE(a_note_of_a_run_that_was_changed_is_not_believed) {
  const test::TemporaryFolder folder("note");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  const auto note = folder.path() / "out/run.json";
  const auto before = read_file(note);
  for (const std::string& damaged :
       {test::replaced(before, "Load sharing", "Load shaming"), std::string("{}"), before.substr(0, 100)}) {
    write_file(note, damaged);
    const auto again = run_with_cache(folder.path(), "run scene.toml -o out");
    check_done(again);
    BOOST_TEST(says(again.err, "run.json has changed since the last run"), again.err);
    BOOST_TEST(!says(again.out, "shaming"));
    BOOST_TEST(!says(again.out, "nothing has changed"));
  }
  fs::remove(note);
  fs::create_directory(note);
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  BOOST_TEST(fs::is_regular_file(note));
  fs::remove(note);
  BOOST_REQUIRE(::mkfifo(note.c_str(), 0600) == 0);
  const auto pipe = run_with_cache(folder.path(), "run scene.toml -o out");  // does not wait
  BOOST_TEST((pipe.status == 0 || pipe.status == 2), pipe.err);
  // A list of files that does not tell whose they are, before another scene.
  write_file(folder.path() / "scene.toml", scene_with_ring("other"));
  auto list = read_file(folder.path() / "out/owner.txt");
  list.erase(list.find("\nscene "), list.find("\ntitle ") - list.find("\nscene "));
  std::ofstream(folder.path() / "out/owner.txt") << list;
  check_refused(run_with_cache(folder.path(), "run scene.toml -o out"), 2,
                {"owner.txt: is damaged: it names no scene"});
}

BOOST_AUTO_TEST_CASE(rings_have_none_of_the_names_of_a_run) {
  const test::TemporaryFolder folder("ring_names");
  const std::string studies =
      "[[sweep]]\ninput = \"stage.sun_speed_rpm\"\nvalues = [1000, 1100]\n[sensitivity]\ninputs = "
      "[\"supports.planet_N_per_m\"]\n[monte_carlo]\nsamples = 2\n";
  write_file(folder.path() / "scene.toml", test::quick_scene() + studies);
  check_done(test::run_program(folder.path(), "run scene.toml -o out"));
  check_done(test::run_program(folder.path(), "tradeoff scene.toml -o out"));
  std::vector<std::string> names = {"grid", "sweep", "sensitivity", "optimise", "errors", "computed", "mesh"};
  for (const auto& entry : fs::directory_iterator(folder.path() / "out"))
    if (entry.path().filename() != "held") names.push_back(entry.path().filename().string());
  BOOST_TEST(names.size() > 14U);
  for (const auto& name : names) {
    BOOST_TEST(app::is_name_of_run(name), name);
    write_file(folder.path() / "scene.toml", scene_with_ring(name));
    check_refused(test::run_program(folder.path(), "check scene.toml"), 2, {"ring.name = " + name});
  }
  // A name that was one of the run's own folders.
  write_file(folder.path() / "scene.toml", scene_with_ring("condensed"));
  check_done(test::run_program(folder.path(), "run scene.toml -o other"));
  fs::remove_all(folder.path() / "other/condensed");
  check_done(test::run_program(folder.path(), "run scene.toml -o other"));
  BOOST_TEST(fs::exists(folder.path() / "other/condensed/dynamics/modes.csv"));
}

BOOST_AUTO_TEST_CASE(a_run_and_the_cost_study_of_a_scene_share_a_folder) {
  const test::TemporaryFolder folder("shared_folder");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  check_done(run_with_cache(folder.path(), "tradeoff scene.toml -o out"));
  const auto out = folder.path() / "out";
  BOOST_TEST(fs::exists(out / "tradeoff.html"));
  BOOST_TEST(says(run_with_cache(folder.path(), "run scene.toml -o out").out, "nothing has changed"));
  write_file(folder.path() / "scene.toml", scene_with_ring("other"));
  check_done(run_with_cache(folder.path(), "run scene.toml -o out"));
  BOOST_TEST(fs::exists(out / "tradeoff.html"));
  write_file(out / "tradeoff_mine.svg", "mine");
  check_done(run_with_cache(folder.path(), "tradeoff scene.toml -o out"));
  BOOST_TEST(read_file(out / "tradeoff_mine.svg") == "mine");
  BOOST_TEST(fs::exists(out / "report.html"));
}

BOOST_AUTO_TEST_CASE(pictures_of_a_comparison_and_names_that_are_formulas) {
  const test::TemporaryFolder folder("formulas");
  write_file(folder.path() / "soft.toml", test::quick_scene());
  write_file(folder.path() / "stiff.toml",
             test::replaced(test::quick_scene(), "planet_N_per_m = 1e9", "planet_N_per_m = 2e9"));
  check_done(run_with_cache(folder.path(), "run soft.toml -o '=1+1'"));
  check_done(run_with_cache(folder.path(), "run stiff.toml -o '@a\n=b'"));
  fs::create_directories(folder.path() / "both_pictures");
  write_file(folder.path() / "both_pictures/09_mine.svg", "mine");
  for (int i = 0; i < 2; ++i) check_done(run_with_cache(folder.path(), "compare '=1+1' '@a\n=b' -o both.html"));
  BOOST_TEST(read_file(folder.path() / "both_pictures/09_mine.svg") == "mine");
  write_file(folder.path() / "data.csv", "mine");
  check_refused(run_with_cache(folder.path(), "compare '=1+1' '@a\n=b' -o data.html"), 2, {"would replace data.csv"});
  BOOST_TEST(read_file(folder.path() / "data.csv") == "mine");
  const auto csv = read_file(folder.path() / "both.csv");
  BOOST_TEST(says(csv, ",'=1+1,"));
  BOOST_TEST(says(csv, ",'@a =b,"));
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    for (const char* formula : {",=", ",@", ",+", ",\"=", ",\"@", ",\"+"}) BOOST_TEST(!says("," + line, formula), line);
  }
}

BOOST_AUTO_TEST_CASE(output_that_cannot_be_written) {
  const test::TemporaryFolder folder("full_device");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  const auto to_full = [&](const std::string& arguments) {
    const auto outcome = test::run_program(folder.path(), "run scene.toml -o out -q",
                                           "sh -c '\"" ANNULUS_PROGRAM "\" " + arguments + " >/dev/full' -- ");
    return outcome;
  };
  for (const std::string arguments : {"run scene.toml -o full", "plan scene.toml", "check scene.toml", "explain",
                                      "--help", "new planetary", "completion bash"})
    check_refused(to_full(arguments), 2, {"cannot write to the standard output"});
  // The results are there nevertheless.
  BOOST_TEST(says(test::run_program(folder.path(), "run scene.toml -o full").out, "nothing has changed"));
  check_refused(test::run_program(folder.path(), "run scene.toml -o /dev/full"), 2,
                {"--out /dev/full", "not a folder"});
  check_refused(test::run_program(folder.path(), "export full/held/dynamics/load_sharing.csv --to csv -o /dev/full"), 2,
                {"cannot write /dev/full: it is a device or a pipe"});
  BOOST_TEST(fs::is_character_file("/dev/full"));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
