#include "fem/condensation/sparse_schur.h"

#include <cholmod.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {

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

namespace {

/// A view of the lower triangle for CHOLMOD; the arrays stay with the Eigen matrix.
cholmod_sparse lower_view(Eigen::SparseMatrix<double>& lower) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(lower.rows());
  view.ncol = static_cast<std::size_t>(lower.cols());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = lower.outerIndexPtr();
  view.i = lower.innerIndexPtr();
  view.x = lower.valuePtr();
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

void check_factor(const CholmodWorkspace& workspace, const cholmod_factor* factor, const char* what) {
  if (factor == nullptr || workspace.common.status == CHOLMOD_OUT_OF_MEMORY)
    throw SolverError(std::string("out of memory while factorising the ") + what);
  if (workspace.common.status == CHOLMOD_NOT_POSDEF || factor->minor < factor->n)
    throw SolverError(std::string("the ") + what +
                      " is not positive definite: the body is not held, or a cell of its mesh is inverted");
}

cholmod_dense dense_view(const Eigen::MatrixXd& matrix) {
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = view.nrow * view.ncol;
  view.d = view.nrow;
  view.x = const_cast<double*>(matrix.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

/// One of CHOLMOD's solves with a factor.
Eigen::MatrixXd solve_with(cholmod_factor* factor, int system, const Eigen::MatrixXd& rhs, cholmod_common& common) {
  cholmod_dense view = dense_view(rhs);
  cholmod_dense* solution = cholmod_solve(system, factor, &view, &common);
  if (solution == nullptr) throw SolverError("out of memory while solving with the factorised stiffness matrix");
  Eigen::MatrixXd result =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution->x), rhs.rows(), rhs.cols());
  cholmod_free_dense(&solution, &common);
  return result;
}

/// Forward solves L y = P b of loads a few at a time: y of the interior enters the compliance, y of the retained
/// DOFs times their own factor is the load that they see.
/// `rank`: place of a row of L among the retained ones in order of elimination, -1 inside.
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
    Eigen::MatrixXd y = solve_with(factor, CHOLMOD_L, permuted, common);
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

}  // namespace

struct SparseCholesky::Impl {
  CholmodWorkspace workspace;
  cholmod_factor* factor = nullptr;
  ~Impl() { cholmod_free_factor(&factor, &workspace.common); }
};

SparseCholesky::SparseCholesky(const Eigen::SparseMatrix<double>& matrix) : impl_(std::make_unique<Impl>()) {
  Eigen::SparseMatrix<double> lower = matrix.triangularView<Eigen::Lower>();
  cholmod_sparse view = lower_view(lower);
  impl_->factor = cholmod_analyze(&view, &impl_->workspace.common);
  if (impl_->factor != nullptr) cholmod_factorize(&view, impl_->factor, &impl_->workspace.common);
  check_factor(impl_->workspace, impl_->factor, "stiffness matrix");
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& right_hand_sides) const {
  require(right_hand_sides.rows() == static_cast<Eigen::Index>(impl_->factor->n), "right-hand side of the wrong size");
  return solve_with(impl_->factor, CHOLMOD_A, right_hand_sides, impl_->workspace.common);
}

