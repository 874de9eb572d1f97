#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "core/errors.h"
#include "fem/contact/contact_system.h"
#include "fem/levels/mesh_bodies.h"
#include "fem/problem/problem_check.h"
#include "ring_paper_problems.h"

/// Every position is a problem of its own, and its solution holds for the pairs it leaves out as well.
BOOST_AUTO_TEST_SUITE(contact_positions)

using namespace annulus::tests;
using annulus::fem::ContactSystem;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedPosition;
using annulus::geometry::Gear;
using annulus::geometry::GearKind;

/// A ring of 82 teeth on 24 pins: every position under other supports.
LoadedMeshProblem small_pinned_ring(double first_pin) {
  annulus::geometry::GearParameters planet;
  planet.teeth = 31;
  planet.module = 2e-3;
  planet.pressure_angle = 20 * M_PI / 180;
  planet.face_width = 20e-3;
  planet.tip_diameter = 66e-3;
  planet.root_diameter = 57e-3;
  planet.root_fillet_factor = 0.3;
  auto ring = planet;
  ring.kind = GearKind::internal;
  ring.teeth = 82;
  ring.tip_diameter = 160.4e-3;
  ring.root_diameter = 169e-3;
  annulus::fem::PinHeld pins;
  pins.angles = annulus::fem::equal_angles(24, first_pin);
  pins.pin_diameter = 6e-3;
  pins.radial_stiffness = pins.tangential_stiffness = 1e9;
  LoadedMeshProblem problem{{Gear(planet), Gear(ring), 51e-3}, {}, 20e-3, 10e-3, 86.9e-3, pins};
  problem.loads = {375, 750, 1500, 2250, 3000};
  problem.phases = 64;
  return problem;
}

/// A rim of 0.44 modules on 40 bolts, of a wind turbine's first stage.
LoadedMeshProblem thin_bolted_ring() {
  annulus::geometry::GearParameters planet;
  planet.teeth = 17;
  planet.module = 45e-3;
  planet.pressure_angle = 20 * M_PI / 180;
  planet.profile_shift = 0.802;
  planet.face_width = 491e-3;
  auto ring = planet;
  ring.kind = GearKind::internal;
  ring.teeth = 56;
  ring.profile_shift = 0.501;
  annulus::fem::PinHeld bolts;
  bolts.angles = annulus::fem::equal_angles(40, 0);
  bolts.pin_diameter = 48e-3;
  bolts.unilateral = false;
  const Gear wheel(ring);
  LoadedMeshProblem problem{{Gear(planet), wheel, 863e-3}, {}, 491e-3, 240e-3, wheel.root_radius() + 20e-3, bolts};
  problem.phases = 64;
  return problem;
}

struct Solver {
  LoadedMeshProblem problem;
  annulus::fem::FlankContact flanks;
  annulus::fem::MeshBodies bodies;
  ContactSystem system;

  explicit Solver(const LoadedMeshProblem& p)
      : problem(p),
        flanks(p.pair),
        bodies(build_bodies(p, flanks, {}, 1)),
        system(flanks, *bodies.pinion, *bodies.wheel, bodies.supports.get(), p.materials, bodies.slice_edges, {}) {}
};

struct Place {
  int cycle, phase;
  double load;
};

double relative(double a, double b) { return std::abs(a - b) / std::max(std::abs(a), std::abs(b)); }

/// Largest relative difference of anything that a position states.
double difference(const LoadedPosition& a, const LoadedPosition& b) {
  BOOST_TEST_REQUIRE(a.pair_share.size() == b.pair_share.size());
  BOOST_TEST_REQUIRE(a.pins.size() == b.pins.size());
  BOOST_TEST_REQUIRE(a.pressure.size() == b.pressure.size());
  double worst = std::max(
      {relative(a.entry.lte, b.entry.lte), relative(a.entry.stiffness_secant, b.entry.stiffness_secant),
       relative(a.entry.stiffness_tangent, b.entry.stiffness_tangent), relative(a.max_pressure, b.max_pressure)});
  for (std::size_t i = 0; i < a.pair_share.size(); ++i)
    worst = std::max(worst, std::abs(a.pair_share[i] - b.pair_share[i]));
  for (std::size_t i = 0; i < a.pins.size(); ++i)
    worst = std::max(worst, std::abs(a.pins[i].radial_force - b.pins[i].radial_force) / a.load);
  for (std::size_t i = 0; i < a.pressure.size(); ++i)
    worst = std::max(worst, std::abs(a.pressure[i].pressure - b.pressure[i].pressure) / a.max_pressure);
  return worst;
}

