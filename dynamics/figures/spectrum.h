#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::dynamics {

/// Amplitudes of a real periodic series whose columns span whole mesh cycles.
struct Spectrum {
  Eigen::VectorXd order;      ///< multiples of the mesh frequency
  Eigen::VectorXd amplitude;  ///< single-sided; order 0 is the mean
};
/// Throws InputError for fewer than two samples or one mesh cycle.
[[nodiscard]] Spectrum spectrum(const Eigen::Ref<const Eigen::VectorXd>& series, int mesh_cycles);

/// A line of a spectrum, read as a sideband of the nearest multiple of the mesh frequency.
struct SpectralLine {
  double order = 0, amplitude = 0;
  int harmonic = 0;     ///< nearest whole order
  double sideband = 0;  ///< order - harmonic, in mesh orders
};
/// The `count` highest lines without the mean, highest first, none below `floor` times the highest.
[[nodiscard]] std::vector<SpectralLine> highest_lines(const Spectrum& spectrum, int count, double floor = 1e-3);

}  // namespace annulus::dynamics