SchurComplement schur_complement(const Eigen::SparseMatrix<double>& matrix, const std::vector<int>& retained,
                                 double shift_retained, const Eigen::SparseMatrix<double>& loads, int acting) {
  const int n = static_cast<int>(matrix.rows()), kept = static_cast<int>(retained.size());
  std::vector<int> position(n, -1);  // place of a DOF among the retained ones
  for (int k = 0; k < kept; ++k) {
    require(position[retained[k]] < 0, "a degree of freedom is retained twice");
    position[retained[k]] = k;
  }
  std::vector<int> interior;
  interior.reserve(n - kept);
  std::vector<int> place_inside(n, -1);
  for (int i = 0; i < n; ++i)
    if (position[i] < 0) {
      place_inside[i] = static_cast<int>(interior.size());
      interior.push_back(i);
    }

  CholmodWorkspace workspace;
  auto& common = workspace.common;

  // A fill-reducing ordering of the interior alone, the retained DOFs appended.
  std::vector<Eigen::Triplet<double>> inside;
  inside.reserve(static_cast<std::size_t>(matrix.nonZeros()) / 2 + n);
  for (int column = 0; column < n; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, column); it; ++it)
      if (it.row() >= column && place_inside[column] >= 0 && place_inside[it.row()] >= 0)
        inside.emplace_back(place_inside[it.row()], place_inside[column], it.value());
  Eigen::SparseMatrix<double> interior_matrix(static_cast<int>(interior.size()), static_cast<int>(interior.size()));
  interior_matrix.setFromTriplets(inside.begin(), inside.end());
  inside = {};
  cholmod_sparse interior_view = lower_view(interior_matrix);
  std::vector<int> interior_order(interior.size());
  // Nested dissection pays for itself in three dimensions and on large plane sectors. Rows of linear and quadratic
  // plane elements have 32 entries at most in the mean, those of linear hexahedra 38 at least, however few cells lie
  // across.
  constexpr int most_entries_in_the_plane = 35;
  const std::size_t small = matrix.nonZeros() < static_cast<Eigen::Index>(most_entries_in_the_plane) * n ? 60000 : 3000;
  const bool ordered = [&] {
    if (interior.empty()) return true;
    if (interior.size() <= small) return cholmod_amd(&interior_view, nullptr, 0, interior_order.data(), &common) != 0;
    // METIS seeds and draws from the C library's one random generator: side by side, two calls would disturb each
    // other's orderings and with them the last digits of the result.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    return cholmod_metis(&interior_view, nullptr, 0, 1, interior_order.data(), &common) != 0;
  }();
  require(ordered, "the fill-reducing ordering failed");
  std::vector<int> permutation;
  permutation.reserve(n);
  for (const int i : interior_order) permutation.push_back(interior[i]);
  permutation.insert(permutation.end(), retained.begin(), retained.end());

  Eigen::SparseMatrix<double> lower = matrix.triangularView<Eigen::Lower>();
  if (shift_retained > 0)
    for (const int i : retained) lower.coeffRef(i, i) += shift_retained;
  cholmod_sparse view = lower_view(lower);
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  cholmod_factor* factor = cholmod_analyze_p(&view, permutation.data(), nullptr, 0, &common);
  if (factor != nullptr) cholmod_factorize(&view, factor, &common);
  check_factor(workspace, factor, "stiffness matrix of the sector");

  // Read the columns of the retained DOFs out of the supernodes. CHOLMOD postorders the elimination tree: columns
  // of independent interior branches may stand between the retained ones, and where the interior falls into pieces the
  // retained DOFs change their own order.
  const auto* order = static_cast<const int*>(factor->Perm);
  std::vector<int> rank(kept), rank_of_row(n, -1);
  int ranks = 0;
  for (int column = 0; column < n; ++column)
    if (position[order[column]] >= 0) rank[position[order[column]]] = rank_of_row[column] = ranks++;
  Eigen::MatrixXd trailing = Eigen::MatrixXd::Zero(kept, kept);
  const auto* first_column = static_cast<const int*>(factor->super);
  const auto* row_start = static_cast<const int*>(factor->pi);
  const auto* value_start = static_cast<const int*>(factor->px);
  const auto* rows = static_cast<const int*>(factor->s);
  const auto* values = static_cast<const double*>(factor->x);
  for (std::size_t s = 0; s < factor->nsuper; ++s) {
    const int height = row_start[s + 1] - row_start[s];
    for (int column = first_column[s]; column < first_column[s + 1]; ++column) {
      if (position[order[column]] < 0) continue;
      const int k = rank[position[order[column]]];
      const int local = column - first_column[s];
      for (int r = local; r < height; ++r) {
        const int retained_row = position[order[rows[row_start[s] + r]]];
        require(retained_row >= 0 && rank[retained_row] >= k,
                "the retained degrees of freedom were not eliminated last");
        trailing(rank[retained_row], k) =
            values[static_cast<std::ptrdiff_t>(value_start[s]) + static_cast<std::ptrdiff_t>(local) * height + r];
      }
    }
  }
  SchurComplement result;
  if (loads.cols() > 0) condense_loads(factor, trailing, rank_of_row, loads, acting, common, result);
  cholmod_free_factor(&factor, &common);
  trailing.transposeInPlace();
  result.matrix = lapack::gram(trailing);  // L L^T
  result.matrix.diagonal().array() -= shift_retained;
  if (std::is_sorted(rank.begin(), rank.end())) return result;
  const Eigen::MatrixXd matrix_by_rank = std::move(result.matrix), loads_by_rank = std::move(result.loads);
  result.matrix.resize(kept, kept);
  for (int j = 0; j < kept; ++j)
    for (int i = 0; i < kept; ++i) result.matrix(i, j) = matrix_by_rank(rank[i], rank[j]);
  result.loads.resize(kept, loads_by_rank.cols());
  for (int i = 0; i < kept && loads_by_rank.cols() > 0; ++i) result.loads.row(i) = loads_by_rank.row(rank[i]);
  return result;
}

}  // namespace annulus::fem
