#pragma once

#include <utility>
#include <vector>

#include "fem/contact/flank_contact.h"
#include "fem/contact/pressure_elements.h"
#include "fem/contact/tooth_pairs.h"

namespace annulus::fem {

/// Tooth pairs that may touch at a position: number, and planet roll length (m) of their theoretical contact. `phase`
/// in mesh cycles from the pitch-point contact of teeth 0.
[[nodiscard]] std::vector<std::pair<int, double>> possible_pairs(const FlankContact& flanks, double phase);

/// Finds the tooth pairs that load may bring into contact, with their elements, from the phase, load, window and reach
/// of `setup`.
void find_pairs(const ContactBodies& bodies, const PressureElements& elements, ToothPairs& setup);

}  // namespace annulus::fem
