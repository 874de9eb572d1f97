#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "app/systems/planetary/report/stage_report_parts.h"

namespace annulus::app {

namespace {

bool is_at(const Csv& csv, const std::vector<double>& row, const PositionKey& at) {
  return row[csv.column("mesh_phase")] == at.mesh_phase &&
         static_cast<int>(row[csv.column("ring_tooth")]) == at.ring_tooth;
}

std::string place_text(const MeshResult& mesh, const PositionKey& at) {
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
  for (const auto& row : csv.rows) {
    if (!is_at(csv, row, at)) continue;
    const auto range = ranges[row[low]].range(0);
    for (const double z : {row[low], row[high]}) {
      series.x.push_back(z);
      series.y.push_back(row[load]);
      series.low.push_back(range.low);
      series.high.push_back(range.high);
    }
  }
  return series;
}

Blocks face_width(const RunResult& result) {
  Plot plot{.title = "Load over the face width",
            .x_label = "z, mm",
            .y_label = "line load, N/mm",
            .legend = true,
            .width = 900,
            .height = 340};
  RangeFinder range;
  range.add(0);
  std::size_t colour = 0;
  for (const auto& [name, mesh] : all_meshes(result)) {
    const std::size_t own = colour++;
    const auto worst = mesh->peak("face_load_factor");
    if (mesh->line_load.rows.empty() || !worst) continue;
    auto series = line_load_series(*mesh, worst->at);
    series.label = fmt::format("{} (KHβ {})", name, to_text(worst->value, 4));
    series.colour = own;
    range.add(series.high);
    plot.series.push_back(std::move(series));
  }
  if (plot.series.empty()) return {};
  plot.y_range = Range{0, range.range().high};
  return heading("Face width") +
         Pictures{{plot},
                  {},
                  phrase("Force per millimetre of face width, all tooth pairs together, at the nominal load: the line "
                         "at the position with the largest face load factor K{} (largest over mean line load, ISO "
                         "6336-1), the band over all positions. Meshes in which nothing changes along the face width "
                         "are left out.",
                         subscript("Hβ"))};
}

// ---- pressure on the flanks ----

struct Patch {
  Range z, roll;
  double pressure = 0;
};

/// The position to show: where the load is most uneven, else where the pressure is largest, away from tip edges if it
/// can be.
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

std::map<int, std::vector<Patch>> patches_at(const Csv& csv, const PositionKey& at) {
  const auto pair = csv.column("pair"), z_low = csv.column("z_low_mm"), z_high = csv.column("z_high_mm"),
             roll_low = csv.column("roll_low_mm"), roll_high = csv.column("roll_high_mm"),
             pressure = csv.column("pressure_MPa");
  std::map<int, std::vector<Patch>> pairs;
  for (const auto& row : csv.rows) {
    if (is_at(csv, row, at))
      pairs[static_cast<int>(row[pair])].push_back(
          {{row[z_low], row[z_high]}, {row[roll_low], row[roll_high]}, row[pressure]});
  }
  for (auto& [number, patches] : pairs) {
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
      return a.z.low != b.z.low ? a.z.low < b.z.low : a.roll.low < b.roll.low;
    });
  }
  return pairs;
}

double column_at(const MeshResult& mesh, const std::string& column, const PositionKey& at) {
  const auto& csv = mesh.positions;
  const auto value = csv.column(column), load = csv.column("load_N");
  for (const auto& row : csv.rows) {
    if (row[load] == mesh.table.loads()[mesh.nominal] && is_at(csv, row, at)) return row[value];
  }
  return NAN;
}

std::string pair_title(const MeshResult& mesh, int pair, const PositionKey& at) {
  return fmt::format("pair {}, {:.0f} % of the load", pair,
                     100 * column_at(mesh, fmt::format("pair{}_share", pair), at));
}

std::string pressure_title(const std::string& name, const MeshResult& mesh, const PositionKey& at) {
  const bool edge = column_at(mesh, "tip_edge_contact", at) != 0;
  return name + ", " + place_text(mesh, at) + (edge ? "; peak at a tip edge is singular" : "");
}

