#include "app/systems/planetary/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/model/gear_system.h"
#include "app/report/plot/plots.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_supports.h"
#include "core/units.h"

namespace annulus::app {

namespace {

const Measured* find(const VariantQuantity& quantity, const std::string& ring) {
  const auto found = std::find_if(quantity.variants.begin(), quantity.variants.end(),
                                  [&](const Measured& m) { return m.variant == ring; });
  return found == quantity.variants.end() ? nullptr : &*found;
}

std::string numbers_text(const VariantQuantity& quantity) {
  auto sorted = quantity.variants;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Measured& a, const Measured& b) { return a.value > b.value; });
  std::string text;
  for (const auto& m : sorted)
    text += (text.empty() ? "" : " > ") + m.variant + " " + to_text(m.value, quantity.digits);
  return text;
}

/// "a is larger than b by this margin" agrees, or the verdict becomes worse: undecided when the error bars overlap or
/// are not known.
void worsen(Verdict& verdict, const Measured& a, const Measured& b, double margin, int digits) {
  const bool decided = told_apart(a, b), in_order = a.value > b.value;
  const double ahead = a.value / b.value - 1;
  if (decided && in_order && ahead >= margin) return;
  verdict.why += verdict.why.empty() ? "" : "; ";
  if (!decided) {
    verdict.why += undecided_text(a, b, digits);
    if (verdict.outcome == Verdict::Outcome::agrees) verdict.outcome = Verdict::Outcome::undecided;
    return;
  }
  const std::string values = both_text(a, b, digits);
  verdict.why +=
      in_order ? fmt::format("{} differ by only {:.2g} %", values, 100 * ahead) : values + " are in the opposite order";
  verdict.outcome = Verdict::Outcome::disagrees;
}

/// What stands behind a load sharing order, from the numbers: how far the rings' path stiffnesses are apart at all.
std::string sharing_reason(const RunResult& result) {
  std::string parts;
  RangeFinder totals;
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto path = path_stiffness(result, i);
    totals.add(path.total);
    parts += fmt::format("{}{} {:.0f} %", i ? ", " : "", result.rings[i].name, 100 * path.ring_part);
  }
  const auto range = totals.range(0);
  return fmt::format(
      ". The ring mesh is only a part of the compliance of a planet's path ({}). The path stiffnesses of the rings "
      "differ by {:.1f} %. Planet bearings and error phases have a larger effect and are not published",
      parts, 100 * (range.high / range.low - 1));
}

Verdict judge(const Reference::Order& order, const VariantQuantity& quantity, const RunResult& result) {
  Verdict verdict{.statement = order.statement,
                  .where = order.where,
                  .quantity = quantity.name,
                  .computed = numbers_text(quantity),
                  .published = {},
                  .outcome = Verdict::Outcome::agrees,
                  .why = {}};
  for (std::size_t i = 0; i < order.variants.size(); ++i) {
    verdict.published +=
        (i ? " > " : "") + order.variants[i] + (order.values.empty() ? "" : " " + to_text(order.values[i], 5));
    if (find(quantity, order.variants[i])) continue;
    verdict.outcome = Verdict::Outcome::undecided;
    verdict.why = "ring '" + order.variants[i] + "' is not part of this run";
    return verdict;
  }
  if (order.variants.size() == 1) {
    const auto* first = find(quantity, order.variants.front());
    for (const auto& other : quantity.variants) {
      if (other.variant != first->variant) worsen(verdict, *first, other, order.margin, quantity.digits);
    }
  }
  for (std::size_t i = 0; i + 1 < order.variants.size(); ++i) {
    worsen(verdict, *find(quantity, order.variants[i]), *find(quantity, order.variants[i + 1]), order.margin,
           quantity.digits);
  }
  if (verdict.outcome != Verdict::Outcome::agrees && order.quantity == "load_sharing")
    verdict.why += sharing_reason(result);
  return verdict;
}

