#pragma once

#include <string>
#include <vector>

#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// Why a loaded mesh is not its own mirror image about the middle of its face; empty when it is.
[[nodiscard]] std::string asymmetry_of_face(const LoadedMeshProblem& problem);

/// The part of the face width on which a solid mesh is solved: all of it, z from 0 to `width`, or of a problem that is
/// its own mirror image about the middle the lower half, up to a plane of symmetry at z = width / 2. A half is loaded
/// with half of the load; its forces are those of the whole face there, and so are its displacements and stresses.
enum class FacePart { whole, half };
struct SolvedFace {
  double width = 0;  ///< m, of the whole face
  bool half = false;

  [[nodiscard]] FacePart part() const { return half ? FacePart::half : FacePart::whole; }

  /// Borders of `pieces` equal pieces of the whole face, as far as they are solved, m: a half cuts the middle one of an
  /// odd number in two.
  [[nodiscard]] std::vector<double> edges(int pieces) const;
  /// Number of these pieces.
  [[nodiscard]] int solved(int pieces) const { return half ? (pieces + 1) / 2 : pieces; }
};

/// Half where the model, the settings and the problem permit it. All of it in the plane.
[[nodiscard]] SolvedFace solved_face(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings);

/// Values of the pieces of a half in the order of rising z, and the same on the whole face; borders likewise.
[[nodiscard]] std::vector<double> mirrored_values(const std::vector<double>& half);
[[nodiscard]] std::vector<double> mirrored_edges(const std::vector<double>& half);
/// A position of the half under its half of the load becomes that of the whole face (`width`, m).
void unfold(LoadedPosition& position, double width);

}  // namespace annulus::fem
