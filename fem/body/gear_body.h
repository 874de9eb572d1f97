#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/body/gauge_place.h"
#include "fem/condensation/cyclic_body.h"
#include "fem/elasticity/arc_load.h"
#include "fem/elasticity/sector_model.h"
#include "fem/elasticity/trace_basis.h"
#include "fem/problem/superelement_cache.h"

namespace annulus::fem {

/// Force (N) and moment about the origin (N m) of a load.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// Where a body is asked for its surface stress: a line of the cross-section at every axial station.
struct StressLine {
  int first_load = 0;         ///< number of its first observed load, [point][axial station][component]
  int components = 1;         ///< tangential; of a solid also axial and shear
  std::vector<double> axial;  ///< m, z of the axial stations, ascending; one in the plane
  std::vector<double> angle;  ///< rad, of its points in the sector's frame, ascending
  std::vector<double> arc;    ///< m, length of the line up to each point
  [[nodiscard]] int axial_stations() const { return static_cast<int>(axial.size()); }
  [[nodiscard]] int points() const { return static_cast<int>(angle.size()); }
  [[nodiscard]] int loads() const { return points() * axial_stations() * components; }
};

/// A whole gear reduced to the loads it takes and the stresses it is asked for, from one condensed sector.
///
/// Loads of a sector in the order of `compliance`: flank ports, [profile station * axial stations + axial station],
/// unit forces along the flank normal into the material; acting loads: on arcs of a free outside, then at places of the
/// other flank; stresses.
struct GearBody {
  int teeth = 0;
  double pitch_angle = 0;
  TraceBasis flank;  ///< over the pinion's or wheel's own roll length
  TraceBasis axial;  ///< over z; empty in the plane
  std::vector<Port> ports;
  std::vector<Eigen::Vector3d> port_points;
  std::vector<Wrench> acting_wrenches;  ///< of the acting loads, in the sector's frame
  std::vector<double> other_rolls;      ///< m, roll lengths of the places on the other flank; empty without
  /// Root land and fillet of the trailing side (from the interface to the form circle) and of the leading side (from
  /// the form circle to the interface); the rim opposite, where it is free. Empty when stresses are not asked for.
  StressLine root_low, root_high, rim;
  CyclicCompliance compliance;
  std::vector<GaugeProbe> gauges;  ///< as wanted
  long unknowns = 0;

  [[nodiscard]] int axial_stations() const { return axial.size() > 0 ? axial.size() : 1; }
  [[nodiscard]] int flank_ports() const { return static_cast<int>(ports.size()); }
  [[nodiscard]] int first_acting() const { return flank_ports(); }  ///< load number of the first acting load
  [[nodiscard]] int acting_loads() const { return static_cast<int>(acting_wrenches.size()); }
  /// In-plane rigid-motion displacement (x, y, rotation about the axis) of a port of sector `sector`, m per (m, m,
  /// rad), in the frame of sector 0. Its transpose gives the resultant of a unit port load.
  [[nodiscard]] Eigen::RowVector3d rigid_motion(int port, int sector) const;
  /// Resultant of a unit acting load of sector `sector` in the frame of sector 0.
  [[nodiscard]] Wrench acting_wrench(int load, int sector) const;
};

/// Force and moment of a load, in the sector's frame.
[[nodiscard]] Wrench resultant(const NodalLoad& load, const std::vector<Eigen::Vector3d>& nodes);
/// Unit normal of the flank (side 1: leading, -1: trailing) out of the material; of a helical gear in its section at z.
[[nodiscard]] Eigen::Vector3d flank_normal(const geometry::ToothProfile& profile, double roll, double side, double z);
/// Unit forces into the material along the flank normal at the nodes of the flank, [as model.flank.nodes].
[[nodiscard]] std::vector<Port> flank_forces(const SectorModel& model, const geometry::ToothProfile& profile,
                                             geometry::Boundary flank);

/// Unit forces (N, transverse) along the normal of the other flank into the material, even over a part of the width.
struct OtherFlankLoads {
  int places = 0;                ///< equally spaced along the flank, its ends included
  double z_low = 0, z_high = 0;  ///< m
};
/// They need SectorOutput::other_flank.
[[nodiscard]] std::vector<NodalLoad> other_flank_loads(const SectorModel& model, const geometry::ToothProfile& profile,
                                                       geometry::Boundary contact_flank, const OtherFlankLoads& loads);

struct GearBodyOptions {
  SectorModelOptions sector;
  RingExtent extent;
  std::vector<ArcLoad> arcs;  ///< loads on a free outside
  OtherFlankLoads other_flank;
  std::vector<WantedGauge> gauges;
  int threads = 1;
  const ResultStore* store = nullptr;  ///< where tooth superelements are cached; may be null
};

/// One tooth by itself: the body without its compliance, and the condensed sector.
struct CondensedTooth {
  GearBody body;
  CondensedSector sector;
  bool reused = false;  ///< read from the store
  double seconds = 0;   ///< wall, that condensing it took, now or when it was cached
};

/// Meshed and condensed without regard to where arcs lie, so that one tooth serves all supports (see OutsideLoads).
[[nodiscard]] CondensedTooth condense_tooth(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile,
                                            double support_radius, const Material& material,
                                            const GearBodyOptions& options);

/// The body of a tooth, `options` being those that it was condensed with.
[[nodiscard]] GearBody compose_body(CondensedTooth tooth, const GearBodyOptions& options);

}  // namespace annulus::fem
