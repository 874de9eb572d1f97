#include "fem/contact/support_row.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {

SupportPlan::SupportPlan(SupportSites sites, int teeth, std::vector<double> slice_edges, FacePart part, double turn)
    : sites_(std::move(sites)), slice_edges_(std::move(slice_edges)), part_(part), turn_(turn), teeth_(teeth) {
  const double pitch = 2 * M_PI / teeth;
  const int slices = static_cast<int>(slice_edges_.size()) - 1;
  constexpr double same = 1e-10;  // rad: round-off of angles of a few turns
  const auto arc_number = [&](const ArcLoad& wanted) {
    const auto equal = [&](const ArcLoad& a) {
      return std::abs(a.centre - wanted.centre) < same && std::abs(a.half_arc - wanted.half_arc) < same &&
             std::abs(std::remainder(a.direction - wanted.direction, 2 * M_PI)) < same &&
             a.parabolic == wanted.parabolic && a.z_low == wanted.z_low;
    };
    const auto number = std::find_if(arcs_.begin(), arcs_.end(), equal) - arcs_.begin();
    if (number == static_cast<std::ptrdiff_t>(arcs_.size())) arcs_.push_back(wanted);
    return static_cast<int>(number);
  };
  for (int site = 0; site < static_cast<int>(sites_.sites.size()); ++site) {
    const auto& s = sites_.sites[site];
    const auto sector_of = [&](double angle) { return static_cast<int>(std::floor(angle / pitch + 0.5)); };
    // An arc that ends at a border does not reach over it.
    const double inside = s.half_arc * (1 - 1e-9);
    for (int direction = 0; direction < static_cast<int>(s.directions.size()); ++direction) {
      const auto& d = s.directions[direction];
      for (int slice = 0; slice < slices; ++slice) {
        Force force{Kind::support, site, direction, slice, {}};
        for (int sector = sector_of(s.angle - inside); sector <= sector_of(s.angle + inside); ++sector) {
          ArcLoad arc;
          arc.centre = s.angle - sector * pitch;
          arc.half_arc = s.half_arc;
          arc.direction = arc.centre + turn + M_PI - std::atan2(d.counter_clockwise, d.inward);
          arc.parabolic = s.parabolic;
          arc.z_low = slice_edges_[slice];
          arc.z_high = slice_edges_[slice + 1];
          force.pieces.emplace_back(((sector % teeth) + teeth) % teeth, arc_number(arc));
        }
        forces_.push_back(std::move(force));
      }
    }
  }
  if (!sites_.against_turning) return;
  Force torque{Kind::torque, 0, 0, 0, {}};
  torque.weight = 1.0 / (teeth * slices);
  for (int slice = 0; slice < slices; ++slice) {
    ArcLoad arc;
    arc.half_arc = pitch / 2;
    arc.direction = turn + M_PI / 2;
    arc.parabolic = false;
    arc.z_low = slice_edges_[slice];
    arc.z_high = slice_edges_[slice + 1];
    const int number = arc_number(arc);
    for (int sector = 0; sector < teeth; ++sector) torque.pieces.emplace_back(sector, number);
  }
  forces_.push_back(std::move(torque));
}

void SupportPlan::apply_on_other_flank(int places) {
  require(applied_ == 0, "forces on the other flank are applied once, here after ", applied_, " others");
  for (int tooth = 0; tooth < teeth_; ++tooth)
    for (int place = 0; place < places; ++place)
      forces_.push_back({Kind::applied, 0, 0, 0, {{tooth, static_cast<int>(arcs_.size()) + place}}});
  applied_ = teeth_ * places;
}

