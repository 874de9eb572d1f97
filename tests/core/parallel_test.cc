#include "core/parallel.h"

#include <atomic>
#include <boost/test/unit_test.hpp>
#include <stdexcept>
#include <string>
#include <vector>

BOOST_AUTO_TEST_SUITE(parallel)

BOOST_AUTO_TEST_CASE(every_task_is_called_once) {
  for (const int threads : {0, 1, 3, 200}) {
    std::vector<std::atomic<int>> calls(100);
    annulus::for_each_task(calls.size(), threads, [&](std::size_t task) { ++calls[task]; });
    for (const auto& called : calls) BOOST_TEST(called == 1);
  }
  annulus::for_each_task(0, 4, [](std::size_t) { throw std::logic_error("there is no task"); });
}

BOOST_AUTO_TEST_CASE(the_failure_of_the_first_task_is_thrown_whatever_the_number_of_threads) {
  for (const int threads : {1, 2, 8})
    for (int repetition = 0; repetition < 50; ++repetition) {
      std::atomic<int> started{0};
      std::string failure;
      try {
        annulus::for_each_task(1000, threads, [&](std::size_t task) {
          ++started;
          if (task >= 5) throw std::runtime_error(std::to_string(task));
        });
      } catch (const std::runtime_error& error) {
        failure = error.what();
      }
      BOOST_TEST(failure == "5");
      BOOST_TEST(started <= 5 + 2 * threads);  // at most those under way
    }
}

BOOST_AUTO_TEST_SUITE_END()
