#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh.h"

namespace annulus::geometry {

/// Values at the vertices of a mesh, [vertex][component].
struct PointData {
  std::string name;                     ///< with its unit: "displacement_m"
  std::vector<std::string> components;  ///< names: "x", "y", "z"; a single one has none
  std::vector<float> values;
};
/// A number that holds for a whole file, by its name with the unit: "load_N".
using FieldValue = std::pair<std::string, double>;

/// A VTK XML unstructured grid in m with the cell data `region`, what is known of its points and what holds for all of
/// it. Throws Error on a failed write.
void write_vtu(const Mesh& mesh, const std::filesystem::path& file, const std::vector<PointData>& data = {},
               const std::vector<FieldValue>& facts = {});

}  // namespace annulus::geometry
