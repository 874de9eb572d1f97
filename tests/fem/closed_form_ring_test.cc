#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/closed_form/ring_loads.h"
#include "tests/verification_record.h"

/// Rings as sums of harmonics, against the closed forms of the books.
BOOST_AUTO_TEST_SUITE(closed_form_ring)

using namespace annulus::fem;

const Material unit_material{1.0, 0.3, 1};
const PlaneModuli unit_moduli = plane_strain(unit_material);
constexpr double round_off = 1e-12;

PlainRing ring_of(double height) { return {1 - height / 2, 1 + height / 2, unit_moduli}; }

RingSeries beam_series(const PlainRing& ring, int harmonics) {
  return {[&](int n) { return curved_beam(ring, n); }, harmonics};
}

/// Radial deflection under each of `loads` equal radial unit forces.
double deflection_under_equal_loads(const RingSeries& series, int loads, int harmonics) {
  const auto force = radial_force(Circle::outer, 0, Spread::uniform, harmonics);
  const auto coupling = series.coupling(force, force);
  double sum = 0;
  for (int i = 0; i < loads; ++i) sum += coupling(2 * M_PI * i / loads);
  return sum;
}

// The series ends at harmonic N. Of every `loads`-th term of extension and shear, which fall with n^-2, a part 1/N of a
// term of order one is left out; bending falls with n^-4.
constexpr int most = 20000;

BOOST_AUTO_TEST_CASE(couplings_of_many_loads_at_once) {
  const auto ring = ring_of(0.2);
  const RingSeries series([&](int n) { return elastic_ring(ring, n, HeldCircle::none); }, 1500);
  const auto radial = radial_force(Circle::outer, 0.05, Spread::uniform, 1500),
             tangential = tangential_force(Circle::inner, 0.04, Spread::parabolic, 1300);
  const std::vector<double> angles = {0, 0.1, 1.3, 3.1, 6.2}, sources = {-0.4, 0, 2.2};
  for (const auto* load : {&radial, &tangential})
    for (const auto* source : {&radial, &tangential}) {
      const auto coupling = series.coupling(*load, *source);
      const auto all = coupling(angles, sources);
      BOOST_TEST_REQUIRE(all.rows() == 5);
      BOOST_TEST_REQUIRE(all.cols() == 3);
      const double largest = all.cwiseAbs().maxCoeff();
      for (std::size_t i = 0; i < angles.size(); ++i)
        for (std::size_t j = 0; j < sources.size(); ++j)
          BOOST_TEST(std::abs(all(i, j) - coupling(angles[i] - sources[j])) < round_off * largest);
    }
}

BOOST_AUTO_TEST_CASE(equal_radial_loads_on_a_curved_beam) {
  annulus::test::Verification record(
      "Ring as a curved beam under 2 to 8 equal radial loads",
      "Castigliano at the neutral axis: Timoshenko, Strength of Materials II, art. 80; thin ring: Roark");
  annulus::test::RecordedPlot plot{"Deflection over that of the thin ring", "height over radius", "", {}, true, true};
  for (const int loads : {2, 4, 8}) plot.curves.push_back({std::to_string(loads) + " loads", {}, {}, {}});
  for (const double height : {0.002, 0.02, 0.2, 0.6}) {
    const PlainRing ring = ring_of(height);
    const double log = std::log(ring.outer_radius / ring.inner_radius), R = height / log;
    const double e = static_cast<double>(1 - height / std::log((1 + height / 2.0L) / (1 - height / 2.0L)));
    const RingSeries series = beam_series(ring, most);
    for (const int loads : {2, 3, 4, 5, 8}) {
      // Castigliano with M = R/2 (1/theta - cos phi / sin theta) and N, V = cos phi, sin phi / (2 sin theta) at the
      // neutral axis, where bending and extension do not couple (Timoshenko, Strength of Materials II, art. 80).
      const double theta = M_PI / loads, s = std::sin(theta), c = std::cos(theta);
      const double bending = R * R / (4 * unit_moduli.young * height * e) * ((theta + s * c) / (s * s) - 2 / theta);
      const double extension = (theta + s * c) / (s * s) / (4 * unit_moduli.young * log);
      const double shear = (theta - s * c) / (s * s) / (4 * 5.0 / 6 * unit_moduli.shear * log);
      const double exact = bending + extension + shear, sum = deflection_under_equal_loads(series, loads, most);
      BOOST_TEST_MESSAGE("height " << height << ", " << loads << " loads: " << sum / exact - 1
                                   << ", extension and shear " << (extension + shear) / exact);
      const double left_out =
          static_cast<double>(loads) / most / (M_PI * log) * (1 / unit_moduli.young + 1.2 / unit_moduli.shear);
      record.near("deflection under " + std::to_string(loads) + " loads x E' / P", "", sum, exact,
                  1.01 * left_out + 1e-9 * exact, "harmonics beyond 20 000; 1 / (h e) loses digits");
      const double thin_ring =
          ((theta + s * c) / (s * s) - 2 / theta) / (4 * unit_moduli.young * std::pow(height, 3) / 12);
      for (auto& curve : plot.curves)
        if (curve.label == std::to_string(loads) + " loads") {
          curve.x.push_back(height);
          curve.computed.push_back(sum / thin_ring);
          curve.reference.push_back(exact / thin_ring);
        }
      if (height > 0.002) continue;
      // The inextensional thin ring (Roark; Timoshenko): the rest is of order (h n / R)^2.
      const double thin = ((theta + s * c) / (s * s) - 2 / theta) / (4 * unit_moduli.young * std::pow(height, 3) / 12);
      record.near("over the deflection of the inextensional thin ring, h/R = 0.002", "", sum / thin, 1,
                  4 * std::pow(height * loads, 2), "extension and shear: (n h / R)^2");
      // Two opposite forces: the diameter changes by P R^3 / (E I) (pi / 4 - 2 / pi).
      if (loads == 2)
        BOOST_TEST(std::abs(thin * 2 * unit_moduli.young * std::pow(height, 3) / 12 - (M_PI / 4 - 2 / M_PI)) <
                   round_off);
    }
  }
  record.plot(plot);
}