Eigen::MatrixXd SupportPlan::own_compliance() const {
  const auto n = static_cast<Eigen::Index>(forces_.size());
  const auto& edges = slice_edges_;
  const double width = (half_face() ? 2 : 1) * (edges.back() - edges.front());
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& force = forces_[i];
    if (force.kind != Kind::support) continue;
    const auto& own = direction(force);
    const auto middle = [&](Eigen::Index slice) {
      return ((edges[slice] + edges[slice + 1]) / 2 - edges.front()) / width;
    };
    compliance(i, i) += width / (edges[force.slice + 1] - edges[force.slice]) / own.stiffness;
    // The pin stays straight between its ends: a force at z divides between them by the lever rule. A force and its
    // mirror image load both ends equally, wherever they act.
    const Eigen::Index first = i - force.slice;
    for (Eigen::Index j = first; j < first + static_cast<Eigen::Index>(edges.size()) - 1; ++j) {
      const double a = middle(force.slice), b = middle(j - first);
      const double share = half_face() ? 1 : (1 - a) * (1 - b) + a * b;
      compliance(i, j) += share * 2 / own.end_stiffness;
    }
  }
  return compliance;
}

SupportRow::SupportRow(SupportPlan plan, const GearBody& ring)
    : plan_(std::move(plan)),
      ring_(ring),
      on_sector_(ring.teeth),
      applied_on_sector_(ring.teeth),
      interfaces_(std::make_unique<Interface[]>(ring.teeth)) {
  const bool solid = ring.axial_stations() > 1, tilts = solid && !plan_.half_face() && !plan_.held_axially();
  const auto& edges = plan_.slice_edges();
  const double width = edges.back() - edges.front();
  require(solid || edges.size() == 2, "a plane body has one slice, not ", edges.size() - 1);
  if (!solid) per_width_ = 1 / width;
  const int n = size();
  resultants_ = Eigen::MatrixXd::Zero(n, tilts ? 5 : 3);
  gap_.resize(n);
  for (int i = 0; i < n; ++i) {
    const auto& force = plan_.forces()[i];
    Wrench wrench = Wrench::Zero();
    for (const auto& [sector, arc] : force.pieces) {
      wrench += force.weight * ring.acting_wrench(arc, sector);
      auto& here = (i < unknowns() ? on_sector_ : applied_on_sector_)[sector];
      here.force.push_back(i < unknowns() ? i : i - unknowns());
      here.arc.push_back(arc);
      here.weight.push_back(force.weight);
    }
    const bool support = force.kind == SupportPlan::Kind::support;
    require(!support || std::abs(wrench.head<3>().norm() - 1) < 1e-9,
            "a support is not wholly on the rim: its unit force acts with ", wrench.head<3>().norm());
    resultants_.row(i).head<3>() << wrench[0], wrench[1], wrench[5];
    if (tilts) resultants_.row(i).tail<2>() << wrench[3], wrench[4];
    gap_[i] = support ? plan_.direction(force).clearance : 0.0;
    unilateral_.push_back(support && plan_.direction(force).unilateral);
  }

  compliance_ = Eigen::MatrixXd::Zero(unknowns(), unknowns());
  for (int sector = 0; sector < ring.teeth; ++sector) {
    const auto& here = on_sector_[sector];
    if (here.force.empty()) continue;
    const Eigen::MatrixXd displacement = at_loads(sector, ring.first_acting(), ring.acting_loads());
    for (std::size_t i = 0; i < here.force.size(); ++i)
      compliance_.row(here.force[i]) += here.weight[i] * displacement.row(here.arc[i]);
  }
  compliance_ = (0.5 * (compliance_ + compliance_.transpose())).eval();
  compliance_ += plan_.own_compliance().topLeftCorner(unknowns(), unknowns());
}

