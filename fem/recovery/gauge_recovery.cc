#include "fem/recovery/gauge_recovery.h"

#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

GaugeRecovery::GaugeRecovery(std::size_t gauge, const GearBody& body, double face_width, const SupportRow* supports,
                             double factor)
    : body_(body),
      probe_(body.gauges.at(gauge)),
      supports_(supports),
      per_width_(body.axial_stations() > 1 ? 1 : 1 / face_width),
      first_load_(body.root_low.first_load),
      loads_(body.root_low.loads() + body.root_high.loads() + body.rim.loads()),
      factor_(factor) {
  if (supports_ == nullptr) return;
  const auto& c = body_.compliance;
  at_supports_ = Eigen::MatrixXd::Zero(body_.teeth, supports_->size());
  for (const auto& part : probe_.parts) {
    const Eigen::RowVectorXd low = (c.low().middleCols(first_load_, loads_) * part.weights).transpose(),
                             high = (c.high().middleCols(first_load_, loads_) * part.weights).transpose();
    for (int turn = 0; turn < body_.teeth; ++turn)
      at_supports_.row(turn) +=
          low * supports_->at_interface(part.sector + turn) + high * supports_->at_interface(part.sector + turn + 1);
  }
}

Eigen::VectorXd GaugeRecovery::strains(const std::vector<ToothForces>& teeth, const Eigen::VectorXd& supports) const {
  const auto& c = body_.compliance;
  const int ports = body_.flank_ports(), n = body_.teeth;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(n);
  if (supports_ != nullptr) {
    result = at_supports_ * supports;
    for (int turn = 0; turn < n; ++turn)
      for (const auto& part : probe_.parts)
        result[turn] += part.weights.dot(supports_->within_sector(part.sector + turn, first_load_, loads_, supports));
  }
  for (const auto& t : teeth) {
    const Eigen::VectorXd low = per_width_ * c.low().leftCols(ports) * t.ports,
                          high = per_width_ * c.high().leftCols(ports) * t.ports;
    const Eigen::VectorXd by_low = probe_.at_interfaces.transpose() * low,
                          by_high = probe_.at_interfaces.transpose() * high;
    const Eigen::VectorXd within = per_width_ * (c.within().block(first_load_, 0, loads_, ports) * t.ports);
    for (int turn = 0; turn < n; ++turn)
      result[turn] += by_low[number(t.tooth - turn)] + by_high[number(t.tooth + 1 - turn)];
    for (const auto& part : probe_.parts) result[number(t.tooth - part.sector)] += part.weights.dot(within);
  }
  return factor_ * result;
}

double gauge_factor(std::size_t gauge, double angle, const GearBody& fine, const GearBody& coarse) {
  const GaugeRecovery exact(gauge, fine, 1, nullptr), rough(gauge, coarse, 1, nullptr);
  const int space = static_cast<int>(std::floor(angle / fine.pitch_angle));
  const auto under = [](const GearBody& section, const GaugeRecovery& recovery, int tooth, double part) -> double {
    const auto& flank = section.flank;
    const auto at = flank(flank.low() + part * (flank.high() - flank.low()));
    ToothForces force{tooth, Eigen::VectorXd::Zero(section.flank_ports())};
    for (std::size_t k = 0; k < at.weights.size(); ++k) force.ports[at.first + static_cast<int>(k)] = at.weights[k];
    return recovery.strains({force}, {})[0];
  };
  // Where the sections have next to no strain, their ratio says nothing.
  constexpr double least = 0.2;
  double largest = 0, factor = 1;
  for (const int tooth : {space, space + 1})
    for (const double part : {0.2, 0.4, 0.6, 0.8}) {
      const double strain = under(fine, exact, tooth, part), coarser = under(coarse, rough, tooth, part);
      if (std::abs(strain) <= largest || std::abs(coarser) < least * std::abs(strain)) continue;
      largest = std::abs(strain);
      factor = strain / coarser;
    }
  return factor;
}

}  // namespace annulus::fem
