#include "app/systems/planetary/planetary_trade.h"
#include "app/systems/planetary/rim_coupling.h"

#include <algorithm>
#include <cmath>

#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/process/measured_work.h"
#include "app/results/content_id.h"
#include "app/scene/overrides.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/tradeoff/trade_settings.h"
#include "core/errors.h"
#include "core/log.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

/// `errors` of the tables, where frequencies are to carry them.
FigureSet figures_of(const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response,
                     const std::optional<MeshStiffnessErrors>& errors) {
  auto figures = dynamics::figures(response);
  auto frequencies = frequency_figures(stage_modes(stage, errors.value_or(MeshStiffnessErrors{})));
  for (const auto& e : frequencies.entries())
    figures.set(e.key, {e.figure.value, errors ? e.figure.error : not_known}, e.parts);
  return figures;
}

/// A model with something left out or added.
struct StageChange {
  std::string fidelity, settings;
  std::function<void(dynamics::PlanetaryStage& stage)> change;
  int samples = finest_samples;
};

std::vector<StageChange> stage_changes(const dynamics::PlanetaryStage& stage,
                                       const std::shared_ptr<const RingCoupling>& elastic) {
  using Stage = dynamics::PlanetaryStage;
  std::vector<StageChange> list;
  const auto without = [&](const char* what, auto drop) { list.push_back({"fewer degrees of freedom", what, drop}); };
  if (std::isfinite(stage.sun.support)) without("sun held in place", [](Stage& s) { s.sun.support = dynamics::rigid; });
  if (std::isfinite(stage.ring.support))
    without("ring held in place", [](Stage& s) { s.ring.support = dynamics::rigid; });
  if (std::isfinite(stage.ring.torsional_support) && stage.ring.torsional_support > 0)
    without("ring held against rotation", [](Stage& s) { s.ring.torsional_support = dynamics::rigid; });
  if (std::isfinite(stage.carrier.support))
    without("carrier held in place", [](Stage& s) { s.carrier.support = dynamics::rigid; });
  if (std::isfinite(stage.planet.bearing_radial))
    without("planet bearings rigid",
            [](Stage& s) { s.planet.bearing_radial = s.planet.bearing_tangential = dynamics::rigid; });
  if (stage.ring_coupling)
    list.push_back({"coupling", "planets not coupled through the ring", [](Stage& s) { s.ring_coupling = nullptr; }});
  if (elastic)
    list.push_back({"coupling", "ring with its elastic modes", [elastic](Stage& s) { s.ring_coupling = elastic; }, 64});
  return list;
}

/// One ring of a planetary set.
class PlanetaryTrade : public TradeSubject {
 public:
  PlanetaryTrade(const Scene& scene, std::size_t ring)
      : scene_(scene), ring_(ring), geometry_(make_geometry(scene)), plan_(make_plan(scene)) {}

  [[nodiscard]] std::string name() const override { return scene_.rings.at(ring_).name; }

  [[nodiscard]] std::vector<TradeMesh> meshes() const override {
    if (!sun().computed() || !wheel().computed()) return {};
    return {{sun(), !solid_reason(scene_).empty(), "sun_planet"},
            {wheel(), !solid_reason(scene_, scene_.rings.at(ring_)).empty(), name()}};
  }

  [[nodiscard]] std::vector<MeshModel> planned(double accuracy) const override {
    const Scene scene = with_accuracy(scene_, accuracy, "asked of the planner");
    return {sun_mesh_model(scene, geometry_), ring_mesh_model(scene, geometry_, ring_)};
  }

  [[nodiscard]] std::vector<MeshResult> tables_as_they_are(const RunOptions& options) const override {
    std::vector<MeshResult> tables;
    for (const auto* model : {&sun(), &wheel()}) {
      const auto make = [&] { return mesh_stiffness(scene_, geometry_, *model, options); };
      // What solves anything does it in a process of its own and is read back.
      if (model->computed()) {
        const auto done = measured([&] {
          (void)make();
          return std::string("solved");
        });
        if (!done.failure.empty()) throw SolverError(done.failure);
      }
      tables.push_back(make());
    }
    return tables;
  }

  [[nodiscard]] bool has_motion() const override { return scene_.dynamics.has_value(); }

