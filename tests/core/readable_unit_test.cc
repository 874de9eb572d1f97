#include "core/readable_unit.h"

#include <boost/test/unit_test.hpp>

#include "core/not_known.h"

namespace annulus {

BOOST_AUTO_TEST_SUITE(readable_units)

BOOST_AUTO_TEST_CASE(the_largest_value_is_between_one_and_a_thousand) {
  const ShownUnit stiffness{"N/µm", 1e-6}, length{"µm", 1e6};
  for (const auto& [declared, largest, unit, shown] :
       std::vector<std::tuple<ShownUnit, double, std::string, double>>{{stiffness, 2.3322e9, "kN/µm", 2.3322},
                                                                       {stiffness, 1.38e8, "N/µm", 138},
                                                                       {stiffness, 999.9e6, "N/µm", 999.9},
                                                                       {stiffness, 1e9, "kN/µm", 1},
                                                                       {length, 6.925e-10, "pm", 692.5},
                                                                       {length, 2.165e-7, "nm", 216.5},
                                                                       {length, 1e-6, "µm", 1},
                                                                       {length, 0.012, "mm", 12},
                                                                       {{"Hz", 1}, 3689.1, "kHz", 3.6891}}) {
    const auto found = readable_unit(declared, {0.3 * largest, -largest, 0, not_known});
    BOOST_TEST(found.unit == unit);
    BOOST_TEST(found.scale * largest == shown, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(beyond_the_units_in_use_it_is_the_nearest) {
  BOOST_TEST(readable_unit({"µm", 1e6}, {3e4}).unit == "m");
  BOOST_TEST(readable_unit({"µm", 1e6}, {3e-16}).unit == "pm");
}

BOOST_AUTO_TEST_CASE(a_unit_without_multiples_stays) {
  BOOST_TEST(readable_unit({"%", 100}, {2e-6}).unit == "%");
  BOOST_TEST(readable_unit({"", 1}, {2e6}).unit.empty());
  BOOST_TEST(readable_unit({"µm", 1e6}, {0, not_known}).unit == "µm");
  BOOST_TEST(readable_unit({"µm", 1e6}, {}).scale == 1e6);
}

BOOST_AUTO_TEST_CASE(all_multiples_of_a_unit_are_the_same_quantity) {
  // A value keeps its size in whatever unit it was declared.
  for (const auto& unit : {ShownUnit{"pm", 1e12}, {"nm", 1e9}, {"mm", 1e3}, {"m", 1}})
    BOOST_TEST(readable_unit(unit, {5e-6}).unit == "µm");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
