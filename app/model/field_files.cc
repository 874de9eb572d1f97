#include "app/model/field_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "app/report/plot/ticks.h"
#include "app/results/vtk_assembly.h"
#include "fem/placed_field.h"
#include "geometry/vtu_file.h"

namespace annulus::app {

namespace {

std::vector<geometry::PointData> point_data(const fem::BodyField& field) {
  geometry::PointData displacement{"displacement_m", {"x", "y", "z"}, {}}, von_mises{"von_mises_Pa", {}, {}},
      stress{"stress_Pa", {"xx", "yy", "zz", "xy", "yz", "zx"}, {}};
  for (std::size_t v = 0; v < field.displacement.size(); ++v) {
    for (int c = 0; c < 3; ++c) displacement.values.push_back(static_cast<float>(field.displacement[v][c]));
    von_mises.values.push_back(static_cast<float>(field.von_mises(v)));
    for (const double s : field.stress[v]) stress.values.push_back(static_cast<float>(s));
  }
  return {std::move(displacement), std::move(von_mises), std::move(stress)};
}

/// Largest displacements are then about a fiftieth of the bodies.
double exaggeration_of(const fem::BodyField& pinion, const fem::BodyField& wheel) {
  Eigen::AlignedBox3d box;
  double largest = 1e-15;
  for (const auto* field : {&pinion, &wheel})
    for (std::size_t v = 0; v < field->displacement.size(); ++v) {
      box.extend(field->mesh.vertices[v]);
      largest = std::max(largest, field->displacement[v].norm());
    }
  return round_below(0.02 * box.sizes().maxCoeff() / largest);
}

}  // namespace

std::array<std::string, 3> field_file_names(const MeshModel& model, const std::string& stem) {
  return {stem + "_" + model.pinion_body + ".vtu", stem + "_" + model.wheel_body + ".vtu", stem + ".vtm"};
}

void write_field_files(const MeshModel& model, const fem::LoadedMeshResult& solved, std::size_t first,
                       const std::filesystem::path& folder, const std::string& stem) {
  const auto& position = solved.positions.at(solved.fields.at(first).position);
  const auto placed = [&](std::size_t field) {
    return fem::in_frame_of_pair(solved.fields.at(field), position, model.problem->pair);
  };
  const auto pinion = placed(first), wheel = placed(first + 1);
  const std::vector<geometry::FieldValue> facts = {{"load_N", position.load},
                                                   {"mesh_phase", position.mesh_phase},
                                                   {"wheel_tooth", position.ring_tooth},
                                                   {"exaggeration", exaggeration_of(pinion, wheel)}};
  const auto [of_pinion, of_wheel, assembly] = field_file_names(model, stem);
  geometry::write_vtu(pinion.mesh, folder / of_pinion, point_data(pinion), facts);
  geometry::write_vtu(wheel.mesh, folder / of_wheel, point_data(wheel), facts);
  write_vtm(folder / assembly, {{model.pinion_body, of_pinion}, {model.wheel_body, of_wheel}});
}

}  // namespace annulus::app
