#include "dynamics/steady_state/second_angle.h"

#include <algorithm>
#include <complex>
#include <numbers>

namespace annulus::dynamics {

namespace {

/// Amplitudes c_l, l = 0 ... (rows - 1)/2, for every sample of the first angle (samples x amplitudes): the function is
/// c_0 + 2 Re sum c_l exp(i l angle).
Eigen::MatrixXcd amplitudes_of(const Eigen::Ref<const Eigen::VectorXd>& values, int rows) {
  const Eigen::Index samples = values.size() / rows;
  const auto of_rows = values.reshaped(samples, rows);
  Eigen::MatrixXcd result(samples, (rows + 1) / 2);
  for (int l = 0; l < result.cols(); ++l) {
    Eigen::VectorXcd turn(rows);
    for (int i = 0; i < rows; ++i) turn[i] = std::polar(1.0 / rows, -2 * std::numbers::pi * ((l * i) % rows) / rows);
    result.col(l) = of_rows * turn;
  }
  return result;
}

}  // namespace

Eigen::MatrixXd along_both_angles(const Eigen::MatrixXd& values, int rows, double advance, Eigen::Index count) {
  const Eigen::Index samples = values.rows() / rows;
  if (rows == 1) return values.replicate((count + samples - 1) / samples, 1).topRows(count);
  const int waves = (rows - 1) / 2;
  Eigen::ArrayXXcd turn(count, waves);  // twice exp(i l angle)
  for (int l = 0; l < waves; ++l)
    for (Eigen::Index i = 0; i < count; ++i) turn(i, l) = std::polar(2.0, static_cast<double>((l + 1) * i) * advance);
  Eigen::MatrixXd result(count, values.cols());
  for (Eigen::Index m = 0; m < values.cols(); ++m) {
    const Eigen::MatrixXcd amplitudes = amplitudes_of(values.col(m), rows);
    for (Eigen::Index begin = 0; begin < count; begin += samples) {
      const Eigen::Index part = std::min(samples, count - begin);
      auto at = result.col(m).segment(begin, part).array();
      at = amplitudes.col(0).head(part).real().array();
      for (int l = 0; l < waves; ++l)
        at += (amplitudes.col(l + 1).head(part).array() * turn.col(l).segment(begin, part)).real();
    }
  }
  return result;
}

Eigen::MatrixXd at_rows(const Eigen::MatrixXd& values, int rows, int wanted) {
  const Eigen::Index samples = values.rows() / rows;
  Eigen::MatrixXd result(samples * wanted, values.cols());
  for (Eigen::Index m = 0; m < values.cols(); ++m) {
    const Eigen::MatrixXcd amplitudes = amplitudes_of(values.col(m), rows);
    for (int row = 0; row < wanted; ++row) {
      auto part = result.col(m).segment(row * samples, samples);
      part = amplitudes.col(0).real();
      for (Eigen::Index l = 1; l < amplitudes.cols(); ++l)
        part += 2 * (amplitudes.col(l) *
                     std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(l * row) / static_cast<double>(wanted)))
                        .real();
    }
  }
  return result;
}

}  // namespace annulus::dynamics
