#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/drawings/mode.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/shared/element_words.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double felt = 0.5;  // participation from which a crossing counts as excited by the mesh

std::size_t kind_colour(const std::string& kind) {
  return kind.starts_with("rotational") ? 0 : kind.starts_with("translational") ? 1 : kind == "planet" ? 2 : 3;
}

/// Modes of one kind and one frequency.
struct Multiple {
  const StageModes::Mode* mode;
  std::size_t index;
  int count;
};

std::vector<Multiple> multiples(const StageModes& modes, const std::string& kind) {
  std::vector<Multiple> list;
  for (std::size_t i = 0; i < modes.list.size(); ++i) {
    const auto& mode = modes.list[i];
    if (mode.kind != kind) continue;
    if (!list.empty() && mode.frequency - list.back().mode->frequency <= 1e-6 * mode.frequency)
      ++list.back().count;
    else
      list.push_back({&mode, i, 1});
  }
  return list;
}

std::vector<std::string> kinds_of(const RunResult& result) {
  std::vector<std::string> kinds;
  for (const auto& [name, response] : responses_of(result)) {
    for (const auto& mode : response->modes.list)
      if (std::find(kinds.begin(), kinds.end(), mode.kind) == kinds.end()) kinds.push_back(mode.kind);
  }
  return kinds;
}

Text mode_cell(const StageModes& modes, const Multiple& m) {
  std::string text = fmt::format("{:.1f}", m.mode->frequency);
  if (m.mode->frequency_error > 0) text += " ± " + to_text(m.mode->frequency_error, 2);
  if (m.count > 1) text += fmt::format(" ×{}", m.count);
  if (m.mode->frequency == 0) return text + " " + muted("free rotation");
  const Eigen::Map<const Eigen::VectorXd> strain(m.mode->strain.data(),
                                                 static_cast<Eigen::Index>(m.mode->strain.size()));
  return text + " " +
         muted(fmt::format("{}, ζ {:.1f} %", strain_words(modes.groups, strain, 1), 100 * m.mode->damping_ratio));
}

PageTable modes_table(const RunResult& result) {
  const auto rings = responses_of(result);
  PageTable table{.head = {"kind"}};
  for (const auto& [name, response] : rings) table.head.emplace_back(name + ", Hz");
  for (const auto& kind : kinds_of(result)) {
    const auto first = table.rows.size();
    for (std::size_t c = 0; c < rings.size(); ++c) {
      const auto& modes = rings[c].second->modes;
      auto row = first;
      for (const auto& m : multiples(modes, kind)) {
        if (row == table.rows.size())
          table.rows.emplace_back(rings.size() + 1).front() = row == first ? kind : std::string();
        table.rows[row++][c + 1] = mode_cell(modes, m);
      }
    }
  }
  return table;
}

/// The member whose speed is the axis of the Campbell diagram, and that speed.
struct DriverSpeed {
  std::string member;
  double rpm = 0;
  [[nodiscard]] std::string column() const { return member + "_speed_rpm"; }
};

Plot campbell_plot(const std::string& name, const StageModes& modes, const DriverSpeed& driver) {
  const auto speed = column_values(modes.campbell, driver.column());
  const auto mesh = column_values(modes.campbell, "mesh_frequency_Hz");
  const auto orders = column_values(modes.critical_speeds, "mesh_order");
  const int highest = orders.empty() ? 1 : static_cast<int>(*std::max_element(orders.begin(), orders.end()));
  const double top = 1.08 * highest * mesh.back() / 1e3;
  Plot plot{.title = name,
            .x_label = driver.member + " speed, r/min",
            .y_label = "frequency, kHz",
            .x_range = Range{0, speed.back()},
            .y_range = Range{0, top},
            .height = 330};
  for (int h = 1; h <= highest; ++h) {
    const double end = h * mesh.back() / 1e3;
    plot.series.push_back(
        {.label = fmt::format("mesh order {}", h), .x = {0, speed.back()}, .y = {0, end}, .colour = 6, .dashed = true});
    // Beside the line, which rises to the right.
    plot.notes.push_back({0.985 * speed.back(), end, fmt::format("{}", h)});
  }
  for (std::size_t i = 0; i < modes.list.size(); ++i) {
    const auto frequency = column_values(modes.campbell, fmt::format("mode{}_Hz", i + 1), 1e99, 1e-3);
    if (*std::min_element(frequency.begin(), frequency.end()) > top) continue;
    plot.series.push_back(
        {.label = modes.list[i].kind, .x = speed, .y = frequency, .colour = kind_colour(modes.list[i].kind)});
  }
  Series critical{.label = "excited", .colour = 7, .style = Series::Style::dots};
  for (const auto& row : modes.critical_speeds.rows) {
    if (row[modes.critical_speeds.column("participation")] < felt) continue;
    critical.x.push_back(row[modes.critical_speeds.column(driver.column())]);
    critical.y.push_back(row[modes.critical_speeds.column("frequency_Hz")] / 1e3);
  }
  plot.series.push_back(std::move(critical));
  plot.series.push_back({.label = "operating speed", .x = {driver.rpm, driver.rpm}, .y = {0, top}, .colour = 4});
  return plot;
}

