#include "app/systems/helical_pair/pair_trade.h"

#include <cmath>

#include "app/scene/overrides.h"
#include "app/systems/helical_pair/pair_errors.h"
#include "app/systems/helical_pair/pair_lumped_model.h"
#include "app/tradeoff/trade_settings.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

FigureSet figures_of(const dynamics::HelicalPair& pair, const dynamics::PairResponse& response) {
  auto figures = dynamics::figures(response);
  figures.add(dynamics::frequency_figures(pair));
  return figures;
}

class PairTrade : public TradeSubject {
 public:
  explicit PairTrade(const Scene& scene)
      : scene_(scene), geometry_(make_pair_geometry(scene)), model_(pair_mesh_model(scene, geometry_)) {
    if (scene.dynamics) errors_ = pair_errors(scene);
  }

  [[nodiscard]] std::string name() const override { return "pinion and wheel"; }

  [[nodiscard]] std::vector<TradeMesh> meshes() const override {
    if (!model_.computed()) return {};
    return {{model_, !pair_solid_reason(scene_, geometry_).empty(), "pinion_wheel"}};
  }

  [[nodiscard]] std::vector<MeshModel> planned(double accuracy) const override {
    return {pair_mesh_model(with_accuracy(scene_, accuracy, "asked of the planner"), geometry_)};
  }

  [[nodiscard]] std::vector<MeshResult> tables_as_they_are(const RunOptions&) const override { return {}; }

  [[nodiscard]] bool has_motion() const override { return scene_.dynamics.has_value(); }

  [[nodiscard]] TradeMotion motion_on(const std::vector<MeshResult>& tables) const override {
    auto simulation = pair_simulation(scene_);
    simulation.keep_series = false;
    simulation.confirm = false;
    const auto result = lumped(tables);
    return {.fidelity = {}, .settings = {}, .id = result.id(simulation), .figures = [result, simulation] {
              auto response = dynamics::evaluate_pair(result.pair, simulation);
              return carried_pair_errors(result, simulation, response);
            }};
  }

  [[nodiscard]] std::vector<TradeMotion> motions(const std::vector<MeshResult>& tables, const RunOptions&,
                                                 const std::filesystem::path&) const override {
    const auto result = lumped(tables);
    auto given = pair_simulation(scene_);
    given.keep_series = false;
    given.integrator.method = dynamics::Integrator::automatic;
    given.integrator.fixed_step = 0;
    std::vector<TradeMotion> list;
    const auto add = [&](const std::string& fidelity, const std::string& settings, const dynamics::HelicalPair& pair,
                         const dynamics::SimulationOptions& simulation) -> TradeMotion& {
      auto changed = result;
      changed.pair = pair;
      list.push_back(
          {.fidelity = fidelity, .settings = settings, .id = changed.id(simulation), .figures = [pair, simulation] {
             const auto response = dynamics::evaluate_pair(pair, simulation);
             if (!response.steady) throw SolverError("the motion does not become periodic");
             return figures_of(pair, response);
           }});
      return list.back();
    };
    const auto& pair = result.pair;
    for (const auto& way : motion_settings(pair.mesh_frequency(), pair.error_period())) {
      auto simulation = given;
      way.apply(simulation);
      add(way.fidelity, way.settings, pair, simulation).finest = way.finest;
    }
    auto fine = given;
    fine.confirm = false;
    fine.samples_per_cycle = finest_samples;
    const auto without = [&](const char* what, double dynamics::PairGear::*bearing) {
      auto stiff = pair;
      bool changed = false;
      for (auto* gear : {&stiff.pinion, &stiff.wheel}) {
        changed = changed || std::isfinite(gear->*bearing);
        gear->*bearing = dynamics::rigid;
      }
      if (changed) add("fewer degrees of freedom", what, stiff, fine).changes_model = true;
    };
    without("shafts and bearings rigid across the axis", &dynamics::PairGear::bearing_transverse);
    without("shafts and bearings rigid along the axis", &dynamics::PairGear::bearing_axial);
    return list;
  }

 private:
  /// The lumped pair on these tables; without any on the stiffness that the scene gives.
  [[nodiscard]] LumpedPair lumped(const std::vector<MeshResult>& tables) const {
    return lumped_pair(scene_, geometry_,
                       tables.empty() ? pair_stiffness(scene_, geometry_, model_, {}) : tables.front(),
                       errors_.amplitude);
  }

  const Scene& scene_;
  PairGeometry geometry_;
  MeshModel model_;
  PairErrors errors_{};
};

}  // namespace

std::unique_ptr<TradeSubject> pair_trade_subject(const Scene& scene) { return std::make_unique<PairTrade>(scene); }

}  // namespace annulus::app
