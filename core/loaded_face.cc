#include "core/loaded_face.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/errors.h"

namespace annulus {

FaceLoad load_of_straight_flanks(const FaceLaw& law, double approach, double tilt) {
  const auto& stations = law.stations();
  const auto count = static_cast<Eigen::Index>(stations.size());
  Eigen::MatrixXd shapes(count, 2);
  for (Eigen::Index i = 0; i < count; ++i)
    shapes.row(i) << 1, 2 * stations[static_cast<std::size_t>(i)] / law.face_width();
  Eigen::VectorXd at = Eigen::VectorXd::Zero(law.size());
  at.head(count) = shapes * Eigen::Vector2d(approach, tilt);
  const auto state = law.at(at);
  return {shapes.transpose() * state.force.head(count),
          shapes.transpose() * state.tangent.topLeftCorner(count, count) * shapes, state.energy,
          law.line_load(at, state)};
}

double approach_under(const FaceLaw& law, double force) {
  constexpr int most = 50;
  constexpr double accuracy = 1e-8;
  const auto count = static_cast<Eigen::Index>(law.stations().size());
  double approach = force / law.in_contact().topLeftCorner(count, count).sum();
  double low = 0;
  for (int i = 0; i < most; ++i) {
    const auto here = load_of_straight_flanks(law, approach, 0);
    const double rest = force - here.force[0];
    if (std::abs(rest) <= accuracy * force) return approach;
    if (rest > 0) low = std::max(low, approach);
    const double tangent = here.tangent(0, 0);
    approach = tangent > 0 ? std::max(approach + rest / tangent, (low + approach) / 2) : 2 * approach;
  }
  throw SolverError(fmt::format("no approach of two faces found for the force {:g} N", force));
}

double FlanksUnderLoad::tilt_stiffness() const {
  const auto& k = load.tangent;
  return k(1, 1) - k(0, 1) * k(0, 1) / k(0, 0);
}

FlanksUnderLoad flanks_under(const FaceLaw& law, double force, double place) {
  constexpr int most = 60;
  constexpr double accuracy = 1e-8;
  const Eigen::Vector2d wanted(force, force * 2 * place / law.face_width());
  Eigen::Vector2d at(approach_under(law, force), 0);
  auto load = load_of_straight_flanks(law, at[0], at[1]);
  // The potential of the flanks is convex: its smallest value is the only equilibrium.
  const auto potential = [&](const Eigen::Vector2d& x, const FaceLoad& l) { return l.energy - wanted.dot(x); };
  for (int i = 0; i < most; ++i) {
    const Eigen::Vector2d rest = wanted - load.force;
    if (rest.cwiseAbs().maxCoeff() <= accuracy * force) return {at[0], at[1], load};
    // Where one end alone touches, the face turns about it almost freely.
    constexpr double least = 1e-6;
    const Eigen::Matrix2d tangent = load.tangent + least * load.tangent.trace() * Eigen::Matrix2d::Identity();
    if (!(tangent.determinant() > 0)) break;
    const Eigen::Vector2d step = tangent.inverse() * rest;
    constexpr double sufficient = 1e-4, shortest = 1e-4;
    std::optional<FaceLoad> next;
    for (double length = 1; length > shortest && !next; length /= 2) {
      const Eigen::Vector2d x = at + length * step;
      auto there = load_of_straight_flanks(law, x[0], x[1]);
      const bool lower = potential(x, there) <= potential(at, load) - sufficient * length * rest.dot(step);
      const bool closer = (wanted - there.force).norm() < (1 - sufficient) * rest.norm();
      if (!(lower || closer) || !there.force.any()) continue;
      at = x;
      next = std::move(there);
    }
    if (!next) break;
    load = std::move(*next);
  }
  throw SolverError(
      fmt::format("no straight flanks found that carry {:g} N at {:g} m from the middle of a face {:g} m "
                  "wide",
                  force, place, law.face_width()));
}

}  // namespace annulus
