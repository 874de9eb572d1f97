#pragma once

#include <string>
#include <vector>

#include "app/report/section.h"
#include "app/scene/scene.h"
#include "geometry/gear.h"

/// What the geometry sections of all kinds share: drawings of the gears to scale and their diameters.
namespace annulus::app {

/// m; 0 without a bore.
[[nodiscard]] double bore_radius(const HubGearInput& gear);

struct NamedGear {
  std::string name;
  const geometry::Gear& gear;
  double other_radius;  ///< of the bore or the outside, m; 0: none
};
/// Diameters of the gears, mm.
[[nodiscard]] PageTable diameter_table(const std::vector<NamedGear>& gears);

[[nodiscard]] std::string helical_note(double helix_angle);
/// What the enlarged teeth show.
[[nodiscard]] std::string teeth_words(const std::string& pinion, const std::string& wheels);

[[nodiscard]] Section geometry_section(const Blocks& blocks);
/// Anything that can be drawn, as a picture.
template <class... What>
[[nodiscard]] Picture drawn(const What&... what) {
  return Drawing{to_svg(what...)};
}

}  // namespace annulus::app
