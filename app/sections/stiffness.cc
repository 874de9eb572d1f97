#include <algorithm>
#include <cmath>
#include <map>

#include "app/sections/report_parts.h"

namespace annulus::app {

namespace {

/// A column of stiffness tables as plots show it.
struct TableColumn {
  double StiffnessEntry::*value;
  double scale;  ///< from SI
};
constexpr TableColumn secant{&StiffnessEntry::stiffness_secant, 1e-6}, transmission_error{&StiffnessEntry::lte, 1e6};

/// Meshes of one kind, as the plots that belong together show them, with their colours.
using MeshGroup = std::vector<std::size_t>;

std::vector<MeshGroup> groups_of(const NamedMeshes& meshes) {
  std::vector<MeshGroup> groups;
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto [at, added] = known.emplace(meshes[i].second->model.mesh, groups.size());
    if (added) groups.emplace_back();
    groups[at->second].push_back(i);
  }
  return groups;
}

/// Over the mesh cycles at the nominal load: the periodic curve that the dynamics use with the estimated error around
/// it, and the solved positions. A prescribed wave is sampled densely already, and a rectangular one must not be
/// rounded.
std::vector<Series> cycle_series(const std::string& name, const MeshResult& mesh, const TableColumn& column,
                                 std::size_t colour) {
  const auto& table = mesh.table;
  const bool single = table.positions() == 1;
  const int phases = table.phases(), total = phases * table.positions();
  const int pieces = mesh.model.fidelity == "prescribed" ? 1 : single ? 10 : 4;
  Series solved{.colour = colour, .style = Series::Style::dots};
  std::vector<double> error;
  for (int i = 0; i < total; ++i) {
    const auto& e = table.at(i / phases, i % phases, static_cast<int>(mesh.nominal));
    solved.x.push_back(static_cast<double>(i) / phases);
    solved.y.push_back(column.scale * (e.*column.value));
    error.push_back(e.error_relative);
  }
  const PeriodicCurve through(solved.y, phases);
  Series curve{.label = name, .colour = colour};
  for (int i = 0; i <= total * pieces; ++i) {
    const double cycle = static_cast<double>(i) / (phases * pieces);
    const double value = pieces == 1 ? solved.y[static_cast<std::size_t>(i % total)] : through(cycle);
    const double e = error[static_cast<std::size_t>(((i + pieces / 2) / pieces) % total)];
    curve.x.push_back(cycle);
    curve.y.push_back(value);
    curve.low.push_back(value * (1 - e));
    curve.high.push_back(value * (1 + e));
  }
  if (pieces == 1 || !single) return {curve};
  return {curve, solved};
}

/// The series about the mean of the first, without bands.
std::vector<Series> about_mean(std::vector<Series> list) {
  const auto& y = list.front().y;
  double mean = 0;
  for (std::size_t i = 0; i + 1 < y.size(); ++i) mean += y[i] / static_cast<double>(y.size() - 1);
  for (auto& series : list) {
    for (auto& v : series.y) v -= mean;
    series.low.clear();
    series.high.clear();
  }
  return list;
}

std::string cycle_label(const MeshResult& mesh) {
  return mesh.table.positions() > 1 ? "ring teeth passed (mesh cycles)" : "mesh cycle";
}

enum class About { zero, mean };
/// One plot per mesh; those of one kind on one scale.
Pictures per_mesh(const NamedMeshes& meshes, const char* y_label, const TableColumn& column, About about,
                  const Text& caption) {
  Pictures pictures{.caption = caption};
  for (const auto& group : groups_of(meshes)) {
    std::vector<Plot> plots;
    for (const auto i : group) {
      const auto& [name, mesh] = meshes[i];
      if (!mesh->model.computed() && about == About::mean) continue;
      auto series = cycle_series(name, *mesh, column, i);
      plots.push_back({.title = name,
                       .x_label = cycle_label(*mesh),
                       .y_label = y_label,
                       .series = about == About::mean ? about_mean(series) : series});
    }
    for (auto& picture : on_one_scale(std::move(plots))) pictures.list.push_back(std::move(picture));
  }
  return pictures;
}

/// Meshes of one kind in one plot, those that repeat earlier continued over the longest period.
Blocks overlays(const NamedMeshes& meshes) {
  Pictures pictures{.caption = "Meshes with a shorter period are continued over the longest period."};
  for (const auto& group : groups_of(meshes)) {
    if (group.size() == 1) continue;
    int longest = 1;
    for (const auto i : group) longest = std::max(longest, meshes[i].second->table.positions());
    Plot plot = wide_plot("Stiffness (secant), " + meshes[group.front()].second->model.mesh + " meshes",
                          longest > 1 ? "ring teeth passed (mesh cycles)" : "mesh cycle", "N/µm");
    std::replace(plot.title.begin(), plot.title.end(), '_', ' ');
    for (const auto i : group) {
      const auto& [name, mesh] = meshes[i];
      const auto once = cycle_series(name, *mesh, secant, i).front();
      Series series{.label = name, .colour = i};
      for (double x = 0; x < longest; x += mesh->table.positions())
        for (std::size_t k = 0; k < once.x.size() && x + once.x[k] <= longest + 1e-9; ++k) {
          series.x.push_back(x + once.x[k]);
          series.y.push_back(once.y[k]);
        }
      plot.series.push_back(std::move(series));
    }
    pictures.list.emplace_back(std::move(plot));
  }
  return pictures.list.empty() ? Blocks() : Blocks(pictures);
}

Blocks over_load(const NamedMeshes& meshes) {
  Plot plot = wide_plot("Mean mesh stiffness over load", "mesh force, kN", "N/µm");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto& table = meshes[i].second->table;
    if (table.loads().size() < 2) continue;
    for (const bool tangent : {false, true}) {
      Series series{.label = meshes[i].first + (tangent ? ", tangent" : ", secant"), .colour = i, .dashed = tangent};
      for (std::size_t load = 0; load < table.loads().size(); ++load) {
        series.x.push_back(table.loads()[load] / 1e3);
        series.y.push_back(mean_at_load(
            table, load, tangent ? &StiffnessEntry::stiffness_tangent : &StiffnessEntry::stiffness_secant));
      }
      plot.series.push_back(std::move(series));
    }
  }
  if (plot.series.empty()) return {};
  return Pictures{{plot},
                  {},
                  "Secant: force over deflection. Tangent: slope of the force over the deflection; it is the stiffness "
                  "for small vibrations."};
}

