#include "core/table_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus {

namespace {

/// Play that the lowest load has closed, m, of every position and phase: where all tangents there are more than four
/// times the secants. Flanks that come into contact stiffen by half of that. The tangents meet no force at the play.
std::vector<double> plays_of(const StiffnessTable& table) {
  constexpr double stiffened = 4;
  std::vector<double> plays;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase) {
      const auto& lowest = table.at(position, phase, 0);
      if (lowest.stiffness_tangent <= stiffened * lowest.stiffness_secant)
        return std::vector<double>(static_cast<std::size_t>(table.positions() * table.phases()), 0.0);
      plays.push_back(table.loads().front() * (1 / lowest.stiffness_secant - 1 / lowest.stiffness_tangent));
    }
  return plays;
}

/// The table with every entry replaced by `change(entry, load index, play)`, from every `step`-th phase.
template <class Change>
StiffnessTable changed(const StiffnessTable& table, int step, Change change) {
  const int loads = static_cast<int>(table.loads().size());
  const auto plays = plays_of(table);
  std::vector<StiffnessEntry> entries;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); phase += step)
      for (int load = 0; load < loads; ++load)
        entries.push_back(change(table.at(position, phase, load), load,
                                 plays[static_cast<std::size_t>(position) * static_cast<std::size_t>(table.phases()) +
                                       static_cast<std::size_t>(phase)]));
  StiffnessTable result(table.mesh(), table.phases() / step, table.ring_angles(), table.loads(), std::move(entries));
  result.provenance = table.provenance;
  return result;
}

enum class Way { stiffer, softer };

/// The elastic part of the deflection changes by its error, play stays: what the model leaves out of the stiffness it
/// leaves out of that part, and all else that is uncertain of the deflection is in it.
StiffnessEntry scaled(StiffnessEntry e, Way way, double play) {
  const double deflection = e.lte - e.unloaded_te, elastic = deflection - play;
  double error = e.error_relative;
  if (play > 0) error = e.error_parts.model + (error - e.error_parts.model) * deflection / elastic;
  // Dividing keeps the stiffness positive whatever the estimate.
  const double factor = way == Way::stiffer ? 1 + error : 1 / (1 + error), changed = play + elastic / factor;
  e.stiffness_secant *= play > 0 ? deflection / changed : factor;
  e.stiffness_tangent *= factor;
  e.lte = e.unloaded_te + changed;
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

/// How long a jump takes at a load, in distances between two phases; resolved from one on.
double jump_length(const StiffnessTable& table, std::size_t load, double uptake) {
  return uptake * std::sqrt(table.loads()[load]) * table.phases();
}

/// Parts of an interval: a jump is made within a 1024th of a mesh cycle, where that leaves a table of moderate size.
int parts_of_interval(const StiffnessTable& table) {
  constexpr int least = 2, of_a_cycle = 1024, of_a_period = 1 << 13;
  return std::max(least, std::min(of_a_cycle, of_a_period / table.positions()) / table.phases());
}

/// The curve through the values at `parts` times as many places.
Values finer(const Values& values, int phases, int parts) {
  const PeriodicCurve curve(values, phases);
  Values result;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int part = 0; part < parts; ++part)
      result.push_back(curve((static_cast<double>(i) + static_cast<double>(part) / parts) / phases));
  return result;
}

/// The same with the jumps of the values at one end of their intervals, `length` of an interval long.
Values finer_with_jumps(const Values& values, int phases, int parts, JumpSide side, double length) {
  Values result = finer(values, phases, parts);
  if (length >= 1) return result;
  const auto jumps = jumps_of(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double change = values[(i + 1) % values.size()] - values[i];
    if (jumps[i] == 0) continue;
    const bool at_once = (jumps[i] > 0) == (side == JumpSide::stiffer);
    for (int part = 1; part < parts; ++part) {
      const double t = static_cast<double>(part) / parts;
      const double taken = at_once ? (t < length ? t / length : 1) : (1 - t < length ? 1 - (1 - t) / length : 0);
      double& value = result[i * static_cast<std::size_t>(parts) + static_cast<std::size_t>(part)];
      // What is no jump goes on along the curve.
      value += jumps[i] / change * (values[i] + change * t - value) + jumps[i] * (taken - t);
    }
  }
  return result;
}

