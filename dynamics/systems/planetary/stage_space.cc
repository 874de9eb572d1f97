#include "dynamics/systems/planetary/stage_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/errors.h"
#include "dynamics/system/input_checks.h"

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;

/// Planets act on each other between one bearing of each, in its middle.
void check_carrier(const StageSpace& space, const LinearCoupling& coupling, int planets) {
  int of_planets = 0;
  for (const std::size_t i : coupling.bearings) {
    const auto& b = space.bearings[i];
    if (b.body.kind != Kind::planet) continue;
    if (b.place != 0 || b.body.planet != of_planets++)
      throw InputError(fmt::format(
          "bearing '{}' of planet {} on a carrier that gives way, at z = {} m, is not the one in its middle", b.name,
          b.body.planet + 1, b.place));
  }
  if (of_planets > 0 && (of_planets != planets || of_planets != std::ssize(coupling.bearings)))
    throw InputError(fmt::format("a carrier that gives way has {} bearings, {} of them of its {} planets",
                                 coupling.bearings.size(), of_planets, planets));
}

}  // namespace

void StageSpace::check(int planets) const {
  for (const auto& [inertia, name] : {std::pair{tilt_inertia.sun, "sun"},
                                      {tilt_inertia.ring, "ring"},
                                      {tilt_inertia.carrier, "carrier"},
                                      {tilt_inertia.planet, "planet"}})
    check_positive(inertia, fmt::format("tilting inertia of the {}", name));
  sun_face.check("sun meshes");
  ring_face.check("ring meshes");
  const auto check_body = [&](const StageBody& body, const std::string& what) {
    if (body.kind == Kind::planet && (body.planet < 0 || body.planet >= planets))
      throw InputError(fmt::format("{} names planet {} of {}", what, body.planet + 1, planets));
    if (body.kind == Kind::pin) throw InputError(what + " names a pin, which is no body of the dynamics");
  };
  for (const auto& b : bearings) {
    check_body(b.body, "bearing '" + b.name + "'");
    check_body(b.on, "bearing '" + b.name + "'");
    if (b.on.kind == Kind::planet) throw InputError(fmt::format("bearing '{}' stands on a planet", b.name));
    if (b.on.kind != Kind::housing && b.body.kind != Kind::planet &&
        std::find(b.rigid.begin(), b.rigid.end(), true) != b.rigid.end())
      throw InputError(fmt::format("bearing '{}' of the {} stands rigidly on the {}: give it a stiffness", b.name,
                                   name_of_body(b.body), name_of_body(b.on)));
  }
  for (const auto& load : loads) check_body(load.body, "a load");
  for (const auto& load : standing_loads) check_body(load.body, "a load");
  check_supports();
  for (const auto& coupling : couplings) check_carrier(*this, coupling, planets);
}

}  // namespace annulus::dynamics
