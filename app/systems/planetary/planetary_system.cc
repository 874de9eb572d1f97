#include "app/systems/planetary/planetary_system.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>

#include "app/model/cost_actual.h"
#include "app/model/mesh_figures.h"
#include "app/scene/example_scenes.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_plan.h"
#include "app/systems/planetary/planetary_rexs.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/planetary_scene.h"
#include "app/systems/planetary/power_flow.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/roller_loads.h"
#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/stage_warnings.h"
#include "app/systems/planetary/static_results.h"
#include "app/systems/planetary/statics.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/rotors.h"
#include "core/errors.h"
#include "core/file_guard.h"
#include "dynamics/friction/friction_losses.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

class PlanetarySystem final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    return fmt::format("{} ring{}, {} planets", planetary(scene()).rings.size(),
                       planetary(scene()).rings.size() == 1 ? "" : "s", scene().stage.planets);
  }

  void check() const override {
    try {
      check_planetary_geometry(scene(), geometry());
    } catch (const Error&) {
      const auto faults = planetary_faults(scene());
      if (faults.size() < 2) throw;
      throw GeometryError(fmt::format("{}", fmt::join(faults, "\n")));
    }
    check_stage_bearings(scene(), geometry());
    if (scene().rotors.empty()) return;
    try {
      dynamics::check_ripples(rotors_of(scene()), stage_kinematics(scene(), geometry(), 0).shaft_ends());
    } catch (const InputError& error) {
      const bool listed = std::any_of(scene().rotors.begin(), scene().rotors.end(),
                                      [](const RotorInput& rotor) { return !rotor.ripple_orders.empty(); });
      throw InputError(fmt::format("rotor.{}: {}", listed ? "ripple_orders" : "torque_over_turn_Nm", error.what()));
    }
  }

  [[nodiscard]] DrawingData drawing() const override {
    const auto drawn = make_geometry(as_drawn(scene(), geometry().operating_point));
    const auto& sun_mesh = drawn.sun_mesh();
    DrawingData data{{{"sun", sun_mesh.wheel()}, {"planet", sun_mesh.pinion()}}, {{"planet and sun", sun_mesh}}};
    for (const auto& ring : drawn.rings) {
      const auto name = fmt::format("ring '{}'", ring.name);
      data.gears.push_back({name, ring.set.ring()});
      data.pairs.push_back({"planet and " + name, ring.set.ring_mesh()});
    }
    return data;
  }

  /// The sun mesh, then one mesh per ring.
  [[nodiscard]] std::vector<MeshModel> meshes() const override { return mesh_models(scene(), geometry()); }

  [[nodiscard]] double mean_mesh_force() const override { return geometry().operating_point.mean_mesh_force; }

  [[nodiscard]] std::vector<std::size_t> meshes_of(std::size_t ring) const override { return {0, ring + 1}; }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    return mesh_stiffness(scene(), geometry(), mesh, options);
  }

  void save_inputs(const SystemRun& run, const RunOptions& options) const override {
    for (std::size_t i = 0; i < planetary(scene()).rings.size(); ++i) {
      const auto file = options.out / planetary(scene()).rings[i].name / "strain_gauges.csv";
      const auto& mesh = run.tables.at(i + 1);
      const auto readings = gauge_readings(scene(), geometry().rings[i].set, mesh);
      if (!readings) {
        remove_file(file);
        continue;
      }
      auto csv = to_csv(*readings, geometry().operating_point.mirrored ? GaugeFrame::mirrored : GaugeFrame::ring);
      csv.header.insert(
          csv.header.begin(),
          {{"annulus_version", version()}, {"inputs_id", mesh.model.id()}, {"model", mesh.model.fidelity}});
      csv.write(file);
    }
  }

  [[nodiscard]] std::string table_for(const std::string& result) const override {
    if (result == dynamics::efficiency_figure().key && !has_friction(scene())) return "[friction]";
    const auto& input = planetary(scene());
    if (result == "planet_bearing_load_zone_rad" && input.supports.planet_clearance == 0)
      return "supports.planet_clearance_um";
    if (result == "held_torque_Nm" && !input.stage.held) return "a held member";
    return GearSystem::table_for(result);
  }

  [[nodiscard]] FigureSet table_figures(std::size_t ring, const std::vector<const MeshResult*>& tables) const override {
    auto figures = GearSystem::table_figures(ring, tables);
    figures.add(stage_losses(scene(), geometry(), ring, *tables.front(), *tables.back()));
    const auto& set = geometry().rings.at(ring).set;
    if (const auto readings = gauge_readings(scene(), set, *tables.back())) figures.add(app::figures(*readings));
    if (const auto loads = roller_loads(scene(), set, *tables.front())) figures.add(app::figures(*loads, sun_planet));
    if (const auto loads = roller_loads(scene(), set, *tables.back())) figures.add(app::figures(*loads, ring_planet));
    return figures;
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t ring,
                                                   const std::vector<const MeshResult*>& tables) const override {
    return planetary_model(scene(), geometry(), ring, *tables.front(), *tables.back());
  }

  [[nodiscard]] MovingFaces moving_faces(std::size_t ring, const std::vector<const MeshResult*>& tables,
                                         const RunOptions& options) const override {
    return moving_stage_faces(scene(), geometry(), ring, *tables.front(), *tables.back(), options);
  }

  [[nodiscard]] std::vector<PlannedResponse> responses() const override {
    return planetary_responses(scene(), geometry(), meshes());
  }

  [[nodiscard]] bool coupled(const MeshModel& mesh) const override { return may_be_coupled(scene(), mesh); }

  [[nodiscard]] std::optional<CostRun> actual_coupling(CostRun size, const MeshResult& mesh) const override {
    if (!mesh.coupling || mesh.coupling->reused) return std::nullopt;
    return actual_time(size, mesh.coupling->seconds);
  }

  [[nodiscard]] std::unique_ptr<RunResponse> respond(const SystemRun& run, std::size_t ring,
                                                     const RunOptions& options) const override {
    return ring_response(scene(), geometry(), ring, run.tables.front(), run.tables.at(ring + 1), options);
  }

  [[nodiscard]] std::string rexs(const std::string& ring) const override { return planetary_rexs(scene(), ring); }
  [[nodiscard]] std::string coordinates() const override {
    return "the frame turns with the carrier; x (towards planet 1 at time 0) and y of sun, ring and carrier, x "
           "(radial) and y (tangential) of each planet, z along the axis; u is the rotation and tiltx, tilty are"
           " the tilts times the base radius, of the carrier times the centre distance; all in m";
  }

  [[nodiscard]] std::vector<TurningBody> turning_bodies() const override {
    using geometry::StageMember;
    const auto stage = stage_kinematics(scene(), geometry(), 0);
    const auto& ring = geometry().rings.front().set;
    std::vector<TurningBody> bodies;
    for (const auto& [member, speed, torque] :
         {std::tuple{StageMember::sun, stage.sun_speed(), stage.sun_torque},
          {StageMember::carrier, stage.carrier_speed, -stage.carrier_torque()},
          {StageMember::ring, stage.ring_speed, stage.sun_torque * ring.ring().teeth() / ring.sun().teeth()}})
      if (torsional_support(scene(), member) != rigid)
        bodies.push_back({to_string(member), stage.body(member).radius, speed, torque});
    return bodies;
  }
  [[nodiscard]] std::optional<dynamics::LumpedCase> rough_lumped() const override {
    return dynamics::lumped_case(rough_stage(scene(), geometry(), 0));
  }

  [[nodiscard]] bool offers(SweepDirection /*direction*/) const override { return true; }

  [[nodiscard]] std::vector<Warning> scene_warnings() const override {
    return stage_scene_warnings(scene(), geometry());
  }
  [[nodiscard]] std::vector<Warning> response_warnings(const SystemRun& run, std::size_t ring) const override {
    const auto& response = static_cast<const RingResponse&>(*run.responses.at(ring));
    const auto& name = planetary(scene()).rings.at(ring).name;
    auto list = stage_warnings(response.stage.figures, name);
    if (moves_in_space(scene())) {
      auto more = face_warnings({{"sun mesh", &run.tables.front()}, {"ring mesh", &run.tables.at(ring + 1)}}, name);
      std::move(more.begin(), more.end(), std::back_inserter(list));
      auto of_bearings = space_result_warnings(response.stage.motion.space, scene().accuracy, name,
                                               "annulus statics has K_Hβ of gears that tilt");
      std::move(of_bearings.begin(), of_bearings.end(), std::back_inserter(list));
    }
    if (response.tolerances) {
      auto more = tolerance_warnings(*response.tolerances, run.tables_of(ring), name);
      std::move(more.begin(), more.end(), std::back_inserter(list));
    }
    return list;
  }

  [[nodiscard]] Json summary(const SystemRun& run) const override { return stage_summary(RunResult(run)); }
  [[nodiscard]] std::string text(const SystemRun& run) const override { return stage_text(RunResult(run)); }
  [[nodiscard]] Page report(const SystemRun& run) const override { return stage_report(RunResult(run)); }

  [[nodiscard]] std::shared_ptr<const SolvedCoupling> coupling(const MeshResult& mesh, const RunOptions& options,
                                                               const std::filesystem::path& folder) const override {
    return std::make_shared<SolvedCoupling>(
        solve_coupling(scene(), geometry(), mesh.model, 1 / mesh.mean_stiffness().value, options, folder));
  }

  [[nodiscard]] Statics statics(const RunOptions& options) const override {
    const auto solved = solve_statics(scene(), geometry(), options);
    write_statics(solved, options);
    Statics result{statics_text(solved), statics_json(solved), {}};
    for (const auto& ring : solved.rings)
      result.warnings.insert(result.warnings.end(), ring.warnings.begin(), ring.warnings.end());
    return result;
  }

  [[nodiscard]] ModelWays ways(std::size_t ring, const std::vector<const MeshResult*>& tables) const override {
    return planetary_ways(scene(), geometry(), ring, *tables.front(), *tables.back());
  }

 protected:
  void describe(Plan& plan) const override { describe_planetary(scene(), geometry(), plan); }

 private:
  [[nodiscard]] const GearGeometry& geometry() const {
    if (!geometry_) geometry_ = make_geometry(scene());
    return *geometry_;
  }
  mutable std::optional<GearGeometry> geometry_;
};

const std::vector<FigureSpec>& all_planetary_figures() {
  static const auto list =
      joined_figures({mesh_figure_specs(ring_planet, "ring mesh", "ring_stiffness", {"planet", "ring"}),
                      mesh_figure_specs(sun_planet, "sun mesh", "sun_stiffness", {"planet", "sun"}),
                      dynamics::friction_figure_specs({{sun_planet, "sun meshes"}, {ring_planet, "ring meshes"}}),
                      dynamics::planetary_figures(), tolerance_figures(), static_figures(),
                      dynamics::transient_figures(), roller_figure_specs(sun_planet, "sun mesh"),
                      roller_figure_specs(ring_planet, "ring mesh"), gauge_figure_specs()});
  return list;
}

}  // namespace

SystemKind planetary_kind() {
  return {{"planetary", planetary_tables, check_planetary_scene, [] { return figure_keys(stage_study_figures()); },
           example_scene("ring_types").c_str()},
          all_planetary_figures,
          stage_study_figures,
          [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<PlanetarySystem>(scene); },
          planetary_from_rexs};
}

}  // namespace annulus::app
