#pragma once

#include <string>

#include "app/scene/scene.h"

/// Displacements and strains are assumed to be small: flanks meet where those without load and errors do. These checks,
/// shared by the kinds of gear systems, refuse loads, supports and errors that are plainly too large for that; what
/// shows only when the bodies are solved is refused there (fem/problem/problem_check.h). Each throws InputError,
/// starting with the key.
namespace annulus::app {

/// Largest deflection that may be expected beforehand, in modules. Ten percent of a module are strains of some percent
/// in the teeth.
inline constexpr double largest_deflection = 0.1;

/// The rule on deflections, for messages.
[[nodiscard]] std::string small_displacements_rule();

/// `key` carries the load, of which one computed mesh carries `force` (N).
void check_load(const Scene& scene, const char* key, double force);
/// `key` carries the load, of which a mesh of prescribed stiffness carries `force` (N).
void check_prescribed_mesh(const Scene& scene, const char* key, const MeshInput& mesh, double force);
/// `key` is a bearing of `stiffness` (N/m) that carries `force` (N). Without a bearing the load is refused elsewhere,
/// as unbalanced.
void check_bearing(const Scene& scene, const char* key, double stiffness, double force);
/// `key` is a torsional support of `stiffness` (N/m) in u = `radius` (m) x angle, and carries `force` (N) there.
void check_torsional_support(const char* key, double stiffness, double force, double radius);
/// The deviation `value` (m) of `key`.
void check_error(const Scene& scene, const char* key, double value);

/// Whether finite elements or closed forms give the stiffness.
[[nodiscard]] bool has_elastic_bodies(const MeshInput& mesh);

}  // namespace annulus::app
