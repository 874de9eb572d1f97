#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

/// Plain plane geometry of outlines, without anything of gears.
namespace annulus::test {

using Polyline = std::vector<Eigen::Vector2d>;

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

inline Eigen::Vector2d moved(const Eigen::Vector2d& point, const Eigen::Vector2d& centre, double angle) {
  return centre + Eigen::Rotation2Dd(angle) * point;
}

/// Whether a point lies within a closed outline, by the number of crossings.
inline bool inside(const Polyline& outline, const Eigen::Vector2d& p) {
  bool in = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const auto &a = outline[i], &b = outline[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      in = !in;
  }
  return in;
}

inline double distance(const Polyline& closed, const Eigen::Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = closed.size() - 1; i < closed.size(); j = i++) {
    const Eigen::Vector2d along = closed[i] - closed[j];
    const double t =
        along.squaredNorm() > 0 ? std::clamp((p - closed[j]).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    least = std::min(least, (p - closed[j] - t * along).norm());
  }
  return least;
}

/// How two closed outlines lie to each other. Of an internal gear the outline bounds the hole.
struct Fit {
  double overlap = 0;                                    ///< deepest corner of either in the body of the other
  double gap = std::numeric_limits<double>::infinity();  ///< least distance
};

/// `hole`: the second outline is that of a hole in which the first one belongs. Only corners that lie within `reach` of
/// `place` are looked at.
inline Fit fit(const Polyline& a, const Polyline& b, bool hole, const Eigen::Vector2d& place, double reach) {
  Fit result;
  const auto near = [&](const Polyline& all) {
    Polyline some;
    for (const auto& p : all)
      if ((p - place).norm() < reach) some.push_back(p);
    return some;
  };
  const auto look = [&](const Polyline& corners, const Polyline& other, bool wanted_inside) {
    for (const auto& p : near(corners)) {
      const double d = distance(other, p);
      result.gap = std::min(result.gap, d);
      if (inside(other, p) != wanted_inside) result.overlap = std::max(result.overlap, d);
    }
  };
  look(a, b, hole);
  look(b, a, false);  // neither a tooth of the other gear nor the hole's edge lies in the body of the first
  return result;
}

}  // namespace annulus::test
