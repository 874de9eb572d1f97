#include "app/systems/two_k_v/two_k_v_system.h"

#include <fmt/format.h>

#include "app/plan/plan.h"
#include "app/systems/two_k_v/two_k_v_lumped_model.h"
#include "app/systems/two_k_v/two_k_v_run.h"
#include "app/systems/two_k_v/two_k_v_scene.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"
#include "example_scenes.h"

namespace annulus::app {

namespace {

class TwoKVSystem final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    return fmt::format("{} cranks with a planet each, {} arc gears on {} pins, ratio {}", scene().stage.planets,
                       scene().arc_gear.count, scene().arc_gear.pins, to_text(two_k_v_kinematics(scene()).ratio(), 6));
  }

  void check() const override {
    check_two_k_v(scene());
    check_two_k_v_geometry(scene(), sun_planet_pair(scene()));
  }

  [[nodiscard]] std::vector<MeshModel> meshes() const override { return two_k_v_meshes(scene()); }

  [[nodiscard]] double mean_mesh_force() const override { return two_k_v_kinematics(scene()).mean_sun_mesh_force(); }

  /// The sun mesh; the arc mesh is a matter of formulas.
  [[nodiscard]] std::vector<MeshModel> model_meshes() const override { return {two_k_v_sun_model(scene())}; }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    return two_k_v_stiffness(scene(), mesh, "", options);
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t /*variant*/,
                                                   const std::vector<const MeshResult*>& tables) const override {
    return two_k_v_lumped_model(scene(), {stiffness_alone(*tables.front()), arc_pins_result(scene())});
  }

  [[nodiscard]] std::vector<PlannedResponse> responses() const override { return two_k_v_responses(scene()); }

  [[nodiscard]] std::unique_ptr<SystemRun> run() const override { return std::make_unique<TwoKVResult>(scene()); }

  [[nodiscard]] std::string title(std::size_t /*variant*/) const override { return "reducer"; }

  [[nodiscard]] ModelWays ways(std::size_t /*variant*/, const std::vector<const MeshResult*>& tables) const override {
    return two_k_v_ways(scene(), {*tables.front(), arc_pins_result(scene())});
  }

 protected:
  void describe(Plan& plan) const override { describe_two_k_v(scene(), plan); }
};

}  // namespace

SystemKind two_k_v_kind() {
  return {{"two_k_v", two_k_v_tables, check_two_k_v_scene, [] { return figure_keys(dynamics::two_k_v_figures()); },
           two_k_v_example},
          two_k_v_run_figures,
          dynamics::two_k_v_figures,
          [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<TwoKVSystem>(scene); }};
}

}  // namespace annulus::app
