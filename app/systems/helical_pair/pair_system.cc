#include "app/systems/helical_pair/pair_system.h"

#include <fmt/format.h>

#include <cmath>

#include "app/model/mesh_figures.h"
#include "app/model/scene_warnings.h"
#include "app/plan/plan.h"
#include "app/results/content_id.h"
#include "app/scene/example_scenes.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_lumped_model.h"
#include "app/systems/helical_pair/pair_rexs.h"
#include "app/systems/helical_pair/pair_run.h"
#include "app/systems/helical_pair/pair_scene.h"
#include "app/systems/helical_pair/pair_space.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/mesh_names.h"
#include "dynamics/friction/friction_losses.h"

namespace annulus::app {

namespace {

class PairSystem final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    return fmt::format("helical pair, {} and {} teeth", helical_pair(scene()).pinion.teeth,
                       helical_pair(scene()).wheel.teeth);
  }

  void check() const override {
    const auto geometry = make_pair_geometry(scene());
    check_pair_geometry(scene(), geometry);
    check_pair_bearings(scene(), geometry);
  }

  [[nodiscard]] DrawingData drawing() const override {
    const auto geometry = make_pair_geometry(scene());
    return {{{"pinion", geometry.pinion()}, {"wheel", geometry.wheel()}}, {{"pinion and wheel", geometry.gears}}};
  }

  [[nodiscard]] std::vector<MeshModel> meshes() const override {
    return {pair_mesh_model(scene(), make_pair_geometry(scene()))};
  }

