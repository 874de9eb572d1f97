#include "fem/condensation/altered_ring.h"

#include <Eigen/LU>

#include "core/errors.h"
#include "fem/condensation/cyclic_body.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// Rows of the high interface turned into the frame of the next sector.
void turn_high_rows(const CondensedSector& sector, Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd columns = matrix.transpose();
  sector.turn_columns(columns, columns.cols() / 2);
  matrix = columns.transpose();
}

Eigen::MatrixXd turned_stiffness(const CondensedSector& sector) {
  Eigen::MatrixXd stiffness = sector.interface_stiffness;
  turn_high_rows(sector, stiffness);
  stiffness.transposeInPlace();
  turn_high_rows(sector, stiffness);
  return stiffness;
}

}  // namespace

AlteredRing::AlteredRing(const CondensedSector& regular, int sectors, int most, int threads)
    : regular_stiffness_(turned_stiffness(regular)) {
  require(most < sectors / 2, most, " of ", sectors, " sectors are replaced");
  const CyclicCompliance composed = compose_ring(regular, sectors, {most, false}, SectorSupport::held, threads);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(composed.interface_size(), composed.interface_size());
  for (int d = 0; d <= most; ++d) {
    interface_compliance_.push_back(Eigen::MatrixXd::Zero(composed.interface_size(), composed.interface_size()));
    composed.add_interface_displacement(d, unit, interface_compliance_.back());
  }
}

Eigen::MatrixXd AlteredRing::compliance(const std::vector<const CondensedSector*>& replaced) const {
  const int count = static_cast<int>(replaced.size());
  require(count >= 1 && count < static_cast<int>(interface_compliance_.size()), count,
          " sectors are replaced, fewer than ", interface_compliance_.size(), " were announced");
  const Eigen::Index m = regular_stiffness_.rows() / 2, interfaces = (count + 1) * m;
  Eigen::MatrixXd composed(interfaces, interfaces);
  for (int i = 0; i <= count; ++i)
    for (int j = 0; j <= i; ++j) {
      composed.block(i * m, j * m, m, m) = interface_compliance_[i - j];
      composed.block(j * m, i * m, m, m) = interface_compliance_[i - j].transpose();
    }
  Eigen::Index ports = 0;
  for (const auto* sector : replaced) ports += sector->interface_load.cols();
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(interfaces, interfaces),
                  loads = Eigen::MatrixXd::Zero(interfaces, ports);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(ports, ports);
  Eigen::Index at = 0;
  for (int i = 0; i < count; ++i) {
    const CondensedSector& sector = *replaced[i];
    require(sector.interface_stiffness.rows() == 2 * m, "a replaced sector has interfaces of ",
            sector.interface_stiffness.rows(), " values, not ", 2 * m);
    change.block(i * m, i * m, 2 * m, 2 * m) += turned_stiffness(sector) - regular_stiffness_;
    Eigen::MatrixXd load = sector.interface_load;
    turn_high_rows(sector, load);
    loads.block(i * m, at, 2 * m, load.cols()) = load;
    result.block(at, at, load.cols(), load.cols()) = sector.compliance;
    at += load.cols();
  }
  // C' = (1 + C dS)^-1 C [Woodbury1950], applied to the loads.
  const Eigen::MatrixXd moved = lapack::product(composed, loads);
  const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(interfaces, interfaces) + lapack::product(composed, change);
  const Eigen::MatrixXd answer = system.partialPivLu().solve(moved);
  const Eigen::MatrixXd through_interfaces = lapack::transpose_product(loads, answer);
  result += (through_interfaces + through_interfaces.transpose()) / 2;
  return result;
}

}  // namespace annulus::fem
