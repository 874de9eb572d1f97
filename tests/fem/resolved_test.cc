#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "core/errors.h"
#include "fem/body/gear_body.h"
#include "fem/body/resolution.h"
#include "fem/condensation/altered_ring.h"
#include "ring_paper.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Teeth with meshes of their own in a condensed gear, and the model that is made of them.
BOOST_AUTO_TEST_SUITE(resolved)

using namespace annulus::tests;
using annulus::fem::AlteredRing;
using annulus::fem::CondensedSector;
using annulus::fem::CondensedTooth;

/// A tooth of the ring paper's ring, its flank refined around a fraction of its length.
CondensedTooth tooth(double fraction) {
  const auto pair = ring_paper_pair(true);
  const annulus::geometry::ToothProfile profile(pair.wheel());
  auto section = annulus::fem::plane_resolution(pair.wheel(), 0).section;
  if (fraction >= 0) section.flank_fractions = {0, 0.5 * fraction, fraction, 0.5 * (1 + fraction), 1};
  annulus::fem::GearBodyOptions options;
  options.sector.flank = annulus::geometry::Boundary::trailing_flank;
  return condense_tooth(make_sector_mesh(pair.wheel(), {ring_outside, {}}, section), profile, ring_outside, {},
                        options);
}

/// Compliance of the replaced sectors' ports from the assembled stiffness of all cuts of the ring: nothing cyclic in
/// it.
Eigen::MatrixXd assembled(const CondensedSector& regular, int sectors,
                          const std::vector<const CondensedSector*>& replaced) {
  const Eigen::Index m = regular.interface_stiffness.rows() / 2;
  Eigen::Index ports = 0;
  for (const auto* s : replaced) ports += s->interface_load.cols();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(sectors * m, sectors * m);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(sectors * m, ports), result = Eigen::MatrixXd::Zero(ports, ports);
  Eigen::Index at = 0;
  for (int i = 0; i < sectors; ++i) {
    const bool changed = i < static_cast<int>(replaced.size());
    const CondensedSector& s = changed ? *replaced[i] : regular;
    // Both cuts in the global frame.
    Eigen::MatrixXd turn = Eigen::MatrixXd::Zero(2 * m, 2 * m);
    for (Eigen::Index n = 0; n < 2 * m; n += 2)
      turn.block(n, n, 2, 2) = Eigen::Rotation2Dd(i * regular.pitch_angle).toRotationMatrix();
    const Eigen::MatrixXd k = turn * s.interface_stiffness * turn.transpose(), l = turn * s.interface_load;
    const Eigen::Index low = i * m, high = ((i + 1) % sectors) * m;
    stiffness.block(low, low, m, m) += k.topLeftCorner(m, m);
    stiffness.block(high, high, m, m) += k.bottomRightCorner(m, m);
    stiffness.block(low, high, m, m) += k.topRightCorner(m, m);
    stiffness.block(high, low, m, m) += k.bottomLeftCorner(m, m);
    if (!changed) continue;
    loads.block(low, at, m, l.cols()) += l.topRows(m);
    loads.block(high, at, m, l.cols()) += l.bottomRows(m);
    result.block(at, at, l.cols(), l.cols()) = s.compliance;
    at += l.cols();
  }
  return result + loads.transpose() * stiffness.llt().solve(loads);
}

