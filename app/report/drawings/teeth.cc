#include "app/report/drawings/teeth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/gear.h"
#include "app/scene/scene_value.h"
#include "core/units.h"
#include "geometry/gear_places.h"

namespace annulus::app {

namespace {

constexpr double teeth_width = 560, teeth_top = 24, legend_row = 17;
constexpr const char* action_colour = "#c22f2f";

/// What is shown: along the line of centres, and to either side of it, m.
struct Window {
  double low, high, half_width;
};

/// Some pitches wide; as high as the teeth and the base circles need, but no higher than wide.
Window window_of(const geometry::GearPair& pair) {
  constexpr double pitches = 2.6, modules = 3.4, air = 0.6;
  const double cosine = std::cos(pair.working_pressure_angle());
  const double wheel_base = pair.wheel().base_radius(), pitch = wheel_base / cosine;
  const double module = pair.pinion().parameters().module;
  const double pinion_base = pair.pinion().base_radius();
  const double other = pair.internal() ? pair.centre_distance() + pinion_base : pair.centre_distance() - pinion_base;
  const double half = pitches * pair.wheel().pitch_angle() * pitch;
  return {std::max(std::min({pitch - modules * module, wheel_base - air * module, other - air * module}), pitch - half),
          std::min(std::max({pitch + modules * module, wheel_base + air * module, other + air * module}), pitch + half),
          half};
}

/// Roll lengths of the pinion at which teeth touch while one pair touches in the pitch point.
std::vector<double> contacts(const geometry::GearPair& pair) {
  const double pitch = pair.pinion().base_pitch();
  std::vector<double> rolls;
  for (double roll =
           pair.roll_length_pitch() - pitch * std::floor((pair.roll_length_pitch() - pair.roll_length_low()) / pitch);
       roll <= pair.roll_length_high(); roll += pitch)
    rolls.push_back(roll);
  return rolls;
}

std::string action(const DrawingPage& page, const geometry::GearPair& pair, const Window& window) {
  const auto line = geometry::action_line(pair);
  const auto at = [&](double roll) { return page.at(line.tangent + roll * line.along); };
  const auto stroke = [&](double from, double to, double width) {
    return svg::line(at(from), at(to), fmt::format(R"(stroke="{}" stroke-width="{}")", action_colour, width));
  };
  // With a white edge, readable on teeth.
  const auto letter = [&](double roll, double right, double down, const char* text) {
    return svg::words(at(roll) + svg::Point(right, down), text,
                      R"(font-weight="600" paint-order="stroke" stroke="#fff" stroke-width="3")");
  };
  const double low = pair.roll_length_low(), pitch = pair.roll_length_pitch(), high = pair.roll_length_high();
  const double beyond = 3 * window.half_width;
  std::string text = stroke(pitch - beyond, pitch + beyond, 0.9) + stroke(low, high, 2.6);
  for (const double roll : contacts(pair)) text += svg::circle(at(roll), 4, fmt::format(R"(fill="{}")", action_colour));
  text += svg::circle(at(pitch), 6.5, R"(fill="none" stroke="#000")");
  return text + letter(pitch, 9, 4, "C") + letter(low, 7, -4, "A") + letter(high, 7, -4, "E");
}

/// In rows from `y` on; what is drawn has a sample in front.
std::string teeth_legend(const TeethInMesh& drawing, const geometry::GearPair& pair, double y, double scale) {
  const auto diameters = [&](double factor) {
    return fmt::format("⌀ {} ({}), ⌀ {} ({})", mm_text(2 * factor * pair.pinion().base_radius()), drawing.pinion_name,
                       mm_text(2 * factor * pair.wheel().base_radius()), drawing.wheel_name);
  };
  std::string text;
  for (const auto& [sample, words] :
       {std::pair{fmt::format(R"(stroke="{}" stroke-width="2.6")", action_colour),
                  fmt::format("path of contact A–E on the line of action, {} mm; ● contact, ○ C pitch point",
                              mm_text(pair.roll_length_high() - pair.roll_length_low()))},
        {base_circle_style, "base circles " + diameters(1)},
        {pitch_circle_style, "working pitch circles " + diameters(1 / std::cos(pair.working_pressure_angle()))}}) {
    text += svg::line({6, y - 4}, {40, y - 4}, sample) + svg::words({48, y}, words);
    y += legend_row;
  }
  text += svg::words({6, y}, fmt::format("working pressure angle {}°, contact ratio {:.3f}, normal backlash {} µm",
                                         to_text(pair.working_pressure_angle() / units::deg, 5), pair.contact_ratio(),
                                         to_text(std::round(pair.normal_backlash() / units::um * 10) / 10, 5)));
  return text + scale_bar({teeth_width - 110.0, y - 6}, scale, 90);
}

}  // namespace

std::string to_svg(const TeethInMesh& drawing, const geometry::GearPair& pair) {
  const auto window = window_of(pair);
  const double scale = teeth_width / (2 * window.half_width), height = scale * (window.high - window.low);
  const DrawingPage page{scale, {0.5 * teeth_width, scale * window.high}};
  const Eigen::Vector2d axis(0, 0), centre(pair.centre_distance(), 0);
  const auto [pinion_angle, wheel_angle] = geometry::pair_places(pair);
  const DrawnGear pinion{.gear = pair.pinion(), .id = drawing.id + "-pinion", .fill = planet_fill};
  const DrawnGear wheel{.gear = pair.wheel(),
                        .id = drawing.id + "-wheel",
                        .fill = pair.internal() ? wheel_fill : sun_fill,
                        .outside_radius = drawing.wheel_outside_radius};
  std::string shown = gear_defs(page, wheel) + placed_gear(page, wheel, axis, wheel_angle);
  shown += gear_defs(page, pinion) + placed_gear(page, pinion, centre, pinion_angle);
  for (const auto& [where, gear] : {std::pair{centre, pair.pinion()}, {axis, pair.wheel()}}) {
    shown += page.circle(where, gear.base_radius(), base_circle_style);
    shown += page.circle(where, gear.base_radius() / std::cos(pair.working_pressure_angle()), pitch_circle_style);
  }
  shown += action(page, pair, window);
  const svg::Point size(teeth_width, height);
  shown += svg::rectangle({0, 0}, size, R"(fill="none" stroke="#bbb")");
  return svg::titled_picture(
      drawing.title,
      fmt::format("{}, enlarged to scale at pitch-point contact: teeth of {} and {}, base circles, line of action",
                  drawing.title, drawing.pinion_name, drawing.wheel_name),
      teeth_width, teeth_top + height + 4.6 * legend_row, 6,
      svg::window({0, teeth_top}, size, {0, 0}, shown) +
          teeth_legend(drawing, pair, teeth_top + height + legend_row, scale));
}

}  // namespace annulus::app
