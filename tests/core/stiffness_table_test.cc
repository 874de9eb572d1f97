#include "core/stiffness_table.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/errors.h"
#include "core/files.h"
#include "core/floating_point.h"
#include "core/units.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(stiffness_table)

using annulus::InputError;
using annulus::StiffnessEntry;
using annulus::StiffnessTable;

/// An entry that keeps the definition of the secant stiffness exactly up to rounding.
StiffnessEntry entry(double load, double secant, double unloaded) {
  annulus::ErrorParts parts;
  parts.discretisation = 0.006, parts.contact = 1e-3 * load / (load + 1e4), parts.condensation = 1e-15;
  parts.model = 0.01 - parts.discretisation - parts.contact - parts.condensation;
  return {unloaded, unloaded + load / secant, secant, 1.1 * secant, 0.01, parts};
}

StiffnessTable sample(int phases, int positions, std::vector<double> loads) {
  std::vector<double> angles;
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < positions; ++i) {
    angles.push_back(2 * std::numbers::pi * i / 162);
    for (int p = 0; p < phases; ++p)
      for (const double load : loads) entries.push_back(entry(load, 1e9 + 1e7 * p + 1e8 * i + load, 1e-6 * p));
  }
  return {"ring_planet", phases, angles, std::move(loads), entries};
}

const auto file = std::filesystem::temp_directory_path() / "annulus_stiffness_table_test.csv";

