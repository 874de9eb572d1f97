#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/export/named_arrays.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// Matrices of the lumped system of a scene (of one variant of it) at its operating point, with the names of rows and
/// columns, the frame and the origin as provenance. Solves its stiffness tables, or reads them from the cache.
[[nodiscard]] NamedArrays lumped_matrices(const Scene& scene, const std::string& variant, int threads);

/// Matrix Market: an array is a file of its own beside `file`, my.mtx is my_mass_kg.mtx, my_damping_N_s_per_m.mtx and
/// so on, with the provenance as comments. Returns them. Throws FileError.
std::vector<std::filesystem::path> write_matrix_market(const std::filesystem::path& file, const NamedArrays& arrays);

}  // namespace annulus::app
