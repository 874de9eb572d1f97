#include "app/model/mesh_figures.h"

#include <algorithm>
#include <cmath>

namespace annulus::app {

namespace {

/// The absolute error of an estimate, which holds it relative to the value.
void set(FigureSet& figures, const std::string& key, const Estimate& e) {
  const double size = std::abs(e.value);
  figures.set(key, {e.value, size * e.error_relative}, size * e.parts);
}

/// (largest - smallest) / mean of the secant stiffness at the nominal load.
double ripple(const MeshResult& mesh) {
  double low = INFINITY, high = 0;
  for (int position = 0; position < mesh.table.positions(); ++position)
    for (int phase = 0; phase < mesh.table.phases(); ++phase) {
      const double k = mesh.table.at(position, phase, static_cast<int>(mesh.nominal)).stiffness_secant;
      low = std::min(low, k);
      high = std::max(high, k);
    }
  return (high - low) / mesh.mean_stiffness().value;
}

}  // namespace

std::vector<FigureSpec> mesh_figure_specs(const std::string& mesh, const std::string& title,
                                          const std::string& quantity) {
  return {
      {.key = mesh + "_mean_stiffness_N_per_m",
       .title = "Mean stiffness of the " + title,
       .unit = "N/µm",
       .scale = 1e-6,
       .definition = "mean over the mesh cycles of the secant stiffness F / (LTE - unloaded TE) at the nominal load",
       .effort = FigureEffort::tables,
       .guarantee = Guarantee::always,
       .quantity = quantity,
       .compared = true},
      {.key = mesh + "_stiffness_ripple",
       .title = "Ripple of the stiffness of the " + title,
       .definition = "(largest - smallest) / mean of the secant stiffness over the mesh cycles at the nominal load",
       .better = Better::smaller,
       .effort = FigureEffort::tables,
       .quantity = "stiffness_ripple",
       .digits = 3},
      {.key = mesh + "_lte_mean_m",
       .title = "Mean loaded transmission error of the " + title,
       .symbol = "LTE",
       .unit = "µm",
       .scale = 1e6,
       .definition = "mean over the mesh cycles of the transmission error under the nominal load",
       .effort = FigureEffort::tables},
      {.key = mesh + "_lte_peak_to_peak_m",
       .title = "Transmission error of the " + title + ", peak to peak",
       .unit = "µm",
       .scale = 1e6,
       .definition = "largest less smallest transmission error over the mesh cycles, under the nominal load",
       .better = Better::smaller,
       .effort = FigureEffort::tables,
       .compared = true}};
}

FigureSet mesh_figures(const MeshResult& mesh) {
  const auto& name = mesh.model.mesh;
  FigureSet figures;
  set(figures, name + "_mean_stiffness_N_per_m", mesh.mean_stiffness());
  // Both ends of the range carry the error of the stiffness; the larger part of it is common to both.
  const double range = ripple(mesh), relative = mesh.lte_peak_to_peak().error_relative;
  figures.set(name + "_stiffness_ripple", {range, range * relative});
  set(figures, name + "_lte_mean_m", mesh.lte_mean());
  set(figures, name + "_lte_peak_to_peak_m", mesh.lte_peak_to_peak());
  return figures;
}

}  // namespace annulus::app
