#include "tests/verification/outside_cases/outside_case.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

namespace annulus::test {

namespace fs = std::filesystem;

OutsideCase::OutsideCase(std::string name) : name_(std::move(name)) {
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
  const fs::path out = fs::temp_directory_path() / ("annulus_" + name_ + "_" + file);
  fs::remove_all(out);
  const std::string program = std::string("ANNULUS_CACHE= ") + ANNULUS_PROGRAM, scene_file = scene(file).string();
  BOOST_TEST_REQUIRE(std::system((program + " check " + scene_file + " > /dev/null").c_str()) == 0);
  BOOST_TEST_REQUIRE(
      std::system((program + " run " + scene_file + " --quiet -o " + out.string() + " > /dev/null").c_str()) == 0);
  return out;
}

}  // namespace annulus::test
