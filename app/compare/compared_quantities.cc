#include "app/compare/compared_quantities.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/sections/report_parts.h"

namespace annulus::app {

namespace {

std::vector<const ComparedVariant*> all_variants(const std::vector<ComparedRun>& runs) {
  std::vector<const ComparedVariant*> list;
  for (const auto& run : runs)
    for (const auto& variant : run.variants) list.push_back(&variant);
  return list;
}

ComparedQuantity quantity_of(const FigureSpec& declared, const std::vector<const ComparedVariant*>& variants) {
  std::vector<double> values;
  values.reserve(variants.size());
  for (const auto* variant : variants) values.push_back(variant->figures.value(declared.key));
  const auto spec = in_readable_unit(declared, values);
  ComparedQuantity compared{.spec = spec, .si = {spec.quantity, spec.title, {}, spec.digits}};
  compared.shown = compared.si;
  if (!spec.unit.empty()) compared.shown.name += ", " + spec.unit;
  for (const auto* variant : variants) {
    const auto* entry = variant->figures.find(spec.key);
    const auto spread = entry ? entry->spread : std::nullopt;
    compared.has_spread |= spread.has_value();
    compared.spreads.push_back(spread ? spread_text(*spread, spec.scale) : "–");
    const auto [value, error] = variant->figures.figure(spec.key);
    if (!std::isfinite(value)) {
      compared.cells.emplace_back("–");
      continue;
    }
    Measured shown{variant->name, value * spec.scale, error * spec.scale};
    if (spread) shown.spread = spread->scaled(spec.scale);
    compared.cells.push_back(measured(shown.value, shown.error));
    compared.si.variants.push_back({variant->name, value, error, spread});
    compared.shown.variants.push_back(shown);
  }
  const auto& shown = compared.shown.variants;
  if (shown.size() < 2) return compared;
  if (std::all_of(shown.begin(), shown.end(), [&](const Measured& m) { return same(shown.front(), m); })) {
    compared.differences = {"the same everywhere"};
  } else {
    for (std::size_t i = 1; i < shown.size(); ++i)
      compared.differences.push_back(difference_text(shown.front(), shown[i], spec.digits));
  }
  return compared;
}

}  // namespace

Comparison::Comparison(const std::vector<ComparedRun>& runs) : inputs(differing_inputs(runs)) {
  const auto all = all_variants(runs);
  for (const auto* variant : all) variants.push_back(variant->name);
  for (const auto& spec : *runs.front().specs) {
    if (!spec.compared) continue;
    auto compared = quantity_of(spec, all);
    if (!compared.si.variants.empty()) quantities.push_back(std::move(compared));
  }
}

std::vector<DifferingInput> differing_inputs(const std::vector<ComparedRun>& runs) {
  std::set<std::string> keys;
  for (const auto& run : runs)
    for (const auto& variant : run.variants)
      for (const auto& [key, value] : variant.inputs) keys.insert(key);
  std::vector<DifferingInput> list;
  for (const auto& key : keys) {
    DifferingInput input{key, {}};
    std::set<std::string> known;
    for (const auto& run : runs)
      for (const auto& variant : run.variants) {
        const auto found = variant.inputs.find(key);
        input.values.push_back(found == variant.inputs.end() ? "–" : found->second);
        known.insert(input.values.back());
      }
    if (known.size() > 1) list.push_back(std::move(input));
  }
  return list;
}

}  // namespace annulus::app
