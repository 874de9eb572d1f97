#include "app/systems/planetary/space_dynamics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/scene/input_place.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/space_stage.h"
#include "app/systems/planetary/stage_members.h"
#include "app/systems/planetary/structure_input.h"
#include "app/systems/shared/bearing_words.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/shared/tilt_inertia.h"
#include "core/errors.h"
#include "core/log.h"
#include "dynamics/spatial/even_face.h"
#include "dynamics/systems/planetary/working_point.h"
#include "fem/face_shape.h"
#include "fem/problem/solved_face.h"

namespace annulus::app {

namespace {

dynamics::StageSpace::TiltInertia tilt_inertias(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& given = scene.own<SpaceInput>().tilt_inertia;
  const auto& set = geometry.rings.at(ring).set;
  const auto& input = planetary(scene).rings.at(ring);
  const auto g = scene.own<SpaceInput>().gravity.value_or(GravityInput{});
  const auto width = [](const geometry::Gear& gear) { return gear.parameters().face_width; };
  const auto of = [&](const TiltingBody& body) { return tilt_inertia(scene, body); };
  return {of({"sun", given.sun, *sun_and_planets(scene).sun.mass, *sun_and_planets(scene).sun.inertia, width(set.sun()),
              g.sun}),
          of({"ring", given.ring, *input.mass, *input.inertia, width(set.ring()), g.ring}),
          of({"carrier", given.carrier, *planetary(scene).carrier.mass, *planetary(scene).carrier.inertia,
              width(set.planet()), g.carrier}),
          of({"planet", given.planet, *sun_and_planets(scene).planet.mass, *sun_and_planets(scene).planet.inertia,
              width(set.planet())})};
}

}  // namespace

bool moves_in_space(const Scene& scene) {
  const auto& structure = scene.own<StructureInput>();
  return scene.own<SpaceInput>().any() || structure.carrier || structure.housing;
}

void check_stage_bearings(const Scene& scene, const GearGeometry& geometry) {
  if (!moves_in_space(scene)) return;
  for (std::size_t ring = 0; ring < planetary(scene).rings.size(); ++ring) {
    auto stage = spatial_frame(scene, geometry, ring);
    const auto& set = geometry.rings.at(ring).set;
    for (const auto& [face, pair] :
         {std::pair{&stage.sun_face, &set.sun_mesh()}, {&stage.ring_face, &set.ring_mesh()}}) {
      const double half = pair->common_face().width / 2, stiffness = nominal_mesh_stiffness(*pair);
      face->law = [=](double, dynamics::StageFace::Flank) {
        return std::make_shared<dynamics::EvenFace>(stiffness, std::vector{-half, half}, std::vector{0.0, 0.0});
      };
    }
    about(scene, "bearing", [&] { dynamics::assemble(stage, 0).mechanism.check(); });
  }
}

void put_in_space(dynamics::PlanetaryStage& stage, const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                  const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  if (stage.ring_coupling && !stage.ring_coupling->modes.empty())
    throw InputError(with_place(scene,
                                "dynamics.rim_coupling = \"elastic\": a ring in [[bearing]] tables has no elastic "
                                "modes; use \"static\" or \"automatic\""));
  auto spatial = make_spatial_stage(scene, geometry, ring, sun_mesh, ring_mesh, {});
  spatial.plane.planet.mass = stage.planet.mass;
  for (const auto& [face, mesh] : {std::pair{&spatial.sun_face, &sun_mesh}, {&spatial.ring_face, &ring_mesh}})
    if (mesh->face) face->symmetric = fem::asymmetry_of_face(*mesh->model.problem).empty();
  const auto inertias = tilt_inertias(scene, geometry, ring);
  about(scene, "bearing", [&] { stage.space = dynamics::space_about_equilibrium(spatial, inertias); });
  stage.space->laws = scene.own<SpaceInput>().bearing_laws;
  if (const auto& g = scene.own<SpaceInput>().gravity) stage.space->mass_place = {g->sun, g->ring, g->carrier};
  const auto& set = geometry.rings.at(ring).set;
  const auto& e = planetary(scene).errors;
  stage.space->sun_face = motion_face(set.sun_mesh(), sun_and_planets(scene).sun_planet, sun_mesh.face,
                                      e.sun_planet_misalignment, GapsAlong::transverse_section);
  stage.space->ring_face = motion_face(set.ring_mesh(), planetary(scene).ring_planet, ring_mesh.face,
                                       e.ring_planet_misalignment, GapsAlong::transverse_section);
  stage.sun.support = stage.ring.support = stage.carrier.support = rigid;
  stage.planet_bearings.clear();
}

MovingFaces moving_stage_faces(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                               const MeshResult& sun_mesh, const MeshResult& ring_mesh, const RunOptions& options) {
  StageFaces faces;
  if (sun_mesh.face) faces.sun = solid_face(sun_mesh, options);
  if (ring_mesh.face) faces.ring = solid_face(ring_mesh, options);
  const auto stage = std::make_shared<const dynamics::SpatialStage>(
      make_spatial_stage(scene, geometry, ring, sun_mesh, ring_mesh, faces));
  const auto law = [stage](std::size_t mesh, double cycles) {
    const bool of_sun = mesh < static_cast<std::size_t>(stage->planets());
    return (of_sun ? stage->sun_face : stage->ring_face).law(cycles, dynamics::StageFace::Flank::driving);
  };
  return {law, std::cos(stage->base_helix_angle)};
}

std::vector<Warning> space_dynamics_warnings(const Scene& scene, const GearGeometry& geometry) {
  const auto& space = scene.own<SpaceInput>();
  std::vector<Warning> list;
  if (!moves_in_space(scene)) return list;
  const auto frame = spatial_frame(scene, geometry, 0);
  if (space.gravity && space.gravity->planet != 0)
    list.push_back({"mass_in_middle", Severity::warning,
                    "the inertia of planets acts in the middle of their face in the dynamics, their weight at "
                    "gravity.planet_at_mm"});
  std::vector<std::string> past_carrier, directed;
  const bool turns = frame.plane.carrier_speed != 0;
  const auto in_housing = [&](const BearingInput& b) {
    const auto& housing = scene.own<StructureInput>().housing;
    if (!housing) return false;
    const auto& points = housing->seats.points;
    return std::find(points.begin(), points.end(), column_of(b.name)) != points.end();
  };
  for (const auto& b : space.bearings) {
    const auto made = stage_bearing(b, {b.body}, b.name);
    const bool past = turns && (in_housing(b) || made.beside.any());
    if (past && dynamics::is_nonlinear(made)) past_carrier.push_back("'" + b.name + "'");
    const bool stands = made.frame() == dynamics::StageFrame::housing;
    if ((stands && b.has_directions()) || in_housing(b) || made.beside.any()) directed.push_back("'" + b.name + "'");
  }
  if (!past_carrier.empty())
    list.push_back(
        {"bearings_linear", Severity::warning,
         fmt::format(
             "the carrier turns past bearing {}, which lies beside the axis or on a housing that gives way. In "
             "the dynamics such bearings have their stiffness at the equilibrium at time 0, and the force that "
             "they bear there. Vibrations that change their load by a large part are not right; annulus statics "
             "has their whole law",
             fmt::join(past_carrier, ", "))});
  if (!directed.empty())
    list.push_back(
        {"bearings_averaged", Severity::warning,
         fmt::format("bearing {} in the housing does not have equal stiffness in all directions; the dynamics "
                     "has its mean over a turn of the carrier",
                     fmt::join(directed, ", "))});
  std::vector<std::string> assumed;
  for (const auto& [value, key] : {std::pair{&space.tilt_inertia.sun, "sun"},
                                   {&space.tilt_inertia.ring, "ring"},
                                   {&space.tilt_inertia.carrier, "carrier"},
                                   {&space.tilt_inertia.planet, "planet"}})
    if (!*value) assumed.push_back(fmt::format("tilt_inertia.{}_kg_m2", key));
  if (!assumed.empty()) list.push_back(tilt_inertia_assumed(assumed));
  // Which faces are even is known once the meshes are solved.
  auto assumptions = space_warnings(scene, 0, frame, {});
  std::erase_if(assumptions, [](const Warning& w) { return w.key == "even_faces"; });
  list.insert(list.end(), assumptions.begin(), assumptions.end());
  return list;
}

}  // namespace annulus::app
