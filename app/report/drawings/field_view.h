#pragma once

#include <string>

#include "app/report/drawings/body_view.h"

namespace annulus::app {

/// A view as HTML: a picture of the deformed body, displacements exaggerated, coloured by von Mises stress, with the
/// numbers from which view3d.js makes a view that can be rotated.
[[nodiscard]] std::string view_html(const BodyView& view);
/// The same of a field; empty when it has no cells.
[[nodiscard]] std::string field_view(const fem::BodyField& field, const fem::LoadedPosition& position,
                                     const std::string& name);

}  // namespace annulus::app
