#include "app/study/study_subject.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/model/run_options.h"
#include "app/model/system_run.h"
#include "app/model/table_errors.h"
#include "core/errors.h"
#include "core/log.h"

namespace annulus::app {

const std::vector<FigureSpec>& study_figures(const Scene& scene) {
  const auto& kind = system_kind(scene.stage.kind);
  const auto system = make_system(scene);
  std::vector<FigureSpec> list;
  std::string keys = scene.stage.kind;
  for (const auto& spec : kind.model_figures()) {
    if (!system->table_for(spec.key).empty()) continue;
    list.push_back(spec);
    keys += " " + spec.key;
  }
  static std::mutex lock;
  static std::map<std::string, std::vector<FigureSpec>> kept;
  const std::lock_guard guard(lock);
  return kept.try_emplace(keys, std::move(list)).first->second;
}

StudySubject::StudySubject(const SystemRun& nominal, const RunOptions& options)
    : nominal_(nominal),
      options_(options),
      variants_(make_system(nominal.scene)->variants()),
      figures_(study_figures(nominal.scene)),
      tables_(nominal.tables) {}

const Scene& StudySubject::scene() const { return nominal_.scene; }

FigureSet StudySubject::nominal(std::size_t variant) const {
  FigureSet figures;
  const auto all = nominal_.variants();
  for (const auto& entry : all.at(variant).figures.entries())
    if (find_figure(figures_, entry.key) != nullptr) figures.set(entry.key, entry.figure, entry.parts);
  return figures;
}

std::filesystem::path StudySubject::folder(std::size_t variant) const {
  auto folder = options_.out / variants_.at(variant) / "dynamics";
  std::filesystem::create_directories(folder);
  return folder;
}

bool StudySubject::solves_elements() const {
  return std::any_of(tables_.begin(), tables_.end(),
                     [](const MeshResult& table) { return table.model.has_elements(); });
}

bool StudySubject::prepare(const StudyCase& changed) const {
  const auto scene_of_case = with_overrides(scene(), changed.overrides);
  const auto system = make_system(scene_of_case);
  const auto meshes = system->model_meshes();
  bool any = false;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (table_serves(tables_.at(i).model, meshes[i], system->mean_mesh_force())) continue;
    any = true;
    {
      const std::lock_guard guard(lock_);
      if (prepared_.count({changed.folder, i}) > 0) continue;
    }
    RunOptions inside = options_;
    inside.out /= changed.folder;
    inside.for_study = true;
    if (solves_elements())
      log::info(changed.where + ":");
    else
      inside.threads = 1;
    auto mesh = stiffness_alone(system->stiffness(meshes[i], inside));
    const std::lock_guard guard(lock_);
    prepared_.emplace(Place{changed.folder, i}, std::move(mesh));
  }
  return any;
}

std::unique_ptr<LumpedModel> StudySubject::model(const StudyCase& changed, std::size_t variant) const {
  try {
    auto scene_of_case = with_overrides(scene(), changed.overrides);
    if (!changed.other_motions && scene_of_case.dynamics) scene_of_case.dynamics->starts = 0;
    const auto system = make_system(scene_of_case);
    const auto meshes = system->model_meshes();
    const double force = system->mean_mesh_force();
    std::vector<const MeshResult*> tables;
    for (const std::size_t i : system->meshes_of(variant)) {
      if (table_serves(tables_.at(i).model, meshes.at(i), force)) {
        tables.push_back(&tables_[i]);
        continue;
      }
      const std::lock_guard guard(lock_);
      const auto found = prepared_.find({changed.folder, i});
      if (found == prepared_.end())
        throw InputError(fmt::format("the {} is not tabulated for a mean mesh force of {} kN", meshes[i].label(),
                                     to_text(force / 1e3, 5)));
      tables.push_back(&found->second);
    }
    return system->model(variant, tables);
  } catch (const InputError&) {
    rethrow_at(scene(), changed.where);
  }
}

FigureSet StudySubject::with_errors(std::size_t variant, const FigureSet& nominal,
                                    const std::function<FigureSet(const LumpedModel&)>& evaluate) const {
  const auto system = make_system(scene());
  std::vector<const MeshResult*> tables;
  for (const std::size_t i : system->meshes_of(variant)) tables.push_back(&tables_.at(i));
  const auto on_tables = [&](const std::vector<const MeshResult*>& changed) {
    return dynamics::Evaluation{evaluate(*system->model(variant, changed)), {}};
  };
  return with_table_errors({nominal, {}}, tables, on_tables,
                           {.simulation = {}, .seeks_steady_state = false, .nominal_alike = true});
}

}  // namespace annulus::app
