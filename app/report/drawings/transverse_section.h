#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "app/report/drawings/gear.h"
#include "fem/problem/ring_structure.h"

namespace annulus::app {

/// Gears in transverse section, to scale, with what holds the ring.
struct TransverseSection {
  struct Place {
    Eigen::Vector2d centre;  ///< m
    double angle = 0;        ///< rad, of tooth 0
  };
  struct Gears {
    DrawnGear gear;
    std::vector<Place> places;
  };
  struct Ring {
    fem::RingStructure structure;
    double outside_radius = 0;  ///< m
    double angle = 0;           ///< rad, of tooth 0
  };
  /// From point to point, the figure follows; `offset` as in `dimension`, page units.
  struct Length {
    Eigen::Vector2d from, to;  ///< m
    double offset = 0;
    std::string symbol{};  ///< before the figure: "a = "
  };
  /// Pins of a 2K-V stage and the like: circles beside gears and rings.
  struct Circle {
    Eigen::Vector2d centre;  ///< m
    double radius = 0;       ///< m
    std::string style{};     ///< SVG attributes
  };
  /// A body with an outline of its own.
  struct Body {
    std::vector<Eigen::Vector2d> outline;  ///< m, closed
    std::string style{};                   ///< SVG attributes
  };
  std::string title{}, label{};  ///< `label`: what those hear who cannot see it
  std::vector<Gears> gears{};
  std::optional<Ring> ring{};
  std::vector<Body> bodies{};
  std::vector<Circle> circles{};
  std::vector<Length> lengths{};
  std::optional<double> outside_radius{};  ///< m, of what is dimensioned below the drawing
};

[[nodiscard]] std::string to_svg(const TransverseSection& section);

}  // namespace annulus::app
