#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/model/gear_system.h"
#include "app/study/study_subject.h"
#include "app/systems/planetary/planetary_run.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

/// The lumped model of one ring in a changed scene.
struct ChangedStage {
  dynamics::PlanetaryStage stage;
  dynamics::SimulationOptions simulation;
  std::string id;  ///< of everything the response depends on; empty when not asked for
};

/// Sun mesh first, then one per ring.
[[nodiscard]] std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry);

/// The rings of a planetary stage, on the tables of the nominal run where these serve and on others where not.
class PlanetarySubject final : public StudySubject {
 public:
  PlanetarySubject(const RunResult& nominal, const RunOptions& options) : nominal_(nominal), options_(options) {}

  [[nodiscard]] const Scene& scene() const override { return nominal_.scene; }
  [[nodiscard]] const RunOptions& options() const override { return options_; }
  [[nodiscard]] std::vector<std::string> variants() const override;
  [[nodiscard]] const std::vector<FigureSpec>& figures() const override { return dynamics::planetary_figures(); }
  [[nodiscard]] FigureSet nominal(std::size_t ring) const override;
  bool prepare(const std::vector<Override>& overrides, const std::string& where,
               const std::string& folder) const override;
  [[nodiscard]] ChangedModel model(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                                   const std::string& folder, bool with_id) const override;
  [[nodiscard]] std::optional<StartSpread> starts(const std::vector<Override>& overrides, const std::string& where,
                                                  std::size_t ring, const std::string& folder, int count,
                                                  int seed) const override;

 private:
  [[nodiscard]] ChangedStage stage(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                                   const std::string& folder, bool with_id) const;
  [[nodiscard]] const MeshResult& nominal_mesh(std::size_t mesh) const;

  const RunResult& nominal_;
  const RunOptions& options_;
};

}  // namespace annulus::app
