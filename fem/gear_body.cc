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

GearBody make_gear_body(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile, double support_radius,
                        const Material& material, const GearBodyOptions& options) {
  const SectorModel model = make_sector_model(sector_mesh, profile, support_radius, material, options.sector);

  GearBody body;
  body.teeth = profile.gear().teeth();
  body.pitch_angle = profile.gear().pitch_angle();
  body.flank = TraceBasis(model.flank.profile, model.flank.degree);
  if (model.flank.axial.size() > 1) body.axial = TraceBasis(model.flank.axial, model.flank.degree);
  body.unknowns = model.stiffness.rows();

  const double side = options.sector.flank == geometry::Boundary::trailing_flank ? -1 : 1;
  for (std::size_t i = 0; i < model.flank.nodes.size(); ++i) {
    Eigen::Vector2d normal = profile.flank_normal(model.flank.profile[i / model.flank.axial.size()]);
    normal.y() *= side;
    body.ports.push_back({model.flank.nodes[i], Eigen::Vector3d(-normal.x(), -normal.y(), 0)});
  }
  if (options.sector.want_outside) {
    require(model.outside.axial.size() == 1, "pins are modelled in the plane");
    body.outside = TraceBasis(model.outside.profile, model.outside.degree);
    for (std::size_t i = 0; i < model.outside.nodes.size(); ++i) {
      const double angle = model.outside.profile[i];
      body.ports.push_back({model.outside.nodes[i], Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)});
      body.ports.push_back({model.outside.nodes[i], Eigen::Vector3d(-std::sin(angle), std::cos(angle), 0)});
    }
  }
  for (const auto& port : body.ports) body.port_points.push_back(model.nodes[port.node]);

  const bool floating = options.sector.held == HeldBoundary::none;
  const CondensedSector sector = condense(model, body.ports, floating);
  body.compliance = compose_ring(sector, body.teeth, options.max_offset, floating, options.threads);
  return body;
}

}  // namespace annulus::fem
