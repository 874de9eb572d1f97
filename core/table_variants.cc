#include "core/table_variants.h"

#include <fmt/format.h>

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

}  // namespace

StiffnessTable stiffer(const StiffnessTable& table) {
  return changed(table, 1, [](const StiffnessEntry& e, int) { return scaled(e, 1 + e.error_relative); });
}

StiffnessTable more_rippled(const StiffnessTable& table) {
  std::vector<double> mean(table.loads().size(), 0.0);
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase)
      for (std::size_t load = 0; load < mean.size(); ++load)
        mean[load] +=
            table.at(position, phase, static_cast<int>(load)).stiffness_secant / (table.positions() * table.phases());
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

}  // namespace annulus
