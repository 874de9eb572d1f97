#include "dynamics/steady_state/other_motions.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "dynamics/steady_state/reach_of_backlash.h"
#include "dynamics/steady_state/steady_response.h"
#include "tests/dynamics/spur_pairs.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(other_motions)

using namespace annulus::dynamics;

/// A motion found by brute force.
struct BruteForce {
  double largest_force = 0;
  bool repeats = false;
};
BruteForce brute_force(const SpurPair& pair, double x, double v) {
  const auto highest = largest_forces(pair, x, v, 300, 24);
  BruteForce result{*std::max_element(highest.begin(), highest.end()), true};
  for (std::size_t i = 12; i < highest.size(); ++i)
    result.repeats = result.repeats && std::abs(highest[i] - highest[i - 12]) < 0.01 * result.largest_force;
  return result;
}

/// Periods after which the largest forces repeat, up to twelve; 0: none.
int period_of(const std::vector<double>& highest) {
  const double scale = *std::max_element(highest.begin(), highest.end());
  for (std::size_t period = 1; period <= 12; ++period) {
    bool repeats = true;
    for (std::size_t i = period; i < highest.size(); ++i)
      repeats = repeats && std::abs(highest[i] - highest[i - period]) < 0.01 * scale;
    if (repeats) return static_cast<int>(period);
  }
  return 0;
}

// Every motion to which more than 5 % of 200 starts of a brute force lead is found, and every motion that is found
// stays where it is.
BOOST_AUTO_TEST_CASE(motions_of_a_spur_pair_by_brute_force) {
  annulus::test::Verification record("Motions of a spur pair with backlash",
                                     "brute force: Runge-Kutta with fixed steps from 200 starts");
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int several = 0;
  for (const auto& [ripple, error] : {std::pair{0.2, 0.0}, {0.0, 0.1}})
    for (const double speed : {0.45, 0.6, 0.7, 0.78, 0.84, 0.9, 0.95, 1.1, 1.4, 1.7, 1.9, 2.1}) {
      SpurPair pair{.ripple = ripple, .error = error, .speed = speed};
      const auto system = pair.system();
      SteadyProblem problem = pair.problem();
      SimulationOptions options;
      options.other_motions.starts = 64;
      options.other_motions.threads = 2;
      options.samples_per_cycle = 128;
      const auto found = steady_response(system, problem, options);
      const auto& list = found.motions.list;
      const double reach = reach_of_backlash(system, problem);
      // Brute force.
      constexpr int starts = 200;
      std::vector<BruteForce> all;
      for (int i = 0; i < starts; ++i) {
        const double x = pair.half_backlash + 1 + 3 * uniform(random), v = 3 * uniform(random);
        all.push_back(brute_force(pair, x, v));
      }
      std::vector<std::pair<double, int>> groups;
      int irregular = 0;
      for (const auto& motion : all) {
        if (!motion.repeats) {
          ++irregular;
          continue;
        }
        const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& g) {
          return std::abs(g.first - motion.largest_force) < 0.02 * std::max(1.0, g.first);
        });
        if (known == groups.end())
          groups.emplace_back(motion.largest_force, 1);
        else
          ++known->second;
      }
      const std::string at = "ripple " + std::to_string(ripple) + ", speed " + std::to_string(speed);
      if (groups.size() + (irregular > 0 ? 1 : 0) > 1) {
        ++several;
        BOOST_TEST(reach >= within_reach, at << ", reach " << reach);
      }
      double largest = 0;
      for (const auto& [force, count] : groups) {
        if (count > 0.05 * starts) largest = std::max(largest, force);
        if (count <= 0.05 * starts) continue;
        double nearest = 1e300;
        for (const auto& motion : list)
          if (motion.period > 0) nearest = std::min(nearest, std::abs(motion.largest_force / SpurPair::load - force));
        if (list.empty()) nearest = std::abs(found.best.force.maxCoeff() / SpurPair::load - force);
        record.at_most("largest force of a motion to which more than 5 % of the starts lead, over the mean force", "",
                       nearest / std::max(1.0, force), 0.02, "samples of both");
      }
      if (irregular > 0.05 * starts)
        BOOST_TEST(std::any_of(list.begin(), list.end(), [](const auto& m) { return m.period == 0; }), at);
      IntegratorOptions integrator = options.integrator;
      integrator.method = Integrator::arkode_explicit;
      integrator.absolute_tolerance = 1e-7 * pair.deflection();
      const auto again = stable_motions(system, problem, found, integrator, {.starts = 4});
      for (std::size_t i = 0; i < again.states.size(); ++i) {
        if (again.found.list[i].period == 0) continue;
        const auto& state = again.states[i];
        const auto stays =
            brute_force(pair, state.q[0] / pair.deflection(), state.v[0] / (pair.deflection() * pair.rate()));
        record.close("largest force of a motion that was found", "", again.found.list[i].largest_force / SpurPair::load,
                     stays.largest_force, 0.02, "samples of both");
      }
      // The response is the one with the largest force.
      if (irregular == 0)
        record.at_most("largest force of the response below that of brute force, over the mean force", "",
                       std::max(0.0, largest - found.best.force.maxCoeff() / SpurPair::load) / largest, 0.02,
                       "samples of both");
    }
  BOOST_TEST(several >= 6, several);
}

