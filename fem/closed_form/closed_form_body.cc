#include "fem/closed_form/closed_form_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Harmonics for a load on an arc: beyond n the terms fall with (n beta)^-2 / n, what is left out is some
/// 1 / (2 (n beta)^2) of a term of order one.
constexpr double waves_per_arc = 60;

int harmonics_for(double half_angle) { return static_cast<int>(std::ceil(waves_per_arc / half_angle)); }

using RootLoads = std::array<RingHarmonics, 3>;

RootLoads root_loads(Circle circle, double radius, double half_angle, int harmonics) {
  return {radial_force(circle, half_angle, Spread::uniform, harmonics),
          tangential_force(circle, half_angle, Spread::uniform, harmonics),
          moment(circle, radius, half_angle, harmonics)};
}

/// Adds to `result[offset + neighbours]` the coupling of roots so many teeth apart.
void add_between_roots(std::vector<Eigen::Matrix3d>& result, const RingSeries& ring, const RootLoads& loads,
                       double pitch_angle, const Eigen::Matrix3d& left, const Eigen::Matrix3d& right) {
  const int neighbours = static_cast<int>(result.size()) / 2;
  std::array<std::array<HarmonicCoupling, 3>, 3> couplings;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) couplings[i][j] = ring.coupling(loads[i], loads[j]);
  for (int offset = -neighbours; offset <= neighbours; ++offset) {
    Eigen::Matrix3d between;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) between(i, j) = couplings[i][j](offset * pitch_angle);
    result[offset + neighbours] += left * between * right;
  }
}

}  // namespace

ClosedFormBody::ClosedFormBody(const geometry::ToothProfile& profile, double support_radius, double width,
                               const Material& material, const std::vector<RingSupport>& supports,
                               const RimModel& model, int neighbours)
    : tooth_(profile, plane_strain(material)),
      pitch_angle_(profile.gear().pitch_angle()),
      teeth_(profile.gear().teeth()) {
  const bool external = profile.gear().kind() == geometry::GearKind::external, floats = !supports.empty();
  require(!(external && floats), "supports belong to a ring");
  const double root_radius = tooth_.root_radius(), beta = tooth_.root_half_angle();
  const int terms = harmonics_for(beta);
  const PlaneModuli moduli = plane_strain(material);
  const PlainRing body{external ? support_radius : root_radius, external ? root_radius : support_radius, moduli};
  const HeldCircle held = external ? HeldCircle::inner : HeldCircle::outer;
  const RootLoads roots = root_loads(external ? Circle::outer : Circle::inner, root_radius, beta, terms);
  const RingSeries foundation([&](int n) { return elastic_ring(body, n, held); }, terms);
  root_.assign(2 * neighbours + 1, Eigen::Matrix3d::Zero());
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  add_between_roots(root_, foundation, roots, pitch_angle_, identity / width, identity);
  foundation_ = root_[neighbours];
  if (floats)
    let_yield({root_radius - model.tooth_band * pitch_angle_ * root_radius, support_radius, moduli}, width,
              model.theory, supports, terms);
}

