#include "core/table_import.h"

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/files.h"
#include "tests/temporary_folder.h"

/// Tables of other programs against the curve they were made from.
namespace annulus {

namespace {

double stiffness_at(double cycles) { return 1e9 * (1 + 0.2 * std::cos(2 * std::numbers::pi * cycles)); }

struct OtherTable {
  test::TemporaryFolder folder{"table_import"};
  std::filesystem::path file = folder.path() / "other.csv";

  StiffnessTable import(const std::string& text, const std::string& mesh = "sun_planet") const {
    write_file(file, text);
    return import_table(file, mesh);
  }
  std::string refusal(const std::string& text) const {
    try {
      (void)import(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(table_import)

BOOST_AUTO_TEST_CASE(equidistant_values_are_taken_as_they_are) {
  const OtherTable other;
  std::string text = "# from: elsewhere\nmesh_phase_deg,stiffness_N_per_um\n";
  for (int i = 0; i <= 12; ++i) text += fmt::format("{:.17g},{:.17g}\n", 30.0 * i, stiffness_at(i / 12.0) / 1e6);
  const auto table = other.import(text);
  BOOST_TEST(table.phases() == 12);
  BOOST_TEST(table.positions() == 1);
  for (int i = 0; i < 12; ++i) {
    BOOST_TEST(table.at(0, i, 0).stiffness_secant == stiffness_at(i / 12.0), boost::test_tools::tolerance(1e-14));
    BOOST_TEST(table.at(0, i, 0).stiffness_tangent == stiffness_at(i / 12.0), boost::test_tools::tolerance(1e-14));
  }
  // Without a load it holds for any.
  for (const double load : {1.0, 1e4, 1e7})
    BOOST_TEST(curves_at_load(table, load).stiffness_secant(1.0 / 3) == stiffness_at(1.0 / 3),
               boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(any_phases_in_any_order_are_resampled) {
  const OtherTable other;
  // 40 places of uneven distance, every third first, then the others: a smooth curve is met to the order of its cubics.
  std::vector<int> order;
  for (int first = 0; first < 3; ++first)
    for (int i = first; i < 40; i += 3) order.push_back(i);
  std::string text = "lte_um,load_N,mesh_phase,unloaded_te_um\n";
  for (const int i : order) {
    const double phase = (i + 0.3 * std::sin(i)) / 40 + 0.01;
    text += fmt::format("{:.17g},20000,{:.17g},2\n", 2 + 1e6 * 20000 / stiffness_at(phase), phase);
  }
  const auto table = other.import(text);
  BOOST_TEST(table.phases() == 64);
  double largest = 0;
  for (int i = 0; i < 64; ++i) {
    BOOST_TEST(table.at(0, i, 0).unloaded_te == 2e-6, boost::test_tools::tolerance(1e-12));
    largest = std::max(largest, std::abs(table.at(0, i, 0).stiffness_secant / stiffness_at(i / 64.0) - 1));
  }
  // Second order near extrema: (2 pi / 40 * 1.3)^2 * 0.2 / 8 = 1e-3.
  BOOST_TEST(largest < 1e-3);
  BOOST_TEST(largest > 0);
}

BOOST_AUTO_TEST_CASE(several_loads_make_a_law_and_cycles_ring_positions) {
  const OtherTable other;
  // lte = F^(9/10): tangent 10/9 of the secant; three mesh cycles.
  std::string text = "mesh_cycles,load_N,lte_m,error_relative\n";
  for (const double load : {1e4, 1.1e4, 1.2e4})
    for (int i = 0; i < 24; ++i)
      text += fmt::format("{:.17g},{},{:.17g},0.02\n", i / 8.0, load, std::pow(load, 0.9) / stiffness_at(i / 24.0));
  const auto table = other.import(text, "ring_planet");
  BOOST_TEST(table.positions() == 3);
  BOOST_TEST(table.phases() == 8);
  BOOST_TEST((table.loads() == std::vector<double>{1e4, 1.1e4, 1.2e4}));
  const auto& e = table.at(1, 4, 1);  // cycle 1.5: half the period
  BOOST_TEST(e.lte == std::pow(1.1e4, 0.9) / stiffness_at(0.5), boost::test_tools::tolerance(1e-12));
  // A central difference over 18 % of the load.
  BOOST_TEST(e.stiffness_tangent / e.stiffness_secant == 10.0 / 9, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(e.error_relative == 0.02);
}

BOOST_AUTO_TEST_CASE(native_tables_are_read_as_such) {
  const OtherTable other;
  const auto first = other.import("mesh_phase,stiffness_N_per_m\n0,1e9\n0.25,1.1e9\n0.5,1.2e9\n0.75,1.1e9\n");
  first.write_csv(other.file);
  const auto again = import_table(other.file, "sun_planet");
  BOOST_TEST(again.at(0, 2, 0).stiffness_secant == 1.2e9);
  BOOST_CHECK_THROW((void)import_table(other.file, "ring_planet"), InputError);
}

BOOST_AUTO_TEST_CASE(what_is_wrong_is_told_with_its_line) {
  const OtherTable other;
  const std::string head = "mesh_phase,stiffness_N_per_m\n", three = "0,1e9\n0.25,1e9\n0.5,1e9\n";
  const auto tells = [&](const std::string& text, const std::string& what) {
    const auto message = other.refusal(text);
    BOOST_TEST(message.find(what) != std::string::npos, message);
    BOOST_TEST(message.find(other.file.string() + ":") == 0U, message);
  };
  tells("phase,stiffness_N_per_m\n0,1\n", ":1: is not a stiffness table: no column mesh_phase");
  tells("mesh_phase,stiffness\n0,1\n", ":1: is not a stiffness table: no column stiffness_N_per_m");
  tells("mesh_phase,lte_um\n0,1\n", "lte needs a column load_N");
  tells(head, "no data");
  tells(head + three, "at least four phases");
  tells("mesh_cycles,stiffness_N_per_m\n0,1e9\n0.25,1e9\n0.5,1e9\n7.5,1e9\n", "4 phases over 8 mesh cycles");
  tells(head + three + "0.75,0\n", ":5: the stiffness has to be above zero");
  tells(head + three + "0.75,nan\n", ":5: stiffness_N_per_m is not a finite number");
  tells(head + three + "0.5,1e9\n", "the same phase twice");
  tells(head + three + "0.75,1e9\n1,1e9\n1,1e9\n", "the same phase twice");
  tells(head + three + "0.75,1e9\n1,2e9\n", ":6: the deflection at the end of the period is");
  tells(head + three + "-0.25,1e9\n", "between zero and 2000 mesh cycles");
  tells("mesh_cycles,stiffness_N_per_m\n0,1e9\n1e9,1e9\n", ":3: the phase has to lie between zero");
  tells("mesh_phase,lte_um,load_N\n0,1,-5\n", "load_N has to be above zero");
  tells("mesh_phase,lte_um,load_N,unloaded_te_um\n0,1,5,2\n", "lte has to exceed unloaded_te");
  std::string falling = "mesh_phase,lte_um,load_N\n";
  for (int i = 0; i < 4; ++i) falling += fmt::format("{},5,100\n{},4,200\n", i / 4.0, i / 4.0);
  tells(falling, "deflection does not rise with the load");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
