#pragma once

#include <string>
#include <vector>

#include "app/plan/cost_plan.h"
#include "app/plan/mesh_model.h"
#include "app/plan/study_plan.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// A derived quantity, in the unit people use for it.
struct Quantity {
  std::string key;  ///< "working_pressure_angle_deg": carries its unit, for JSON
  double value = 0;
  std::string unit;     ///< for people: "°"
  std::string meaning;  ///< what it is, and from what it follows
};

/// A DOF of the lumped model, or a group of equal ones.
struct DofPlan {
  std::string name;  ///< "sun x, y"
  bool kept = true;
  std::string reason;
};

/// What will be modelled and why; made without computing anything elastic.
struct Plan {
  std::string title;
  std::vector<Input> inputs;         ///< all inputs with a value, and the ones derived from others
  std::vector<Quantity> quantities;  ///< of the stage and the sun mesh
  std::vector<std::pair<std::string, std::vector<Quantity>>> rings;  ///< per ring
  std::vector<MeshModel> meshes;                                     ///< sun mesh first, then one per ring
  std::vector<DofPlan> dofs;
  std::vector<Decision> motion;      ///< how the motion is found in time
  std::vector<StudyPlan> studies;    ///< sweeps, samples, sensitivity
  std::vector<std::string> remarks;  ///< simplifications and warnings
  PlanCost cost{};                   ///< predicted; empty when there is nothing to compute
  std::string budget{};              ///< what is chosen for a budget; empty without one

  /// Contact problems per level of resolution: positions x phases x loads, closure included, over all computed meshes.
  [[nodiscard]] long contact_problems() const;
};

[[nodiscard]] std::string to_text(const Plan& plan);
[[nodiscard]] std::string to_json(const Plan& plan);

}  // namespace annulus::app
