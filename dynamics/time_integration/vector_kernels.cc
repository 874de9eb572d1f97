#include "dynamics/time_integration/vector_kernels.h"

#include <nvector/nvector_serial.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace annulus::dynamics {

namespace {

constexpr int most_terms = 14;  // stages of the largest explicit method, and the state

/// z = sum of c_j x_j. z may be one of the x: every entry is read before it is written.
template <int Terms>
void combine(std::ptrdiff_t n, const double* c, const double* const* x, double* z) {
  using Block = Eigen::Array<double, 4, 1>;  // so that the sums stay in registers
  const auto block = [](const double* p) { return Eigen::Map<const Block>(p); };
  std::ptrdiff_t i = 0;
  for (; i + Block::SizeAtCompileTime <= n; i += Block::SizeAtCompileTime) {
    Block sum = c[0] * block(x[0] + i);
    for (int j = 1; j < Terms; ++j) sum += c[j] * block(x[j] + i);
    Eigen::Map<Block>(z + i) = sum;
  }
  for (; i < n; ++i) {
    double sum = c[0] * x[0][i];
    for (int j = 1; j < Terms; ++j) sum += c[j] * x[j][i];
    z[i] = sum;
  }
}

using Kernel = void (*)(std::ptrdiff_t, const double*, const double* const*, double*);

template <std::size_t... Terms>
constexpr std::array<Kernel, sizeof...(Terms)> kernels(std::index_sequence<Terms...>) {
  return {&combine<static_cast<int>(Terms) + 1>...};
}

extern "C" {

static int annulus_linear_combination(int terms, realtype* c, N_Vector* x, N_Vector z) {
  static constexpr auto table = kernels(std::make_index_sequence<most_terms>{});
  if (terms < 1) return 1;
  double* result = NV_DATA_S(z);
  const std::ptrdiff_t n = NV_LENGTH_S(z);
  std::array<const double*, most_terms> data{};
  const int first = terms < most_terms ? terms : most_terms;
  for (int j = 0; j < first; ++j) data[static_cast<std::size_t>(j)] = NV_DATA_S(x[j]);
  // A result among the later terms of a long sum would be overwritten before it is read: SUNDIALS never asks for it.
  table[static_cast<std::size_t>(first - 1)](n, c, data.data(), result);
  for (int j = first; j < terms; ++j) {
    const double* term = NV_DATA_S(x[j]);
    for (std::ptrdiff_t i = 0; i < n; ++i) result[i] += c[j] * term[i];
  }
  return 0;
}

static realtype annulus_weighted_norm(N_Vector x, N_Vector weight) {
  const Eigen::Map<const Eigen::ArrayXd> values(NV_DATA_S(x), NV_LENGTH_S(x)),
      weights(NV_DATA_S(weight), NV_LENGTH_S(x));
  return std::sqrt((values * weights).square().mean());
}

}  // extern "C"

}  // namespace

void use_fast_kernels(N_Vector vector) {
  vector->ops->nvlinearcombination = annulus_linear_combination;
  vector->ops->nvwrmsnorm = annulus_weighted_norm;
}

}  // namespace annulus::dynamics
