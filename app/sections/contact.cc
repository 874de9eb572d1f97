#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "app/sections/report_parts.h"
#include "core/not_known.h"

namespace annulus::app {

namespace {

/// The rows of a table at one position, by the names of their columns.
class RowsAt {
 public:
  RowsAt(const Csv& csv, const PositionKey& at) : csv_(csv) {
    for (const auto& row : csv.rows)
      if (row[csv.column("mesh_phase")] == at.mesh_phase &&
          static_cast<int>(row[csv.column("ring_tooth")]) == at.ring_tooth)
        rows_.push_back(&row);
  }
  [[nodiscard]] const std::vector<const std::vector<double>*>& rows() const { return rows_; }
  [[nodiscard]] double value(const std::vector<double>* row, const std::string& column) const {
    return (*row)[csv_.column(column)];
  }
  /// The value of the row at this load; NaN without one.
  [[nodiscard]] double at_load(double load, const std::string& column) const {
    for (const auto* row : rows_)
      if (value(row, "load_N") == load) return value(row, column);
    return not_known;
  }

 private:
  const Csv& csv_;
  std::vector<const std::vector<double>*> rows_;
};

std::string position_text(const MeshResult& mesh, const PositionKey& at) {
  const std::string tooth = mesh.table.positions() > 1 ? fmt::format(", ring tooth {}", at.ring_tooth) : "";
  return fmt::format("mesh phase {}", to_text(at.mesh_phase, 4)) + tooth;
}

// ---- load over the face width ----

/// Line load of one position as a step line, and its range over all positions as a band.
Series line_load_series(const MeshResult& mesh, const PositionKey& at) {
  const auto& csv = mesh.line_load;
  const auto low = csv.column("z_low_mm"), high = csv.column("z_high_mm"), load = csv.column("line_load_N_per_mm");
  std::map<double, RangeFinder> ranges;  // by the slice's lower edge
  for (const auto& row : csv.rows) ranges[row[low]].add(row[load]);
  Series series;
  const RowsAt shown(csv, at);
  for (const auto* row : shown.rows()) {
    const auto range = ranges[(*row)[low]].range(0);
    for (const double z : {(*row)[low], (*row)[high]}) {
      series.x.push_back(z);
      series.y.push_back((*row)[load]);
      series.low.push_back(range.low);
      series.high.push_back(range.high);
    }
  }
  return series;
}

Blocks face_width(const NamedMeshes& meshes) {
  Plot plot = wide_plot("Load over the face width", "z, mm", "line load, N/mm", 340);
  RangeFinder range;
  range.add(0);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto& [name, mesh] = meshes[i];
    const auto worst = mesh->peak("face_load_factor");
    if (mesh->line_load.rows.empty() || !worst) continue;
    auto series = line_load_series(*mesh, worst->at);
    const auto factor = mesh->face_load_factor();
    series.label = fmt::format("{} (KHβ {})", name,
                               factor ? measured(factor->value, factor->value * factor->error_relative) : "–");
    series.colour = i;
    range.add(series.high);
    plot.series.push_back(std::move(series));
  }
  if (plot.series.empty()) return {};
  plot.y_range = Range{0, range.range().high};
  return heading("Face width") +
         Pictures{{plot},
                  {},
                  phrase("Force per millimetre of face width at the nominal load, summed over all tooth pairs. Line: "
                         "position with the largest face load factor K{} (largest over mean line load, ISO 6336-1). "
                         "Band: range over all positions. Meshes without variation along the face width are left out.",
                         subscript("Hβ"))};
}

// ---- pressure on the flanks ----

struct Patch {
  Range z, roll;
  double pressure = 0;
};
using PairPatches = std::map<int, std::vector<Patch>>;

/// A mesh at the position that is shown.
struct ShownMesh {
  const MeshResult& mesh;
  PositionKey at;
  RowsAt positions;
  std::string title;
  PairPatches pairs;

