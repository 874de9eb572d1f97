#include "app/report/drawings/axial_section.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/drawing_page.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double axial_width = 560, axial_left = 70, axial_right = 150, axial_top = 70;

/// A rectangle of the section, along the axis and from radius to radius, m; a line where it has no extent one way.
using AxialBox = Eigen::AlignedBox2d;

/// A ring in axial section: z to the right, the radius upwards.
class AxialDrawing {
 public:
  explicit AxialDrawing(const AxialSection& section)
      : section_(section),
        width_(section.ring.parameters().face_width),
        outside_(section.outside_radius),
        body_(section.structure.body(outside_)),
        drawing_(section.structure.drawing(outside_)),
        end_(body_.sleeve ? -body_.sleeve->length : 0) {
    constexpr double tallest = 420;
    const std::string wheel = std::string("fill=\"") + wheel_fill + "\" " + edge;
    if (end_ < 0) add({end_, body_.held_inner_radius}, {0, outside_}, wheel);
    if (body_.hoop) add({width_ - body_.hoop->width, outside_}, {width_, outside_ + body_.hoop->thickness}, wheel);
    if (body_.flange) add({0, outside_}, {flange_width(), body_.flange->outside_radius}, wheel);
    add({0, section.ring.root_radius()}, {width_, outside_}, wheel);
    add({0, section.ring.tip_radius()}, {width_, section.ring.root_radius()}, std::string(R"(fill="#fbf1e7" )") + edge);
    for (const auto& cylinders : drawing_.cylinders)
      add({0, cylinders.circle_radius - cylinders.diameter / 2},
          {width_, cylinders.circle_radius + cylinders.diameter / 2},
          R"(fill="#D55E00" fill-opacity="0.6" stroke="#7a3600" stroke-width="0.9")");
    page_.scale = std::min((axial_width - axial_left - axial_right) / all_.sizes().x(), tallest / all_.sizes().y());
    page_.origin = svg::Point(axial_left, axial_top) + page_.scale * Eigen::Vector2d(-all_.min().x(), all_.max().y());
  }

  [[nodiscard]] std::string svg() const {
    const double bottom = page_.at(all_.min()).y();
    std::string text;
    for (const auto& [block, style] : blocks_)
      text += svg::rectangle(page_.at(block.min()), page_.at(block.max()), style);
    for (const auto& line : held()) text += ground(line);
    text += dimensions() + diameters() + supports();
    text += scale_bar({14, bottom + 58}, page_.scale, 0.3 * axial_width);
    return svg::titled_picture(section_.title, section_.label, axial_width, bottom + 78, 14, text);
  }

 private:
  static constexpr const char* edge = R"(stroke="#2c3a48" stroke-width="0.9")";
  static constexpr double line_height = 15;

  void add(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const std::string& style) {
    blocks_.emplace_back(AxialBox(low, high), style);
    all_.extend(blocks_.back().first);
  }
  [[nodiscard]] double flange_width() const { return std::min(body_.flange->width, width_); }
  [[nodiscard]] svg::Point at(double z, double r) const { return page_.at({z, r}); }

  [[nodiscard]] std::vector<AxialBox> held() const {
    const auto line = [](double z1, double r1, double z2, double r2) {
      return AxialBox(Eigen::Vector2d(z1, r1), Eigen::Vector2d(z2, r2));
    };
    const auto face = [&](double z) { return line(z, body_.held_inner_radius, z, outside_); };
    switch (body_.held) {
      case fem::HeldSurface::outside:
        return {line(0, outside_, width_, outside_)};
      case fem::HeldSurface::both_end_faces:
        return {face(width_), face(end_)};
      case fem::HeldSurface::low_end_face:
        return {face(end_)};
      case fem::HeldSurface::flange_face:
        return {line(0, outside_, 0, body_.flange->outside_radius)};
      case fem::HeldSurface::none:
        break;
    }
    return drawing_.teeth ? std::vector{line(0, outside_, width_, outside_)} : std::vector<AxialBox>();
  }

  /// A held line with the hatching of firm ground on its far side.
  [[nodiscard]] std::string ground(const AxialBox& line) const {
    constexpr double step = 7;
    const svg::Point a = page_.at(line.min()), b = page_.at(line.max());
    const svg::Point along = (b - a).normalized();
    const auto hatch = line.sizes().x() == 0 ? "l-6 6" : "l6 -6";
    std::string d;
    for (double s = 0; s <= (b - a).norm(); s += step) d += svg::through({a + s * along}) + hatch;
    const auto style = [](double width) { return fmt::format(R"(stroke="{}" stroke-width="{}")", held_colour, width); };
    return svg::line(a, b, style(3)) + svg::path(d, style(0.9));
  }

  /// Lengths along the axis below the section or above it, thicknesses at its left.
  [[nodiscard]] std::string dimensions() const {
    const auto above = [&](double from, double to, double r) {
      const double up = at(from, r).y() - page_.at(all_.max()).y() + 20;
      return dimension(at(from, r), at(to, r), up, mm_text(to - from));
    };
    const auto upright = [&](double z, double from, double to, double offset) {
      return dimension(at(z, from), at(z, to), offset, mm_text(to - from));
    };
    std::string text = dimension(at(0, all_.min().y()), at(width_, all_.min().y()), -22, "b = " + mm_text(width_));
    if (end_ < 0) text += above(end_, 0, outside_);
    text += upright(end_, body_.held_inner_radius > 0 ? body_.held_inner_radius : section_.ring.root_radius(), outside_,
                    22);
    if (body_.hoop) {
      const double begin = width_ - body_.hoop->width, top = outside_ + body_.hoop->thickness;
      text += above(begin, width_, top) + upright(begin, outside_, top, 14);
    }
    if (body_.flange) text += above(0, flange_width(), body_.flange->outside_radius);
    return text;
  }

  /// Diameters at the right, each at its height, moved apart where they would cover each other.
  [[nodiscard]] std::string diameters() const {
    std::vector<std::pair<double, std::string>> labels = {{section_.ring.tip_radius(), "tip"},
                                                          {section_.ring.root_radius(), "root"}};
    if (body_.held == fem::HeldSurface::both_end_faces) labels.emplace_back(body_.held_inner_radius, "clamped from");
    labels.emplace_back(outside_, "outside");
    if (body_.flange) labels.emplace_back(body_.flange->outside_radius, "flange");
    if (body_.hoop) labels.emplace_back(outside_ + body_.hoop->thickness, "hoop");
    double y = 1e9;
    std::string text;
    for (const auto& [radius, name] : labels) {
      const svg::Point p = at(all_.max().x(), radius);
      y = std::min(p.y(), y - line_height);
      text += svg::path(svg::through({p + svg::Point(2, 0), p + svg::Point(10, 0), {p.x() + 24, y}, {p.x() + 30, y}}),
                        R"(fill="none" stroke="#888" stroke-width="0.8")");
      text += svg::words({p.x() + 33, y + 4}, fmt::format("⌀ {} {}", mm_text(2 * radius), name));
    }
    return text;
  }

  /// Pins, bolts and teeth in words above the section.
  [[nodiscard]] std::string supports() const {
    svg::Point p = at(all_.min().x(), all_.max().y()) - svg::Point(0, 8);
    std::string text;
    for (const auto& c : drawing_.cylinders) {
      text += svg::words(p, fmt::format("{} {} ⌀ {}", c.angles.size(), c.name, mm_text(c.diameter)));
      p.y() -= line_height;
    }
    if (const auto& teeth = drawing_.teeth)
      text += svg::words(p - svg::Point(0, 6), fmt::format("{} {}", teeth->angles.size(), teeth->name));
    return text;
  }

  const AxialSection& section_;
  double width_, outside_;
  fem::RingBody body_;
  fem::RingDrawing drawing_;
  double end_;  // of the sleeve, at or below 0
  std::vector<std::pair<AxialBox, std::string>> blocks_{};
  AxialBox all_{};
  DrawingPage page_{.up = DrawingPage::Up::y};
};

}  // namespace

std::string to_svg(const AxialSection& section) { return AxialDrawing(section).svg(); }

}  // namespace annulus::app
