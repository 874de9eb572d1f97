#include <fmt/format.h>
#include <gmsh.h>

#include <bit>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "core/errors.h"
#include "core/files.h"
#include "geometry/gmsh_session.h"
#include "geometry/mesh.h"

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

/// gmsh does not tell when a disk is full.
bool ends_as_mesh(const std::filesystem::path& file) {
  const std::string last = "$EndElements\n";
  std::ifstream in(file, std::ios::binary);
  in.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end);
  return std::string(std::istreambuf_iterator<char>(in), {}) == last;
}

}  // namespace

void write_msh(const Mesh& mesh, const std::filesystem::path& file) {
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
    throw InputError(fmt::format("cannot write the mesh {}: {}", file.string(), e.what()));
  } catch (...) {  // gmsh throws plain strings and integers
    throw InputError(fmt::format("cannot write the mesh {}: gmsh refused; is the folder writable?", file.string()));
  }
  if (!ends_as_mesh(unfinished.temporary()))
    throw InputError(
        fmt::format("cannot write {}: check that its folder exists, is writable and not full", file.string()));
  unfinished.finish();
}

namespace {

/// As VTK reads it: the number of bytes, then the bytes, in base 64.
std::string base64(const std::vector<float>& values) {
  static_assert(std::endian::native == std::endian::little, "the header of the file says so");
  const auto bytes = static_cast<std::uint32_t>(values.size() * sizeof(float));
  std::string raw(sizeof(bytes) + bytes, '\0');
  std::memcpy(raw.data(), &bytes, sizeof(bytes));
  if (bytes > 0) std::memcpy(raw.data() + sizeof(bytes), values.data(), bytes);
  const std::string padding((3 - raw.size() % 3) % 3, '=');
  raw.append(padding.size(), '\0');
  using Digits = boost::archive::iterators::base64_from_binary<
      boost::archive::iterators::transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Digits(raw.begin()), Digits(raw.end()));
  text.replace(text.size() - padding.size(), padding.size(), padding);
  return text;
}

}  // namespace

void write_vtu(const Mesh& mesh, const std::filesystem::path& file, const std::vector<PointData>& data) {
  const bool solid = mesh.dimension == 3;
  const int corners = solid ? 8 : 4;
  constexpr int vtk_quad = 9;
  constexpr int vtk_hexahedron = 12;
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
                 "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
                 "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n"
                 "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n",
                 mesh.vertices.size(), mesh.cells.size());
  for (const auto& v : mesh.vertices) fmt::format_to(out, "{:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
  text += "</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
  for (const auto& cell : mesh.cells) {
    for (int i = 0; i < corners; ++i) fmt::format_to(out, "{}{}", cell[i], i + 1 < corners ? ' ' : '\n');
  }
  text += "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
  for (std::size_t c = 1; c <= mesh.cells.size(); ++c) fmt::format_to(out, "{}\n", corners * c);
  text += "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n";
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) fmt::format_to(out, "{}\n", solid ? vtk_hexahedron : vtk_quad);
  text +=
      "</DataArray>\n</Cells>\n<CellData Scalars=\"region\">\n"
      "<DataArray type=\"Int32\" Name=\"region\" format=\"ascii\">\n";
  for (const auto region : mesh.regions) fmt::format_to(out, "{}\n", static_cast<int>(region));
  text += "</DataArray>\n</CellData>\n<PointData>\n";
  for (const auto& d : data) {
    require(d.values.size() == mesh.vertices.size() * static_cast<std::size_t>(d.components), "values at every vertex");
    fmt::format_to(
        out, "<DataArray type=\"Float32\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n{}\n</DataArray>\n",
        d.name, d.components, base64(d.values));
  }
  text += "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_file(file, text);
}

}  // namespace annulus::geometry
