#include <fmt/format.h>
#include <gmsh.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
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

/// gmsh does not report a full disk.
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
    throw FileError(fmt::format("cannot write the mesh {}: {}", file.string(), e.what()));
  } catch (...) {  // gmsh throws plain strings and integers
    throw FileError(fmt::format("cannot write the mesh {}: gmsh refused; is the folder writable?", file.string()));
  }
  if (!ends_as_mesh(unfinished.temporary())) throw cannot_write(file, 0);
  unfinished.finish();
}

namespace {

std::string base64(std::string raw) {
  const std::size_t padding = (3 - raw.size() % 3) % 3;
  raw.append(padding, '\0');
  using Digits = boost::archive::iterators::base64_from_binary<
      boost::archive::iterators::transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(raw.size() / 3 * 4, '=');
  std::copy_n(Digits(raw.begin()), text.size() - padding, text.begin());
  return text;
}

/// As VTK reads it: number and size of blocks, size of a partial one, compressed size; then the only block.
template <class Number>
std::string compressed(const std::vector<Number>& values) {
  static_assert(std::endian::native == std::endian::little, "the header of the file says so");
  const std::size_t size = values.size() * sizeof(Number);
  require(size < std::numeric_limits<std::uint32_t>::max(), "an array of a VTU file below 4 GiB");
  std::string packed(::compressBound(size), '\0');
  uLongf length = packed.size();
  const int status =
      ::compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(values.data()), size);
  require(status == Z_OK, "a buffer of the bound's size holds the compressed array");
  packed.resize(length);
  const std::array<std::uint32_t, 4> header = {1, static_cast<std::uint32_t>(size), 0,
                                               static_cast<std::uint32_t>(length)};
  std::string head(sizeof header, '\0');
  std::memcpy(head.data(), header.data(), sizeof header);
  return base64(head) + base64(packed);
}

template <class Number>
void add_array(std::string& text, std::string_view type, std::string_view name, int components,
               const std::vector<Number>& values) {
  fmt::format_to(std::back_inserter(text),
                 "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n{}\n</DataArray>\n",
                 type, name, components, compressed(values));
}

}  // namespace

void write_vtu(const Mesh& mesh, const std::filesystem::path& file, const std::vector<PointData>& data) {
  const bool solid = mesh.dimension == 3;
  const int corners = solid ? 8 : 4;
  constexpr int vtk_quad = 9;
  constexpr int vtk_hexahedron = 12;
  std::vector<double> points;
  points.reserve(3 * mesh.vertices.size());
  for (const auto& v : mesh.vertices) points.insert(points.end(), v.begin(), v.end());
  std::vector<std::int32_t> connectivity, offsets;
  for (const auto& cell : mesh.cells) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.begin() + corners);
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(mesh.cells.size(), solid ? vtk_hexahedron : vtk_quad);
  std::vector<std::int32_t> regions;
  for (const auto region : mesh.regions) regions.push_back(static_cast<std::int32_t>(region));

  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      mesh.vertices.size(), mesh.cells.size());
  text += "<Points>\n";
  // Fields are in single precision; so is what they stand on.
  if (data.empty())
    add_array(text, "Float64", "Points", 3, points);
  else
    add_array(text, "Float32", "Points", 3, std::vector<float>(points.begin(), points.end()));
  text += "</Points>\n<Cells>\n";
  add_array(text, "Int32", "connectivity", 1, connectivity);
  add_array(text, "Int32", "offsets", 1, offsets);
  add_array(text, "UInt8", "types", 1, types);
  text += "</Cells>\n<CellData Scalars=\"region\">\n";
  add_array(text, "Int32", "region", 1, regions);
  text += "</CellData>\n<PointData>\n";
  for (const auto& d : data) {
    require(d.values.size() == mesh.vertices.size() * static_cast<std::size_t>(d.components), "values at every vertex");
    add_array(text, "Float32", d.name, d.components, d.values);
  }
  text += "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_file(file, text);
}

}  // namespace annulus::geometry
