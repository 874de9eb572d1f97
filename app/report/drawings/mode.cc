#include "app/report/drawings/mode.h"

#include <fmt/format.h>

#include <numbers>

#include "app/report/drawings/drawing_page.h"
#include "app/report/plot/ticks.h"
#include "core/units.h"

namespace annulus::app {

namespace {

using Point = Eigen::Vector2d;

constexpr double exaggeration = 0.2;  // of the centre distance, for the largest displacement
constexpr double picture_width = 260, picture_height = 280;

/// A body of the stage: where it is at rest, and by how much it is displaced and turned.
struct Body {
  Point at_rest{0, 0}, moved{0, 0};
  double turned = 0;  ///< rad
};

/// Draws the bodies at rest, or displaced.
struct Stage {
  DrawingPage page;
  bool displaced;

  [[nodiscard]] std::string style(const char* colour) const {
    return fmt::format(R"(fill="none" stroke="{}")", displaced ? colour : "#c4c4c4");
  }

  /// A body that swings from where it is drawn to its mirror image about its place at rest and back; the style of the
  /// page says when.
  [[nodiscard]] std::string swinging(const Body& body, const std::string& content) const {
    if (!displaced) return content;
    const svg::Point axis = page.at(body.at_rest + body.moved), back = 2 * (page.at(body.at_rest) - axis);
    return svg::group(
        fmt::format(
            R"(class="swing" style="--x:{:.2f}px;--y:{:.2f}px;--a:{:.2f}deg;transform-origin:{:.1f}px {:.1f}px")",
            back.x(), back.y(), 2 * body.turned / units::deg, axis.x(), axis.y()),
        content);
  }

  /// A circle with marks that show how far it turned: `marks` lines from `inner` to the circle.
  [[nodiscard]] std::string wheel(const Body& body, double radius, double angle, int marks, double inner,
                                  const char* colour) const {
    const Point centre = body.at_rest + body.moved;
    std::string text = page.circle(centre, radius, style(colour));
    for (int i = 0; i < marks; ++i) {
      const Point mark = polar(radius, angle + body.turned + 2 * std::numbers::pi * i / marks);
      text += page.line(centre + inner * mark, centre + mark, style(colour));
    }
    return swinging(body, text);
  }
};

std::string drawn(const Stage& stage, const ModeDrawing& m) {
  const double e = stage.displaced ? exaggeration * m.centre_distance : 0;
  const auto central = [&](const ModeDrawing::Motion& motion, double radius) {
    return Body{{0, 0}, {e * motion.x, e * motion.y}, e * motion.u / radius};
  };
  std::string text = stage.wheel(central(m.ring, m.ring_radius), m.ring_radius, 0, 12, 1.08, palette(2));
  const auto carrier = central(m.carrier, m.centre_distance);
  for (std::size_t n = 0; n < m.planets.size(); ++n) {
    const double phi = m.planet_angles[n];
    const Point arm = polar(m.centre_distance, phi + carrier.turned);
    text += stage.swinging(carrier, stage.page.line(carrier.moved, carrier.moved + arm, stage.style("#444444")));
    const auto& p = m.planets[n];
    const Body planet{polar(m.centre_distance, phi),
                      e * (p.x * polar(1, phi) + p.y * polar(1, phi + std::numbers::pi / 2)),
                      e * p.u / m.planet_radius};
    text += stage.wheel(planet, m.planet_radius, phi, 2, 0.35, palette(1));
  }
  text += stage.wheel(central(m.sun, m.sun_radius), m.sun_radius, 0, 3, 0.3, palette(0));
  return svg::group(stage.displaced ? R"(stroke-width="1.6")" : R"(stroke-width="1")", text);
}

}  // namespace

std::string to_svg(const ModeDrawing& mode) {
  const double reach = 1.08 * mode.ring_radius + exaggeration * mode.centre_distance;
  const DrawingPage page{
      (picture_width - 8) / 2 / reach, {picture_width / 2, 20 + (picture_height - 20) / 2}, DrawingPage::Up::y};
  return svg::titled_picture(mode.title, {}, picture_width, picture_height, 4,
                             drawn({page, false}, mode) + drawn({page, true}, mode));
}

}  // namespace annulus::app
