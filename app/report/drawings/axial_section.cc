#include "app/report/drawings/axial_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/drawing_page.h"
#include "app/report/plot/frame.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr int axial_width = 560;
constexpr double axial_left = 70, axial_right = 150, axial_top = 70;

/// A rectangle of the section: along the axis, and from radius to radius, m.
struct AxialBlock {
  double z_low, z_high, r_low, r_high;
};

/// The ring and what belongs to it, as rectangles.
struct AxialBlocks {
  AxialBlock rim, teeth;
  std::vector<AxialBlock> more{};  ///< sleeve, hoop, flange
  std::vector<AxialBlock> held{};  ///< lines: no extent one way
  std::vector<AxialBlock> pins{};
};

AxialBlocks blocks_of(const AxialSection& section) {
  const auto& ring = section.ring;
  const double width = ring.parameters().face_width, outside = section.outside_radius;
  AxialBlocks blocks{{0, width, ring.root_radius(), outside}, {0, width, ring.tip_radius(), ring.root_radius()}};
  const auto body = section.structure.body(outside);
  const auto drawing = section.structure.drawing(outside);
  const double end = body.sleeve ? -body.sleeve->length : 0;
  if (end < 0) blocks.more.push_back({end, 0, body.held_inner_radius, outside});
  if (body.hoop) blocks.more.push_back({width - body.hoop->width, width, outside, outside + body.hoop->thickness});
  if (body.flange)
    blocks.more.push_back({0, std::min(body.flange->width, width), outside, body.flange->outside_radius});
  switch (body.held) {
    case fem::HeldSurface::outside:
      blocks.held.push_back({0, width, outside, outside});
      break;
    case fem::HeldSurface::both_end_faces:
      blocks.held.push_back({width, width, body.held_inner_radius, outside});
      [[fallthrough]];
    case fem::HeldSurface::low_end_face:
      blocks.held.push_back({end, end, body.held_inner_radius, outside});
      break;
    case fem::HeldSurface::flange_face:
      blocks.held.push_back({0, 0, outside, body.flange->outside_radius});
      break;
    case fem::HeldSurface::none:
      if (drawing.teeth) blocks.held.push_back({0, width, outside, outside});
      break;
  }
  for (const auto& cylinders : drawing.cylinders)
    blocks.pins.push_back(
        {0, width, cylinders.circle_radius - cylinders.diameter / 2, cylinders.circle_radius + cylinders.diameter / 2});
  return blocks;
}

AxialBlock bounds(const AxialBlocks& blocks) {
  AxialBlock all = blocks.rim;
  for (const auto* list : {&blocks.more, &blocks.pins})
    for (const auto& b : *list)
      all = {std::min(all.z_low, b.z_low), std::max(all.z_high, b.z_high), all.r_low, std::max(all.r_high, b.r_high)};
  all.r_low = blocks.teeth.r_low;
  return all;
}

/// Axial coordinate to the right, radius upwards.
struct AxialPage {
  double scale, x0, y0;
  [[nodiscard]] Eigen::Vector2d at(double z, double r) const { return {x0 + scale * z, y0 - scale * r}; }
};

std::string drawn(const AxialPage& page, const AxialBlock& block, const char* style) {
  const Eigen::Vector2d corner = page.at(block.z_low, block.r_high);
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>", corner.x(), corner.y(),
                     page.scale * (block.z_high - block.z_low), page.scale * (block.r_high - block.r_low), style);
}

/// A held line with the hatching of firm ground on its far side.
std::string ground(const AxialPage& page, const AxialBlock& line) {
  constexpr double step = 7;
  const Eigen::Vector2d a = page.at(line.z_low, line.r_low), b = page.at(line.z_high, line.r_high);
  const bool upright = line.z_low == line.z_high;
  const double length = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length;
  std::string d;
  for (double s = 0; s <= length; s += step) {
    const Eigen::Vector2d p = a + s * along;
    d += fmt::format("M{:.1f} {:.1f}l{} {}", p.x(), p.y(), upright ? -6 : 6, upright ? 6 : -6);
  }
  return fmt::format(
      "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" stroke=\"{}\" stroke-width=\"3\"/><path d=\"{}\" stroke=\"{}\" "
      "stroke-width=\"0.9\"/>",
      a.x(), a.y(), b.x(), b.y(), held_colour, d, held_colour);
}

