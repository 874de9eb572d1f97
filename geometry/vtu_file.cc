#include "geometry/vtu_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

#include "core/errors.h"
#include "core/files.h"

namespace annulus::geometry {

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
void add_array(std::string& text, std::string_view type, std::string_view name, std::size_t components,
               const std::vector<Number>& values, const std::vector<std::string>& component_names = {}) {
  std::string names;
  for (std::size_t i = 0; i < component_names.size(); ++i)
    names += fmt::format(" ComponentName{}=\"{}\"", i, component_names[i]);
  fmt::format_to(
      std::back_inserter(text),
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"binary\">\n{}\n</DataArray>\n", type,
      name, components, names, compressed(values));
}

}  // namespace

void write_vtu(const Mesh& mesh, const std::filesystem::path& file, const std::vector<PointData>& data,
               const std::vector<FieldValue>& facts) {
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

  std::string text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n");
  if (!facts.empty()) {
    text += "<FieldData>\n";
    for (const auto& [name, value] : facts)
      text += fmt::format(
          "<DataArray type=\"Float64\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{:.17g}</DataArray>\n", name,
          value);
    text += "</FieldData>\n";
  }
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.vertices.size(), mesh.cells.size());
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
    const auto components = std::max<std::size_t>(1, d.components.size());
    require(d.values.size() == mesh.vertices.size() * components, "values at every vertex");
    add_array(text, "Float32", d.name, components, d.values, d.components);
  }
  text += "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_file(file, text);
}

}  // namespace annulus::geometry
