#include "fem/recovery/stress_recovery.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// Two lines that share the end of the first and the start of the second: there the mean counts.
StressRecovery::Line join(const StressRecovery::Line& first, const StressRecovery::Line& second) {
  const auto points = first.tangential.rows(), more = second.tangential.rows() - 1;
  StressRecovery::Line line = first;
  for (std::size_t i = 1; i < second.abscissa.size(); ++i)
    line.abscissa.push_back(first.abscissa.back() + second.abscissa[i] - second.abscissa.front());
  const auto append = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    Eigen::MatrixXd both(points + more, a.cols());
    both << a.topRows(points - 1), (a.bottomRows(1) + b.topRows(1)) / 2, b.bottomRows(more);
    return both;
  };
  line.tangential = append(first.tangential, second.tangential);
  line.von_mises = append(first.von_mises, second.von_mises);
  return line;
}

/// The largest entry of a line's stresses (points x axial stations), if it exceeds `least`, and its roughness. Solid
/// bodies have few points in a fillet, between which the stress bends; what these miss, their notch factors know.
void take_largest(const Eigen::MatrixXd& stress, double sign, double BodyStress::*value, double least,
                  RecoveredStress& largest) {
  Eigen::Index point = 0, station = 0;
  if ((sign * stress).maxCoeff(&point, &station) <= least) return;
  largest.*value = stress(point, station);
  largest.roughness.*value = 0;
  if (stress.cols() > 1 || point == 0 || point + 1 == stress.rows()) return;
  const double neighbours = (stress(point - 1, station) + stress(point + 1, station)) / 2;
  largest.roughness.*value = std::abs(stress(point, station) - neighbours);
}

}  // namespace

StressRecovery::StressRecovery(const GearBody& body, double face_width, double poisson_ratio,
                               const SupportRow* supports, const NotchFactors& notch)
    : body_(body),
      supports_(supports),
      per_width_(body.axial_stations() > 1 ? 1 : 1 / face_width),
      poisson_ratio_(poisson_ratio),
      notch_(notch),
      first_load_(body.root_low.first_load),
      loads_(body.root_low.loads() + body.root_high.loads() + body.rim.loads()) {
  require(body.root_low.points() > 1 && body.root_high.points() > 1, "a body that was not asked for its stresses has ",
          body.root_low.points(), " and ", body.root_high.points(), " points in its roots");
}

StressRecovery::Observed StressRecovery::looked_at(const Forces& forces) const {
  require(!forces.teeth->empty(), "stresses without forces");
  const auto& c = body_.compliance;
  int first_tooth = forces.teeth->front().tooth, last_tooth = first_tooth;
  for (const auto& t : *forces.teeth) {
    first_tooth = std::min(first_tooth, t.tooth);
    last_tooth = std::max(last_tooth, t.tooth);
  }
  const bool plane = body_.axial_stations() == 1;
  const bool all_around = forces.look == Look::around && plane && c.max_interface_offset() == c.sectors() / 2;
  // Outwards from the loaded teeth, as far as the coupling of the interfaces is known.
  const int loaded = last_tooth - first_tooth;
  const int reach = std::max(0, std::min({forces.look == Look::around ? 6 : 3, c.max_interface_offset() - 1 - loaded,
                                          (c.sectors() - loaded) / 2 - 1}));
  const int first = all_around ? 0 : first_tooth - reach, last = all_around ? body_.teeth - 1 : last_tooth + reach;
  require(last > first, "stresses of teeth from ", first, " to ", last, " that are not known to act on each other");
  return {first, Eigen::MatrixXd(loads_, last - first + 1)};
}

