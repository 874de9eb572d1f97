#include "fem/gear_body.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

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

GearBody make_gear_body(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile, double support_radius,
                        const Material& material, const GearBodyOptions& options) {
  const SectorModel model = make_sector_model(sector_mesh, profile, support_radius, material, options.sector);

  GearBody body;
  body.teeth = profile.gear().teeth();
  body.pitch_angle = profile.gear().pitch_angle();
  body.flank = TraceBasis(model.flank.profile, model.flank.degree);
  if (model.flank.axial.size() > 1) body.axial = TraceBasis(model.flank.axial, model.flank.degree);
  body.unknowns = model.stiffness.rows();

  SectorLoads loads;
  const double side = options.sector.flank == geometry::Boundary::trailing_flank ? -1 : 1;
  for (const int node : model.flank.nodes) {
    // At the node's own place, not at the coordinates of its row: only there has the normal the base circle's lever
    // arm.
    const auto& point = model.nodes[node];
    const double roll = profile.roll_length_at(std::hypot(point.x(), point.y()));
    loads.ports.push_back({node, -flank_normal(profile, roll, side, point.z())});
    body.port_points.push_back(point);
  }
  for (const auto& arc : options.arcs) {
    loads.acting.push_back(on_outside(arc, model.outside));
    Wrench wrench = Wrench::Zero();
    for (const auto& f : loads.acting.back()) {
      wrench.head<3>() += f.force;
      wrench.tail<3>() += model.nodes[f.node].cross(f.force);
    }
    body.arc_wrenches.push_back(wrench);
  }

  const bool floating = options.sector.held == HeldBoundary::none;
  const CondensedSector sector = condense(model, loads, floating);
  body.compliance = compose_ring(sector, body.teeth, options.extent, floating, options.threads);
  body.ports = std::move(loads.ports);
  return body;
}

}  // namespace annulus::fem
