#include "app/scene/scene_value.h"

#include <boost/test/unit_test.hpp>
#include <limits>

namespace annulus {

BOOST_AUTO_TEST_SUITE(scene_value)

BOOST_AUTO_TEST_CASE(numbers_for_people) {
  BOOST_TEST(app::to_text(0.1516) == "0.1516");
  BOOST_TEST(app::to_text(1e9) == "1e9");
  BOOST_TEST(app::to_text(1.364e9) == "1.364e9");
  BOOST_TEST(app::to_text(9.99e9) == "9.99e9");
  BOOST_TEST(app::to_text(1e-6) == "1e-6");
  BOOST_TEST(app::to_text(-2.5e-7) == "-2.5e-7");
  BOOST_TEST(app::to_text(0.0) == "0");
  BOOST_TEST(app::to_text(1128.0) == "1128");
  BOOST_TEST(app::to_text(257.828571428, 8) == "257.82857");
  BOOST_TEST(app::to_text(std::numeric_limits<double>::infinity()) == "inf");
  BOOST_TEST(app::to_text(app::Value(std::vector<double>{15, 36.5})) == "[15, 36.5]");
}

BOOST_AUTO_TEST_CASE(nearest_word) {
  const std::vector<std::string> keys = {"module_mm", "face_width_mm", "power_kW", "pins", "pin_diameter_mm"};
  BOOST_TEST(app::nearest("modul_mm", keys) == "module_mm");
  BOOST_TEST(app::nearest("power", keys) == "power_kW");  // a forgotten unit
  BOOST_TEST(app::nearest("pinz", keys) == "pins");
  BOOST_TEST(app::nearest("fcae_width_mm", keys) == "face_width_mm");  // swapped letters
  BOOST_TEST(app::nearest("completely_else", keys).empty());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
