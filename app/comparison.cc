#include "app/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/svg_plot.h"
#include "core/units.h"

namespace annulus::app {

namespace {

double largest_factor(const dynamics::MeshKindResult& kind, double& error) {
  double largest = 0;
  for (const auto& b : kind.branches) {
    if (b.dynamic_factor_max.value > largest) {
      largest = b.dynamic_factor_max.value;
      error = b.dynamic_factor_max.error;
    }
  }
  return largest;
}

double stiffness_range(const MeshResult& mesh) {
  double low = INFINITY, high = 0;
  for (int position = 0; position < mesh.table.positions(); ++position) {
    for (int phase = 0; phase < mesh.table.phases(); ++phase) {
      const double k = mesh.table.at(position, phase, static_cast<int>(mesh.nominal)).stiffness_secant;
      low = std::min(low, k);
      high = std::max(high, k);
    }
  }
  return (high - low) / mesh.mean_stiffness().value;
}

const Measured* find(const RingQuantity& quantity, const std::string& ring) {
  const auto found =
      std::find_if(quantity.rings.begin(), quantity.rings.end(), [&](const Measured& m) { return m.ring == ring; });
  return found == quantity.rings.end() ? nullptr : &*found;
}

std::string numbers_text(const RingQuantity& quantity) {
  auto sorted = quantity.rings;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Measured& a, const Measured& b) { return a.value > b.value; });
  std::string text;
  for (const auto& m : sorted) text += (text.empty() ? "" : " > ") + m.ring + " " + to_text(m.value, quantity.digits);
  return text;
}

/// Outcome of "a is larger than b": undecided when the error bars overlap.
Verdict::Outcome larger(const Measured& a, const Measured& b) {
  if (std::abs(a.value - b.value) <= a.error + b.error) return Verdict::Outcome::undecided;
  return a.value > b.value ? Verdict::Outcome::agrees : Verdict::Outcome::disagrees;
}

void worsen(Verdict& verdict, const Measured& a, const Measured& b, int digits) {
  const auto outcome = larger(a, b);
  if (outcome == Verdict::Outcome::agrees) return;
  const bool wrong = outcome == Verdict::Outcome::disagrees;
  verdict.why += (verdict.why.empty() ? "" : "; ") +
                 fmt::format("'{}' ({}) is {} '{}' ({})", a.ring, to_text(a.value, digits),
                             wrong ? "below" : "within the error bars of", b.ring, to_text(b.value, digits));
  if (wrong || verdict.outcome == Verdict::Outcome::disagrees) {
    verdict.outcome = Verdict::Outcome::disagrees;
  } else {
    verdict.outcome = Verdict::Outcome::undecided;
  }
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
      ". The ring mesh brings only a part of the compliance of a planet's path ({}); the path stiffnesses of the rings "
      "lie {:.1f} % apart, "
      "planet bearings and error phases, which are not published, weigh more",
      parts, 100 * (range.high / range.low - 1));
}

Verdict judge(const Reference::Order& order, const RingQuantity& quantity, const RunResult& result) {
  Verdict verdict{.statement = order.statement,
                  .where = order.where,
                  .quantity = quantity.name,
                  .computed = numbers_text(quantity),
                  .published = {},
                  .outcome = Verdict::Outcome::agrees,
                  .why = {}};
  for (std::size_t i = 0; i < order.rings.size(); ++i) {
    verdict.published +=
        (i ? " > " : "") + order.rings[i] + (order.values.empty() ? "" : " " + to_text(order.values[i], 5));
    if (find(quantity, order.rings[i])) continue;
    verdict.outcome = Verdict::Outcome::undecided;
    verdict.why = "ring '" + order.rings[i] + "' is not part of this run";
    return verdict;
  }
  if (order.rings.size() == 1) {
    const auto* first = find(quantity, order.rings.front());
    for (const auto& other : quantity.rings) {
      if (other.ring != first->ring) worsen(verdict, *first, other, quantity.digits);
    }
  }
  for (std::size_t i = 0; i + 1 < order.rings.size(); ++i) {
    worsen(verdict, *find(quantity, order.rings[i]), *find(quantity, order.rings[i + 1]), quantity.digits);
  }
  if (verdict.outcome != Verdict::Outcome::agrees && order.quantity == "load_sharing")
    verdict.why += sharing_reason(result);
  return verdict;
}