BOOST_AUTO_TEST_CASE(positions_do_not_depend_on_those_solved_before) {
  const Solver solver(small_pinned_ring(0));
  // Around a pair's end of contact, where some cycles need longer windows than others.
  std::vector<Place> places;
  for (const int phase : {43, 45, 48, 52, 53, 61})
    for (int cycle = 0; cycle < 41; ++cycle)
      for (const double load : {375.0, 3000.0}) places.push_back({cycle, phase, load});
  const auto alone = [&](const Place& p, ContactSystem::PairsCache& cache, ContactSystem::WarmStart& warm) {
    return solver.system.solve(p.cycle, p.phase / 64.0, p.load, cache, warm, nullptr);
  };
  std::vector<LoadedPosition> expected;
  std::size_t most_setups = 0;
  for (const auto& p : places) {
    ContactSystem::PairsCache cache;
    ContactSystem::WarmStart warm;
    expected.push_back(alone(p, cache, warm));
    most_setups = std::max(most_setups, cache.setups.size());
  }
  BOOST_TEST(most_setups > 1U);  // else nothing could pass from one position to another

  std::vector<std::size_t> order(places.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  // As tables are solved (a phase and a load, cycle by cycle), backwards, and shuffled.
  const auto as_table = [&](std::size_t a, std::size_t b) {
    const auto &p = places[a], &q = places[b];
    return std::tie(p.phase, p.load, p.cycle) < std::tie(q.phase, q.load, q.cycle);
  };
  std::sort(order.begin(), order.end(), as_table);
  auto backwards = order, shuffled = order;
  std::reverse(backwards.begin(), backwards.end());
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(7));
  for (const auto& one_order : {order, backwards, shuffled}) {
    ContactSystem::PairsCache cache;
    ContactSystem::WarmStart warm;
    double worst = 0;
    for (const std::size_t i : one_order)
      worst = std::max(worst, difference(expected[i], alone(places[i], cache, warm)));
    BOOST_TEST_MESSAGE("largest relative difference " << worst);
    BOOST_TEST(worst < 1e-10);  // rounding; contacts that bear nothing may count as touching
  }
}

BOOST_AUTO_TEST_CASE(pins_turned_by_whole_teeth_give_the_same_table) {
  constexpr int turned_teeth = 3, phases = 8;
  auto problem = small_pinned_ring(0);
  // The ring is solved in a mirror image: the other way.
  auto turned = small_pinned_ring(turned_teeth * problem.pair.wheel().pitch_angle());
  problem.phases = turned.phases = phases;
  const auto a = solve_plane(problem), b = solve_plane(turned);
  double table = 0, pressure = 0;
  const int cycles = a.table.positions();
  const auto loads = problem.loads.size();
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (std::size_t i = 0; i < phases * loads; ++i) {
      const auto& p = a.positions[static_cast<std::size_t>(cycle) * phases * loads + i];
      const auto& q = b.positions[static_cast<std::size_t>((cycle + turned_teeth) % cycles) * phases * loads + i];
      table = std::max(table, relative(p.entry.lte, q.entry.lte));
      pressure = std::max(pressure, relative(p.max_pressure, q.max_pressure));
    }
  BOOST_TEST_MESSAGE("transmission error " << table << ", pressure " << pressure);
  BOOST_TEST(table < 1e-8);
  BOOST_TEST(pressure < 1e-8);
}

BOOST_AUTO_TEST_CASE(pairs_that_a_bending_rim_brings_into_contact_carry) {
  const Solver solver(thin_bolted_ring());
  double worst = 0;
  int added = 0;
  for (const int phase : {44, 45, 46, 47, 48}) {
    double before = 0;
    for (double load = 4e5; load < 1.1e6; load += 5e4) {
      ContactSystem::PairsCache cache;
      ContactSystem::WarmStart warm;
      const auto position = solver.system.solve(0, phase / 64.0, load, cache, warm, nullptr);
      BOOST_TEST(position.entry.lte > before, "phase " << phase << ", " << load << " N");
      before = position.entry.lte;
      added += !cache.setups.back()->added.empty();
      worst = std::max(worst, position.max_penetration / position.entry.lte);
    }
  }
  BOOST_TEST(added > 0);  // pairs that their gaps before loading left out
  BOOST_TEST(worst < 1e-10);
}