std::vector<StressRecovery::Observed> StressRecovery::by_sector(const std::vector<Forces>& list) const {
  const auto& c = body_.compliance;
  const int ports = body_.flank_ports();
  std::vector<Observed> result;
  // Of every member of the list, among all loaded teeth and all looked-at interfaces.
  std::vector<Eigen::Index> first_tooth, first_interface;
  Eigen::Index teeth = 0, interfaces = 0;
  for (const auto& forces : list) {
    result.push_back(looked_at(forces));
    first_tooth.push_back(teeth);
    first_interface.push_back(interfaces);
    teeth += std::ssize(*forces.teeth);
    interfaces += result.back().stress.cols() + 1;
  }
  Eigen::MatrixXd on_ports(ports, teeth);
  for (std::size_t k = 0; k < list.size(); ++k)
    for (std::size_t t = 0; t < list[k].teeth->size(); ++t)
      on_ports.col(first_tooth[k] + static_cast<Eigen::Index>(t)) = per_width_ * (*list[k].teeth)[t].ports;
  const Eigen::MatrixXd low = c.low().leftCols(ports) * on_ports, high = c.high().leftCols(ports) * on_ports;
  // The interfaces on both sides of every loaded tooth are loaded.
  std::vector<std::map<int, Eigen::VectorXd>> loaded(list.size());
  for (std::size_t k = 0; k < list.size(); ++k)
    for (std::size_t t = 0; t < list[k].teeth->size(); ++t) {
      const auto add = [&](int interface, const auto& load) {
        loaded[k].try_emplace(interface, Eigen::VectorXd::Zero(c.interface_size())).first->second += load;
      };
      const int tooth = (*list[k].teeth)[t].tooth;
      add(tooth, low.col(first_tooth[k] + static_cast<Eigen::Index>(t)));
      add(tooth + 1, high.col(first_tooth[k] + static_cast<Eigen::Index>(t)));
    }

  // Displacements of the looked-at interfaces. All loads that are as many interfaces away are one product.
  Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(c.interface_size(), interfaces);
  struct Passed {
    const Eigen::VectorXd* load;
    Eigen::Index to;
  };
  std::map<int, std::vector<Passed>> by_offset;
  for (std::size_t k = 0; k < list.size(); ++k)
    for (const auto& [interface, load] : loaded[k])
      for (Eigen::Index i = 0; i <= result[k].stress.cols(); ++i)
        by_offset[result[k].first + static_cast<int>(i) - interface].push_back({&load, first_interface[k] + i});
  for (const auto& [offset, passed] : by_offset) {
    const auto count = static_cast<Eigen::Index>(passed.size());
    Eigen::MatrixXd loads(c.interface_size(), count), moved = Eigen::MatrixXd::Zero(c.interface_size(), count);
    for (Eigen::Index i = 0; i < count; ++i) loads.col(i) = *passed[static_cast<std::size_t>(i)].load;
    c.add_interface_displacement(offset, loads, moved);
    for (Eigen::Index i = 0; i < count; ++i) displacement.col(passed[static_cast<std::size_t>(i)].to) += moved.col(i);
  }
  if (supports_ != nullptr) {
    struct Seen {
      const Eigen::VectorXd* forces;
      Eigen::Index at;
    };
    std::map<int, std::vector<Seen>> by_interface;
    for (std::size_t k = 0; k < list.size(); ++k)
      for (Eigen::Index i = 0; i <= result[k].stress.cols(); ++i)
        by_interface[supports_->number_of(result[k].first + static_cast<int>(i))].push_back(
            {list[k].supports, first_interface[k] + i});
    for (const auto& [interface, seen] : by_interface) {
      Eigen::MatrixXd forces(list.front().supports->size(), std::ssize(seen));
      for (std::size_t i = 0; i < seen.size(); ++i) forces.col(static_cast<Eigen::Index>(i)) = *seen[i].forces;
      const Eigen::MatrixXd moved = supports_->interface_displacement(interface, forces);
      for (std::size_t i = 0; i < seen.size(); ++i)
        displacement.col(seen[i].at) += moved.col(static_cast<Eigen::Index>(i));
    }
  }

  const Eigen::MatrixXd of_low = lapack::transpose_product(c.low().middleCols(first_load_, loads_), displacement);
  const Eigen::MatrixXd of_high = lapack::transpose_product(c.high().middleCols(first_load_, loads_), displacement);
  const Eigen::MatrixXd within = c.within().block(first_load_, 0, loads_, ports) * on_ports;
  for (std::size_t k = 0; k < list.size(); ++k) {
    auto& [first, stress] = result[k];
    const auto sectors = stress.cols();
    stress = of_low.middleCols(first_interface[k], sectors) + of_high.middleCols(first_interface[k] + 1, sectors);
    for (Eigen::Index i = 0; i < sectors; ++i) {
      const int sector = first + static_cast<int>(i);
      for (std::size_t t = 0; t < list[k].teeth->size(); ++t)
        if (number((*list[k].teeth)[t].tooth) == number(sector))
          stress.col(i) += within.col(first_tooth[k] + static_cast<Eigen::Index>(t));
      if (supports_ != nullptr)
        stress.col(i) += supports_->within_sector(sector, first_load_, loads_, *list[k].supports);
    }
  }
  return result;
}

StressRecovery::Line StressRecovery::on_sector(const StressLine& line,
                                               const Eigen::Ref<const Eigen::VectorXd>& observed) const {
  Line result{line.arc, Eigen::MatrixXd(line.points(), line.axial_stations()), {}};
  result.von_mises = result.tangential;
  const double nu = poisson_ratio_;
  Eigen::Index at = line.first_load - first_load_;
  for (int u = 0; u < line.points(); ++u)
    for (int z = 0; z < line.axial_stations(); ++z, at += line.components) {
      const double t = observed[at];
      const double axial = line.components == 1 ? nu * t : observed[at + 1];  // plane strain
      const double shear = line.components == 1 ? 0 : observed[at + 2];
      result.tangential(u, z) = t;
      result.von_mises(u, z) = std::sqrt(t * t - t * axial + axial * axial + 3 * shear * shear);
    }
  return result;
}

StressRecovery::Result StressRecovery::stresses(const std::vector<ToothForces>& teeth,
                                                const Eigen::VectorXd& supports) const {
  const Forces forces{&teeth, &supports, Look::around};
  return evaluated(forces, by_sector({forces}).front(), Lines::wanted);
}

std::vector<RecoveredStress> StressRecovery::largest(const std::vector<Forces>& list) const {
  const auto observed = by_sector(list);
  std::vector<RecoveredStress> result;
  for (std::size_t k = 0; k < list.size(); ++k)
    result.push_back(evaluated(list[k], observed[k], Lines::left_out).largest);
  return result;
}

