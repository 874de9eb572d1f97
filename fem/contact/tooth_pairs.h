#pragma once

#include <Eigen/Core>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "fem/contact/flank_contact.h"
#include "fem/contact/flank_patch.h"

namespace annulus::fem {

/// One tooth pair that may touch: its window, divided into pressure elements, on both flanks.
struct ToothPair {
  int index = 0;    ///< number of the pair, and of the pinion's tooth in cycle 0
  double roll = 0;  ///< theoretical contact on the pinion
  double smallest_gap = std::numeric_limits<double>::infinity();
  FlankPatch pinion, wheel;  ///< the same elements on both
  struct Element {
    double gap = 0;                      ///< mean, m
    double roll_low = 0, roll_high = 0;  ///< on the pinion, m
    double area = 0;                     ///< m^2
    double distance = 0;                 ///< from the centre of the window, m
    bool tip_edge = false;               ///< ends at the end of a flank
    bool outermost = false;              ///< ends where the window does: has to stay free
  };
  std::vector<Element> elements;
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(elements.size()); }
};

/// Two flanks facing each other over some slices, in which the theoretical contact stands at the same place.
struct FacingFlanks {
  int pair = 0;
  double pair_roll = 0, roll = 0;  ///< theoretical contact on the pinion: of the pair, and in these slices
  FlankContact::Interval domain;
  double centre_roll = 0;   ///< where the flanks are nearest
  double gap = 0;           ///< m, there, along the normal; without the lead's
  std::vector<int> slices;  ///< all of a spur gear, one of a helical one
};

/// Slices of a tooth pair: number of the pair, number of the slice.
using PairSlices = std::set<std::pair<int, int>>;

/// Facing flanks that take no part in a contact problem.
struct OmittedFlanks {
  int pair = 0;
  std::vector<int> slices;
  double gap = 0;  ///< m, FacingFlanks::gap or less
};

/// All pairs of one phase and load, and what they have in common in every mesh cycle.
struct ToothPairs {
  double phase = 0, load = 0, window = 0;
  double reach = 0;  ///< m, transmission error: flanks further apart than the nearest ones by more are left out
  PairSlices added;  ///< that take part however far apart they are
  std::vector<ToothPair> pairs;
  std::vector<OmittedFlanks> omitted;  ///< within the range of pairs
  int first_pair = 0, last_pair = 0;   ///< of those and these
  std::vector<Eigen::Index> start;     ///< first unknown of every pair
  Eigen::Index contacts = 0;           ///< number of unknown contact forces
  Eigen::MatrixXd compliance;          ///< contacts x contacts
  double asymmetry = 0;                ///< of the compliance, formed in both directions
};

}  // namespace annulus::fem
