#pragma once

#include <string>

#include "fem/loaded_mesh.h"

namespace annulus::app {

/// Deformation and stress of one body (`name` for people) near the contact, as HTML: a picture of the deformed body,
/// displacements exaggerated, coloured by von Mises stress, with the numbers from which view3d.js makes a view that can
/// be turned.
[[nodiscard]] std::string field_view(const fem::BodyField& field, const fem::LoadedPosition& position,
                                     const std::string& name);

}  // namespace annulus::app
