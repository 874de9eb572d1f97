#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "fem/problem/material.h"
#include "fem/problem/planet_rollers.h"
#include "fem/problem/ring_structure.h"
#include "fem/problem/strain_gauge.h"
#include "geometry/gear_pair.h"

namespace annulus {
class ResultStore;
}

namespace annulus::fem {

/// A gear mesh to be solved, external or internal, with the supports of its bodies.
struct LoadedMeshProblem {
  geometry::GearPair pair;
  MeshMaterials materials{};
  double face_width = 0;            ///< m, of the common face, on which the flanks touch
  double pinion_bore_radius = 0;    ///< m, rigid hub, or the raceway of rollers
  double wheel_support_radius = 0;  ///< m: bore of an external wheel (rigid hub), or outside radius of a ring
  RingStructure structure{};        ///< ring mesh only; the outside held unless set
  double misalignment = 0;          ///< m over the face width, normal to the flanks, > 0 opens towards +z
  geometry::Overhang pinion_overhang{}, wheel_overhang{};  ///< teeth beyond the common face
  std::vector<double> loads{};                             ///< N, total normal forces, strictly increasing
  int phases = 16;                                         ///< positions per mesh cycle
  std::string name = "mesh";                               ///< of the mesh in its stiffness table
  std::vector<StrainGauge> gauges{};                       ///< on the wheel; of condensed models with elements
  std::optional<PlanetRollers> planet_rollers{};           ///< of condensed models with elements, spur teeth
};

/// Estimated relative error of a stiffness in plane strain for a face of finite width: towards its ends the material is
/// free to expand. Solid elements are softer by 5.2, 3.8, 2.8 and 1.2 % (ring mesh) and 4.2, 2.9, 2.4 and 0.6 % (sun
/// mesh) at face widths of 2, 5, 10 and 25 modules and a Poisson ratio of 0.3; plane stress throughout would be softer
/// by nu^2 / (1 - nu^2) = 9.9 %. 0.65 of that, falling with the width in units of ten modules, lies above.
[[nodiscard]] double plane_strain_error(const LoadedMeshProblem& problem);

/// What a plane section leaves out of the stiffness: that, and what teeth beyond the common face support.
[[nodiscard]] double plane_error(const LoadedMeshProblem& problem);

/// What teeth leave out that end where their tip chamfers begin (ToothProfile), and then touch with another edge. Whole
/// teeth that do not touch there are stiffer by up to 0.7, 1.0 and 1.2 % at any position, at chamfers of 0.1, 0.2 and
/// 0.4 modules of a ring; those of planets and suns differ by less.
[[nodiscard]] double chamfer_error(const LoadedMeshProblem& problem);

/// The wheel, as its supports see it.
[[nodiscard]] inline SupportedRing supported_ring(const LoadedMeshProblem& problem) {
  return {problem.pair.wheel().teeth(), problem.wheel_support_radius,
          problem.face_width + problem.wheel_overhang.total(), problem.materials.wheel};
}
/// The single supports of the wheel; none where a surface holds it. Throws InputError when they cannot hold it.
[[nodiscard]] inline SupportSites support_sites(const LoadedMeshProblem& problem) {
  return problem.structure.supports(supported_ring(problem));
}

enum class Fidelity { closed_form, plane, solid, resolved_plane, resolved_solid };
[[nodiscard]] constexpr const char* fidelity_name(Fidelity f) {
  constexpr const char* names[] = {"closed_form", "plane", "solid", "resolved_plane", "resolved_solid"};
  return names[static_cast<int>(f)];
}
[[nodiscard]] constexpr bool is_solid(Fidelity f) { return f == Fidelity::solid || f == Fidelity::resolved_solid; }
[[nodiscard]] constexpr bool is_resolved(Fidelity f) {
  return f == Fidelity::resolved_plane || f == Fidelity::resolved_solid;
}

/// Relative error that is left in the stiffness of a model however fine it is.
[[nodiscard]] inline double model_error(const LoadedMeshProblem& problem, Fidelity fidelity) {
  return (is_solid(fidelity) ? 0 : plane_error(problem)) + chamfer_error(problem);
}

/// What condensed models recover inside the bodies, in a result with a table: its stresses, or its fields as well,
/// where the wheel's root is stressed most or over a mesh cycle.
enum class Recovery { stresses, fields, fields_of_cycle };

struct LoadedMeshSettings {
  Fidelity fidelity = Fidelity::plane;
  /// Wanted relative accuracy of the stiffness at the middle load of the table: the mesh is refined until the estimate
  /// of every position meets it. Entries at other loads carry their own estimate.
  double accuracy = 0.01;
  /// Polynomial degree of the elements. Linear ones give way to quadratic ones where the first level does not do,
  /// unless a level is forced.
  int degree = 2;
  /// Forces one level of resolution (1, 2, ...; its error estimated from the level before) instead of refining.
  std::optional<int> level{};
  /// Solid models solve half of the face width where the problem is its own mirror image about the middle: the same
  /// results in a fraction of the time.
  bool symmetry = true;
  /// In modules: larger ones are refused, because a linear model with its unloaded flanks no longer describes them.
  double largest_deflection = std::numeric_limits<double>::infinity();
  Recovery recovery = Recovery::stresses;
  int threads = 1;                                  ///< changes the time, never the result
  std::function<void(double fraction)> progress{};  ///< called now and then with the finished fraction
  /// Called before a level is solved, with the degree of its elements; what it throws ends the solve.
  std::function<void(int degree, int level)> before_level{};
  /// Where tooth superelements are cached; may be null. They depend neither on loads and phases nor on the
  /// places, the number and the stiffness of supports, nor on modifications of the flanks.
  std::shared_ptr<const ResultStore> store{};
};

}  // namespace annulus::fem
