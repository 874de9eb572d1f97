#include "fem/face_shape.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/errors.h"
#include "core/parallel.h"

namespace annulus::fem {

namespace {

/// Force and moment (over half the face width) of a face and their derivatives.
struct FaceLoad {
  Eigen::Vector2d force;
  Eigen::Matrix2d tangent;
};

/// `approach`: m, in the middle; `tilt`: m, by which the end approaches further.
FaceLoad load_at(const FaceLaw& law, double approach, double tilt) {
  const auto& stations = law.stations();
  const auto count = static_cast<Eigen::Index>(stations.size());
  Eigen::MatrixXd shapes(count, 2);
  for (Eigen::Index i = 0; i < count; ++i)
    shapes.row(i) << 1, 2 * stations[static_cast<std::size_t>(i)] / law.face_width();
  Eigen::VectorXd at = Eigen::VectorXd::Zero(law.size());
  at.head(count) = shapes * Eigen::Vector2d(approach, tilt);
  const auto state = law.at(at);
  return {shapes.transpose() * state.force.head(count),
          shapes.transpose() * state.tangent.topLeftCorner(count, count) * shapes};
}

/// The approach of straight flanks under a force.
double approach_under(const FaceLaw& law, double force) {
  constexpr int most = 50;
  constexpr double accuracy = 1e-8;
  const auto count = static_cast<Eigen::Index>(law.stations().size());
  double approach = force / law.in_contact().topLeftCorner(count, count).sum();
  double low = 0;
  for (int i = 0; i < most; ++i) {
    const auto here = load_at(law, approach, 0);
    const double rest = force - here.force[0];
    if (std::abs(rest) <= accuracy * force) return approach;
    if (rest > 0) low = std::max(low, approach);
    const double tangent = here.tangent(0, 0);
    approach = tangent > 0 ? std::max(approach + rest / tangent, (low + approach) / 2) : 2 * approach;
  }
  throw SolverError(fmt::format("no approach of two faces found for the force {:g} N", force));
}

double legendre(double z) { return (3 * z * z - 1) / 2; }

/// The reduced face under the same motion: its law is straight about the load.
Eigen::Vector2d reduced_load(double slope, double curvature, double gap, double force, double tangent, double tilt) {
  constexpr int places = 400;
  // The approach in the middle is that of straight flanks.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const double shift = slope / 3 * gap;
  for (int i = 0; i < places; ++i) {
    const double z = (2 * i + 1.0) / places - 1;
    const double weight = (1 + slope * z + curvature * legendre(z)) / places;
    const double pressing = std::max(0.0, force + tangent * (shift + (tilt - gap) * z));
    sum += weight * pressing * Eigen::Vector2d(1, z);
  }
  return sum;
}

struct Reduced {
  double slope = 0, curvature = 0, gap = 0, error = 0;
};

Reduced reduced_at(const FaceLaw& law, double load) {
  const double approach = approach_under(law, load);
  const auto [force, tangent] = load_at(law, approach, 0);
  // Means of z and z^2 with the weights are slope / 3 and 1/3 + 2/15 curvature.
  const double mean = tangent(0, 1) / tangent(0, 0), square = tangent(1, 1) / tangent(0, 0);
  Reduced result;
  result.slope = 3 * mean;
  result.curvature = (square - 1.0 / 3) * 7.5;
  result.gap = (force[0] * mean - force[1]) / (tangent(0, 0) * (square - mean * mean));
  for (const double z : {-1.0, 1.0, -result.slope / (3 * result.curvature)}) {
    if (!(std::abs(z) <= 1)) continue;
    const double weight = 1 + result.slope * z + result.curvature * legendre(z);
    constexpr double least = 0.05;  // between the phases it may be less
    if (!(weight > least))
      throw SolverError(
          fmt::format("a mesh whose stiffness is {:.2g} of the mean at z = {:.2g} of half the face width "
                      "cannot be reduced to its force and moment",
                      weight, z));
  }
  constexpr double share = 0.5;
  for (const double side : {-1.0, 1.0}) {
    const double tilt = side * share * load / tangent(0, 0);
    const auto exact = load_at(law, approach, tilt).force;
    const auto found = reduced_load(result.slope, result.curvature, result.gap, load, tangent(0, 0), tilt);
    result.error = std::max(result.error, (found - exact).cwiseAbs().maxCoeff() / load);
  }
  return result;
}

}  // namespace

FaceShape reduced_face(const SolidFace& face, double load, int phases, int threads) {
  std::vector<Reduced> list(static_cast<std::size_t>(phases));
  for_each_task(list.size(), threads,
                [&](std::size_t i) { list[i] = reduced_at(*face.at(static_cast<double>(i) / phases, load), load); });
  FaceShape shape;
  for (const auto& r : list) {
    shape.slope.push_back(r.slope);
    shape.curvature.push_back(r.curvature);
    shape.gap_slope.push_back(r.gap);
    shape.error_relative = std::max(shape.error_relative, r.error);
  }
  return shape;
}

}  // namespace annulus::fem
