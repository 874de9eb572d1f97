#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "discretised_body.h"
#include "fem/contact/complementarity.h"
#include "fem/contact/contact_system.h"
#include "fem/contact/hertz.h"
#include "fem/elasticity/trace_basis.h"
#include "structured_mesh.h"
#include "tests/verification_record.h"

/// Two equal elastic cylinders pressed together, against Hertz (Johnson, Contact Mechanics, 4.2).
BOOST_AUTO_TEST_SUITE(hertz)

using annulus::fem::Material;
using annulus::fem::TraceBasis;
using annulus::geometry::Boundary;

constexpr double radius = 0.05, inner_radius = radius / 2, half_angle = M_PI / 3;
constexpr double half_width = radius / 100;  // wanted: Hertz neglects (b / R)^2 = 1e-4
const Material steel{};

/// Line load whose Hertz half-width is `half_width`: E* = E / (2 (1 - nu^2)), relative curvature 2 / R.
double line_load() {
  const double modulus = steel.youngs_modulus / (2 * (1 - steel.poisson_ratio * steel.poisson_ratio));
  return M_PI * modulus * (2 / radius) * half_width * half_width / 4;
}

/// Graded positions 0 ... length: cells of `first` up to `uniform`, then growing by a quarter each.
std::vector<double> graded(double first, double uniform, double length) {
  std::vector<double> x = {0};
  double cell = first;
  while (x.back() < length) {
    if (x.back() > uniform) cell *= 1.25;
    x.push_back(x.back() + cell);
  }
  for (double& v : x) v *= length / x.back();
  return x;
}

struct Result {
  double half_width = 0, peak_pressure = 0, worst_pressure = 0;  ///< last: of any element, by the peak
  std::vector<double> place, pressure;                           ///< by the half-width and the peak of Hertz
};

/// `cells`: cells in a half-width; the pressure elements are as long as the cells.
Result press(int cells, int degree) {
  const double cell = half_width / cells;
  const auto sideways = graded(cell / radius, 1.5 * half_width / radius, half_angle);
  const auto inwards = graded(cell, half_width, radius - inner_radius);
  std::vector<double> angles;
  for (std::size_t i = sideways.size() - 1; i > 0; --i) angles.push_back(-sideways[i]);
  angles.insert(angles.end(), sideways.begin(), sideways.end());
  std::vector<double> radii;
  for (std::size_t i = inwards.size(); i-- > 0;) radii.push_back(radius - inwards[i]);
  const auto mesh = annulus::tests::structured_mesh(
      static_cast<int>(radii.size()) - 1, static_cast<int>(angles.size()) - 1,
      [&](double u, double v) -> Eigen::Vector2d {
        const double r = radii[std::lround(u * static_cast<double>(radii.size() - 1))];
        const double angle = angles[std::lround(v * static_cast<double>(angles.size() - 1))];
        return {r * std::cos(angle), r * std::sin(angle)};
      },
      {Boundary::support, Boundary::tip, Boundary::none, Boundary::none});
  const auto project = [](Boundary boundary, const Eigen::Vector2d& p) -> Eigen::Vector2d {
    if (boundary == Boundary::tip) return p * (radius / p.norm());
    return boundary == Boundary::support ? Eigen::Vector2d(p * (inner_radius / p.norm())) : p;
  };
  const auto body = annulus::tests::discretise_body(mesh, project, steel, degree);

  std::vector<bool> fixed(body.stiffness.rows(), false);
  for (const int n : body.boundary_nodes(Boundary::support)) fixed[body.dof[2 * n]] = fixed[body.dof[2 * n + 1]] = true;
  const annulus::tests::FreeSystem system(body.stiffness, fixed);

  // Surface nodes in order of the angle, loaded along the inward normal.
  auto surface = body.boundary_nodes(Boundary::tip);
  const auto angle_of = [&](int n) { return std::atan2(body.nodes[n].y(), body.nodes[n].x()); };
  std::sort(surface.begin(), surface.end(), [&](int a, int b) { return angle_of(a) < angle_of(b); });
  const auto count = static_cast<Eigen::Index>(surface.size());
  std::vector<double> stations;
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(body.stiffness.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double angle = angle_of(surface[i]);
    stations.push_back(angle);
    loads(body.dof[2 * surface[i]], i) = -std::cos(angle);
    loads(body.dof[2 * surface[i] + 1], i) = -std::sin(angle);
  }
  const Eigen::MatrixXd free_loads = system.restrict_rows(loads);
  const Eigen::MatrixXd compliance =
      free_loads.transpose() * annulus::tests::SparseCholesky(system.matrix).solve(free_loads);

  // Elements of constant pressure over a window of 1.5 half-widths to either side, as long as the cells there.
  const TraceBasis trace(stations, degree);
  const int elements = 3 * cells;
  const double window = 1.5 * half_width / radius;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count, elements);
  annulus::fem::ComplementarityProblem problem;
  problem.gap = Eigen::VectorXd::Zero(elements);
  std::vector<double> centres;
  for (int e = 0; e < elements; ++e) {
    const double low = window * (2.0 * e / elements - 1), high = window * (2.0 * (e + 1) / elements - 1);
    centres.push_back((low + high) / 2 * radius);
    using Rule = boost::math::quadrature::gauss<double, 4>;
    for (std::size_t q = 0; q < Rule::abscissa().size(); ++q)
      for (const double side : {-1.0, 1.0}) {
        const double angle = (low + high) / 2 + side * Rule::abscissa()[q] * (high - low) / 2;
        const double weight = Rule::weights()[q] / 2;
        problem.gap[e] += weight * 2 * radius * (1 - std::cos(angle));  // both circles fall away from the tangent
        const auto values = trace(angle);
        for (std::size_t i = 0; i < values.weights.size(); ++i)
          weights(values.first + static_cast<int>(i), e) += weight * values.weights[i];
      }
  }
  problem.compliance = 2 * weights.transpose() * compliance * weights;  // two equal bodies
  problem.rigid = Eigen::MatrixXd::Ones(elements, 1);
  problem.load = Eigen::VectorXd::Constant(1, line_load());
  problem.unilateral.assign(elements, true);
  const auto solution = solve_complementarity(problem, {});

  Result result;
  const double length = 2 * window * radius / elements;
  double second_moment = 0;
  for (int e = 0; e < elements; ++e) {
    const double pressure = solution.force[e] / length;
    result.peak_pressure = std::max(result.peak_pressure, pressure);
    second_moment += solution.force[e] * (centres[e] * centres[e] + length * length / 12);
  }
  result.half_width = 2 * std::sqrt(second_moment / line_load());  // of a semi-ellipse: F b^2 / 4
  const double peak = 2 * line_load() / (M_PI * half_width);
  const auto integral = [](double t) {  // of sqrt(1 - t^2)
    t = std::clamp(t, -1.0, 1.0);
    return (t * std::sqrt(1 - t * t) + std::asin(t)) / 2;
  };
  for (int e = 0; e < elements; ++e) {
    const double low = (centres[e] - length / 2) / half_width, high = (centres[e] + length / 2) / half_width;
    const double mean = (integral(high) - integral(low)) / (high - low);
    result.worst_pressure = std::max(result.worst_pressure, std::abs(solution.force[e] / length / peak - mean));
    result.place.push_back(centres[e] / half_width);
    result.pressure.push_back(solution.force[e] / length / peak);
  }
  return result;
}

