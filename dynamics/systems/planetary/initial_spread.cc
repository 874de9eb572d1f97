#include "dynamics/systems/planetary/initial_spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/errors.h"
#include "dynamics/steady_state/random_starts.h"

namespace annulus::dynamics {

namespace {

bool same_motion(const FigureSet& a, const FigureSet& b, double share) {
  const auto close = [&](const std::string& key) {
    const double x = a.value(key), y = b.value(key);
    return x == y || std::abs(x - y) <= share * std::max(std::abs(x), std::abs(y));
  };
  for (const std::string mesh : {"sun_planet_", "ring_planet_"})
    if (!close(mesh + "load_sharing_instantaneous") || !close(mesh + "peak_factor") ||
        // A fraction of the time, itself counted in samples.
        !(std::abs(a.value(mesh + "contact_loss") - b.value(mesh + "contact_loss")) <= std::max(share, 0.01)))
      return false;
  return true;
}

}  // namespace

InitialSpread initial_spread(const PlanetaryStage& stage, const InitialSpreadOptions& options) {
  if (options.random_starts < 0 || !(options.factor > 0) || !(options.same > 0))
    throw InputError(
        fmt::format("a spread over initial conditions needs a positive size of starts ({}), a positive share of "
                    "sameness ({}) and no negative number of starts ({})",
                    options.factor, options.same, options.random_starts));
  const auto [system, problem, turning] = lumped_case(stage);
  const RandomStarts starts(system, problem, options.factor, options.seed);
  PointOptions point{.simulation = options.simulation, .motion = false};
  point.simulation.steady_state = SteadyState::time_integration;
  point.simulation.other_motions.starts = 0;  // the starts of the spread are its own
  InitialSpread spread;
  for (int i = 0; i <= options.random_starts; ++i) {
    if (i > 0) point.simulation.start = starts.draw(static_cast<std::uint64_t>(i));
    InitialStart start{.figures = evaluate_point(stage, point).figures};
    start.steady = start.figures.value("steady") == 1;
    if (start.steady) {
      const auto known = std::find_if(spread.starts.begin(), spread.starts.end(), [&](const InitialStart& other) {
        return other.steady && same_motion(start.figures, other.figures, options.same);
      });
      start.attractor = known != spread.starts.end() ? known->attractor : spread.attractors++;
    } else {
      ++spread.unsteady;
    }
    if (i == 0) spread.low = spread.high = start.figures;
    for (const auto& entry : start.figures.entries()) {
      if (std::isnan(entry.figure.value) || std::isnan(spread.low.value(entry.key))) continue;
      spread.low.set(entry.key, std::min(spread.low.value(entry.key), entry.figure.value));
      spread.high.set(entry.key, std::max(spread.high.value(entry.key), entry.figure.value));
    }
    spread.starts.push_back(std::move(start));
  }
  return spread;
}

}  // namespace annulus::dynamics
