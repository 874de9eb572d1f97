#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// Pieces of a curve between two solved positions. A prescribed wave is sampled densely already, and a rectangular one
/// must not be rounded.
int pieces_of(const MeshResult& mesh) {
  if (!mesh.model.computed()) return 1;
  return mesh.table.positions() > 1 ? 4 : 10;
}

/// The curve as a line with its band, and dots where it was solved when there are few enough to tell apart.
void add_curve(Plot& plot, const std::string& label, const CycleCurve& c, std::size_t colour, bool dots) {
  plot.series.push_back({.label = label, .x = c.cycles, .y = c.value, .low = c.low, .high = c.high, .colour = colour});
  if (dots)
    plot.series.push_back(
        {.label = {}, .x = c.solved_cycles, .y = c.solved, .colour = colour, .style = Series::Style::dots});
}

double lte_um(const StiffnessEntry& e) { return e.lte / units::um; }
double tangent(const StiffnessEntry& e) { return e.stiffness_tangent / 1e6; }

const char* cycle_label(const MeshResult& mesh) {
  return mesh.table.positions() > 1 ? "ring teeth passed (mesh cycles)" : "mesh cycle";
}

/// The same quantity of every ring, side by side on one scale.
enum class Offset { none, mean };
template <class Pick>
Pictures per_ring(const RunResult& result, const char* y_label, Pick pick, Offset offset, const Text& caption) {
  std::vector<Plot> plots;
  RangeFinder range;
  for (const auto& ring : result.rings) {
    const auto& mesh = ring.mesh;
    auto curve = cycle_curve(mesh, pick, pieces_of(mesh));
    if (offset == Offset::mean) {
      for (auto& v : curve.value) v -= curve.mean;
      for (auto& v : curve.solved) v -= curve.mean;
      curve.low.clear();
      curve.high.clear();
    }
    range.add(curve.value);
    range.add(curve.low);
    range.add(curve.high);
    Plot plot{.title = ring.name, .x_label = cycle_label(mesh), .y_label = y_label};
    add_curve(plot, ring.name, curve, plots.size(), mesh.model.computed() && mesh.table.positions() == 1);
    plots.push_back(std::move(plot));
  }
  return {on_one_scale(plots, range), {}, caption};
}

/// All rings in one plot, the repeating ones repeated over the longest period.
Pictures overlay(const RunResult& result) {
  int longest = 2;
  for (const auto& ring : result.rings) longest = std::max(longest, ring.mesh.table.positions());
  Plot plot{.title = "Ring mesh stiffness (secant)",
            .x_label = "ring teeth passed (mesh cycles)",
            .y_label = "N/µm",
            .legend = true,
            .width = 900,
            .height = 320};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.rings[i];
    const auto c = cycle_curve(ring.mesh, secant_N_per_um, pieces_of(ring.mesh));
    Series series{.label = ring.name, .colour = i};
    const std::size_t period = c.value.size() - 1;
    for (double x = 0; x < longest; x += ring.mesh.table.positions()) {
      for (std::size_t k = 0; k <= period && x + c.cycles[k] <= longest + 1e-9; ++k) {
        series.x.push_back(x + c.cycles[k]);
        series.y.push_back(c.value[k]);
      }
    }
    plot.series.push_back(std::move(series));
  }
  return {{plot}, {}, "Rings that repeat with every tooth are continued over the period of the others."};
}

Blocks over_load(const RunResult& result) {
  Plot plot{.title = "Mean mesh stiffness over load",
            .x_label = "mesh force, kN",
            .y_label = "N/µm",
            .legend = true,
            .width = 900,
            .height = 320};
  std::size_t colour = 0;
  for (const auto& [label, mesh] : all_meshes(result)) {
    const std::size_t own = colour++;
    const auto& loads = mesh->table.loads();
    if (loads.size() < 2) continue;
    Series secants{.label = label + ", secant", .colour = own},
        tangents{.label = label + ", tangent", .colour = own, .dashed = true};
    for (std::size_t load = 0; load < loads.size(); ++load) {
      secants.x.push_back(loads[load] / 1e3);
      tangents.x.push_back(loads[load] / 1e3);
      secants.y.push_back(mean_at_load(mesh->table, load, secant_N_per_um));
      tangents.y.push_back(mean_at_load(mesh->table, load, tangent));
    }
    plot.series.push_back(std::move(secants));
    plot.series.push_back(std::move(tangents));
  }
  if (plot.series.empty()) return {};
  return Pictures{
      {plot},
      {},
      "Secant: force over deflection. Tangent: slope of the force over the deflection, what small vibrations feel."};
}

Plot shares_plot(const std::string& title, const MeshResult& mesh, std::size_t colour) {
  const auto& csv = mesh.positions;
  Series series{.label = title, .colour = colour, .style = Series::Style::dots};
  const double load = mesh.table.loads()[mesh.nominal];
  const auto load_column = csv.column("load_N");
  for (const auto& row : csv.rows) {
    if (row[load_column] != load) continue;
    for (std::size_t c = 0; c + 1 < csv.columns.size(); ++c) {
      if (!csv.columns[c].ends_with("_roll_mm") || !std::isfinite(row[c])) continue;
      series.x.push_back(row[c]);
      series.y.push_back(row[c + 1]);
    }
  }
  return {.title = title,
          .x_label = "roll length on the planet's flank, mm",
          .y_label = "share of the mesh force",
          .y_range = Range{-0.03, 1.05},
          .series = {series}};
}

Blocks shares(const RunResult& result) {
  std::vector<Picture> plots;
  std::size_t colour = 0;
  for (const auto& [name, mesh] : all_meshes(result)) {
    const std::size_t own = colour++;
    if (!mesh->positions.rows.empty())
      plots.emplace_back(shares_plot(own < result.rings.size() ? "ring mesh, " + name : name, *mesh, own));
  }
  if (plots.empty()) return {};
  return heading("Load shares of the tooth pairs") +
         Pictures{plots,
                  {},
                  "Share of one tooth pair while it passes through the mesh, from the planet's root to its tip. Where "
                  "the share falls to zero outside the theoretical path of contact, deflection brings teeth together "
                  "early and lets them part late."};
}

}  // namespace

Section stiffness_section(const RunResult& result) {
  const auto sun = cycle_curve(result.sun_mesh, secant_N_per_um, pieces_of(result.sun_mesh));
  Plot sun_plot{
      .title = "Sun mesh stiffness (secant)", .x_label = "mesh cycle", .y_label = "N/µm", .width = 900, .height = 300};
  add_curve(sun_plot, "sun mesh", sun, result.rings.size(), result.sun_mesh.model.computed());
  return {"stiffness", "Transmission error and stiffness",
          heading("Loaded transmission error of the ring mesh") +
              per_ring(result, "transmission error, µm", lte_um, Offset::none,
                       "At the nominal mean mesh force, along the line of action, one scale for all. The band is the "
                       "estimated error.") +
              per_ring(result, "transmission error – mean, µm", lte_um, Offset::mean,
                       "The same about its mean: what excites vibration.") +
              heading("Mesh stiffness") + overlay(result) +
              per_ring(result, "stiffness, N/µm", secant_N_per_um, Offset::none,
                       "Secant stiffness at the nominal load, one scale for all, with the estimated error.") +
              Pictures{{sun_plot}, {}, "The same for all rings."} +
              stiffness_errors(sun_then_rings(result, "ring mesh of ")) + over_load(result) + shares(result)};
}

}  // namespace annulus::app
