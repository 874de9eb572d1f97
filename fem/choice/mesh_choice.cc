#include "fem/choice/mesh_choice.h"

#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "fem/choice/table_choice.h"
#include "fem/closed_form/closed_form_error.h"

namespace annulus::fem {
namespace {

/// The cheapest model the mesh permits, unless another is wanted, and why.
std::pair<Fidelity, std::string> chosen_model(WantedModel wanted, const std::string& why_solid,
                                              const std::string& why_plane) {
  const bool solid = !why_solid.empty();
  const std::string& why = solid ? why_solid : why_plane;
  const std::string asked = "the scene asks for it (model)";
  switch (wanted) {
    case WantedModel::automatic:
      return {solid ? Fidelity::solid : Fidelity::plane, why};
    case WantedModel::closed_form:
      return {Fidelity::closed_form, asked};
    case WantedModel::plane:
      return {Fidelity::plane, asked};
    case WantedModel::solid:
      return {Fidelity::solid, solid ? why : asked};
    case WantedModel::resolved:
      break;
  }
  return {solid ? Fidelity::resolved_solid : Fidelity::resolved_plane, asked + "; " + why};
}

/// Why a plane model suffices where nothing changes along the face width.
std::string plane_reason(const LoadedMeshProblem& problem) {
  if (!problem.pair.internal())
    return fmt::format(
        "spur gears without lead modifications on {} over the full width: nothing changes along the face width",
        problem.planet_rollers ? "rollers and a hub" : "hubs");
  const auto reason = problem.structure.words().plane_reason;
  return reason.empty() ? "" : reason + ": nothing changes along the face width";
}

/// Why the mesh repeats after so many ring positions.
std::string repeats_text(const LoadedMeshProblem& problem, int positions) {
  if (!problem.pair.internal()) return "equal teeth on concentric hubs: one mesh cycle suffices";
  if (!on_single_supports(problem.structure))
    return "the support is the same behind every tooth: one mesh cycle suffices";
  const int teeth = problem.pair.wheel().teeth();
  const auto supports = problem.structure.words().repetition;
  if (positions == teeth) return fmt::format("{} teeth on {}: no smaller rotation repeats the ring", teeth, supports);
  return fmt::format("{} teeth on {}: the ring repeats after {} teeth", teeth, supports, positions);
}

/// Formulas do where their error, known beforehand, is within the accuracy.
void prefer_formulas(const LoadedMeshProblem& problem, const MeshWish& wish, MeshChoice& choice) {
  if (wish.model != WantedModel::automatic || choice.settings.fidelity != Fidelity::plane) return;
  if (wish.accuracy < least_closed_form_error || !problem.gauges.empty() || problem.planet_rollers) return;
  if (geometry::measured(problem.pair.pinion().parameters()) || geometry::measured(problem.pair.wheel().parameters()))
    return;
  const double error = closed_form_error(problem);
  if (error > wish.accuracy) return;
  choice.settings.fidelity = Fidelity::closed_form;
  choice.reason += fmt::format("; formulas are within {:.2g} %", 100 * error);
  choice.formula_error = error;
}

}  // namespace

std::string solid_reason(const RingStructure& structure, const FaceFeatures& features) {
  std::string reasons = structure.words().solid_reason;
  const auto add = [&](bool applies, const std::string& reason) {
    if (applies) reasons += (reasons.empty() ? "" : "; ") + reason;
  };
  constexpr const char* lead = "the lead of the {} is modified, so the load varies along the face width";
  add(features.helix_angle != 0, "helical teeth enter the contact progressively along the face width");
  add(features.wheel_lead_modified, fmt::format(lead, features.wheel_name));
  add(features.pinion_lead_modified, fmt::format(lead, features.pinion_name));
  add(features.misalignment != 0, "the flanks are misaligned, so the load varies along the face width");
  add(features.beside, "the middles of the faces are apart, so the load varies along the face width");
  add(features.gauges_across, "strain gauges stand at places along the face width, or measure along the axis");
  return reasons;
}

MeshChoice choose_mesh(LoadedMeshProblem& problem, const std::string& why_solid, const MeshWish& wish) {
  const auto& pair = problem.pair;
  MeshChoice choice;
  std::tie(choice.settings.fidelity, choice.reason) = chosen_model(wish.model, why_solid, plane_reason(problem));
  choice.settings.accuracy = wish.accuracy;
  choice.settings.largest_deflection = 0.25;  // small displacements; the bound of small displacements
  choice.positions = problem.structure.repeating_teeth(pair.wheel().teeth());
  choice.repeats = repeats_text(problem, choice.positions);
  const double uptake = load_uptake(wish.mean_force, problem.face_width, pair.pinion().parameters().module,
                                    problem.materials.youngs_modulus());
  auto table = table_resolution(wish.accuracy, uptake, pair.overlap_ratio());
  problem.phases = table.phases;
  for (const double factor : table.load_factors) problem.loads.push_back(factor * wish.mean_force);
  choice.phases = std::move(table.phases_reason);
  choice.loads = std::move(table.loads_reason);
  prefer_formulas(problem, wish, choice);
  const bool formulas = choice.settings.fidelity == Fidelity::closed_form;
  auto elements = element_choice(problem, formulas ? Fidelity::plane : choice.settings.fidelity, wish.accuracy);
  // Frequencies of linear elements are 2 % too high where a mesh is within 3 %.
  choice.coupling_degree = wish.ring_modes_count ? 2 : elements.degree;
  if (formulas) return choice;
  choice.settings.degree = elements.degree;
  choice.elements = std::move(elements.reason);
  return choice;
}

}  // namespace annulus::fem