/// Lengths along the axis below the section or above it, thicknesses at its left.
std::string dimensions(const AxialPage& page, const AxialSection& section, const AxialBlock& all) {
  const double width = section.ring.parameters().face_width, outside = section.outside_radius;
  const auto below = [&](double from, double to, const char* name) {
    const Eigen::Vector2d a = page.at(from, all.r_low);
    return dimension(a, page.at(to, all.r_low), -22, name + mm_text(to - from));
  };
  const auto above = [&](double from, double to, double r, const char* name) {
    const Eigen::Vector2d a = page.at(from, r);
    return dimension(a, page.at(to, r), a.y() - page.at(0, all.r_high).y() + 20, name + mm_text(to - from));
  };
  const auto upright = [&](double z, double from, double to, double offset) {
    return dimension(page.at(z, from), page.at(z, to), offset, mm_text(to - from));
  };
  std::string svg = below(0, width, "b = ");
  const auto body = section.structure.body(outside);
  const double end = body.sleeve ? -body.sleeve->length : 0;
  if (end < 0) svg += above(end, 0, outside, "");
  svg += upright(end, body.held_inner_radius > 0 ? body.held_inner_radius : section.ring.root_radius(), outside, 22);
  if (body.hoop) {
    svg += above(width - body.hoop->width, width, outside + body.hoop->thickness, "");
    svg += upright(width - body.hoop->width, outside, outside + body.hoop->thickness, 14);
  }
  if (body.flange) svg += above(0, std::min(body.flange->width, width), body.flange->outside_radius, "");
  return svg;
}

/// Diameters at the right, each at its height, moved apart where they would cover each other.
std::string diameters(const AxialPage& page, const AxialSection& section, const AxialBlock& all) {
  struct Label {
    double radius;
    std::string text;
  };
  std::vector<Label> labels = {
      {section.ring.tip_radius(), "tip"}, {section.ring.root_radius(), "root"}, {section.outside_radius, "outside"}};
  const auto body = section.structure.body(section.outside_radius);
  const auto drawing = section.structure.drawing(section.outside_radius);
  if (body.held == fem::HeldSurface::both_end_faces)
    labels.insert(labels.end() - 1, {body.held_inner_radius, "clamped from"});
  if (body.flange) labels.push_back({body.flange->outside_radius, "flange"});
  if (body.hoop) labels.push_back({section.outside_radius + body.hoop->thickness, "hoop"});
  constexpr double line = 15;
  double last = 1e9;
  std::string svg;
  for (const auto& label : labels) {
    const Eigen::Vector2d at = page.at(all.z_high, label.radius);
    const double y = std::min(at.y(), last - line);
    last = y;
    svg += fmt::format(
        "<path d=\"M{:.1f} {:.1f}h8L{:.1f} {:.1f}h6\" fill=\"none\" stroke=\"#888\" stroke-width=\"0.8\"/><text "
        "x=\"{:.1f}\" y=\"{:.1f}\">⌀ {} {}</text>",
        at.x() + 2, at.y(), at.x() + 24, y, at.x() + 33, y + 4, mm_text(2 * label.radius), label.text);
  }
  const Eigen::Vector2d corner = page.at(all.z_low, all.r_high);
  double above = 8;
  for (const auto& cylinders : drawing.cylinders) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{} {} ⌀ {}</text>", corner.x(), corner.y() - above,
                       cylinders.angles.size(), cylinders.name, mm_text(cylinders.diameter));
    above += line;
  }
  if (drawing.teeth)
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{} {}</text>", corner.x(), corner.y() - 14,
                       drawing.teeth->angles.size(), drawing.teeth->name);
  return svg;
}

}  // namespace

std::string to_svg(const AxialSection& section) {
  constexpr double tallest = 420;
  const auto blocks = blocks_of(section);
  const auto all = bounds(blocks);
  const double scale =
      std::min((axial_width - axial_left - axial_right) / (all.z_high - all.z_low), tallest / (all.r_high - all.r_low));
  const AxialPage page{scale, axial_left - scale * all.z_low, axial_top + scale * all.r_high};
  const double bottom = page.at(0, all.r_low).y();
  std::string svg = open_svg(section.title, axial_width, static_cast<int>(bottom + 78), 14.0, section.label);
  constexpr const char* edge = "stroke=\"#2c3a48\" stroke-width=\"0.9\"";
  const auto filled = [&](const char* fill) { return fmt::format("fill=\"{}\" {}", fill, edge); };
  for (const auto& block : blocks.more) svg += drawn(page, block, filled(wheel_fill).c_str());
  svg += drawn(page, blocks.rim, filled(wheel_fill).c_str());
  svg += drawn(page, blocks.teeth, filled("#fbf1e7").c_str());
  for (const auto& line : blocks.held) svg += ground(page, line);
  for (const auto& pin : blocks.pins)
    svg += drawn(page, pin, "fill=\"#D55E00\" fill-opacity=\"0.6\" stroke=\"#7a3600\" stroke-width=\"0.9\"");
  svg += dimensions(page, section, all) + diameters(page, section, all);
  svg += scale_bar({14, bottom + 58}, scale, 0.3 * axial_width);
  return svg + "</svg>";
}

}  // namespace annulus::app
