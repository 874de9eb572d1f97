#include "fem/contact/pair_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// m, by how much the ends of helical teeth are ahead of their middle, and behind it.
double ahead_of_middle(const FlankContact& flanks) {
  return std::abs(roll_per_z(flanks)) * flanks.pair().common_face().width / 2;
}

/// Number and pinion roll length of the pairs within a range.
std::vector<std::pair<int, double>> pairs_within(const FlankContact& flanks, const PairRange& range, double phase) {
  const auto& pair = flanks.pair();
  const double pitch = pair.pinion().base_pitch(), ahead = ahead_of_middle(flanks);
  // Along the path the contact of a tooth moves from the root of the driving gear to its tip.
  const double direction = pair.driver() == geometry::GearRole::pinion ? 1 : -1;
  const double reference = pair.roll_length_pitch() + direction * phase * pitch;
  const int first = static_cast<int>(std::ceil((range.low - ahead - reference) / pitch));
  const int last = static_cast<int>(std::floor((range.high + ahead - reference) / pitch));
  std::vector<std::pair<int, double>> pairs;
  for (int k = first; k <= last; ++k) pairs.emplace_back(k, reference + k * pitch);
  return pairs;
}

/// m, how far a theoretical contact stands before (negative) or behind the path of contact.
double beyond_path(const geometry::GearPair& pair, double roll) {
  return roll < pair.roll_length_low() ? roll - pair.roll_length_low() : std::max(0.0, roll - pair.roll_length_high());
}

/// Wherever flanks may face each other; domains and gaps are not looked for.
std::vector<FacingFlanks> facing_flanks(const ContactFace& face, int slices,
                                        const std::vector<std::pair<int, double>>& pairs) {
  std::vector<FacingFlanks> result;
  for (const auto& [index, roll] : pairs) {
    FacingFlanks facing;
    facing.pair = index;
    facing.pair_roll = facing.roll = roll;
    // The section of a helical gear turns along the face width, and the contact moves with it; measured flanks have
    // another profile in every slice.
    if (!face.varies()) {
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

bool is_added(const ToothPairs& setup, int pair, const std::vector<int>& slices) {
  return std::any_of(slices.begin(), slices.end(), [&](int s) { return setup.added.count({pair, s}) > 0; });
}

/// Domains and gaps of `all`; returns the least gap without load, as transmission error, m. Beyond the first flanks out
/// of reach the domain stays empty, and the gap is that of those nearer ones. Those that do not face each other are
/// taken out.
double find_gaps(const ContactFace& face, std::vector<FacingFlanks>& all, const ToothPairs& setup) {
  const auto& pair = face.flanks().pair();
  std::vector<std::size_t> outwards(all.size());
  std::iota(outwards.begin(), outwards.end(), std::size_t{0});
  std::stable_sort(outwards.begin(), outwards.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(beyond_path(pair, all[a].roll)) < std::abs(beyond_path(pair, all[b].roll));
  });
  const double least_lead_gap = face.smallest_lead_gap();
  double least = std::numeric_limits<double>::infinity();
  std::optional<double> apart_before, apart_behind;
  for (const std::size_t i : outwards) {
    auto& f = all[i];
    // Beyond either end of the path flanks get further apart all the way, unless they are measured ones.
    const auto* measured = face.measured(f.slices.front());
    const double beyond = beyond_path(pair, f.roll);
    auto& apart = beyond < 0 ? apart_before : apart_behind;
    if (beyond != 0 && apart && !is_added(setup, f.pair, f.slices)) {
      f.gap = *apart;
      if (!face.flanks().face_each_other(f.roll)) f.slices.clear();
      continue;
    }
    f.domain = face.flanks().domain(f.roll);
    if (f.domain.empty()) {
      f.slices.clear();
      continue;
    }
    f.centre_roll = face.flanks().nearest_roll(f.roll, f.domain, measured);
    const auto nearest = face.flanks().match(f.centre_roll, f.roll, measured);
    f.gap = face.normal_factor() * nearest.gap;
    for (const int s : f.slices) f.gap -= face.measured_dip(s, f.centre_roll, nearest.wheel_roll);
    for (const int s : f.slices) least = std::min(least, gap_without_load(face, f, s));
    if (beyond != 0 && measured == nullptr && !apart &&
        (f.gap + least_lead_gap) / face.normal_factor() - least > setup.reach)
      apart = f.gap;
  }
  require(std::isfinite(least), "no tooth pair faces another");
  all.erase(std::remove_if(all.begin(), all.end(), [](const auto& f) { return f.slices.empty(); }), all.end());
  return least;
}

}  // namespace

PairRange pitch_beyond_path(const FlankContact& flanks) {
  const auto& pair = flanks.pair();
  const double pitch = pair.pinion().base_pitch(), ahead = ahead_of_middle(flanks);
  PairRange range{pair.roll_length_low() - pitch, pair.roll_length_high() + pitch,
                  std::numeric_limits<double>::infinity()};
  // Unless the ends of helical teeth are ahead: they may have no contact of involutes there.
  if (ahead == 0) range.low = std::max(range.low, std::numeric_limits<double>::min());
  for (const double end : {range.low - ahead, range.high + ahead})
    if (const auto domain = flanks.domain(end); !domain.empty())
      range.gap_beyond = std::min(range.gap_beyond, flanks.match(flanks.nearest_roll(end, domain), end).gap);
  return range;
}

PairRange within_gap(const FlankContact& flanks, double gap) {
  const auto& pair = flanks.pair();
  const double step = pair.pinion().base_pitch() / 4;
  const auto faces = [&](double roll) {
    const auto domain = flanks.domain(roll);
    return !domain.empty() && flanks.match(flanks.nearest_roll(roll, domain), roll).gap <= gap;
  };
  PairRange range{pair.roll_length_low(), pair.roll_length_high(), gap};
  const int most = 2 * pair.pinion().teeth();  // half a turn to either side
  for (int i = 0; i < most && faces(range.low); ++i) range.low -= step;
  for (int i = 0; i < most && faces(range.high); ++i) range.high += step;
  return range;
}

PairRange possible_contacts(const FlankContact& flanks) {
  constexpr double largest_approach = 0.5;  // modules
  return within_gap(flanks, largest_approach * flanks.pair().pinion().parameters().module);
}

int most_pairs_in(const PairRange& range, const FlankContact& flanks) {
  const double pitch = flanks.pair().pinion().base_pitch();
  return static_cast<int>(std::floor((range.high - range.low + 2 * ahead_of_middle(flanks)) / pitch)) + 1;
}

std::vector<std::pair<int, double>> possible_pairs(const FlankContact& flanks, double phase) {
  auto pairs = pairs_within(flanks, pitch_beyond_path(flanks), phase);
  const auto apart = [&](const auto& pair) { return roll_per_z(flanks) == 0 && flanks.domain(pair.second).empty(); };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), apart), pairs.end());
  require(!pairs.empty(), "no tooth pair faces another");
  return pairs;
}

