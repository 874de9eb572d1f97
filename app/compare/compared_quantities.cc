#include "app/compare/compared_quantities.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace annulus::app {

std::vector<const ComparedVariant*> all_variants(const std::vector<ComparedRun>& runs) {
  std::vector<const ComparedVariant*> list;
  for (const auto& run : runs)
    for (const auto& variant : run.variants) list.push_back(&variant);
  return list;
}

std::vector<ComparedQuantity> compared_quantities(const std::vector<ComparedRun>& runs) {
  std::vector<ComparedQuantity> list;
  for (const auto& spec : *runs.front().specs) {
    if (!spec.compared) continue;
    ComparedQuantity compared{spec, {spec.quantity, spec.title, {}, spec.digits}};
    for (const auto* variant : all_variants(runs)) {
      const auto [value, error] = variant->figures.figure(spec.key);
      if (std::isfinite(value)) compared.quantity.rings.push_back({variant->name, value, error});
    }
    if (!compared.quantity.rings.empty()) list.push_back(std::move(compared));
  }
  return list;
}

RingQuantity in_unit(const ComparedQuantity& compared) {
  auto quantity = compared.quantity;
  if (!compared.spec.unit.empty()) quantity.name += ", " + compared.spec.unit;
  for (auto& m : quantity.rings) {
    m.value *= compared.spec.scale;
    m.error *= compared.spec.scale;
  }
  return quantity;
}

std::vector<std::string> difference_texts(const ComparedQuantity& compared) {
  const auto quantity = in_unit(compared);
  std::vector<std::string> texts;
  if (quantity.rings.size() < 2) return texts;
  const auto& first = quantity.rings.front();
  if (std::all_of(quantity.rings.begin(), quantity.rings.end(), [&](const Measured& m) { return same(first, m); }))
    return {"the same everywhere"};
  for (std::size_t i = 1; i < quantity.rings.size(); ++i)
    texts.push_back(difference_text(first, quantity.rings[i], quantity.digits));
  return texts;
}

std::vector<DifferingInput> differing_inputs(const std::vector<ComparedRun>& runs) {
  std::set<std::string> keys;
  for (const auto& run : runs) {
    if (!run.inputs_known) continue;
    for (const auto& variant : run.variants)
      for (const auto& [key, value] : variant.inputs) keys.insert(key);
  }
  std::vector<DifferingInput> list;
  for (const auto& key : keys) {
    DifferingInput input{key, {}};
    std::set<std::string> known;
    for (const auto& run : runs)
      for (const auto& variant : run.variants) {
        const auto found = variant.inputs.find(key);
        input.values.push_back(!run.inputs_known ? "?" : found == variant.inputs.end() ? "–" : found->second);
        if (run.inputs_known) known.insert(input.values.back());
      }
    if (known.size() > 1) list.push_back(std::move(input));
  }
  return list;
}

std::string unknown_inputs_text(const std::vector<ComparedRun>& runs) {
  std::string names;
  for (const auto& run : runs)
    if (!run.inputs_known) names += (names.empty() ? "" : ", ") + run.name;
  return names.empty() ? ""
                       : "The inputs are not known of " + names + ": an earlier version ran it; run its scene again.";
}

}  // namespace annulus::app
