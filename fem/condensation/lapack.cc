#include "fem/condensation/lapack.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <vector>

#include "core/errors.h"
#include "core/floating_point.h"

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void zpotrf_(const char* uplo, const int* n, std::complex<double>* a, const int* lda, int* info);
void zpotri_(const char* uplo, const int* n, std::complex<double>* a, const int* lda, int* info);
void dsyevr_(const char* job, const char* range, const char* uplo, const int* n, double* a, const int* lda,
             const double* vl, const double* vu, const int* il, const int* iu, const double* abstol, int* found,
             double* w, double* z, const int* ldz, int* isuppz, double* work, const int* lwork, int* iwork,
             const int* liwork, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n,
            const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void ztrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n,
            const std::complex<double>* alpha, const std::complex<double>* a, const int* lda, std::complex<double>* b,
            const int* ldb);
void dgemm_(const char* ta, const char* tb, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha, const double* a,
            const int* lda, const double* beta, double* c, const int* ldc);
}

namespace annulus::fem::lapack {
namespace {
int size(Eigen::Index n) { return static_cast<int>(n); }
int leading(Eigen::Index n) { return n > 0 ? static_cast<int>(n) : 1; }

template <class Matrix, class Potrf>
bool factorise(Matrix& matrix, const Potrf& potrf) {
  const int n = size(matrix.rows()), lda = leading(n);
  int info = 0;
  potrf("L", &n, matrix.data(), &lda, &info);
  return info == 0;
}

template <class Matrix, class Trsm>
void solve_in_place(const Matrix& factor, Matrix& rhs, const Trsm& trsm) {
  const int m = size(rhs.rows()), n = size(rhs.cols()), lda = leading(factor.rows()), ldb = leading(m);
  const typename Matrix::Scalar one = 1;
  if (m > 0 && n > 0) trsm("L", "L", "N", "N", &m, &n, &one, factor.data(), &lda, rhs.data(), &ldb);
}

}  // namespace

bool cholesky(Eigen::MatrixXd& matrix) { return factorise(matrix, dpotrf_); }
bool cholesky(Eigen::MatrixXcd& matrix) { return factorise(matrix, zpotrf_); }
void solve_lower(const Eigen::MatrixXd& factor, Eigen::MatrixXd& rhs) { solve_in_place(factor, rhs, dtrsm_); }
void solve_lower(const Eigen::MatrixXcd& factor, Eigen::MatrixXcd& rhs) { solve_in_place(factor, rhs, ztrsm_); }

void invert_from_cholesky(Eigen::MatrixXcd& factor) {
  const int n = size(factor.rows()), lda = leading(n);
  int info = 0;
  zpotri_("L", &n, factor.data(), &lda, &info);
  require(info == 0, "a factor has a zero in row ", info, " of its diagonal and no inverse");
  factor.triangularView<Eigen::StrictlyUpper>() = factor.adjoint();
}

Eigen::MatrixXd transpose_product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                  const Eigen::Ref<const Eigen::MatrixXd>& b) {
  require(a.rows() == b.rows(), "transpose_product of matrices with ", a.rows(), " and ", b.rows(), " rows");
  Eigen::MatrixXd c(a.cols(), b.cols());
  const int m = size(a.cols()), n = size(b.cols()), k = size(a.rows());
  const int lda = leading(size(a.outerStride())), ldb = leading(size(b.outerStride())), ldc = leading(m);
  const double one = 1, zero = 0;
  if (c.size() > 0) dgemm_("T", "N", &m, &n, &k, &one, a.data(), &lda, b.data(), &ldb, &zero, c.data(), &ldc);
  return c;
}

Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b) {
  require(a.cols() == b.rows(), "product over ", a.cols(), " and ", b.rows(), " values");
  Eigen::MatrixXd c(a.rows(), b.cols());
  const int m = size(a.rows()), n = size(b.cols()), k = size(a.cols());
  const int lda = leading(a.outerStride()), ldb = leading(b.outerStride()), ldc = leading(m);
  const double one = 1, zero = 0;
  if (c.size() > 0) dgemm_("N", "N", &m, &n, &k, &one, a.data(), &lda, b.data(), &ldb, &zero, c.data(), &ldc);
  return c;
}

void add_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& c) {
  require(a.cols() == b.rows() && c.rows() == a.rows() && c.cols() == b.cols(), "product of ", a.rows(), " x ",
          a.cols(), " and ", b.rows(), " x ", b.cols(), " into ", c.rows(), " x ", c.cols());
  const int m = size(a.rows()), n = size(b.cols()), k = size(a.cols());
  const int lda = leading(m), ldb = leading(k), ldc = leading(m);
  const double one = 1;
  if (c.size() > 0) dgemm_("N", "N", &m, &n, &k, &one, a.data(), &lda, b.data(), &ldb, &one, c.data(), &ldc);
}

Eigen::MatrixXd gram(const Eigen::MatrixXd& y) {
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(y.cols(), y.cols());
  const int n = size(y.cols()), k = size(y.rows()), lda = leading(k), ldc = leading(n);
  const double one = 1, zero = 0;
  if (n > 0) dsyrk_("L", "T", &n, &k, &one, y.data(), &lda, &zero, c.data(), &ldc);
  c.triangularView<Eigen::StrictlyUpper>() = c.transpose();
  return c;
}

std::pair<Eigen::VectorXd, Eigen::MatrixXd> largest_eigenpairs(Eigen::MatrixXd matrix, int count) {
  const int n = size(matrix.rows()), first = n - count + 1;
  require(matrix.cols() == n && count >= 1 && count <= n, count, " eigenpairs of a matrix of ", n, " rows and ",
          matrix.cols(), " columns");
  Eigen::VectorXd values(n);
  Eigen::MatrixXd vectors(n, count);
  std::vector<int> support(2 * static_cast<std::size_t>(count));
  const double unused = 0, tolerance = 0;
  int found = 0, info = 0, work_size = -1, integer_size = -1, integer_wanted = 0;
  double work_wanted = 0;
  const UntrappedFloatingPoint untrapped;  // dsyevr tries what infinity and "not a number" do on this machine
  const auto call = [&](double* work, int* integers) {
    dsyevr_("V", "I", "L", &n, matrix.data(), &n, &unused, &unused, &first, &n, &tolerance, &found, values.data(),
            vectors.data(), &n, support.data(), work, &work_size, integers, &integer_size, &info);
  };
  call(&work_wanted, &integer_wanted);  // asks for the sizes of the workspace
  work_size = static_cast<int>(work_wanted);
  integer_size = integer_wanted;
  std::vector<double> work(work_size);
  std::vector<int> integers(integer_size);
  call(work.data(), integers.data());
  if (info != 0 || found != count)
    throw SolverError(
        fmt::format("an eigenvalue problem of {} unknowns did not converge: {} of {} eigenvalues were found (LAPACK "
                    "dsyevr returned {})",
                    n, found, count, info));
  return {values.head(count).reverse(), vectors.rowwise().reverse()};
}

void use_one_thread() {
  // Resolved at run time so that any other BLAS, and a CHOLMOD without OpenMP, work as well.
  using Set = void (*)(int);
  const auto call = [](const char* name, int value) {
    if (auto* set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, name))) set(value);
  };
  call("openblas_set_num_threads", 1);
  // CHOLMOD asks for a number of threads fixed when it was compiled; OpenMP keeps this limit for every thread.
  call("omp_set_max_active_levels", 0);
}

}  // namespace annulus::fem::lapack