BOOST_AUTO_TEST_CASE(a_curved_beam_of_large_radius_is_a_straight_one) {
  annulus::test::Verification record("A curved beam of large radius under a sinusoidal load",
                                     "closed form: Timoshenko's straight beam, q/(E I k^4) + q/(kappa G A k^2)");
  // Sinusoidal load q sin(k x) on Timoshenko's straight beam: q / (E I k^4) + q / (kappa G A k^2).
  const double radius = 1e3, height = 0.3, k = 2;
  const int n = static_cast<int>(k * radius);
  const auto compliance = curved_beam({radius - height / 2, radius + height / 2, unit_moduli}, n);
  const double inertia = std::pow(height, 3) / 12;
  const double straight =
      1 / (unit_moduli.young * inertia * std::pow(k, 4)) + 1.2 / (unit_moduli.shear * height * k * k);
  // Loads are per radian: q R. The curvature counts with (1 / k R)^2.
  record.near("deflection over that of the straight beam", "", compliance(0, 0) * radius / straight, 1,
              2 / std::pow(k * radius, 2), "curvature: (1 / k R)^2");
}

BOOST_AUTO_TEST_CASE(a_slender_elastic_ring_is_a_curved_beam) {
  annulus::test::Verification record("A slender ring by plane elasticity", "limit: the curved beam");
  for (const double height : {0.04, 0.02, 0.01})
    for (const int n : {2, 3, 5}) {
      const double ratio =
          elastic_ring(ring_of(height), n, HeldCircle::none)(0, 0) / curved_beam(ring_of(height), n)(0, 0);
      BOOST_TEST_MESSAGE("height " << height << ", harmonic " << n << ": elasticity / beam - 1 = " << ratio - 1);
      // What a beam leaves out is of the order of the shear deflection, (n h / R)^2 / 4.
      record.near("compliance over that of the beam", "", ratio, 1, 0.25 * std::pow(n * height, 2),
                  "order of the shear deflection, (n h / R)^2 / 4");
    }
}

