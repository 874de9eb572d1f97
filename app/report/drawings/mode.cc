#include "app/report/drawings/mode.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/report/plot/frame.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double exaggeration = 0.2;  // of the centre distance, for the largest displacement
constexpr int picture_width = 260, picture_height = 280;
constexpr const char *at_rest = "#c4c4c4", *carrier_colour = "#444444";

/// StagePage coordinates of a point of the stage, y upwards.
struct StagePage {
  double x0, y0, scale;
  [[nodiscard]] double x(double v) const { return x0 + scale * v; }
  [[nodiscard]] double y(double v) const { return y0 - scale * v; }
};

std::string circle(const StagePage& page, double x, double y, double radius, const char* colour) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"{}\"/>", page.x(x),
                     page.y(y), page.scale * radius, colour);
}

std::string line(const StagePage& page, double x1, double y1, double x2, double y2, const char* colour) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>", page.x(x1), page.y(y1), page.x(x2),
                     page.y(y2), colour);
}

/// A wheel with marks that show how far it turned: `marks` lines from `inner` to the circle.
std::string wheel(const StagePage& page, double x, double y, double radius, double angle, int marks, double inner,
                  const char* colour) {
  std::string svg = circle(page, x, y, radius, colour);
  for (int i = 0; i < marks; ++i) {
    const double a = angle + 2 * std::numbers::pi * i / marks, c = std::cos(a), s = std::sin(a);
    svg += line(page, x + inner * radius * c, y + inner * radius * s, x + radius * c, y + radius * s, colour);
  }
  return svg;
}

/// A body that swings from where it is drawn, displaced by (dx, dy) and turned by `angle`, to its mirror image about
/// its place at rest and back; the style of the page says when.
std::string swinging(const StagePage& page, double x, double y, double dx, double dy, double angle,
                     const std::string& content) {
  return fmt::format(
      "<g class=\"swing\" style=\"--x:{:.2f}px;--y:{:.2f}px;--a:{:.2f}deg;transform-origin:{:.1f}px {:.1f}px\">{}</g>",
      -2 * page.scale * dx, 2 * page.scale * dy, 2 * angle / units::deg, page.x(x), page.y(y), content);
}

std::string draw_stage(const StagePage& page, const ModeDrawing& m, double e, bool moved) {
  const auto colour = [&](const char* own) { return moved ? own : at_rest; };
  std::string svg = moved ? "<g stroke-width=\"1.6\">" : "<g stroke-width=\"1\">";
  const auto body = [&](double x0, double y0, double dx, double dy, double angle, const std::string& content) {
    svg += moved ? swinging(page, x0 + dx, y0 + dy, dx, dy, angle, content) : content;
  };
  const auto central = [&](const ModeDrawing::Motion& motion, double radius, int marks, double inner, const char* own) {
    const double x = e * motion.x, y = e * motion.y, turn = e * motion.u / radius;
    body(0, 0, x, y, turn, wheel(page, x, y, radius, turn, marks, inner, colour(own)));
  };
  central(m.ring, m.ring_radius, 12, 1.08, palette(2));
  const double turn = e * m.carrier.u / m.centre_distance, cx = e * m.carrier.x, cy = e * m.carrier.y;
  for (std::size_t n = 0; n < m.planets.size(); ++n) {
    const double phi = m.planet_angles[n], c = std::cos(phi), s = std::sin(phi);
    const auto& p = m.planets[n];
    body(0, 0, cx, cy, turn,
         line(page, cx, cy, cx + m.centre_distance * std::cos(phi + turn),
              cy + m.centre_distance * std::sin(phi + turn), colour(carrier_colour)));
    const double x = c * m.centre_distance, y = s * m.centre_distance, dx = e * (c * p.x - s * p.y),
                 dy = e * (s * p.x + c * p.y), own = e * p.u / m.planet_radius;
    body(x, y, dx, dy, own, wheel(page, x + dx, y + dy, m.planet_radius, phi + own, 2, 0.35, colour(palette(1))));
  }
  central(m.sun, m.sun_radius, 3, 0.3, palette(0));
  return svg + "</g>";
}

}  // namespace

std::string to_svg(const ModeDrawing& mode) {
  const double reach = 1.08 * mode.ring_radius + exaggeration * mode.centre_distance;
  const StagePage page{picture_width / 2.0, 20 + (picture_height - 20) / 2.0, (picture_width - 8) / 2.0 / reach};
  std::string svg = open_svg(mode.title, picture_width, picture_height, 4);
  svg += draw_stage(page, mode, 0, false);
  svg += draw_stage(page, mode, exaggeration * mode.centre_distance, true);
  return svg + "</svg>";
}

}  // namespace annulus::app
