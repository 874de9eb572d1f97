#include "app/model/mesh_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace annulus::app {

namespace {

/// The absolute error of an estimate, which holds it relative to the value.
void set(FigureSet& figures, const std::string& key, const Estimate& e) {
  const double size = std::abs(e.value);
  figures.set(key, {e.value, size * e.error_relative}, size * e.parts);
}

/// Stresses of a body: column of the positions behind its name, and title.
constexpr std::pair<const char*, const char*> stress_names[] = {{"root_tension", "Root stress (tension)"},
                                                                {"root_von_mises", "Root stress (von Mises)"},
                                                                {"rim_von_mises", "Rim stress (von Mises)"}};

}  // namespace

std::vector<FigureSpec> mesh_figure_specs(const std::string& mesh, const std::string& title,
                                          const std::string& quantity, const std::vector<std::string>& bodies) {
  std::vector<FigureSpec> specs = {
      {.key = mesh + "_mean_stiffness_N_per_m",
       .title = "Mean stiffness of the " + title,
       .unit = "N/µm",
       .scale = 1e-6,
       .definition = "mean over the mesh cycles of the secant stiffness F / (LTE - unloaded TE) at the nominal load",
       .term = "mesh_stiffness",
       .effort = FigureEffort::tables,
       .guarantee = Guarantee::always,
       .quantity = quantity,
       .headline = true,
       .compared = true},
      {.key = mesh + "_stiffness_ripple",
       .title = "Ripple of the stiffness of the " + title,
       .unit = "%",
       .scale = 100,
       .definition = "(largest - smallest) / mean of the secant stiffness over the mesh cycles at the nominal load",
       .term = "stiffness_ripple",
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
       .term = "transmission_error",
       .effort = FigureEffort::tables},
      {.key = mesh + "_lte_peak_to_peak_m",
       .title = "Transmission error of the " + title + ", peak to peak",
       .unit = "µm",
       .scale = 1e6,
       .definition = "largest less smallest transmission error over the mesh cycles, under the nominal load",
       .term = "transmission_error",
       .better = Better::smaller,
       .effort = FigureEffort::tables,
       .headline = true,
       .compared = true}};
  const auto add = [&](const std::string& key, const std::string& name, const std::string& definition) -> FigureSpec& {
    return specs.emplace_back(FigureSpec{.key = mesh + "_" + key,
                                         .title = name + ", " + title,
                                         .definition = definition,
                                         .better = Better::smaller,
                                         .effort = FigureEffort::tables});
  };
  if (bodies.empty()) return specs;
  auto& ratio = add("contact_ratio", "Contact ratio", "transverse contact ratio of the gears without load");
  ratio.symbol = "ε_α";
  ratio.term = "contact_ratio";
  ratio.better = Better::neither;
  auto& face = add("face_load_factor", "Face load factor",
                   "largest over mean line load (ISO 6336-1), the largest over the mesh cycles at the nominal load");
  face.symbol = "K_Hβ";
  face.term = "face_load_factor";
  face.headline = true;
  face.digits = 3;
  for (const auto& body : bodies)
    for (const auto& [key, name] : stress_names) {
      auto& stress = add(body + "_" + key + "_Pa", std::string(name) + " of the " + body,
                         "largest over the mesh cycles at the nominal load");
      stress.unit = "MPa";
      stress.term = std::string(key).starts_with("root") ? "root_stress" : "rim_stress";
      stress.headline = std::string(key) != "root_von_mises";
      stress.scale = 1e-6;
    }
  return specs;
}

FigureSet mesh_figures(const MeshResult& mesh) {
  const auto& name = mesh.model.mesh;
  FigureSet figures;
  set(figures, name + "_mean_stiffness_N_per_m", mesh.mean_stiffness());
  set(figures, name + "_stiffness_ripple", mesh.stiffness_ripple());
  set(figures, name + "_lte_mean_m", mesh.lte_mean());
  set(figures, name + "_lte_peak_to_peak_m", mesh.lte_peak_to_peak());
  if (mesh.contact_ratio > 0) figures.set(name + "_contact_ratio", {mesh.contact_ratio, 0});
  if (const auto factor = mesh.face_load_factor()) set(figures, name + "_face_load_factor", *factor);
  if (!mesh.model.computed()) return figures;
  for (const auto gear : {geometry::GearRole::pinion, geometry::GearRole::wheel})
    for (const auto& [key, title] : stress_names) {
      const auto& body = mesh.model.body_name(gear);
      // A body without a free rim has none of its stresses.
      if (const auto stress = mesh.largest_stress(body, key))
        set(figures, fmt::format("{}_{}_{}_Pa", name, body, key), *stress);
    }
  return figures;
}

}  // namespace annulus::app