Plot shares_plot(const std::string& title, const MeshResult& mesh, std::size_t colour) {
  const auto& csv = mesh.positions;
  Series series{.label = title, .colour = colour, .style = Series::Style::dots};
  const auto load = csv.column("load_N");
  for (const auto& row : csv.rows) {
    if (row[load] != mesh.table.loads()[mesh.nominal]) continue;
    for (std::size_t c = 0; c + 1 < csv.columns.size(); ++c) {
      if (!csv.columns[c].ends_with("_roll_mm") || !std::isfinite(row[c])) continue;
      series.x.push_back(row[c]);
      series.y.push_back(row[c + 1]);
    }
  }
  return {.title = title,
          .x_label = fmt::format("roll length on the {}'s flank, mm", mesh.model.pinion_body),
          .y_label = "share of the mesh force",
          .y_range = Range{-0.03, 1.05},
          .series = {series}};
}

Blocks load_shares(const NamedMeshes& meshes) {
  std::vector<Picture> plots;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (!meshes[i].second->positions.rows.empty())
      plots.emplace_back(shares_plot(meshes[i].first, *meshes[i].second, i));
  if (plots.empty()) return {};
  return heading("Load shares of the tooth pairs") +
         Pictures{plots,
                  {},
                  "Load share of one tooth pair from the root to the tip of the gear that the axis names. Deflection "
                  "brings teeth into "
                  "contact early and separates them late. The share then falls to zero outside the theoretical path of "
                  "contact."};
}

}  // namespace

double mean_at_load(const StiffnessTable& table, std::size_t load, double StiffnessEntry::*stiffness) {
  double sum = 0;
  for (int p = 0; p < table.positions(); ++p)
    for (int k = 0; k < table.phases(); ++k) sum += table.at(p, k, static_cast<int>(load)).*stiffness / 1e6;
  return sum / (table.positions() * table.phases());
}

Blocks stiffness_blocks(const NamedMeshes& meshes) {
  Blocks blocks;
  const auto moved = per_mesh(meshes, "transmission error – mean, µm", transmission_error, About::mean,
                              "The same about its mean. This variation excites vibration.");
  if (!moved.list.empty())
    blocks += heading("Loaded transmission error") +
              per_mesh(meshes, "transmission error, µm", transmission_error, About::zero,
                       "At the nominal mesh force, along the line of action. The band is the estimated error.") +
              moved;
  return blocks + heading("Mesh stiffness") + overlays(meshes) +
         per_mesh(meshes, "stiffness, N/µm", secant, About::zero,
                  "Secant stiffness at the nominal load, with the estimated error. Meshes of one kind have the same "
                  "scale.") +
         over_load(meshes) + load_shares(meshes);
}

}  // namespace annulus::app