void ClosedFormBody::let_yield(const PlainRing& rim, double width, RimTheory theory,
                               const std::vector<RingSupport>& supports, int terms) {
  const RingSeries ring(
      [&](int n) -> HarmonicCompliance {
        if (theory == RimTheory::curved_beam) return curved_beam(rim, n);
        return elastic_ring(rim, n, HeldCircle::none);
      },
      terms);
  const double beta = tooth_.root_half_angle();
  const RootLoads roots = root_loads(Circle::inner, rim.inner_radius, beta, terms);
  Eigen::Matrix3d to_rim = Eigen::Matrix3d::Identity();  // root loads about the centroid of the arc on the rim
  to_rim(2, 1) = centroid_radius(tooth_.root_radius(), beta, Spread::uniform) -
                 centroid_radius(rim.inner_radius, beta, Spread::uniform);
  add_between_roots(root_, ring, roots, pitch_angle_, to_rim.transpose() / width, to_rim);
  if (theory == RimTheory::elastic_ring) {
    const RingSeries held([&](int n) { return elastic_ring(rim, n, HeldCircle::outer); }, terms);
    add_between_roots(root_, held, roots, pitch_angle_, -to_rim.transpose() / width, to_rim);
  }

  // Supports of one width of arc share their couplings: (radially outwards, counter-clockwise) on each.
  std::vector<std::pair<double, Spread>> arcs;
  std::vector<std::size_t> arc_of;
  for (const auto& support : supports) {
    const std::pair arc(support.half_angle, support.spread);
    const auto known = std::find(arcs.begin(), arcs.end(), arc);
    arc_of.push_back(known - arcs.begin());
    if (known == arcs.end()) arcs.push_back(arc);
  }
  using Pair = std::array<RingHarmonics, 2>;
  std::vector<Pair> loads;
  for (const auto& [half_angle, spread] : arcs) {
    const int support_terms = std::min(terms, harmonics_for(half_angle) / 2);
    loads.push_back({radial_force(Circle::outer, half_angle, spread, support_terms),
                     tangential_force(Circle::outer, half_angle, spread, support_terms)});
  }
  const auto component = [](const RingSupport& s, int c) { return c == 0 ? -s.inwards : s.tangential; };
  const auto count = static_cast<Eigen::Index>(supports.size());
  support_compliance_ = Eigen::MatrixXd::Zero(count, count);
  support_resultants_ = Eigen::MatrixXd::Zero(count, 3);
  from_supports_.assign(teeth_, Eigen::MatrixXd::Zero(3, count));
  // Those of one arc that act in one direction.
  struct Group {
    std::size_t arc;
    int direction;
    std::vector<Eigen::Index> members;
    std::vector<double> angles;
  };
  std::vector<Group> groups;
  for (std::size_t arc = 0; arc < arcs.size(); ++arc)
    for (const int direction : {0, 1}) {
      Group group{arc, direction, {}, {}};
      for (Eigen::Index i = 0; i < count; ++i) {
        if (arc_of[i] != arc || component(supports[i], direction) == 0) continue;
        group.members.push_back(i);
        group.angles.push_back(supports[i].angle);
      }
      if (!group.members.empty()) groups.push_back(std::move(group));
    }
  std::vector<double> tooth_angles;
  tooth_angles.reserve(static_cast<std::size_t>(teeth_));
  for (int tooth = 0; tooth < teeth_; ++tooth) tooth_angles.push_back(tooth * pitch_angle_);
  for (const Group& source : groups) {
    const RingHarmonics& source_load = loads[source.arc][source.direction];
    const auto force = [&](std::size_t j) { return component(supports[source.members[j]], source.direction) / width; };
    for (const Group& target : groups) {
      const auto coupled =
          ring.coupling(loads[target.arc][target.direction], source_load)(target.angles, source.angles);
      for (std::size_t j = 0; j < source.members.size(); ++j)
        for (std::size_t i = 0; i < target.members.size(); ++i)
          if (target.members[i] <= source.members[j])
            support_compliance_(target.members[i], source.members[j]) +=
                force(j) * component(supports[target.members[i]], target.direction) * coupled(i, j);
    }
    for (int i = 0; i < 3; ++i) {
      const auto to_root = ring.coupling(roots[i], source_load)(tooth_angles, source.angles);
      for (std::size_t j = 0; j < source.members.size(); ++j)
        for (int tooth = 0; tooth < teeth_; ++tooth)
          from_supports_[tooth](i, source.members[j]) += force(j) * to_root(tooth, j);
    }
  }
  support_compliance_.triangularView<Eigen::StrictlyLower>() = support_compliance_.transpose();
  for (Eigen::Index j = 0; j < count; ++j) {
    const RingSupport& support = supports[j];
    support_compliance_(j, j) += 1 / support.stiffness;
    const Eigen::Vector2d force =
        Eigen::Rotation2Dd(support.angle) * Eigen::Vector2d(-support.inwards, support.tangential);
    support_resultants_.row(j) << force.x(), force.y(),
        support.tangential * centroid_radius(rim.outer_radius, support.half_angle, support.spread);
  }
  for (auto& coupling : from_supports_) coupling = (to_rim.transpose() * coupling).eval();
}

Eigen::Matrix3d ClosedFormBody::root_compliance(int offset) const {
  const int neighbours = static_cast<int>(root_.size()) / 2;
  require(std::abs(offset) <= neighbours, "the coupling of teeth ", offset, " apart has not been prepared, only up to ",
          neighbours);
  return root_[offset + neighbours];
}

Eigen::MatrixXd ClosedFormBody::root_from_supports(int tooth) const {
  return from_supports_[((tooth % teeth_) + teeth_) % teeth_];
}

Eigen::Matrix3d ClosedFormBody::root_resultants(int tooth) const {
  const Eigen::Rotation2Dd turn(tooth * pitch_angle_);
  Eigen::Matrix3d resultants = Eigen::Matrix3d::Zero();
  resultants.block<1, 2>(0, 0) = (turn * Eigen::Vector2d(1, 0)).transpose();
  resultants.block<1, 2>(1, 0) = (turn * Eigen::Vector2d(0, 1)).transpose();
  resultants(1, 2) = centroid_radius(tooth_.root_radius(), tooth_.root_half_angle(), Spread::uniform);
  resultants(2, 2) = 1;
  return resultants;
}

}  // namespace annulus::fem
