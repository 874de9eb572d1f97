#include "dynamics/steady_state/two_frequencies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "core/whole_ratio.h"
#include "dynamics/system/periods.h"

namespace annulus::dynamics {

namespace {

/// An error of a mesh that repeats after a whole number of mesh cycles, `turns` times in them.
struct Wave {
  SecondWave wave;
  int cycles = 0, turns = 0;
};

/// What the excitation consists of.
struct Parts {
  int fixed = 1;  ///< mesh cycles after which all but the waves repeats
  std::vector<Wave> waves;
};

std::optional<std::pair<long, long>> cycles_of(double rate, double mesh_frequency) {
  return whole_ratio(std::abs(rate) / (2 * std::numbers::pi * mesh_frequency));
}

std::optional<Parts> parts_of(const LumpedSystem& system, double mesh_frequency) {
  Parts parts;
  const auto repeats = [&](double cycles) {
    parts.fixed = common_period(parts.fixed, static_cast<int>(std::lround(std::max(1.0, cycles))));
  };
  for (std::size_t m = 0; m < system.meshes().size(); ++m) {
    const auto& mesh = system.meshes()[m];
    constexpr double same = 1e-9;
    if (mesh.frequency != 0 && std::abs(std::abs(mesh.frequency) - mesh_frequency) > same * mesh_frequency)
      return std::nullopt;
    repeats(period_in_cycles(mesh.excitation));
    for (const auto& error : mesh.tooth_errors) repeats(error.curve.period());
    for (const auto& error : mesh.errors) {
      if (error.rate == 0) continue;
      const auto ratio = cycles_of(error.rate, mesh_frequency);
      if (!ratio) return std::nullopt;
      parts.waves.push_back(
          {{static_cast<int>(m), error}, static_cast<int>(ratio->second), static_cast<int>(ratio->first)});
    }
  }
  for (const auto& coupling : system.couplings())
    for (const auto& curve : coupling.compliance) repeats(curve.period());
  for (const auto& face : system.faces())
    if (face.course)
      for (const auto* curve : {&face.course->slope, &face.course->curvature, &face.course->gap_slope})
        repeats(curve->period());
  for (const auto& load : system.harmonic_loads()) {
    const auto ratio = cycles_of(load.rate, mesh_frequency);
    if (!ratio) return std::nullopt;
    repeats(static_cast<double>(ratio->second));
  }
  return parts;
}

}  // namespace

std::optional<TwoFrequencies> two_frequencies(const LumpedSystem& system, double mesh_frequency, int period) {
  if (!system.has_fixed_directions()) return std::nullopt;
  const auto parts = parts_of(system, mesh_frequency);
  if (!parts) return std::nullopt;
  std::set<int> candidates;
  for (const auto& wave : parts->waves)
    if (parts->fixed % wave.cycles != 0) candidates.insert(wave.cycles);
  std::optional<TwoFrequencies> best;
  for (const int cycles : candidates) {
    TwoFrequencies found{parts->fixed, 2 * std::numbers::pi * mesh_frequency / cycles, {}};
    for (const auto& wave : parts->waves) {
      constexpr int most_turns = 2;  // more would need many values of the second angle
      if (parts->fixed % wave.cycles == 0) continue;
      if (cycles % wave.cycles == 0 && wave.turns * (cycles / wave.cycles) <= most_turns)
        found.waves.push_back(wave.wave);
      else
        found.cycles = common_period(found.cycles, wave.cycles);
    }
    if (!best || found.cycles < best->cycles) best = std::move(found);
  }
  constexpr int usual_rows = 9;
  if (!best || best->cycles > period / (2 * usual_rows)) return std::nullopt;
  return best;
}

namespace {

/// The system with other errors where those of the second angle were.
template <class Changed>
LumpedSystem with_changed_waves(const LumpedSystem& system, const std::vector<SecondWave>& waves, Changed changed) {
  LumpedSystemBuilder builder;
  builder.add(system);
  for (int m = 0; m < static_cast<int>(system.meshes().size()); ++m) {
    std::vector<HarmonicError> errors;
    for (const auto& error : system.meshes()[static_cast<std::size_t>(m)].errors) {
      const bool turns = std::any_of(waves.begin(), waves.end(),
                                     [&](const SecondWave& wave) { return wave.mesh == m && wave.error == error; });
      if (const auto kept = turns ? changed(error) : std::optional(error)) errors.push_back(*kept);
    }
    builder.set_errors(m, std::move(errors));
  }
  return builder.build();
}

}  // namespace

LumpedSystem without_waves(const LumpedSystem& system, const std::vector<SecondWave>& waves) {
  return with_changed_waves(system, waves, [](const HarmonicError&) { return std::optional<HarmonicError>(); });
}

LumpedSystem with_waves_at(const LumpedSystem& system, const TwoFrequencies& angles, double angle) {
  return with_changed_waves(system, angles.waves, [&](const HarmonicError& error) {
    return std::optional(HarmonicError{error.amount, 0, error.rate / angles.second_rate * angle + error.phase});
  });
}

}  // namespace annulus::dynamics
