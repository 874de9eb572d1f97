#include "core/files.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.h"
#include "core/file_guard.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(files)

namespace {

using annulus::read_file;
using annulus::UnfinishedFile;
using annulus::write_file;
using annulus::test::TemporaryFolder;

std::ptrdiff_t count(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

/// Of a process that has ended.
int ended_process() {
  const int child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_replaced_file_leaves_nothing_behind) {
  const TemporaryFolder folder("files");
  write_file(folder.path() / "f", "old and longer");
  write_file(folder.path() / "f", "new");
  BOOST_TEST(read_file(folder.path() / "f") == "new");
  BOOST_TEST(count(folder.path()) == 1);
}

BOOST_AUTO_TEST_CASE(every_byte_is_read_and_what_cannot_be_is_named) {
  const TemporaryFolder folder("read_file");
  const auto file = folder.path() / "f";
  const std::string bytes("a\r\n\0\xff\x1a end", 10);
  write_file(file, bytes);
  BOOST_TEST((read_file(file) == bytes));
  write_file(file, "");
  BOOST_TEST(read_file(file).empty());
  for (const auto& none : {folder.path() / "missing", folder.path()})
    BOOST_CHECK_EXCEPTION((void)read_file(none), annulus::InputError, [&](const auto& e) {
      return std::string(e.what()).find("cannot read " + none.string()) == 0;
    });
}

BOOST_AUTO_TEST_CASE(nothing_is_seen_of_a_file_that_is_not_finished) {
  const TemporaryFolder folder("unfinished");
  const auto file = folder.path() / "f";
  write_file(file, "whole");
  {
    const UnfinishedFile given_up(file);
    std::ofstream(given_up.temporary()) << "half of";
    BOOST_TEST(read_file(file) == "whole");
  }
  BOOST_TEST(read_file(file) == "whole");
  BOOST_TEST(count(folder.path()) == 1);
}

BOOST_AUTO_TEST_CASE(many_writers_of_one_file_leave_one_of_theirs_whole) {
  const TemporaryFolder folder("writers");
  const auto file = folder.path() / "f";
  std::vector<std::thread> writers;
  for (char letter = 'a'; letter < 'e'; ++letter)
    writers.emplace_back([&file, letter] {
      for (int i = 0; i < 50; ++i) write_file(file, std::string(100'000, letter));
    });
  for (auto& w : writers) w.join();
  const auto text = read_file(file);
  BOOST_TEST(text.size() == 100'000U);
  BOOST_TEST(text.find_first_not_of(text.front()) == std::string::npos);
  BOOST_TEST(count(folder.path()) == 1);
}

BOOST_AUTO_TEST_CASE(links_and_devices_are_not_written_through) {
  const TemporaryFolder folder("links");
  const auto file = folder.path() / "f", target = folder.path() / "target";
  write_file(target, "of another");
  // Under the temporary names that come next, and the final one.
  std::string name = UnfinishedFile(file).temporary().filename();
  const auto middle = "." + std::to_string(::getpid()) + ".";
  const auto at = name.find(middle) + middle.size();
  const int counter = std::stoi(name.substr(at));
  for (int i = 1; i < 4; ++i)
    std::filesystem::create_symlink(target,
                                    folder.path() / ("f" + middle + std::to_string(counter + i) + ".unfinished"));
  std::filesystem::create_symlink(target, file);
  write_file(file, "new");
  BOOST_TEST(read_file(target) == "of another");
  BOOST_TEST(read_file(file) == "new");
  BOOST_TEST(!std::filesystem::is_symlink(file));
  BOOST_TEST(count(folder.path()) == 5);
  for (const char* device : {"/dev/full", "/dev/null"}) {
    BOOST_CHECK_THROW(write_file(device, "x"), annulus::FileError);
    std::filesystem::create_symlink(device, folder.path() / "device");
    BOOST_CHECK_THROW(write_file(folder.path() / "device", "x"), annulus::FileError);
    std::filesystem::remove(folder.path() / "device");
    BOOST_TEST(std::filesystem::is_character_file(device));
  }
}

namespace {

/// Refuses one file.
class Refusal : annulus::FileGuard {
 public:
  explicit Refusal(std::filesystem::path file) : file_(std::move(file)) {}

 protected:
  void before_write(const std::filesystem::path& file) override { refuse(file); }
  void before_removal(const std::filesystem::path& file) override { refuse(file); }

 private:
  void refuse(const std::filesystem::path& file) const {
    if (file == file_) throw annulus::FileError("refused");
  }
  std::filesystem::path file_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(guards_are_asked_before_files_are_written_and_removed) {
  const TemporaryFolder folder("guards");
  const auto file = folder.path() / "f", other = folder.path() / "g";
  write_file(file, "old");
  {
    const Refusal guard(file);
    BOOST_CHECK_THROW(write_file(file, "new"), annulus::FileError);
    BOOST_CHECK_THROW(annulus::remove_file(file), annulus::FileError);
    BOOST_TEST(read_file(file) == "old");
    write_file(other, "new");
    annulus::remove_file(other);
    BOOST_TEST(count(folder.path()) == 1);
  }
  write_file(file, "new");
  annulus::remove_file(file);
  annulus::remove_file(file);  // nothing to do
  BOOST_TEST(count(folder.path()) == 0);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_written_is_named_with_the_reason) {
  const TemporaryFolder folder("unwritable");
  BOOST_CHECK_THROW(write_file(folder.path() / "missing" / "f", "x"), annulus::FileError);
  std::filesystem::create_directory(folder.path() / "taken");
  write_file(folder.path() / "taken" / "inside", "x");
  BOOST_CHECK_THROW(write_file(folder.path() / "taken", "x"), annulus::FileError);
  BOOST_TEST(count(folder.path()) == 1);
}

BOOST_AUTO_TEST_CASE(old_files_of_dead_processes_are_removed_and_no_others) {
  const TemporaryFolder folder("leftovers");
  std::filesystem::create_directory(folder.path() / "inside");
  const auto dead = std::to_string(ended_process());
  const auto put = [&](const std::string& name, int minutes_ago) {
    write_file(folder.path() / name, "x");
    std::filesystem::last_write_time(folder.path() / name,
                                     std::filesystem::file_time_type::clock::now() - std::chrono::minutes(minutes_ago));
  };
  put("inside/a.csv." + dead + ".0.unfinished", 20);
  put("b.msh." + dead + ".1.unfinished.msh", 20);
  put("young.csv." + dead + ".2.unfinished", 1);
  put("alive.csv." + std::to_string(::getpid()) + ".3.unfinished", 20);
  put("mine.unfinished", 20);
  put("c.csv", 20);
  annulus::remove_unfinished_files(folder.path());
  BOOST_TEST(count(folder.path() / "inside") == 0);
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    left.push_back(entry.path().filename().string().substr(0, 4));
  std::sort(left.begin(), left.end());
  BOOST_TEST(left == (std::vector<std::string>{"aliv", "c.cs", "insi", "mine", "youn"}),
             boost::test_tools::per_element());
  annulus::remove_unfinished_files(folder.path() / "missing");  // nothing to do
}

BOOST_AUTO_TEST_SUITE_END()
