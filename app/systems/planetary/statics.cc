#include "app/systems/planetary/statics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/model/plan_studies.h"
#include "app/model/table_errors.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/space_stage.h"
#include "app/systems/planetary/static_errors.h"
#include "app/systems/planetary/structure_input.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/space_results.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

using dynamics::SpatialStage;
using dynamics::StaticPosition;
using dynamics::StaticSchedule;
using dynamics::StaticTurn;

std::vector<BearingStatics> all_bearings(const SpatialStage& stage, const StaticTurn& turn, const FigureSet& figures) {
  std::vector<BearingStatics> list;
  const auto made = dynamics::assemble(stage, 0);
  for (std::size_t b = 0; b < turn.bearing_names.size(); ++b) {
    const auto of = [&](const char* what) { return figures.figure(bearing_key(b, what)); };
    auto& bearing = list.emplace_back(BearingStatics{.name = turn.bearing_names[b],
                                                     .body = dynamics::name_of_body(made.bearings.at(b).body),
                                                     .radial = of("radial"),
                                                     .axial = of("axial"),
                                                     .moment = of("moment")});
    if (made.bearings.at(b).rolling) bearing.element = of("element");
    for (const auto& p : turn.positions) bearing.mean_radial += p.bearings[b].force.head<2>().norm();
    bearing.mean_radial /= static_cast<double>(turn.positions.size());
  }
  return list;
}

/// In the mirror image y, and what turns about x and z, have the other sign.
void mirror(StaticTurn& turn) {
  for (auto& p : turn.positions) {
    p.carrier_angle = -p.carrier_angle;
    p.carrier_torque = -p.carrier_torque;
    p.ring_torque = -p.ring_torque;
    for (auto& b : p.bearings) {
      b.force.y() = -b.force.y();
      b.moment.x() = -b.moment.x();
    }
    for (auto& b : p.bodies) {
      b.displacement.y() = -b.displacement.y();
      b.rotation.x() = -b.rotation.x();
      b.rotation.z() = -b.rotation.z();
    }
  }
}

/// Places and phases that show something. One period of the housing is smooth; several at once, as of eccentric gears,
/// need more places to meet their worst coincidence.
StaticSchedule schedule_of(const Scene& scene, const SpatialStage& stage, const StageFaces& faces) {
  const auto& wanted = scene.own<StructureInput>().statics;
  const bool in_cycle =
      varies_in_cycle(sun_and_planets(scene).sun_planet) || varies_in_cycle(planetary(scene).ring_planet);
  const bool solid = faces.sun || faces.ring;
  const int usual_phases = 8, period = dynamics::period_of(stage);
  const bool errors = stage.plane.error_period() > 1;
  const int usual_places = errors ? (solid ? 96 : 768) : solid ? 16 : 32;
  return dynamics::places_over(period, wanted.places.value_or(usual_places),
                               wanted.phases.value_or(in_cycle ? usual_phases : 1));
}

void check_sun(const Scene& scene) {
  const auto& bearings = scene.own<SpaceInput>().bearings;
  const auto* sun = scene.find("supports.sun_N_per_m");
  const bool given = sun != nullptr && sun->origin == Origin::scene;
  const bool has_bearing = std::any_of(bearings.begin(), bearings.end(), [](const auto& b) {
    return b.body == dynamics::StageBody::Kind::sun && b.holds_radially();
  });
  if (!given && !has_bearing && scene.stage.planets > 1)
    throw InputError(fmt::format(
        "{}: supports.sun_N_per_m: is required by annulus statics where no [[bearing]] holds the sun radially: it "
        "has the largest effect on load sharing; give a stiffness, \"floating\" or \"rigid\"",
        scene.file.string()));
}

void warn_of_back_flanks(std::vector<Warning>& list, const StaticTurn& turn, const SpatialStage& stage,
                         const std::string& ring) {
  int count = 0;
  for (const auto& p : turn.positions) {
    const auto carries = [](const auto& m) { return m.back_flanks; };
    count += std::any_of(p.sun_meshes.begin(), p.sun_meshes.end(), carries) ||
             std::any_of(p.ring_meshes.begin(), p.ring_meshes.end(), carries);
  }
  if (count > 0)
    list.push_back(
        {"back_flanks", Severity::warning,
         fmt::format(
             "back flanks carry load in {} of {} positions, behind a normal backlash of {:.3g} µm in the sun mesh "
             "and {:.3g} µm in the ring mesh (half_backlash_um of the mesh or of [dynamics], otherwise that of "
             "the profile shifts). They have the mean stiffness of the driving flanks and no lead modifications",
             count, turn.positions.size(), *stage.sun_face.backlash / units::um, *stage.ring_face.backlash / units::um),
         ring});
}

