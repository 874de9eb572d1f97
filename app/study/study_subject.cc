#include "app/study/study_subject.h"

#include <fmt/format.h>

#include "app/model/gear_system.h"
#include "app/pipeline.h"
#include "app/reuse.h"
#include "core/errors.h"
#include "core/log.h"

namespace annulus::app {

RunOptions StudySubject::options_in(const std::string& folder) const {
  RunOptions inside = options();
  inside.out /= folder;
  inside.for_study = true;
  return inside;
}

std::filesystem::path StudySubject::folder(std::size_t variant) const {
  return options().out / variants().at(variant) / "dynamics";
}

std::optional<MeshResult> StudySubject::changed_mesh(const MeshModel& nominal, const MeshModel& changed,
                                                     double mean_mesh_force, const std::string& folder) const {
  if (table_serves(nominal, changed, mean_mesh_force)) return std::nullopt;
  if (folder.empty())
    throw InputError(fmt::format("the {} is not tabulated for a mean mesh force of {} kN", changed.label(),
                                 to_text(mean_mesh_force / 1e3, 5)));
  return load(changed, options_in(folder).out / changed.ring);
}

bool StudySubject::prepare_mesh(const MeshModel& nominal, const MeshModel& changed, double mean_mesh_force,
                                const std::string& where, const std::string& folder) const {
  if (table_serves(nominal, changed, mean_mesh_force)) return false;
  const auto inside = options_in(folder);
  if (cached_stiffness(changed, changed.ring, inside)) {
    count_reuse(inside, study_meshes, 1, 0);
    return true;
  }
  log::info(where + ":");
  (void)computed_stiffness(changed, changed.ring, inside);
  return true;
}

StudyPoint evaluate(const ChangedModel& model, bool quick) {
  try {
    return model.answer(quick);
  } catch (const Error& error) {
    std::string reason = error.what();
    for (auto& c : reason) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    return {{}, {}, std::move(reason)};
  }
}

}  // namespace annulus::app
