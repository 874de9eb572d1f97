#pragma once

#include <string>

#include "app/scene/scene.h"
#include "geometry/gear.h"

/// Limits of the models, shared by the kinds of gear systems: bodies that are meshed need a rim, and displacements and
/// strains are assumed to be small, so that flanks meet where those without load and errors do. Loads, supports and
/// errors that are plainly too large for that are refused; what shows only when the bodies are solved is refused there
/// (fem/problem/problem_check.h). Each check throws, starting with the key: GeometryError for rims, else InputError.
namespace annulus::app {

/// Relative rounding of diameters that come from sums.
inline constexpr double diameter_rounding = 1e-9;
/// Largest deflection that may be expected beforehand, in modules. Ten percent of a module are strains of some percent
/// in the teeth.
inline constexpr double largest_deflection = 0.1;

/// Displacement of a gear from its nominal position, in modules: flanks overlap by two modules, and half of one reduces
/// the contact ratio to one.
inline constexpr double largest_gear_displacement = 0.5;
[[nodiscard]] double displacement_limit(const Scene& scene);  ///< the same, m

/// Least thickness of a rim behind the root, m.
[[nodiscard]] double least_rim(const Scene& scene);
/// "a computed mesh needs 1.2 mm = 0.3 modules of rim behind the root"
[[nodiscard]] std::string rim_rule(const Scene& scene);
/// The rule on deflections, for messages.
[[nodiscard]] std::string small_displacements_rule();
/// `length` (m) with its unit: "663.6 mm".
[[nodiscard]] std::string length_mm(double length);

/// The bore of [`table`] leaves the gear a rim. Without bore nothing is checked.
void check_bore(const Scene& scene, const char* table, const HubGearInput& input, const geometry::Gear& gear);
/// `key` carries the load, of which one computed mesh carries `force` (N) on a face of `face_width` (m);
/// `youngs_modulus` (Pa) of its gears in series.
void check_load(const Scene& scene, const char* key, double force, double face_width, double youngs_modulus);
/// `key` carries the load, of which a mesh of prescribed stiffness carries `force` (N).
void check_prescribed_mesh(const Scene& scene, const char* key, const MeshInput& mesh, double force);
/// `key` is a bearing of `stiffness` (N/m) that carries `force` (N). Without a bearing the load is refused elsewhere,
/// as unbalanced.
void check_bearing(const Scene& scene, const char* key, double stiffness, double force);
/// `key` is a torsional support of `stiffness` (N/m) in u = `radius` (m) x angle, and carries `force` (N) there.
void check_torsional_support(const char* key, double stiffness, double force, double radius);
/// The deviations of [errors], but for misalignments.
void check_deviations(const Scene& scene);

}  // namespace annulus::app
