#include "app/systems/two_k_v/two_k_v_system.h"

#include <fmt/format.h>

#include "app/model/mesh_figures.h"
#include "app/model/scene_warnings.h"
#include "app/plan/plan.h"
#include "app/scene/example_scenes.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_run.h"
#include "app/systems/two_k_v/two_k_v_scene.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"

namespace annulus::app {

namespace {

class TwoKVSystem final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    return fmt::format("{} cranks with a planet each, {} arc gears on {} pins, ratio {}", scene().stage.planets,
                       two_k_v(scene()).arc_gear.count, two_k_v(scene()).arc_gear.pins,
                       to_text(two_k_v_kinematics(scene()).ratio(), 6));
  }

  void check() const override {
    check_two_k_v(scene());
    check_two_k_v_geometry(scene(), sun_planet_pair(scene()));
  }

  /// The arc teeth are no involutes.
  [[nodiscard]] DrawingData drawing() const override {
    const auto pair = sun_planet_pair(scene());
    return {{{"sun", pair.wheel()}, {"planet", pair.pinion()}}, {{"planet and sun", pair}}};
  }

  [[nodiscard]] std::vector<MeshModel> meshes() const override { return two_k_v_meshes(scene()); }

  [[nodiscard]] double mean_mesh_force() const override { return two_k_v_kinematics(scene()).mean_sun_mesh_force(); }

  /// The sun mesh; the arc mesh is a matter of formulas.
  [[nodiscard]] std::vector<MeshModel> model_meshes() const override { return {two_k_v_sun_model(scene())}; }
  [[nodiscard]] std::vector<MeshModel> run_meshes() const override { return two_k_v_run_meshes(scene()); }
  [[nodiscard]] std::vector<RunVariant> run_variants() const override { return two_k_v_run_variants(scene()); }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    return two_k_v_stiffness(scene(), mesh, options);
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t /*variant*/,
                                                   const std::vector<const MeshResult*>& tables) const override {
    const TwoKVTables both{stiffness_alone(*tables.front()), arc_pins_result(scene())};
    const auto models = two_k_v_models(scene(), both);
    models.moving.check();
    auto simulation = two_k_v_simulation(scene(), models.moving);
    simulation.keep_series = false;
    return std::make_unique<LumpedModel>(
        two_k_v_id(models, simulation, both),
        [models, simulation](Answer wanted) -> StudyPoint {
          auto figures = dynamics::static_figures(models.at_nominal, models.arc_clearance);
          if (wanted == Answer::without_motion)
            figures.set("steady", 1);  // nothing was integrated
          else
            figures.add(dynamics::figures(models.moving, dynamics::simulate(models.moving, simulation)));
          return {.figures = {dynamics::two_k_v_figures(), figures}};
        },
        LumpedModel::Abilities{{},
                               [models, simulation](const dynamics::SystemState* start) -> LumpedModel::FollowedPoint {
                                 auto figures = dynamics::static_figures(models.at_nominal, models.arc_clearance);
                                 const auto response =
                                     dynamics::simulate(models.moving, dynamics::followed_from(simulation, start));
                                 figures.add(dynamics::figures(models.moving, response));
                                 return {{.figures = {dynamics::two_k_v_figures(), figures}}, response.end};
                               },
                               [models] { return dynamics::lumped_case(models.moving); }});
  }

  [[nodiscard]] std::string coordinates() const override {
    return "the frame turns with the output carrier; x of cranks and arc gears across their eccentricities; u is"
           " the rotation times a radius: the base radius of input, sun and planets, the eccentricity of cranks,"
           " the radius of the crank circle of arc gears and output; all in m";
  }

  [[nodiscard]] std::vector<TurningBody> turning_bodies() const override {
    const auto stage = two_k_v_kinematics(scene());
    std::vector<TurningBody> bodies;
    if (two_k_v(scene()).input.support != rigid)
      bodies.push_back(
          {"input", stage.sun_base_radius(), stage.output_speed * stage.ratio(), stage.output_torque / stage.ratio()});
    if (two_k_v(scene()).output.support != rigid)
      bodies.push_back({"output", stage.crank_circle_radius(), stage.output_speed, -stage.output_torque});
    return bodies;
  }
  [[nodiscard]] std::optional<dynamics::LumpedCase> rough_lumped() const override {
    return dynamics::lumped_case(rough_two_k_v(scene()));
  }

  [[nodiscard]] std::vector<PlannedResponse> responses() const override { return two_k_v_responses(scene()); }

  /// Tables of the arc meshes that formulas give.
  void save_inputs(const SystemRun& run, const RunOptions& options) const override {
    const auto all = run_variants();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& arc = *run.tables_of(i).back();
      if (!arc.tabulated || arc.model.fidelity == "prescribed") continue;
      std::filesystem::create_directories(options.out / all[i].folder);
      arc.table.write_csv(options.out / all[i].folder / "stiffness_arc_pins.csv");
    }
  }

  [[nodiscard]] std::unique_ptr<RunResponse> respond(const SystemRun& run, std::size_t variant,
                                                     const RunOptions& options) const override {
    std::vector<double> published;
    if (run.reference)
      for (const auto& value : run.reference->values)
        if (value.quantity == "frequency_1_Hz") published.push_back(value.value);
    return two_k_v_response(variant == 0 ? scene() : *compared_scene(scene()), run_variants()[variant],
                            run.tables_of(variant), published, options);
  }

  [[nodiscard]] bool offers(SweepDirection direction) const override { return direction != SweepDirection::branches; }

  [[nodiscard]] std::vector<Warning> scene_warnings() const override {
    const auto pair = sun_planet_pair(scene());
    std::vector<Warning> list;
    warn_of_clearance(list, pair, {"planet", "sun"}, "sun mesh");
    warn_of_measured_flanks(list, pair, {"planet", "sun"}, "sun mesh");
    warn_of_undercut(list, pair.wheel(), "sun");
    warn_of_undercut(list, pair.pinion(), "planet");
    return list;
  }

  [[nodiscard]] Json summary(const SystemRun& run) const override { return two_k_v_summary(TwoKVResult(run)); }
  [[nodiscard]] std::string text(const SystemRun& run) const override { return two_k_v_text(TwoKVResult(run)); }
  [[nodiscard]] Page report(const SystemRun& run) const override { return reducer_report(TwoKVResult(run)); }

  [[nodiscard]] std::string title(std::size_t /*variant*/) const override { return "reducer"; }

  [[nodiscard]] ModelWays ways(std::size_t /*variant*/, const std::vector<const MeshResult*>& tables) const override {
    return two_k_v_ways(scene(), {*tables.front(), arc_pins_result(scene())});
  }

 protected:
  void describe(Plan& plan) const override { describe_two_k_v(scene(), plan); }
};

const std::vector<FigureSpec>& all_two_k_v_figures() {
  static const auto list =
      joined_figures({mesh_figure_specs(sun_planet, "sun mesh", "sun_stiffness", {"planet", "sun"}),
                      mesh_figure_specs(arc_pins, "arc mesh", "arc_stiffness"), dynamics::two_k_v_figures(),
                      dynamics::transient_figures()});
  return list;
}

}  // namespace

SystemKind two_k_v_kind() {
  return {{"two_k_v", two_k_v_tables, check_two_k_v_scene, [] { return figure_keys(dynamics::two_k_v_figures()); },
           example_scene("arc_tooth_2kv").c_str()},
          all_two_k_v_figures,
          dynamics::two_k_v_figures,
          [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<TwoKVSystem>(scene); }};
}

}  // namespace annulus::app
