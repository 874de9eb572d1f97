#include "dynamics/spatial/stage_bearing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/spatial/elastic_laws.h"

namespace annulus::dynamics {

using Eigen::Vector3d;

bool StageLoad::stands_in_housing() const {
  return frame == StageFrame::housing && (force.head<2>().any() || moment.head<2>().any() || point.head<2>().any());
}

namespace {

std::optional<RollingRow> mirrored(std::optional<RollingRow> row) {
  if (row) row->contact_angle = -row->contact_angle;
  return row;
}

/// A bearing and its mirror image about the middle of the face do the same.
bool mirrors(const StageBearing& a, const StageBearing& b) {
  return a.body == b.body && a.on == b.on && a.place == -b.place && a.beside == b.beside && a.x == b.x && a.y == b.y &&
         a.play == b.play && a.load_zone == b.load_zone && a.row == mirrored(b.row) && a.distance == b.distance &&
         a.force == b.force && !a.matrix && !b.matrix;
}

}  // namespace

bool keeps_plane(const Eigen::MatrixXd& k) {
  constexpr double rounding = 1e-12;
  for (Eigen::Index in = 0; in < k.rows(); ++in)
    for (Eigen::Index out = 0; out < k.cols(); ++out)
      if (in % 5 < 2 && out % 5 >= 2 && std::abs(k(in, out)) > rounding * std::sqrt(k(in, in) * k(out, out)))
        return false;
  return true;
}

void add_reasons(std::vector<std::string>& reasons, const std::vector<StageLoad>& loads,
                 const std::vector<StageWeight>& weights, const Vector3d& gravity) {
  for (const auto& load : loads) {
    const bool transverse = load.force.head<2>().any();
    if (load.force.z() != 0 || load.moment.head<2>().any() || (transverse && load.point.z() != 0))
      reasons.push_back(
          fmt::format("load '{}' acts along the axis or tilts the {}", load.name, name_of_body(load.body)));
  }
  if (gravity.z() != 0 && !weights.empty()) reasons.emplace_back("gravity acts along the axis");
  if (gravity.head<2>().any())
    for (const auto& weight : weights)
      if (weight.place != 0)
        reasons.push_back(
            fmt::format("the weight of the {} acts beside the middle of the face", name_of_body(weight.body)));
}

void add_reasons(std::vector<std::string>& reasons, const std::vector<StageBearing>& bearings) {
  for (const auto& b : bearings) {
    const bool paired =
        b.matrix ? b.place == 0 && keeps_plane(*b.matrix)
                 : std::any_of(bearings.begin(), bearings.end(), [&](const auto& o) { return mirrors(b, o); });
    const bool radial = b.holds_radially();
    if (radial && !paired)
      reasons.push_back(fmt::format("bearing '{}' of the {} has no counterpart on the other side of the face", b.name,
                                    name_of_body(b.body)));
  }
}

StageFrame StageBearing::frame() const {
  using Kind = StageBody::Kind;
  if (body.kind == Kind::planet || body.kind == Kind::pin) return StageFrame::planet;
  return on.kind == Kind::carrier ? StageFrame::carrier : StageFrame::housing;
}

std::vector<BearingPart> parts_of(const StageBearing& b, Motions motions) {
  const bool space = motions == Motions::in_space;
  std::vector<BearingPart> parts;
  const auto linear = [&](std::vector<int> coordinates, const Eigen::MatrixXd& stiffness) {
    parts.push_back({std::move(coordinates), std::make_shared<LinearLaw>(stiffness)});
  };
  const auto single = [&](int coordinate, double stiffness, double play) {
    if (stiffness == 0 || stiffness == rigid) return;
    if (play > 0)
      parts.push_back({{coordinate}, std::make_shared<StopLaw>(1, stiffness, play), true});
    else
      linear({coordinate}, Eigen::MatrixXd::Constant(1, 1, stiffness));
  };
  if (b.matrix) {
    const Eigen::Index size = space ? 5 : 2;
    linear(space ? std::vector{0, 1, 2, 3, 4} : std::vector{0, 1}, b.matrix->topLeftCorner(size, size));
    return parts;
  }
  if (b.row) {
    const auto row = law_of(*b.row, motions);
    parts.push_back({row->coordinates(), row, true, row});
  } else if (!b.distance.empty()) {
    parts.push_back({{0, 1}, std::make_shared<TableLaw>(b.distance, b.force), true});
  } else if (b.play > 0 && b.x > 0) {
    std::shared_ptr<const ElasticLaw> law;
    if (b.load_zone)
      law = std::make_shared<LoadZoneLaw>(RadialBearing(b.x, b.play, b.seat), b.x);
    else
      law = std::make_shared<StopLaw>(2, b.x, b.play);
    parts.push_back({{0, 1}, std::move(law), true});
  } else {
    single(0, b.x, 0);
    single(1, b.y, 0);
  }
  if (!space) return parts;
  constexpr int axial = 2;
  const auto holds = [&](const auto& part) {
    return std::count(part.coordinates.begin(), part.coordinates.end(), axial) > 0;
  };
  if (std::none_of(parts.begin(), parts.end(), holds)) single(axial, b.axial, b.axial_play);
  if (b.row) return parts;
  if (b.tilt_play > 0 && b.tilt > 0) {
    parts.push_back({{3, 4}, std::make_shared<StopLaw>(2, b.tilt, b.tilt_play), true});
  } else {
    single(3, b.tilt, 0);
    single(4, b.tilt, 0);
  }
  return parts;
}

bool is_nonlinear(const StageBearing& bearing) {
  const auto parts = parts_of(bearing, Motions::in_space);
  return std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.nonlinear; });
}

}  // namespace annulus::dynamics