/// Ring angle of the contact and stiffness at the nominal load, in order, the closure position left out.
std::vector<std::pair<double, double>> nominal_stiffness(const MeshResult& mesh) {
  const auto& csv = mesh.positions;
  const auto angle = csv.column("ring_angle_deg"), load = csv.column("load_N"), phase = csv.column("mesh_phase");
  const auto lte = csv.column("lte_um"), unloaded = csv.column("unloaded_te_um");
  const double nominal = mesh.table.loads()[mesh.nominal];
  std::vector<std::pair<double, double>> samples;
  for (const auto& row : csv.rows) {
    if (row[load] != nominal || row[phase] >= 1) continue;
    samples.emplace_back(row[angle] * units::deg, nominal / ((row[lte] - row[unloaded]) * units::um));
  }
  return samples;
}

/// Angle from the contact to the pin that carries the largest radial force, over all positions.
double most_loaded_pin(const Csv& pins) {
  const auto angle = pins.column("ring_angle_deg"), pin = pins.column("pin_angle_deg"),
             force = pins.column("radial_force_N");
  const auto largest = std::max_element(pins.rows.begin(), pins.rows.end(),
                                        [&](const auto& a, const auto& b) { return a[force] < b[force]; });
  return std::remainder(((*largest)[pin] - (*largest)[angle]) * units::deg, 2 * std::numbers::pi);
}

/// Mean of the samples within a quarter pitch of the places, over the mean of the others, less one.
double near_over_far(const std::vector<std::pair<double, double>>& samples, double place, double pitch) {
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  for (const auto& [angle, value] : samples) {
    const bool is_near = std::abs(std::remainder(angle - place, pitch)) < pitch / 4;
    (is_near ? near : far) += value;
    (is_near ? near_count : far_count) += 1;
  }
  return near_count && far_count ? (near / near_count) / (far / far_count) - 1 : 0;
}

/// Two readings of "at a pin": the contact itself passes a pin, or the pin that carries most stands in the path of
/// force.
std::vector<Verdict> judge_pin(const Reference::AtPin& statement, const RunResult& result) {
  Verdict verdict{.statement = statement.statement,
                  .where = statement.where,
                  .quantity = "ring mesh stiffness over the pin pitch",
                  .computed = {},
                  .published = "stiffer at a pin",
                  .outcome = Verdict::Outcome::undecided,
                  .why = {}};
  const auto found =
      std::find_if(result.rings.begin(), result.rings.end(), [&](const auto& r) { return r.name == statement.ring; });
  const auto effect = found == result.rings.end()
                          ? std::nullopt
                          : pin_effect(result, static_cast<std::size_t>(found - result.rings.begin()));
  if (!effect) {
    verdict.why = found == result.rings.end() ? "ring '" + statement.ring + "' is not part of this run"
                                              : "the stiffness of this ring was not computed over its pins";
    return {verdict};
  }
  const auto reading = [&](const char* quantity, double relative, std::string computed) {
    verdict.quantity = quantity;
    verdict.computed = fmt::format("{:+.1f} % {}", 100 * relative, computed);
    verdict.outcome = std::abs(relative) <= found->mesh.mean_stiffness().error_relative ? Verdict::Outcome::undecided
                      : relative > 0                                                    ? Verdict::Outcome::agrees
                                                                                        : Verdict::Outcome::disagrees;
    return verdict;
  };
  const auto force = reading(
      "ring mesh stiffness with a pin in the path of the force, compared with between pins", effect->force_at_pin,
      fmt::format("with a pin {:+.1f} teeth from the contact, where the force on a pin is largest",
                  effect->loaded_pin_teeth));
  auto contact = reading(
      "ring mesh stiffness with the contact at a pin, compared with between pins", effect->contact_at_pin,
      fmt::format("at a pin; stiffest with the contact {:+.1f} teeth from the nearest pin", effect->stiffest_teeth));
  if (contact.outcome != Verdict::Outcome::agrees)
    contact.why = fmt::format(
        "the force does not reach the housing directly behind the contact: the most loaded pin is {:+.1f} teeth from "
        "it",
        effect->loaded_pin_teeth);
  return {force, contact};
}

}  // namespace

