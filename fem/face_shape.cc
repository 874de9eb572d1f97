#include "fem/face_shape.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

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
  double slope = 0, curvature = 0, gap = 0;
};

/// `stiffness`: N/m; `mean`, `square`: means of z and z^2 with the shares of the places in it; of straight flanks the
/// moment over the force is `moment`.
Reduced reduced(double force, double moment, double stiffness, double mean, double square) {
  // Means of z and z^2 with the weights are slope / 3 and 1/3 + 2/15 curvature.
  const Reduced result{3 * mean, (square - 1.0 / 3) * 7.5,
                       (force * mean - moment) / (stiffness * (square - mean * mean))};
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
  return result;
}

struct ReducedPhase {
  Reduced straight;
  std::optional<Reduced> tilted{};  ///< absent where a tilt leaves too little at an end
  double error = 0;
};

ReducedPhase reduced_at(const FaceLaw& law, double load) {
  const double approach = approach_under(law, load);
  const auto [force, tangent] = load_at(law, approach, 0);
  const double stiffness = tangent(0, 0);
  ReducedPhase result;
  result.straight = reduced(force[0], force[1], stiffness, tangent(0, 1) / stiffness, tangent(1, 1) / stiffness);
  const double tilt = reduced_face_tilt * load / stiffness;
  const Eigen::Vector2d up = load_at(law, approach, tilt).force, down = load_at(law, approach, -tilt).force;
  for (const auto& [exact, side] : {std::pair{&up, 1.0}, {&down, -1.0}}) {
    const auto& r = result.straight;
    const auto found = reduced_load(r.slope, r.curvature, r.gap, load, stiffness, side * tilt);
    result.error = std::max(result.error, (found - *exact).cwiseAbs().maxCoeff() / load);
  }
  const Eigen::Vector2d between = (up - down) / (2 * tilt * stiffness);
  try {
    result.tilted = reduced(force[0], (up[1] + down[1]) / 2, stiffness, between[0], between[1]);
  } catch (const SolverError&) {
    result.tilted.reset();  // it serves error bars alone
  }
  return result;
}

void add(FaceShape& shape, const Reduced& phase) {
  shape.slope.push_back(phase.slope);
  shape.curvature.push_back(phase.curvature);
  shape.gap_slope.push_back(phase.gap);
}

}  // namespace

FaceShape reduced_face(const SolidFace& face, double load, int phases, int threads) {
  std::vector<ReducedPhase> list(static_cast<std::size_t>(phases));
  for_each_task(list.size(), threads,
                [&](std::size_t i) { list[i] = reduced_at(*face.at(static_cast<double>(i) / phases, load), load); });
  FaceShape shape, tilted;
  for (const auto& phase : list) {
    add(shape, phase.straight);
    if (phase.tilted) add(tilted, *phase.tilted);
    shape.error_relative = std::max(shape.error_relative, phase.error);
  }
  if (tilted.slope.size() == shape.slope.size()) shape.tilted = std::make_shared<const FaceShape>(std::move(tilted));
  return shape;
}

}  // namespace annulus::fem
