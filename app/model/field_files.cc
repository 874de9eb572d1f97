#include "app/model/field_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "app/report/plot/ticks.h"
#include "app/results/vtk_assembly.h"
#include "core/errors.h"
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

using PlacedFields = std::pair<fem::BodyField, fem::BodyField>;

/// Of pinion and wheel at one position.
PlacedFields placed_fields(const MeshModel& model, const fem::LoadedMeshResult& solved, std::size_t first) {
  const auto& position = solved.positions.at(solved.fields.at(first).position);
  const auto& pair = model.problem->pair;
  return {fem::in_frame_of_pair(solved.fields.at(first), position, pair),
          fem::in_frame_of_pair(solved.fields.at(first + 1), position, pair)};
}

/// One factor for all positions, so that they can follow each other.
double exaggeration_of(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Eigen::AlignedBox3d box;
  double largest = 0;
  for (std::size_t first = 0; first < solved.fields.size(); first += 2) {
    const auto [pinion, wheel] = placed_fields(model, solved, first);
    for (const auto* field : {&pinion, &wheel})
      for (std::size_t v = 0; v < field->displacement.size(); ++v) {
        box.extend(field->mesh.vertices[v]);
        largest = std::max(largest, field->displacement[v].norm());
      }
  }
  return round_below(fem::visible_exaggeration(box.sizes().maxCoeff(), largest));
}

void write_fields_at(std::size_t first, double exaggeration, const MeshModel& model,
                     const fem::LoadedMeshResult& solved, const std::filesystem::path& folder,
                     const std::string& stem) {
  const auto& position = solved.positions.at(solved.fields.at(first).position);
  const auto [pinion, wheel] = placed_fields(model, solved, first);
  const std::vector<geometry::FieldValue> facts = {{"load_N", position.load},
                                                   {"mesh_phase", position.mesh_phase},
                                                   {"wheel_tooth", position.ring_tooth},
                                                   {"exaggeration", exaggeration}};
  const auto [of_pinion, of_wheel, assembly] = field_file_names(model, stem);
  geometry::write_vtu(pinion.mesh, folder / of_pinion, point_data(pinion), facts);
  geometry::write_vtu(wheel.mesh, folder / of_wheel, point_data(wheel), facts);
  write_vtm(folder / assembly, {{model.pinion_body, of_pinion}, {model.wheel_body, of_wheel}});
}

}  // namespace

std::array<std::string, 3> field_file_names(const MeshModel& model, const std::string& stem) {
  return {stem + "_" + model.pinion_body + ".vtu", stem + "_" + model.wheel_body + ".vtu", stem + ".vtm"};
}

void write_field_files(const MeshModel& model, const fem::LoadedMeshResult& solved, const std::filesystem::path& folder,
                       const std::vector<std::string>& stems) {
  require(2 * stems.size() == solved.fields.size(), "a name for every position with fields");
  if (stems.empty()) return;
  const double exaggeration = exaggeration_of(model, solved);
  for (std::size_t i = 0; i < stems.size(); ++i) write_fields_at(2 * i, exaggeration, model, solved, folder, stems[i]);
}

}  // namespace annulus::app
