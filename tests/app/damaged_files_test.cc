#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cctype>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/files.h"
#include "tests/app/fault_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/run_results.h"
#include "tests/temporary_folder.h"

// Kept results damaged at random: the next run states the damage or computes anew, and never takes it.

namespace annulus {

namespace {

namespace fs = std::filesystem;

constexpr int damages = 200;

struct Damage {
  const char* name;
  std::string (*apply)(std::string bytes, std::mt19937& random);
};

std::size_t place(const std::string& bytes, std::mt19937& random) {
  return std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random);
}

std::string flipped(std::string bytes, std::mt19937& random) {
  bytes[place(bytes, random)] ^= static_cast<char>(1 << std::uniform_int_distribution(0, 7)(random));
  return bytes;
}

/// What no reader notices by the form of a file.
std::string digit_changed(std::string bytes, std::mt19937& random) {
  const auto start = place(bytes, random);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (char& c = bytes[(start + i) % bytes.size()]; std::isdigit(static_cast<unsigned char>(c))) {
      c = c == '9' ? '1' : static_cast<char>(c + 1);
      return bytes;
    }
  return flipped(std::move(bytes), random);
}

std::string cut(std::string bytes, std::mt19937& random) { return bytes.substr(0, place(bytes, random)); }

std::string zeroed(std::string bytes, std::mt19937& random) {
  const auto start = place(bytes, random);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(start),
            bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), start + 16)), '\0');
  return bytes;
}

std::string line_moved(std::string bytes, std::mt19937& random) {
  const auto end = bytes.find('\n', place(bytes, random));
  if (end == std::string::npos || end + 1 == bytes.size()) return flipped(std::move(bytes), random);
  return bytes.substr(end + 1) + bytes.substr(0, end + 1);
}

constexpr Damage kinds[] = {{"bit flipped", flipped},
                            {"digit changed", digit_changed},
                            {"cut", cut},
                            {"bytes zeroed", zeroed},
                            {"lines moved", line_moved}};

}  // namespace

BOOST_AUTO_TEST_SUITE(damaged_files)

BOOST_AUTO_TEST_CASE(no_damaged_byte_reaches_a_result) {
  const test::TemporaryFolder folder("damaged_files");
  const auto out = folder.path() / "out", whole = folder.path() / "whole";
  write_file(folder.path() / "scene.toml", test::fault_scene("damaged_results"));
  const auto run = [&] { return test::run_program(folder.path(), "run scene.toml -o out --quiet --threads 2"); };
  BOOST_TEST_REQUIRE(run().status == 0);
  const auto expected = test::results_in(out);
  fs::copy(out, whole, fs::copy_options::recursive);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(whole))
    if (entry.is_regular_file() && entry.file_size() > 0 && entry.path().filename() != "owner.txt")
      files.push_back(entry.path().lexically_relative(whole));
  std::sort(files.begin(), files.end());
  std::mt19937 random(25);
  std::map<std::string, int> outcomes;
  for (int i = 0; i < damages; ++i) {
    const auto& file = files[std::uniform_int_distribution<std::size_t>(0, files.size() - 1)(random)];
    const auto& kind = kinds[static_cast<std::size_t>(i) % std::size(kinds)];
    const auto before = read_file(out / file), after = kind.apply(before, random);
    write_file(out / file, after);
    const auto outcome = run();
    const auto what = fmt::format("{}: {}, status {}: {}", file.string(), kind.name, outcome.status, outcome.err);
    const bool same = outcome.status == 0 && test::results_in(out) == expected;
    if (same) {
      ++outcomes["right"];
    } else {
      const bool refused = outcome.status == 2 || outcome.status == 3;
      ++outcomes[refused ? "refused" : outcome.status == 0 ? "wrong" : "crashed"];
      // A refusal names the file.
      if (!refused || outcome.err.find(file.filename().string()) == std::string::npos) BOOST_ERROR(what);
    }
    fs::remove_all(out);
    fs::copy(whole, out, fs::copy_options::recursive);
  }
  BOOST_TEST_MESSAGE(fmt::format("{} damages: {} right, {} refused, {} wrong, {} crashed", damages, outcomes["right"],
                                 outcomes["refused"], outcomes["wrong"], outcomes["crashed"]));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