std::string message_after_editing(const StiffnessTable& table, const std::string& from, const std::string& to) {
  table.write_csv(file);
  auto edited = annulus::read_file(file);
  BOOST_REQUIRE(edited.find(from) != std::string::npos);
  edited.replace(edited.find(from), from.size(), to);
  annulus::write_file(file, edited);
  try {
    (void)StiffnessTable::read_csv(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

BOOST_AUTO_TEST_CASE(round_trip_for_every_shape_of_table) {
  for (const auto& [phases, positions, loads] :
       {std::tuple{1, 1, 1}, {4, 1, 1}, {4, 1, 3}, {3, 5, 2}, {1, 4, 2}, {7, 2, 1}}) {
    std::vector<double> forces;
    for (int i = 0; i < loads; ++i) forces.push_back(1e4 * (i + 1) / 3);
    auto table = sample(phases, positions, forces);
    table.provenance = {{"annulus_version", "0"}, {"model", "plane"}};
    table.write_csv(file);
    const auto read = StiffnessTable::read_csv(file);
    BOOST_TEST(read.mesh() == table.mesh());
    BOOST_TEST((read.provenance == table.provenance));
    BOOST_REQUIRE(read.phases() == phases);
    BOOST_REQUIRE(read.positions() == positions);
    BOOST_TEST((read.loads() == table.loads()));
    for (int i = 0; i < positions; ++i) {
      // Radians to degrees and back: one rounding each.
      BOOST_TEST(std::abs(read.ring_angles()[i] - table.ring_angles()[i]) <= 4e-16 * table.ring_angles()[i]);
      for (int p = 0; p < phases; ++p)
        for (int l = 0; l < loads; ++l) {
          BOOST_TEST(read.at(i, p, l).lte == table.at(i, p, l).lte);
          BOOST_TEST(read.at(i, p, l).unloaded_te == table.at(i, p, l).unloaded_te);
          BOOST_TEST(read.at(i, p, l).stiffness_secant == table.at(i, p, l).stiffness_secant);
          BOOST_TEST(read.at(i, p, l).stiffness_tangent == table.at(i, p, l).stiffness_tangent);
          BOOST_TEST(read.at(i, p, l).error_relative == table.at(i, p, l).error_relative);
          for (const auto& [name, part] : annulus::stiffness_error_part_names)
            BOOST_TEST((read.at(i, p, l).error_parts.*part) == (table.at(i, p, l).error_parts.*part), name);
        }
    }
  }
  std::filesystem::remove(file);
}

BOOST_AUTO_TEST_CASE(a_table_from_elsewhere_may_go_without_the_parts_of_its_error) {
  annulus::write_file(
      file,
      "# mesh: sun_planet\nmesh_phase,ring_angle_deg,load_N,unloaded_te_m,lte_m,stiffness_secant_N_per_m,"
      "stiffness_tangent_N_per_m,error_relative\n0,0,1000,0,1e-6,1e9,1e9,0.02\n");
  const auto table = StiffnessTable::read_csv(file);
  BOOST_TEST(table.at(0, 0, 0).error_relative == 0.02);
  BOOST_TEST(table.at(0, 0, 0).error_parts.total() == 0);
  BOOST_TEST(message_after_editing(sample(4, 1, {1e4}), "0.006", "-0.006").find("error_discretisation_relative") !=
             std::string::npos);
  std::filesystem::remove(file);
}

BOOST_AUTO_TEST_CASE(a_damaged_file_is_refused_with_its_line) {
  const auto table = sample(2, 2, {1000, 2000});  // line 1 mesh, 2 rows, 3 columns, rows from line 4 on
  const auto starts = [](const std::string& message, int line) {
    return message.starts_with(file.string() + ":" + std::to_string(line) + ":");
  };
  BOOST_TEST(starts(message_after_editing(table, "\n0.5,0,1000", "\n0.4,0,1000"), 6));  // phase off the grid
  BOOST_TEST(starts(message_after_editing(table, "\n0.5,0,2000", "\n0.5,0,2500"), 7));  // load off the grid
  BOOST_TEST(starts(message_after_editing(table, "\n0,0,2000", "\n0,0,900"), 5));       // loads fall
  BOOST_TEST(starts(message_after_editing(table, ",1000,0,", ",1000,0.1,"), 4));        // secant contradicts lte
  BOOST_TEST(starts(message_after_editing(table, "lte_m", "lte_um"), 3));               // a column is missing
  BOOST_TEST(starts(message_after_editing(table, "# mesh", "# gear"), 1));
  BOOST_TEST(starts(message_after_editing(table, "\n0.5,0,2000", "\n0.5,nan,2000"), 11));  // block broken: last row
  const auto nameless = message_after_editing(table, "ring_planet", "");
  BOOST_TEST(nameless.find("its mesh has no name") != std::string::npos);
  std::filesystem::remove(file);
}

BOOST_AUTO_TEST_CASE(unusable_values_are_refused) {
  const annulus::UntrappedFloatingPoint untrapped;  // values that are no numbers
  const auto make = [](std::vector<double> loads, StiffnessEntry e, int phases = 1) {
    std::vector<StiffnessEntry> entries(loads.size(), e);
    return StiffnessTable("sun_planet", phases, {0}, std::move(loads), std::move(entries));
  };
  const auto good = entry(1000, 1e9, 0);
  BOOST_CHECK_NO_THROW(make({1000}, good));
  BOOST_CHECK_THROW(make({1000}, good, 2), InputError);     // too few entries
  BOOST_CHECK_THROW(make({1000, 1000}, good), InputError);  // not increasing
  BOOST_CHECK_THROW(make({0}, good), InputError);           // secant undefined without load
  BOOST_CHECK_THROW(make({2000}, good), InputError);        // secant x deflection is not the load
  auto bad = good;
  bad.stiffness_tangent = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW(make({1000}, bad), InputError);
  bad = entry(1000, -1e9, 0);
  BOOST_CHECK_THROW(make({1000}, bad), InputError);
  bad = good;
  bad.error_relative = -0.1;
  BOOST_CHECK_THROW(make({1000}, bad), InputError);
  BOOST_CHECK_THROW((void)make({1000}, good).at(0, 1, 0), annulus::InternalError);
}

BOOST_AUTO_TEST_CASE(curves_are_linear_in_load_and_refuse_to_extrapolate) {
  const annulus::UntrappedFloatingPoint untrapped;  // values that are no numbers
  const auto table = sample(4, 3, {1000, 2000, 4000});
  for (const double load : {1000.0, 1700.0, 2000.0, 3500.0, 4000.0}) {
    const auto curves = annulus::curves_at_load(table, load);
    BOOST_TEST(curves.stiffness_secant.period() == 3.0);
    for (int i = 0; i < 3; ++i)
      for (int p = 0; p < 4; ++p) {
        // The sample is linear in load; tolerance: rounding of values of 1e9.
        const double expected = 1e9 + 1e7 * p + 1e8 * i + load;
        BOOST_TEST(std::abs(curves.stiffness_secant(i + p / 4.0) - expected) <= 1e-6);
        BOOST_TEST(std::abs(curves.stiffness_tangent(i + p / 4.0) - 1.1 * expected) <= 1e-6);
        BOOST_TEST(std::abs(curves.unloaded_te(i + p / 4.0) - 1e-6 * p) <= 1e-20);
      }
  }
  const auto at_node = annulus::curves_at_load(table, 2000);
  BOOST_TEST(std::abs(at_node.lte(1.25) - table.at(1, 1, 1).lte) <= 1e-20);
  BOOST_CHECK_THROW(annulus::curves_at_load(table, 999), InputError);
  BOOST_CHECK_THROW(annulus::curves_at_load(table, 4001), InputError);
  BOOST_CHECK_THROW(annulus::curves_at_load(table, std::numeric_limits<double>::quiet_NaN()), InputError);
  BOOST_CHECK_THROW(annulus::curves_at_load(sample(4, 1, {1000}), 1001), InputError);
  BOOST_CHECK_NO_THROW(annulus::curves_at_load(sample(4, 1, {1000}), 1000 * (1 + 1e-12)));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(periodic_curve)

using annulus::PeriodicCurve;

std::vector<double> sampled(const auto& f, int values, double period) {
  std::vector<double> y;
  for (int i = 0; i < values; ++i) y.push_back(f(period * i / values));
  return y;
}

const auto uneven = std::vector<double>{3, -1, 4, 1, -5, 9, 2, -6, 5, 3, 5, 8};  // 3 mesh cycles of 4 values

BOOST_AUTO_TEST_CASE(passes_through_its_values_with_its_period) {
  annulus::test::Verification record("Interpolation of a periodic curve (makima)", "its values; its period");
  const PeriodicCurve curve(uneven, 4);
  BOOST_TEST(curve.period() == 3.0);
  for (int i = 0; i < 12; ++i) record.near("value at a knot", "", curve(i / 4.0), uneven[i], 1e-14, "rounding");
  for (const double x : {0.0, 0.1, 0.99, 1.6, 2.9999})
    for (const int turns : {-1000, -1, 1, 7, 100000}) {
      // Reducing an argument of 3e5 loses 3e5 eps = 7e-11 of phase; slopes here reach 60 per cycle.
      record.near("value up to 100 000 periods away", "", curve(x + 3.0 * turns), curve(x), 1e-8,
                  "rounding of the argument x slope");
      BOOST_TEST(std::abs(curve.derivative(x + 3.0 * turns) - curve.derivative(x)) <= 1e-6);
    }
}

BOOST_AUTO_TEST_CASE(value_and_slope_are_continuous_over_knots_and_seam) {
  annulus::test::Verification record("Continuity of curves through tables",
                                     "Lipschitz bounds of the curve and of its slope; central differences");
  const PeriodicCurve curve(uneven, 4);
  for (int i = -12; i <= 24; ++i) {
    const double knot = i / 4.0, h = 1e-9;
    // Lipschitz bounds of this curve: slope below 100, curvature below 4000 per cycle squared.
    record.at_most("slope across a knot", "1/cycle", std::abs(curve(knot + h) - curve(knot - h)) / (2 * h), 100,
                   "slope of this curve");
    record.at_most("curvature across a knot", "1/cycle^2",
                   std::abs(curve.derivative(knot + h) - curve.derivative(knot - h)) / (2 * h), 4000,
                   "curvature of this curve");
  }
  // Within pieces the derivative is that of the value: central differences of a cubic err by h^2 |f'''| / 6.
  for (double x = 0.013; x < 3; x += 0.0371) {
    if (std::abs(x * 4 - std::round(x * 4)) < 1e-3) continue;
    const double h = 1e-5;
    record.at_most("derivative against central differences", "1/cycle",
                   std::abs((curve(x + h) - curve(x - h)) / (2 * h) - curve.derivative(x)), 1e-5, "h^2 f''' / 6");
  }
}

BOOST_AUTO_TEST_CASE(constants_are_exact_for_any_number_of_values) {
  annulus::test::Verification record("Interpolation of 1 to 16 equal values", "the constant");
  for (const int n : {1, 2, 3, 4, 5, 16}) {
    const PeriodicCurve curve(std::vector<double>(n, 1.87e9), n);
    for (const double x : {-7.3, 0.0, 0.2, 0.5, 0.999999, 41.7}) {
      record.near("value", "", curve(x), 1.87e9, 0, "exact");
      record.near("derivative", "", curve.derivative(x), 0, 0, "exact");
    }
    record.near("mean", "", curve.mean(), 1.87e9, 0, "exact");
  }
  record.near("value of a curve without values", "", PeriodicCurve()(0.3), 0, 0, "exact");
}

BOOST_AUTO_TEST_CASE(does_not_ring_beside_a_plateau) {
  // A stiffness that steps between one and two tooth pairs: Akima's reason to weight slopes.
  const PeriodicCurve curve({1, 1, 1, 1, 2, 2, 2, 2}, 8);
  annulus::test::Verification record("Interpolation of a curve that steps between two plateaus", "the plateaus");
  for (double x = 0; x < 0.375; x += 0.003) record.near("value on the lower plateau", "", curve(x), 1, 0, "exact");
  for (double x = 0.5; x < 0.875; x += 0.003) record.near("value on the upper plateau", "", curve(x), 2, 0, "exact");
}

BOOST_AUTO_TEST_CASE(mean_is_the_integral) {
  const PeriodicCurve curve(uneven, 4);
  double integral = 0;
  // Two-point Gauss integrates each cubic piece exactly.
  for (int i = 0; i < 12; ++i)
    for (const double g : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) integral += curve((i + 0.5 + g / 2) / 4) / 8;
  annulus::test::Verification record("Mean of an interpolated curve", "Gauss quadrature, exact for cubics");
  record.near("mean", "", curve.mean(), integral / 3, 1e-13, "rounding");
}

BOOST_AUTO_TEST_CASE(converges_on_a_smooth_curve) {
  const auto f = [](double x) { return std::exp(std::sin(2 * std::numbers::pi * (x + 0.07))); };
  annulus::test::Verification record("Interpolation of a smooth periodic curve", "exp(sin x)");
  std::vector<double> max, mean;
  for (const int n : {64, 128, 256}) {
    const PeriodicCurve curve(sampled(f, n, 1), n);
    max.push_back(0);
    mean.push_back(0);
    for (int i = 0; i < 20000; ++i) {
      const double error = std::abs(curve(i / 20000.0) - f(i / 20000.0));
      max.back() = std::max(max.back(), error);
      mean.back() += error / 20000;
    }
  }
  // The maximum is second order (at extrema). Its constant depends on where the extremum lies between two knots, so
  // two refinements are taken together: at least 0.9 of order 2 over both.
  record.at_least("order of the largest error, over two refinements", "", std::log2(max[0] / max[2]) / 2, 1.8,
                  "0.9 of the order 2 (at extrema)");
  record.at_most("largest error, 256 values", "", max[2], 1e-4, "ceiling beside the rate");
  // The mean is h^3 log(1/h): the second-order error fades like h^3 / distance from the extremum. At h = 1/256 that is
  // a local order of 3 - 1/log(1/h) = 2.8, of which 0.9.
  record.at_least("order of the mean error", "", std::log2(mean[1] / mean[2]), 2.5, "0.9 of 3 - 1/log(1/h) = 2.8");
  record.at_most("mean error, 256 values", "", mean[2], 3e-6, "ceiling beside the rate");
  const std::vector<double> sizes{1.0 / 64, 1.0 / 128, 1.0 / 256};
  record.convergence("Error of interpolation; dashed: orders 2 and 2.8", "distance of the values", "error", "largest",
                     sizes, max, 2);
  record.convergence("Error of interpolation; dashed: orders 2 and 2.8", "distance of the values", "error", "mean",
                     sizes, mean, 2.8);
}

BOOST_AUTO_TEST_CASE(unusable_values_are_refused) {
  BOOST_CHECK_THROW(PeriodicCurve({}, 1), annulus::InputError);
  BOOST_CHECK_THROW(PeriodicCurve({1, 2, 3}, 2), annulus::InputError);
  BOOST_CHECK_THROW(PeriodicCurve({1, NAN}, 2), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
