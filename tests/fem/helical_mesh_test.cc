#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "contact_bench.h"
#include "core/errors.h"
#include "fem/contact/hertz.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Helical gears, slice by slice.
BOOST_AUTO_TEST_SUITE(helical_mesh)

using namespace annulus::tests;
using annulus::fem::LoadedPosition;

/// The ring paper's sun and planet with helical teeth.
annulus::fem::LoadedMeshProblem helical_sun_mesh(double helix_angle) { return with_helix(sun_mesh(2), helix_angle); }

double mean_lte(const std::vector<LoadedPosition>& positions) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) sum += positions[i].entry.lte;
  return sum / static_cast<double>(positions.size() - 1);
}

double peak_to_peak(const std::vector<LoadedPosition>& positions) {
  double low = positions.front().entry.lte, high = low;
  for (const auto& p : positions) low = std::min(low, p.entry.lte), high = std::max(high, p.entry.lte);
  return high - low;
}

constexpr int phases = 16;
constexpr double degree = M_PI / 180;

BOOST_AUTO_TEST_CASE(balances_hold_and_the_overlap_smooths_the_mesh) {
  annulus::test::Verification record("Balances of a helical mesh, and its smoothness against the spur mesh",
                                     "statics, energy, Maxwell and Betti; overlap evens the stiffness");
  const auto problem = helical_sun_mesh(12 * degree);
  BOOST_TEST(problem.pair.overlap_ratio() > 1.4);
  ContactBench helical(problem, 0, annulus::fem::Fidelity::solid);
  ContactBench spur(helical_sun_mesh(0), 0, annulus::fem::Fidelity::solid);
  const auto positions = helical.sweep(phases, nominal_load), of_spur = spur.sweep(phases, nominal_load);
  double force = 0;
  for (const auto& p : positions) {
    force = std::max(force, p.force_balance_relative);
    record.at_most("balance of energy, relative", "", p.energy_balance_relative, 1e-9, "rounding of the solve");
    record.at_most("reciprocity of the compliance, relative", "", p.reciprocity_relative, 1e-9,
                   "rounding of the solve");
    record.at_most("largest penetration", "m", p.max_penetration, 1e-14, "rounding of the solve");
    // The load is the transverse force at the base circle: so are the shares of the pairs and the line load.
    BOOST_TEST(std::accumulate(p.pair_share.begin(), p.pair_share.end(), 0.0) == 1.0,
               boost::test_tools::tolerance(1e-9));
    const double line_load = std::accumulate(p.line_load.begin(), p.line_load.end(), 0.0) * helical.face_width() /
                             static_cast<double>(p.line_load.size());
    BOOST_TEST(line_load == nominal_load, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(std::abs(p.entry.unloaded_te) < 1e-12);  // m
    BOOST_TEST(p.entry.stiffness_tangent >= p.entry.stiffness_secant);
    BOOST_TEST(*std::min_element(p.pair_share.begin(), p.pair_share.end()) >= 0);
  }
  // Transverse force x base radius = torque. Nodes between the vertices of a twisted cell at the very end of the flank
  // belong to the fillet or the tip as well and stand off the involute by 1e-7 of the radius.
  BOOST_TEST_MESSAGE("force balance " << force);
  record.at_most("balance of forces, relative", "", force, 1e-7, "nodes at the ends of twisted flanks");
  BOOST_TEST(positions.back().entry.lte == positions.front().entry.lte, boost::test_tools::tolerance(1e-9));
  BOOST_TEST_MESSAGE("peak to peak over mean: helical " << peak_to_peak(positions) / mean_lte(positions) << ", spur "
                                                        << peak_to_peak(of_spur) / mean_lte(of_spur));
  // Always several pairs, none of which comes or goes along its whole length.
  record.at_most("peak to peak of the transmission error, helical over spur", "",
                 peak_to_peak(positions) / peak_to_peak(of_spur), 0.25, "overlap ratio above 1.4");
  // Contact lines are longer by 1 / cos(beta_b) and so is the normal force: the mean stiffness is that of the spur pair
  // within the change of the contact ratio.
  record.near("mean transmission error, helical over spur", "", mean_lte(positions) / mean_lte(of_spur), 1, 0.1,
              "change of the contact ratio");
  annulus::test::RecordedPlot::Curve helix{"helical, 12 degrees", {}, {}, {}}, straight{"spur", {}, {}, {}};
  for (int i = 0; i <= phases; ++i) {
    helix.x.push_back(static_cast<double>(i) / phases);
    straight.x.push_back(helix.x.back());
    helix.computed.push_back(positions[i].entry.lte * 1e6);
    straight.computed.push_back(of_spur[i].entry.lte * 1e6);
  }
  record.plot({"Loaded transmission error of the sun mesh", "mesh phase", "um", {helix, straight}});
}

BOOST_AUTO_TEST_CASE(a_hardly_helical_pair_is_a_spur_pair) {
  annulus::test::Verification record("Hardly helical teeth, 0.1 and 0.01 degrees", "limit: the spur mesh");
  ContactBench spur(helical_sun_mesh(0), 0, annulus::fem::Fidelity::solid);
  const auto expected = spur.sweep(8, nominal_load);
  double before = 0;
  for (const double angle : {0.1 * degree, 0.01 * degree}) {
    ContactBench helical(helical_sun_mesh(angle), 0, annulus::fem::Fidelity::solid);
    const auto positions = helical.sweep(8, nominal_load);
    double worst = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
      worst = std::max(worst, std::abs(positions[i].entry.lte / expected[i].entry.lte - 1));
    BOOST_TEST_MESSAGE("helix " << angle / degree << " degrees: LTE differs by " << worst);
    // The ends of the face are ahead and behind by half an overlap, 0.064 beta; what one gains the other loses, but
    // where a pair enters. The path that remains is of the order of beta.
    record.at_most(angle > 0.05 * degree ? "transmission error, largest relative difference, 0.1 degrees"
                                         : "transmission error, largest relative difference, 0.01 degrees",
                   "", worst, angle, "of the order of the helix angle, where a pair enters");
    if (before > 0) BOOST_TEST(worst < 0.15 * before);
    before = worst;
  }
}

BOOST_AUTO_TEST_CASE(every_slice_presses_as_hertz_says_along_the_oblique_line_of_contact) {
  // Per length of the contact line the normal force is (F / cos) / (b / cos) = F / b; the curvature across the line is
  // that of the transverse section times cos(beta_b). A slice without regard to the slant would be 14 % off at 30
  // degrees. As many elements as at level 3 of the plane leave 0.3 %, 1 % where a slice carries a third of the mean.
  annulus::test::Verification record("Pressure of every slice of spur and helical teeth, 0 and 30 degrees",
                                     "Hertz along the oblique line of contact");
  for (const double angle : {0.0, 30 * degree}) {
    ContactBench bench(helical_sun_mesh(angle), 0, annulus::fem::Fidelity::solid);
    bench.set_elements(12);
    const auto& pair = bench.flanks().pair();
    const double slant = std::cos(pair.pinion().base_helix_angle()), base = pair.pinion().base_radius();
    const double load = 1e-2 * nominal_load, mean = load / bench.face_width();
    const auto arc = [&](double roll) { return roll * roll / (2 * base); };
    struct Slice {
      double force = 0, first = 0, second = 0, peak = 0;
    };
    double peak_sum = 0, width_sum = 0, worst_peak = 0, worst_width = 0;
    int compared = 0;
    for (const double phase : {0.0, 0.25, 0.5, 0.75}) {
      const auto position = bench.solve(phase, load);
      std::map<std::pair<int, double>, Slice> slices;  // by pair and middle
      for (const auto& patch : position.pressure) {
        Slice& slice = slices[{patch.pair, (patch.z_low + patch.z_high) / 2}];
        const double low = arc(patch.roll_low), high = arc(patch.roll_high), f = patch.pressure * (high - low);
        slice.force += f;
        slice.first += f * (low + high) / 2;
        slice.second += f * (low * low + low * high + high * high) / 3;
        slice.peak = std::max(slice.peak, patch.pressure);
      }
      for (const auto& [key, slice] : slices) {
        const double ahead = bench.flanks().pinion().twist() * base * (key.second - bench.face_width() / 2);
        const double roll = position.pair_roll[key.first] + ahead, at = arc(roll);
        const double b =
            annulus::fem::hertz_half_width(slice.force, slant * bench.flanks().pair().relative_curvature(roll), {});
        const double room = std::min(at - arc(pair.roll_length_low()), arc(pair.roll_length_high()) - at);
        if (room < 3 * b || slice.force < 0.3 * mean) continue;  // tip edges, and slices with few elements
        const double centre = slice.first / slice.force;
        const double width = 2 * std::sqrt(slice.second / slice.force - centre * centre) / b - 1;
        const double peak = slice.peak / (2 * slice.force / (M_PI * b)) - 1;
        peak_sum += peak;
        width_sum += width;
        worst_peak = std::max(worst_peak, std::abs(peak));
        worst_width = std::max(worst_width, std::abs(width));
        ++compared;
      }
    }
    BOOST_TEST_MESSAGE("helix " << angle / degree << " degrees, " << compared << " slices: peak " << peak_sum / compared
                                << " in the mean, " << worst_peak << " at worst; half-width " << width_sum / compared
                                << ", " << worst_width);
    BOOST_TEST(compared > 30);
    const char* origin = "discretisation of the pressure";
    record.near("peak pressure over Hertz, mean of all slices", "", 1 + peak_sum / compared, 1, 0.003, origin);
    record.near("half-width over Hertz, mean of all slices", "", 1 + width_sum / compared, 1, 0.004, origin);
    record.at_most("peak pressure, largest difference from Hertz", "", worst_peak, 0.01, origin);
    record.at_most("half-width, largest difference from Hertz", "", worst_width, 0.015, origin);
  }
}

BOOST_AUTO_TEST_CASE(the_hand_does_not_matter) {
  annulus::test::Verification record("Right- and left-handed teeth", "symmetry");
  // A mirror image in the section through the middle, up to the order of the nodes.
  ContactBench right(helical_sun_mesh(12 * degree), 0, annulus::fem::Fidelity::solid);
  ContactBench left(helical_sun_mesh(-12 * degree), 0, annulus::fem::Fidelity::solid);
  for (const double phase : {0.1, 0.6}) {
    auto p = right.solve(phase, nominal_load);
    const auto q = left.solve(phase, nominal_load);
    // Sections are meshed at z = 0, not in the middle: the two hands do not have the same mesh, only the same error.
    record.close("transmission error", "m", p.entry.lte, q.entry.lte, 2e-3, "meshes that are not mirror images");
    std::reverse(p.line_load.begin(), p.line_load.end());
    for (std::size_t s = 0; s < p.line_load.size(); ++s)
      record.close("line load of a slice", "N", p.line_load[s], q.line_load[s], 0.01,
                   "meshes that are not mirror images");
  }
}

BOOST_AUTO_TEST_CASE(linear_elements_are_refined_once_before_quadratic_ones_follow) {
  annulus::test::Verification record("Level chosen for three quarters of the error of linear elements",
                                     "first order: cells 1.5 times smaller leave two thirds");
  const auto problem = helical_sun_mesh(12 * degree);
  annulus::fem::LoadedMeshSettings settings;
  settings.fidelity = annulus::fem::Fidelity::solid;
  settings.degree = 1;
  settings.level = 1;
  const double first = solve_loaded_mesh(problem, settings).worst_error_relative;
  // Cells 1.5 times smaller leave two thirds of an error of first order.
  settings.level.reset();
  settings.accuracy = 0.75 * first;
  const auto refined = solve_loaded_mesh(problem, settings);
  record.near("degree of the elements", "", refined.degree, 1, 0, "the lowest that does");
  record.near("level of resolution", "", refined.level, 2, 0, "the second does");
  record.at_most("largest stated error over the wanted accuracy", "", refined.worst_error_relative / settings.accuracy,
                 1, "the accuracy asked for");
}

BOOST_AUTO_TEST_CASE(the_plane_fidelity_is_refused) {
  BOOST_CHECK_THROW((void)annulus::tests::solve_plane(helical_sun_mesh(12 * degree), 1), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
