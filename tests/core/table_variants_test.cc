#include "core/table_variants.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"

BOOST_AUTO_TEST_SUITE(table_variants)

using annulus::JumpSide;
using annulus::StiffnessEntry;
using annulus::StiffnessTable;

/// Two positions, four phases, two loads; stiffness 1e9 + 1e8 x (number of the entry), error 1 %, unloaded TE 2 um.
StiffnessTable sample() {
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < 16; ++i) {
    const double load = i % 2 ? 2e3 : 1e3, k = 1e9 + 1e8 * i;
    entries.push_back({2e-6, 2e-6 + load / k, k, 1.2 * k, 0.01});
  }
  return {"ring_planet", 4, {0.0, 0.04}, {1e3, 2e3}, entries};
}

template <class Check>
void for_each_entry(const StiffnessTable& table, Check check) {
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase)
      for (int load = 0; load < 2; ++load) check(position, phase, load, table.at(position, phase, load));
}

BOOST_AUTO_TEST_CASE(stiffer_raises_all_by_the_error) {
  const auto table = sample(), changed = stiffer(table);
  for_each_entry(changed, [&](int position, int phase, int load, const StiffnessEntry& e) {
    const auto& before = table.at(position, phase, load);
    BOOST_TEST(e.stiffness_secant == 1.01 * before.stiffness_secant, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(e.stiffness_tangent == 1.01 * before.stiffness_tangent, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(e.unloaded_te == before.unloaded_te);
    BOOST_TEST(e.stiffness_secant * (e.lte - e.unloaded_te) == table.loads()[load],
               boost::test_tools::tolerance(1e-12));
  });
}

BOOST_AUTO_TEST_CASE(more_ripple_moves_both_ways_about_the_mean_of_each_load) {
  const auto table = sample(), changed = more_rippled(table);
  // Means: entries 0, 2, ..., 14 and 1, 3, ..., 15.
  const double mean[] = {1e9 + 7e8, 1e9 + 8e8};
  for_each_entry(changed, [&](int position, int phase, int load, const StiffnessEntry& e) {
    const double before = table.at(position, phase, load).stiffness_secant;
    BOOST_TEST(e.stiffness_secant == (before > mean[load] ? before * 1.01 : before / 1.01),
               boost::test_tools::tolerance(1e-14));
  });
}

BOOST_AUTO_TEST_CASE(play_is_not_elastic) {
  // 20 um of play before a linear stiffness, which the model leaves 3 % of out; 1 % of the deflection is uncertain too.
  const double play = 20e-6, loads[] = {1e3, 2e3}, k[] = {1e9, 1.2e9};
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < 4; ++i) {
    const double load = loads[i % 2], g = play + load / k[i / 2];
    StiffnessEntry e{0, g, load / g, k[i / 2], 0.04};
    e.error_parts.model = 0.03;
    e.error_parts.discretisation = 0.01;
    entries.push_back(e);
  }
  const StiffnessTable table("ring_planet", 2, {0.0}, {1e3, 2e3}, entries);
  const auto changed = stiffer(table), rippled = more_rippled(table);
  for (int phase = 0; phase < 2; ++phase)
    for (int load = 0; load < 2; ++load) {
      const auto &before = table.at(0, phase, load), &after = changed.at(0, phase, load);
      const double elastic = before.lte - play, factor = 1 + 0.03 + 0.01 * before.lte / elastic;
      BOOST_TEST(after.lte == play + elastic / factor, boost::test_tools::tolerance(1e-12));
      BOOST_TEST(after.stiffness_secant * after.lte == loads[load], boost::test_tools::tolerance(1e-12));
      BOOST_TEST(after.stiffness_tangent == before.stiffness_tangent * factor, boost::test_tools::tolerance(1e-12));
      const double other = rippled.at(0, phase, load).lte;
      BOOST_TEST(other == play + (phase == 1 ? elastic / factor : elastic * factor),
                 boost::test_tools::tolerance(1e-12));
    }
}

BOOST_AUTO_TEST_CASE(coarser_keeps_every_second_phase) {
  const auto table = sample(), changed = coarser(table);
  BOOST_TEST(changed.phases() == 2);
  for_each_entry(changed, [&](int position, int phase, int load, const StiffnessEntry& e) {
    BOOST_TEST(e.lte == table.at(position, 2 * phase, load).lte);
  });
  BOOST_CHECK_THROW((void)coarser(coarser(changed)), annulus::InputError);
}

/// One load, one value per phase.
StiffnessTable curve_of(const std::vector<double>& stiffness) {
  std::vector<StiffnessEntry> entries;
  for (const double k : stiffness) entries.push_back({0, 1e3 / k, k, k, 0.01});
  return {"mesh", static_cast<int>(stiffness.size()), {0.0}, {1e3}, entries};
}

BOOST_AUTO_TEST_CASE(the_other_half_of_the_phases_gives_the_ones_between) {
  const auto table = sample(), changed = through_odd_phases(table);
  BOOST_TEST(changed.phases() == table.phases());
  for_each_entry(changed, [&](int position, int phase, int load, const StiffnessEntry& e) {
    // Odd phases stay. Between two knots a curve without overshoot lies between them: the next ones, over all
    // positions.
    const auto value = [&](int steps) {
      const int all = table.positions() * table.phases(), i = (position * table.phases() + phase + steps + all) % all;
      return table.at(i / table.phases(), i % table.phases(), load).stiffness_secant;
    };
    if (phase % 2 == 1) {
      BOOST_TEST(e.stiffness_secant == value(0), boost::test_tools::tolerance(1e-14));
    } else {
      BOOST_TEST(e.stiffness_secant >= std::min(value(-1), value(1)) * (1 - 1e-14));
      BOOST_TEST(e.stiffness_secant <= std::max(value(-1), value(1)) * (1 + 1e-14));
    }
    BOOST_TEST(e.stiffness_secant * (e.lte - e.unloaded_te) == table.loads()[load],
               boost::test_tools::tolerance(1e-12));
  });
  BOOST_CHECK_THROW((void)through_odd_phases(curve_of({1e9, 2e9, 3e9})), annulus::InputError);
}

std::vector<double> stiffnesses(const StiffnessTable& table) {
  std::vector<double> values;
  for (int phase = 0; phase < table.phases(); ++phase) values.push_back(table.at(0, phase, 0).stiffness_secant);
  return values;
}

BOOST_AUTO_TEST_CASE(a_jump_is_made_at_either_end_of_its_interval) {
  const double low = 1e9, high = 1.5e9;
  const auto table = curve_of({low, low, low, high, high, high, high, low});
  /// Beside both ends of the interval and amid it.
  const auto expect = [&](JumpSide side, int phase, double uptake, const std::vector<double>& expected) {
    const auto all = stiffnesses(with_jumps(table, side, uptake));
    const std::size_t parts = all.size() / 8, first = parts * static_cast<std::size_t>(phase);
    const std::vector<double> found = {all[first], all[first + 1], all[first + parts / 2], all[first + parts - 1],
                                       all[(first + parts) % all.size()]};
    BOOST_TEST(found == expected, boost::test_tools::tolerance(1e-12) << boost::test_tools::per_element());
  };
  expect(JumpSide::stiffer, 2, 0, {low, high, high, high, high});
  expect(JumpSide::softer, 2, 0, {low, low, low, low, high});
  expect(JumpSide::stiffer, 6, 0, {high, high, high, high, low});
  expect(JumpSide::softer, 6, 0, {high, low, low, low, low});
  expect(JumpSide::softer, 4, 0, {high, high, high, high, high});
  // At 1000 N a jump takes a quarter of the interval, or all of it.
  const double quarter = 1.0 / 32 / std::sqrt(1e3);
  const auto first = stiffnesses(with_jumps(table, JumpSide::stiffer, quarter));
  BOOST_TEST(first[2 * 128 + 16] == 0.5 * (low + high), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(first[2 * 128 + 32] == high, boost::test_tools::tolerance(1e-12));
  expect(JumpSide::stiffer, 4, 5 * quarter, {high, high, high, high, high});
  BOOST_TEST(largest_jump(table, 5 * quarter) == 0.0);
  BOOST_TEST(largest_jump(table, 0) == (high - low) / (0.5 * (low + high)), boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_jump_in_two_intervals_is_as_large_as_in_one) {
  // A phase amid the jump: half of it on either side.
  const auto table = curve_of({1e9, 1e9, 1.25e9, 1.5e9, 1.5e9, 1.5e9, 1.5e9, 1.25e9});
  BOOST_TEST(largest_jump(table, 0) == 0.25e9 / 1.3125e9, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(smooth_curves_have_no_jumps) {
  const auto jump = [](int phases) {
    std::vector<double> values;
    for (int i = 0; i < phases; ++i) values.push_back(1e9 * (1 + 0.1 * std::cos(2 * std::numbers::pi * i / phases)));
    return largest_jump(curve_of(values), 0);
  };
  // Changes of neighbours differ by h^2 k'' at most.
  for (const int phases : {32, 64, 128}) BOOST_TEST(jump(phases) <= 0.1 * std::pow(2 * std::numbers::pi / phases, 2));
}

BOOST_AUTO_TEST_SUITE_END()