Verdict judge_pin(const Reference::AtPin& statement, const RunResult& result) {
  Verdict verdict{.statement = statement.statement,
                  .where = statement.where,
                  .quantity = "ring mesh stiffness at a pin against between pins",
                  .computed = {},
                  .published = "stiffer at a pin",
                  .outcome = Verdict::Outcome::undecided,
                  .why = {}};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.rings[i];
    if (ring.name != statement.ring) continue;
    if (ring.mesh.model.positions < 2) {
      verdict.why = "this ring's stiffness does not depend on its position";
      return verdict;
    }
    const auto effect = pin_effect(result, i);
    verdict.computed = fmt::format("{:+.1f} % at a pin; stiffest {:+.1f} teeth from the nearest pin",
                                   100 * effect.relative(), effect.stiffest_teeth);
    const double error = ring.mesh.mean_stiffness().error_relative;
    if (std::abs(effect.relative()) > error) {
      verdict.outcome = effect.relative() > 0 ? Verdict::Outcome::agrees : Verdict::Outcome::disagrees;
    }
    if (verdict.outcome == Verdict::Outcome::disagrees) {
      verdict.why =
          "the line of force passes the rim some teeth away from the contact, so the stiffest place is not the pin "
          "itself";
    } else if (verdict.outcome == Verdict::Outcome::undecided) {
      verdict.why = "the difference is within the error bars";
    }
    return verdict;
  }
  verdict.why = "ring '" + statement.ring + "' is not part of this run";
  return verdict;
}

}  // namespace

std::vector<RingQuantity> ring_quantities(const RunResult& result) {
  std::vector<RingQuantity> list;
  const auto add = [&](const char* key, const char* name, int digits, auto value) {
    RingQuantity quantity{key, name, {}, digits};
    for (const auto& ring : result.rings) {
      if (auto m = value(ring); std::isfinite(m.value)) {
        m.ring = ring.name;
        quantity.rings.push_back(std::move(m));
      }
    }
    if (!quantity.rings.empty()) list.push_back(std::move(quantity));
  };
  const auto of = [](const Estimate& e) { return Measured{{}, e.value, std::abs(e.error_relative * e.value)}; };
  add("ring_stiffness", "mean ring mesh stiffness, N/m", 4,
      [&](const RingResult& r) { return of(r.mesh.mean_stiffness()); });
  add("stiffness_ripple", "range over mean of the ring mesh stiffness", 3, [&](const RingResult& r) {
    // Both ends of the range carry the stiffness error; the larger part of it is common to both.
    const double range = stiffness_range(r.mesh);
    return Measured{{}, range, range * r.mesh.lte_peak_to_peak().error_relative};
  });
  const auto sharing = [&](const char* name, auto pick) {
    add("load_sharing", name, 5, [&](const RingResult& r) {
      if (!r.response) return Measured{{}, NAN, 0};
      const dynamics::Figure f = pick(r.response->figures);
      return Measured{{}, f.value, f.error};
    });
  };
  sharing("load sharing, sun meshes, averaged over a mesh cycle",
          [](const auto& f) { return f.sun_planet.load_sharing.averaged; });
  sharing("load sharing, ring meshes, averaged over a mesh cycle",
          [](const auto& f) { return f.ring_planet.load_sharing.averaged; });
  sharing("load sharing, sun meshes, instantaneous",
          [](const auto& f) { return f.sun_planet.load_sharing.instantaneous; });
  sharing("load sharing, sun meshes, quasi-static",
          [](const auto& f) { return f.sun_planet.load_sharing.quasi_static; });
  const auto factor = [&](const char* name, auto pick) {
    add("dynamic_factor", name, 4, [&](const RingResult& r) {
      if (!r.response) return Measured{{}, NAN, 0};
      double error = 0;
      const double value = largest_factor(pick(r.response->figures), error);
      return Measured{{}, value, error};
    });
  };
  factor("dynamic factor, largest of all sun meshes", [](const auto& f) { return f.sun_planet; });
  factor("dynamic factor, largest of all ring meshes", [](const auto& f) { return f.ring_planet; });
  return list;
}

