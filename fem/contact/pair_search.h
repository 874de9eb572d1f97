#pragma once

#include <utility>
#include <vector>

#include "fem/contact/contact_body.h"
#include "fem/contact/contact_face.h"
#include "fem/contact/pressure_elements.h"
#include "fem/contact/tooth_pairs.h"

namespace annulus::fem {

/// Tooth pairs that may touch at a position: number, and planet roll length (m) of their theoretical contact. `phase`
/// in mesh cycles from the pitch-point contact of teeth 0.
[[nodiscard]] std::vector<std::pair<int, double>> possible_pairs(const FlankContact& flanks, double phase);

/// Finds the tooth pairs that load may bring into contact. Everything is referred to.
class PairSearch {
 public:
  PairSearch(const ContactFace& face, const ContactBody& planet, const ContactBody& wheel,
             const PressureElements& elements)
      : face_(face), planet_(planet), wheel_(wheel), elements_(elements) {}

  /// The pairs of `setup` with their elements, from its phase, load, window and reach.
  void find(ToothPairs& setup) const;

 private:
  /// Wherever flanks may face each other at a phase; domains and gaps are not looked for.
  [[nodiscard]] std::vector<FacingFlanks> facing(double phase) const;
  /// m, how far a theoretical contact stands before (negative) or behind the path of contact.
  [[nodiscard]] double beyond_path(double roll) const;
  /// Domains and gaps of `all` as far as load may close them; returns the least gap without load, as transmission
  /// error, m.
  double find_gaps(std::vector<FacingFlanks>& all, ToothPairs& setup) const;

  const ContactFace& face_;
  const ContactBody &planet_, &wheel_;
  const PressureElements& elements_;
};

}  // namespace annulus::fem
