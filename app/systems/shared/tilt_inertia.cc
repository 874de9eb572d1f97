#include "app/systems/shared/tilt_inertia.h"

#include <fmt/format.h>

#include "app/scene/input_place.h"
#include "core/errors.h"

namespace annulus::app {

double tilt_inertia(const Scene& scene, const TiltingBody& body) {
  const double least = body.inertia / 2 + body.mass * body.centre_of_mass * body.centre_of_mass;  // of a thin disc
  if (!body.given) return least + body.mass * body.width * body.width / 12;
  if (*body.given < least)
    throw InputError(with_place(
        scene, fmt::format("tilt_inertia.{0}_kg_m2 = {1:g}: is less than {2:g}, which a thin disc with "
                           "{0}.inertia_kg_m2 = {3:g} has whose centre of mass is at z = {4:g} m; it is that about an "
                           "axis across the body's own, through the middle of the face of [stage]",
                           body.name, *body.given, least, body.inertia, body.centre_of_mass)));
  return *body.given;
}

}  // namespace annulus::app