BOOST_AUTO_TEST_CASE(uniform_pressure_and_torsion_of_a_thick_ring) {
  annulus::test::Verification record("Thick ring under pressure and under torsion",
                                     "closed forms of Lame and of pure shear (Timoshenko and Goodier)");
  const double a = 1, b = 1.6, nu = 0.3;
  const PlainRing ring{a, b, unit_moduli};
  const auto free = elastic_ring(ring, 0, HeldCircle::none);
  // Lame, unit pressure inside: load per radian a.
  const auto lame = [&](double r) { return (1 + nu) * a * a / (b * b - a * a) * ((1 - 2 * nu) * r + b * b / r); };
  record.close("displacement inside under pressure x E", "m", free(0, 0) * a, lame(a), round_off, "rounding");
  record.close("displacement outside under pressure x E", "m", free(2, 0) * a, lame(b), round_off, "rounding");
  // Outside held, unit shear inside: u = a^2 / (2 G) (1/a - a/b^2).
  const auto held = elastic_ring(ring, 0, HeldCircle::outer);
  const double twist = a * a / (2 * unit_moduli.shear) * (1 / a - a / (b * b));
  record.close("twist, held outside x E", "m", held(1, 1) * a, twist, round_off, "rounding");
  // Inside held, unit shear outside; and both free under opposite torques, up to a rotation.
  const auto hub = elastic_ring(ring, 0, HeldCircle::inner);
  record.close("twist, held inside x E", "m", hub(3, 3) * b, b * b / (2 * unit_moduli.shear) * (b / (a * a) - 1 / b),
               round_off, "rounding");
  const Eigen::Vector4d opposite(0, 1 / a, 0, -1 / b), motion = free * opposite;
  BOOST_TEST(motion[1] / a - motion[3] / b == held(1, 1) / (a * a), boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(short_waves_see_a_half_plane) {
  annulus::test::Verification record("Short waves on a ring", "half-plane: Johnson, Contact Mechanics, eq. 13.7");
  const PlainRing ring{0.8, 1, unit_moduli};
  const int n = 3000;
  for (const auto held : {HeldCircle::none, HeldCircle::inner}) {
    // p cos(k x) on a half plane: u = 2 p / (E' k) (Johnson, Contact Mechanics, eq. 13.7); along the surface the same.
    const auto compliance = elastic_ring(ring, n, held);
    record.close("normal displacement x E' k / 2 p", "", compliance(2, 2) * n * unit_moduli.young / 2, 1.0, 2.0 / n,
                 "waves of finite length, 1/n");
    record.close("tangential displacement x E' k / 2 p", "", compliance(3, 3) * n * unit_moduli.young / 2, 1.0, 2.0 / n,
                 "waves of finite length, 1/n");
  }
}

BOOST_AUTO_TEST_CASE(compliances_are_symmetric_and_held_circles_do_not_move) {
  annulus::test::Verification record("Compliances of rings, harmonics 0 to 40", "Maxwell and Betti: symmetry");
  const PlainRing ring{0.9, 1, unit_moduli};
  for (int n = 0; n <= 40; ++n) {
    std::vector<HarmonicCompliance> all = {curved_beam(ring, n)};
    for (const auto held : {HeldCircle::none, HeldCircle::inner, HeldCircle::outer})
      all.push_back(elastic_ring(ring, n, held));
    // Solutions in powers of r lose digits where the ring is thin against the wave: (R / h)^4 of them in bending.
    for (const auto& c : all)
      record.at_most("asymmetry over the largest entry", "",
                     (c - c.transpose()).cwiseAbs().maxCoeff() / c.cwiseAbs().maxCoeff(), 1e-10,
                     "powers of r lose (R / h)^4 digits in bending");
    BOOST_TEST((all[2].topRows(2).isZero() && all[3].bottomRows(2).isZero()));
  }
}

BOOST_AUTO_TEST_CASE(loads_have_the_resultants_they_are_named_for) {
  annulus::test::Verification record("Harmonics of loads on an arc",
                                     "their work on unit translations and rotations is their resultant");
  // The first harmonics of a load are its resultants: radial and tangential parts of a unit translation and rotation.
  const double beta = 0.1, radius = 2;
  for (const auto spread : {Spread::uniform, Spread::parabolic}) {
    const auto radial = radial_force(Circle::inner, beta, spread, 1),
               tangential = tangential_force(Circle::inner, beta, spread, 1);
    // u_r = cos, u_theta = -sin does the work pi (f_r - f_theta).
    record.close("resultant of a radial load", "", M_PI * (radial.terms[1][0] - radial.terms[1][1]), 1.0, round_off,
                 "rounding");
    // u_r = sin, u_theta = cos: V = -1.
    record.close("resultant of a tangential load", "", M_PI * (tangential.terms[1][0] - tangential.terms[1][1]), 1.0,
                 round_off, "rounding");
    // Rotation about the axis: u_theta = r, V = -r.
    record.close("moment of a tangential load", "m", -2 * M_PI * radius * tangential.terms[0][1],
                 centroid_radius(radius, beta, spread), round_off, "rounding");
  }
  const auto couple = moment(Circle::inner, radius, beta, 1);
  record.at_most("resultant of a couple", "1/m", std::abs(couple.terms[1][0] - couple.terms[1][1]), round_off,
                 "rounding");
  record.close("moment of a couple", "", -2 * M_PI * radius * couple.terms[0][1], 1.0, 1e-10, "rounding over beta^3");
}

/// Foundation of an external tooth: constants of Sainsot, Velex and Duverger (J. Mech. Des. 126, 2004), table 1:
/// A / theta^2 + B h^2 + C h / theta + D / theta + E h + F, h root radius over bore radius, theta half the tooth angle.
struct SainsotConstant {
  double a, b, c, d, e, f;
  double operator()(double h, double theta) const {
    return a / (theta * theta) + b * h * h + c * h / theta + d / theta + e * h + f;
  }
};

BOOST_AUTO_TEST_CASE(the_foundation_is_that_of_sainsot_velex_and_duverger) {
  annulus::test::Verification record("Foundation of a tooth on a ring",
                                     "Sainsot, Velex and Duverger, J. Mech. Des. 126 (2004), table 1");
  const SainsotConstant l{-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045};
  const SainsotConstant p{-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236};
  const SainsotConstant q{-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904};
  for (const double h : {2.0, 4.0, 7.0})
    for (const double theta : {0.02, 0.05, 0.1}) {
      const int harmonics = static_cast<int>(400 / theta);
      const PlainRing body{1 / h, 1, unit_moduli};
      const RingSeries series([&](int n) { return elastic_ring(body, n, HeldCircle::inner); }, harmonics);
      // They measure displacement and rotation in the middle of the root: work of point loads there.
      const auto bending = moment(Circle::outer, 1, theta, harmonics),
                 slope = moment(Circle::outer, 1, theta / 100, harmonics);
      const auto shear = tangential_force(Circle::outer, theta, Spread::uniform, harmonics);
      const auto shift = tangential_force(Circle::outer, 0, Spread::uniform, harmonics);
      const auto thrust = radial_force(Circle::outer, theta, Spread::uniform, harmonics);
      const auto sink = radial_force(Circle::outer, 0, Spread::uniform, harmonics);
      const double thickness = 2 * theta;
      const double l_ring = series.coupling(slope, bending)(0) * thickness * thickness;
      const double p_ring = series.coupling(shift, shear)(0), pq_ring = series.coupling(sink, thrust)(0);
      BOOST_TEST_MESSAGE("h " << h << ", theta " << theta << ": L* " << l_ring << " against " << l(h, theta) << ", P* "
                              << p_ring << " against " << p(h, theta) << ", P* Q* " << pq_ring << " against "
                              << p(h, theta) * q(h, theta));
      // Their polynomials are fits; they leave the body's rotation out of L*, which counts at large h and theta.
      record.close("L*", "", l_ring, l(h, theta), 0.07, "their fit, which leaves out the rotation of the body");
      record.close("P*", "", p_ring, p(h, theta), 0.03, "their fit");
      record.close("P* Q*", "", pq_ring, p(h, theta) * q(h, theta), 0.05, "their fit");
    }
}

BOOST_AUTO_TEST_CASE(the_work_of_the_root_tractions_gives_the_constants_of_weber_and_banaschek) {
  annulus::test::Verification record("Foundation of a narrow tooth",
                                     "half-plane constants of Weber and Banaschek: 18 (1 - nu^2) / pi, 1.04");
  // Half plane: 18 (1 - nu^2) / pi = 5.2 for the moment, 2 (1 - nu - 2 nu^2) = 1.04 for moment and shear together.
  const double theta = 0.002;
  const int harmonics = static_cast<int>(400 / theta);
  const PlainRing body{0.2, 1, unit_moduli};
  const RingSeries series([&](int n) { return elastic_ring(body, n, HeldCircle::inner); }, harmonics);
  const auto bending = moment(Circle::outer, 1, theta, harmonics);
  const auto shear = tangential_force(Circle::outer, theta, Spread::uniform, harmonics);
  // The curvature of the circle counts with theta times the size of the body.
  record.close("constant of the moment", "", series.coupling(bending, bending)(0) * 4 * theta * theta, 18 * 0.91 / M_PI,
               0.005, "curvature of the circle: theta x size of the body");
  record.close("constant of moment and shear together", "", 2 * series.coupling(bending, shear)(0) * 2 * theta, 1.04,
               0.1, "curvature of the circle: theta x size of the body");
}

BOOST_AUTO_TEST_SUITE_END()
