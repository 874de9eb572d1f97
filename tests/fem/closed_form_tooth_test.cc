#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "fem/closed_form/closed_form_mesh.h"
#include "fem/closed_form/line_contact.h"
#include "fem/contact/complementarity.h"
#include "fem/contact/contact_system.h"
#include "fem/contact/hertz.h"
#include "ring_paper.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(closed_form_tooth)

using namespace annulus::fem;

const Material unit_material{1.0, 0.3, 1};
constexpr double round_off = 1e-13;

BOOST_AUTO_TEST_CASE(a_tooth_of_constant_section_is_timoshenkos_cantilever) {
  annulus::test::Verification record("A tooth of constant section",
                                     "Timoshenko's cantilever: L^3/(3 E I) + 1.2 L/(G A), compression L/(E A)");
  const PlaneModuli m = plane_strain(unit_material);
  const double height = 0.3, length = 2, inertia = std::pow(height, 3) / 12;
  const Eigen::Vector2d force(-0.6, 0.8);
  const double exact = 0.64 * (std::pow(length, 3) / (3 * m.young * inertia) + 1.2 * length / (m.shear * height)) +
                       0.36 * length / (m.young * height);
  // The load inside the outline and at its end; an internal tooth points the other way.
  for (const double end : {2.0, 2.7})
    for (const double sense : {1.0, -1.0}) {
      std::vector<std::pair<double, double>> outline;
      for (int i = 0; i <= 7; ++i) outline.emplace_back(5 + sense * end * i / 7, height / 2);
      record.close("compliance x E", "", cantilever_compliance(outline, 5 + sense * length, force, m), exact, round_off,
                   "rounding");
      BOOST_TEST(cantilever_compliance(outline, 5 - sense, force, m) == 0.0);  // below the root: no beam
    }
}

BOOST_AUTO_TEST_CASE(a_wedge_bends_as_integrated_by_hand) {
  annulus::test::Verification record("A tooth that is a wedge", "bending and shear integrated by hand");
  const PlaneModuli m = plane_strain(unit_material);
  // Half-thickness 0.3 - 0.1 x over 0 ... 2, transverse force at the end: with t = 0.6 - 0.2 x,
  // int 12 (2 - x)^2 / t^3 dx = 12 * 125 [ln t + 0.4 / t - 0.02 / t^2] from 0.2 to 0.6, as 2 - x = 5 (t - 0.2).
  const auto f = [](double t) { return std::log(t) + 0.4 / t - 0.02 / (t * t); };
  const double bending = 12 * 125 * (f(0.6) - f(0.2)) / m.young, shear = 1.2 * 5 * std::log(3.0) / m.shear;
  std::vector<std::pair<double, double>> outline;
  for (int i = 0; i <= 20; ++i) outline.emplace_back(0.1 * i, 0.3 - 0.01 * i);
  record.close("compliance x E", "", cantilever_compliance(outline, 2, {0, 1}, m), bending + shear, 1e-12, "rounding");
}

BOOST_AUTO_TEST_CASE(every_force_passes_the_root_with_the_lever_arm_of_the_base_circle) {
  for (const bool internal : {false, true}) {
    const auto pair = annulus::tests::ring_paper_pair(internal);
    const annulus::geometry::ToothProfile profile(pair.wheel());
    const ToothCantilever tooth(profile, plane_strain(Material{}));
    const double centroid = centroid_radius(tooth.root_radius(), tooth.root_half_angle(), Spread::uniform);
    const double tip = profile.roll_length_tip(), form = profile.roll_length_form();
    double last = 0;
    for (int i = 0; i <= 10; ++i) {
      const auto load = tooth.load(form + (tip - form) * i / 10);
      BOOST_TEST(load.root.head<2>().norm() == 1.0, boost::test_tools::tolerance(1e-13));
      BOOST_TEST(std::abs(load.root.z() + load.root.y() * centroid) == pair.wheel().base_radius(),
                 boost::test_tools::tolerance(1e-12));
      BOOST_TEST(load.depth > 0);
      BOOST_TEST(load.compliance >= last);  // softer towards the tip, external and internal
      last = load.compliance;
    }
  }
}

/// Flanks that go on far beyond the contact.
FlankGap wide_gap(double slope, double curvature) { return {slope, curvature, -10, 10, {}}; }

