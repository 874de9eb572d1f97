#include <boost/test/unit_test.hpp>
#include <cfenv>
#include <thread>

BOOST_AUTO_TEST_SUITE(floating_point_traps)

// A trap that is off would let every test pass.
BOOST_AUTO_TEST_CASE(are_on_in_test_cases_and_their_threads) {
  constexpr int wanted = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
  BOOST_TEST(::fegetexcept() == wanted);
  int in_thread = 0;
  std::thread([&] { in_thread = ::fegetexcept(); }).join();
  BOOST_TEST(in_thread == wanted);
}

BOOST_AUTO_TEST_SUITE_END()
