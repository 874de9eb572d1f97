#include "app/systems/planetary/gauge_spectrum.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "app/systems/planetary/strain_gauges.h"
#include "dynamics/figures/spectrum.h"

namespace annulus::app {

namespace {

constexpr double highest_order = 3.5, lowest_line = 1e-4;
constexpr long most_cycles = 20000;

/// Mesh cycles after which the motion and a revolution of the carrier against the ring repeat together; 0: too many.
long common_cycles(const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response) {
  if (!response.steady || !response.whole_period) return 0;
  const long cycles = std::lcm(static_cast<long>(response.window_cycles), static_cast<long>(stage.ring_teeth));
  return cycles <= most_cycles ? cycles : 0;
}

}  // namespace

Csv gauge_spectrum(const dynamics::PlanetaryStage& stage, const MeshResult& ring_mesh,
                   const dynamics::DynamicResponse& response) {
  const long cycles = ring_mesh.gauges.rows.empty() ? 0 : common_cycles(stage, response);
  if (cycles == 0) return {};
  const auto& series = response.series;
  const Eigen::Index window = series.time.size(), samples = window / response.window_cycles;
  const auto system = dynamics::assemble(stage);
  const int planets = stage.planets();
  Csv csv;
  csv.columns = {"mesh_order", "carrier_order", "frequency_Hz"};
  std::vector<dynamics::Spectrum> spectra;
  for (const auto& curve : gauge_curves(ring_mesh.gauges)) {
    csv.columns.push_back(fmt::format("gauge_{}_um_per_m", spectra.size() + 1));
    Eigen::VectorXd strain = Eigen::VectorXd::Zero(cycles * samples);
    for (Eigen::Index i = 0; i < strain.size(); ++i) {
      const double time =
          series.time[0] + static_cast<double>(i) / (static_cast<double>(samples) * response.mesh_frequency);
      for (int n = 0; n < planets; ++n) {
        const auto& mesh = system.meshes()[static_cast<std::size_t>(planets + n)];
        const double turns = (mesh.frequency * time + mesh.phase_offset) / stage.ring_teeth;
        const double share = series.force(planets + n, i % window) / stage.mean_mesh_force();
        strain[i] += share * curve(turns);
      }
    }
    spectra.push_back(dynamics::spectrum(strain, static_cast<int>(cycles)));
  }
  double highest = 0;
  for (const auto& s : spectra) highest = std::max(highest, s.amplitude.tail(s.amplitude.size() - 1).maxCoeff());
  const auto& order = spectra.front().order;
  for (Eigen::Index i = 1; i < order.size() && order[i] <= highest_order; ++i) {
    if (std::none_of(spectra.begin(), spectra.end(),
                     [&](const auto& s) { return s.amplitude[i] >= lowest_line * highest; }))
      continue;
    auto& row =
        csv.rows.emplace_back(std::vector{order[i], order[i] * stage.ring_teeth, order[i] * response.mesh_frequency});
    for (const auto& s : spectra) row.push_back(s.amplitude[i]);
  }
  return csv;
}

}  // namespace annulus::app
