#include "fem/body/gauge_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "fem/body/gear_body.h"

namespace annulus::fem {
namespace {

/// Weights of the points of a line whose sum is the mean over [from, to] of what is linear between them.
std::vector<double> mean_weights(const std::vector<double>& at, double from, double to) {
  std::vector<double> weights(at.size(), 0.0);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const double low = std::max(from, at[i]), high = std::min(to, at[i + 1]);
    if (high <= low) continue;
    const double share = (high - low) / (to - from), along = ((low + high) / 2 - at[i]) / (at[i + 1] - at[i]);
    weights[i] += share * (1 - along);
    weights[i + 1] += share * along;
  }
  return weights;
}

/// Weights of the stations of an axis that interpolate at z, which lies between them.
std::vector<std::pair<int, double>> station_weights(const std::vector<double>& stations, double z) {
  const auto above = std::upper_bound(stations.begin(), stations.end(), z);
  if (above == stations.begin()) return {{0, 1.0}};
  const auto i = static_cast<int>(above - stations.begin()) - 1;
  if (above == stations.end()) return {{i, 1.0}};
  const double along = (z - stations[i]) / (stations[i + 1] - stations[i]);
  return {{i, 1 - along}, {i + 1, along}};
}

/// What the strain of a gauge takes of tangential and axial stress, per Pa. A plane body has no axial strain, and its
/// axial stress follows.
std::pair<double, double> stress_shares(const StrainGauge& gauge, const Material& material, bool solid) {
  const double nu = material.poisson_ratio, E = material.youngs_modulus;
  if (!solid) return {(1 - nu * nu) / E, 0.0};
  return gauge.direction == StrainGauge::Direction::hoop ? std::pair{1 / E, -nu / E} : std::pair{-nu / E, 1 / E};
}

/// Lines of neighbouring sectors, one behind the other; where two meet, the mean counts.
struct Chain {
  struct Piece {
    const StressLine* line;
    int sector;
  };
  std::vector<Piece> pieces;
  std::vector<double> arc;  ///< m, of the points of all pieces, shared ones once

  void add(const StressLine& line, int sector) {
    const double start = arc.empty() ? 0 : arc.back();
    for (std::size_t i = arc.empty() ? 0 : 1; i < line.arc.size(); ++i)
      arc.push_back(start + line.arc[i] - line.arc.front());
    pieces.push_back({&line, sector});
  }
};

}  // namespace

std::vector<GaugePart> gauge_parts(const WantedGauge& wanted, const GearBody& body) {
  const StrainGauge& gauge = wanted.gauge;
  const int first_load = body.root_low.first_load,
            loads = body.root_low.loads() + body.root_high.loads() + body.rim.loads();
  std::vector<GaugePart> parts;
  const bool root = gauge.place == StrainGauge::Place::root, solid = body.axial_stations() > 1;
  const double pitch = body.pitch_angle;
  Chain chain;
  double middle = 0;
  if (root) {
    const int space = static_cast<int>(std::floor(gauge.angle / pitch));  // behind the tooth of this number
    chain.add(body.root_high, space);
    chain.add(body.root_low, space + 1);
    middle = chain.arc.back() / 2 + gauge.offset;
  } else {
    const auto& rim = body.rim;
    if (rim.points() == 0)
      throw InputError(fmt::format("strain gauge '{}' needs a free outside, and the ring is held there", gauge.name));
    const int sector = static_cast<int>(std::lround(gauge.angle / pitch));
    for (const int s : {sector - 1, sector, sector + 1}) chain.add(rim, s);
    const double radius = (rim.arc.back() - rim.arc.front()) / (rim.angle.back() - rim.angle.front());
    middle = (rim.arc.back() - rim.arc.front()) + radius * (gauge.angle - sector * pitch - rim.angle.front());
  }
  const double from = middle - gauge.length / 2, to = middle + gauge.length / 2;
  if (from < 0 || to > chain.arc.back())
    throw InputError(
        root ? fmt::format(
                   "strain gauge '{}' of {:.4g} mm at {:.4g} mm from the middle of a tooth space does not lie in "
                   "its root, which is {:.4g} mm long between the form circles",
                   gauge.name, 1e3 * gauge.length, 1e3 * gauge.offset, 1e3 * chain.arc.back())
             : fmt::format("strain gauge '{}' of {:.4g} mm is longer than two teeth of the outside ({:.4g} mm)",
                           gauge.name, 1e3 * gauge.length, 2e3 / 3 * chain.arc.back()));

  const auto weights = mean_weights(chain.arc, from, to);
  const auto [tangential, axial] = stress_shares(gauge, wanted.material, solid);
  std::size_t first = 0;
  for (std::size_t p = 0; p < chain.pieces.size(); ++p) {
    const auto& [line, sector] = chain.pieces[p];
    const double low = line->axial.front(),
                 high = wanted.mirror_width > 0 ? wanted.mirror_width - low : line->axial.back();
    const double rounding = 1e-9 * (high - low);
    if (solid && (gauge.z < low - rounding || gauge.z > high + rounding))
      throw InputError(
          fmt::format("strain gauge '{}' stands {:.4g} mm from the low end of the common face, where the ring "
                      "has no surface: it reaches from {:.4g} to {:.4g} mm",
                      gauge.name, 1e3 * gauge.z, 1e3 * low, 1e3 * high));
    const double z = wanted.mirror_width > 0 ? std::min(gauge.z, wanted.mirror_width - gauge.z) : gauge.z;
    GaugePart part{sector, Eigen::VectorXd::Zero(loads)};
    for (int u = 0; u < line->points(); ++u) {
      const bool shared = (u == 0 && p > 0) || (u + 1 == line->points() && p + 1 < chain.pieces.size());
      const double weight = (shared ? 0.5 : 1) * weights[first + static_cast<std::size_t>(u)];
      if (weight == 0) continue;
      for (const auto& [station, of_station] : station_weights(line->axial, z)) {
        const int load = line->first_load - first_load + (u * line->axial_stations() + station) * line->components;
        part.weights[load] += weight * of_station * tangential;
        if (line->components > 1) part.weights[load + 1] += weight * of_station * axial;
      }
    }
    first += static_cast<std::size_t>(line->points()) - 1;
    if (!part.weights.isZero(0)) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace annulus::fem
