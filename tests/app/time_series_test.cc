#include "app/model/time_series.h"

#include <boost/test/unit_test.hpp>

/// Motions and forces as a file.
BOOST_AUTO_TEST_SUITE(time_series)

using namespace annulus;

dynamics::TimeSeries series_of(int cycles, int samples_per_cycle) {
  const int samples = cycles * samples_per_cycle;
  dynamics::TimeSeries series;
  series.dofs = {"sun_x"};
  series.meshes = {"sun_planet1"};
  series.time = Eigen::VectorXd::LinSpaced(samples, 0, samples - 1);
  series.displacement = series.time.transpose() * 1e-6;
  series.force = series.time.transpose() * 10;
  return series;
}

BOOST_AUTO_TEST_CASE(whole_windows_but_for_long_ones) {
  const auto whole = app::time_series_table(series_of(200, 3), 200);
  BOOST_TEST(whole.rows.size() == 600U);
  BOOST_TEST(whole.header.empty());
  BOOST_TEST((whole.columns == std::vector<std::string>{"time_s", "sun_x_m", "sun_planet1_force_N"}));
  const auto cut = app::time_series_table(series_of(1485, 3), 1485);
  BOOST_TEST(cut.rows.size() == 600U);
  BOOST_TEST(cut.rows.back()[0] == 599.0);
  BOOST_TEST(cut.rows.back()[2] == 5990.0);
  BOOST_TEST(cut.header_value("mesh_cycles").value_or("") == "200 of 1485");
}

BOOST_AUTO_TEST_SUITE_END()
