#include "core/table_variants.h"

#include <boost/test/unit_test.hpp>

#include "core/errors.h"

BOOST_AUTO_TEST_SUITE(table_variants)

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

BOOST_AUTO_TEST_CASE(coarser_keeps_every_second_phase) {
  const auto table = sample(), changed = coarser(table);
  BOOST_TEST(changed.phases() == 2);
  for_each_entry(changed, [&](int position, int phase, int load, const StiffnessEntry& e) {
    BOOST_TEST(e.lte == table.at(position, 2 * phase, load).lte);
  });
  BOOST_CHECK_THROW((void)coarser(coarser(changed)), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
