#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/sections/report_parts.h"

namespace annulus::app {

namespace {

const VariantQuantity* quantity(const std::vector<VariantQuantity>& list, const std::string& key) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const VariantQuantity& q) { return q.key == key; });
  return found == list.end() ? nullptr : &*found;
}

std::vector<Measured> sorted(const VariantQuantity& q) {
  auto variants = q.variants;
  std::stable_sort(variants.begin(), variants.end(),
                   [](const Measured& a, const Measured& b) { return a.likely() > b.likely(); });
  return variants;
}

Text stiffness_sentence(const VariantQuantity& q) {
  const auto variants = sorted(q);
  const auto& stiffest = variants.front();
  const auto value = measured_in_unit({stiffest.value, stiffest.error}, shown_units::stiffness);
  if (variants.size() < 2) return phrase("{}: {}.", q.name, value);
  if (same(variants.back(), stiffest)) return phrase("{}: {} everywhere.", q.name, value);
  std::vector<Text> others;
  for (std::size_t i = 1; i < variants.size(); ++i)
    others.push_back(bold(variants[i].variant) + " is " +
                     (same(variants[i], stiffest)
                          ? "as stiff"
                          : fmt::format("{:.1f} % softer", 100 * (1 - variants[i].value / stiffest.value))));
  return phrase("{}: {} is the stiffest ({}); {}.", q.name, bold(stiffest.variant), value, enumerated(others));
}

/// Of results over samples: what to expect, before what the nominal inputs give.
Text spread_sentence(const std::vector<Measured>& variants) {
  std::vector<Text> words;
  for (const auto& r : variants) {
    const Text with_variant = variants.size() > 1 ? " with " + bold(r.variant) : Text();
    words.push_back(r.spread ? phrase("{}{}", spread_text(*r.spread, 1), with_variant)
                             : measured(r.value, r.error) + with_variant);
  }
  std::vector<Text> nominal;
  nominal.reserve(variants.size());
  for (const auto& r : variants) nominal.emplace_back(measured(r.value, r.error));
  return phrase("{} (median, 5 % to 95 % of the samples); {} with the nominal inputs.", enumerated(words),
                enumerated(nominal));
}

Text sharing_sentence(const VariantQuantity& q) {
  const auto variants = sorted(q);
  const auto &low = variants.back(), &high = variants.front();
  const Text head = q.name + ": ";
  if (high.spread) return head + spread_sentence(variants);
  if (variants.size() == 1) return head + measured(high.value, high.error) + ".";
  return head +
         phrase("the most loaded planet carries {:.1f} % more than its share with {} and {:.1f} % with {}",
                100 * (low.value - 1), bold(low.variant), 100 * (high.value - 1), bold(high.variant)) +
         (!std::isfinite(high.error + low.error) ? "; the error is not known."
          : told_apart(high, low)                ? "."
                                                 : "; the difference is within the error bars.");
}

Text factor_sentence(const VariantQuantity& q) {
  const auto variants = sorted(q);
  if (variants.front().spread) return q.name + ": " + spread_sentence(variants);
  std::vector<Text> words;
  words.reserve(variants.size());
  for (const auto& r : variants)
    words.push_back(measured(r.value, r.error) + (variants.size() > 1 ? " with " + bold(r.variant) : Text()));
  return phrase("{}: {}.", q.name, enumerated(words));
}

}  // namespace

Blocks answer_sentences(const std::vector<VariantQuantity>& quantities) {
  Blocks blocks;
  for (const auto& q : quantities)
    if (q.key.ends_with("_stiffness")) blocks += paragraph(stiffness_sentence(q));
  if (const auto* q = quantity(quantities, "load_sharing")) blocks += paragraph(sharing_sentence(*q));
  for (const auto* key : {"dynamic_factor", "peak_factor"})
    if (const auto* q = quantity(quantities, key)) blocks += paragraph(factor_sentence(*q));
  return blocks;
}

Blocks answer_picture(const std::vector<VariantQuantity>& quantities, const std::vector<std::string>& names) {
  bool sampled = false;
  constexpr double letter = 6;
  double longest = 0;
  for (const auto& name : names) longest = std::max(longest, letter * static_cast<double>(name.size() + 18));
  const int label_width = std::max(220, static_cast<int>(longest));
  BarChart chart{.title = "Above the ideal, %",
                 .x_label = "%",
                 .width = 420 + label_width,
                 .label_width = label_width,
                 .row_height = 22};
  for (const auto& [key, name] : {std::pair{"load_sharing", "load sharing K_γ"},
                                  {"dynamic_factor", "dynamic factor K_V"},
                                  {"peak_factor", "peak factor K_γ K_V"}}) {
    const auto* q = quantity(quantities, key);
    if (q == nullptr) continue;
    for (const auto& m : q->variants) {
      if (!std::isfinite(m.value)) continue;
      const auto above = [](double x) { return 100 * (x - 1); };
      auto& bar = chart.bars.emplace_back(BarChart::Bar{
          .label = std::string(name) + ", " + m.variant,
          .value = above(m.likely()),
          .colour = static_cast<std::size_t>(std::find(names.begin(), names.end(), m.variant) - names.begin()),
          .note = fmt::format("{:.3g} %", above(m.likely())),
          .error = 100 * m.error});
      if (!m.spread) continue;
      bar.spread = Range{above(m.spread->low), above(m.spread->high)};
      bar.nominal = above(m.value);
      sampled = true;
    }
  }
  if (chart.bars.empty()) return {};
  const std::string whiskers = sampled ? "Bars: median of the samples. Whiskers: 5 % to 95 %. Diamonds: nominal inputs."
                                       : "Whiskers: estimated numerical error.";
  return Pictures{
      {chart},
      {},
      "Load sharing: excess of the most loaded planet over its share. Dynamic factor: excess of the largest force over "
      "the mean force of its mesh cycle. Peak factor: excess of the largest force over the nominal force. " +
          whiskers};
}

}  // namespace annulus::app
