#include "dynamics/steady_state/branches.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "core/errors.h"
#include "dynamics/steady_state/shooting.h"
#include "tests/dynamics/spur_pairs.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(branches)

using namespace annulus::dynamics;

LumpedFamily over_speed(SpurPair pair) {
  return [pair](double speed) mutable {
    pair.speed = speed;
    return LumpedCase{pair.system(), pair.problem()};
  };
}

const BranchEvent* find(const Branch& branch, BranchEvent::Kind kind, std::size_t number = 0) {
  for (const auto& event : branch.events)
    if (event.kind == kind && number-- == 0) return &event;
  return nullptr;
}

/// Largest force over the mean force after the speed was changed in small steps, by fixed steps of Runge-Kutta.
struct Sweep {
  std::vector<double> speed, force;
};
Sweep swept(SpurPair pair, double from, double to, int count) {
  Sweep sweep;
  double x = pair.half_backlash + 1, v = 0;
  for (int i = 0; i <= count; ++i) {
    pair.speed = from + (to - from) * i / count;
    sweep.speed.push_back(pair.speed);
    sweep.force.push_back(largest_forces(pair, x, v, 250, 2).back());
  }
  return sweep;
}

/// Shooting that resolves the multipliers to some 1e-4 of the deflection.
ShootingOptions exactly(const SpurPair& pair) {
  ShootingOptions options;
  options.displacement = 1e-4 * pair.deflection();
  options.rate = pair.rate();
  options.tolerance = 1e-6 * pair.deflection();
  options.integrator.relative_tolerance = 1e-10;
  options.integrator.absolute_tolerance = 1e-12 * pair.deflection();
  return options;
}

/// The state at time 0 of the motion with this largest force, from starts all over.
std::optional<SystemState> settled_state(const SpurPair& pair, double force) {
  for (int i = 0; i < 40; ++i) {
    double x = pair.half_backlash + 1 + 3 * std::cos(2.4 * i), v = 3 * std::sin(1.7 * i);
    if (std::abs(largest_forces(pair, x, v, 300, 1).back() - force) < 0.03 * force) return pair.state(x, v);
  }
  return std::nullopt;
}

// The softening resonance of a spur pair: both jumps of sweeps lie at the folds of the branch, and each sweep follows
// its stable parts.
BOOST_AUTO_TEST_CASE(jumps_of_a_spur_pair_lie_at_folds) {
  annulus::test::Verification record("Branch of a spur pair over speed",
                                     "sweeps up and down by Runge-Kutta with fixed steps");
  const SpurPair pair{.zeta = 0.05, .ripple = 0, .error = 0.2};
  BranchOptions options{.from = 0.6, .to = 1.2, .samples_per_cycle = 128};
  const auto branch = trace_branch(over_speed(pair), options);
  BOOST_TEST(branch.end.empty(), branch.end);
  const auto* up = find(branch, BranchEvent::Kind::fold);
  const auto* down = find(branch, BranchEvent::Kind::fold, 1);
  BOOST_REQUIRE(up != nullptr);
  BOOST_REQUIRE(down != nullptr);
  BOOST_TEST(up->input > down->input);
  constexpr int count = 240;
  const auto jump = [](const Sweep& sweep) {
    std::size_t at = 1;
    double largest = 0;
    for (std::size_t i = 1; i < sweep.force.size(); ++i)
      if (const double step = std::abs(sweep.force[i] - sweep.force[i - 1]); step > largest) {
        largest = step;
        at = i;
      }
    return (sweep.speed[at] + sweep.speed[at - 1]) / 2;
  };
  const auto rising = swept(pair, 0.6, 1.2, count), falling = swept(pair, 1.2, 0.6, count);
  const double step = 0.6 / count;
  record.near("speed of the jump while running up, over the natural frequency", "", up->input, jump(rising), step,
              "step of the sweep");
  record.near("speed of the jump while running down, over the natural frequency", "", down->input, jump(falling), step,
              "step of the sweep");
  // Every point of a sweep, but those at jumps, lies on a stable part.
  for (const auto& sweep : {rising, falling})
    for (std::size_t i = 0; i < sweep.speed.size(); ++i) {
      if (std::min(std::abs(sweep.speed[i] - up->input), std::abs(sweep.speed[i] - down->input)) < 2 * step) continue;
      double nearest = 1e300;
      for (std::size_t k = 1; k < branch.points.size(); ++k) {
        const auto &a = branch.points[k - 1], &b = branch.points[k];
        if (!a.stable || !b.stable) continue;
        const double share = (sweep.speed[i] - a.input) / (b.input - a.input);
        if (share < 0 || share > 1) continue;
        const double force = a.largest_force + share * (b.largest_force - a.largest_force);
        nearest = std::min(nearest, std::abs(force / SpurPair::load - sweep.force[i]));
      }
      record.at_most("distance of a sweep from the stable parts, over the force", "", nearest / sweep.force[i], 0.01,
                     "samples, and straight lines between the points of the branch");
    }
  // Between the folds the middle part is unstable.
  BOOST_TEST(std::any_of(branch.points.begin(), branch.points.end(), [](const auto& p) { return !p.stable; }));
  for (const auto& p : branch.points)
    if (p.input > up->input + step || p.input < down->input - step) BOOST_TEST(p.stable, p.input);
}

