#include "app/systems/helical_pair/pair_system.h"

#include <fmt/format.h>

#include "app/plan/plan.h"
#include "app/systems/helical_pair/pair_lumped_model.h"
#include "app/systems/helical_pair/pair_run.h"
#include "app/systems/helical_pair/pair_scene.h"
#include "example_scenes.h"

namespace annulus::app {

namespace {

class PairSystem final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    return fmt::format("helical pair, {} and {} teeth", scene().pinion.teeth, scene().wheel.teeth);
  }

  void check() const override { check_pair_geometry(scene(), make_pair_geometry(scene())); }

  [[nodiscard]] std::vector<MeshModel> meshes() const override {
    return {pair_mesh_model(scene(), make_pair_geometry(scene()))};
  }

  [[nodiscard]] double mean_mesh_force() const override { return make_pair_geometry(scene()).transverse_force; }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    return pair_stiffness(mesh, options);
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t /*variant*/,
                                                   const std::vector<const MeshResult*>& tables) const override {
    const auto geometry = make_pair_geometry(scene());
    // Of this scene: its stiffness may be prescribed otherwise.
    auto mesh = stiffness_alone(*tables.front());
    mesh.model = pair_mesh_model(scene(), geometry);
    return pair_lumped_model(scene(), geometry, pair_mesh(scene(), geometry, std::move(mesh)));
  }

  [[nodiscard]] std::vector<PlannedResponse> responses() const override { return pair_responses(scene()); }

  [[nodiscard]] std::unique_ptr<SystemRun> run() const override { return std::make_unique<PairRunResult>(scene()); }

  [[nodiscard]] std::string title(std::size_t /*variant*/) const override { return "pinion and wheel"; }

  [[nodiscard]] ModelWays ways(std::size_t /*variant*/, const std::vector<const MeshResult*>& tables) const override {
    const auto geometry = make_pair_geometry(scene());
    return pair_ways(scene(), geometry, pair_mesh(scene(), geometry, *tables.front()));
  }

 protected:
  void describe(Plan& plan) const override { describe_pair(scene(), make_pair_geometry(scene()), plan); }
};

}  // namespace

SystemKind helical_pair_kind() {
  return {{"helical_pair", pair_tables, check_pair_scene, [] { return figure_keys(dynamics::pair_figures()); },
           helical_pair_example},
          pair_run_figures,
          dynamics::pair_figures,
          [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<PairSystem>(scene); }};
}

}  // namespace annulus::app
