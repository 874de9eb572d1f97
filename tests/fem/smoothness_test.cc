#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <vector>

#include "contact_bench.h"
#include "fem/contact/hertz.h"
#include "fem/contact/pair_search.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// The loaded transmission error along the mesh cycle: what is not smooth in it is the teeth, not the mesh.
BOOST_AUTO_TEST_SUITE(smoothness)

using namespace annulus::tests;
using annulus::fem::LoadedPosition;

/// Unloaded gaps of all tooth pairs at the positions of one mesh cycle in equal steps.
class Gaps {
 public:
  Gaps(const annulus::fem::FlankContact& flanks, int steps) {
    for (int i = 0; i <= steps; ++i) {
      gaps_.emplace_back();
      for (const auto& [index, roll] : annulus::fem::possible_pairs(flanks, static_cast<double>(i) / steps))
        gaps_.back()[index] = flanks.smallest_gap(roll);
    }
  }
  /// Largest change between positions i and i + 1 of a gap that is, before or after, smaller than `reach`.
  [[nodiscard]] double largest_change(int i, double reach) const {
    double largest = 0;
    for (const auto& [index, gap] : gaps_[i]) {
      const auto next = gaps_[i + 1].find(index);
      if (next != gaps_[i + 1].end() && std::min(gap, next->second) < reach)
        largest = std::max(largest, std::abs(next->second - gap));
    }
    return largest;
  }

 private:
  std::vector<std::map<int, double>> gaps_;
};

/// One mesh cycle in equal steps.
class Cycle {
 public:
  Cycle(ContactBench& bench, int steps, double load)
      : bench_(bench), steps_(steps), positions_(bench.sweep(steps, load)) {
    for (int i = 0; i < steps; ++i) mean_ += lte(i) / steps;
    const auto& pair = bench.flanks().pair();
    const double middle = (pair.roll_length_low() + pair.roll_length_high()) / 2;
    half_width_ =
        annulus::fem::hertz_half_width(load / bench.face_width(), bench.flanks().pair().relative_curvature(middle), {});
    // The contact moves along the flank by roll / r_b of its way along the line of action.
    travel_ = half_width_ * pair.pinion().base_radius() / middle / pair.pinion().base_pitch();
  }

