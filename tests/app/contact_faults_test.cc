#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "core/files.h"
#include "tests/app/fault_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

// Scenes whose contact was once wrong without a word.

namespace annulus {

BOOST_AUTO_TEST_SUITE(contact_faults)

BOOST_AUTO_TEST_CASE(a_thin_rim_on_bolts_gives_way_more_under_more_load) {
  const test::TemporaryFolder folder("omitted_pair");
  write_file(folder.path() / "scene.toml", test::fault_scene("omitted_pair"));
  const auto solved = test::run_program(folder.path(), "solve scene.toml -o out --quiet --threads 2");
  BOOST_TEST_REQUIRE(solved.status == 0, solved.err);
  const auto csv = Csv::read(folder.path() / "out/ring/lte_ring_planet.csv");
  const auto cycle = csv.column("ring_tooth"), phase = csv.column("mesh_phase"), load = csv.column("load_N"),
             lte = csv.column("lte_um");
  std::map<std::pair<double, double>, std::map<double, double>> curves;
  for (const auto& row : csv.rows) curves[{row[cycle], row[phase]}][row[load]] = row[lte];
  BOOST_TEST(curves.size() > 100U);
  for (const auto& [position, curve] : curves) {
    double before = 0;
    for (const auto& [force, error] : curve) {
      BOOST_TEST(error > before, "ring tooth " << position.first << ", phase " << position.second << ", " << force);
      before = error;
    }
  }
}

BOOST_AUTO_TEST_CASE(pins_turned_by_three_teeth_shift_the_table) {
  const test::TemporaryFolder folder("order_of_teeth");
  constexpr int turned_teeth = 3, cycles = 41;  // 82 teeth on 24 pins repeat after 41
  std::map<std::vector<double>, std::pair<double, double>> tables[2];
  const auto scene = test::fault_scene("order_of_teeth");
  for (const bool turned : {false, true}) {
    const std::string angle = turned ? "first_pin_angle_deg = 13.170731707317\n" : "";  // 3 x 360 / 82
    write_file(folder.path() / "scene.toml",
               test::replaced(scene, "pin_diameter_mm = 6\n", "pin_diameter_mm = 6\n" + angle));
    const auto solved = test::run_program(folder.path(), "solve scene.toml -o out --quiet --threads 2");
    BOOST_TEST_REQUIRE(solved.status == 0, solved.err);
    const auto csv = Csv::read(folder.path() / "out/held/lte_ring_planet.csv");
    const auto cycle = csv.column("ring_tooth"), phase = csv.column("mesh_phase"), load = csv.column("load_N"),
               lte = csv.column("lte_um"), pressure = csv.column("max_pressure_MPa");
    for (const auto& row : csv.rows) {
      if (row[phase] == 1) continue;
      const int tooth = (static_cast<int>(row[cycle]) + (turned ? cycles - turned_teeth : 0)) % cycles;
      tables[turned][{static_cast<double>(tooth), row[phase], row[load]}] = {row[lte], row[pressure]};
    }
  }
  BOOST_TEST_REQUIRE(tables[0].size() == 13120U);
  BOOST_TEST_REQUIRE(tables[1].size() == tables[0].size());
  constexpr double digits = 2e-5;  // tables have six
  double largest = 0;
  for (const auto& [place, values] : tables[0]) {
    const auto& other = tables[1].at(place);
    largest = std::max({largest, std::abs(other.first / values.first - 1), std::abs(other.second / values.second - 1)});
  }
  BOOST_TEST(largest < digits);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
