#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/plan/cost_plan.h"
#include "app/plan/mesh_model.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "core/json.h"

namespace annulus::app {

/// A derived quantity, in the unit people use for it.
struct Quantity {
  std::string key;  ///< "working_pressure_angle_deg": carries its unit, for JSON
  double value = 0;
  std::string unit;     ///< for people: "°"
  std::string meaning;  ///< what it is, and from what it follows
};
/// A quantity in the unit that its key ends with ("_mm", "_deg", "_rpm" ...; none otherwise). `value`: SI.
[[nodiscard]] Quantity quantity(std::string key, double value, std::string meaning);

/// A DOF of the lumped model, or a group of equal ones.
struct DofPlan {
  std::string name;  ///< "sun x, y"
  bool retained = true;
  std::string reason;
};
/// A DOF that stands on a support ("axial bearing") of stiffness `given`, and is dropped where that counts as rigid:
/// `effective` is infinite (stiff_supports.h).
[[nodiscard]] DofPlan supported_dof(std::string name, const std::string& support, double given, double effective,
                                    const char* unit = "N/m");

/// What will be modelled and why; made without computing anything elastic.
struct Plan {
  std::string title;
  std::vector<Input> inputs;         ///< all inputs with a value, and the ones derived from others
  std::vector<Quantity> quantities;  ///< of all variants
  std::vector<std::pair<std::string, std::vector<Quantity>>> variants;  ///< of each
  std::string variant_word;                                             ///< what these are: "ring"
  std::vector<MeshModel> meshes;                                        ///< those of all variants first
  std::vector<DofPlan> dofs;
  std::vector<Decision> motion;      ///< how the motion is found in time
  std::vector<StudyPlan> studies;    ///< sweeps, samples, sensitivity
  std::vector<std::string> remarks;  ///< simplifications
  std::vector<Warning> warnings{};   ///< what the scene says of itself, the severe ones first
  PlanCost cost{};                   ///< predicted; empty when there is nothing to compute
  std::string budget{};              ///< what is chosen for a budget; empty without one

  [[nodiscard]] bool computes() const;  ///< whether a stiffness is solved
  /// Contact problems per level of resolution: positions x phases x loads, closure included, over all computed meshes.
  [[nodiscard]] long contact_problems() const;
};

/// The value of an absent input that follows from others.
struct DerivedInput {
  std::string key, variant;
  double value = 0;    ///< in the unit of the key
  std::string note{};  ///< how; empty: what the schema notes
};
/// Tip and root diameter of the gear in a table of the scene ("sun", "ring").
void add_diameters(std::vector<DerivedInput>& list, const std::string& table, const geometry::Gear& gear,
                   const std::string& variant = "");
/// The inputs of a scene that have a value, those that are derived among them.
[[nodiscard]] std::vector<Input> resolved_inputs(const Scene& scene, const std::vector<DerivedInput>& derived);

/// Decisions, studies, cost and warnings on one screen.
[[nodiscard]] std::string overview(const Plan& plan);
/// All of it, every input with its origin.
[[nodiscard]] std::string to_text(const Plan& plan);
[[nodiscard]] Json to_json(const Plan& plan);

}  // namespace annulus::app
