#include "fem/contact/pair_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Number and planet roll length of the pairs within the path of contact and a base pitch beyond.
std::vector<std::pair<int, double>> candidate_pairs(const FlankContact& flanks, double phase) {
  const auto& pair = flanks.pair();
  const double pitch = pair.pinion().base_pitch();
  // Along the path the contact of a tooth moves from the planet's root to its tip in the ring mesh (planet drives) and
  // from tip to root in the sun mesh (sun drives).
  const double direction = pair.internal() ? 1 : -1;
  const double reference = pair.roll_length_pitch() + direction * phase * pitch;
  // Under load teeth meet before and after the theoretical path: look one base pitch beyond both its ends. The ends of
  // helical teeth are ahead of their middle, and behind it.
  const double ahead = std::abs(roll_per_z(flanks)) * pair.pinion().parameters().face_width / 2;
  const int first = static_cast<int>(std::ceil((pair.roll_length_low() - ahead - reference) / pitch - 1));
  const int last = static_cast<int>(std::floor((pair.roll_length_high() + ahead - reference) / pitch + 1));
  std::vector<std::pair<int, double>> pairs;
  for (int k = first; k <= last; ++k) {
    const double roll = reference + k * pitch;
    if (ahead > 0 || roll > 0) pairs.emplace_back(k, roll);
  }
  return pairs;
}

/// m, how far a theoretical contact stands before (negative) or behind the path of contact.
double beyond_path(const geometry::GearPair& pair, double roll) {
  return roll < pair.roll_length_low() ? roll - pair.roll_length_low() : std::max(0.0, roll - pair.roll_length_high());
}

/// Wherever flanks may face each other at a phase; domains and gaps are not looked for.
std::vector<FacingFlanks> facing_flanks(const ContactFace& face, int slices, double phase) {
  std::vector<FacingFlanks> result;
  for (const auto& [index, roll] : candidate_pairs(face.flanks(), phase)) {
    FacingFlanks facing;
    facing.pair = index;
    facing.pair_roll = facing.roll = roll;
    // The section of a helical gear turns along the face width, and the contact moves with it.
    if (!face.helical()) {
      facing.slices.resize(slices);
      std::iota(facing.slices.begin(), facing.slices.end(), 0);
      result.push_back(std::move(facing));
    } else {
      for (int s = 0; s < slices; ++s) {
        facing.roll = roll + face.slice_roll(s);
        facing.slices = {s};
        result.push_back(facing);
      }
    }
  }
  return result;
}

/// Domains and gaps of `all` as far as load may close them; returns the least gap without load, as transmission error,
/// m.
double find_gaps(const ContactFace& face, std::vector<FacingFlanks>& all, ToothPairs& setup) {
  const auto& pair = face.flanks().pair();
  std::vector<std::size_t> outwards(all.size());
  std::iota(outwards.begin(), outwards.end(), std::size_t{0});
  std::stable_sort(outwards.begin(), outwards.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(beyond_path(pair, all[a].roll)) < std::abs(beyond_path(pair, all[b].roll));
  });
  const double least_lead_gap = face.smallest_lead_gap();
  double least = std::numeric_limits<double>::infinity();
  bool apart_before = false, apart_behind = false;
  for (const std::size_t i : outwards) {
    auto& f = all[i];
    // Beyond either end of the path flanks get further apart all the way.
    const double beyond = beyond_path(pair, f.roll);
    if (beyond < 0 ? apart_before : beyond > 0 && apart_behind) continue;
    f.domain = face.flanks().domain(f.roll);
    if (f.domain.empty()) continue;
    f.centre_roll = face.flanks().nearest_roll(f.roll, f.domain);
    f.gap = face.normal_factor() * face.flanks().match(f.centre_roll, f.roll).gap;
    for (const int s : f.slices) least = std::min(least, gap_without_load(face, f, s));
    const double further = (f.gap + least_lead_gap) / face.normal_factor() - least;
    if (beyond == 0 || further <= setup.reach) continue;
    (beyond < 0 ? apart_before : apart_behind) = true;
    setup.nearest_left_out = std::min(setup.nearest_left_out, further);
  }
  require(std::isfinite(least), "no tooth pair faces another");
  return least;
}

}  // namespace

std::vector<std::pair<int, double>> possible_pairs(const FlankContact& flanks, double phase) {
  auto pairs = candidate_pairs(flanks, phase);
  const auto apart = [&](const auto& pair) { return roll_per_z(flanks) == 0 && flanks.domain(pair.second).empty(); };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), apart), pairs.end());
  require(!pairs.empty(), "no tooth pair faces another");
  return pairs;
}

void find_pairs(const ContactBodies& bodies, const PressureElements& elements, ToothPairs& setup) {
  auto all = facing_flanks(bodies.face, bodies.planet.slices(), setup.phase);
  const double least = find_gaps(bodies.face, all, setup);
  for (auto& f : all) {
    if (f.domain.empty()) continue;
    std::vector<int> near;
    for (const int s : f.slices) {
      const double further = gap_without_load(bodies.face, f, s) - least;
      if (further <= setup.reach)
        near.push_back(s);
      else
        setup.nearest_left_out = std::min(setup.nearest_left_out, further);
    }
    if (near.empty()) continue;
    f.slices = std::move(near);
    if (setup.pairs.empty() || setup.pairs.back().index != f.pair) {
      setup.pairs.emplace_back();
      setup.pairs.back().index = f.pair;
      setup.pairs.back().roll = f.pair_roll;
    }
    elements.add(setup.pairs.back(), f, setup.load, setup.window);
  }
  const auto empty = [](const ToothPair& p) { return p.elements.empty(); };
  setup.pairs.erase(std::remove_if(setup.pairs.begin(), setup.pairs.end(), empty), setup.pairs.end());
  for (auto& p : setup.pairs) {
    bodies.planet.find_weights(p.planet, p.index);
    bodies.wheel.find_weights(p.wheel, wheel_tooth(bodies.face.flanks(), p.index, 0));
  }
}

}  // namespace annulus::fem
