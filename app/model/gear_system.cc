#include "app/model/gear_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/model/plan_studies.h"
#include "app/model/trade_subject.h"
#include "app/plan/plan.h"
#include "app/scene/input_place.h"
#include "core/errors.h"

namespace annulus::app {

PlanCost GearSystem::cost(int threads, const CostModel& costs) const {
  return plan_cost(meshes(), responses(threads), plan_studies(scene_), threads, costs,
                   [this](const MeshModel& mesh) { return coupled(mesh); });
}

Plan GearSystem::plan(int threads) const {
  Plan plan;
  plan.title = scene_.title;
  plan.meshes = meshes();
  plan.studies = plan_studies(scene_);
  describe(plan);
  plan.cost = cost(threads, CostModel::of_this_machine());
  return plan;
}

const SystemKind& system_kind(const std::string& name) {
  const auto& kinds = system_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const SystemKind& k) { return k.scene.name == name; });
  if (found == kinds.end()) throw InternalError(fmt::format("internal error: no gear system '{}' is registered", name));
  return *found;
}

std::vector<std::size_t> GearSystem::meshes_of(std::size_t /*variant*/) const {
  std::vector<std::size_t> all(model_meshes().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::unique_ptr<TradeSubject>> GearSystem::trades() const { return {}; }

std::unique_ptr<GearSystem> make_system(const Scene& scene) { return system_kind(scene.stage.kind).make(scene); }

Plan make_plan(const Scene& scene, int threads) { return make_system(scene)->plan(threads); }

std::string plan_scene(const Scene& scene, PlanFormat format, int threads, const std::string& budget) {
  Plan plan = make_plan(scene, threads);
  plan.budget = budget;
  return format == PlanFormat::json ? to_json(plan) : to_text(plan);
}

void check_stage(const Scene& scene) {
  try {
    make_system(scene)->check();
  } catch (const GeometryError& error) {
    throw GeometryError(with_place(scene, without_place(scene, error.what())));
  } catch (const InputError& error) {
    throw InputError(with_place(scene, without_place(scene, error.what())));
  }
}

bool table_serves(const MeshModel& nominal, const MeshModel& changed, double mean_mesh_force) {
  if (!nominal.computed() || !changed.computed()) return nominal.computed() == changed.computed();
  const auto& loads = nominal.problem->loads;
  if (mean_mesh_force < loads.front() || mean_mesh_force > loads.back()) return false;
  MeshModel same_loads = changed;
  same_loads.problem->loads = loads;
  return same_loads.id() == nominal.id();
}

std::vector<std::string> tables_to_solve(const Scene& nominal, const Scene& changed) {
  const auto system = make_system(changed);
  const auto before = make_system(nominal)->meshes(), after = system->meshes();
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (!table_serves(before.at(i), after[i], system->mean_mesh_force())) labels.push_back(after[i].label());
  return labels;
}

}  // namespace annulus::app
