#include "core/text_columns.h"

#include <boost/test/unit_test.hpp>

namespace annulus {

BOOST_AUTO_TEST_SUITE(text_columns)

BOOST_AUTO_TEST_CASE(characters_are_counted_and_not_bytes) {
  BOOST_TEST(characters("kN/µm") == 5U);
  BOOST_TEST(characters("kg m²") == 5U);
  BOOST_TEST(characters("–") == 1U);
  BOOST_TEST(characters("") == 0U);
}

BOOST_AUTO_TEST_CASE(columns_line_up) {
  BOOST_TEST(left_aligned("µm", 4) == "µm  ");
  BOOST_TEST(right_aligned("µm", 4) == "  µm");
  // A text that is too long stays whole, and apart from what follows.
  BOOST_TEST(left_aligned("kN/µm", 3) == "kN/µm ");
  BOOST_TEST(right_aligned("kN/µm", 3) == "kN/µm");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
