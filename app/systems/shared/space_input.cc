#include "app/systems/shared/space_input.h"

#include <algorithm>
#include <cmath>

namespace annulus::app {

namespace {

using Body = dynamics::StageBody::Kind;

Eigen::Vector3d vector_of(const std::vector<double>& list) {
  return list.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(list[0], list[1], list[2]);
}

}  // namespace

dynamics::RollingRow rolling_row(const BearingInput& input) {
  using Row = dynamics::RollingRow;
  Row row;
  row.element = input.balls ? Row::Element::ball : Row::Element::roller;
  row.count = input.balls ? *input.balls : *input.rollers;
  row.diameter = input.balls ? *input.ball_diameter : *input.roller_diameter;
  row.length = input.roller_length.value_or(0);
  row.pitch_diameter = input.pitch_diameter.value_or(0);
  row.contact_angle = input.contact_angle;
  row.clearance = input.clearance;
  row.inner_groove = input.inner_groove;
  row.outer_groove = input.outer_groove;
  row.ring = input.ring.value_or(input.body == Body::planet ? Row::Ring::outer : Row::Ring::inner);
  return row;
}

dynamics::StageBearing stage_bearing(const BearingInput& input, const dynamics::StageBody& body, std::string name) {
  dynamics::StageBearing b;
  const bool planet = body.kind == Body::planet;
  b.name = std::move(name);
  b.body = body;
  b.on = {input.on.value_or(planet ? Body::carrier : Body::housing)};
  b.place = input.place;
  if (!input.beside.empty()) b.beside = {input.beside[0], input.beside[1]};
  b.x = input.along_x();
  b.y = input.along_y();
  b.axial = input.axial;
  b.tilt = input.tilt;
  b.play = input.clearance / 2;
  b.load_zone = input.load_zone;
  b.axial_play = input.axial_clearance / 2;
  b.tilt_play = input.tilt_clearance / 2;
  b.distance = input.displacement;
  b.force = input.force;
  if (input.rolls()) {
    b.row = rolling_row(input);
    b.play = 0;
  }
  if (!input.matrix.empty())
    b.matrix = Eigen::Map<const Eigen::Matrix<double, 5, 5, Eigen::RowMajor>>(input.matrix.data());
  return b;
}

dynamics::StageLoad stage_load(const LoadInput& input, const dynamics::StageBody& body, std::string name) {
  return {std::move(name), body, input.frame, vector_of(input.point), vector_of(input.force), vector_of(input.moment)};
}

Eigen::Vector3d GravityInput::vector() const {
  const double in_plane = acceleration * std::cos(inclination);
  return {in_plane * std::cos(direction), in_plane * std::sin(direction), acceleration * std::sin(inclination)};
}

bool SpaceInput::has_bearing(Body body) const {
  return std::any_of(bearings.begin(), bearings.end(), [&](const auto& b) { return b.body == body; });
}

bool SpaceInput::ring_in_mounts() const {
  return std::any_of(bearings.begin(), bearings.end(),
                     [](const auto& b) { return b.body == Body::ring && !b.beside.empty() && b.holds_radially(); });
}

bool SpaceInput::has_radial_bearing(Body body, int planets) const {
  const auto holds = [&](int planet) {
    return std::any_of(bearings.begin(), bearings.end(), [&](const auto& b) {
      return b.body == body && (!b.planet || *b.planet == planet) && b.holds_radially();
    });
  };
  for (int planet = 1; planet <= planets; ++planet)
    if (!holds(planet)) return false;
  return true;
}

}  // namespace annulus::app
