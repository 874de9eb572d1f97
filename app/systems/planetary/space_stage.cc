#include "app/systems/planetary/space_stage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "app/model/excitation.h"
#include "app/systems/planetary/carrier_pins.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/structure_input.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/units.h"
#include "dynamics/spatial/even_face.h"
#include "fem/problem/solved_face.h"
#include "geometry/profile.h"

namespace annulus::app {

namespace {

using dynamics::StageBody;
using dynamics::StageFace;
using Body = StageBody::Kind;

/// Every planet where none is named.
std::vector<StageBody> bodies_of(const Scene& scene, Body kind, const std::optional<int>& planet) {
  if (kind != Body::planet) return {{kind}};
  if (planet) return {{kind, *planet - 1}};
  std::vector<StageBody> all;
  all.reserve(static_cast<std::size_t>(scene.stage.planets));
  for (int n = 0; n < scene.stage.planets; ++n) all.push_back({kind, n});
  return all;
}

/// "rows", of planets one by one "rows planet2".
std::string name_of(const std::string& name, const StageBody& body, bool of_all) {
  return of_all ? fmt::format("{} {}", name, dynamics::name_of_body(body)) : name;
}

void add_bearings(const Scene& scene, dynamics::SpatialStage& stage) {
  for (const auto& input : scene.own<SpaceInput>().bearings)
    for (const auto& body : bodies_of(scene, input.body, input.planet)) {
      const bool of_all = body.kind == Body::planet && !input.planet;
      stage.bearings.push_back(stage_bearing(input, body, name_of(input.name, body, of_all)));
    }
}

/// After add_bearings().
void add_housing(const Scene& scene, dynamics::SpatialStage& stage) {
  const auto& input = scene.own<StructureInput>().housing;
  if (!input) return;
  dynamics::HousingStructure housing{{}, input->seats.stiffness};
  for (const auto& point : input->seats.points)
    for (std::size_t i = 0; i < stage.bearings.size(); ++i)
      if (stage.bearings[i].on.kind == Body::housing && column_of(stage.bearings[i].name) == point) {
        if (input->seats.turns && stage.bearings[i].body.kind == Body::ring)
          housing.ring_bearing = housing.bearings.size();
        housing.bearings.push_back(i);
      }
  stage.housing = std::move(housing);
}

void add_loads(const Scene& scene, std::size_t ring, dynamics::SpatialStage& stage) {
  const auto& space = scene.own<SpaceInput>();
  for (const auto& input : space.loads)
    for (const auto& body : bodies_of(scene, input.body, input.planet)) {
      const bool of_all = body.kind == Body::planet && !input.planet;
      stage.loads.push_back(stage_load(input, body, name_of(input.name, body, of_all)));
    }
  if (!space.gravity) return;
  const auto& g = *space.gravity;
  stage.gravity = g.vector();
  stage.weights = {{{Body::sun}, *sun_and_planets(scene).sun.mass, g.sun},
                   {{Body::ring}, *planetary(scene).rings.at(ring).mass, g.ring},
                   {{Body::carrier}, *planetary(scene).carrier.mass, g.carrier}};
  for (int n = 0; n < scene.stage.planets; ++n)
    stage.weights.push_back({{Body::planet, n}, *sun_and_planets(scene).planet.mass, g.planet});
}

/// Half the total normal backlash as the lumped model has it, both flanks; that of the gears where it does not say.
double backlash_of(const Scene& scene, const MeshInput& mesh, const geometry::GearPair& pair) {
  if (mesh.half_backlash) return 2 * *mesh.half_backlash;
  if (scene.dynamics) return 2 * scene.dynamics->half_backlash;
  return std::max(0.0, pair.normal_backlash());
}

/// The law of a whole mesh along the normal at a phase, and the scale of its stiffness.
struct WholeMesh {
  dynamics::MeshLaw law;
  double stiffness = 0;  ///< N/m
};

/// `c`: cos(base helix angle): forces are 1 / c times those of the transverse section, approaches c times.
WholeMesh whole_mesh(const dynamics::MeshExcitation& excitation, double phase, double c, bool back) {
  const auto linear = [&](double stiffness) {
    const double k = stiffness / (c * c);
    return WholeMesh{[k](double d) { return dynamics::MeshPoint{k * d * d / 2, k * d, k}; }, k};
  };
  if (const auto* constant = std::get_if<dynamics::ConstantStiffness>(&excitation)) return linear(constant->mean);
  if (const auto* wave = std::get_if<dynamics::HarmonicStiffness>(&excitation))
    return linear(wave->mean * (1 + wave->ripple * std::cos(2 * std::numbers::pi * (phase - wave->phase_shift))));
  if (const auto* wave = std::get_if<dynamics::RectangularStiffness>(&excitation)) {
    const double x = phase - wave->phase_shift;
    const bool high = x - std::floor(x) < wave->duty;
    return linear(wave->mean * (1 + wave->ripple * ((high ? 1 : 0) - wave->duty)));
  }
  const auto& table = std::get<dynamics::TableStiffness>(excitation);
  phase -= table.phase_shift;
  // Back flanks pass their contact the other way.
  const double at = back ? table.back_flank_phase.value_or(2 * phase) - phase : phase;
  if (!table.surface) return linear(table.secant(at));
  const auto surface = table.surface;
  const double scale = table.secant.mean();
  return {[surface, at, c](double d) {
            const auto [force, tangent] = (*surface)(at, d / c);
            return dynamics::MeshPoint{surface->energy(at, d / c), force / c, tangent / (c * c)};
          },
          scale / (c * c)};
}

/// m, of the transverse section: what the flanks are apart without load at a phase.
double unloaded_error(const dynamics::MeshExcitation& excitation, double phase) {
  const auto* table = std::get_if<dynamics::TableStiffness>(&excitation);
  return table ? table->unloaded_te(phase - table->phase_shift) : 0.0;
}

/// A face without its law.
StageFace bare_face(const Scene& scene, const geometry::GearPair& pair, const MeshInput& input, double misalignment) {
  StageFace face;
  const auto common = pair.common_face();
  face.middle = place_of_face(pair);
  const auto gaps = gaps_along(pair, misalignment, {-common.width / 2, common.width / 2});
  face.symmetric = std::abs(gaps[0] - gaps[1]) <= place_rounding * units::mm;
  face.backlash = backlash_of(scene, input, pair);
  return face;
}

/// Its law: solid gears, or a whole mesh that is spread evenly; back flanks always so.
void set_law(StageFace& face, const geometry::GearPair& pair, const MeshInput& input,
             const dynamics::MeshExcitation& excitation, double misalignment, int stretches,
             const std::shared_ptr<const fem::SolidFace>& solid, double mesh_force) {
  const double c = std::cos(pair.pinion().base_helix_angle());
  const auto [stations, gaps] = even_stations(pair, input, misalignment, stretches);
  face.law = [=, stations = stations, gaps = gaps](double phase,
                                                   StageFace::Flank flank) -> std::shared_ptr<const FaceLaw> {
    const bool back = flank == StageFace::Flank::back;
    if (solid && !back) return solid->at(phase, mesh_force / c);
    auto [law, stiffness] = whole_mesh(excitation, phase, c, back);
    auto gap = gaps;
    const double unloaded = c * unloaded_error(excitation, phase) * (back ? -1 : 1);
    for (double& g : gap) g = (back ? 0 : g) + unloaded;
    return std::make_shared<dynamics::EvenFace>(std::move(law), stiffness, stations, std::move(gap));
  };
}

bool lead_crowned(const GearInput& gear) { return gear.lead_crowning != 0; }

}  // namespace

dynamics::SpatialStage spatial_frame(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& set = geometry.rings.at(ring).set;
  dynamics::SpatialStage stage;
  stage.plane = stage_kinematics(scene, geometry, ring);
  auto& plane = stage.plane;
  const auto& supports = planetary(scene).supports;
  stage.pins = pins_in_space(scene, plane.planet_angles, plane.carrier.radius);
  plane.sun.support = supports.sun;
  plane.ring.support = supports.ring;
  plane.carrier.support = supports.carrier;
  plane.ring.torsional_support = torsional_support(scene, geometry::StageMember::ring);
  for (std::size_t n = 0; n < static_cast<std::size_t>(scene.stage.planets); ++n)
    plane.planet_bearings.push_back({.radial = supports.planet_bearing(&SupportInput::planet_radial, n),
                                     .tangential = supports.planet_bearing(&SupportInput::planet_tangential, n),
                                     .play = supports.planet_clearance / 2});
  const auto& planet = set.planet();
  stage.base_helix_angle = planet.helix_angle() == 0 ? 0.0 : planet.base_helix_angle();
  stage.planet_working_radius_sun = planet.base_radius() / std::cos(set.sun_mesh().working_pressure_angle());
  stage.planet_working_radius_ring = planet.base_radius() / std::cos(set.ring_mesh().working_pressure_angle());
  stage.sun_face = bare_face(scene, set.sun_mesh(), sun_and_planets(scene).sun_planet,
                             planetary(scene).errors.sun_planet_misalignment);
  stage.ring_face =
      bare_face(scene, set.ring_mesh(), planetary(scene).ring_planet, planetary(scene).errors.ring_planet_misalignment);
  add_bearings(scene, stage);
  add_housing(scene, stage);
  add_loads(scene, ring, stage);
  return stage;
}

bool varies_in_cycle(const MeshInput& mesh) { return mesh.stiffness != StiffnessShape::constant; }

dynamics::SpatialStage make_spatial_stage(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                          const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                          const StageFaces& faces) {
  auto stage = spatial_frame(scene, geometry, ring);
  const auto with_meshes = unsupported_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  auto& plane = stage.plane;
  plane.sun_tooth_errors = with_meshes.sun_tooth_errors;
  plane.ring_tooth_errors = with_meshes.ring_tooth_errors;
  plane.sun_mesh = with_meshes.sun_mesh;
  plane.ring_mesh = with_meshes.ring_mesh;
  // Of the ring's modes nothing moves in an equilibrium: with them the compliance is the same.
  if (ring_mesh.coupling && coupling_choice(scene, *ring_mesh.coupling).taken != RimCoupling::none)
    plane.ring_coupling = taken_coupling(*ring_mesh.coupling, RimCoupling::statical);
  for (const auto& [face, solid, mesh] :
       {std::tuple{&stage.sun_face, &faces.sun, &sun_mesh}, {&stage.ring_face, &faces.ring, &ring_mesh}})
    if (*solid) face->symmetric = fem::asymmetry_of_face(*mesh->model.problem).empty();
  // All of a face that is even is alike while nothing tilts.
  const bool crowned = lead_crowned(sun_and_planets(scene).sun) || lead_crowned(sun_and_planets(scene).planet) ||
                       lead_crowned(planetary(scene).rings[ring]);
  const int stretches = stage.reasons_for_space().empty() && !crowned ? 1 : faces.stretches;
  const auto& set = geometry.rings.at(ring).set;
  const double force = geometry.operating_point.mean_mesh_force;
  set_law(stage.sun_face, set.sun_mesh(), sun_and_planets(scene).sun_planet, plane.sun_mesh,
          planetary(scene).errors.sun_planet_misalignment, stretches, faces.sun, force);
  set_law(stage.ring_face, set.ring_mesh(), planetary(scene).ring_planet, plane.ring_mesh,
          planetary(scene).errors.ring_planet_misalignment, stretches, faces.ring, force);
  return stage;
}

std::vector<Warning> space_warnings(const Scene& scene, std::size_t ring, const dynamics::SpatialStage& stage,
                                    const StageFaces& faces) {
  std::vector<Warning> list;
  const auto& name = planetary(scene).rings.at(ring).name;
  if (!stage.reasons_for_space().empty()) {
    std::vector<std::string> held;
    for (const auto kind : {Body::sun, Body::ring, Body::carrier})
      if (!stage.has_bearings({kind})) held.push_back(dynamics::name_of_body({kind}));
    for (int n = 0; n < stage.planets(); ++n)
      if (!stage.has_bearings({Body::planet, n})) {
        held.emplace_back("planets");
        break;
      }
    if (!held.empty())
      list.push_back({"held_in_space", Severity::warning,
                      fmt::format("no [[bearing]] holds the {}: they are assumed neither to move along the axis nor to "
                                  "tilt (planets against the carrier). Tilting bodies load one end of the face more "
                                  "than the other",
                                  fmt::join(held, ", ")),
                      name});
  }
  for (const auto& [key, body, given] : {std::tuple{"supports.sun_N_per_m", Body::sun, planetary(scene).supports.sun},
                                         {"supports.ring_N_per_m", Body::ring, planetary(scene).supports.ring},
                                         {"supports.carrier_N_per_m", Body::carrier, planetary(scene).supports.carrier},
                                         {"supports.planet_N_per_m", Body::planet, planetary(scene).supports.planet}}) {
    const auto* input = scene.find(key);
    const bool written = input != nullptr && input->origin == Origin::scene && given > 0 && given != rigid;
    if (written && stage.has_radial_bearings({body}))
      list.push_back({"support_replaced", Severity::warning,
                      fmt::format("{} is left out: the {} is held by its [[bearing]] tables alone", key,
                                  body == Body::planet ? std::string("planet") : dynamics::name_of_body({body})),
                      name});
  }
  if (planetary(scene).supports.planet_clearance > 0 && stage.has_radial_bearings({Body::planet}))
    list.push_back({"support_replaced", Severity::warning,
                    "supports.planet_clearance_um is left out: the planets are held by their [[bearing]] tables alone, "
                    "which have clearance_um",
                    name});
  // In a plane stage a plane model has nothing along its face.
  const auto spread = [&](const MeshInput& input, const std::shared_ptr<const fem::SolidFace>& face) {
    return input.stiffness == StiffnessShape::computed && !face &&
           (!stage.reasons_for_space().empty() || scene.fidelity == Fidelity::solid);
  };
  if (spread(sun_and_planets(scene).sun_planet, faces.sun) || spread(planetary(scene).ring_planet, faces.ring))
    list.push_back(even_faces_warning(name));
  return list;
}

}  // namespace annulus::app