BOOST_AUTO_TEST_CASE(line_contact_is_that_of_hertz_and_johnson) {
  annulus::test::Verification record("Line contact of two flanks",
                                     "Hertz; approach: Johnson, Contact Mechanics, eq. 5.57, each body");
  const double width = 2, curvature = 0.5, depth = 3;
  const LineContact contact(wide_gap(0, curvature), {depth}, {2 * depth}, 0, unit_material, width);
  for (const double force : {1e-9, 1e-6, 1e-3}) {
    const double line_load = force / width, b = hertz_half_width(line_load, curvature, unit_material);
    const auto state = contact.at(force);
    record.close("half-width", "m", state.half_width, b, round_off, "rounding");
    record.close("peak pressure x pi b / 2", "N/m", contact.peak_pressure(state, force) * M_PI * b / 2, line_load,
                 round_off, "rounding");
    // Far below the contact: Johnson, Contact Mechanics, eq. 5.57, each body.
    const double nu = 0.3;
    const double johnson = (1 - nu * nu) / M_PI * line_load *
                           (2 * std::log(2 * depth / b) + 2 * std::log(4 * depth / b) - 2 * nu / (1 - nu));
    record.close("approach", "m", state.approach, johnson, b * b / depth / depth,
                 "far below the contact: (b / depth)^2");
    const double step = 1e-4 * force;
    const double slope = (contact.at(force + step).approach - contact.at(force - step).approach) / (2 * step);
    BOOST_TEST(state.compliance == slope, boost::test_tools::tolerance(1e-7));  // step^2 and 1e-16 / step
  }
}

BOOST_AUTO_TEST_CASE(patches_of_parabola_wedge_and_edge) {
  annulus::test::Verification record(
      "Contact of a parabola, a wedge and an edge",
      "Johnson, Contact Mechanics, eq. 4.43 and 5.43; singular integral of a cut parabola");
  const double modulus = 3, curvature = 0.5, slope = 0.02;
  const double tolerance = 1e-12;
  for (const double a : {0.01, 0.3}) {
    // Johnson, Contact Mechanics, eq. 4.43, and where a tilted parabola touches.
    const auto hertz = ContactPatch(wide_gap(slope, curvature), 0, modulus).at(a);
    record.close("parabola: line load", "N/m", hertz.line_load, M_PI * modulus * curvature * a * a / 4, tolerance,
                 "rounding");
    record.close("tilted parabola: middle", "m", hertz.middle, -slope / curvature, tolerance, "rounding");
    // A wedge, eq. 5.43: slopes of +-0.02 and hardly any curvature.
    FlankGap wedge = wide_gap(-slope, 1e-9);
    wedge.kinks[0] = {0.0, 2 * slope};
    record.close("wedge: line load", "N/m", ContactPatch(wedge, 0, modulus).at(a).line_load, modulus * slope * a, 1e-7,
                 "a curvature of 1e-9 is left");
    // The end of the gap presses: p = E*/2 sqrt((2a - x)/x) (slope + curvature (x + a)), x from the end.
    FlankGap cut = wide_gap(slope, curvature);
    for (const double side : {1.0, -1.0}) {
      (side > 0 ? cut.low : cut.high) = 0;
      cut.slope = side * slope;
      const ContactPatch patch(cut, 0, modulus);
      const double load = M_PI * modulus / 2 * a * (slope + curvature * 1.5 * a);
      record.close("edge: line load", "N/m", patch.at(a).line_load, load, tolerance, "rounding");
      record.close("edge: half-width", "m", patch.half_width(load), a, tolerance, "rounding");
      BOOST_TEST(patch.at(a).middle == side * a);
      BOOST_TEST(patch.at(a).cut == -side);
      cut = wide_gap(slope, curvature);
    }
  }
}

/// Approach of the same gap by boundary elements: constant pressures on a half plane, unilateral. Its constant is that
/// of a contact whose displacement is -2 ln|x| / (pi E*) under unit line load.
double boundary_element_approach(const FlankGap& gap, double tilt, double modulus, double line_load, double from,
                                 double to) {
  constexpr int count = 400;
  const double half = (to - from) / count / 2;
  const auto place = [&](int i) { return from + (2 * i + 1) * half; };
  ComplementarityProblem problem;
  problem.compliance.resize(count, count);
  problem.rigid = Eigen::MatrixXd::Ones(count, 1);
  problem.load = Eigen::VectorXd::Constant(1, line_load);
  problem.gap.resize(count);
  problem.unilateral.assign(count, true);
  const auto primitive = [](double x) { return x == 0 ? 0.0 : x * std::log(std::abs(x)) - x; };
  for (int i = 0; i < count; ++i) {
    const double x = place(i);
    problem.gap[i] = gap.slope * x + gap.curvature * x * x / 2;
    for (const auto& kink : gap.kinks) problem.gap[i] += kink.jump * std::max(0.0, x - kink.place);
    for (int j = 0; j < count; ++j)
      problem.compliance(i, j) =
          -2 / (M_PI * modulus) * (primitive(x - place(j) + half) - primitive(x - place(j) - half)) / (2 * half) +
          tilt * (x + place(j));
  }
  std::vector<bool> start;
  return solve_complementarity(problem, start).rigid[0];
}