  [[nodiscard]] double lte(int i) const { return positions_[i].entry.lte; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double closure() const { return std::abs(lte(steps_) / lte(0) - 1); }
  /// Mesh cycles in which the contact travels its own half-width.
  [[nodiscard]] double travel() const { return travel_; }
  [[nodiscard]] double first_difference(int i, int step = 1) const { return std::abs(lte(i + step) - lte(i)); }
  [[nodiscard]] double largest_first(int step) const {
    double largest = 0;
    for (int i = 0; i + step <= steps_; i += step) largest = std::max(largest, first_difference(i, step));
    return largest;
  }
  /// The cycle closes: the position before the first is the last but one.
  [[nodiscard]] double second_difference(int i, int step) const {
    return std::abs(lte(i + step) - 2 * lte(i) + lte(i >= step ? i - step : i - step + steps_));
  }
  [[nodiscard]] std::vector<double> second_differences(int step) const {
    std::vector<double> result;
    for (int i = 0; i < steps_; i += step) result.push_back(second_difference(i, step));
    std::sort(result.begin(), result.end());
    return result;
  }
  /// Do the same pairs touch two steps before and after, on their path and two half-widths away from its ends?
  [[nodiscard]] bool far_from_tip_edges(int i, int step) const {
    if (i < 2 * step || i + 2 * step > steps_) return false;
    const auto& pair = bench_.flanks().pair();
    const double base = pair.pinion().base_radius(), low = pair.roll_length_low(), high = pair.roll_length_high();
    std::size_t touching = 0;
    for (int k = -2; k <= 2; ++k) {
      const auto& position = positions_[i + k * step];
      std::size_t here = 0;
      for (std::size_t p = 0; p < position.pair_roll.size(); ++p) {
        if (position.pair_share[p] <= 0) continue;
        ++here;
        const double roll = position.pair_roll[p], room = 4 * base * half_width_;
        if (roll * roll - low * low < room || high * high - roll * roll < room) return false;
      }
      if (k > -2 && here != touching) return false;
      touching = here;
    }
    return true;
  }

 private:
  ContactBench& bench_;
  int steps_;
  std::vector<LoadedPosition> positions_;
  double mean_ = 0, half_width_ = 0, travel_ = 0;
};

constexpr int steps = 512, coarser = 4;

void check_cycle(annulus::test::Verification& record, ContactBench& bench, const Gaps& gaps, double load) {
  const Cycle cycle(bench, steps, load * nominal_load);
  const double h = 1.0 / steps, mean = cycle.mean();

  // The next mesh cycle has the same pairs under other numbers: round-off.
  record.at_most("closure of the mesh cycle, relative", "", cycle.closure(), 1e-11, "rounding");

  // Continuity. The transmission error is the derivative of the complementary energy by the load, so that
  //   d LTE = sum of tangent load shares x d gap + change of the compliance:
  // no step exceeds the largest change of a gap by more than the compliance changes. That is half of the LTE in a
  // cycle, and a tenth while a contact crosses its tip edge, in the travel of its half-width.
  double worst = 0;
  for (int i = 0; i < steps; ++i)
    worst = std::max(worst, (cycle.first_difference(i) - gaps.largest_change(i, 1.5 * mean)) / (h * mean));
  BOOST_TEST_MESSAGE("load " << load << ": mean " << mean << " m, largest step " << cycle.largest_first(1) / mean
                             << " (" << cycle.largest_first(coarser) / mean << " at " << coarser
                             << " times the step), slope beyond the gaps " << worst << ", travel " << cycle.travel());
  record.at_most("slope of the transmission error beyond that of the gaps, over its mean per cycle", "", worst,
                 0.5 + 0.1 / cycle.travel(),
                 "change of the compliance; a tip edge crossed in the travel of a half-width");
  // In proportion to the step, where the coarser step resolves the entry of a tooth.
  if (load >= 0.1) {
    BOOST_TEST(cycle.largest_first(1) < 1.15 / coarser * cycle.largest_first(coarser));
  }

  // Kinks where a pair enters or leaves: their second difference shrinks with the step, or faster while the step does
  // not resolve what surrounds them.
  const auto fine = cycle.second_differences(1), coarse = cycle.second_differences(coarser);
  BOOST_TEST(fine.back() < 0.6 * coarse.back());

  // Elsewhere the curvature of the LTE, of the order of the LTE itself per cycle squared (a pair is a third softer at
  // the ends of its path than in its middle), and the kinks that the discretisation leaves where an element at the rim
  // of a contact touches or leaves: 1e-2 of the LTE per cycle at most, 1e-6 to 1e-5 of it in a step.
  const double median = fine[fine.size() / 2] / mean, coarse_median = coarse[coarse.size() / 2] / mean;
  BOOST_TEST(median < 2 * h * h + 0.01 * h);
  BOOST_TEST(coarse_median < 2 * std::pow(coarser * h, 2) + 0.01 * coarser * h);
  // Positions far from tip edges, every one.
  for (const int step : {1, coarser}) {
    double largest = 0;
    int positions = 0;
    for (int i = 0; i < steps; i += step)
      if (cycle.far_from_tip_edges(i, step)) {
        largest = std::max(largest, cycle.second_difference(i, step) / mean);
        ++positions;
      }
    BOOST_TEST_MESSAGE("  step 1/" << steps / step << ": second difference " << largest << " at " << positions
                                   << " positions far from tip edges, median of all "
                                   << (step == 1 ? median : coarse_median) << ", largest of all "
                                   << (step == 1 ? fine : coarse).back() / mean);
    // The kinks come from tip edges still two half-widths away: some 4e-4 of the LTE per half-width.
    record.at_most(step == 1 ? "second difference far from tip edges over the mean, steps of 1/512"
                             : "second difference far from tip edges over the mean, steps of 1/128",
                   "", largest, 2 * std::pow(step * h, 2) + 4e-4 * step * h / cycle.travel(),
                   "curvature of the order of the transmission error; kinks two half-widths from tip edges");
  }
}

const char* const gaps_reference =
    "theory: the slope is the sum of the load shares x slopes of the gaps, and the change of the compliance";

void check_loads(annulus::test::Verification& record, const annulus::fem::LoadedMeshProblem& problem) {
  ContactBench bench(problem, 1);
  const Gaps gaps(bench.flanks(), steps);
  for (const double load : {1e-3, 0.1, 1.0, 10.0}) check_cycle(record, bench, gaps, load);
}

BOOST_AUTO_TEST_CASE(the_ring_mesh_is_smooth_from_a_thousandth_to_ten_times_the_load) {
  annulus::test::Verification record("Smooth transmission error of the ring mesh, a thousandth to ten times the load",
                                     gaps_reference);
  check_loads(record, ring_mesh(annulus::fem::OutsideHeld{}, 2));
}

BOOST_AUTO_TEST_CASE(the_sun_mesh_is_smooth_from_a_thousandth_to_ten_times_the_load) {
  annulus::test::Verification record("Smooth transmission error of the sun mesh, a thousandth to ten times the load",
                                     gaps_reference);
  check_loads(record, sun_mesh(2));
}

BOOST_AUTO_TEST_CASE(where_a_contact_reaches_its_tip_edge_the_transmission_error_jumps_by_next_to_nothing) {
  annulus::test::Verification record("Transmission error where a contact reaches its tip edge",
                                     "theory: it is smooth; steps of a five-hundredth of the travel of a half-width");
  // When the centre of a pair comes nearer to its tip edge than a fiftieth of a half-width, the elements between are
  // dropped: the one place where the discretisation changes at once. Steps of a five-hundredth of the travel of a
  // half-width leave a second difference of some 1e-6 of the LTE to the rest.
  for (const bool internal : {true, false}) {
    ContactBench bench(internal ? ring_mesh(annulus::fem::OutsideHeld{}, 2) : sun_mesh(2), 1);
    const auto& pair = bench.flanks().pair();
    const double base = pair.pinion().base_radius(), pitch = pair.pinion().base_pitch();
    for (const double roll : {pair.roll_length_low(), pair.roll_length_high()})
      for (const double load : {1e-3, 0.1, 1.0}) {
        const double b = annulus::fem::hertz_half_width(load * nominal_load / bench.face_width(),
                                                        bench.flanks().pair().relative_curvature(roll), {});
        const double travel = b * base / roll / pitch, step = travel / 500;
        const double middle = (internal ? 1 : -1) * (roll - pair.roll_length_pitch()) / pitch;
        const auto lte = [&](int i) {
          return bench.solve(middle - std::floor(middle) + i * step, load * nominal_load).entry.lte;
        };
        double largest = 0, before = lte(-30), here = lte(-29);
        for (int i = -28; i <= 30; ++i) {
          const double next = lte(i);
          largest = std::max(largest, std::abs(next - 2 * here + before) / here);
          before = here;
          here = next;
        }
        BOOST_TEST_MESSAGE((internal ? "ring" : "sun") << " load " << load << " at roll " << roll << ": " << largest);
        record.at_most("second difference over the transmission error", "", largest, 2e-4,
                       "elements dropped at the edge; 1.1e-4 found when it was set");
      }
  }
}

BOOST_AUTO_TEST_SUITE_END()
