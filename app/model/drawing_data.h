#pragma once

#include <string>
#include <vector>

#include "core/json.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

/// The gears of a scene and their pairs, with their names for people.
struct DrawingData {
  struct NamedGear {
    std::string name;
    geometry::Gear gear;
  };
  struct NamedPair {
    std::string name;
    geometry::GearPair pair;
  };
  std::vector<NamedGear> gears;
  std::vector<NamedPair> pairs;
};

/// A quantity of a drawing: a line of the tables of `annulus geometry`.
struct DrawingRow {
  std::string key, title, unit;  ///< key with the unit at its end
  std::vector<std::string> cells;
  std::vector<double> values;  ///< in that unit; NaN where a gear does not have it
};

/// Diameters, thicknesses and measurements [ISO21771], a cell per gear.
[[nodiscard]] std::vector<DrawingRow> gear_rows(const DrawingData& data);
/// Contact, backlash, clearance and sliding, a cell per pair.
[[nodiscard]] std::vector<DrawingRow> pair_rows(const DrawingData& data);

/// What `annulus geometry` prints.
[[nodiscard]] std::string drawing_text(const DrawingData& data);
/// {"gears": {"sun": {"tip_diameter_mm": ...}}, "pairs": {...}}; null where a gear does not have it.
[[nodiscard]] Json drawing_json(const DrawingData& data);

}  // namespace annulus::app
