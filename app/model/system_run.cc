#include "app/model/system_run.h"

#include <algorithm>

#include "app/model/cost_actual.h"
#include "app/model/gear_system.h"
#include "app/model/mesh_figures.h"
#include "app/scene/input_place.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "dynamics/figures/shaft_results.h"

namespace annulus::app {

SystemRun::SystemRun(const Scene& of) : scene(of), system(make_system(scene)) {}

SystemRun::~SystemRun() = default;

void SystemRun::solve_meshes(const RunOptions& options) {
  for (const auto& mesh : system->run_meshes())
    tables.push_back(system->stiffness(options.remodel ? options.remodel(mesh) : mesh, options));
  system->save_inputs(*this, options);
}

void SystemRun::respond(const RunOptions& options) {
  const auto timer = timers.measure("dynamics");
  const auto variants = system->run_variants();
  responses.resize(variants.size());
  for_each_task(responses.size(), options.threads, [&](std::size_t variant) {
    const Stopwatch watch;
    const auto& name = variants[variant].folder;
    std::unique_ptr<RunResponse> response;
    about(scene, name.empty() ? "dynamics" : "dynamics of '" + name + "'",
          [&] { response = system->respond(*this, variant, options); });
    response->seconds = watch.seconds();
    responses[variant] = std::move(response);
  });
}

std::vector<const MeshResult*> SystemRun::meshes() const {
  std::vector<const MeshResult*> list;
  for (const auto& table : tables)
    if (table.model.computed()) list.push_back(&table);
  return list;
}

std::vector<const MeshResult*> SystemRun::tables_of(std::size_t variant) const {
  std::vector<const MeshResult*> list;
  const auto variants = system->run_variants();
  for (const std::size_t i : variants.at(variant).tables) list.push_back(&tables.at(i));
  return list;
}

namespace {

/// The spreads of results that samples of this variant have.
void add_spreads(FigureSet& figures, const StudyResults& studies, const std::string& variant) {
  if (!studies.monte_carlo) return;
  for (std::size_t i = 0; i < studies.variants.size(); ++i) {
    const auto& samples = studies.monte_carlo->variants[i];
    if (!studies.variants[i].empty() && studies.variants[i] != variant) continue;
    for (const auto& spec : studies.figures)
      if (const auto* s = samples.find(spec.key); s && spec.spread)
        figures.set_spread(
            spec.key, {s->q05.value, s->median.value, s->q95.value, studies.monte_carlo->samples - samples.failed});
  }
}

}  // namespace

std::vector<VariantFigures> SystemRun::variants() const {
  const auto names = system->run_variants();
  std::vector<VariantFigures> list;
  for (std::size_t variant = 0; variant < names.size(); ++variant) {
    const auto found = system->table_figures(variant, tables_of(variant));
    FigureSet figures;
    for (const auto& spec : system_kind(scene.stage.kind).figures())
      if (const auto* entry = found.find(spec.key)) figures.set(entry->key, entry->figure, entry->parts);
    if (!responses.empty()) figures.add(responses[variant]->figures);
    add_spreads(figures, studies, names[variant].name);
    list.push_back({names[variant].name, std::move(figures)});
  }
  return list;
}

std::optional<CostRun> SystemRun::actual(const CostStep& step) const {
  if (step.kind == CostKind::response) {
    const auto variants = system->run_variants();
    for (std::size_t i = 0; i < responses.size(); ++i)
      if (variants[i].folder == step.variant && !responses[i]->reused)
        return actual_time(step.size, responses[i]->seconds);
    return std::nullopt;
  }
  if (step.kind == CostKind::studies) {
    const auto found = studies.times.find(step.label);
    return found == studies.times.end() ? std::nullopt : std::optional(actual_time(step.size, found->second.seconds));
  }
  if (step.kind == CostKind::files) {
    const auto other = std::find_if(timings.begin(), timings.end(), [](const auto& t) { return t.first == "other"; });
    return other == timings.end() ? std::nullopt : std::optional(actual_time(step.size, other->second));
  }
  for (const auto* mesh : meshes()) {
    if (step.kind == CostKind::mesh && mesh->model.label() == step.label) return actual_mesh(step.size, *mesh);
    if (step.kind == CostKind::coupling && mesh->model.variant == step.variant)
      if (auto found = system->actual_coupling(step.size, *mesh)) return found;
  }
  return std::nullopt;
}

FigureSet GearSystem::table_figures(std::size_t /*variant*/, const std::vector<const MeshResult*>& tables) const {
  FigureSet figures;
  for (const auto* mesh : tables)
    if (mesh->table.phases() > 0) figures.add(mesh_figures(*mesh));
  return figures;
}

std::string GearSystem::table_for(const std::string& result) const {
  return result == dynamics::shaft_key && scene().rotors.empty() ? "[[rotor]]" : "";
}

std::vector<RunVariant> GearSystem::run_variants() const {
  std::vector<RunVariant> list;
  for (const auto& name : variants()) list.push_back({name, name, meshes_of(list.size())});
  return list;
}

}  // namespace annulus::app
