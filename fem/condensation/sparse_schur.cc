#include "fem/condensation/sparse_schur.h"

#include <cholmod.h>
#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <mutex>
#include <numeric>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// CHOLMOD's workspace, started and finished with the object.
struct CholmodWorkspace {
  cholmod_common common{};
  CholmodWorkspace() {
    lapack::use_one_thread();
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
  }
  ~CholmodWorkspace() { cholmod_finish(&common); }
  CholmodWorkspace(const CholmodWorkspace&) = delete;
  CholmodWorkspace& operator=(const CholmodWorkspace&) = delete;
};

/// A factor and the workspace it belongs to.
struct CholmodFactor {
  CholmodWorkspace workspace;
  cholmod_factor* factor = nullptr;
  CholmodFactor() = default;
  ~CholmodFactor() { cholmod_free_factor(&factor, &workspace.common); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;
};

/// A view of the lower triangle for CHOLMOD; the arrays stay with the Eigen matrix.
cholmod_sparse lower_view(const Eigen::SparseMatrix<double>& lower) {
  return Eigen::viewAsCholmod(lower.selfadjointView<Eigen::Lower>());
}

/// L^-1 rhs
Eigen::MatrixXd solve_lower(cholmod_factor* factor, Eigen::MatrixXd& rhs, cholmod_common& common) {
  cholmod_dense view = Eigen::viewAsCholmod(rhs);
  cholmod_dense* solution = cholmod_solve(CHOLMOD_L, factor, &view, &common);
  if (solution == nullptr)
    throw SolverError(fmt::format(
        "out of memory while solving with the factorised stiffness of a sector: {} loads on {} DOFs need {:.3g} MB",
        rhs.cols(), rhs.rows(), static_cast<double>(rhs.size()) * sizeof(double) / 1e6));
  Eigen::MatrixXd result =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution->x), rhs.rows(), rhs.cols());
  cholmod_free_dense(&solution, &common);
  return result;
}

/// Forward solves L y = P b of loads a few at a time: y of the interior enters the compliance, y of the retained
/// DOFs times their own factor is the load that they see.
/// `rank`: number of a row of L among the retained ones in order of elimination, -1 inside.
void condense_loads(cholmod_factor* factor, const Eigen::MatrixXd& retained_factor, const std::vector<int>& rank,
                    const Eigen::SparseMatrix<double>& loads, int acting, cholmod_common& common,
                    SchurComplement& result) {
  constexpr int chunk = 64;
  const int n = static_cast<int>(factor->n), count = static_cast<int>(loads.cols());
  const auto* order = static_cast<const int*>(factor->Perm);
  std::vector<int> row_of(n);
  for (int row = 0; row < n; ++row) row_of[order[row]] = row;
  result.loads.resize(retained_factor.rows(), count);
  result.compliance.resize(count, acting);
  Eigen::MatrixXd acting_inside(n, acting);
  for (int first = 0, columns = 0; first < count; first += columns) {
    columns = std::min(first < acting ? acting - first : count - first, chunk);
    Eigen::MatrixXd permuted = Eigen::MatrixXd::Zero(n, columns);
    for (int c = 0; c < columns; ++c)
      for (Eigen::SparseMatrix<double>::InnerIterator it(loads, first + c); it; ++it)
        permuted(row_of[it.row()], c) = it.value();
    Eigen::MatrixXd y = solve_lower(factor, permuted, common);
    Eigen::MatrixXd retained(retained_factor.rows(), columns);
    for (int row = 0; row < n; ++row)
      if (rank[row] >= 0) {
        retained.row(rank[row]) = y.row(row);
        y.row(row).setZero();
      }
    result.loads.middleCols(first, columns) = lapack::product(retained_factor, retained);
    if (first < acting) {
      acting_inside.middleCols(first, columns) = y;
      const int until = first + columns;  // the acting ones so far; the rest by symmetry
      const Eigen::MatrixXd block = lapack::transpose_product(y, acting_inside.leftCols(until));
      result.compliance.block(first, 0, columns, until) = block;
      result.compliance.block(0, first, until, columns) = block.transpose();
    } else if (acting > 0) {
      result.compliance.middleRows(first, columns) = lapack::transpose_product(y, acting_inside);
    }
  }
}

/// The DOFs of a matrix, parted into retained and interior ones.
struct Partition {
  std::vector<int> retained, interior;                    ///< DOFs
  std::vector<int> number_among_retained, number_inside;  ///< of every DOF; -1 for the others
};

