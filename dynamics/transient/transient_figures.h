#pragma once

#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/transient/transient.h"

/// The results of courses of speed and torque, each declared once.
namespace annulus::dynamics {

[[nodiscard]] const std::vector<FigureSpec>& transient_figures();
inline constexpr const char* course_force_key = "course_mesh_force_N";

/// Those of a course, with the change by a looser integration of it (`looser`), and of largest values that by half the
/// samples, as errors. Beside the declared ones, for each mesh and shaft of its own: course_element_key().
[[nodiscard]] FigureSet figures(const TransientResponse& course, const TransientResponse& looser);
/// Without errors.
[[nodiscard]] FigureSet figures(const TransientResponse& course);
/// The contact loss of a gear mesh, or the largest torque of a shaft over the nominal one. `row`: of
/// TransientResponse::meshes.
[[nodiscard]] std::string course_element_key(int row);

}  // namespace annulus::dynamics
