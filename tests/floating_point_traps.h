// Comes before every test source (annulus_add_tests), so that each test case runs with traps.
#pragma once

#include <cfenv>

#include <boost/test/unit_test.hpp>

// What a test program traps; the application's goes without FE_INVALID: there "not a number" says "not known", and is
// compared and written.
#ifndef ANNULUS_FLOATING_POINT_TRAPS
#define ANNULUS_FLOATING_POINT_TRAPS (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)
#endif

namespace annulus::test {

/// Division by zero, overflow and operations that have no number for a result end the test in which they happen, also
/// in the threads that it starts.
struct FloatingPointTraps {
  FloatingPointTraps() {
    std::feclearexcept(FE_ALL_EXCEPT);
    ::feenableexcept(ANNULUS_FLOATING_POINT_TRAPS);
  }
  ~FloatingPointTraps() { ::fedisableexcept(FE_ALL_EXCEPT); }
  FloatingPointTraps(const FloatingPointTraps&) = delete;
  FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;
};

}  // namespace annulus::test

// The fixture of test cases that name none; Boost.Test turns traps off around test cases and global fixtures alike.
#define BOOST_AUTO_TEST_CASE_FIXTURE ::annulus::test::FloatingPointTraps
