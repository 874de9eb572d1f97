#include "core/log.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <thread>

BOOST_AUTO_TEST_SUITE(stage_timers)

void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// A sleep lasts at least as long as asked, so the lower bounds hold on a busy machine too.
BOOST_AUTO_TEST_CASE(stages_accumulate_and_the_rest_is_other) {
  annulus::StageTimers timers;
  for (int i = 0; i < 2; ++i) {
    const auto scope = timers.measure("contact");
    sleep_ms(5);
  }
  sleep_ms(5);
  {
    const auto outer = timers.measure("dynamics");
    const auto inner = timers.measure("steps");
    sleep_ms(5);
  }
  const auto rows = timers.report();
  BOOST_REQUIRE(rows.size() == 5U);
  const char* names[] = {"contact", "dynamics", "steps", "other", "total"};
  for (std::size_t i = 0; i < rows.size(); ++i) BOOST_TEST(rows[i].first == names[i]);
  BOOST_TEST(timers.seconds("contact") >= 0.010);
  BOOST_TEST(timers.seconds("steps") >= 0.005);
  BOOST_TEST(timers.seconds("dynamics") >= timers.seconds("steps"));
  BOOST_TEST(timers.seconds("never entered") == 0.0);
  BOOST_TEST(rows[3].second >= 0.005);
  // The nested stage is not counted twice: contact + dynamics + other = total (rounding of sums of seconds).
  BOOST_TEST(std::abs(rows[0].second + rows[1].second + rows[3].second - rows[4].second) < 1e-12);
}

BOOST_AUTO_TEST_CASE(peak_memory_grows_with_what_is_touched) {
  const double before = annulus::peak_memory_MB();
  const std::vector<char> block(300'000'000, 1);  // more than this small program has used before
  BOOST_TEST(block.back() == 1);
  BOOST_TEST(annulus::peak_memory_MB() > 300);
  BOOST_TEST(before < 300);
}

BOOST_AUTO_TEST_SUITE_END()
