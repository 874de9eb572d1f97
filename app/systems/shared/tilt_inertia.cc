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
        scene, fmt::format("tilt_inertia.{0}_kg_m2 = {1:g}: must be at least {2:g}, that of a thin disc with "
                           "{0}.inertia_kg_m2 = {3:g} and its centre of mass at z = {4:g} m. Its axis lies across that "
                           "of the body, in the middle of the face of [stage]",
                           body.name, *body.given, least, body.inertia, body.centre_of_mass)));
  return *body.given;
}

}  // namespace annulus::app