// Parametric resonance: the motion doubles its period where Mathieu's equation with damping becomes unstable, and the
// multipliers are those of shooting with the event-finding integrator.
BOOST_AUTO_TEST_CASE(period_doubling_and_multipliers) {
  annulus::test::Verification record("Period doubling of a spur pair", "shooting by the integrator that finds events");
  const SpurPair pair{.zeta = 0.03, .ripple = 0.2, .half_backlash = 1};
  BranchOptions options{.from = 2.3, .to = 1.6, .samples_per_cycle = 128};
  const auto branch = trace_branch(over_speed(pair), options);
  const auto* first = find(branch, BranchEvent::Kind::period_doubling);
  const auto* second = find(branch, BranchEvent::Kind::period_doubling, 1);
  BOOST_REQUIRE(first != nullptr);
  BOOST_REQUIRE(second != nullptr);
  // Multiplier of the linear equation by shooting, and its place on either side of the event.
  const auto modulus = [&](double speed) {
    auto at = pair;
    at.speed = speed;
    const auto system = at.system();
    const auto periodic = periodic_response(system, 1 / at.problem().mesh_frequency, 1, {.samples_per_cycle = 64});
    const auto found = shoot(system, 1 / at.problem().mesh_frequency,
                             {0, periodic.displacement.col(0), periodic.velocity.col(0), 0, 0}, exactly(at));
    return std::abs(found.multipliers[0]);
  };
  for (const auto* event : {first, second}) {
    double low = event->input - 0.02, high = event->input + 0.02;
    const double at_low = modulus(low) - 1;
    BOOST_REQUIRE((modulus(high) - 1) * at_low < 0);
    for (int i = 0; i < 30; ++i) {
      const double middle = (low + high) / 2;
      ((modulus(middle) - 1) * at_low > 0 ? low : high) = middle;
    }
    record.near("speed of a period doubling, over the natural frequency", "", event->input, low,
                std::max(event->error, 1e-3), "half a step along the branch");
  }
  for (std::size_t i = 0; i < branch.points.size(); i += 10)
    record.near("largest Floquet multiplier without loss of contact", "", branch.points[i].multiplier,
                modulus(branch.points[i].input), 2e-3, "samples of the balance");
}

// Multipliers of motions that lose contact, where the damping force jumps.
BOOST_AUTO_TEST_CASE(multipliers_with_loss_of_contact) {
  annulus::test::Verification record("Floquet multipliers of motions that lose contact",
                                     "shooting by the integrator that finds events");
  const SpurPair pair{.zeta = 0.05, .ripple = 0, .error = 0.2};
  for (const int samples : {128, 512}) {
    BranchOptions options{.from = 0.6, .to = 1.2, .samples_per_cycle = samples};
    const auto branch = trace_branch(over_speed(pair), options);
    int compared = 0;
    for (std::size_t i = 0; i < branch.points.size(); i += 7) {
      const auto& point = branch.points[i];
      if (point.contact_loss == 0 || !point.stable) continue;
      auto at = pair;
      at.speed = point.input;
      const auto system = at.system();
      // The stable motion with loss of contact by time integration.
      const auto settled = settled_state(at, point.largest_force / SpurPair::load);
      if (!settled) continue;
      const auto found = shoot(system, 1 / at.problem().mesh_frequency, *settled, exactly(at));
      BOOST_TEST(found.converged);
      record.near(samples == 128 ? "largest multiplier, 128 samples" : "largest multiplier, 512 samples", "",
                  point.multiplier, std::abs(found.multipliers[0]), samples == 128 ? 0.04 : 0.01,
                  "samples of the balance");
      ++compared;
    }
    BOOST_TEST(compared > 3, compared);
  }
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused) {
  const SpurPair pair{.error = 0.1};
  BOOST_CHECK_THROW((void)trace_branch(over_speed(pair), {.from = 1, .to = 1}), annulus::InputError);
  BOOST_CHECK_THROW((void)trace_branch(over_speed(pair), {.from = 1, .to = 1.1, .samples_per_cycle = 20}),
                    annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
