#include "fem/contact/planet_on_rollers.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::fem {

PlanetOnRollers::PlanetOnRollers(const PlanetRollers& rollers, SupportPlan bed, const GearBody& planet)
    : partner_(rollers.partner),
      bearing_(rollers.stiffness, rollers.play),
      planet_(planet),
      row_(std::move(bed), planet) {
  const Eigen::Index forces = row_.unknowns() - 1;  // without the torque
  directions_ = row_.resultants().topLeftCorner(forces, 2);
  stiffness_ = row_.plan().own_compliance().diagonal().head(forces).cwiseInverse();
}

SupportPlan PlanetOnRollers::bed(const PlanetRollers& rollers, int teeth, std::vector<double> slice_edges,
                                 bool half_face) {
  // A rigid rim that moves by d presses on half of the bed, by d cos t: the sum of k d cos^2 t over it is N k d / 4.
  const double patch = 4 * rollers.stiffness / teeth, pitch = 2 * M_PI / teeth;
  SupportSites sites;
  sites.against_turning = true;
  for (int tooth = 0; tooth < teeth; ++tooth)
    sites.sites.push_back({tooth * pitch, pitch / 2, false, {{-1, 0, true, rollers.play, patch}}});
  SupportPlan plan(std::move(sites), teeth, std::move(slice_edges), half_face);
  plan.apply_on_other_flank(places);
  return plan;
}

Eigen::VectorXd PlanetOnRollers::partner_forces(double angle) const {
  const auto& pair = partner_.pair();
  const double low = pair.roll_length_low(), high = pair.roll_length_high(), base = pair.pinion().base_radius();
  struct Contact {
    int tooth;
    double roll, share;
  };
  std::vector<Contact> contacts;
  double sum = 0;
  for (int tooth = 0; tooth < planet_.teeth; ++tooth) {
    // In the mirror image the tooth stands at the opposite angle, and rolls by its distance from where its roll is 0.
    const double mirrored = -(angle + tooth * planet_.pitch_angle);
    const double middle = (low + high) / 2;
    const double roll = middle + base * std::remainder(mirrored - partner_.planet_tooth_angle(middle), 2 * M_PI);
    if (roll <= low || roll >= high) continue;
    const double share = (roll - low) * (high - roll);
    contacts.push_back({tooth, roll, share});
    sum += share;
  }
  require(!contacts.empty(), "a mesh without contact");
  const auto& rolls = planet_.other_rolls;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(planet_.teeth * places);
  for (const auto& contact : contacts) {
    const double step = (rolls.back() - rolls.front()) / (places - 1);
    const double at = std::clamp((contact.roll - rolls.front()) / step, 0.0, places - 1.0);
    const int first = std::min(static_cast<int>(at), places - 2);
    const double share = contact.share / sum, part = at - first;
    forces[contact.tooth * places + first] += share * (1 - part);
    forces[contact.tooth * places + first + 1] += share * part;
  }
  return forces;
}

PlanetOnRollers::Motion PlanetOnRollers::bearing_motion(double load, const Eigen::VectorXd& forces,
                                                        const Eigen::VectorXd& change) const {
  // By virtual work a motion adds its part along the forces of this mesh, which are what bed and other mesh leave.
  const Eigen::Index applied = row_.plan().applied();
  const auto on_bed = [&](const Eigen::VectorXd& f) -> Eigen::Vector2d {
    return -directions_.transpose() * f.head(directions_.rows());
  };
  const auto of_mesh = [&](const Eigen::VectorXd& f) -> Eigen::Vector2d {
    return on_bed(f) - row_.resultants().bottomLeftCorner(applied, 2).transpose() * f.tail(applied);
  };
  const Eigen::Vector2d force = on_bed(forces), along = of_mesh(forces) / load,
                        turning = (of_mesh(change) - along) / load;

  // Newton's method; the potential is convex. It starts where the law of the bearing puts the planet.
  const double play = row_.gap()[0];
  Eigen::Vector2d motion = bearing_.distance(force.norm()) * force.normalized();
  constexpr int steps = 100;
  for (int step = 0; step < steps; ++step) {
    Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
    Eigen::Vector2d residual = force;
    for (Eigen::Index i = 0; i < stiffness_.size(); ++i) {
      const Eigen::Vector2d direction = directions_.row(i);
      const double pressed = -direction.dot(motion) - play;
      if (pressed <= 0) continue;
      residual += stiffness_[i] * pressed * direction;
      stiffness += stiffness_[i] * direction * direction.transpose();
    }
    const Eigen::Matrix2d compliance = stiffness.inverse();
    if (!compliance.allFinite()) break;
    const Eigen::Vector2d moved = compliance * residual;
    motion += moved;
    if (moved.norm() <= 1e-13 * motion.norm())
      return {along.dot(motion), along.dot(compliance * on_bed(change)) + turning.dot(motion)};
  }
  throw SolverError(
      fmt::format("a planet with a rigid rim on its rollers is not in equilibrium under {:.4g} N, with "
                  "{:.4g} m of play",
                  force.norm(), play));
}

}  // namespace annulus::fem