/// Throws InternalError when a DOF is retained twice.
Partition partition_of(int dofs, const std::vector<int>& retained) {
  Partition partition{retained, {}, std::vector<int>(dofs, -1), std::vector<int>(dofs, -1)};
  for (std::size_t k = 0; k < retained.size(); ++k) {
    require(partition.number_among_retained[retained[k]] < 0, "DOF ", retained[k], " is retained twice");
    partition.number_among_retained[retained[k]] = static_cast<int>(k);
  }
  partition.interior.reserve(dofs - retained.size());
  for (int i = 0; i < dofs; ++i)
    if (partition.number_among_retained[i] < 0) {
      partition.number_inside[i] = static_cast<int>(partition.interior.size());
      partition.interior.push_back(i);
    }
  return partition;
}

/// Lower triangle of the interior block.
Eigen::SparseMatrix<double> interior_block(const Eigen::SparseMatrix<double>& matrix, const Partition& partition) {
  const auto& inside = partition.number_inside;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(matrix.nonZeros()) / 2 + inside.size());
  for (int column = 0; column < matrix.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, column); it; ++it)
      if (it.row() >= column && inside[column] >= 0 && inside[it.row()] >= 0)
        entries.emplace_back(inside[it.row()], inside[column], it.value());
  const auto size = static_cast<int>(partition.interior.size());
  Eigen::SparseMatrix<double> block(size, size);
  block.setFromTriplets(entries.begin(), entries.end());
  return block;
}

/// Fill-reducing ordering of the interior, as numbers inside.
std::vector<int> interior_ordering(const Eigen::SparseMatrix<double>& matrix, const Partition& partition,
                                   cholmod_common& common) {
  std::vector<int> order(partition.interior.size());
  if (order.empty()) return order;
  Eigen::SparseMatrix<double> block = interior_block(matrix, partition);
  cholmod_sparse view = lower_view(block);
  // Nested dissection pays for itself in three dimensions and on large plane sectors. Rows of linear and quadratic
  // plane elements have 32 entries at most in the mean, those of linear hexahedra 38 at least, however few cells lie
  // across.
  constexpr int most_entries_in_the_plane = 35;
  const bool plane = matrix.nonZeros() < static_cast<Eigen::Index>(most_entries_in_the_plane) * matrix.rows();
  const std::size_t small = plane ? 60000 : 3000;
  if (order.size() <= small) {
    require(cholmod_amd(&view, nullptr, 0, order.data(), &common) != 0, "the fill-reducing ordering failed");
    return order;
  }
  // METIS seeds and draws from the C library's one random generator: side by side, two calls would disturb each
  // other's orderings and with them the last digits of the result.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  require(cholmod_metis(&view, nullptr, 0, 1, order.data(), &common) != 0, "the fill-reducing ordering failed");
  return order;
}

/// Factorises a matrix, its lower triangle given, with the retained DOFs eliminated after the interior.
void factorise_retained_last(CholmodFactor& cholesky, Eigen::SparseMatrix<double>& lower,
                             const std::vector<int>& interior_order, const Partition& partition) {
  std::vector<int> permutation;
  permutation.reserve(static_cast<std::size_t>(lower.rows()));
  for (const int i : interior_order) permutation.push_back(partition.interior[i]);
  permutation.insert(permutation.end(), partition.retained.begin(), partition.retained.end());
  auto& common = cholesky.workspace.common;
  cholmod_sparse view = lower_view(lower);
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  cholesky.factor = cholmod_analyze_p(&view, permutation.data(), nullptr, 0, &common);
  if (cholesky.factor != nullptr) cholmod_factorize(&view, cholesky.factor, &common);
  if (cholesky.factor == nullptr || common.status == CHOLMOD_OUT_OF_MEMORY)
    throw SolverError(fmt::format("out of memory while factorising the stiffness of a sector ({} DOFs)", lower.rows()));
  if (common.status == CHOLMOD_NOT_POSDEF || cholesky.factor->minor < cholesky.factor->n)
    throw SolverError(
        fmt::format("the stiffness of a sector ({} DOFs) is not positive definite: the body is not held, or a cell of "
                    "its mesh is inverted",
                    lower.rows()));
}