// Where no mesh comes near to losing contact at any speed, nothing is tried.
BOOST_AUTO_TEST_CASE(nothing_is_tried_out_of_reach) {
  SpurPair pair{.zeta = 0.1, .ripple = 0.02, .speed = 0.9};
  const auto system = pair.system();
  SimulationOptions options;
  options.other_motions.starts = 8;
  const auto found = steady_response(system, pair.problem(), options);
  BOOST_TEST(reach_of_backlash(system, pair.problem()) < within_reach);
  BOOST_TEST(found.motions.starts == 0);
  BOOST_TEST(found.motions.list.empty());
  // Half the forced swing over twice the damping ratio.
  BOOST_TEST(reach_of_backlash(system, pair.problem()) == 0.02 / 0.2, boost::test_tools::tolerance(0.03));
  BOOST_TEST(found.motions.reach == reach_of_backlash(system, pair.problem()));
  pair.half_backlash = 0;
  BOOST_TEST(reach_of_backlash(pair.system(), pair.problem()) == 0);
  pair = {.ripple = 0.2, .speed = 0.8};
  auto problem = pair.problem();
  problem.period_in_cycles = longest_searched_period + 1;
  const auto refused = steady_response(pair.system(), problem, options);
  BOOST_TEST(refused.motions.starts == 0);
  BOOST_TEST(refused.motions.not_tried.find("repeats after 201 mesh cycles") != std::string::npos,
             refused.motions.not_tried);
}

// Pairs that brute force finds irregular from every start, and from some. The third one has a motion that
// repeats after nine periods.
BOOST_AUTO_TEST_CASE(irregular_and_rare_motions_are_recognised) {
  annulus::test::Verification record("Irregular motions of a spur pair with backlash",
                                     "brute force: Runge-Kutta with fixed steps");
  for (const auto& pair : {SpurPair{.zeta = 0.02, .error = 1, .half_backlash = 3, .speed = 1.5},
                           SpurPair{.zeta = 0.02, .error = 2, .half_backlash = 8, .speed = 0.9},
                           SpurPair{.zeta = 0.02, .ripple = 0.3, .error = 1, .half_backlash = 8, .speed = 1.8}}) {
    constexpr int starts = 24;
    std::map<int, int> by_period;
    double largest = 0;
    for (int i = 0; i < starts; ++i) {
      double x = pair.half_backlash + 1 + 3 * std::cos(2.4 * i), v = 3 * std::sin(1.7 * i);
      const auto highest = largest_forces(pair, x, v, 600, 120);
      const int period = period_of(highest);
      ++by_period[period];
      if (period == 0) largest = std::max(largest, *std::max_element(highest.begin(), highest.end()));
    }
    SimulationOptions options;
    options.other_motions.starts = starts;
    const auto found = steady_response(pair.system(), pair.problem(), options);
    for (const auto& [period, count] : by_period) {
      if (6 * count < starts) continue;
      int same = 0;
      double force = 0;
      for (const auto& motion : found.motions.list) {
        if (motion.period != period) continue;
        same += motion.starts;
        force = std::max(force, motion.largest_force);
      }
      BOOST_TEST_REQUIRE(same > 0, "period " << period);
      record.near("share of the starts that lead to motions of one period", "", static_cast<double>(same) / starts,
                  static_cast<double>(count) / starts, 0.3, "24 starts each, two standard deviations");
      if (period == 0)
        record.close("largest force of the irregular motion", "", force / SpurPair::load, largest, 0.15,
                     "largest of some hundred periods");
    }
  }
}

