#include "dynamics/systems/planetary/gauge_strain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "dynamics/figures/spectrum.h"

namespace annulus::dynamics {

namespace {

constexpr double highest_order = 3.5, lowest_line = 1e-4;
constexpr long most_cycles = 20000;

/// Mesh cycles after which the motion and a turn of the carrier against the ring repeat together; 0: too many.
long common_cycles(const PlanetaryStage& stage, const DynamicResponse& response) {
  if (!response.steady || !response.whole_period) return 0;
  const long cycles = std::lcm(static_cast<long>(response.window_cycles), static_cast<long>(stage.ring_teeth));
  return cycles <= most_cycles ? cycles : 0;
}

}  // namespace

std::vector<double> strain_over_turn(const PeriodicCurve& curve, const Eigen::VectorXd& angles, double first,
                                     int samples) {
  constexpr double turn = 2 * std::numbers::pi;
  std::vector<double> strain;
  for (int i = 0; i < samples; ++i) {
    double sum = 0;
    for (const double angle : angles) sum += curve(static_cast<double>(i) / samples + (angle - first) / turn);
    strain.push_back(sum);
  }
  return strain;
}

std::optional<StrainLines> strain_lines(const PlanetaryStage& stage, const std::vector<PeriodicCurve>& curves,
                                        const DynamicResponse& response) {
  const long cycles = curves.empty() ? 0 : common_cycles(stage, response);
  if (cycles == 0) return std::nullopt;
  const auto& series = response.series;
  const Eigen::Index window = series.time.size(), samples = window / response.window_cycles;
  const auto system = assemble(stage);
  const int planets = stage.planets();
  std::vector<Spectrum> spectra;
  for (const auto& curve : curves) {
    Eigen::VectorXd strain = Eigen::VectorXd::Zero(cycles * samples);
    for (Eigen::Index i = 0; i < strain.size(); ++i) {
      const double time =
          series.time[0] + static_cast<double>(i) / (static_cast<double>(samples) * response.mesh_frequency);
      for (int n = 0; n < planets; ++n) {
        const auto& mesh = system.meshes()[static_cast<std::size_t>(planets + n)];
        const double turns = (mesh.frequency * time + mesh.phase_offset) / stage.ring_teeth;
        strain[i] += series.force(planets + n, i % window) / stage.mean_mesh_force() * curve(turns);
      }
    }
    spectra.push_back(spectrum(strain, static_cast<int>(cycles)));
  }
  double highest = 0;
  for (const auto& s : spectra) highest = std::max(highest, s.amplitude.tail(s.amplitude.size() - 1).maxCoeff());
  const auto& order = spectra.front().order;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 1; i < order.size() && order[i] <= highest_order; ++i)
    if (std::any_of(spectra.begin(), spectra.end(),
                    [&](const auto& s) { return s.amplitude[i] >= lowest_line * highest; }))
      kept.push_back(i);
  StrainLines lines{order(kept), Eigen::MatrixXd(spectra.size(), kept.size())};
  for (std::size_t g = 0; g < spectra.size(); ++g)
    lines.amplitude.row(static_cast<Eigen::Index>(g)) = spectra[g].amplitude(kept).transpose();
  return lines;
}

}  // namespace annulus::dynamics