StressRecovery::Result StressRecovery::evaluated(const Forces& forces, const Observed& observed, Lines lines) const {
  const auto sectors = observed.stress.cols();
  const bool closed = sectors == body_.teeth;
  // The teeth in the other mesh of a planet have their loads at a few places: far from them alone that is exact.
  const bool other_mesh = supports_ != nullptr && supports_->unknowns() < supports_->size();
  const auto is_near = [&](int sector) {
    constexpr int reach = 3;
    return std::any_of(forces.teeth->begin(), forces.teeth->end(), [&](const auto& t) {
      const int apart = number(sector - t.tooth);
      return std::min(apart, body_.teeth - apart) <= reach;
    });
  };

  Result result;
  auto& largest = result.largest;
  for (Eigen::Index i = 0; i < (closed ? sectors : sectors - 1); ++i) {
    if (other_mesh && !is_near(observed.first + static_cast<int>(i))) continue;
    Line root = join(on_sector(body_.root_high, observed.stress.col(i)),
                     on_sector(body_.root_low, observed.stress.col((i + 1) % sectors)));
    for (Eigen::Index k = 0; k < root.tangential.size(); ++k) {
      const double factor = root.tangential.data()[k] < 0 ? notch_.compression : notch_.tension;
      root.tangential.data()[k] *= factor;
      root.von_mises.data()[k] *= factor;
    }
    take_largest(root.tangential, 1, &BodyStress::root_tension, largest.root_tension, largest);
    take_largest(root.tangential, -1, &BodyStress::root_compression, -largest.root_compression, largest);
    const double before = largest.root_von_mises;
    take_largest(root.von_mises, 1, &BodyStress::root_von_mises, before, largest);
    if (lines == Lines::wanted && largest.root_von_mises > before) result.root = std::move(root);
  }
  if (body_.rim.points() == 0) return result;
  Line rim = whole_rim(observed);
  take_largest(rim.tangential, 1, &BodyStress::rim_tension, 0, largest);
  take_largest(rim.tangential, -1, &BodyStress::rim_compression, 0, largest);
  take_largest(rim.von_mises, 1, &BodyStress::rim_von_mises, 0, largest);
  if (lines == Lines::wanted) result.rim = std::move(rim);
  return result;
}

StressRecovery::Line StressRecovery::whole_rim(const Observed& observed) const {
  const auto sectors = observed.stress.cols();
  const Eigen::Index points = body_.rim.points(), stations = body_.rim.axial_stations();
  const Eigen::Index rows = sectors * (points - 1) + 1;
  Line rim{{}, Eigen::MatrixXd::Zero(rows, stations), Eigen::MatrixXd::Zero(rows, stations)};
  for (Eigen::Index i = 0; i < sectors; ++i) {
    const Line own = on_sector(body_.rim, observed.stress.col(i));
    const double turned = (observed.first + static_cast<double>(i)) * body_.pitch_angle;
    for (Eigen::Index u = i == 0 ? 0 : 1; u < points; ++u) rim.abscissa.push_back(body_.rim.angle[u] + turned);
    rim.tangential.middleRows(i * (points - 1), points) += own.tangential;
    rim.von_mises.middleRows(i * (points - 1), points) += own.von_mises;
    if (i == 0) continue;  // where two sectors meet the mean counts
    rim.tangential.row(i * (points - 1)) /= 2;
    rim.von_mises.row(i * (points - 1)) /= 2;
  }
  return rim;
}

NotchFactors notch_factors(const GearBody& fine, const GearBody& coarse, double poisson_ratio, int degree) {
  // The same forces on both flanks, of which each has its own nodes.
  const auto under = [&](const GearBody& section, double part) {
    const auto& flank = section.flank;
    const auto at = flank(flank.low() + part * (flank.high() - flank.low()));
    ToothForces force{0, Eigen::VectorXd::Zero(section.flank_ports())};
    for (std::size_t k = 0; k < at.weights.size(); ++k) force.ports[at.first + static_cast<int>(k)] = at.weights[k];
    return StressRecovery(section, 1, poisson_ratio, nullptr).stresses({force}, {}).largest;
  };
  NotchFactors factors;
  double largest = 0;
  for (const double part : {0.2, 0.4, 0.6, 0.8}) {
    const auto exact = under(fine, part), rough = under(coarse, part);
    if (exact.root_tension <= largest) continue;
    largest = exact.root_tension;
    factors = {exact.root_tension / rough.root_tension, exact.root_compression / rough.root_compression};
  }
  // Cells of a solid do not miss exactly what cells of a plane section miss. Measured against the finest level of solid
  // elements (spur teeth, 2 to 15 modules wide): up to 0.06 of the correction with linear elements, and 0.47 of the
  // small one with quadratic elements.
  const double left = degree == 1 ? 0.15 : 0.5;
  factors.error = left * std::max(std::abs(factors.tension - 1), std::abs(factors.compression - 1));
  return factors;
}

}  // namespace annulus::fem