  [[nodiscard]] double value(const std::string& column) const {
    return positions.at_load(mesh.table.loads()[mesh.nominal], column);
  }
  [[nodiscard]] std::string pair_title(int pair) const {
    return fmt::format("pair {}, {:.0f} % of the load", pair, 100 * value(fmt::format("pair{}_share", pair)));
  }
};

/// Where the load is most uneven, else where the pressure is largest, away from tip edges if it can be.
std::optional<PositionKey> shown_position(const MeshResult& mesh) {
  if (const auto worst = mesh.peak("face_load_factor")) return worst->at;
  const auto& csv = mesh.positions;
  const auto load = csv.column("load_N"), phase = csv.column("mesh_phase"), tooth = csv.column("ring_tooth"),
             edge = csv.column("tip_edge_contact"), pressure = csv.column("max_pressure_MPa");
  const std::vector<double>* best = nullptr;
  const auto rank = [&](const std::vector<double>& row) { return std::pair(row[edge] == 0, row[pressure]); };
  for (const auto& row : csv.rows) {
    if (row[load] != mesh.table.loads()[mesh.nominal] || row[phase] >= 1) continue;
    if (!best || rank(row) > rank(*best)) best = &row;
  }
  if (!best) return std::nullopt;
  return PositionKey{(*best)[phase], static_cast<int>((*best)[tooth])};
}

PairPatches patches_at(const Csv& csv, const PositionKey& at) {
  const RowsAt table(csv, at);
  PairPatches pairs;
  for (const auto* row : table.rows())
    pairs[static_cast<int>(table.value(row, "pair"))].push_back(
        {{table.value(row, "z_low_mm"), table.value(row, "z_high_mm")},
         {table.value(row, "roll_low_mm"), table.value(row, "roll_high_mm")},
         table.value(row, "pressure_MPa")});
  for (auto& [number, patches] : pairs)
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
      return std::pair(a.z.low, a.roll.low) < std::pair(b.z.low, b.roll.low);
    });
  return pairs;
}

ColourMap pressure_map(const ShownMesh& shown) {
  ColourMap map{.title = shown.title,
                .x_label = fmt::format("roll length of the {}, mm", shown.mesh.model.pinion_body),
                .y_label = "z, mm",
                .value_label = "pressure, MPa",
                .height = 330};
  RangeFinder z, pressure;
  pressure.add(0);
  for (const auto& [number, patches] : shown.pairs) {
    ColourMap::Panel panel{.title = shown.pair_title(number)};
    RangeFinder roll;
    for (const auto& p : patches) {
      panel.cells.push_back({.x = p.roll, .y = p.z, .value = p.pressure});
      z.add({p.z.low, p.z.high});
      roll.add({p.roll.low, p.roll.high});
      pressure.add(p.pressure);
    }
    panel.x_range = roll.range(0.15);
    map.panels.push_back(std::move(panel));
  }
  // The whole face width, not only the part in contact.
  if (!shown.mesh.line_load.rows.empty())
    for (const auto* edge : {"z_low_mm", "z_high_mm"}) z.add(column_values(shown.mesh.line_load, edge));
  map.y_range = z.range(0);
  map.values = pressure.range(0);
  return map;
}

