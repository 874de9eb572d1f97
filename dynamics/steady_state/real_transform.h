#pragma once

#include <complex>
#include <memory>

namespace annulus::dynamics {

/// Discrete Fourier transform of real periodic samples (FFTW), either way without scaling: lines 0 ... samples/2,
/// X_j = sum_i x_i exp(-2 pi i j / samples). Results depend on the values alone. Objects may be made in any thread, and
/// several threads may use one object.
class RealTransform {
 public:
  explicit RealTransform(int samples);
  void forward(const double* values, std::complex<double>* lines) const;
  /// Destroys `lines`.
  void inverse(std::complex<double>* lines, double* values) const;

 private:
  struct Plans;
  std::shared_ptr<const Plans> plans_;
};

}  // namespace annulus::dynamics
