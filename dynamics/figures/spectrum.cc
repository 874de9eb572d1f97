#include "dynamics/figures/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "core/errors.h"

namespace annulus::dynamics {

Spectrum spectrum(const Eigen::Ref<const Eigen::VectorXd>& series, int mesh_cycles) {
  const auto n = series.size();
  if (n < 2 || mesh_cycles < 1)
    throw InputError(fmt::format("a spectrum needs at least two samples and one mesh cycle, not {} and {}",
                                 series.size(), mesh_cycles));
  Eigen::VectorXd copy = series;
  Eigen::VectorXcd lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, copy);
  const Eigen::Index half = n / 2 + 1;
  Spectrum result{Eigen::VectorXd(half), Eigen::VectorXd(half)};
  for (Eigen::Index i = 0; i < half; ++i) {
    // Lines other than the mean and the Nyquist line stand for a pair of conjugates.
    const double pair = i == 0 || 2 * i == n ? 1.0 : 2.0;
    result.order[i] = static_cast<double>(i) / mesh_cycles;
    result.amplitude[i] = pair * std::abs(lines[i]) / static_cast<double>(n);
  }
  return result;
}

std::vector<SpectralLine> highest_lines(const Spectrum& spectrum, int count, double floor) {
  std::vector<SpectralLine> lines;
  for (Eigen::Index i = 1; i < spectrum.order.size(); ++i) {
    const int harmonic = static_cast<int>(std::lround(spectrum.order[i]));
    lines.push_back({spectrum.order[i], spectrum.amplitude[i], harmonic, spectrum.order[i] - harmonic});
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const SpectralLine& a, const SpectralLine& b) { return a.amplitude > b.amplitude; });
  if (lines.empty()) return lines;
  const double least = floor * lines.front().amplitude;
  const auto low =
      std::find_if(lines.begin(), lines.end(), [least](const SpectralLine& line) { return line.amplitude < least; });
  const auto listed = std::min<std::ptrdiff_t>(low - lines.begin(), std::max(count, 0));
  lines.resize(static_cast<std::size_t>(listed));
  return lines;
}

}  // namespace annulus::dynamics
