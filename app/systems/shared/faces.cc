#include "app/systems/shared/faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/systems/shared/space_members.h"
#include "core/errors.h"
#include "core/log.h"
#include "fem/face_shape.h"
#include "fem/problem/solved_face.h"
#include "geometry/profile.h"

namespace annulus::app {

std::vector<double> gaps_along(const geometry::GearPair& pair, double misalignment,
                               const std::vector<double>& stations) {
  const auto face = pair.common_face();
  const geometry::ToothProfile pinion(pair.pinion()), wheel(pair.wheel());
  std::vector<double> gaps;
  for (const double z : stations) {
    const double from_low = z + face.width / 2;
    gaps.push_back(pinion.lead_modification(from_low + face.pinion.below) +
                   wheel.lead_modification(from_low + face.wheel.below) + misalignment * z / face.width);
  }
  return gaps;
}

double place_of_face(const geometry::GearPair& pair) {
  const auto common = pair.common_face();
  const auto& p = pair.pinion().parameters();
  const double middle = p.axial_offset - p.face_width / 2 + common.pinion.below + common.width / 2;
  return std::abs(middle) < place_rounding * common.width ? 0 : middle;
}

EvenStations even_stations(const geometry::GearPair& pair, const MeshInput& input, double misalignment, int stretches) {
  EvenStations even;
  const double width = pair.common_face().width;
  for (int i = 0; i <= stretches; ++i) even.at.push_back(width * (static_cast<double>(i) / stretches - 0.5));
  even.gap = gaps_in_table(input) ? std::vector<double>(even.at.size(), 0.0) : gaps_along(pair, misalignment, even.at);
  return even;
}

double nominal_mesh_stiffness(const geometry::GearPair& pair) { return 20e9 * pair.common_face().width; }

bool gaps_in_table(const MeshInput& input) { return input.stiffness == StiffnessShape::computed; }

dynamics::SpreadFace motion_face(const geometry::GearPair& pair, const MeshInput& input,
                                 const std::shared_ptr<const FaceShape>& given, double misalignment, GapsAlong gaps) {
  const double c = gaps == GapsAlong::normal ? 1 : std::cos(pair.pinion().base_helix_angle());
  dynamics::SpreadFace face;
  face.width = pair.common_face().width;
  face.middle = place_of_face(pair);
  if (given) {
    const auto scaled = [c](FaceShape shape) {
      for (double& gap : shape.gap_slope) gap /= c;
      return shape;
    };
    auto shape = scaled(*given);
    if (shape.tilted) shape.tilted = std::make_shared<const FaceShape>(scaled(*shape.tilted));
    face.shape = std::make_shared<const FaceShape>(std::move(shape));
  }
  if (gaps_in_table(input)) return face;
  std::vector<double> places;
  for (const auto& place : dynamics::face_places()) places.push_back(place.z * face.width / 2);
  face.gap = gaps_along(pair, misalignment, places);
  for (double& gap : face.gap) gap /= c;
  return face;
}

std::shared_ptr<const fem::SolidFace> solid_face(const MeshResult& mesh, const RunOptions& options, int coarser) {
  if (!mesh.model.computed()) return nullptr;
  auto settings = mesh.model.settings;
  if (!fem::why_no_solid_face(*mesh.model.problem, settings.fidelity).empty()) return nullptr;
  settings.degree = static_cast<int>(mesh.fact("degree"));
  settings.threads = options.threads;
  settings.store = options.store;
  const int level = static_cast<int>(mesh.fact("level"));
  return std::make_shared<fem::SolidFace>(*mesh.model.problem, settings, std::max(0, level - coarser));
}

Warning even_faces_warning(const std::string& ring) {
  return {"even_faces", Severity::warning,
          "a computed mesh stiffness is spread evenly over the face: every part of it gives way by itself. Real teeth "
          "support the loaded part from beside it, so that K_Hβ is overestimated where bodies tilt. Lead modifications "
          "and misalignment act in the stiffness alone, not in the load along the face. The error bar of K_Hβ contains "
          "neither. Solid models of rings that stand on no single supports, with planets on hubs, need no such "
          "assumption",
          ring};
}

std::shared_ptr<const FaceShape> face_in_motion(const MeshResult& mesh, double mesh_force, const RunOptions& options) {
  const auto solid = solid_face(mesh, options);
  if (!solid) return nullptr;
  constexpr int phases = 16;
  const double normal = mesh_force / std::cos(mesh.model.problem->pair.pinion().base_helix_angle());
  const auto id = identity_of(mesh.model.id(), mesh.fact("level"), mesh.fact("degree"), normal, phases);
  try {
    const auto [shape, reused] = cached_value(
        options.store.get(), "faces", id, [&] { return fem::reduced_face(*solid, normal, phases, options.threads); });
    note_reuse(options, fmt::format("face of the {} mesh", mesh.model.mesh), source_of(reused));
    return std::make_shared<const FaceShape>(shape);
  } catch (const SolverError& error) {  // the face is then even, which face_warnings() says
    log::info(fmt::format("{} mesh: {}", mesh.model.mesh, error.what()));
    return nullptr;
  }
}

std::vector<Warning> face_warnings(const std::vector<std::pair<std::string, const MeshResult*>>& meshes,
                                   const std::string& ring) {
  std::vector<Warning> list;
  if (std::any_of(meshes.begin(), meshes.end(),
                  [](const auto& mesh) { return mesh.second->model.computed() && !mesh.second->face; }))
    list.push_back(even_faces_warning(ring));
  for (const auto& [name, mesh] : meshes) {
    if (mesh->face && !mesh->face->tilted)
      list.push_back(
          {"face_without_error", Severity::warning,
           fmt::format("error bars do not contain the change of the {} along its face when gears tilt. A tilt by half "
                       "of the approach already takes one end of the face out of contact",
                       name),
           ring});
  }
  return list;
}

}  // namespace annulus::app
