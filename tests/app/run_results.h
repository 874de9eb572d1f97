#pragma once

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "core/files.h"
#include "tests/app/run_program.h"

/// What a run of the program leaves, to be compared with what another one leaves, bit by bit.
namespace annulus::test {

/// Without what tells how long things took and what was reused.
inline void forget_times(nlohmann::json& json) {
  static const std::regex cost("_seconds|^seconds_per_|^(condensed|reused)_teeth$|^reused$");
  if (json.is_object()) {
    for (const auto* key : {"timings_s", "reuse", "cost", "peak_memory_MB"}) json.erase(key);
    for (auto it = json.begin(); it != json.end();)
      it = std::regex_search(it.key(), cost) ? json.erase(it) : std::next(it);
  }
  if (json.is_structured())
    for (auto& value : json) forget_times(value);
}

/// Every result of a run by its place, without times. The report repeats them with times all over.
inline std::map<std::string, std::string> results_in(const std::filesystem::path& out) {
  static const std::regex times("# ([a-z_]*_seconds|(condensed|reused)_teeth): [^\n]*\n");
  std::map<std::string, std::string> results;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
    const auto place = entry.path().lexically_relative(out);
    if (!entry.is_regular_file() || *place.begin() == "cache" || place == "run.json" || place == "run.log" ||
        place == "owner.txt" || place == "report.html" || is_unfinished(place))
      continue;
    auto text = read_file(entry.path());
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
inline std::string difference(const std::string& place, const std::string& expected, const std::string& found) {
  if (place.ends_with(".json"))
    return nlohmann::json::diff(nlohmann::json::parse(expected), nlohmann::json::parse(found)).dump().substr(0, 500);
  const auto at = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end()).first - expected.begin();
  return "at byte " + std::to_string(at);
}

inline void check_same(const std::map<std::string, std::string>& expected,
                       const std::map<std::string, std::string>& found) {
  for (const auto& [place, text] : expected) {
    const auto it = found.find(place);
    BOOST_TEST((it != found.end()), place << " is missing");
    if (it != found.end() && it->second != text)
      BOOST_ERROR(place << " differs: " << difference(place, text, it->second));
  }
  BOOST_TEST(found.size() == expected.size());
}

}  // namespace annulus::test