  [[nodiscard]] double mean_mesh_force() const override { return make_pair_geometry(scene()).transverse_force; }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    return pair_stiffness(scene(), make_pair_geometry(scene()), mesh, options);
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t /*variant*/,
                                                   const std::vector<const MeshResult*>& tables) const override {
    return pair_lumped_model(lumped(tables));
  }

  [[nodiscard]] MovingFaces moving_faces(std::size_t /*variant*/, const std::vector<const MeshResult*>& tables,
                                         const RunOptions& options) const override {
    return moving_pair_face(scene(), make_pair_geometry(scene()), lumped(tables).pair, *tables.front(), options);
  }

  [[nodiscard]] std::vector<PlannedResponse> responses() const override { return pair_responses(scene()); }

  void save_inputs(const SystemRun& run, const RunOptions& options) const override {
    const auto& mesh = run.tables.front();
    if (mesh.tabulated && !mesh.model.computed()) {
      auto table = mesh.table;
      table.provenance = {{"annulus_version", version()}, {"source", mesh.model.reason}};
      table.write_csv(options.out / "stiffness_pinion_wheel.csv");
    }
    save_pair_errors(pair_errors(scene()), options.out / "errors");
  }

  [[nodiscard]] std::string table_for(const std::string& result) const override {
    if (result == dynamics::efficiency_figure().key && !has_friction(scene())) return "[friction]";
    return GearSystem::table_for(result);
  }

  [[nodiscard]] FigureSet table_figures(std::size_t /*variant*/,
                                        const std::vector<const MeshResult*>& tables) const override {
    const PairMesh mesh(*tables.front());
    FigureSet figures;
    for (const auto& s : mean_stiffnesses(scene(), make_pair_geometry(scene()), mesh))
      if (s.taken) figures.set("mean_stiffness_N_per_m", {s.value, std::abs(s.value) * s.error_relative});
    if (mesh.computed) figures.add(mesh_figures(*mesh.computed));
    figures.add(pair_losses(scene(), make_pair_geometry(scene()), tables.front()->shares));
    return figures;
  }

  [[nodiscard]] std::unique_ptr<RunResponse> respond(const SystemRun& run, std::size_t /*variant*/,
                                                     const RunOptions& options) const override {
    return pair_response(scene(), run.tables.front(), options);
  }

  [[nodiscard]] std::vector<TurningBody> turning_bodies() const override {
    const auto geometry = make_pair_geometry(scene());
    const double speed = helical_pair(scene()).stage.pinion_speed, torque = helical_pair(scene()).stage.pinion_torque,
                 ratio = geometry.wheel().base_radius() / geometry.pinion().base_radius();
    return {{"pinion", geometry.pinion().base_radius(), speed, torque},
            {"wheel", geometry.wheel().base_radius(), -speed / ratio, torque * ratio}};
  }
  [[nodiscard]] std::string rexs(const std::string& /*ring*/) const override { return pair_rexs(scene()); }
  [[nodiscard]] std::string coordinates() const override {
    return "the frame is that of the housing; y along the transverse line of action, x across it, z along the "
           "axes; u is the rotation and tiltx, tilty are the tilts times the base radius; all in m";
  }

  [[nodiscard]] std::optional<dynamics::LumpedCase> rough_lumped() const override {
    return dynamics::lumped_case(rough_pair(scene()));
  }

  [[nodiscard]] bool offers(SweepDirection /*direction*/) const override { return true; }

  [[nodiscard]] std::vector<Warning> scene_warnings() const override {
    const auto geometry = make_pair_geometry(scene());
    std::vector<Warning> list;
    warn_of_clearance(list, geometry.gears, {"pinion", "wheel"}, "");
    warn_of_measured_flanks(list, geometry.gears, {"pinion", "wheel"}, "");
    warn_of_undercut(list, geometry.pinion(), "pinion");
    warn_of_undercut(list, geometry.wheel(), "wheel");
    if (const auto mesh = meshes().front(); !mesh.computed()) warn_of_shares(list, scene(), {"mesh"});
    if (scene().dynamics) {
      auto space = pair_space_warnings(scene());
      list.insert(list.end(), space.begin(), space.end());
    }
    if (scene().dynamics)
      warn_of_backlash(list, helical_pair(scene()).pinion_wheel.half_backlash.value_or(scene().dynamics->half_backlash),
                       geometry.gears, "");
    return list;
  }

  [[nodiscard]] std::vector<Warning> response_warnings(const SystemRun& run, std::size_t /*variant*/) const override {
    if (!pair_in_space(scene())) return {};
    auto list = face_warnings({{"mesh", &run.tables.front()}}, "");
    const auto more = space_result_warnings(PairRunResult(run).response->space, scene().accuracy, "", "");
    list.insert(list.end(), more.begin(), more.end());
    return list;
  }

  [[nodiscard]] Json summary(const SystemRun& run) const override { return pair_summary(PairRunResult(run)); }
  [[nodiscard]] std::string text(const SystemRun& run) const override { return pair_text(PairRunResult(run)); }
  [[nodiscard]] Page report(const SystemRun& run) const override { return pair_report(PairRunResult(run)); }

  [[nodiscard]] std::string title(std::size_t /*variant*/) const override { return "pinion and wheel"; }

  [[nodiscard]] ModelWays ways(std::size_t /*variant*/, const std::vector<const MeshResult*>& tables) const override {
    return pair_ways(lumped(tables));
  }

 protected:
  void describe(Plan& plan) const override { describe_pair(scene(), make_pair_geometry(scene()), plan); }

 private:
  [[nodiscard]] LumpedPair lumped(const std::vector<const MeshResult*>& tables) const {
    const auto geometry = make_pair_geometry(scene());
    const auto model = pair_mesh_model(scene(), geometry);
    // What is not computed is that of this scene.
    return lumped_pair(scene(), geometry,
                       model.computed() ? *tables.front() : pair_stiffness(scene(), geometry, model, {}),
                       pair_errors(scene()).amplitude);
  }
};

const std::vector<FigureSpec>& all_pair_figures() {
  static const auto list = [] {
    std::vector<FigureSpec> specs = {{.key = "mean_stiffness_N_per_m",
                                      .title = "Mean stiffness along the normal, as applied",
                                      .unit = "N/µm",
                                      .scale = 1e-6,
                                      .definition =
                                          "mean mesh stiffness along the normal of the flanks that the lumped "
                                          "model has",
                                      .effort = FigureEffort::tables,
                                      .guarantee = Guarantee::always,
                                      .quantity = "mean_stiffness",
                                      .compared = true}};
    return joined_figures({specs,
                           mesh_figure_specs(pinion_wheel, "mesh", "pinion_wheel_stiffness", {"pinion", "wheel"}),
                           dynamics::pair_figures(), dynamics::friction_figure_specs({{pinion_wheel, "mesh"}}),
                           dynamics::transient_figures()});
  }();
  return list;
}

}  // namespace

SystemKind helical_pair_kind() {
  return {{"helical_pair", pair_tables, check_pair_scene, [] { return figure_keys(pair_study_figures()); },
           example_scene("helical_pair").c_str()},
          all_pair_figures,
          pair_study_figures,
          [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<PairSystem>(scene); },
          pair_from_rexs};
}

}  // namespace annulus::app