std::vector<Verdict> compare(const Reference& reference, const RunResult& result) {
  const auto quantities = ring_quantities(result);
  std::vector<Verdict> verdicts;
  for (const auto& order : reference.orders) {
    for (const auto& quantity : quantities) {
      if (quantity.key == order.quantity) verdicts.push_back(judge(order, quantity, result));
    }
  }
  for (const auto& statement : reference.at_pins) verdicts.push_back(judge_pin(statement, result));
  return verdicts;
}

PathStiffness path_stiffness(const RunResult& result, std::size_t ring) {
  const auto& set = result.geometry.rings.at(ring).set;
  const double sun = 1 / result.sun_mesh.mean_stiffness().value;
  const double mesh = 1 / result.rings.at(ring).mesh.mean_stiffness().value;
  const double as = set.sun_mesh().working_pressure_angle(), ar = set.ring_mesh().working_pressure_angle();
  const double lever = std::pow(std::cos(as) + std::cos(ar), 2) + std::pow(std::sin(as) - std::sin(ar), 2);
  const double bearing = std::isfinite(result.scene.supports.planet) ? lever / result.scene.supports.planet : 0;
  const double compliance = sun + mesh + bearing;
  return {1 / compliance, mesh / compliance, sun / compliance, bearing / compliance};
}

PinEffect pin_effect(const RunResult& result, std::size_t ring) {
  const auto& mesh = result.rings.at(ring).mesh;
  const auto& input = result.scene.rings.at(ring);
  const double pitch = 2 * std::numbers::pi / input.pins.value_or(1);
  const double tooth = 2 * std::numbers::pi / input.teeth;
  double at = 0, between = 0, stiffest = 0;
  int at_count = 0, between_count = 0;
  PinEffect effect;
  const auto& positions = mesh.positions;
  if (positions.rows.empty()) return {1, 1, 0};
  const auto angle_column = positions.column("ring_angle_deg"), load_column = positions.column("load_N");
  const auto lte_column = positions.column("lte_um"), unloaded_column = positions.column("unloaded_te_um");
  const auto phase_column = positions.column("mesh_phase");
  const double load = mesh.table.loads()[mesh.nominal];
  double cycle_sum = 0, cycle_angle = 0;
  int cycle_count = 0;
  const auto close_cycle = [&] {
    if (cycle_count > 0 && cycle_sum / cycle_count > stiffest) {
      stiffest = cycle_sum / cycle_count;
      effect.stiffest_teeth =
          std::remainder(cycle_angle / cycle_count - input.first_pin_angle.value_or(0), pitch) / tooth;
    }
    cycle_sum = cycle_angle = cycle_count = 0;
  };
  for (const auto& row : positions.rows) {
    if (row[load_column] != load || row[phase_column] >= 1) continue;
    const double angle = row[angle_column] * units::deg;
    const double k = load / ((row[lte_column] - row[unloaded_column]) * units::um);
    const double from_pin = std::remainder(angle - input.first_pin_angle.value_or(0), pitch);
    (std::abs(from_pin) < pitch / 4 ? at : between) += k;
    (std::abs(from_pin) < pitch / 4 ? at_count : between_count) += 1;
    if (row[phase_column] == 0) close_cycle();
    cycle_sum += k;
    cycle_angle += angle;
    ++cycle_count;
  }
  close_cycle();
  effect.at_pin = at / std::max(1, at_count);
  effect.between = between / std::max(1, between_count);
  return effect;
}

}  // namespace annulus::app
