#include "geometry/gmsh/msh_file.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/files.h"
#include "geometry/gmsh/gmsh_session.h"

namespace annulus::geometry {

namespace {

constexpr std::array<std::string_view, 15> boundary_names = {
    "none",          "support",        "side_low",       "side_high",       "tip",
    "leading_flank", "trailing_flank", "leading_fillet", "trailing_fillet", "root",
    "end_low",       "end_high",       "inner",          "outside",         "flange_face"};
constexpr std::array<std::string_view, 5> region_names = {"tooth", "rim", "sleeve", "hoop", "flange"};

// Element types of the MSH format.
constexpr int msh_line = 1;
constexpr int msh_quadrilateral = 3;
constexpr int msh_hexahedron = 5;

/// Elements of one dimension as discrete entities, one per group, each with its named physical group; node tags start
/// at 1. Returns the first entity.
template <class Name>
int add_groups(int dimension, int type, const std::map<int, std::vector<std::size_t>>& groups, const Name& name) {
  int first = 0;
  for (const auto& [group, nodes] : groups) {
    const int entity = gmsh::model::addDiscreteEntity(dimension);
    if (first == 0) first = entity;
    gmsh::model::mesh::addElementsByType(entity, type, {}, nodes);
    const int physical = gmsh::model::addPhysicalGroup(dimension, {entity});
    gmsh::model::setPhysicalName(dimension, physical, std::string(name(group)));
  }
  return first;
}

void add_vertices(const Mesh& mesh, int dimension, int entity) {
  std::vector<std::size_t> tags(mesh.vertices.size());
  std::vector<double> coordinates;
  coordinates.reserve(3 * tags.size());
  for (std::size_t v = 0; v < tags.size(); ++v) {
    tags[v] = v + 1;
    coordinates.insert(coordinates.end(), mesh.vertices[v].begin(), mesh.vertices[v].end());
  }
  gmsh::model::mesh::addNodes(dimension, entity, tags, coordinates);
}

/// gmsh does not report a full disk.
bool ends_as_mesh(const std::filesystem::path& file) {
  const std::string last = "$EndElements\n";
  std::ifstream in(file, std::ios::binary);
  in.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end);
  return std::string(std::istreambuf_iterator<char>(in), {}) == last;
}

}  // namespace

void write_msh_file(const Mesh& mesh, const std::filesystem::path& file) {
  const bool solid = mesh.dimension == 3;
  std::map<int, std::vector<std::size_t>> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    auto& nodes = cells[static_cast<int>(mesh.regions[c])];
    for (int i = 0; i < (solid ? 8 : 4); ++i) nodes.push_back(mesh.cells[c][i] + 1);
  }
  std::map<int, std::vector<std::size_t>> faces;
  for (const auto& face : mesh.faces) {
    auto& nodes = faces[static_cast<int>(face.boundary)];
    for (int i = 0; i < (solid ? 4 : 2); ++i) nodes.push_back(face.vertices[i] + 1);
  }
  UnfinishedFile unfinished(file, ".msh");  // gmsh chooses the format by the ending
  try {
    const GmshModel model("annulus mesh");
    // Nodes first: elements refer to them. gmsh accepts all of them on one entity.
    const int holder = gmsh::model::addDiscreteEntity(mesh.dimension);
    add_vertices(mesh, mesh.dimension, holder);
    add_groups(mesh.dimension, solid ? msh_hexahedron : msh_quadrilateral, cells,
               [](int region) { return region_names.at(static_cast<std::size_t>(region)); });
    add_groups(mesh.dimension - 1, solid ? msh_quadrilateral : msh_line, faces,
               [](int boundary) { return boundary_names.at(static_cast<std::size_t>(boundary)); });
    gmsh::model::mesh::reclassifyNodes();
    gmsh::write(unfinished.temporary().string());
  } catch (const std::exception& e) {
    throw FileError(fmt::format("cannot write the mesh {}: {}", file.string(), e.what()));
  } catch (...) {  // gmsh throws plain strings and integers
    throw FileError(fmt::format("cannot write the mesh {}: gmsh refused; is the folder writable?", file.string()));
  }
  if (!ends_as_mesh(unfinished.temporary())) throw cannot_write(file, 0);
  unfinished.finish();
}

}  // namespace annulus::geometry
