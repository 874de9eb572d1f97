#include "core/table_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/errors.h"

namespace annulus {

namespace {

/// The table with every entry replaced by `change(entry, load index)`, from every `step`-th phase.
template <class Change>
StiffnessTable changed(const StiffnessTable& table, int step, Change change) {
  const int loads = static_cast<int>(table.loads().size());
  std::vector<StiffnessEntry> entries;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); phase += step)
      for (int load = 0; load < loads; ++load) entries.push_back(change(table.at(position, phase, load), load));
  StiffnessTable result(table.mesh(), table.phases() / step, table.ring_angles(), table.loads(), std::move(entries));
  result.provenance = table.provenance;
  return result;
}

StiffnessEntry scaled(StiffnessEntry e, double factor) {
  e.stiffness_secant *= factor;
  e.stiffness_tangent *= factor;
  e.lte = e.unloaded_te + (e.lte - e.unloaded_te) / factor;
  return e;
}

using Values = std::vector<double>;

/// What one kind of value of the entries does over all phases of all positions, at one load.
Values over_phases(const StiffnessTable& table, int load, double StiffnessEntry::*value) {
  Values values;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase) values.push_back(table.at(position, phase, load).*value);
  return values;
}

double mean_of(const Values& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// By how much every value jumps to the next one: the change less what the changes before and after it have in common
/// with it.
Values jumps_of(const Values& values) {
  const std::size_t n = values.size();
  const auto change = [&](std::size_t i) { return values[(i + 1) % n] - values[i % n]; };
  Values jumps(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double here = change(i), sign = here < 0 ? -1 : 1;
    const double common = std::min(sign * change(i + n - 1), sign * change(i + 1));
    jumps[i] = sign * std::max(0.0, std::abs(here) - std::max(0.0, common));
  }
  return jumps;
}

/// Parts of an interval: a jump is made within a 1024th of a mesh cycle, where that leaves a table of moderate size.
int parts_of_interval(const StiffnessTable& table) {
  constexpr int least = 4, of_a_cycle = 1024, of_a_period = 1 << 15;
  return std::max(least, std::min(of_a_cycle, of_a_period / table.positions()) / table.phases());
}

/// The curve through the values at `parts` times as many places, with its jumps at the ends of their intervals that
/// `side` names, if any.
Values finer(const Values& values, int phases, int parts, std::optional<JumpSide> side) {
  const PeriodicCurve curve(values, phases);
  const auto jumps = side ? jumps_of(values) : Values(values.size(), 0.0);
  Values result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double here = values[i], change = values[(i + 1) % values.size()] - here;
    const double share = change == 0 ? 0 : jumps[i] / change;
    const double taken = (jumps[i] > 0) == (side == JumpSide::stiffer) ? 1 : 0;  // of the jump, behind its first end
    result.push_back(here);
    for (int part = 1; part < parts; ++part) {
      const double t = static_cast<double>(part) / parts;
      const double smooth = curve((static_cast<double>(i) + t) / phases);
      result.push_back(smooth + share * (here + change * t - smooth) + jumps[i] * (taken - t));
    }
  }
  return result;
}

}  // namespace

StiffnessTable stiffer(const StiffnessTable& table) {
  return changed(table, 1, [](const StiffnessEntry& e, int) { return scaled(e, 1 + e.error_relative); });
}

StiffnessTable more_rippled(const StiffnessTable& table) {
  std::vector<double> mean;
  for (std::size_t load = 0; load < table.loads().size(); ++load)
    mean.push_back(mean_of(over_phases(table, static_cast<int>(load), &StiffnessEntry::stiffness_secant)));
  return changed(table, 1, [&](const StiffnessEntry& e, int load) {
    // Dividing keeps the stiffness positive whatever the estimate.
    const double up = 1 + e.error_relative;
    return scaled(e, e.stiffness_secant > mean[static_cast<std::size_t>(load)] ? up : 1 / up);
  });
}

StiffnessTable coarser(const StiffnessTable& table) {
  if (table.phases() % 2)
    throw InputError(fmt::format("stiffness table {}: {} phases cannot be halved", table.mesh(), table.phases()));
  return changed(table, 2, [](const StiffnessEntry& e, int) { return e; });
}

StiffnessTable with_jumps(const StiffnessTable& table, JumpSide side) {
  const std::size_t loads = table.loads().size();
  const int parts = parts_of_interval(table), phases = parts * table.phases();
  std::vector<StiffnessEntry> entries(static_cast<std::size_t>(table.positions() * phases) * loads);
  for (std::size_t load = 0; load < loads; ++load) {
    const auto values = [&](double StiffnessEntry::*value, bool jumps) {
      return finer(over_phases(table, static_cast<int>(load), value), table.phases(), parts,
                   jumps ? std::optional(side) : std::nullopt);
    };
    const auto secant = values(&StiffnessEntry::stiffness_secant, true);
    const auto tangent = values(&StiffnessEntry::stiffness_tangent, true);
    const auto unloaded_te = values(&StiffnessEntry::unloaded_te, false);
    for (std::size_t i = 0; i < secant.size(); ++i)
      entries[i * loads + load] = {.unloaded_te = unloaded_te[i],
                                   .lte = unloaded_te[i] + table.loads()[load] / secant[i],
                                   .stiffness_secant = secant[i],
                                   .stiffness_tangent = tangent[i]};
  }
  StiffnessTable result(table.mesh(), phases, table.ring_angles(), table.loads(), std::move(entries));
  result.provenance = table.provenance;
  return result;
}

double largest_jump(const StiffnessTable& table) {
  double largest = 0;
  for (int load = 0; load < static_cast<int>(table.loads().size()); ++load) {
    const auto values = over_phases(table, load, &StiffnessEntry::stiffness_secant);
    const double mean = mean_of(values);
    for (const double jump : jumps_of(values)) largest = std::max(largest, std::abs(jump) / mean);
  }
  return largest;
}

}  // namespace annulus
