#include "app/model/drawing_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/not_known.h"
#include "core/text_columns.h"
#include "core/units.h"
#include "geometry/measurements.h"

namespace annulus::app {

namespace {

using geometry::Gear;
using geometry::GearPair;

std::string cell(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const auto text = fmt::format("{:.{}f}", value, decimals);
  return text.find_first_not_of("-0.") == std::string::npos ? fmt::format("{:.{}f}", 0.0, decimals) : text;
}

/// A row with `decimals` of `value` of each item.
template <class Items, class Value>
DrawingRow row(const Items& items, std::string key, std::string title, std::string unit, int decimals,
               const Value& value) {
  DrawingRow result{std::move(key), std::move(title), std::move(unit), {}, {}};
  for (const auto& item : items) {
    result.values.push_back(value(item) + 0.0);  // no negative zeros
    result.cells.push_back(cell(result.values.back(), decimals));
  }
  return result;
}

/// Of pins as they are sold: to a quarter of a millimetre, and to a tenth of a module where that is less.
double rounded_pin(const Gear& gear) {
  const double step = std::min(0.25 * units::mm, 0.1 * gear.parameters().module);
  return step * std::round(geometry::usual_pin_diameter(gear) / step);
}

struct PinMeasure {
  double pin = not_known, over = not_known;
};
PinMeasure pin_measure(const Gear& gear) {
  try {
    const double pin = rounded_pin(gear);
    return {pin, geometry::dimension_over_pins(gear, pin)};
  } catch (const GeometryError&) {  // no pins touch this tooth: it has no such measure
    return {};
  }
}

}  // namespace

std::vector<DrawingRow> gear_rows(const DrawingData& data) {
  std::vector<DrawingRow> rows;
  const auto add = [&](const char* key, const char* title, const char* unit, int decimals, const auto& value) {
    rows.push_back(row(data.gears, key, title, unit, decimals, [&](const auto& g) { return value(g.gear); }));
  };
  const auto mm = [&](const char* key, const char* title, const auto& value) {
    add(key, title, "mm", 4, [&](const Gear& g) { return value(g) / units::mm; });
  };
  add("teeth", "teeth", "", 0, [](const Gear& g) { return g.teeth(); });
  mm("module_mm", "normal module", [](const Gear& g) { return g.parameters().module; });
  add("pressure_angle_deg", "normal pressure angle", "°", 4,
      [](const Gear& g) { return g.parameters().pressure_angle / units::deg; });
  add("helix_angle_deg", "helix angle, right hand positive", "°", 4,
      [](const Gear& g) { return g.helix_angle() / units::deg; });
  add("profile_shift", "profile shift x", "", 5, [](const Gear& g) { return g.parameters().profile_shift; });
  mm("face_width_mm", "face width", [](const Gear& g) { return g.parameters().face_width; });
  mm("reference_diameter_mm", "reference diameter d", [](const Gear& g) { return 2 * g.reference_radius(); });
  mm("base_diameter_mm", "base diameter d_b", [](const Gear& g) { return 2 * g.base_radius(); });
  mm("tip_diameter_mm", "tip diameter d_a", [](const Gear& g) { return 2 * g.tip_radius(); });
  mm("tip_form_diameter_mm", "tip form diameter, end of the involute",
     [](const Gear& g) { return 2 * g.tip_form_radius(); });
  mm("root_diameter_mm", "root diameter d_f", [](const Gear& g) { return 2 * g.root_radius(); });
  mm("form_diameter_mm", "form diameter, start of the involute", [](const Gear& g) { return 2 * g.form_radius(); });
  mm("tooth_thickness_mm", "normal tooth thickness on d",
     [](const Gear& g) { return geometry::normal_tooth_thickness(g); });
  mm("tip_thickness_mm", "normal tooth thickness on d_a", [](const Gear& g) {
    return (g.tooth_thickness(g.tip_form_radius()) - 2 * g.parameters().tip_chamfer) *
           std::cos(g.helix_angle_at(g.tip_radius()));
  });
  add("span_teeth", "teeth (ring: spaces) of the span", "", 0,
      [](const Gear& g) { return geometry::usual_span_teeth(g); });
  mm("span_mm", "span W_k", [](const Gear& g) { return g.base_tangent_length(geometry::usual_span_teeth(g)); });
  mm("measuring_pin_mm", "measuring pin or ball", [](const Gear& g) { return pin_measure(g).pin; });
  mm("over_pins_mm", "dimension over pins (ring: between)", [](const Gear& g) { return pin_measure(g).over; });
  return rows;
}

std::vector<DrawingRow> pair_rows(const DrawingData& data) {
  std::vector<DrawingRow> rows;
  const auto add = [&](const char* key, const char* title, const char* unit, int decimals, const auto& value) {
    rows.push_back(row(data.pairs, key, title, unit, decimals, [&](const auto& p) { return value(p.pair); }));
  };
  add("centre_distance_mm", "centre distance a", "mm", 4,
      [](const GearPair& p) { return p.centre_distance() / units::mm; });
  add("working_pressure_angle_deg", "working pressure angle α_wt", "°", 4,
      [](const GearPair& p) { return p.working_pressure_angle() / units::deg; });
  add("normal_backlash_um", "normal backlash j_bn", "µm", 2,
      [](const GearPair& p) { return p.normal_backlash() / units::um; });
  add("contact_ratio", "transverse contact ratio ε_α", "", 4, [](const GearPair& p) { return p.contact_ratio(); });
  add("overlap_ratio", "overlap ratio ε_β", "", 4, [](const GearPair& p) { return p.overlap_ratio(); });
  add("total_contact_ratio", "total contact ratio ε_γ", "", 4,
      [](const GearPair& p) { return p.total_contact_ratio(); });
  add("path_of_contact_mm", "length of the path of contact g_α", "mm", 4,
      [](const GearPair& p) { return (p.roll_length_high() - p.roll_length_low()) / units::mm; });
  add("pinion_tip_clearance_mm", "clearance at the tip of the first gear", "mm", 4,
      [](const GearPair& p) { return p.tip_clearance().pinion_tip / units::mm; });
  add("wheel_tip_clearance_mm", "clearance at the tip of the second gear", "mm", 4,
      [](const GearPair& p) { return p.tip_clearance().wheel_tip / units::mm; });
  const auto sliding = [&](const char* key, const char* title, double geometry::SpecificSliding::*part) {
    add(key, title, "", 4, [part](const GearPair& p) { return geometry::specific_sliding(p).*part; });
  };
  using geometry::SpecificSliding;
  sliding("sliding_pinion_at_root", "specific sliding, root of the first gear", &SpecificSliding::pinion_at_root);
  sliding("sliding_wheel_at_tip", "specific sliding there, tip of the second", &SpecificSliding::wheel_at_tip);
  sliding("sliding_pinion_at_tip", "specific sliding, tip of the first gear", &SpecificSliding::pinion_at_tip);
  sliding("sliding_wheel_at_root", "specific sliding there, root of the second", &SpecificSliding::wheel_at_root);
  return rows;
}

namespace {

/// Columns as wide as their widest cell.
std::string table_text(const std::vector<std::string>& names, const std::vector<DrawingRow>& rows) {
  std::size_t first = 0;
  const auto title_of = [](const DrawingRow& r) { return r.unit.empty() ? r.title : r.title + ", " + r.unit; };
  for (const auto& r : rows) first = std::max(first, characters(title_of(r)));
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    columns.push_back(characters(names[i]));
    for (const auto& r : rows) columns.back() = std::max(columns.back(), characters(r.cells[i]));
  }
  std::string text;
  const auto line = [&](const std::string& title, const std::vector<std::string>& cells) {
    text += left_aligned(title, first + 1);
    for (std::size_t i = 0; i < cells.size(); ++i) text += " " + right_aligned(cells[i], columns[i] + 1);
    text += "\n";
  };
  line("", names);
  for (const auto& r : rows) line(title_of(r), r.cells);
  return text;
}

template <class Items>
std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

Json table_json(const std::vector<std::string>& names, const std::vector<DrawingRow>& rows) {
  Json json = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const auto& r : rows) json[names[i]][r.key] = json_number(r.values[i]);
  return json;
}

}  // namespace

std::string drawing_text(const DrawingData& data) {
  std::string text = table_text(names_of(data.gears), gear_rows(data));
  if (!data.pairs.empty()) text += "\n" + table_text(names_of(data.pairs), pair_rows(data));
  return text;
}

Json drawing_json(const DrawingData& data) {
  return {{"gears", table_json(names_of(data.gears), gear_rows(data))},
          {"pairs", table_json(names_of(data.pairs), pair_rows(data))}};
}

}  // namespace annulus::app