ColourMap pressure_map(const std::string& title, const MeshResult& mesh, const PositionKey& at,
                       const std::map<int, std::vector<Patch>>& pairs) {
  ColourMap map{.title = title,
                .x_label = "roll length of the planet, mm",
                .y_label = "z, mm",
                .value_label = "pressure, MPa",
                .height = 330};
  RangeFinder z, pressure;
  pressure.add(0);
  for (const auto& [number, patches] : pairs) {
    ColourMap::Panel panel{.title = pair_title(mesh, number, at)};
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
  if (!mesh.line_load.rows.empty()) {
    for (const auto* edge : {"z_low_mm", "z_high_mm"}) {
      for (const auto& row : mesh.line_load.rows) z.add(row[mesh.line_load.column(edge)]);
    }
  }
  map.y_range = z.range(0);
  map.values = pressure.range(0);
  return map;
}

/// Nothing changes along the face width: pressure over the roll length, as steps about the theoretical contact point.
Plot pressure_profile(const std::string& title, const MeshResult& mesh, const PositionKey& at,
                      const std::map<int, std::vector<Patch>>& pairs) {
  Plot plot{.title = title,
            .x_label = "roll length from the theoretical contact point, mm",
            .y_label = "pressure, MPa",
            .legend = true};
  for (const auto& [number, patches] : pairs) {
    const double centre = column_at(mesh, fmt::format("pair{}_roll_mm", number), at);
    Series series{.label = pair_title(mesh, number, at), .colour = plot.series.size()};
    const auto add = [&](double roll, double pressure) {
      series.x.push_back(roll - centre);
      series.y.push_back(pressure);
    };
    add(patches.front().roll.low, 0);
    double end = patches.front().roll.low;
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

Blocks pressures(const RunResult& result) {
  Blocks maps;
  std::vector<Picture> profiles;
  for (const auto& [name, mesh] : all_meshes(result)) {
    if (mesh->pressure.rows.empty()) continue;
    const auto at = shown_position(*mesh);
    if (!at) continue;
    const auto pairs = patches_at(mesh->pressure, *at);
    if (pairs.empty()) continue;
    std::set<double> slices;
    for (const auto& [number, patches] : pairs) {
      for (const auto& p : patches) slices.insert(p.z.low);
    }
    const auto title = pressure_title(name, *mesh, *at);
    if (slices.size() > 1) {
      maps += Pictures{{pressure_map(title, *mesh, *at, pairs)}};
    } else {
      profiles.push_back(pressure_profile(title, *mesh, *at, pairs));
    }
  }
  if (maps.empty() && profiles.empty()) return {};
  Blocks blocks = heading("Pressure on the flanks");
  if (!maps.empty())
    blocks += paragraph(
                  "Contact pressure of every tooth pair at the nominal load, over face width and roll length of the "
                  "planet (small at its root, large at its tip), at the position with the largest face load factor. "
                  "White: no contact.") +
              maps;
  if (!profiles.empty())
    blocks += Pictures{profiles,
                       {},
                       "Contact pressure of every tooth pair at the nominal load where nothing changes along the face "
                       "width, at the position with the largest pressure away from tip edges."};
  return blocks;
}

// ---- stress along roots and rim ----

struct StressLine {
  std::string mesh;
  std::size_t colour = 0;
  std::string place;
  std::vector<double> x, tangential, von_mises;
};

/// The curves of all meshes by their names ("planet root", "ring rim"), in the order of appearance.
std::vector<std::pair<std::string, std::vector<StressLine>>> stress_lines(const RunResult& result) {
  std::vector<std::pair<std::string, std::vector<StressLine>>> lists;
  std::size_t colour = 0;
  for (const auto& [mesh_name, mesh] : all_meshes(result)) {
    const std::size_t own = colour++;
    const auto& csv = mesh->stress;
    for (std::size_t c = 0; c < csv.header.size(); ++c) {
      const auto& curve_name = csv.header[c].second;
      StressLine line{.mesh = mesh_name, .colour = own, .place = {}, .x = {}, .tangential = {}, .von_mises = {}};
      std::vector<std::array<double, 3>> points;
      for (const auto& row : csv.rows) {
        if (static_cast<std::size_t>(row[csv.column("curve")]) != c + 1) continue;
        const double polar = row[csv.column("polar_angle_deg")];
        const double x = std::isfinite(polar) ? std::remainder(polar - row[csv.column("ring_angle_deg")], 360.0)
                                              : row[csv.column("arc_length_mm")];
        points.push_back({x, row[csv.column("tangential_MPa")], row[csv.column("von_mises_MPa")]});
        line.place =
            place_text(*mesh, {row[csv.column("mesh_phase")], static_cast<int>(row[csv.column("ring_tooth")])});
      }
      if (points.empty()) continue;
      std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
      for (const auto& p : points) {
        line.x.push_back(p[0]);
        line.tangential.push_back(p[1]);
        line.von_mises.push_back(p[2]);
      }
      auto found =
          std::find_if(lists.begin(), lists.end(), [&, key = curve_name](const auto& l) { return l.first == key; });
      if (found == lists.end()) found = lists.insert(lists.end(), {curve_name, {}});
      found->second.push_back(std::move(line));
    }
  }
  return lists;
}

Blocks stresses(const RunResult& result) {
  Blocks blocks;
  for (const auto& [name, lines] : stress_lines(result)) {
    const bool rim = name.ends_with("rim");
    const std::string body = name.substr(0, name.find(' '));
    Plot plot{.title = rim ? "Rim of the " + body + ", outside" : "Tooth root of the " + body,
              .x_label = rim ? "angle from the contact, °" : "arc length along the tooth space, mm",
              .y_label = "stress, MPa",
              .legend = true,
              .width = 900,
              .height = 340};
    std::string places;
    for (const auto& l : lines) {
      plot.series.push_back({.label = l.mesh, .x = l.x, .y = l.tangential, .colour = l.colour});
      plot.series.push_back({.label = {}, .x = l.x, .y = l.von_mises, .colour = l.colour, .dashed = true});
      places += (places.empty() ? "" : "; ") + l.mesh + ": " + l.place;
    }
    blocks += Pictures{{plot},
                       {},
                       std::string("Solid: stress along the surface, tension positive; dashed: von Mises. ") +
                           (rim ? "Around the whole circumference. "
                                : "From the form circle of the trailing to that of the leading flank. ") +
                           "Each at the position where its largest von Mises stress occurs (" + places + ")."};
  }
  return blocks.empty() ? blocks : heading("Stress") + blocks;
}

}  // namespace

Section contact_section(const RunResult& result) {
  return {"contact", "Face width, pressure, stress", face_width(result) + pressures(result) + stresses(result)};
}

}  // namespace annulus::app
