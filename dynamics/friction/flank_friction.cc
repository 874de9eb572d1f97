#include "dynamics/friction/flank_friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "core/units.h"
#include "dynamics/system/input_checks.h"
#include "geometry/gear_pair.h"

namespace annulus::dynamics {

namespace {

/// Along the line of action in base pitches from the pitch point, in the sense in which the contact moves.
struct ContactPath {
  double begin = 0, end = 0;
  double lines = 0;  ///< by which the contact lines of a pair are apart at both ends of the face
};

ContactPath path_of(const geometry::GearPair& pair) {
  const double pitch = pair.pinion().base_pitch();
  const double below = (pair.roll_length_pitch() - pair.roll_length_low()) / pitch,
               above = (pair.roll_length_high() - pair.roll_length_pitch()) / pitch;
  const double lines = pair.common_face().width * std::abs(std::tan(pair.pinion().base_helix_angle())) / pitch;
  return pair.driver() == geometry::GearRole::pinion ? ContactPath{-below, above, lines}
                                                     : ContactPath{-above, below, lines};
}

/// Part of the path on which a pair touches whose middle is at `middle`.
std::pair<double, double> contact_of(const ContactPath& path, double middle) {
  return {std::max(path.begin, middle - path.lines / 2), std::min(path.end, middle + path.lines / 2)};
}

/// Integral of |s|.
double integral(double s) { return s * std::abs(s) / 2; }

}  // namespace

Sliding sliding_of(const geometry::GearPair& pair, const PairShares& shares) {
  const int phases = shares.phases;
  if (phases < 1 || std::ssize(shares.share) != phases)
    throw InputError(
        fmt::format("the shares of the tooth pairs have {} phases and values of {}", phases, shares.share.size()));
  const auto path = path_of(pair);
  const double pitch = pair.pinion().base_pitch();
  constexpr int fine = 256;
  const int finer = (fine + phases - 1) / phases, values = finer * phases;
  const double step = 1.0 / values;
  std::vector<double> side, distance;
  for (int i = 0; i < values; ++i) {
    const auto before = static_cast<std::size_t>(i / finer), after = (before + 1) % shares.share.size();
    const double towards = static_cast<double>(i % finer) / finer;
    // Behind the last phase the pairs have moved on by one.
    const std::ptrdiff_t moved = after == 0 ? 1 : 0;
    const auto share_of = [&](std::ptrdiff_t pair_number) {
      const auto at = [&](std::size_t phase, std::ptrdiff_t n) {
        const auto& list = shares.share[phase];
        return n < 0 || n >= std::ssize(list) ? 0.0 : list[static_cast<std::size_t>(n)];
      };
      return (1 - towards) * at(before, pair_number) + towards * at(after, pair_number - moved);
    };
    double sides = 0, distances = 0;
    for (std::ptrdiff_t n = 0; n <= std::ssize(shares.share[before]); ++n) {
      const double share = share_of(n);
      if (share == 0) continue;
      const double middle = i * step - shares.first - static_cast<double>(n);
      auto [low, high] = contact_of(path, middle);
      if (high - low < step) {
        // Spur teeth, and ends of contact lines: the mean over the step in time.
        const double at = path.lines < step ? middle : std::clamp(middle, path.begin, path.end);
        low = at - step / 2;
        high = at + step / 2;
      }
      sides += share * (std::abs(high) - std::abs(low)) / (high - low);
      distances += share * (integral(high) - integral(low)) / (high - low);
    }
    side.push_back(sides);
    distance.push_back(pitch * distances);
  }
  return {{side, values}, {distance, values}};
}

PairShares even_shares(const geometry::GearPair& pair) {
  const auto path = path_of(pair);
  constexpr int phases = 256;
  PairShares shares{.phases = phases, .first = static_cast<int>(std::floor(-path.end - path.lines / 2))};
  const int last = static_cast<int>(std::ceil(1 - path.begin + path.lines / 2));
  for (int i = 0; i < phases; ++i) {
    auto& list = shares.share.emplace_back();
    double sum = 0;
    for (int later = shares.first; later <= last; ++later) {
      const double middle = static_cast<double>(i) / phases - later;
      const auto [low, high] = contact_of(path, middle);
      const bool touches = path.begin <= middle && middle < path.end;
      list.push_back(path.lines == 0 ? (touches ? 1.0 : 0.0) : std::max(0.0, high - low));
      sum += list.back();
    }
    for (double& share : list) share /= sum;
  }
  return shares;
}

std::vector<FrictionShare> friction_shares(const FlankFriction& friction, const PitchPointMotion& motion,
                                           const SlidingSense& sense) {
  if (friction.coefficient == 0 || sense.rotation == 0) return {};
  const double mu = friction.coefficient * sense.rotation;
  return {{mu * sense.contact * motion.across, friction.sliding.side},
          {mu * motion.rotation, friction.sliding.distance}};
}

double pitch_point_radius(const geometry::GearPair& pair) {
  return 1 / (pair.relative_curvature(pair.roll_length_pitch()) * std::cos(pair.pinion().base_helix_angle()));
}

double mean_coefficient_of_friction(const geometry::GearPair& pair, const MeanFilm& film) {
  check_positive(film.line_load, "line load");
  check_positive(film.pitch_velocity, "velocity of the pitch circles");
  check_positive(film.viscosity, "viscosity of the oil");
  check_positive(film.roughness, "roughness of the flanks");
  check_positive(film.lubricant_factor, "lubricant factor");
  constexpr double least_line_load = 150, largest_velocity = 50;  // N/mm, m/s
  const double line_load = std::max(film.line_load * units::mm, least_line_load);
  const double velocity = std::min(film.pitch_velocity, largest_velocity);
  const double radius = pitch_point_radius(pair);
  const double sum = 2 * velocity * std::sin(pair.working_pressure_angle());
  constexpr double mPas = 1e-3;
  return 0.048 * std::pow(line_load / (sum * radius / units::mm), 0.2) * std::pow(film.viscosity / mPas, -0.05) *
         std::pow(film.roughness / units::um, 0.25) * film.lubricant_factor;
}

}  // namespace annulus::dynamics
