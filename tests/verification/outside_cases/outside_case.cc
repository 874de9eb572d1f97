#include "tests/verification/outside_cases/outside_case.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>
#include "tests/app/run_program.h"

namespace annulus::test {

namespace fs = std::filesystem;

OutsideCase::OutsideCase(const std::string& name) : name_(name), folder_(name) {
  std::ifstream file(scene("printed.csv"));
  BOOST_TEST_REQUIRE(file.good());
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line.front() == '#' || line == "quantity,unit,value") continue;
    std::istringstream cells(line);
    std::string quantity, unit, value;
    std::getline(cells, quantity, ',');
    std::getline(cells, unit, ',');
    std::getline(cells, value);
    const auto point = value.find('.');
    const auto decimals = point == std::string::npos ? 0 : value.size() - point - 1;
    printed_[quantity] = {unit, std::stod(value), 0.5 * std::pow(10.0, -static_cast<double>(decimals))};
  }
}

fs::path OutsideCase::scene(const std::string& file) const {
  return fs::path(ANNULUS_SOURCE_DIR) / "data/cases" / name_ / file;
}

fs::path OutsideCase::run(const std::string& file) const {
  const auto quoted = "'" + scene(file).string() + "'";
  for (const auto& command : {"check " + quoted, "run --quiet -o '" + file + "' " + quoted}) {
    const auto outcome = run_program(folder_.path(), command);
    BOOST_TEST_REQUIRE(outcome.status == 0, command << ": " << outcome.err);
  }
  return folder_.path() / file;
}

fs::path OutsideCase::solve(const std::string& file, const std::string& arguments) const {
  return with_arguments("solve", file, arguments);
}

fs::path OutsideCase::statics(const std::string& file, const std::string& arguments) const {
  return with_arguments("statics", file, arguments);
}

fs::path OutsideCase::with_arguments(const std::string& command, const std::string& file,
                                     const std::string& arguments) const {
  auto out = file + arguments;
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  const auto line = command + " --quiet " + arguments + " -o '" + out + "' '" + scene(file).string() + "'";
  const auto outcome = run_program(folder_.path(), line);
  BOOST_TEST_REQUIRE(outcome.status == 0, line << ": " << outcome.err);
  return folder_.path() / out;
}

}  // namespace annulus::test