std::vector<VariantQuantity> ring_quantities(const RunResult& result) {
  // The definitions that are compared with published statements, the usual one first.
  constexpr const char* keys[] = {"ring_planet_mean_stiffness_N_per_m",
                                  "ring_planet_stiffness_ripple",
                                  "sun_planet_load_sharing_averaged",
                                  "ring_planet_load_sharing_averaged",
                                  "sun_planet_load_sharing_instantaneous",
                                  "sun_planet_load_sharing_quasi_static",
                                  "sun_planet_dynamic_factor",
                                  "ring_planet_dynamic_factor",
                                  "sun_planet_peak_factor",
                                  "ring_planet_peak_factor"};
  const auto& specs = system_kind(result.scene.stage.kind).figures();
  const auto variants = result.variants();
  std::vector<VariantQuantity> list;
  for (const auto* key : keys) {
    const auto* spec = find_figure(specs, key);
    VariantQuantity quantity{spec->quantity, spec->title, {}, spec->digits};
    for (const auto& variant : variants) {
      const auto* entry = variant.figures.find(key);
      if (entry && std::isfinite(entry->figure.value))
        quantity.variants.push_back({variant.name, entry->figure.value, entry->figure.error, entry->spread});
    }
    if (!quantity.variants.empty()) list.push_back(std::move(quantity));
  }
  return list;
}

std::vector<Verdict> compare(const Reference& reference, const RunResult& result) {
  const auto quantities = ring_quantities(result);
  std::vector<Verdict> verdicts;
  for (const auto& order : reference.orders)
    for (const auto& quantity : quantities)
      if (quantity.key == order.quantity) verdicts.push_back(judge(order, quantity, result));
  for (const auto& statement : reference.at_pins)
    for (auto& verdict : judge_pin(statement, result)) verdicts.push_back(std::move(verdict));
  return verdicts;
}

PathStiffness path_stiffness(const RunResult& result, std::size_t ring) {
  const auto& set = result.geometry.rings.at(ring).set;
  const double sun = 1 / result.sun_mesh.mean_stiffness().value;
  const double mesh = 1 / result.rings.at(ring).mesh.mean_stiffness().value;
  const double bearing = bearing_compliance(result.scene, set, result.geometry.operating_point.mean_mesh_force);
  const double compliance = sun + mesh + bearing;
  return {1 / compliance, mesh / compliance, sun / compliance, bearing / compliance};
}

std::optional<PinEffect> pin_effect(const RunResult& result, std::size_t ring) {
  const auto& mesh = result.rings.at(ring).mesh;
  const auto& input = planetary(result.scene).rings.at(ring);
  if (!input.pins || mesh.positions.rows.empty() || mesh.pins.rows.empty()) return std::nullopt;
  const double pitch = 2 * std::numbers::pi / *input.pins, tooth = 2 * std::numbers::pi / input.teeth;
  const double first_pin = input.first_pin_angle.value_or(0);

  PinEffect effect;
  const auto loaded_pin = most_loaded_pin(mesh.pins);
  effect.loaded_pin_teeth = loaded_pin / tooth;
  const auto samples = nominal_stiffness(mesh);
  effect.contact_at_pin = near_over_far(samples, first_pin, pitch);
  effect.force_at_pin = near_over_far(samples, first_pin - loaded_pin, pitch);
  // Means over one tooth pitch take out the ripple of the teeth themselves.
  const auto per_cycle = static_cast<std::size_t>(mesh.table.phases());
  double stiffest = 0;
  for (std::size_t i = 0; i + per_cycle <= samples.size(); ++i) {
    double sum = 0, angle = 0;
    for (std::size_t k = i; k < i + per_cycle; ++k) {
      sum += samples[k].second;
      angle += samples[k].first / static_cast<double>(per_cycle);
    }
    if (sum <= stiffest) continue;
    stiffest = sum;
    effect.stiffest_teeth = std::remainder(angle - first_pin, pitch) / tooth;
  }
  return effect;
}

}  // namespace annulus::app
