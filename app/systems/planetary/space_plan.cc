#include "app/systems/planetary/space_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/space_stage.h"
#include "app/systems/shared/bearing_words.h"

namespace annulus::app {

namespace {

using dynamics::StageBearing;
using Body = dynamics::StageBody::Kind;

bool in_housing(const dynamics::SpatialStage& stage, Body kind) {
  return stage.housing && std::any_of(stage.housing->bearings.begin(), stage.housing->bearings.end(),
                                      [&](std::size_t i) { return stage.bearings[i].body.kind == kind; });
}

}  // namespace

bool has_statics_in_space(const Scene& scene) { return moves_in_space(scene) || scene.stage.helix_angle != 0; }

std::vector<DofPlan> dofs_in_space(const Scene& scene, const GearGeometry& geometry, std::vector<DofPlan> plane) {
  if (!moves_in_space(scene) && (scene.dynamics || !has_statics_in_space(scene))) return plane;
  const auto stage = spatial_frame(scene, geometry, 0);
  const bool leaves_plane = !stage.reasons_for_space().empty();
  std::vector<DofPlan> list;
  const auto of_plane = [&](const std::string& dof) {
    for (const auto& entry : plane)
      if (entry.name.starts_with(dof) && &entry != &plane.back()) list.push_back(entry);
  };
  const std::string planets = fmt::format("planet 1 ... {}", scene.stage.planets);
  for (const auto& [kind, name] : {std::pair{Body::sun, std::string("sun")},
                                   {Body::ring, "ring"},
                                   {Body::carrier, "carrier"},
                                   {Body::planet, planets}}) {
    std::vector<StageBearing> bearings;
    for (auto b : stage.bearings) {
      if (b.body.kind != kind || (kind == Body::planet && b.body.planet != 0)) continue;
      if (const auto own = " " + dynamics::name_of_body(b.body); b.name.ends_with(own))
        b.name.resize(b.name.size() - own.size());
      bearings.push_back(std::move(b));
    }
    const auto in_series = [&, kind = kind](DofPlan dof) {
      if (kind == Body::planet && stage.pins) return DofPlan{dof.name, true, "pins and carrier give way"};
      if (in_housing(stage, kind)) return DofPlan{dof.name, true, "the housing gives way"};
      return dof;
    };
    if (stage.has_radial_bearings({kind}))
      list.push_back(in_series(radial_dof(name, bearings)));
    else
      of_plane(name == planets ? "planet" : name + " x, y");
    if (!leaves_plane) {
      list.push_back(no_dof_out_of_plane(name));
    } else if (bearings.empty()) {
      list.push_back(in_series({name + " z, tilts", false,
                                "no [[bearing]] holds it: it is assumed neither to move along the axis nor to tilt"}));
    } else {
      list.push_back(in_series(axial_dof(name, bearings)));
      list.push_back(in_series(tilt_dof(name, bearings)));
    }
    if (kind == Body::ring && stage.housing && stage.housing->ring_bearing)
      list.push_back({"ring u", true, "the housing gives way"});
    else if (kind == Body::ring && stage.ring_turns_in_mounts())
      list.push_back({"ring u", true, "bearings beside its axis give way"});
    else if (kind == Body::carrier && !scene.dynamics)
      list.push_back({"carrier u", false, "its angle is that of the position"});
    else if (kind != Body::planet)
      of_plane(name + " u");
  }
  list.push_back(plane.back());  // the planets turn
  return list;
}

std::string remark_on_statics(const Scene& scene, const GearGeometry& geometry) {
  if (!has_statics_in_space(scene)) return {};
  const auto reasons = spatial_frame(scene, geometry, 0).reasons_for_space();
  const char* where = moves_in_space(scene) ? "In space" : "annulus statics";
  if (reasons.empty())
    return fmt::format(
        "{}: no body moves along the axis or tilts. The teeth are spur, and faces, bearings and loads are symmetric "
        "about the middle of the face.",
        where);
  return fmt::format("{}: bodies also move along the axis and tilt, because {}.", where, fmt::join(reasons, "; "));
}

}  // namespace annulus::app