BOOST_AUTO_TEST_CASE(replaced_teeth_are_exact) {
  annulus::test::Verification record("Teeth of other meshes in a condensed ring",
                                     "the assembled stiffness of all cuts of the ring, solved directly");
  const CondensedTooth regular = tooth(-1), other = tooth(0.3), third = tooth(0.8);
  const int sectors = 162;
  const AlteredRing ring(regular.sector, sectors, 3, 1);
  for (const auto& replaced : {std::vector{&other.sector}, {&other.sector, &regular.sector, &third.sector}}) {
    const Eigen::MatrixXd exact = assembled(regular.sector, sectors, replaced), found = ring.compliance(replaced);
    // Round-off of systems with a condition number of some 1e6.
    record.at_most("compliance, error over its largest entry", "",
                   (found - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff(), 1e-9,
                   "rounding x condition number of some 1e6");
  }
}

BOOST_AUTO_TEST_CASE(a_tooth_replaced_by_its_like_changes_nothing) {
  annulus::test::Verification record("A ring in which teeth are replaced by their like",
                                     "the ring composed of equal teeth by harmonics");
  const CondensedTooth regular = tooth(-1);
  const AlteredRing ring(regular.sector, 162, 3, 1);
  const auto composed = compose_ring(regular.sector, 162, {3, false}, annulus::fem::SectorSupport::held, 1);
  const Eigen::MatrixXd two = ring.compliance({&regular.sector, &regular.sector});
  const Eigen::Index ports = regular.sector.ports;
  const double whole = composed.block(0).norm();
  record.at_most("compliance of a tooth, relative difference", "",
                 (two.topLeftCorner(ports, ports) - composed.block(0)).norm() / whole, 1e-11, "rounding");
  record.at_most("compliance between neighbours, relative difference", "",
                 (two.bottomLeftCorner(ports, ports) - composed.block(1)).norm() / whole, 1e-11, "rounding");
}

annulus::fem::LoadedMeshResult solve_resolved_plane(const annulus::fem::LoadedMeshProblem& problem) {
  annulus::fem::LoadedMeshSettings settings;
  settings.fidelity = annulus::fem::Fidelity::resolved_plane;
  settings.level = 1;
  settings.threads = 2;
  return solve_loaded_mesh(problem, settings);
}

BOOST_AUTO_TEST_CASE(the_resolved_fidelity_agrees_with_the_plane_one_within_their_estimates) {
  annulus::test::Verification record("Resolved contact against condensed flanks, nominal load",
                                     "meshes of their own around every contact, refined until the estimate is small");
  // Nominal load: positions with two pairs in contact, and one where a pair bears at a tip edge.
  for (const auto& problem : {ring_mesh(annulus::fem::OutsideHeld{}, 2), sun_mesh(2)}) {
    const auto plane = solve_plane(problem, 2);
    const auto truth = solve_resolved_plane(problem);
    for (int phase = 0; phase < 2; ++phase) {
      const auto &a = plane.table.at(0, phase, 0), &b = truth.table.at(0, phase, 0);
      const double difference = std::abs(a.stiffness_secant / b.stiffness_secant - 1);
      BOOST_TEST_MESSAGE(problem.pair.internal() << " phase " << phase << ": plane - resolved " << difference
                                                 << ", estimates " << numeric_error(a) << " and " << numeric_error(b));
      record.at_most("difference of the stiffness over the sum of both stated errors", "",
                     difference / (numeric_error(a) + numeric_error(b)), 1, "their stated errors");
      BOOST_TEST(numeric_error(b) < 0.015);
    }
    BOOST_TEST(truth.closure_relative < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(light_and_heavy_loads_all_along_the_mesh_cycle) {
  // Every load has meshes of its own. Among the positions are contacts cut short by a tip edge at any distance: with
  // two times the load, that of pair 1 at phase 5/8 reaches 0.16 half-widths beyond its centre.
  annulus::test::Verification record("Resolved contact against condensed flanks, a quarter and twice the load",
                                     "meshes of their own around every contact, refined until the estimate is small");
  const std::vector<double> loads = {0.25 * nominal_load, 2 * nominal_load};
  for (const auto& problem : {ring_mesh(annulus::fem::OutsideHeld{}, 8, loads), sun_mesh(3, loads)}) {
    const auto plane = solve_plane(problem, 3);
    const auto truth = solve_resolved_plane(problem);
    check_invariants(truth);
    double worst = 0, shares = 0;
    bool edge = false;
    for (std::size_t i = 0; i < truth.positions.size(); ++i) {
      const auto &a = plane.positions[i], &b = truth.positions[i];
      const double difference = std::abs(a.entry.stiffness_secant / b.entry.stiffness_secant - 1);
      record.at_most("difference of the stiffness over the sum of both stated errors", "",
                     difference / (numeric_error(a.entry) + numeric_error(b.entry)), 1, "their stated errors");
      BOOST_TEST(numeric_error(b.entry) < 0.003);
      worst = std::max(worst, difference);
      edge = edge || b.tip_edge_contact;
      // Pairs by their theoretical contact: either result may leave out one that two tips barely reach.
      for (std::size_t k = 0; k < a.pair_roll.size(); ++k)
        for (std::size_t l = 0; l < b.pair_roll.size(); ++l)
          if (a.pair_roll[k] == b.pair_roll[l]) shares = std::max(shares, std::abs(a.pair_share[k] - b.pair_share[l]));
    }
    BOOST_TEST_MESSAGE(problem.pair.internal() << ": plane - resolved " << worst << ", load shares " << shares);
    record.at_most("load shares of the pairs, largest difference", "", shares, 0.002, "error of the stiffness");
    BOOST_TEST(edge);
  }
}

BOOST_AUTO_TEST_CASE(what_is_not_resolved_is_refused) {
  annulus::fem::LoadedMeshSettings settings;
  settings.fidelity = annulus::fem::Fidelity::resolved_plane;
  settings.level = 1;
  BOOST_CHECK_THROW((void)solve_loaded_mesh(ring_mesh(paper_pins(24, 0), 2), settings), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