BOOST_AUTO_TEST_CASE(the_half_width_formula_is_that_of_the_textbook) {
  annulus::test::Verification record("Half-width of a line contact", "Johnson, Contact Mechanics, eq. 4.43");
  record.close("half-width", "m", annulus::fem::hertz_half_width(line_load(), 2 / radius, steel), half_width, 1e-14,
               "rounding");
}

void check(annulus::test::Verification& record, int cells, double half_width_tolerance, double pressure_tolerance,
           double worst_tolerance) {
  const Result r = press(cells, 2);
  const double peak = 2 * line_load() / (M_PI * half_width);
  BOOST_TEST_MESSAGE(cells << " cells in b: half-width " << r.half_width / half_width - 1 << ", peak "
                           << r.peak_pressure / peak - 1 << ", worst pressure " << r.worst_pressure);
  const auto mesh = ", " + std::to_string(cells) + " cells in it";
  const char* origin = "discretisation (h / b)^2 / 2, finite size of the body 0.1 %";
  record.close("half-width" + mesh, "m", r.half_width, half_width, half_width_tolerance, origin);
  record.close("peak pressure" + mesh, "Pa", r.peak_pressure, peak, pressure_tolerance, origin);
  record.at_most("pressure of any element, error over the peak" + mesh, "", r.worst_pressure, worst_tolerance,
                 "the element that the contact ends in: order sqrt(h / b)");
  if (cells < 12) return;
  annulus::test::RecordedPlot::Curve curve{"", {}, {}, {}, {}};
  for (std::size_t e = 0; e < r.place.size(); ++e) {
    curve.x.push_back(r.place[e]);
    curve.computed.push_back(r.pressure[e]);
  }
  for (int i = -150; i <= 150; ++i) {
    const double x = i / 100.0;
    curve.reference_x.push_back(x);
    curve.reference.push_back(std::sqrt(std::max(0.0, 1 - x * x)));
  }
  record.plot({"Contact pressure", "place over half-width", "pressure over peak", {curve}});
}

// Errors: the discretisation of pressure and flank, of the order (h / b)^2 / 2, is 1.4 % at six cells in the half-width
// and 0.35 % at twelve; the body is a hundred times larger than the contact, not infinite: 0.1 %. Over an element that
// the contact ends in, a constant pressure is wrong by a part of its mean, which is of order sqrt(h / b).
BOOST_AUTO_TEST_CASE(two_cylinders_touch_as_hertz_says) {
  annulus::test::Verification record("Two equal elastic cylinders pressed together",
                                     "Hertz: Johnson, Contact Mechanics, 4.2");
  check(record, 6, 0.02, 0.01, 0.1 * std::sqrt(1.0 / 6));
  check(record, 12, 0.0045, 0.0045, 0.1 * std::sqrt(1.0 / 12));
}

BOOST_AUTO_TEST_SUITE_END()
