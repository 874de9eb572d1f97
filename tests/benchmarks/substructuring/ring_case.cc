#include "benchmarks/substructuring/ring_case.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/stopwatch.h"
#include "core/errors.h"
#include "fem/body/resolution.h"
#include "fem/condensation/condensed_sector.h"
#include "fem/condensation/cyclic_body.h"
#include "fem/condensation/lapack.h"
#include "fem/discretised_body.h"
#include "fem/ring_paper.h"
#include "geometry/profile.h"
#include "geometry/sector_mesh.h"

namespace annulus::benchmarks {
namespace {

using geometry::Boundary;

constexpr double rim_thickness = 18.7e-3, face_width = 88e-3, free_length = 18e-3, sleeve_thickness = 10.6e-3;  // m

/// The sector, its elements and the ports: unit forces along the normal into the material on the nodes of the flank.
struct Sector {
  geometry::Gear gear;
  geometry::ToothProfile profile;
  double outside;
  geometry::Mesh mesh;
  fem::SectorModel model;
  std::vector<fem::Port> ports;
};

geometry::Gear ring_gear(int teeth) {
  auto parameters = tests::ring_paper_ring();
  parameters.teeth = teeth;
  // With few teeth a whole addendum would reach below the base circle, where there is no involute.
  const double reference = parameters.module * teeth / 2;
  const double standard = reference - (1 - parameters.profile_shift) * parameters.module;
  const double least = 1.01 * reference * std::cos(parameters.pressure_angle);
  parameters.tip_diameter = 2 * std::max(standard, least);
  return geometry::Gear(parameters);
}

fem::BodyResolution resolution(const RingCase& ring) {
  if (ring.level) return fem::solid_resolution(*ring.level, 2);
  if (ring.dimension == 2) return {{24, 4, 12, 2, 6, 0.5}, 0, 0};
  return {{6, 2, 4, 1, 2, 1.0}, 4, 2};
}

Sector make_sector(const RingCase& ring) {
  const geometry::Gear gear = ring_gear(ring.teeth);
  Sector sector{gear, geometry::ToothProfile(gear), gear.root_radius() + rim_thickness, {}, {}, {}};
  const auto counts = resolution(ring);
  geometry::Rim rim{sector.outside, {}};
  if (ring.cantilever) rim.circles = {sector.outside - sleeve_thickness};
  sector.mesh = make_sector_mesh(gear, rim, counts.section);
  fem::SectorModelOptions options;
  options.flank = Boundary::trailing_flank;
  if (ring.dimension == 3) {
    std::vector<geometry::Layers> stacks;
    if (ring.cantilever) {
      geometry::Layers sleeve{-free_length, 0, counts.sleeve_cells};
      sleeve.region = geometry::Mesh::Region::sleeve;
      sleeve.toothed = false;
      sleeve.radius_low = rim.circles.front();
      stacks.push_back(sleeve);
      options.held = fem::HeldBoundary::end_low;
    }
    stacks.push_back({0, face_width, counts.face_cells});
    sector.mesh = extrude(sector.mesh, stacks);
  }
  sector.model = make_sector_model(sector.mesh, sector.profile, sector.outside, fem::Material{}, options);
  const auto& flank = sector.model.flank;
  for (std::size_t i = 0; i < flank.nodes.size(); ++i) {
    const Eigen::Vector2d normal = sector.profile.flank_normal(flank.profile[i / flank.axial.size()]);
    sector.ports.push_back({flank.nodes[i], Eigen::Vector3d(-normal.x(), normal.y(), 0)});
  }
  return sector;
}

/// The neighbour, the one after, and the farthest: in between the compliance of a held ring is too small to compare.
std::vector<int> compared_offsets(int teeth) { return {0, 1, 2, teeth / 2}; }

/// Where the ports of one tooth are in the whole ring: displacement along a port = sum of its DOFs x components.
struct PortMap {
  std::vector<std::array<int, 3>> dofs;
  std::vector<Eigen::Vector3d> directions;
};

PortMap map_ports(const tests::DiscretisedBody& body, const Sector& sector, int tooth) {
  const Eigen::AngleAxisd turn(tooth * sector.gear.pitch_angle(), Eigen::Vector3d::UnitZ());
  PortMap map;
  for (const auto& port : sector.ports) {
    const Eigen::Vector3d point = turn * sector.model.nodes[port.node];
    const auto nearest = std::min_element(body.nodes.begin(), body.nodes.end(), [&](const auto& a, const auto& b) {
      return (a - point).squaredNorm() < (b - point).squaredNorm();
    });
    require((*nearest - point).norm() < 1e-9 * sector.outside, "a port has no node in the whole ring");
    std::array<int, 3> dofs{};
    for (int d = 0; d < body.dimension; ++d) dofs[d] = body.dof[(nearest - body.nodes.begin()) * body.dimension + d];
    map.dofs.push_back(dofs);
    map.directions.emplace_back(turn * port.direction);
  }
  return map;
}

std::vector<bool> held_dofs(const tests::DiscretisedBody& body, Boundary held) {
  std::vector<bool> fixed(body.stiffness.rows(), false);
  for (const int node : body.boundary_nodes(held))
    for (int d = 0; d < body.dimension; ++d) fixed[body.dof[node * body.dimension + d]] = true;
  return fixed;
}

tests::DiscretisedBody whole_ring(const RingCase& ring, const Sector& sector) {
  // The projection of sector 0, turned to where the point is.
  const auto project = [&](Boundary boundary, const Eigen::Vector2d& point) -> Eigen::Vector2d {
    const double pitch = sector.gear.pitch_angle();
    const Eigen::Rotation2Dd turn(pitch * std::round(std::atan2(point.y(), point.x()) / pitch));
    return turn * sector.profile.project(boundary, turn.inverse() * point, sector.outside);
  };
  return tests::discretise_body(repeat(sector.mesh, ring.teeth, ring.teeth), project, fem::Material{}, 2);
}

/// Every how many-th port is loaded: some dozen right-hand sides for the whole ring, however many its ports are.
int stride(const Sector& sector) { return std::max(1, static_cast<int>(sector.ports.size()) / 13); }

Eigen::MatrixXd every(const Eigen::MatrixXd& columns, int stride) {
  Eigen::MatrixXd picked(columns.rows(), (columns.cols() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < picked.cols(); ++i) picked.col(i) = columns.col(i * stride);
  return picked;
}

}  // namespace

std::string describe(const RingCase& ring) {
  const char* held = ring.cantilever ? "end face held" : "outside held";
  return fmt::format("{}D {} {}, {} teeth", ring.dimension, held,
                     ring.level ? fmt::format("level {}", *ring.level) : "coarse", ring.teeth);
}

RingCompliance composed(const RingCase& ring, int threads) {
  fem::lapack::use_one_thread();
  RingCompliance result;
  const Stopwatch whole;
  Stopwatch watch;
  const Sector sector = make_sector(ring);
  result.discretise_seconds = watch.wall();
  watch = {};
  const auto condensed = condense(sector.model, fem::SectorLoads{sector.ports, {}, {}}, fem::SectorSupport::held);
  result.condense_seconds = watch.wall();
  watch = {};
  constexpr int neighbours = 6;  // as the program wants them
  const auto near = compose_ring(condensed, ring.teeth, {neighbours, false}, fem::SectorSupport::held, threads);
  result.compose_seconds = watch.wall();
  result.cpu_seconds = whole.cpu();
  result.unknowns = sector.model.stiffness.rows();
  const bool compared = !ring.level;
  const auto all =
      compared ? compose_ring(condensed, ring.teeth, {ring.teeth / 2, true}, fem::SectorSupport::held, threads) : near;
  for (const int offset : compared_offsets(ring.teeth))
    if (offset <= all.max_offset()) result.blocks.push_back(every(all.block(offset), stride(sector)));
  return result;
}

RingCompliance monolithic(const RingCase& ring) {
  RingCompliance result;
  const Stopwatch whole;
  Stopwatch watch;
  const Sector sector = make_sector(ring);
  const auto body = whole_ring(ring, sector);
  const tests::FreeSystem system(body.stiffness,
                                 held_dofs(body, ring.cantilever ? Boundary::end_low : Boundary::support));
  result.unknowns = system.matrix.rows();
  result.discretise_seconds = watch.wall();
  watch = {};
  const tests::SparseCholesky factor(system.matrix);
  result.condense_seconds = watch.wall();
  watch = {};
  const PortMap loaded = map_ports(body, sector, 0);
  const int step = stride(sector), ports = static_cast<int>(sector.ports.size());
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(system.matrix.rows(), (ports + step - 1) / step);
  for (Eigen::Index column = 0; column < loads.cols(); ++column)
    for (int d = 0; d < ring.dimension; ++d)
      loads(system.row[loaded.dofs[column * step][d]], column) = loaded.directions[column * step][d];
  const Eigen::MatrixXd solution = factor.solve(loads);
  for (const int offset : compared_offsets(ring.teeth)) {
    const PortMap seen = map_ports(body, sector, offset);
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(ports, loads.cols());
    for (int port = 0; port < ports; ++port)
      for (int d = 0; d < ring.dimension; ++d)
        block.row(port) += seen.directions[port][d] * solution.row(system.row[seen.dofs[port][d]]);
    result.blocks.push_back(block);
  }
  result.compose_seconds = watch.wall();
  result.cpu_seconds = whole.cpu();
  return result;
}

}  // namespace annulus::benchmarks
