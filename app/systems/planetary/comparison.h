#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/model/measured.h"
#include "app/scene/reference.h"
#include "app/systems/planetary/planetary_run.h"

namespace annulus::app {

/// Everything that can be compared between rings. One key may stand for several definitions of the same figure.
[[nodiscard]] std::vector<VariantQuantity> ring_quantities(const RunResult& result);

/// A published statement compared with the computed numbers.
struct Verdict {
  enum class Outcome { agrees, disagrees, undecided };
  std::string statement, where;
  std::string quantity;  ///< the definition that was compared
  std::string computed;  ///< the numbers
  std::string published;
  Outcome outcome = Outcome::undecided;
  std::string why;  ///< what the numbers say where they do not agree
};

[[nodiscard]] std::vector<Verdict> compare(const Reference& reference, const RunResult& result);

/// Stiffness of a planet's whole path, sun mesh + ring mesh + bearing in series, all centres held (N/m), and the part
/// of its compliance that the ring mesh brings. What the ring can do to load sharing is bounded by that part.
struct PathStiffness {
  double total = 0;
  double ring_part = 0, sun_part = 0, bearing_part = 0;
};
[[nodiscard]] PathStiffness path_stiffness(const RunResult& result, std::size_t ring);

/// How the stiffness of a pinned ring depends on where the pins stand. Relative values: near over far, less one, near
/// being within a quarter of the pin pitch.
struct PinEffect {
  double contact_at_pin = 0;    ///< the contact itself at a pin
  double force_at_pin = 0;      ///< a pin where the pins carry most, in the path of the force
  double loaded_pin_teeth = 0;  ///< that place: ring teeth from the contact, counter-clockwise positive
  double stiffest_teeth = 0;    ///< contact from the nearest pin where the mean over a tooth is stiffest
};
/// Nothing for a ring without pins, or whose stiffness was prescribed.
[[nodiscard]] std::optional<PinEffect> pin_effect(const RunResult& result, std::size_t ring);

}  // namespace annulus::app