/// Meshes whose load somewhere on the face is beyond their table, which is continued there.
void warn_of_loads_beyond(std::vector<Warning>& list, const StaticTurn& turn, const MeshResult& mesh, bool sun,
                          const std::string& ring, double normal_factor) {
  if (!mesh.tabulated || mesh.table.loads().size() < 2) return;
  const auto& stations = sun ? turn.sun_stations : turn.ring_stations;
  const double width = stations.back() - stations.front(), most = mesh.table.loads().back();
  double largest_load = 0;
  for (const auto& p : turn.positions)
    for (const auto& m : sun ? p.sun_meshes : p.ring_meshes)
      for (const double load : m.line_load) largest_load = std::max(largest_load, load * width * normal_factor);
  if (largest_load <= most) return;
  list.push_back(
      {"beyond_table", Severity::warning,
       fmt::format("{}: the load somewhere on the face is that of {:.3g} kN on all of it, more than the {:.3g} "
                   "kN up to which its stiffness is tabulated; it is continued there with its last tangent",
                   sun ? "sun mesh" : "ring mesh", largest_load / 1e3, most / 1e3),
       ring});
}

/// Bearings that bear more than the end of their table.
void warn_of_bearing_tables(std::vector<Warning>& list, const StaticTurn& turn, const SpatialStage& stage,
                            const std::string& ring) {
  for (std::size_t i = 0; i < stage.bearings.size(); ++i) {
    const auto& bearing = stage.bearings[i];
    if (bearing.force.empty()) continue;
    const double most = largest(turn, [&](const StaticPosition& p) { return p.bearings.at(i).force.head<2>().norm(); });
    if (most > bearing.force.back())
      list.push_back(beyond_bearing_table(bearing.name, most, bearing.force.back(), ring));
  }
}

struct RingProblem {
  const Scene& scene;
  const GearGeometry& geometry;
  std::size_t ring;
  const MeshResult &sun_mesh, &ring_mesh;
  const std::shared_ptr<const fem::SolidFace>&sun_face, &ring_face;
};

/// The results with the errors that the tables of meshes without solid faces bring. `decisive`: decisive_places().
FigureSet with_errors_of_tables(const RingProblem& of, const StageFaces& faces, const StaticResults& results,
                                const StaticTurn& decisive, int threads) {
  std::vector<const MeshResult*> tables;
  if (!faces.sun) tables.push_back(&of.sun_mesh);
  if (!faces.ring) tables.push_back(&of.ring_mesh);
  const auto evaluate = [&](const std::vector<const MeshResult*>& changed) {
    const auto& sun = faces.sun ? of.sun_mesh : *changed.front();
    const auto& ring = faces.ring ? of.ring_mesh : *changed.back();
    const auto stage = make_spatial_stage(of.scene, of.geometry, of.ring, sun, ring, faces);
    return dynamics::Evaluation{values(results, dynamics::solve_turn(stage, decisive.schedule, threads, &decisive)),
                                {}};
  };
  return with_table_errors({values(results, decisive), {}}, tables, evaluate,
                           {.simulation = {}, .seeks_steady_state = false, .nominal_alike = true});
}