BOOST_AUTO_TEST_CASE(cut_kinked_and_tilting_patches_agree_with_boundary_elements) {
  annulus::test::Verification record("Contacts cut by a tip edge, kinked by relief, on tilting flanks",
                                     "boundary elements: 400 constant pressures on a half-plane, unilateral");
  const double nu = unit_material.poisson_ratio, modulus = 1 / (2 * (1 - nu * nu)), depth = 100, curvature = 0.5;
  struct Setting {
    double slope, low, high, kink, jump, tilt;
  };
  // Free at the edge's side, cut at once, cut as it grows, a kink; tilting flanks move the patch, also off an edge.
  for (const auto& s : {Setting{0, -1, 1, 0, 0, 0.5},
                        {0.02, 0, 1, 0, 0, 0},
                        {0, -0.05, 1, 0, 0, 0},
                        {-0.01, -1, 1, 0, 0.03, 0},
                        {0, -0.05, 1, 0.1, 0.02, -0.5},
                        {0.02, 0, 1, 0, 0, -1}}) {
    FlankGap gap{s.slope, curvature, s.low, s.high, {}};
    gap.kinks[1] = {s.kink, s.jump};
    const LineContact contact(gap, {depth}, {depth}, s.tilt, unit_material, 1);
    for (const double line_load : {2e-3, 1e-2}) {
      const auto state = contact.at(line_load);
      const double from = std::max(s.low, state.middle - 1.3 * state.half_width);
      const double to = std::min(s.high, state.middle + 1.3 * state.half_width);
      const double elements = boundary_element_approach(gap, s.tilt, modulus, line_load, from, to);
      const double constant = line_load / (M_PI * modulus) * (2 * std::log(depth) - nu / (1 - nu) - 1);
      const double local = state.approach - constant;
      BOOST_TEST_MESSAGE("slope " << s.slope << ", low " << s.low << ", jump " << s.jump << ", tilt " << s.tilt
                                  << ": half-width " << state.half_width << ", middle " << state.middle << ", approach "
                                  << local << ", elements " << local / elements - 1);
      record.close("local approach x E", "m", local, elements, 2e-3, "singular ends: first order, 400 elements");
      const double step = 1e-4 * line_load;
      const double slope = (contact.at(line_load + step).approach - contact.at(line_load - step).approach) / (2 * step);
      BOOST_TEST(state.compliance == slope, boost::test_tools::tolerance(1e-5));  // kinks under the quadrature
    }
  }
}

BOOST_AUTO_TEST_CASE(a_corner_softens_the_contact_near_it) {
  const double force = 1e-3, depth = 3;
  const auto approach = [&](double edge, double corner) {
    FlankGap gap = wide_gap(0, 0.5);
    gap.high = edge;
    return LineContact(gap, {depth, edge, corner}, {depth}, 0, unit_material, 1).at(force);
  };
  const double b = approach(10, M_PI).half_width;
  // Far away nothing; a half plane has no corner; sharper is softer, and so is nearer.
  BOOST_TEST(approach(9, M_PI / 2).approach == approach(9, M_PI).approach, boost::test_tools::tolerance(1e-3));
  double last = 0;
  for (const double edge : {9.0, 3 * b, 0.9 * b, 0.3 * b, 0.0}) {
    const auto obtuse = approach(edge, 2), square = approach(edge, M_PI / 2);
    BOOST_TEST(obtuse.approach > approach(edge, M_PI).approach);
    BOOST_TEST(square.approach > obtuse.approach);
    BOOST_TEST(square.approach > last);
    BOOST_TEST(square.at_tip_edge == (edge < b));
    last = square.approach;
  }
}

BOOST_AUTO_TEST_SUITE_END()
