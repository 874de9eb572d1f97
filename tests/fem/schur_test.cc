#include "fem/condensation/sparse_schur.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "core/errors.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(sparse_factors)

using annulus::fem::schur_complement;

/// Eigen's own factorisation.
using Reference = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// Springs between the neighbours of an n x n grid, of random stiffness, and `ground` from every node to the ground.
Eigen::SparseMatrix<double> spring_net(int n, double ground) {
  std::mt19937 random(3);
  std::vector<Eigen::Triplet<double>> entries;
  const auto spring = [&](int a, int b) {
    const double k = 0.5 + static_cast<double>(random()) / std::mt19937::max();
    entries.emplace_back(a, a, k);
    entries.emplace_back(b, b, k);
    entries.emplace_back(a, b, -k);
    entries.emplace_back(b, a, -k);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      entries.emplace_back(i * n + j, i * n + j, ground);
      if (i + 1 < n) spring(i * n + j, (i + 1) * n + j);
      if (j + 1 < n) spring(i * n + j, i * n + j + 1);
    }
  Eigen::SparseMatrix<double> matrix(n * n, n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<int> some_nodes(int n, int count) {
  std::vector<int> nodes(n);
  std::iota(nodes.begin(), nodes.end(), 0);
  std::mt19937 random(5);
  for (int i = n - 1; i > 0; --i) std::swap(nodes[i], nodes[random() % (i + 1)]);
  nodes.resize(count);
  return nodes;  // in no order
}

Eigen::MatrixXd dense_complement(const Eigen::MatrixXd& k, const std::vector<int>& retained) {
  std::vector<int> inner;
  for (int i = 0; i < k.rows(); ++i)
    if (std::find(retained.begin(), retained.end(), i) == retained.end()) inner.push_back(i);
  const auto pick = [&](const std::vector<int>& rows, const std::vector<int>& columns) {
    Eigen::MatrixXd m(rows.size(), columns.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < columns.size(); ++j) m(i, j) = k(rows[i], columns[j]);
    return m;
  };
  return pick(retained, retained) - pick(retained, inner) * pick(inner, inner).llt().solve(pick(inner, retained));
}

// Entries of order one, condition numbers below 1e3: some digits above 2e-16.
constexpr double round_off = 1e-12;

BOOST_AUTO_TEST_CASE(schur_complement_equals_the_dense_one_in_the_order_asked_for) {
  annulus::test::Verification record("Schur complement of a net of springs", "dense elimination (Eigen)");
  const auto matrix = spring_net(12, 0.1);
  for (const int kept : {1, 7, 40, 144}) {
    const auto retained = some_nodes(144, kept);
    const Eigen::MatrixXd expected = dense_complement(matrix, retained);
    record.at_most("largest error of an entry (of order one)", "",
                   (schur_complement(matrix, retained).matrix - expected).cwiseAbs().maxCoeff(), round_off,
                   "rounding x condition number below 1e3");
    // A shift is taken off again.
    BOOST_TEST((schur_complement(matrix, retained, 2.0).matrix - expected).cwiseAbs().maxCoeff() < round_off);
  }
}

BOOST_AUTO_TEST_CASE(a_singular_complement_needs_and_survives_the_shift) {
  const auto matrix = spring_net(12, 0);  // all nodes may move together
  const auto retained = some_nodes(144, 20);
  const Eigen::MatrixXd shifted = schur_complement(matrix, retained, 1.5).matrix;
  BOOST_TEST((shifted - dense_complement(matrix, retained)).cwiseAbs().maxCoeff() < round_off);
  BOOST_TEST((shifted * Eigen::VectorXd::Ones(20)).cwiseAbs().maxCoeff() < round_off);
}

BOOST_AUTO_TEST_CASE(large_matrices_take_the_nested_dissection_and_agree) {
  const auto matrix = spring_net(64, 0.1);  // 4096 - 30 > 3000 inner DOFs
  const auto retained = some_nodes(64 * 64, 30);
  const Eigen::MatrixXd complement = schur_complement(matrix, retained).matrix;
  // (K^-1)_rr = S^-1
  const Reference reference(matrix);
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(64 * 64, 30);
  for (int i = 0; i < 30; ++i) unit(retained[i], i) = 1;
  const Eigen::MatrixXd inverse = unit.transpose() * reference.solve(unit);
  BOOST_TEST((complement * inverse - Eigen::MatrixXd::Identity(30, 30)).cwiseAbs().maxCoeff() < 1e-11);
}

BOOST_AUTO_TEST_CASE(loads_are_condensed_as_by_dense_elimination) {
  std::mt19937 random(17);
  for (const int n : {12, 64}) {  // both orderings
    const auto matrix = spring_net(n, 0.1);
    const auto retained = some_nodes(n * n, 30);
    constexpr int count = 150, acting = 70;  // more than one chunk of either kind
    std::vector<Eigen::Triplet<double>> entries;
    for (int load = 0; load < count; ++load)
      for (int k = 0; k < 3; ++k)
        entries.emplace_back(static_cast<int>(random() % (n * n)), load, 1.0 * random() / std::mt19937::max());
    entries.emplace_back(retained[3], 5, 1.0);
    Eigen::SparseMatrix<double> loads(n * n, count);
    loads.setFromTriplets(entries.begin(), entries.end());
    for (const double shift : {0.0, 1.5}) {
      const auto result = schur_complement(matrix, retained, shift, loads, acting);
      // Free loads: b_r^T S^-1 b_r and the part with the retained DOFs held make b^T K^-1 b.
      const Eigen::MatrixXd dense = loads;
      const Eigen::MatrixXd exact = dense.transpose() * Reference(matrix).solve(dense).leftCols(acting);
      const Eigen::MatrixXd moved = result.loads.transpose() * result.matrix.llt().solve(result.loads.leftCols(acting));
      BOOST_TEST((result.compliance + moved - exact).cwiseAbs().maxCoeff() < round_off * exact.cwiseAbs().maxCoeff());
    }
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_condensed_is_refused) {
  auto matrix = spring_net(5, 0.1);
  BOOST_CHECK_THROW((void)schur_complement(matrix, {3, 4, 3}), annulus::InternalError);
  BOOST_CHECK_THROW((void)schur_complement(spring_net(5, -1), {3, 4}), annulus::SolverError);
}

BOOST_AUTO_TEST_SUITE_END()