void find_pairs(const ContactBodies& bodies, const PressureElements& elements, const PairRange& range,
                ToothPairs& setup) {
  auto all = facing_flanks(bodies.face, bodies.pinion.slices(), pairs_within(bodies.face.flanks(), range, setup.phase));
  const double least = find_gaps(bodies.face, all, setup);
  setup.first_pair = all.front().pair;
  setup.last_pair = all.back().pair;
  for (auto& f : all) {
    OmittedFlanks omitted{f.pair, {}, f.gap};
    std::vector<int> near;
    for (const int s : f.slices) {
      const bool reached = gap_without_load(bodies.face, f, s) - least <= setup.reach;
      (!f.domain.empty() && (reached || setup.added.count({f.pair, s}) > 0) ? near : omitted.slices).push_back(s);
    }
    if (!near.empty()) {
      f.slices = near;
      if (setup.pairs.empty() || setup.pairs.back().index != f.pair) {
        setup.pairs.emplace_back();
        setup.pairs.back().index = f.pair;
        setup.pairs.back().roll = f.pair_roll;
      }
      auto& pair = setup.pairs.back();
      const auto before = pair.size();
      elements.add(pair, f, setup.load, setup.window);
      // Two tips that barely reach each other have no room for elements.
      if (pair.size() == before) omitted.slices.insert(omitted.slices.end(), near.begin(), near.end());
    }
    if (!omitted.slices.empty()) setup.omitted.push_back(std::move(omitted));
  }
  const auto empty = [](const ToothPair& p) { return p.elements.empty(); };
  setup.pairs.erase(std::remove_if(setup.pairs.begin(), setup.pairs.end(), empty), setup.pairs.end());
  for (auto& p : setup.pairs) {
    bodies.pinion.find_weights(p.pinion, p.index);
    bodies.wheel.find_weights(p.wheel, wheel_tooth(bodies.face.flanks(), p.index, 0));
  }
}

}  // namespace annulus::fem