/// The table with the curves `values_of(load index, value of the entries)` at `phases` phases; without error estimates.
template <class ValuesOf>
StiffnessTable from_curves(const StiffnessTable& table, int phases, ValuesOf values_of) {
  const std::size_t loads = table.loads().size();
  std::vector<StiffnessEntry> entries(static_cast<std::size_t>(table.positions() * phases) * loads);
  for (std::size_t load = 0; load < loads; ++load) {
    const auto with = [&](double StiffnessEntry::*value) { return values_of(static_cast<int>(load), value); };
    const auto secant = with(&StiffnessEntry::stiffness_secant), tangent = with(&StiffnessEntry::stiffness_tangent),
               unloaded_te = with(&StiffnessEntry::unloaded_te);
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

void need_even_phases(const StiffnessTable& table) {
  if (table.phases() % 2)
    throw InputError(fmt::format("stiffness table {}: {} phases cannot be halved", table.mesh(), table.phases()));
}

}  // namespace

StiffnessTable stiffer(const StiffnessTable& table) {
  return changed(table, 1, [](const StiffnessEntry& e, int, double play) { return scaled(e, Way::stiffer, play); });
}

StiffnessTable more_rippled(const StiffnessTable& table) {
  std::vector<double> mean;
  for (std::size_t load = 0; load < table.loads().size(); ++load)
    mean.push_back(mean_of(over_phases(table, static_cast<int>(load), &StiffnessEntry::stiffness_secant)));
  return changed(table, 1, [&](const StiffnessEntry& e, int load, double play) {
    return scaled(e, e.stiffness_secant > mean[static_cast<std::size_t>(load)] ? Way::stiffer : Way::softer, play);
  });
}

StiffnessTable coarser(const StiffnessTable& table) {
  need_even_phases(table);
  return changed(table, 2, [](const StiffnessEntry& e, int, double) { return e; });
}

StiffnessTable through_odd_phases(const StiffnessTable& table) {
  need_even_phases(table);
  return from_curves(table, table.phases(), [&](int load, double StiffnessEntry::*value) {
    const auto given = over_phases(table, load, value);
    Values odd;
    for (std::size_t i = 1; i < given.size(); i += 2) odd.push_back(given[i]);
    const PeriodicCurve curve(odd, table.phases() / 2);
    Values values;
    for (std::size_t i = 0; i < given.size(); ++i)
      values.push_back(curve((static_cast<double>(i) - 1) / table.phases()));
    return values;
  });
}

StiffnessTable with_jumps(const StiffnessTable& table, JumpSide side, double uptake) {
  const int parts = parts_of_interval(table);
  return from_curves(table, parts * table.phases(), [&](int load, double StiffnessEntry::*value) {
    const auto given = over_phases(table, load, value);
    if (value == &StiffnessEntry::unloaded_te) return finer(given, table.phases(), parts);
    return finer_with_jumps(given, table.phases(), parts, side,
                            jump_length(table, static_cast<std::size_t>(load), uptake));
  });
}

double largest_jump(const StiffnessTable& table, double uptake) {
  double largest = 0;
  for (std::size_t load = 0; load < table.loads().size(); ++load) {
    if (jump_length(table, load, uptake) >= 1) continue;
    const auto values = over_phases(table, static_cast<int>(load), &StiffnessEntry::stiffness_secant);
    const double mean = mean_of(values);
    for (const double jump : jumps_of(values)) largest = std::max(largest, std::abs(jump) / mean);
  }
  return largest;
}

}  // namespace annulus