// Vibrations that die out slowly, or never, are no motions of their own.
BOOST_AUTO_TEST_CASE(slow_transients_are_undecided) {
  LumpedSystemBuilder builder;
  const SpurPair pair{.zeta = 0.05, .ripple = 0.2, .speed = 1.5};
  MeshElement mesh;
  mesh.name = "mesh";
  const auto x = builder.add_dof("x"), support = builder.add_dof("support");
  mesh.b = x + (-1.0) * support;
  builder.add_mass(x, SpurPair::mass);
  builder.add_mass(support, 100 * SpurPair::mass);
  builder.add_spring(support, SpurPair::stiffness, 0, "soft and undamped");
  builder.add_load(x, SpurPair::load);
  mesh.excitation = HarmonicStiffness{SpurPair::stiffness, pair.ripple, 0};
  mesh.frequency = pair.problem().mesh_frequency;
  mesh.damping = 2 * pair.zeta * std::sqrt(SpurPair::stiffness * SpurPair::mass);
  mesh.half_backlash = pair.deflection();
  builder.add_mesh(mesh);
  SimulationOptions options;
  options.other_motions.starts = 8;
  const auto found = steady_response(builder.build(), pair.problem(), options);
  BOOST_TEST(found.motions.reach > within_reach);
  BOOST_TEST(found.motions.undecided > 0);
  for (const auto& motion : found.motions.list) BOOST_TEST(motion.period != 0);
  BOOST_TEST(found.steady);
}

// The number of threads changes nothing; no load is a case in reach.
BOOST_AUTO_TEST_CASE(threads_and_idle_meshes) {
  const SpurPair pair{.ripple = 0.2, .speed = 0.84};
  SimulationOptions options;
  options.other_motions.starts = 12;
  const auto one = steady_response(pair.system(), pair.problem(), options);
  options.other_motions.threads = 2;
  const auto two = steady_response(pair.system(), pair.problem(), options);
  BOOST_REQUIRE(one.motions.list.size() == two.motions.list.size());
  for (std::size_t i = 0; i < one.motions.list.size(); ++i) {
    BOOST_TEST(one.motions.list[i].largest_force == two.motions.list[i].largest_force);
    BOOST_TEST(one.motions.list[i].starts == two.motions.list[i].starts);
  }
  options.mesh_cycles = 40;
  const auto prescribed = steady_response(pair.system(), pair.problem(), options);
  BOOST_TEST(prescribed.motions.not_tried.find("prescribed") != std::string::npos, prescribed.motions.not_tried);
  LumpedSystemBuilder builder;
  MeshElement mesh = pair.system().meshes().front();
  mesh.b = builder.add_dof("x");
  builder.add_mass(mesh.b, SpurPair::mass);
  builder.add_mesh(mesh);
  BOOST_TEST(std::isinf(reach_of_backlash(builder.build(), pair.problem())));
}

BOOST_AUTO_TEST_SUITE_END()
