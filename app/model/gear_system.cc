#include "app/model/gear_system.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <numeric>

#include "app/model/plan_studies.h"
#include "app/model/scene_warnings.h"
#include "app/plan/plan.h"
#include "app/scene/input_place.h"
#include "app/scene/overrides.h"
#include "core/errors.h"

namespace annulus::app {

std::vector<std::string> GearSystem::variants() const {
  auto names = variant_names(scene_);
  if (names.empty()) names.emplace_back();
  return names;
}

PlanCost GearSystem::cost(int threads) const {
  const auto planned = responses();
  return plan_cost(meshes(), planned, plan_studies(*this, planned), threads,
                   [this](const MeshModel& mesh) { return coupled(mesh); });
}

Plan GearSystem::plan(int threads) const {
  Plan plan;
  plan.title = scene_.title;
  plan.variant_word = variant_word(scene_.stage.kind);
  plan.meshes = meshes();
  const auto planned = responses();
  plan.studies = plan_studies(*this, planned);
  describe(plan);
  for (const auto& rotor : scene_.rotors) plan.dofs.push_back({rotor.name + " u", true, "turns on its shaft"});
  const auto is_coupled = [this](const MeshModel& mesh) { return coupled(mesh); };
  plan.cost = plan_cost(plan.meshes, planned, plan.studies, threads, is_coupled).at_pace(machine_pace());
  plan.warnings = scene_warnings();
  for (auto& warning : common_warnings(scene_, plan)) plan.warnings.push_back(std::move(warning));
  plan.warnings = by_severity(std::move(plan.warnings));
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

std::string GearSystem::title(std::size_t variant) const {
  const auto name = variants().at(variant);
  return name.empty() ? scene_.stage.kind : name;
}

std::shared_ptr<const SolvedCoupling> GearSystem::coupling(const MeshResult& /*mesh*/, const RunOptions& /*options*/,
                                                           const std::filesystem::path& /*folder*/) const {
  return nullptr;
}

ModelWays GearSystem::ways(std::size_t /*variant*/, const std::vector<const MeshResult*>& /*tables*/) const {
  return {};
}

std::unique_ptr<GearSystem> make_system(const Scene& scene) { return system_kind(scene.stage.kind).make(scene); }

Plan make_plan(const Scene& scene, int threads) { return make_system(scene)->plan(threads); }

namespace {

/// Every line of a message with the place of what it speaks of.
std::string with_places(const Scene& scene, const std::string& message) {
  std::vector<std::string> lines;
  boost::algorithm::split(lines, message, boost::algorithm::is_any_of("\n"));
  for (auto& line : lines) line = with_place(scene, without_place(scene, line));
  return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace

void check_stage(const Scene& scene) {
  try {
    make_system(scene)->check();
  } catch (const GeometryError& error) {
    throw GeometryError(with_places(scene, error.what()));
  } catch (const InputError& error) {
    throw InputError(with_places(scene, error.what()));
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

std::vector<MeshModel> tables_to_solve(const Scene& nominal, const Scene& changed) {
  const auto system = make_system(changed);
  const auto before = make_system(nominal)->meshes(), after = system->meshes();
  std::vector<MeshModel> list;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (!table_serves(before.at(i), after[i], system->mean_mesh_force())) list.push_back(after[i]);
  return list;
}

std::string GearSystem::rexs(const std::string& /*variant*/) const {
  if (!scene_kind(scene().stage.kind).gears)
    throw InputError(fmt::format("{}: a {} has no gears of its own; export the scenes of its parts",
                                 scene().file.string(), scene().stage.kind));
  std::vector<std::string> known;
  for (const auto& kind : system_kinds())
    if (kind.from_rexs) known.push_back(kind.scene.name);
  throw InputError(fmt::format("{}: stage.kind = {}: REXS does not describe its gears, only those of {}",
                               scene().file.string(), scene().stage.kind, listed(known)));
}

GearSystem::Statics GearSystem::statics(const RunOptions&) const {
  throw InputError(fmt::format("{}: stage.kind = {}: annulus statics computes planetary stages alone",
                               scene().file.string(), scene().stage.kind));
}

}  // namespace annulus::app
