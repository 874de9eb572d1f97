#include "records.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace annulus::manual {

namespace {

using nlohmann::json;

/// JSON has no infinities: a null was one.
double number(const json& value) { return value.is_null() ? HUGE_VAL : value.get<double>(); }

std::vector<double> numbers(const json& values) {
  std::vector<double> result;
  for (const auto& v : values) result.push_back(number(v));
  return result;
}

Row read_row(const json& j) {
  return {j.at("quantity"),
          j.at("unit"),
          j.at("origin"),
          j.at("kind"),
          number(j.at("computed")),
          number(j.at("expected")),
          number(j.at("tolerance")),
          number(j.at("used")),
          j.at("comparisons")};
}

Picture read_picture(const json& j) {
  Picture picture{j.at("title"), j.at("x_label"), j.at("y_label"), j.at("x_log"), j.at("y_log"), j.at("slopes"), {}};
  for (const auto& c : j.at("curves"))
    picture.curves.push_back({c.at("label"), numbers(c.at("x")), numbers(c.at("computed")), numbers(c.at("reference")),
                              numbers(c.at("reference_x"))});
  return picture;
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string output;
  std::array<char, 4096> part{};
  while (const auto read = std::fread(part.data(), 1, part.size(), pipe.get())) output.append(part.data(), read);
  return output;
}

/// Suites with their cases, of Boost.Test's --list_content: names with a star when enabled, cases indented.
std::map<std::string, std::vector<std::string>> content_of(const std::string& program) {
  std::istringstream lines(output_of('\'' + program + "' --list_content 2>&1"));
  std::map<std::string, std::vector<std::string>> suites;
  std::string line, suite;
  while (std::getline(lines, line)) {
    const auto begin = line.find_first_not_of(' '), end = line.find('*');
    if (begin == std::string::npos || end == std::string::npos) continue;
    const auto name = line.substr(begin, end - begin);
    if (begin == 0)
      suite = name;
    else
      suites[suite].push_back(name);
  }
  return suites;
}

}  // namespace

Records read_records(const std::filesystem::path& folder) {
  Records records;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream file(entry.path());
    const json j = json::parse(file);
    Record record{j.at("title"), j.at("reference"), {}, {}};
    for (const auto& row : j.at("rows")) record.rows.push_back(read_row(row));
    for (const auto& plot : j.at("plots")) record.pictures.push_back(read_picture(plot));
    records[{j.at("layer"), j.at("suite"), j.at("case")}] = record;
  }
  return records;
}

std::vector<ListedCase> list_cases(const std::filesystem::path& entries) {
  std::ifstream file(entries);
  if (!file) throw std::runtime_error("cannot read " + entries.string());
  std::map<std::string, std::map<std::string, std::vector<std::string>>> known;
  std::vector<ListedCase> cases;
  std::string label, layer, suite, program;
  while (file >> label >> layer >> suite && std::getline(file >> std::ws, program)) {
    if (known.count(program) == 0) known[program] = content_of(program);
    const auto& names = known[program][suite];
    if (names.empty()) throw std::runtime_error(program + " has no test cases in suite " + suite);
    for (const auto& name : names) cases.push_back({{layer, suite, name}, label});
  }
  return cases;
}

}  // namespace annulus::manual
