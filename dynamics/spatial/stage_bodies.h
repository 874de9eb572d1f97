#pragma once

#include <string>

namespace annulus::dynamics {

/// A body of a stage; planets and their pins by number. Pinion and wheel are those of a pair.
struct StageBody {
  enum class Kind { housing, sun, ring, carrier, pinion, wheel, planet, pin };
  Kind kind = Kind::housing;
  int planet = 0;
  bool operator==(const StageBody&) const = default;
};

/// For messages and files: "sun", "planet2".
[[nodiscard]] std::string name_of_body(const StageBody& body);

/// Motions of bodies: in the plane alone, or along the axis and tilting as well.
enum class Motions { in_plane, in_space };

/// How nonlinear bearings act in motion: with their tangents at the equilibrium, or by their whole law.
enum class BearingLaws { tangents, whole };

/// Frames in which bearings, loads and results are stated. z points along the axis in all of them.
///
/// carrier: x towards planet 0. housing: that of the carrier at time 0. planet: x radially outwards through the
/// planet's axis and y tangential, counter-clockwise. In a pair the housing has x from the pinion to the wheel, and no
/// other frame exists.
enum class StageFrame { carrier, housing, planet };

}  // namespace annulus::dynamics