const Eigen::MatrixXd& SupportRow::at_interface(int interface) const {
  const int number = tooth_number(interface);
  auto& slot = interfaces_[number];
  std::call_once(slot.formed, [&] {
    const auto& c = ring_.compliance;
    slot.displacement = Eigen::MatrixXd::Zero(c.interface_size(), unknowns());
    for (int sector = 0; sector < ring_.teeth; ++sector) {
      const auto& here = on_sector_[sector];
      const auto count = static_cast<Eigen::Index>(here.force.size());
      if (count == 0) continue;
      Eigen::MatrixXd low(c.interface_size(), count), high(c.interface_size(), count);
      for (Eigen::Index i = 0; i < count; ++i) {
        low.col(i) = here.weight[i] * c.low().col(ring_.first_acting() + here.arc[i]);
        high.col(i) = here.weight[i] * c.high().col(ring_.first_acting() + here.arc[i]);
      }
      Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(c.interface_size(), count);
      c.add_interface_displacement(number - sector, low, displacement);
      c.add_interface_displacement(number - sector - 1, high, displacement);
      for (Eigen::Index i = 0; i < count; ++i) slot.displacement.col(here.force[i]) += displacement.col(i);
    }
    slot.displacement *= per_width_;
  });
  return slot.displacement;
}

Eigen::MatrixXd SupportRow::at_loads(int sector, int first, int count) const {
  const auto& c = ring_.compliance;
  Eigen::MatrixXd result =
      lapack::transpose_product(Eigen::MatrixXd(c.low().middleCols(first, count)), at_interface(sector)) +
      lapack::transpose_product(Eigen::MatrixXd(c.high().middleCols(first, count)), at_interface(sector + 1));
  const auto& here = on_sector_[tooth_number(sector)];
  for (std::size_t i = 0; i < here.force.size(); ++i)
    result.col(here.force[i]) +=
        per_width_ * here.weight[i] * c.within().col(ring_.first_acting() + here.arc[i]).segment(first, count);
  return result;
}

Eigen::VectorXd SupportRow::within(const OnSector& here, int first, int count, const Eigen::VectorXd& forces) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(count);
  for (std::size_t i = 0; i < here.force.size(); ++i)
    result += per_width_ * here.weight[i] * forces[here.force[i]] *
              ring_.compliance.within().col(ring_.first_acting() + here.arc[i]).segment(first, count);
  return result;
}

Eigen::VectorXd SupportRow::within_sector(int sector, int first, int count, const Eigen::VectorXd& forces) const {
  const int number = tooth_number(sector);
  Eigen::VectorXd result = within(on_sector_[number], first, count, forces);
  if (plan_.applied() > 0) result += within(applied_on_sector_[number], first, count, forces.tail(plan_.applied()));
  return result;
}

void SupportRow::add_applied(int interface, const Eigen::VectorXd& applied, Eigen::VectorXd& displacement) const {
  const auto& c = ring_.compliance;
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(c.interface_size(), 1);
  for (int sector = 0; sector < ring_.teeth; ++sector) {
    const auto& here = applied_on_sector_[sector];
    Eigen::MatrixXd low = Eigen::MatrixXd::Zero(c.interface_size(), 1), high = low;
    bool loaded = false;
    for (std::size_t i = 0; i < here.force.size(); ++i) {
      const double force = here.weight[i] * applied[here.force[i]];
      if (force == 0) continue;
      loaded = true;
      low += force * c.low().col(ring_.first_acting() + here.arc[i]);
      high += force * c.high().col(ring_.first_acting() + here.arc[i]);
    }
    if (!loaded) continue;
    c.add_interface_displacement(interface - sector, low, moved);
    c.add_interface_displacement(interface - sector - 1, high, moved);
  }
  displacement += per_width_ * moved.col(0);
}

Eigen::MatrixXd SupportRow::interface_displacement(int interface,
                                                   const Eigen::Ref<const Eigen::MatrixXd>& forces) const {
  Eigen::MatrixXd result = lapack::product(at_interface(interface), forces.topRows(unknowns()));
  if (plan_.applied() == 0) return result;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    Eigen::VectorXd displacement = result.col(i);
    add_applied(tooth_number(interface), forces.col(i).tail(plan_.applied()), displacement);
    result.col(i) = displacement;
  }
  return result;
}

