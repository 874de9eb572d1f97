#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/condensation/cyclic_body.h"
#include "fem/contact/trace_basis.h"
#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// A whole gear reduced to the ports its contacts need: compliance of all teeth from one condensed sector.
///
/// Flank ports come first, [profile station * axial stations + axial station], unit forces along the flank normal into
/// the material; then the ports of a free outside, pairs of (radial outwards, tangential counter-clockwise) forces.
struct GearBody {
  int teeth = 0;
  double pitch_angle = 0;
  TraceBasis flank;    ///< over the planet's or wheel's own roll length
  TraceBasis axial;    ///< over z; empty in the plane
  TraceBasis outside;  ///< over the polar angle in the sector's frame; empty when the outside is held
  std::vector<Port> ports;
  std::vector<Eigen::Vector3d> port_points;
  CyclicCompliance compliance;
  long unknowns = 0;

  [[nodiscard]] int axial_stations() const { return axial.size() > 0 ? axial.size() : 1; }
  [[nodiscard]] int flank_ports() const { return flank.size() * axial_stations(); }
  /// In-plane rigid-motion displacement (x, y, rotation about the axis) of a port of sector `sector`, m per (m, m,
  /// rad), in the frame of sector 0. Its transpose gives the resultant of a unit port load.
  [[nodiscard]] Eigen::RowVector3d rigid_motion(int port, int sector) const;
};

struct GearBodyOptions {
  SectorModelOptions sector;
  int max_offset = 6;  ///< farthest teeth whose coupling is wanted
  int threads = 1;
};

[[nodiscard]] GearBody make_gear_body(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile,
                                      double support_radius, const Material& material, const GearBodyOptions& options);

}  // namespace annulus::fem
