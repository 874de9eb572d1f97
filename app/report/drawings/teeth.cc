#include "app/report/drawings/teeth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/gear.h"
#include "app/report/plot/frame.h"
#include "app/report/text/xml.h"
#include "app/scene/scene_value.h"
#include "core/units.h"
#include "geometry/gear_places.h"

namespace annulus::app {

namespace {

constexpr int teeth_width = 560;
constexpr double teeth_top = 24, legend_row = 17;
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
  const double module = pair.planet().parameters().module;
  const double planet_base = pair.planet().base_radius();
  const double other = pair.internal() ? pair.centre_distance() + planet_base : pair.centre_distance() - planet_base;
  const double half = pitches * pair.wheel().pitch_angle() * pitch;
  return {std::max(std::min({pitch - modules * module, wheel_base - air * module, other - air * module}), pitch - half),
          std::min(std::max({pitch + modules * module, wheel_base + air * module, other + air * module}), pitch + half),
          half};
}

/// Roll lengths of the planet at which teeth touch while one pair touches in the pitch point.
std::vector<double> contacts(const geometry::GearPair& pair) {
  const double pitch = pair.planet().base_pitch();
  std::vector<double> rolls;
  for (double roll =
           pair.roll_length_pitch() - pitch * std::floor((pair.roll_length_pitch() - pair.roll_length_low()) / pitch);
       roll <= pair.roll_length_high(); roll += pitch)
    rolls.push_back(roll);
  return rolls;
}

std::string stroke(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const char* colour, double width) {
  return fmt::format("<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" stroke=\"{}\" stroke-width=\"{}\"/>", a.x(), a.y(),
                     b.x(), b.y(), colour, width);
}

/// A letter with a white edge, readable on teeth.
std::string letter(const Eigen::Vector2d& at, const std::string& text) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"600\" paint-order=\"stroke\" stroke=\"#fff\" "
      "stroke-width=\"3\">{}</text>",
      at.x(), at.y(), text);
}

std::string action(const DrawingPage& page, const geometry::GearPair& pair, const Window& window) {
  const auto line = geometry::action_line(pair);
  const auto at = [&](double roll) { return page.at(line.tangent + roll * line.along); };
  const double beyond = 3 * window.half_width;
  std::string svg =
      stroke(at(pair.roll_length_pitch() - beyond), at(pair.roll_length_pitch() + beyond), action_colour, 0.9);
  svg += stroke(at(pair.roll_length_low()), at(pair.roll_length_high()), action_colour, 2.6);
  for (const double roll : contacts(pair)) {
    const Eigen::Vector2d p = at(roll);
    svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4\" fill=\"{}\"/>", p.x(), p.y(), action_colour);
  }
  const Eigen::Vector2d pitch = at(pair.roll_length_pitch());
  svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"6.5\" fill=\"none\" stroke=\"#000\"/>", pitch.x(),
                     pitch.y());
  svg += letter(pitch + Eigen::Vector2d(9, 4), "C");
  svg += letter(at(pair.roll_length_low()) + Eigen::Vector2d(7, -4), "A");
  return svg + letter(at(pair.roll_length_high()) + Eigen::Vector2d(7, -4), "E");
}

std::string legend_entry(double y, const std::string& sample, const std::string& text) {
  return fmt::format("<g transform=\"translate(6 {:.1f})\"><path d=\"M0 -4h34\" {}/><text x=\"42\">{}</text></g>", y,
                     sample, escape(text));
}

std::string teeth_legend(const TeethInMesh& drawing, const geometry::GearPair& pair, double y, double scale) {
  const double cosine = std::cos(pair.working_pressure_angle());
  const auto diameters = [&](double factor) {
    return fmt::format("⌀ {} ({}), ⌀ {} ({})", mm_text(2 * factor * pair.planet().base_radius()), drawing.planet_name,
                       mm_text(2 * factor * pair.wheel().base_radius()), drawing.wheel_name);
  };
  std::string svg =
      legend_entry(y, fmt::format("stroke=\"{}\" stroke-width=\"2.6\"", action_colour),
                   fmt::format("path of contact A–E on the line of action, {} mm; ● contact, ○ C pitch point",
                               mm_text(pair.roll_length_high() - pair.roll_length_low())));
  svg += legend_entry(y + legend_row, base_circle_style, "base circles " + diameters(1));
  svg += legend_entry(y + 2 * legend_row, pitch_circle_style, "working pitch circles " + diameters(1 / cosine));
  svg += fmt::format(
      "<text x=\"6\" y=\"{:.1f}\">working pressure angle {}°, contact ratio {:.3f}, normal backlash {} µm</text>",
      y + 3 * legend_row, to_text(pair.working_pressure_angle() / units::deg, 5), pair.contact_ratio(),
      to_text(std::round(pair.normal_backlash() / units::um * 10) / 10, 5));
  return svg + scale_bar({teeth_width - 110.0, y + 3 * legend_row - 6}, scale, 90);
}

}  // namespace

std::string to_svg(const TeethInMesh& drawing, const geometry::GearPair& pair) {
  const auto window = window_of(pair);
  const double scale = teeth_width / (2 * window.half_width), height = scale * (window.high - window.low);
  const DrawingPage page{scale, 0.5 * teeth_width, scale * window.high};
  const Eigen::Vector2d axis(0, 0), centre(pair.centre_distance(), 0);
  const auto [planet_angle, wheel_angle] = geometry::pair_places(pair);
  const DrawnGear planet{.gear = pair.planet(), .id = drawing.id + "-planet", .fill = planet_fill};
  const DrawnGear wheel{.gear = pair.wheel(),
                        .id = drawing.id + "-wheel",
                        .fill = pair.internal() ? wheel_fill : sun_fill,
                        .outside_radius = drawing.wheel_outside_radius};
  std::string svg = open_svg(
      drawing.title, teeth_width, static_cast<int>(teeth_top + height + 4.6 * legend_row), 6.0,
      fmt::format("{}, enlarged to scale at pitch-point contact: teeth of {} and {}, base circles, line of action",
                  drawing.title, drawing.planet_name, drawing.wheel_name));
  svg += fmt::format("<svg y=\"{0}\" width=\"{1}\" height=\"{2:.1f}\" viewBox=\"0 0 {1} {2:.1f}\">", teeth_top,
                     teeth_width, height);
  svg += gear_defs(page, wheel) + placed_gear(page, wheel, axis, wheel_angle);
  svg += gear_defs(page, planet) + placed_gear(page, planet, centre, planet_angle);
  const double cosine = std::cos(pair.working_pressure_angle());
  for (const auto& [where, gear] : {std::pair{centre, pair.planet()}, {axis, pair.wheel()}}) {
    svg += drawn_circle(page, where, gear.base_radius(), base_circle_style);
    svg += drawn_circle(page, where, gear.base_radius() / cosine, pitch_circle_style);
  }
  svg += action(page, pair, window);
  svg += fmt::format("<rect width=\"{}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#bbb\"/></svg>", teeth_width, height);
  return svg + teeth_legend(drawing, pair, teeth_top + height + legend_row, scale) + "</svg>";
}

}  // namespace annulus::app
