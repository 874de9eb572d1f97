#include "fem/elasticity/trace_basis.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Gauss-Lobatto points on [0, 1]: the nodes of deal.II's FE_Q.
std::vector<double> lobatto(int degree) {
  switch (degree) {
    case 1:
      return {0, 1};
    case 2:
      return {0, 0.5, 1};
    case 3:
      return {0, 0.5 - std::sqrt(5.0) / 10, 0.5 + std::sqrt(5.0) / 10, 1};
    case 4:
      return {0, 0.5 - std::sqrt(21.0) / 14, 0.5, 0.5 + std::sqrt(21.0) / 14, 1};
    default:
      throw InputError("elements of degree " + std::to_string(degree) + " are not available: 1 to 4 are");
  }
}

/// Adds `factor` times the product of (x - node) over all nodes but `i` to the coefficients of 1, x, x^2, ...
void add_product(const std::vector<double>& nodes, std::size_t i, double factor, std::vector<double>& coefficients) {
  std::vector<double> product = {factor};
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (j == i) continue;
    product.push_back(0);
    for (std::size_t k = product.size() - 1; k > 0; --k) product[k] = product[k - 1] - nodes[j] * product[k];
    product[0] *= -nodes[j];
  }
  for (std::size_t k = 0; k < product.size(); ++k) coefficients[k] += product[k];
}

}  // namespace

TraceBasis::TraceBasis(std::vector<double> stations, int degree)
    : stations_(std::move(stations)), degree_(degree), unit_(lobatto(degree)) {
  require(stations_.size() > 1 && (stations_.size() - 1) % degree_ == 0, "a trace of ", stations_.size(),
          " stations has a broken element of degree ", degree_);
  for (std::size_t i = 0; i < unit_.size(); ++i) {
    double product = 1;
    for (std::size_t j = 0; j < unit_.size(); ++j)
      if (j != i) product *= unit_[i] - unit_[j];
    scale_.push_back(1 / product);
  }
  for (int e = 0; e < elements(); ++e) {
    std::vector<double> coefficients(unit_.size(), 0.0);
    const double* u = stations_.data() + static_cast<std::ptrdiff_t>(e) * degree_;
    for (std::size_t i = 1; i < unit_.size(); ++i) add_product(unit_, i, (u[i] - u[0]) * scale_[i], coefficients);
    map_.insert(map_.end(), coefficients.begin() + 1, coefficients.end());  // the first node is at xi = 0
  }
}

TraceBasis::Values TraceBasis::operator()(double coordinate) const {
  const double tolerance = 1e-9 * (high() - low());
  require(coordinate >= low() - tolerance && coordinate <= high() + tolerance, "the point ", coordinate,
          " is outside a boundary trace from ", low(), " to ", high());
  const auto above = std::upper_bound(stations_.begin(), stations_.end(), coordinate);
  int element = static_cast<int>(above - stations_.begin() - 1) / degree_;
  element = std::clamp(element, 0, elements() - 1);
  const double* u = stations_.data() + static_cast<std::ptrdiff_t>(element) * degree_;

  // Invert the isoparametric map of the coordinate; it is nearly linear, so Newton needs a few steps.
  const double* map = map_.data() + static_cast<std::ptrdiff_t>(element) * degree_;
  const double wanted = coordinate - u[0];
  double xi = wanted / (u[degree_] - u[0]);
  for (int step = 0; step < 20; ++step) {
    double value = 0, slope = 0;
    for (int k = degree_ - 1; k >= 0; --k) {
      slope = slope * xi + (k + 1) * map[k];
      value = (value + map[k]) * xi;
    }
    const double change = (value - wanted) / slope;
    xi -= change;
    if (std::abs(change) < 1e-14) break;
  }
  Values result;
  result.first = element * degree_;
  for (int i = 0; i <= degree_; ++i) {
    double weight = scale_[i];
    for (int j = 0; j <= degree_; ++j)
      if (j != i) weight *= xi - unit_[j];
    result.weights.push_back(weight);
  }
  return result;
}

std::vector<double> TraceBasis::mean_over(double low, double high) const {
  std::vector<double> result(stations_.size(), 0.0);
  for_gauss_points(low, high, [&](double x, double weight, double length) {
    const auto values = (*this)(x);
    for (int i = 0; i <= degree_; ++i)
      result[values.first + i] += values.weights[i] * weight * length / 2 / (high - low);
  });
  return result;
}

}  // namespace annulus::fem
