#include "app/export/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/model/field_files.h"
#include "app/model/gear_system.h"
#include "app/model/mesh_solve.h"
#include "app/model/reuse.h"
#include "app/results/user_cache.h"
#include "app/results/vtk_assembly.h"
#include "app/run/solved_case.h"
#include "core/errors.h"

namespace annulus::app {

std::vector<std::filesystem::path> write_mesh_cycle(const Scene& scene, const std::string& variant, int threads,
                                                    const std::filesystem::path& file) {
  if (file.extension() != ".pvd")
    throw InputError(fmt::format("-o {}: must end with .pvd, by which ParaView knows it", file.string()));
  check_stage(scene);
  const auto system = make_system(scene);
  const auto chosen = system->variants().at(variant_number(*system, variant));
  const auto name = file.stem().string();
  const auto folder = file.parent_path() / name;
  const RunOptions options = with_reuse({.out = folder, .cache = results_cache(folder), .threads = threads});
  std::vector<std::pair<double, std::filesystem::path>> steps;
  for (const auto& model : system->meshes()) {
    if (!model.has_elements() || (!model.variant.empty() && model.variant != chosen)) continue;
    const auto solved = solve_contact(model, options, fem::Recovery::fields_of_cycle);
    std::vector<std::string> stems;
    for (std::size_t first = 0; first < solved.fields.size(); first += 2) {
      stems.push_back(fmt::format("{}_{:02}", model.mesh, stems.size()));
      steps.emplace_back(solved.positions.at(solved.fields[first].position).mesh_phase,
                         std::filesystem::path(name) / field_file_names(model, stems.back()).back());
    }
    std::filesystem::create_directories(folder);
    write_field_files(model, solved, folder, stems);
  }
  if (steps.empty())
    throw InputError(
        fmt::format("{}: no mesh of this scene has fields inside its bodies: none is computed with model "
                    "\"plane\" or \"solid\"",
                    scene.file.string()));
  std::stable_sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  write_pvd(file, steps);
  return {file};
}

}  // namespace annulus::app
