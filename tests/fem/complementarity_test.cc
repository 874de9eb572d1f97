#include "fem/contact/complementarity.h"

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/errors.h"

BOOST_AUTO_TEST_SUITE(complementarity)

using annulus::fem::ComplementarityProblem;
using annulus::fem::solve_complementarity;

constexpr double round_off = 1e-12;  // condition numbers below 1e4 times 2e-16

/// Springs of compliance c_i behind gaps g_i, all pressed by one rigid body with the force `load`.
ComplementarityProblem springs(const Eigen::VectorXd& compliance, const Eigen::VectorXd& gap, double load) {
  ComplementarityProblem p;
  p.compliance = compliance.asDiagonal();
  p.gap = gap;
  p.rigid = Eigen::MatrixXd::Ones(gap.size(), 1);
  p.load = Eigen::VectorXd::Constant(1, load);
  p.unilateral.assign(gap.size(), true);
  return p;
}

BOOST_AUTO_TEST_CASE(two_springs_against_a_wall) {
  const Eigen::Vector2d c(0.5, 0.25), g(0, 0.3);
  // Light: the near spring alone, lambda = c1 F until the second gap closes at F = 0.6.
  const auto light = solve_complementarity(springs(c, g, 0.5), {});
  BOOST_TEST(light.force[0] == 0.5, boost::test_tools::tolerance(round_off));
  BOOST_TEST(light.force[1] == 0.0);
  BOOST_TEST(light.rigid[0] == 0.25, boost::test_tools::tolerance(round_off));
  BOOST_TEST(light.gap[1] == 0.05, boost::test_tools::tolerance(round_off));
  BOOST_TEST(light.tangent(0, 0) == 0.5, boost::test_tools::tolerance(round_off));
  BOOST_TEST((light.active == std::vector<bool>{true, false}));
  // Heavy: lambda / c1 + (lambda - g2) / c2 = F, lambda = (2 + 1.2) / 6.
  const auto heavy = solve_complementarity(springs(c, g, 2), {});
  BOOST_TEST(heavy.rigid[0] == 3.2 / 6, boost::test_tools::tolerance(round_off));
  BOOST_TEST(heavy.force[0] == 3.2 / 3, boost::test_tools::tolerance(round_off));
  BOOST_TEST(heavy.force[1] == 2 - 3.2 / 3, boost::test_tools::tolerance(round_off));
  BOOST_TEST(heavy.tangent(0, 0) == 1.0 / 6, boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(the_tangent_is_the_derivative_of_the_rigid_motion) {
  const Eigen::Vector3d c(0.5, 0.25, 0.1), g(0, 0.3, 5);
  const double load = 2, step = 1e-3;
  const auto at = [&](double f) { return solve_complementarity(springs(c, g, f), {}).rigid[0]; };
  const double difference = (at(load + step) - at(load - step)) / (2 * step);
  // Linear between changes of the set: the difference quotient is exact up to round-off / step.
  BOOST_TEST(solve_complementarity(springs(c, g, load), {}).tangent(0, 0) == difference,
             boost::test_tools::tolerance(1e-11));
}

BOOST_AUTO_TEST_CASE(all_of_a_near_contact_and_nothing_of_a_far_one_is_active) {
  const int n = 20;
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(n, 1, 2);
  const auto near = solve_complementarity(springs(c, Eigen::VectorXd::Zero(n), 3), std::vector<bool>(n, false));
  BOOST_TEST((near.active == std::vector<bool>(n, true)));
  const double stiffness = c.cwiseInverse().sum();
  for (int i = 0; i < n; ++i)
    BOOST_TEST(near.force[i] == 3 / stiffness / c[i], boost::test_tools::tolerance(round_off));

  Eigen::VectorXd far = Eigen::VectorXd::Constant(n, 1e3);
  far[4] = 0;
  const auto single = solve_complementarity(springs(c, far, 3), std::vector<bool>(n, true));
  for (int i = 0; i < n; ++i) BOOST_TEST(single.active[i] == (i == 4));
  BOOST_TEST(single.force[4] == 3.0, boost::test_tools::tolerance(round_off));
  BOOST_TEST(single.gap[5] == 1e3 - 3 * c[4], boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(bilateral_contacts_pull) {
  // A rigid bar on two springs at x = 0 and x = 1, force 1 at x = 2: reactions -1 and 2.
  ComplementarityProblem p;
  p.compliance = Eigen::Vector2d(0.1, 0.2).asDiagonal();
  p.gap = Eigen::Vector2d::Zero();
  p.rigid.resize(2, 2);
  p.rigid << 1, 0, 1, 1;
  p.load = Eigen::Vector2d(1, 2);
  p.unilateral = {false, false};
  const auto held = solve_complementarity(p, {});
  BOOST_TEST(held.force[0] == -1.0, boost::test_tools::tolerance(round_off));
  BOOST_TEST(held.force[1] == 2.0, boost::test_tools::tolerance(round_off));
  BOOST_TEST(held.rigid[0] == -0.1, boost::test_tools::tolerance(round_off));
  // The same bar may lift off at x = 0: nothing balances the moment.
  p.unilateral = {true, true};
  BOOST_CHECK_THROW((void)solve_complementarity(p, {}), annulus::SolverError);
}

/// A random problem: elastic body with coupled contacts, one or two rigid motions, some contacts bilateral.
ComplementarityProblem random_problem(unsigned seed, int n, int rigid) {
  std::mt19937 random(seed);
  const auto number = [&] { return 2.0 * random() / std::mt19937::max() - 1; };
  ComplementarityProblem p;
  const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(n, n, number);
  p.compliance = half * half.transpose() / n + 0.05 * Eigen::MatrixXd::Identity(n, n);
  p.gap = Eigen::VectorXd::NullaryExpr(n, [&] { return std::abs(number()); });
  p.rigid = Eigen::MatrixXd::Ones(n, rigid);
  for (int i = 0; i < n; ++i)
    for (int r = 1; r < rigid; ++r) p.rigid(i, r) = number();
  // A load that all contacts pressed equally would carry, so that a solution exists.
  p.load = p.rigid.transpose() * Eigen::VectorXd::Constant(n, 2.0 / n);
  for (int i = 0; i < n; ++i) p.unilateral.push_back(i % 7 != 3);
  return p;
}

BOOST_AUTO_TEST_CASE(random_problems_satisfy_the_optimality_conditions) {
  int open = 0, closed = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const int n = 5 + static_cast<int>(seed), rigid = 1 + static_cast<int>(seed % 3);
    const auto p = random_problem(seed, n, rigid);
    const auto s = solve_complementarity(p, {});
    const Eigen::VectorXd w = p.compliance * s.force + p.gap - p.rigid * s.rigid;
    const double size = std::max(1.0, s.rigid.cwiseAbs().maxCoeff());
    BOOST_TEST((w - s.gap).cwiseAbs().maxCoeff() < round_off * size);
    BOOST_TEST((p.rigid.transpose() * s.force - p.load).cwiseAbs().maxCoeff() < round_off * size);
    for (int i = 0; i < n; ++i) {
      if (!p.unilateral[i]) {
        BOOST_TEST(std::abs(w[i]) < round_off * size);
        continue;
      }
      BOOST_TEST(s.force[i] >= -round_off);
      BOOST_TEST(w[i] >= -round_off * size);
      BOOST_TEST(std::min(s.force[i], w[i]) < round_off * size);
      ++(s.active[i] ? closed : open);
    }
  }
  BOOST_TEST(open > 100);  // the sample has both kinds
  BOOST_TEST(closed > 100);
}

BOOST_AUTO_TEST_CASE(the_solution_does_not_depend_on_the_start) {
  std::mt19937 random(7);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto p = random_problem(100 + seed, 30, 2);
    const auto reference = solve_complementarity(p, {});
    for (int trial = 0; trial < 6; ++trial) {
      std::vector<bool> start(30, trial == 0);
      if (trial > 1)
        for (int i = 0; i < 30; ++i) start[i] = random() % 2 == 0;
      const auto s = solve_complementarity(p, start);
      BOOST_TEST((s.active == reference.active));
      // The same set is solved by the same operations: no difference at all.
      BOOST_TEST((s.force - reference.force).cwiseAbs().maxCoeff() == 0.0);
    }
  }
}

BOOST_AUTO_TEST_CASE(loads_that_cannot_be_carried_are_solver_errors) {
  const Eigen::Vector2d c(1, 1), g(0, 0.1);
  BOOST_CHECK_THROW((void)solve_complementarity(springs(c, g, -1), {}), annulus::SolverError);  // pulls
  auto loose = springs(c, g, 1);
  loose.rigid.conservativeResize(2, 2);
  loose.rigid.col(1) << 1, 1;  // two rigid motions that the contacts cannot tell apart
  loose.load = Eigen::Vector2d(1, 0.5);
  BOOST_CHECK_THROW((void)solve_complementarity(loose, {}), annulus::SolverError);
  auto indefinite = springs(c, g, 1);
  indefinite.compliance(0, 0) = -1;
  BOOST_CHECK_THROW((void)solve_complementarity(indefinite, {}), annulus::SolverError);
}

BOOST_AUTO_TEST_SUITE_END()
