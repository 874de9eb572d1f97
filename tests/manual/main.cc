/// The verification manual from what the tests recorded (scripts/verification_manual.sh), and whether it still tells
/// what they do.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>

#include "core/files.h"
#include "page.h"

namespace {

using namespace annulus::manual;
namespace fs = std::filesystem;

struct Arguments {
  fs::path entries, records, introduction, docs;
};

void write(const Arguments& a) {
  const auto cases = list_cases(a.entries);
  auto records = read_records(a.records);
  // What was recorded by tests that are no more.
  std::erase_if(records, [&](const auto& r) {
    return std::none_of(cases.begin(), cases.end(), [&](const auto& c) { return c.name == r.first; });
  });
  const fs::path pictures = a.docs / "verification";
  fs::remove_all(pictures);
  fs::create_directories(pictures);
  for (const auto& [name, record] : records)
    for (std::size_t i = 0; i < record.pictures.size(); ++i)
      std::ofstream(pictures / picture_name(name, i)) << picture_svg(record.pictures[i]);
  std::set<std::pair<std::string, std::string>> suites;
  for (const auto& c : cases) suites.emplace(c.name.layer, c.name.suite);
  for (const auto& [layer, suite] : suites)
    if (const auto found = records_of(layer, suite, cases, records); !found.empty())
      std::ofstream(pictures / tolerances_name(layer, suite)) << tolerances_svg(found);
  std::ofstream(a.docs / "verification.md") << page(annulus::read_file(a.introduction), cases, records);
}

/// Names of verification test cases that the manual does not tell of.
int check(const Arguments& a) {
  const auto manual = annulus::read_file(a.docs / "verification.md");
  int missing = 0;
  for (const auto& c : list_cases(a.entries))
    if (c.label == "verification" && manual.find('`' + c.name.text() + '`') == std::string::npos) {
      std::cerr << c.name.text() << " is not in docs/verification.md\n";
      ++missing;
    }
  // And the other way round.
  const auto cases = list_cases(a.entries);
  static const std::regex named("`([a-z]+\\.[a-z0-9_]+/[a-z0-9_]+)`");
  for (std::sregex_iterator at(manual.begin(), manual.end(), named), end; at != end; ++at)
    if (std::none_of(cases.begin(), cases.end(), [&](const auto& c) { return c.name.text() == (*at)[1].str(); })) {
      std::cerr << (*at)[1] << " in docs/verification.md is no test case\n";
      ++missing;
    }
  return missing;
}

/// A section without what differs from machine to machine by rounding: which of many comparisons is the worst, its
/// figures, and tolerances that follow from them. Every comparison lies within its tolerance, or its test would have
/// failed.
std::string without_figures(const std::string& section) {
  std::string result;
  std::istringstream lines(section);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| ", 0) == 0) {
      static const std::regex column(R"((?:[^|\\]|\\.)+)");
      std::vector<std::string> cells;
      for (std::sregex_iterator at(line.begin(), line.end(), column), end; at != end; ++at) cells.push_back(at->str());
      const bool constant = cells.size() == 6 && cells[4].find(" of it") != std::string::npos;
      if (cells.size() == 6) line = cells[0] + '|' + (constant ? cells[4] : "") + '|' + cells[5];
    }
    result += line + '\n';
  }
  return std::regex_replace(result, std::regex(" \\(worst of \\d+\\)"), "");
}

/// Cases whose section of the manual tells something else than the test that ran last.
int compare(const Arguments& a) {
  const auto manual = without_figures(annulus::read_file(a.docs / "verification.md"));
  int compared = 0, different = 0;
  const auto cases = list_cases(a.entries);
  for (const auto& [name, record] : read_records(a.records)) {
    const auto same = [&, n = name](const auto& c) { return c.name == n; };
    if (std::none_of(cases.begin(), cases.end(), same)) continue;
    ++compared;
    if (manual.find(without_figures(case_section(name, record))) != std::string::npos) continue;
    std::cerr << name.text() << " differs from docs/verification.md: run scripts/verification_manual.sh\n";
    ++different;
  }
  fmt::print("{} recorded cases compared with docs/verification.md\n", compared);
  return different;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  CLI::App app("The verification manual from what the tests recorded");
  app.require_subcommand(1);
  const auto add = [&](const char* name, const char* text) {
    auto* command = app.add_subcommand(name, text);
    command->add_option("--entries", a.entries, "tests: label, layer, suite, program")->required();
    command->add_option("--docs", a.docs, "folder of the manual")->required();
    return command;
  };
  auto* writing = add("write", "writes docs/verification.md and its pictures");
  writing->add_option("--records", a.records, "folder of the records")->required();
  writing->add_option("--introduction", a.introduction, "what stands before the cases")->required();
  auto* checking = add("check", "fails when a verification test case is not in the manual");
  auto* comparing = add("compare", "fails when records and manual differ in more than figures");
  comparing->add_option("--records", a.records, "folder of the records")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    if (*writing) write(a);
    if (*checking && check(a) > 0) return 1;
    if (*comparing && compare(a) > 0) return 1;
  } catch (const std::exception& e) {
    std::cerr << "verification_manual: " << e.what() << '\n';
    return 2;
  }
  return 0;
}