Eigen::VectorXd SupportRow::applied_at_supports(const Eigen::VectorXd& applied) const {
  // By reciprocity from the work of the applied forces under those of the supports.
  Eigen::VectorXd result = Eigen::VectorXd::Zero(unknowns());
  for (int sector = 0; sector < ring_.teeth; ++sector) {
    const auto& here = applied_on_sector_[sector];
    for (std::size_t i = 0; i < here.force.size(); ++i)
      if (const double force = here.weight[i] * applied[here.force[i]]; force != 0)
        result += force * at_loads(sector, ring_.first_acting() + here.arc[i], 1).row(0).transpose();
  }
  return result;
}

Eigen::VectorXd SupportRow::applied_at_flank(int tooth, const Eigen::VectorXd& applied) const {
  const auto& c = ring_.compliance;
  const int ports = ring_.flank_ports(), number = tooth_number(tooth);
  Eigen::VectorXd low = Eigen::VectorXd::Zero(c.interface_size()), high = low;
  add_applied(number, applied, low);
  add_applied(tooth_number(tooth + 1), applied, high);
  return c.low().leftCols(ports).transpose() * low + c.high().leftCols(ports).transpose() * high +
         within(applied_on_sector_[number], 0, ports, applied);
}

Eigen::MatrixXd SupportRow::at_ports(int tooth, const Eigen::MatrixXd& port_weights) const {
  const auto& c = ring_.compliance;
  const int ports = ring_.flank_ports();
  const Eigen::MatrixXd low = lapack::product(c.low().leftCols(ports), port_weights);
  const Eigen::MatrixXd high = lapack::product(c.high().leftCols(ports), port_weights);
  Eigen::MatrixXd result =
      lapack::transpose_product(low, at_interface(tooth)) + lapack::transpose_product(high, at_interface(tooth + 1));
  const auto& here = on_sector_[tooth_number(tooth)];
  for (std::size_t i = 0; i < here.force.size(); ++i)
    result.col(here.force[i]) += per_width_ * here.weight[i] * port_weights.transpose() *
                                 c.within().col(ring_.first_acting() + here.arc[i]).head(ports);
  return result;
}

Eigen::VectorXd SupportRow::at_flank(int tooth, const Eigen::VectorXd& forces) const {
  const auto& c = ring_.compliance;
  const int ports = ring_.flank_ports();
  const Eigen::VectorXd low = interface_displacement(tooth, forces), high = interface_displacement(tooth + 1, forces);
  return c.low().leftCols(ports).transpose() * low + c.high().leftCols(ports).transpose() * high +
         within_sector(tooth, 0, ports, forces);
}

std::vector<double> SupportRow::site_forces(const Eigen::VectorXd& forces) const {
  std::vector<double> result(plan_.sites().sites.size(), 0.0);
  for (int i = 0; i < unknowns(); ++i) {
    const auto& force = plan_.forces()[i];
    if (force.kind == SupportPlan::Kind::support && force.direction == 0) result[force.site] += forces[i];
  }
  return result;
}

void SupportRow::fill_states(const Eigen::VectorXd& forces, LoadedPosition& position) const {
  const auto& sites = plan_.sites();
  std::vector<PinState> states(sites.sites.size());
  for (int i = 0; i < size(); ++i) {
    const auto& force = plan_.forces()[i];
    if (force.kind != SupportPlan::Kind::support) continue;
    const auto& direction = plan_.direction(force);
    auto& state = states[force.site];
    // A support feels the opposite of what it does to the rim; in the mirrored frame of the solve tangential forces
    // change their sign twice.
    state.radial_force += forces[i] * direction.inward;
    state.tangential_force += forces[i] * direction.counter_clockwise;
    // A bolt never lifts off; of a pin the radial direction decides.
    if (unilateral_[i] ? forces[i] > 0 : direction.inward == 1) state.touching = true;
  }
  position.pins.assign(states.begin(), states.begin() + sites.pins);
  position.housing.assign(states.begin() + sites.pins, states.end());
}

}  // namespace annulus::fem