BOOST_AUTO_TEST_CASE(a_transmission_error_that_falls_with_the_load_is_a_defect) {
  LoadedMeshProblem problem = small_pinned_ring(0);
  std::vector<LoadedPosition> positions(problem.loads.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i].load = problem.loads[i];
    positions[i].entry.lte = 1e-6 * (1 + static_cast<double>(i));
    positions[i].entry.stiffness_secant = problem.loads[i] / positions[i].entry.lte;
  }
  BOOST_CHECK_NO_THROW(check_rise(problem, positions));
  auto skipped = positions;
  skipped[2].entry = {};  // left out of a comparison of levels
  BOOST_CHECK_NO_THROW(check_rise(problem, skipped));
  skipped[3].entry.lte = 0.9 * skipped[1].entry.lte;
  BOOST_CHECK_THROW(check_rise(problem, skipped), annulus::InternalError);
  positions[4].entry.lte = positions[3].entry.lte * (1 - 1e-2);
  BOOST_CHECK_THROW(check_rise(problem, positions), annulus::InternalError);
}

/// The outside-fixed ring of the ring paper as a plane or a solid.
annulus::fem::MeshBodies bodies_of(const LoadedMeshProblem& problem, annulus::fem::Fidelity fidelity) {
  annulus::fem::LoadedMeshSettings settings;
  settings.fidelity = fidelity;
  settings.degree = 1;
  return build_bodies(problem, annulus::fem::FlankContact(problem.pair), settings, 1);
}

// Omitted pairs are proved apart by this bound: nowhere on a flank may the material yield less.
BOOST_AUTO_TEST_CASE(least_displacements_bound_those_of_the_flank) {
  const auto problem = ring_mesh({}, 8);
  for (const auto fidelity : {annulus::fem::Fidelity::plane, annulus::fem::Fidelity::solid}) {
    const auto bodies = bodies_of(problem, fidelity);
    const auto& body = *bodies.wheel;
    const auto& flank = body.body().flank;
    const double base = problem.pair.wheel().base_radius();
    annulus::fem::FlankPatch patch;
    for (int i = 0; i < 5; ++i) {
      const double roll = flank.low() + (0.3 + 0.1 * i) * (flank.high() - flank.low());
      patch.loads.push_back(body.make_load(0, roll * roll / (2 * base), 1e-4));
      for (int slice = 0; slice < body.slices(); ++slice) patch.elements.push_back({i, slice});
    }
    body.find_weights(patch, 0);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> force(0, 1000);
    double tightest = 1;
    for (int trial = 0; trial < 20; ++trial) {
      Eigen::VectorXd forces(static_cast<Eigen::Index>(patch.elements.size()));
      for (auto& f : forces) f = force(random);
      for (const int at : {-2, -1, 0, 1, 2}) {
        const Eigen::VectorXd displacement = body.displacement(at, patch, 0, forces);
        const Eigen::VectorXd exact = body.least_by_slice(displacement),
                              bound = body.least_displacement(at, patch, 0, forces);
        const double size = displacement.cwiseAbs().maxCoeff();
        BOOST_TEST((exact - bound).minCoeff() >= -1e-12 * size, "tooth " << at);
        tightest = std::min(tightest, (exact - bound).maxCoeff() / size);
      }
    }
    // Of the size of the displacement it leaves a few per cent open: most pairs need no more.
    BOOST_TEST(tightest < 0.05);
  }
}

// Sixteen positions at once have the stresses of each alone.
BOOST_AUTO_TEST_CASE(stresses_of_many_positions_are_those_of_each) {
  for (const auto& problem : {ring_mesh({}, 8), small_pinned_ring(0.01)}) {
    const Solver solver(problem);
    std::vector<annulus::fem::ContactForces> forces;
    for (const double phase : {0.0, 0.3, 0.6, 0.9})
      for (const int cycle : {0, 1}) {
        ContactSystem::PairsCache cache;
        ContactSystem::WarmStart warm;
        (void)solver.system.solve(cycle, phase, problem.loads.front(), cache, warm, &forces.emplace_back());
      }
    using annulus::fem::StressRecovery;
    std::vector<StressRecovery::Forces> list;
    for (const auto& f : forces) list.push_back({&f.wheel, &f.supports});
    const auto together = solver.bodies.wheel_stress->largest(list);
    BOOST_REQUIRE(together.size() == forces.size());
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const auto alone = solver.bodies.wheel_stress->stresses(forces[i].wheel, forces[i].supports).largest;
      for (const auto value : {&annulus::fem::BodyStress::root_tension, &annulus::fem::BodyStress::root_compression,
                               &annulus::fem::BodyStress::root_von_mises, &annulus::fem::BodyStress::rim_von_mises})
        BOOST_TEST(std::abs(together[i].*value - alone.*value) <= 1e-9 * alone.root_von_mises);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
