#include "app/systems/two_k_v/two_k_v_trade.h"

#include <algorithm>
#include <cmath>

#include "app/scene/overrides.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_motion.h"
#include "app/tradeoff/trade_settings.h"
#include "core/errors.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "dynamics/systems/two_k_v/two_k_v_response.h"

namespace annulus::app {

namespace {

/// The sun mesh and the motion. The arc mesh is a matter of formulas.
class TwoKVTrade : public TradeSubject {
 public:
  explicit TwoKVTrade(const Scene& scene) : scene_(scene), model_(two_k_v_sun_model(scene)) { check_two_k_v(scene); }

  [[nodiscard]] std::string name() const override { return "reducer"; }

  [[nodiscard]] std::vector<TradeMesh> meshes() const override {
    if (!model_.computed()) return {};
    return {{model_, model_.settings.fidelity == fem::Fidelity::solid, "sun_planet"}};
  }

  [[nodiscard]] std::vector<MeshModel> planned(double accuracy) const override {
    return {two_k_v_sun_model(with_accuracy(scene_, accuracy, "asked of the planner"))};
  }

  [[nodiscard]] std::vector<MeshResult> tables_as_they_are(const RunOptions&) const override {
    return {given_sun_result(scene_, model_)};
  }

  [[nodiscard]] bool has_motion() const override { return scene_.dynamics.has_value(); }

  [[nodiscard]] TradeMotion motion_on(const std::vector<MeshResult>& tables) const override {
    const auto all = with_arcs(tables);
    const auto models = two_k_v_models(scene_, all);
    return motion(models, simulation_of(models), all);
  }

  [[nodiscard]] std::vector<TradeMotion> motions(const std::vector<MeshResult>& tables, const RunOptions&,
                                                 const std::filesystem::path&) const override {
    const auto all = with_arcs(tables);
    const auto models = two_k_v_models(scene_, all);
    auto given = simulation_of(models);
    given.integrator.method = dynamics::Integrator::automatic;
    given.integrator.fixed_step = 0;
    std::vector<TradeMotion> list;
    for (const auto& way : shooting_settings()) {
      auto simulation = given;
      way.apply(simulation);
      list.push_back(motion(models, simulation, all));
      list.back().fidelity = way.fidelity;
      list.back().settings = way.settings;
      list.back().finest = way.finest;
    }
    return list;
  }

 private:
  [[nodiscard]] TwoKVTables with_arcs(const std::vector<MeshResult>& tables) const {
    return {tables.front(), arc_pins_result(scene_)};
  }

  [[nodiscard]] dynamics::SimulationOptions simulation_of(const TwoKVModels& models) const {
    auto simulation = two_k_v_simulation(scene_, models.moving);
    simulation.keep_series = false;
    return simulation;
  }

  [[nodiscard]] static TradeMotion motion(const TwoKVModels& models, const dynamics::SimulationOptions& simulation,
                                          const TwoKVTables& tables) {
    return {
        .fidelity = {}, .settings = {}, .id = two_k_v_id(models, simulation, tables), .figures = [models, simulation] {
          const auto response = dynamics::simulate(models.moving, simulation);
          if (!response.steady) throw SolverError("the motion does not become periodic");
          return evaluation_of(models, response).figures;
        }};
  }

  const Scene& scene_;
  MeshModel model_;
};

}  // namespace

std::unique_ptr<TradeSubject> two_k_v_trade_subject(const Scene& scene) { return std::make_unique<TwoKVTrade>(scene); }

}  // namespace annulus::app
