#include "fem/contact/pin_row.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

PinRow::PinRow(const PinHeld& pins, const GearBody& ring, double outside_radius, double width, bool mirrored,
               double derived_stiffness)
    : pins_(pins), stiffness_(pins.radial_stiffness.value_or(derived_stiffness)) {
  const double half_arc = pins.pin_diameter / 2 / outside_radius, pitch = ring.pitch_angle;
  const int ports = static_cast<int>(ring.ports.size()), first_port = ring.flank_ports();
  for (const double angle : pins.angles) angles_.push_back(mirrored ? -angle : angle);
  for (const double angle : angles_) {
    std::vector<std::pair<int, Eigen::MatrixXd>> pieces;
    const int lowest = static_cast<int>(std::floor((angle - half_arc) / pitch + 0.5));
    const int highest = static_cast<int>(std::floor((angle + half_arc) / pitch + 0.5));
    double total = 0;
    for (int sector = lowest; sector <= highest; ++sector) {
      Eigen::MatrixXd load = Eigen::MatrixXd::Zero(ports, 2);
      const auto& stations = ring.outside.stations();
      for (int e = 0; e < ring.outside.elements(); ++e) {
        // Overlap of the element with the arc, in the frame of the sector.
        const double a = std::max(stations[e * ring.outside.degree()], angle - half_arc - sector * pitch);
        const double b = std::min(stations[(e + 1) * ring.outside.degree()], angle + half_arc - sector * pitch);
        if (b <= a) continue;
        using Rule = boost::math::quadrature::gauss<double, 7>;
        const auto add = [&](double abscissa, double weight) {
          const double local = (a + b) / 2 + abscissa * (b - a) / 2;
          const double relative = (local + sector * pitch - angle) / half_arc;
          const double share = 0.75 * (1 - relative * relative) * weight * (b - a) / 2 / half_arc;
          total += share;
          const auto values = ring.outside(local);
          for (std::size_t i = 0; i < values.weights.size(); ++i) {
            const int station = values.first + static_cast<int>(i);
            const int radial = first_port + 2 * station, tangential = radial + 1;
            // Directions of the pin seen in the polar frame of the node.
            const double turn = angle - (stations[station] + sector * pitch);
            const double f = share * values.weights[i];
            load(radial, 0) -= f * std::cos(turn);
            load(tangential, 0) -= f * std::sin(turn);
            load(radial, 1) -= f * std::sin(turn);
            load(tangential, 1) += f * std::cos(turn);
          }
        };
        for (std::size_t q = 0; q < Rule::abscissa().size(); ++q) {
          add(Rule::abscissa()[q], Rule::weights()[q]);
          if (Rule::abscissa()[q] != 0) add(-Rule::abscissa()[q], Rule::weights()[q]);
        }
      }
      pieces.emplace_back(sector, load);
    }
    require(std::abs(total - 1) < 1e-9, "a pin is not wholly on the rim");
    loads_.push_back(std::move(pieces));
  }

  const int n = size(), outside = ports - first_port;
  compliance_ = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  resultants_ = Eigen::MatrixXd::Zero(2 * n, 3);
  for (int p = 0; p < n; ++p) {
    for (const auto& [sector, load] : loads_[p])
      for (int i = first_port; i < ports; ++i)
        resultants_.middleRows(2 * p, 2) += load.row(i).transpose() * ring.rigid_motion(i, sector);
    for (int q = 0; q <= p; ++q)
      for (const auto& [sector_p, load_p] : loads_[p])
        for (const auto& [sector_q, load_q] : loads_[q])
          compliance_.block(2 * p, 2 * q, 2, 2) +=
              load_p.bottomRows(outside).transpose() *
              ring.compliance.apply(sector_p - sector_q, first_port, outside, first_port, load_q.bottomRows(outside)) /
              width;
    for (int q = 0; q < p; ++q)
      compliance_.block(2 * q, 2 * p, 2, 2) = compliance_.block(2 * p, 2 * q, 2, 2).transpose();
  }
  compliance_.diagonal().array() += 1 / stiffness_;

  to_stations_.assign(ring.teeth, Eigen::MatrixXd::Zero(first_port, 2 * n));
  for (int tooth = 0; tooth < ring.teeth; ++tooth)
    for (int p = 0; p < n; ++p)
      for (const auto& [sector, load] : loads_[p])
        to_stations_[tooth].middleCols(2 * p, 2) +=
            ring.compliance.apply(tooth - sector, 0, first_port, first_port, load.bottomRows(outside)) / width;
}

const Eigen::MatrixXd& PinRow::to_ports(int tooth) const {
  const int teeth = static_cast<int>(to_stations_.size());
  return to_stations_[((tooth % teeth) + teeth) % teeth];
}

}  // namespace annulus::fem