  [[nodiscard]] TradeMotion motion_on(const std::vector<MeshResult>& tables) const override {
    const auto &sun = tables.front(), &wheel = tables.back();
    auto stage = make_stage(scene_, geometry_, ring_, sun, wheel);
    auto simulation = simulation_options(scene_, stage);
    simulation.keep_series = false;
    simulation.confirm = false;
    TradeMotion motion{.fidelity = {}, .settings = {}, .id = response_id(stage, simulation, sun, wheel), .figures = {}};
    motion.figures = [this, stage = std::move(stage), simulation, &sun, &wheel] {
      auto response = dynamics::simulate(stage, simulation);
      const auto make = [&](const MeshResult& s, const MeshResult& w) {
        return make_stage(scene_, geometry_, ring_, s, w);
      };
      const auto errors = carried_errors(response, simulation, {make, sun, wheel});
      set_errors(errors, response);
      return figures_of(stage, response, stiffness_errors(sun, wheel));
    };
    return motion;
  }

  [[nodiscard]] std::vector<TradeMotion> motions(const std::vector<MeshResult>& tables, const RunOptions& options,
                                                 const std::filesystem::path& folder) const override {
    const auto &sun = tables.front(), &wheel = tables.back();
    const auto coupling = solved_coupling(wheel, options, folder / "coupling");
    auto stage = make_stage(scene_, geometry_, ring_, sun, wheel);
    stage.ring_coupling = coupling.statical;
    auto given = simulation_options(scene_, stage);
    given.keep_series = false;
    given.integrator.method = dynamics::Integrator::automatic;
    given.integrator.fixed_step = 0;
    std::vector<TradeMotion> list;
    const auto add = [&](const std::string& fidelity, const std::string& settings,
                         const dynamics::PlanetaryStage& model,
                         const dynamics::SimulationOptions& simulation) -> TradeMotion& {
      list.push_back({.fidelity = fidelity,
                      .settings = settings,
                      .id = response_id(model, simulation, sun, wheel),
                      .figures = [model, simulation] {
                        const auto response = dynamics::simulate(model, simulation);
                        if (!response.steady) throw SolverError("the motion does not become periodic");
                        return figures_of(model, response, std::nullopt);
                      }});
      return list.back();
    };
    const auto ways = motion_settings(stage.mesh_frequency(), stage.error_period());
    const auto directly = [&](int samples) {
      auto simulation = given;
      simulation.confirm = false;
      simulation.samples_per_cycle = samples;
      return simulation;
    };
    for (const auto& way : ways) {
      auto simulation = given;
      way.apply(simulation);
      add(way.fidelity, way.settings, stage, simulation).finest = way.finest;
    }
    for (const auto& [fidelity, settings, change, samples] : stage_changes(stage, coupling.elastic)) {
      auto changed = stage;
      change(changed);
      add(fidelity, settings, changed, directly(samples)).changes_model = true;
    }
    return list;
  }

 private:
  struct Couplings {
    std::shared_ptr<const RingCoupling> statical{}, elastic{};
  };

  [[nodiscard]] const MeshModel& sun() const { return plan_.meshes.front(); }
  [[nodiscard]] const MeshModel& wheel() const { return plan_.meshes.at(ring_ + 1); }

  /// Static coupling, and with the ring's modes, of this ring mesh; none where it is of no concern.
  [[nodiscard]] Couplings solved_coupling(const MeshResult& mesh, const RunOptions& options,
                                          const std::filesystem::path& folder) const {
    if (!mesh.model.computed() || !may_be_coupled(scene_, mesh.model)) return {};
    const double compliance = 1 / mesh.mean_stiffness().value;
    const auto done = measured([&] {
      (void)solve_coupling(scene_, geometry_, mesh.model, compliance, options, folder);
      return std::string("solved");
    });
    if (!done.failure.empty()) {
      log::warn("the coupling of the planets is left out: " + done.failure);
      return {};
    }
    const auto solved = solve_coupling(scene_, geometry_, mesh.model, compliance, options, folder);  // from the cache
    Couplings couplings{taken_coupling(solved, RimCoupling::statical), nullptr};
    if (!solved.coupling.modes.empty()) couplings.elastic = taken_coupling(solved, RimCoupling::elastic);
    return couplings;
  }

  const Scene& scene_;
  std::size_t ring_;
  GearGeometry geometry_;
  Plan plan_;
};

}  // namespace

std::unique_ptr<TradeSubject> planetary_trade_subject(const Scene& scene, std::size_t ring) {
  return std::make_unique<PlanetaryTrade>(scene, ring);
}

}  // namespace annulus::app
