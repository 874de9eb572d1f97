#include "app/export/matrices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>

#include "app/model/gear_system.h"
#include "app/results/content_id.h"
#include "app/run/solved_case.h"
#include "app/scene/overrides.h"
#include "core/errors.h"
#include "core/files.h"
#include "dynamics/modes/linear_system.h"

namespace annulus::app {

namespace {

NamedArray array_of(const char* name, const Eigen::MatrixXd& matrix) {
  NamedArray array{name, {static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())}, {}, {}};
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) array.values.push_back(matrix(i, j));
  return array;
}

}  // namespace

NamedArrays lumped_matrices(const Scene& scene, const std::string& variant, int threads) {
  const auto found = solved_case(scene, variant, threads);
  const auto linear = dynamics::linear_system(found.system);
  return {{{"annulus_version", version()},
           {"scene", scene.title},
           {variant_word(scene.stage.kind), variant},
           {"equation",
            "M q'' + (C + G) q' + (K + K_rotation) q = load; K and C contain the meshes, B K_mesh B' and B c_mesh B'"},
           {"coordinates", fmt::format("{}", fmt::join(linear.dofs, " "))},
           {"meshes", fmt::format("{}", fmt::join(linear.meshes, " "))},
           {"frame", make_system(scene)->coordinates()},
           {"mesh_frequency_Hz", fmt::format("{}", found.problem.mesh_frequency)}},
          {array_of("M_kg", linear.mass), array_of("C_N_s_per_m", linear.damping),
           array_of("G_N_s_per_m", linear.gyroscopic), array_of("K_N_per_m", linear.stiffness),
           array_of("K_rotation_N_per_m", linear.rotating_stiffness), array_of("B", linear.mesh_vectors),
           array_of("K_mesh_N_per_m", linear.mesh_stiffness), array_of("c_mesh_N_s_per_m", linear.mesh_damping),
           array_of("load_N", linear.load)},
          scene_text(scene, {})};
}

std::vector<std::filesystem::path> write_matrix_market(const std::filesystem::path& file, const NamedArrays& arrays) {
  std::vector<std::filesystem::path> written;
  for (const auto& array : arrays.arrays) {
    const auto rows = array.shape.at(0), columns = array.shape.size() > 1 ? array.shape[1] : 1;
    std::string text = fmt::format("%%MatrixMarket matrix array real general\n% {}, unit {}\n", array.name,
                                   unit_of_name(array.name).empty() ? "1" : unit_of_name(array.name));
    for (const auto& [key, value] : arrays.provenance)
      if (!value.empty()) text += fmt::format("% {}: {}\n", key, value);
    text += fmt::format("{} {}\n", rows, columns);
    for (std::size_t j = 0; j < columns; ++j)  // column by column
      for (std::size_t i = 0; i < rows; ++i) text += fmt::format("{:.17g}\n", array.values[i * columns + j]);
    auto name = file.stem().string() + "_" + array.name + file.extension().string();
    written.push_back(file.parent_path() / name);
    write_file(written.back(), text);
  }
  return written;
}

}  // namespace annulus::app
