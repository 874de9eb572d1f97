#include "fem/closed_form/ring_harmonics.h"

#include <Eigen/LU>
#include <cmath>

namespace annulus::fem {
namespace {

/// Four independent solutions of one harmonic: displacements and outward loads (per radian) on both circles.
struct Solutions {
  Eigen::Matrix4d displacement, load;
};

Solutions michell_solutions(const PlainRing& ring, int harmonic) {
  const double n = harmonic, k = ring.moduli.dilatation, mu = ring.moduli.shear;
  Solutions s;
  // u_r = A x^p cos, u_theta = B x^p sin with x = r / reference: dilatation P x^p / r, load per radian r times stress.
  const auto power = [&](int column, double p, double a, double b, double reference) {
    const double dilatation = (p + 1) * a + n * b;
    const double radial = mu * ((k - 2) * dilatation + 2 * p * a), tangential = mu * (-n * a + (p - 1) * b);
    for (const int circle : {0, 1}) {
      const double r = circle == 0 ? ring.inner_radius : ring.outer_radius, outward = circle == 0 ? -1 : 1;
      const double x = std::pow(r / reference, p);
      s.displacement.block<2, 1>(2 * circle, column) << a * x, b * x;
      s.load.block<2, 1>(2 * circle, column) << outward * radial * x, outward * tangential * x;
    }
  };
  const double inner = ring.inner_radius, outer = ring.outer_radius;
  power(0, n + 1, n + 2 - k * n, k * (n + 2) - n, outer);
  power(1, -n - 1, 1, 1, inner);
  power(2, n - 1, 1, -1, outer);
  if (harmonic != 1) {
    power(3, 1 - n, 2 - n + k * n, -n - k * (2 - n), inner);
    return s;
  }
  // The fourth power coincides with the rigid translation: u_r = ln x + c, u_theta = -ln x.
  const double c = (1 - k) / (1 + k);
  for (const int circle : {0, 1}) {
    const double x = std::log((circle == 0 ? inner : outer) / outer), outward = circle == 0 ? -1 : 1;
    s.displacement.block<2, 1>(2 * circle, 3) << x + c, -x;
    s.load.block<2, 1>(2 * circle, 3) << outward * mu * ((k - 2) * (1 + c) + 2), -outward * mu * (1 + c);
  }
  return s;
}

/// Makes the rigid motion in `column` cost something and the other solutions independent of it.
void restrain(Solutions& s, int column, double stiffness) {
  const Eigen::Vector4d rigid = s.displacement.col(column).normalized();
  for (int i = 0; i < 4; ++i)
    if (i != column) s.displacement.col(i) -= rigid * rigid.dot(s.displacement.col(i));
  s.displacement.col(column) = rigid;
  s.load.col(column) = stiffness * rigid;
}

/// Uniform radial and uniform tangential loads.
Solutions uniform_solutions(const PlainRing& ring) {
  const double a = ring.inner_radius, b = ring.outer_radius, mu = ring.moduli.shear, k = ring.moduli.dilatation;
  Solutions s;
  s.displacement.setZero();
  s.load.setZero();
  // u_r = r, 1/r; u_theta = r (rigid), 1/r; columns and rows as the circles have them.
  s.displacement.col(0) << a, 0, b, 0;
  s.load.col(0) << -2 * mu * (k - 1) * a, 0, 2 * mu * (k - 1) * b, 0;
  s.displacement.col(1) << 1 / a, 0, 1 / b, 0;
  s.load.col(1) << 2 * mu / a, 0, -2 * mu / b, 0;
  s.displacement.col(2) << 0, a, 0, b;
  s.displacement.col(3) << 0, 1 / a, 0, 1 / b;
  s.load.col(3) << 0, 2 * mu / a, 0, -2 * mu / b;
  return s;
}

}  // namespace

HarmonicCompliance elastic_ring(const PlainRing& ring, int harmonic, HeldCircle held) {
  Solutions s = harmonic == 0 ? uniform_solutions(ring) : michell_solutions(ring, harmonic);
  if (held == HeldCircle::none) {
    if (harmonic <= 1) restrain(s, 2, ring.moduli.shear);
    return s.displacement * s.load.inverse();
  }
  const int held_row = held == HeldCircle::inner ? 0 : 2;
  Eigen::Matrix4d conditions = s.load;
  conditions.middleRows<2>(held_row) = s.displacement.middleRows<2>(held_row);
  HarmonicCompliance compliance = s.displacement * conditions.inverse();
  compliance.middleRows<2>(held_row).setZero();
  compliance.middleCols<2>(held_row).setZero();
  return compliance;
}

HarmonicCompliance curved_beam(const PlainRing& ring, int harmonic) {
  const double n = harmonic, a = ring.inner_radius, b = ring.outer_radius;
  // ln(b/a) = 2 atanh(x), e = (a + b)/2 (atanh(x) - x) / atanh(x); the difference as its series, which does not cancel.
  const double height = b - a, x = height / (a + b), log = 2 * std::atanh(x), neutral = height / log;
  double difference = 0, power = x * x * x;
  for (int k = 3; power > 1e-20 * x * x * x && k < 400; k += 2, power *= x * x) difference += power / k;
  const double offset = (a + b) / 2 * difference / std::atanh(x);
  constexpr double shear_factor = 5.0 / 6;
  const double extension = ring.moduli.young * log, bending = ring.moduli.young * height * offset;
  const double shear = shear_factor * ring.moduli.shear * log;
  const Eigen::Vector3d strain(1, n, 0), curvature(0, 0, n), sliding(-n, -1, neutral);  // of (u, w, psi)
  Eigen::Matrix3d stiffness = extension * strain * strain.transpose() + bending * curvature * curvature.transpose() +
                              shear * sliding * sliding.transpose();
  if (harmonic == 0) {  // a turn about the axis is rigid
    const Eigen::Vector3d turn = Eigen::Vector3d(0, neutral, 1).normalized();
    stiffness += shear * turn * turn.transpose() * neutral * neutral;
  }
  if (harmonic == 1) {
    const Eigen::Vector3d shift = Eigen::Vector3d(1, -1, 0).normalized();
    stiffness += shear * shift * shift.transpose();
  }
  Eigen::Matrix<double, 4, 3> to_circles;
  to_circles << 1, 0, 0, 0, 1, a - neutral, 1, 0, 0, 0, 1, b - neutral;
  return to_circles * stiffness.inverse() * to_circles.transpose();
}

}  // namespace annulus::fem
