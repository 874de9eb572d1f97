#include "geometry/gmsh/meshed_sector.h"

#include <gmsh.h>

#include <map>
#include <string>
#include <utility>

#include "core/errors.h"
#include "geometry/gmsh/gmsh_session.h"
#include "geometry/gmsh/sector_blocks.h"

namespace annulus::geometry {

namespace {

/// Reads the generated mesh back, with vertices in the order of gmsh's node numbers.
Mesh collect(const SectorBlocks& b, double module) {
  constexpr int msh_edge = 1;
  constexpr int msh_quad = 3;
  Mesh mesh;
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters, -1, -1, false, false);
  std::map<std::size_t, Eigen::Vector3d> nodes;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    nodes[tags[i]] = {module * coordinates[3 * i], module * coordinates[3 * i + 1], 0};
  }
  std::vector<std::size_t> elements, corners;
  std::map<std::size_t, std::uint32_t> index;
  // gmsh refills vectors without shrinking them: they have to come in empty.
  const auto read_elements = [&](int type, int entity) {
    elements.clear();
    corners.clear();
    gmsh::model::mesh::getElementsByType(type, elements, corners, entity);
  };
  const auto vertex = [&](std::size_t tag) {
    const auto [entry, added] = index.try_emplace(tag, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(nodes.at(tag));
    return entry->second;
  };
  for (const auto& [block, region] : b.blocks) {
    read_elements(msh_quad, block);
    require(!elements.empty(), "gmsh has not filled a block of the sector with quadrilaterals");
    for (std::size_t e = 0; e < elements.size(); ++e) {
      std::array<std::uint32_t, 8> cell{};
      for (std::size_t i = 0; i < 4; ++i) cell[i] = vertex(corners[4 * e + i]);
      const Eigen::Vector3d d = mesh.vertices[cell[2]] - mesh.vertices[cell[0]];
      const Eigen::Vector3d f = mesh.vertices[cell[3]] - mesh.vertices[cell[1]];
      if (d.x() * f.y() - d.y() * f.x() < 0) std::swap(cell[1], cell[3]);
      mesh.cells.push_back(cell);
      mesh.regions.push_back(region);
    }
  }
  for (const auto& [curve, boundary] : b.curves) {
    if (boundary == Boundary::none) continue;
    read_elements(msh_edge, curve);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      mesh.faces.push_back({{vertex(corners[2 * e]), vertex(corners[2 * e + 1])}, boundary});
    }
  }
  return mesh;
}

}  // namespace

Mesh meshed_sector(const Gear& gear, const Rim& rim, const SectorResolution& resolution) {
  try {
    const GmshModel model("annulus sector");
    const SectorBlocks blocks = describe_sector(gear, rim, resolution);
    gmsh::model::geo::synchronize();
    gmsh::model::mesh::generate(2);
    return collect(blocks, gear.parameters().module);
  } catch (const std::string& message) {
    throw InternalError("internal error: gmsh could not mesh a tooth sector: " + message);
  } catch (int) {
    throw InternalError("internal error: gmsh could not mesh a tooth sector");
  }
}

}  // namespace annulus::geometry