/// The excited crossings nearest to the operating speed.
Text critical_cell(const StageModes& modes, const DriverSpeed& driver) {
  const auto& csv = modes.critical_speeds;
  const auto frequency = csv.column("frequency_Hz"), order = csv.column("mesh_order"), mode = csv.column("mode"),
             participation = csv.column("participation"), speed = csv.column(driver.column());
  std::vector<const std::vector<double>*> rows;
  for (const auto& row : csv.rows) {
    // Members of a multiple mode meet an order together.
    const bool again = std::any_of(rows.begin(), rows.end(),
                                   [&](const auto* r) { return std::abs((*r)[speed] / row[speed] - 1) < 1e-6; });
    if (row[participation] >= felt && !again) rows.push_back(&row);
  }
  std::stable_sort(rows.begin(), rows.end(), [&](const auto* a, const auto* b) {
    return std::abs((*a)[speed] - driver.rpm) < std::abs((*b)[speed] - driver.rpm);
  });
  std::vector<Text> speeds;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, rows.size()); ++i) {
    const auto& row = *rows[i];
    const auto& kind = modes.list[static_cast<std::size_t>(row[mode]) - 1].kind;
    speeds.push_back(
        phrase("{:.0f} r/min {}", row[speed],
               muted(fmt::format("order {:.0f} with the {} mode at {:.0f} Hz", row[order], kind, row[frequency]))));
  }
  return speeds.empty() ? "none" : joined(speeds, line_break());
}

Blocks campbell_part(const RunResult& result) {
  const auto& point = result.geometry.operating_point;
  const DriverSpeed driver{to_string(point.driver), std::abs(point.flow.speed[point.driver]) / units::rpm};
  std::vector<Picture> pictures;
  PageTable table{.head = {"ring", "critical speeds nearest to the operating speed"}};
  for (const auto& [name, response] : responses_of(result)) {
    if (response->modes.campbell.rows.empty()) continue;
    pictures.emplace_back(campbell_plot(name, response->modes, driver));
    table.rows.push_back({name, critical_cell(response->modes, driver)});
  }
  if (pictures.empty()) return {};
  Legend legend;
  for (const auto& kind : kinds_of(result)) legend.emplace_back(kind, kind_colour(kind));
  legend.insert(legend.end(), {{"operating speed", 4}, {"mesh orders 1, 2, ...", 6}, {"critical speeds", 7}});
  return heading("Campbell diagram") +
         Pictures{pictures, legend,
                  "Natural frequencies over speed in the frame of the carrier, with gyroscopic and centripetal terms "
                  "and without damping. A dot marks a mesh order that excites the mode at the crossing. At the other "
                  "crossings the phases between the planets cancel the excitation; errors leave a part of it."} +
         table;
}

ModeDrawing drawing(const StageModes& modes, const geometry::PlanetarySet& set, const Multiple& m) {
  const auto& dofs = modes.shapes.columns;
  const auto find = [&](const std::string& dof) { return std::find(dofs.begin(), dofs.end(), dof); };
  const auto exists = [&](const std::string& dof) { return find(dof) != dofs.end(); };
  const auto value = [&](const std::string& dof) {
    return exists(dof) ? modes.shapes.rows[m.index][static_cast<std::size_t>(find(dof) - dofs.begin())] : 0.0;
  };
  const auto motion = [&](const std::string& body) {
    return ModeDrawing::Motion{value(body + "_x"), value(body + "_y"), value(body + "_u")};
  };
  ModeDrawing d{.title = fmt::format("{}, {:.0f} Hz", m.mode->kind, m.mode->frequency),
                .sun_radius = set.sun().base_radius(),
                .planet_radius = set.planet().base_radius(),
                .ring_radius = set.ring().base_radius(),
                .centre_distance = set.centre_distance(),
                .sun = motion("sun"),
                .ring = motion("ring"),
                .carrier = motion("carrier")};
  for (int n = 0; n < set.planets(); ++n) {
    const auto name = fmt::format("planet{}", n + 1);
    const double phi = set.planet_angle(n), c = std::cos(phi), s = std::sin(phi);
    d.planet_angles.push_back(phi);
    auto planet = motion(name);
    // A planet on a rigid bearing rides on the carrier.
    if (!exists(name + "_x")) planet.x = c * d.carrier.x + s * d.carrier.y;
    if (!exists(name + "_y")) planet.y = -s * d.carrier.x + c * d.carrier.y + d.carrier.u;
    d.planets.push_back(planet);
  }
  return d;
}

Blocks shapes_part(const RunResult& result) {
  const auto [name, response] = responses_of(result).front();  // a copy: the list ends here
  const auto& set = result.geometry.rings.front().set;
  std::vector<Picture> pictures;
  for (const auto& kind : kinds_of(result)) {
    int drawn = 0;
    for (const auto& m : multiples(response->modes, kind)) {
      if (m.mode->frequency == 0 || drawn == 2) continue;
      pictures.emplace_back(Drawing{to_svg(drawing(response->modes, set, m))});
      ++drawn;
    }
  }
  if (pictures.empty()) return {};
  return heading("Mode shapes") +
         Pictures{pictures,
                  {{"sun", 0}, {"planets", 1}, {"ring", 2}, {"carrier", 6}},
                  fmt::format("The two lowest modes of each kind, for ring '{}'. Grey: at rest. Displacements are not "
                              "to scale. Point at a mode to animate it. Of each pair or multiple, one mode is shown.",
                              name),
                  Pictures::Layout::shapes};
}

}  // namespace

Section modes_section(const RunResult& result) {
  Section section{"modes", "Natural frequencies"};
  if (!kinds_of(result).empty())
    section.blocks =
        paragraph(fmt::format("Natural frequencies without rotation, with the mean tangent mesh stiffness and all "
                              "meshes in contact. Beside each frequency: the elements with most of the strain energy, "
                              "and the damping ratio ζ at the operating speed. The mesh frequency is {:.1f} Hz.",
                              result.geometry.operating_point.mesh_frequency)) +
        modes_table(result) + shapes_part(result) + campbell_part(result);
  return section;
}

}  // namespace annulus::app
