#include "dynamics/spatial/carrier_structure.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

using Motion = Eigen::Matrix<double, 6, 1>;
using Seat = Eigen::Matrix<double, 6, 6>;

/// Displacement and rotation along radial, tangential and axial directions at a point of a wall, over those of the wall
/// along x, y and z at the middle.
Seat at_point(double angle, double radius, double z) {
  Eigen::Matrix3d axes;
  axes << std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0, 0, 0, 1;
  // Displacement = u + phi x p, p = radius r + z k in the point's own axes.
  Eigen::Matrix3d lever;
  lever << 0, z, 0, -z, 0, radius, 0, -radius, 0;
  Seat result = Seat::Zero();
  result.topLeftCorner<3, 3>() = axes;
  result.bottomRightCorner<3, 3>() = axes;
  result.topRightCorner<3, 3>() = lever * axes;
  return result;
}

void check(const TwoWallCarrier& c) {
  for (const auto& [value, name] : {std::pair{c.radius, "radius of the planets"},
                                    {c.pin_length, "length of the pins"},
                                    {c.web_radius, "radius of the webs"},
                                    {c.web_length, "length of the webs"},
                                    {c.web_width, "width of the webs"},
                                    {c.web_depth, "depth of the webs"},
                                    {c.youngs_modulus, "Young's modulus of the webs"}})
    if (!(value > 0) || !std::isfinite(value))
      throw InputError(fmt::format("a carrier of two walls has a {} of {:g}; it must be positive", name, value));
  if (c.webs < 2 || c.planet_angles.empty())
    throw InputError(fmt::format("a carrier of two walls has {} webs and {} planets; it needs two webs and a planet",
                                 c.webs, c.planet_angles.size()));
}

}  // namespace

EndStiffness beam_end(const Beam& along_x, const Beam& along_y, double length, Side wall) {
  // A beam that comes from the wall at -z turns about +y where it bends along +x, about -x where it bends along +y.
  const double side = wall == Side::low ? 1 : -1;
  EndStiffness all = EndStiffness::Zero();
  for (const auto& [beam, shift, turn, sign] : {std::tuple{&along_x, 0, 4, side}, {&along_y, 1, 3, -side}}) {
    Eigen::Matrix2d compliance;
    const double tilt = sign * beam->cantilever_tilt(length);
    compliance << beam->cantilever(length), tilt, tilt, beam->cantilever_bend(length);
    const Eigen::Matrix2d stiffness = compliance.inverse();
    all(shift, shift) = stiffness(0, 0);
    all(turn, turn) = stiffness(1, 1);
    all(shift, turn) = all(turn, shift) = stiffness(0, 1);
  }
  all(2, 2) = along_x.axial / length;
  return all;
}

Eigen::MatrixXd pins_stiffness(const TwoWallCarrier& c) {
  check(c);
  const Side other = c.shaft == Side::low ? Side::high : Side::low;
  const EndStiffness near = beam_end(c.pin, c.pin, c.pin_length / 2, c.shaft),
                     far = beam_end(c.pin, c.pin, c.pin_length / 2, other);
  // The far ends of the webs move with the far wall.
  const double end = (c.shaft == Side::low ? 1 : -1) * c.web_length / 2;
  const auto radial = rectangular_beam(c.web_depth, c.web_width, c.youngs_modulus, c.poisson_ratio),
             tangential = rectangular_beam(c.web_width, c.web_depth, c.youngs_modulus, c.poisson_ratio);
  Seat web = Seat::Zero();
  web.topLeftCorner<5, 5>() = beam_end(radial, tangential, c.web_length, c.shaft);
  web(5, 5) = radial.torsion / c.web_length;
  Seat wall = Seat::Zero();  // stiffness against motions of the far wall
  for (int k = 0; k < c.webs; ++k) {
    const auto seat = at_point(c.first_web + 2 * std::numbers::pi * k / c.webs, c.web_radius, end);
    wall += seat.transpose() * web * seat;
  }
  const auto planets = static_cast<Eigen::Index>(c.planet_angles.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(5 * planets, 5 * planets), coupling(5 * planets, 6);
  for (Eigen::Index n = 0; n < planets; ++n) {
    const Eigen::Matrix<double, 5, 6> seat =
        at_point(c.planet_angles[static_cast<std::size_t>(n)], c.radius, 0).topRows<5>();
    all.block<5, 5>(5 * n, 5 * n) = near + far;
    coupling.middleRows<5>(5 * n) = -far * seat;
    wall += seat.transpose() * far * seat;
    wall(5, 5) += c.pin.torsion / c.pin_length;  // twisted from wall to wall
  }
  // The far wall bears no load of its own.
  all -= coupling * wall.inverse() * coupling.transpose();
  return (all + all.transpose()) / 2;
}

}  // namespace annulus::dynamics
