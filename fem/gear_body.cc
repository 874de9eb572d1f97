#include "fem/gear_body.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Appends the stresses of a surface to what is observed, at no more than about `most` points along the line: every so
/// many nodes, and the last one.
StressLine observe(const StressSurface& surface, const SectorModel& model, int most, SectorLoads& loads) {
  StressLine line;
  const auto& trace = surface.trace;
  if (trace.nodes.empty()) return line;
  line.first_load = loads.columns();
  line.axial_stations = static_cast<int>(trace.axial.size());
  line.components = model.dimension == 3 ? 3 : 1;
  const int nodes = static_cast<int>(trace.profile.size()), step = (nodes - 1 + most - 1) / most;
  double arc = 0;
  for (int u = 0; u < nodes; ++u) {
    const auto at = [&](int station) { return model.nodes[trace.nodes[station * line.axial_stations]]; };
    if (u > 0) arc += (at(u) - at(u - 1)).norm();
    if (u % step != 0 && u != nodes - 1) continue;
    line.angle.push_back(trace.profile[u]);
    line.arc.push_back(arc);
    for (int z = 0; z < line.axial_stations; ++z) {
      const auto& stress = surface.stress[u * line.axial_stations + z];
      loads.observed.push_back(stress.tangential);
      if (line.components == 1) continue;
      loads.observed.push_back(stress.axial);
      loads.observed.push_back(stress.shear);
    }
  }
  return line;
}

}  // namespace

Eigen::RowVector3d GearBody::rigid_motion(int port, int sector) const {
  const Eigen::AngleAxisd turn(sector * pitch_angle, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d d = turn * ports[port].direction, p = turn * port_points[port];
  return {d.x(), d.y(), p.x() * d.y() - p.y() * d.x()};
}

Wrench GearBody::arc_wrench(int arc, int sector) const {
  const Eigen::AngleAxisd turn(sector * pitch_angle, Eigen::Vector3d::UnitZ());
  Wrench turned;
  turned << turn * arc_wrenches[arc].head<3>(), turn * arc_wrenches[arc].tail<3>();
  return turned;
}

namespace {

/// Unit normal of the flank (side 1: leading, -1: trailing) out of the material; of a helical gear in its section at z.
Eigen::Vector3d flank_normal(const geometry::ToothProfile& profile, double roll, double side, double z) {
  const Eigen::Vector2d normal = profile.flank_normal(roll), point = profile.flank_point(roll);
  // The normal stands on the tangent (twist e_z x p) + e_z of the helix through the point.
  const double moment = side * (point.x() * normal.y() - point.y() * normal.x());
  const Eigen::Vector3d all(normal.x(), side * normal.y(), -profile.twist() * moment);
  return Eigen::AngleAxisd(profile.twist() * z, Eigen::Vector3d::UnitZ()) * all.normalized();
}

}  // namespace

Wrench resultant(const NodalLoad& load, const std::vector<Eigen::Vector3d>& nodes) {
  Wrench wrench = Wrench::Zero();
  for (const auto& f : load) {
    wrench.head<3>() += f.force;
    wrench.tail<3>() += nodes[f.node].cross(f.force);
  }
  return wrench;
}

std::vector<Port> flank_forces(const SectorModel& model, const geometry::ToothProfile& profile,
                               geometry::Boundary flank) {
  std::vector<Port> ports;
  const double side = flank == geometry::Boundary::trailing_flank ? -1 : 1;
  for (const int node : model.flank.nodes) {
    // At the node's own place, not at the coordinates of its row: only there has the normal the base circle's lever
    // arm.
    const auto& point = model.nodes[node];
    const double roll = profile.roll_length_at(std::hypot(point.x(), point.y()));
    ports.push_back({node, -flank_normal(profile, roll, side, point.z())});
  }
  return ports;
}

CondensedTooth condense_tooth(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile,
                              double support_radius, const Material& material, const GearBodyOptions& options) {
  const SectorModel model = make_sector_model(sector_mesh, profile, support_radius, material, options.sector);

  CondensedTooth tooth;
  GearBody& body = tooth.body;
  body.teeth = profile.gear().teeth();
  body.pitch_angle = profile.gear().pitch_angle();
  body.flank = TraceBasis(model.flank.profile, model.flank.degree);
  if (model.flank.axial.size() > 1) body.axial = TraceBasis(model.flank.axial, model.flank.degree);
  body.unknowns = model.stiffness.rows();

  SectorLoads loads;
  loads.ports = flank_forces(model, profile, options.sector.flank);
  for (const auto& port : loads.ports) body.port_points.push_back(model.nodes[port.node]);
  for (const auto& arc : options.arcs) {
    loads.acting.push_back(on_outside(arc, model.outside));
    body.arc_wrenches.push_back(resultant(loads.acting.back(), model.nodes));
  }

  constexpr int root_points = 60, rim_points = 24;
  body.root_low = observe(model.root_low, model, root_points, loads);
  body.root_high = observe(model.root_high, model, root_points, loads);
  body.rim = observe(model.rim, model, rim_points, loads);

  tooth.sector = condense(model, loads, options.sector.held == HeldBoundary::none);
  body.ports = std::move(loads.ports);
  return tooth;
}

GearBody make_gear_body(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile, double support_radius,
                        const Material& material, const GearBodyOptions& options) {
  CondensedTooth tooth = condense_tooth(sector_mesh, profile, support_radius, material, options);
  tooth.body.compliance = compose_ring(tooth.sector, tooth.body.teeth, options.extent,
                                       options.sector.held == HeldBoundary::none, options.threads);
  return std::move(tooth.body);
}

}  // namespace annulus::fem
