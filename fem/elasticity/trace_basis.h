#pragma once

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cstddef>
#include <vector>

namespace annulus::fem {

/// The Lagrange shape functions of the elements along one boundary line, as functions of a smooth coordinate of that
/// line (roll length, polar angle): the isoparametric coordinate is found from the coordinate of the nodes.
class TraceBasis {
 public:
  static constexpr int largest_degree = 4;
  TraceBasis() = default;
  /// `stations`: coordinates of the nodes, ascending, elements * degree + 1 of them.
  TraceBasis(std::vector<double> stations, int degree);

  struct Values {
    int first = 0;  ///< node of values[0]
    /// degree + 1 shape functions, sum 1
    boost::container::static_vector<double, largest_degree + 1> weights;
  };
  /// Throws InternalError outside the line (beyond a relative 1e-9).
  [[nodiscard]] Values operator()(double coordinate) const;
  /// Gauss points over [low, high], element by element: within one a shape function is smooth. Calls
  /// add(coordinate, weight, length), the weights of one element summing to 2 over its part of this length.
  template <class Add>
  void for_gauss_points(double low, double high, const Add& add) const;
  /// Integrals of all shape functions over [low, high], divided by its length.
  [[nodiscard]] std::vector<double> mean_over(double low, double high) const;

  [[nodiscard]] int size() const { return static_cast<int>(stations_.size()); }
  [[nodiscard]] const std::vector<double>& stations() const { return stations_; }
  [[nodiscard]] int elements() const { return degree_ > 0 ? (size() - 1) / degree_ : 0; }
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] double low() const { return stations_.front(); }
  [[nodiscard]] double high() const { return stations_.back(); }

 private:
  std::vector<double> stations_;
  int degree_ = 0;
  std::vector<double> unit_;   // reference coordinates of the nodes of one element
  std::vector<double> scale_;  // of every shape function: it is this times the product of distances to other nodes
  /// The isoparametric map of every element, from its first node on: coefficients of xi, xi^2, ...
  std::vector<double> map_;
};

template <class Add>
void TraceBasis::for_gauss_points(double low, double high, const Add& add) const {
  using Rule = boost::math::quadrature::gauss<double, 7>;
  for (int e = 0; e < elements(); ++e) {
    const double a = std::max(low, stations_[e * degree_]), b = std::min(high, stations_[(e + 1) * degree_]);
    if (b <= a) continue;
    for (std::size_t q = 0; q < Rule::abscissa().size(); ++q)
      for (const double side : {1.0, -1.0}) {
        if (side < 0 && Rule::abscissa()[q] == 0) continue;
        add((a + b) / 2 + side * Rule::abscissa()[q] * (b - a) / 2, Rule::weights()[q], b - a);
      }
  }
}

}  // namespace annulus::fem