/// Numbers of the retained DOFs in the order of their elimination. CHOLMOD postorders the elimination tree: columns of
/// independent interior branches may stand between the retained ones, and where the interior falls into pieces the
/// retained DOFs change their own order.
struct EliminationRanks {
  std::vector<int> of_retained;  ///< by number among the retained ones
  std::vector<int> of_row;       ///< by row of the factor; -1 inside
};

EliminationRanks elimination_ranks(const cholmod_factor& factor, const Partition& partition) {
  const auto* order = static_cast<const int*>(factor.Perm);
  const int n = static_cast<int>(factor.n);
  EliminationRanks ranks{std::vector<int>(partition.retained.size()), std::vector<int>(n, -1)};
  int next = 0;
  for (int row = 0; row < n; ++row)
    if (const int number = partition.number_among_retained[order[row]]; number >= 0)
      ranks.of_retained[number] = ranks.of_row[row] = next++;
  return ranks;
}

/// The columns of the retained DOFs, read out of the supernodes: lower triangular, by rank.
Eigen::MatrixXd retained_factor(const cholmod_factor& factor, const EliminationRanks& ranks) {
  const auto kept = static_cast<Eigen::Index>(ranks.of_retained.size());
  Eigen::MatrixXd trailing = Eigen::MatrixXd::Zero(kept, kept);
  const auto* first_column = static_cast<const int*>(factor.super);
  const auto* row_start = static_cast<const int*>(factor.pi);
  const auto* value_start = static_cast<const int*>(factor.px);
  const auto* rows = static_cast<const int*>(factor.s);
  const auto* values = static_cast<const double*>(factor.x);
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const int height = row_start[s + 1] - row_start[s];
    for (int column = first_column[s]; column < first_column[s + 1]; ++column) {
      const int rank = ranks.of_row[column];
      if (rank < 0) continue;
      const int local = column - first_column[s];
      for (int r = local; r < height; ++r) {
        const int row_rank = ranks.of_row[rows[row_start[s] + r]];
        if (row_rank < rank)
          throw InternalError("internal error: a retained degree of freedom was not eliminated last");
        trailing(row_rank, rank) =
            values[static_cast<std::ptrdiff_t>(value_start[s]) + static_cast<std::ptrdiff_t>(local) * height + r];
      }
    }
  }
  return trailing;
}

/// From the order of elimination to the order in which the DOFs are retained.
void restore_order(const std::vector<int>& rank, SchurComplement& result) {
  if (std::is_sorted(rank.begin(), rank.end())) return;
  const auto kept = static_cast<int>(rank.size());
  const Eigen::MatrixXd matrix_by_rank = std::move(result.matrix), loads_by_rank = std::move(result.loads);
  result.matrix.resize(kept, kept);
  for (int j = 0; j < kept; ++j)
    for (int i = 0; i < kept; ++i) result.matrix(i, j) = matrix_by_rank(rank[i], rank[j]);
  result.loads.resize(kept, loads_by_rank.cols());
  for (int i = 0; i < kept && loads_by_rank.cols() > 0; ++i) result.loads.row(i) = loads_by_rank.row(rank[i]);
}

}  // namespace

SchurComplement schur_complement(const Eigen::SparseMatrix<double>& matrix, const std::vector<int>& retained,
                                 double shift_retained, const Eigen::SparseMatrix<double>& loads, int acting) {
  const Partition partition = partition_of(static_cast<int>(matrix.rows()), retained);
  CholmodFactor cholesky;
  auto& common = cholesky.workspace.common;
  const auto interior_order = interior_ordering(matrix, partition, common);
  Eigen::SparseMatrix<double> lower = matrix.triangularView<Eigen::Lower>();
  if (shift_retained > 0)
    for (const int i : retained) lower.coeffRef(i, i) += shift_retained;
  factorise_retained_last(cholesky, lower, interior_order, partition);

  const EliminationRanks ranks = elimination_ranks(*cholesky.factor, partition);
  Eigen::MatrixXd trailing = retained_factor(*cholesky.factor, ranks);
  SchurComplement result;
  if (loads.cols() > 0) condense_loads(cholesky.factor, trailing, ranks.of_row, loads, acting, common, result);
  cholmod_free_factor(&cholesky.factor, &common);  // the largest piece of memory, before the product
  trailing.transposeInPlace();
  result.matrix = lapack::gram(trailing);  // L L^T
  result.matrix.diagonal().array() -= shift_retained;
  restore_order(ranks.of_retained, result);
  return result;
}

}  // namespace annulus::fem
