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

int PlanetOnRollers::patches_per_tooth(int teeth, int slices) {
  constexpr int most = 400, most_per_tooth = 4;
  return std::clamp(most / (teeth * slices), 1, most_per_tooth);
}

SupportPlan PlanetOnRollers::bed(const PlanetRollers& rollers, int teeth, std::vector<double> slice_edges,
                                 FacePart part) {
  // A rigid rim that moves by d presses on half of the bed, by d cos t: the sum of k d cos^2 t over it is N k d / 4.
  const int per_tooth = patches_per_tooth(teeth, static_cast<int>(slice_edges.size()) - 1);
  const int patches = teeth * per_tooth;
  const double patch = 4 * rollers.stiffness / patches, spacing = 2 * M_PI / patches;
  const double first = -(per_tooth - 1) / 2.0 * spacing;
  SupportSites sites;
  sites.against_turning = true;
  for (int i = 0; i < patches; ++i)
    sites.sites.push_back({first + i * spacing, spacing / 2, false, {{-1, 0, true, rollers.play, patch}}});
  SupportPlan plan(std::move(sites), teeth, std::move(slice_edges), part);
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
    const double roll = middle + base * std::remainder(mirrored - partner_.pinion_tooth_angle(middle), 2 * M_PI);
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
                                                        const std::vector<Change>& changes) const {
  // By virtual work a motion adds its part along the forces of this mesh, which are what bed and other mesh leave.
  const Eigen::Index applied = row_.plan().applied();
  const auto on_bed = [&](const Eigen::VectorXd& f) -> Eigen::Vector2d {
    return -directions_.transpose() * f.head(directions_.rows());
  };
  const auto of_mesh = [&](const Eigen::VectorXd& f) -> Eigen::Vector2d {
    return on_bed(f) - row_.resultants().bottomLeftCorner(applied, 2).transpose() * f.tail(applied);
  };
  const Eigen::Vector2d along = of_mesh(forces) / load;
  Eigen::Matrix2d stiffness;
  const Eigen::Vector2d motion = round_rim(on_bed(forces), stiffness);
  Motion result{along.dot(motion)};
  for (const auto& change : changes) {
    const Eigen::Vector2d turning = (of_mesh(change.forces) - change.own * along) / load;
    result.slopes.push_back(along.dot(stiffness.inverse() * on_bed(change.forces)) + turning.dot(motion));
  }
  return result;
}

void PlanetOnRollers::press(const Eigen::Vector2d& motion, const Eigen::Vector2d& force, Eigen::Vector2d& residual,
                            Eigen::Matrix2d& stiffness) const {
  constexpr double unloaded = 1e-7;  // of the stiffness, as in a RadialBearing
  residual = force;
  stiffness.setZero();
  for (Eigen::Index i = 0; i < stiffness_.size(); ++i) {
    const Eigen::Vector2d direction = directions_.row(i);
    const double moved = direction.dot(motion), pressed = -moved - play();
    const double k = stiffness_[i];
    residual -= unloaded * k * moved * direction;
    stiffness += unloaded * k * direction * direction.transpose();
    if (pressed <= 0) continue;
    residual += k * pressed * direction;
    stiffness += k * direction * direction.transpose();
  }
}

Eigen::Vector2d PlanetOnRollers::round_rim(const Eigen::Vector2d& force, Eigen::Matrix2d& stiffness) const {
  // Newton's method with a search along its steps: the potential is convex. It starts where the law puts the planet.
  Eigen::Vector2d motion = bearing_.distance(force.norm()) * force.normalized(), residual;
  press(motion, force, residual, stiffness);
  constexpr int steps = 100, halves = 60;
  constexpr double accuracy = 1e-11;
  for (int step = 0; step < steps; ++step) {
    if (residual.norm() <= accuracy * force.norm()) return motion;
    const Eigen::Vector2d change = stiffness.inverse() * residual, from = motion;
    const double slope = change.dot(residual);
    double share = 1, low = 0, high = 2;
    for (int half = 0; half < halves; ++half) {
      motion = from + share * change;
      press(motion, force, residual, stiffness);
      const double here = change.dot(residual);
      if (std::abs(here) <= 0.9 * slope) break;
      (here > 0 ? low : high) = share;
      share = (low + high) / 2;
    }
  }
  throw SolverError(
      fmt::format("a planet with a rigid rim on its rollers is not in equilibrium under {:.4g} N, with "
                  "{:.4g} m of play",
                  force.norm(), play()));
}

}  // namespace annulus::fem
