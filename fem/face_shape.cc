#include "fem/face_shape.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/errors.h"
#include "core/loaded_face.h"
#include "core/parallel.h"

namespace annulus::fem {

namespace {

double legendre(double z) { return (3 * z * z - 1) / 2; }

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
};

ReducedPhase reduced_at(const FaceLaw& law, double load) {
  const double approach = approach_under(law, load);
  const auto here = load_of_straight_flanks(law, approach, 0);
  const auto& force = here.force;
  const auto& tangent = here.tangent;
  const double stiffness = tangent(0, 0);
  ReducedPhase result;
  result.straight = reduced(force[0], force[1], stiffness, tangent(0, 1) / stiffness, tangent(1, 1) / stiffness);
  const double tilt = reduced_face_tilt * load / stiffness;
  const Eigen::Vector2d up = load_of_straight_flanks(law, approach, tilt).force,
                        down = load_of_straight_flanks(law, approach, -tilt).force;
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
  }
  if (tilted.slope.size() == shape.slope.size()) shape.tilted = std::make_shared<const FaceShape>(std::move(tilted));
  return shape;
}

}  // namespace annulus::fem