/// Nothing changes along the face width: pressure over the roll length, as steps about the theoretical contact point.
Plot pressure_profile(const ShownMesh& shown) {
  Plot plot{.title = shown.title,
            .x_label = "roll length from the theoretical contact point, mm",
            .y_label = "pressure, MPa",
            .legend = true};
  for (const auto& [number, patches] : shown.pairs) {
    const double centre = shown.value(fmt::format("pair{}_roll_mm", number));
    Series series{.label = shown.pair_title(number), .colour = plot.series.size()};
    const auto add = [&](double roll, double pressure) {
      series.x.push_back(roll - centre);
      series.y.push_back(pressure);
    };
    double end = patches.front().roll.low;
    add(end, 0);
    for (const auto& p : patches) {
      if (p.roll.low > end + 1e-9) {  // no pressure between pieces apart
        add(end, 0);
        add(p.roll.low, 0);
      }
      add(p.roll.low, p.pressure);
      add(p.roll.high, p.pressure);
      end = p.roll.high;
    }
    add(end, 0);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Blocks pressures(const NamedMeshes& meshes) {
  Blocks maps;
  std::vector<Picture> profiles;
  for (const auto& [name, mesh] : meshes) {
    const auto at = mesh->pressure.rows.empty() ? std::nullopt : shown_position(*mesh);
    if (!at) continue;
    ShownMesh shown{
        *mesh, *at, {mesh->positions, *at}, name + ", " + position_text(*mesh, *at), patches_at(mesh->pressure, *at)};
    if (shown.pairs.empty()) continue;
    if (shown.value("tip_edge_contact") != 0) shown.title += "; peak at a tip edge is singular";
    std::set<double> slices;
    for (const auto& [number, patches] : shown.pairs)
      for (const auto& p : patches) slices.insert(p.z.low);
    if (slices.size() > 1)
      maps += Pictures{{pressure_map(shown)}};
    else
      profiles.emplace_back(pressure_profile(shown));
  }
  if (maps.empty() && profiles.empty()) return {};
  Blocks blocks = heading("Pressure on the flanks");
  if (!maps.empty())
    blocks += paragraph(
                  "Contact pressure of every tooth pair at the nominal load, at the position with the largest face "
                  "load factor. Axes: roll length (small at the root, large at the tip) and face width. "
                  "White: no contact.") +
              maps;
  if (!profiles.empty())
    blocks += Pictures{profiles,
                       {},
                       "Contact pressure of every tooth pair at the nominal load, for meshes without variation along "
                       "the face width. The position is that with the largest pressure away from tip edges."};
  return blocks;
}

// ---- stress along roots and rim ----

/// The curves of all meshes with one name ("planet root", "ring rim").
struct StressPlot {
  std::vector<Series> series;
  std::string positions;
  bool of_pinion = false;  ///< whose rim is its bore
};

void add_stress(StressPlot& plot, const std::string& name, const MeshResult& mesh, std::size_t curve,
                std::size_t colour) {
  const auto& csv = mesh.stress;
  const auto column = [&](const std::vector<double>& row, const char* of) { return row[csv.column(of)]; };
  std::vector<std::array<double, 3>> points;
  PositionKey at;
  for (const auto& row : csv.rows) {
    if (static_cast<std::size_t>(column(row, "curve")) != curve + 1) continue;
    const double polar = column(row, "polar_angle_deg");
    const double x = std::isfinite(polar) ? std::remainder(polar - column(row, "ring_angle_deg"), 360.0)
                                          : column(row, "arc_length_mm");
    points.push_back({x, column(row, "tangential_MPa"), column(row, "von_mises_MPa")});
    at = {column(row, "mesh_phase"), static_cast<int>(column(row, "ring_tooth"))};
  }
  if (points.empty()) return;
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  Series tangential{.label = name, .colour = colour}, von_mises{.colour = colour, .dashed = true};
  for (const auto& [x, along, mises] : points) {
    tangential.x.push_back(x);
    tangential.y.push_back(along);
    von_mises.x.push_back(x);
    von_mises.y.push_back(mises);
  }
  plot.series.insert(plot.series.end(), {tangential, von_mises});
  plot.positions += (plot.positions.empty() ? "" : "; ") + name + ": " + position_text(mesh, at);
}

Blocks stresses(const NamedMeshes& meshes) {
  std::vector<std::string> names;  // in the order of appearance
  std::map<std::string, StressPlot> plots;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto& header = meshes[i].second->stress.header;
    for (std::size_t c = 0; c < header.size(); ++c) {
      auto& plot = plots[header[c].second];
      plot.of_pinion = header[c].second.starts_with(meshes[i].second->model.pinion_body + " ");
      add_stress(plot, meshes[i].first, *meshes[i].second, c, i);
      if (std::find(names.begin(), names.end(), header[c].second) == names.end()) names.push_back(header[c].second);
    }
  }
  Blocks blocks;
  for (const auto& name : names) {
    const auto& [series, positions, of_pinion] = plots[name];
    if (series.empty()) continue;
    const bool rim = name.ends_with("rim");
    const std::string body = name.substr(0, name.find(' '));
    Plot plot =
        wide_plot(rim ? "Rim of the " + body + (of_pinion ? ", bore" : ", outside") : "Tooth root of the " + body,
                  rim ? "angle from the contact, °" : "arc length along the tooth space, mm", "stress, MPa", 340);
    plot.series = series;
    blocks += Pictures{{plot},
                       {},
                       std::string("Solid: stress along the surface, tension positive. Dashed: von Mises stress. ") +
                           (rim ? "Around the whole circumference. "
                                : "Range: from the form circle of the trailing flank to that of the leading flank. ") +
                           "Each curve is at the position with its largest von Mises stress (" + positions + ")."};
  }
  return blocks.empty() ? blocks : heading("Stress") + blocks;
}

}  // namespace

Section contact_section(const NamedMeshes& meshes) {
  return {
      "contact", "Face width, pressure, stress",
      face_width(meshes) + pressures(meshes) + stresses(meshes) + stresses_by_load(meshes) + beside_iso_6336(meshes)};
}

}  // namespace annulus::app
