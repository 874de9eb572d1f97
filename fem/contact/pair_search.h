#pragma once

#include <utility>
#include <vector>

#include "fem/contact/flank_contact.h"
#include "fem/contact/pressure_elements.h"
#include "fem/contact/tooth_pairs.h"

namespace annulus::fem {

/// Where tooth pairs are looked for.
struct PairRange {
  double low = 0, high = 0;  ///< m, pinion roll lengths of theoretical contacts
  double gap_beyond = 0;     ///< m, along the normal: flanks beyond are further apart without load
};
/// One base pitch beyond both ends of the path of contact.
[[nodiscard]] PairRange pitch_beyond_path(const FlankContact& flanks);
/// All flanks that face each other with no more than a gap (m) without load.
[[nodiscard]] PairRange within_gap(const FlankContact& flanks, double gap);
/// All flanks that small displacements can bring together: up to half a module apart, twice as far as any mesh may give
/// way.
[[nodiscard]] PairRange possible_contacts(const FlankContact& flanks);
/// Largest number of pairs that a range holds at any phase.
[[nodiscard]] int most_pairs_in(const PairRange& range, const FlankContact& flanks);

/// Tooth pairs up to a pitch beyond the path of contact: number, and pinion roll length (m) of their theoretical
/// contact. `phase` in mesh cycles from the pitch-point contact of teeth 0.
[[nodiscard]] std::vector<std::pair<int, double>> possible_pairs(const FlankContact& flanks, double phase);

/// Finds the tooth pairs that take part in the contact problem, with their elements, and those that do not, from the
/// phase, load, window, reach and added pairs of `setup`.
void find_pairs(const ContactBodies& bodies, const PressureElements& elements, const PairRange& range,
                ToothPairs& setup);

}  // namespace annulus::fem