RingStatics solve_ring(const RingProblem& of, const RunOptions& options) {
  const auto make = [&](const StageFaces& faces) {
    return make_spatial_stage(of.scene, of.geometry, of.ring, of.sun_mesh, of.ring_mesh, faces);
  };
  const StageFaces faces{.sun = of.sun_face, .ring = of.ring_face};
  const auto stage = make(faces);
  const auto schedule = schedule_of(of.scene, stage, faces);
  RingStatics result;
  result.ring = planetary(of.scene).rings[of.ring].name;
  result.turn = dynamics::solve_turn(stage, schedule, options.threads);
  const auto solve = [&](const SpatialStage& changed) {
    return dynamics::solve_turn(changed, schedule, options.threads, &result.turn);
  };
  const auto results = results_of(result.turn);
  StaticErrors errors(
      results, with_errors_of_tables(of, faces, results, decisive_places(results, result.turn), options.threads));
  using Periods = StaticErrors::Periods;
  errors.add_positions(result.turn, stage.plane.error_period() == 1 ? Periods::one : Periods::several);
  // The elements leave no more than what a level changes.
  if (faces.sun || faces.ring)
    errors.add_difference(
        solve(make({.sun = solid_face(of.sun_mesh, options, 1), .ring = solid_face(of.ring_mesh, options, 1)})),
        &ErrorParts::discretisation);
  const auto spread = [&](const std::shared_ptr<const fem::SolidFace>& face) { return !face; };
  if ((spread(faces.sun) && result.turn.sun_stations.size() > 2) ||
      (spread(faces.ring) && result.turn.ring_stations.size() > 2)) {
    auto fewer = faces;
    fewer.stretches /= 2;
    errors.add_difference(solve(make(fewer)), &ErrorParts::discretisation, of_half_the_points);
  }
  result.figures = errors.figures();
  result.bearings = all_bearings(stage, result.turn, result.figures);
  for (std::size_t b = 0; b < result.turn.body_names.size(); ++b)
    result.tilt.push_back(result.figures.figure(tilt_key(b)));
  result.reasons = stage.reasons_for_space();
  result.period = dynamics::period_of(stage);
  result.mean_mesh_force = stage.plane.mean_mesh_force();
  result.worst_residual = largest(result.turn, [](const StaticPosition& p) { return p.residual_relative; });
  result.warnings = space_warnings(of.scene, of.ring, stage, faces);
  warn_of_back_flanks(result.warnings, result.turn, stage, result.ring);
  warn_of_bearing_tables(result.warnings, result.turn, stage, result.ring);
  const double normal_factor = std::cos(stage.base_helix_angle);
  if (!faces.sun) warn_of_loads_beyond(result.warnings, result.turn, of.sun_mesh, true, result.ring, normal_factor);
  if (!faces.ring) warn_of_loads_beyond(result.warnings, result.turn, of.ring_mesh, false, result.ring, normal_factor);
  if (of.geometry.operating_point.mirrored) mirror(result.turn);
  return result;
}

void warn_of_studies(StageStatics& statics) {
  std::vector<std::string> names;
  for (const auto& study : plan_studies(statics.scene)) names.push_back(study.name);
  if (names.empty()) return;
  statics.rings.front().warnings.push_back(
      {"studies_left_out", Severity::warning,
       fmt::format("annulus statics answers the scene as it stands and leaves out {}; annulus run has them",
                   fmt::join(names, ", "))});
}

void warn_of_friction(StageStatics& statics) {
  if (!has_friction(statics.scene)) return;
  statics.rings.front().warnings.push_back(
      {"friction_left_out", Severity::warning,
       "annulus statics has flanks without friction; annulus run has [friction] in the motion"});
}

}  // namespace

StageStatics solve_statics(const Scene& scene, const GearGeometry& geometry, const RunOptions& run_options) {
  check_sun(scene);
  RunOptions options = run_options;
  options.with_dynamics = false;
  options.out = run_options.out / "statics";  // beside the tables of a run, which may have another model
  std::vector<MeshResult> tables;
  std::vector<std::shared_ptr<const fem::SolidFace>> faces;
  for (const auto& model : mesh_models(scene, geometry)) {
    auto& mesh = tables.emplace_back(mesh_stiffness(scene, geometry, model, options));
    if (may_be_coupled_at_rest(scene, model))
      mesh.coupling = std::make_shared<SolvedCoupling>(solve_coupling(
          scene, geometry, model, 1 / mesh.mean_stiffness().value, options, options.out / model.variant));
    faces.push_back(solid_face(mesh, options));
  }
  StageStatics statics{scene, {}};
  for (std::size_t ring = 0; ring < planetary(scene).rings.size(); ++ring) {
    try {
      statics.rings.push_back(solve_ring(
          {scene, geometry, ring, tables.front(), tables.at(ring + 1), faces.front(), faces.at(ring + 1)}, options));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: ring '{}': {}", scene.file.string(), planetary(scene).rings[ring].name, error.what()));
    }
  }
  warn_of_studies(statics);
  warn_of_friction(statics);
  return statics;
}

}  // namespace annulus::app
