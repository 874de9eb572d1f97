#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/condensation/condensed_sector.h"

namespace annulus::fem {

/// Compliance of a body of N equal sectors, every sector and its interface seen in the frame of that sector.
///
/// Everything passes from sector to sector by the displacements of the cyclic interfaces: the displacement u of a
/// load's work partner in sector s is
///
///     u = c f_s + l^T v_s + h^T v_(s+1),     v_s = sum_t G_(s-t) q_t
///
/// with the compliance c between loads of one sector (interfaces held), the equivalent loads l, h on its low and high
/// interface, and the compliance G of the interfaces under loads q on them. A body that floats is given with an
/// artificial stiffness against its rigid motions alone: exact, up to a rigid motion, for every set of loads in
/// equilibrium.
class CyclicCompliance {
 public:
  CyclicCompliance() = default;
  /// `interfaces`: G for offsets 0 ... max; `high` in the frame of the next sector. Couples the ports of sectors up to
  /// `max_offset` apart.
  CyclicCompliance(int sectors, int ports, int max_offset, std::vector<Eigen::MatrixXd> interfaces, Eigen::MatrixXd low,
                   Eigen::MatrixXd high, Eigen::MatrixXd within);

  [[nodiscard]] int sectors() const { return sectors_; }
  [[nodiscard]] int interface_size() const { return static_cast<int>(low_.rows()); }  ///< m, DOFs of a interface
  /// Farthest sectors between which ports are coupled, and farthest interfaces.
  [[nodiscard]] int max_offset() const { return static_cast<int>(blocks_.size()) - 1; }
  [[nodiscard]] int max_interface_offset() const { return static_cast<int>(interfaces_.size()) - 1; }

  /// block(d)(i, j): displacement at port i of sector s + d under a unit load at port j of sector s. Any offset, taken
  /// modulo N to the nearest; throws InternalError beyond max_offset().
  [[nodiscard]] Eigen::MatrixXd block(int offset) const;

  /// v_(s+d) += G_d q_s, a column per load case; any offset up to max_interface_offset().
  void add_interface_displacement(int offset, const Eigen::MatrixXd& interface_load,
                                  Eigen::MatrixXd& displacement) const;
  [[nodiscard]] const Eigen::MatrixXd& low() const { return low_; }        ///< l, m x loads
  [[nodiscard]] const Eigen::MatrixXd& high() const { return high_; }      ///< h, m x loads
  [[nodiscard]] const Eigen::MatrixXd& within() const { return within_; }  ///< c, loads x (ports and acting loads)

 private:
  int sectors_ = 0;
  std::vector<Eigen::MatrixXd> interfaces_, blocks_;  // offsets 0 ... max
  Eigen::MatrixXd low_, high_, within_;
};

struct RingExtent {
  int max_offset = 6;       ///< farthest sectors whose ports are to be coupled
  bool whole_ring = false;  ///< couple all interfaces: for supports, and for stresses all around
};

/// Composes the ring exactly by its block-circulant structure: one Hermitian system per circumferential harmonic.
/// `threads` only changes the time, never the result. `probes`: loads of sector 0, loads x k; if there are any,
/// `carried` gets the displacements of all interfaces under each of them, m x sectors.
[[nodiscard]] CyclicCompliance compose_ring(const CondensedSector& sector, int sectors, const RingExtent& extent,
                                            SectorSupport support, int threads, const Eigen::MatrixXd& probes = {},
                                            std::vector<Eigen::MatrixXd>* carried = nullptr);

}  // namespace annulus::fem
