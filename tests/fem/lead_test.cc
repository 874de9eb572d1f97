#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "ring_paper.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Load distribution along the face width under lead modifications and misalignment.
BOOST_AUTO_TEST_SUITE(lead)

using namespace annulus::tests;
using annulus::fem::Fidelity;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedPosition;

/// A mesh of the ring paper's gears whose planet has a modified lead.
LoadedMeshProblem modified(bool internal, double crowning, double slope) {
  return with_planet_lead(internal ? ring_mesh(annulus::fem::OutsideHeld{}, 2) : sun_mesh(2), crowning, slope);
}

/// Place of the resultant along the face width: 0 at the end that carries most under a misalignment > 0, 1 at the
/// other.
double resultant_place(const LoadedPosition& position) {
  double force = 0, moment = 0;
  const auto slices = static_cast<double>(position.line_load.size());
  for (std::size_t s = 0; s < position.line_load.size(); ++s) {
    force += position.line_load[s];
    moment += position.line_load[s] * (static_cast<double>(s) + 0.5) / slices;
  }
  return moment / force;
}

// The mesh is the same on both sides of the middle; its stiffness is factorised, not its symmetry.
constexpr double symmetric = 1e-9;

double asymmetry(const LoadedPosition& position) {
  double worst = 0;
  const auto& q = position.line_load;
  for (std::size_t s = 0; s < q.size(); ++s)
    worst = std::max(worst, std::abs(q[s] - q[q.size() - 1 - s]) * static_cast<double>(q.size()));
  double sum = 0;
  for (const double x : q) sum += x;
  return worst / sum;
}

BOOST_AUTO_TEST_CASE(straight_teeth_with_equal_supports_have_an_even_load_along_the_face) {
  annulus::test::Verification record("Line load of straight teeth along the face",
                                     "statics: mean line load; even but for the ends, which are free to widen");
  for (const bool internal : {true, false}) {
    ContactBench bench(modified(internal, 0, 0), 0, Fidelity::solid);
    for (const double load : {1e-3, 1.0})
      for (const double phase : {0.0, 0.5}) {
        const auto position = bench.solve(phase, load * nominal_load);
        const double mean = load * nominal_load / bench.face_width();
        double least = position.line_load.front(), sum = 0;
        for (const double q : position.line_load) {
          least = std::min(least, q);
          sum += q / static_cast<double>(position.line_load.size());
        }
        record.close("mean line load", "N/m", sum, mean, 1e-9, "rounding of the solve");
        BOOST_TEST_MESSAGE((internal ? "ring" : "sun") << " load " << load << ": least " << least / mean
                                                       << ", K_H_beta " << position.face_load_factor);
        // The ends of the teeth are free to widen (plane stress), softer by up to nu^2 = 9 % over a tenth of the face;
        // the slices there lose 1 to 3 % to the others.
        record.at_most("face load factor", "", position.face_load_factor, 1.015,
                       "ends softer by up to nu^2 over a tenth of the face");
        BOOST_TEST(position.face_load_factor > 1);
        BOOST_TEST(least / mean > 0.97);
        record.at_most("asymmetry of the line load", "", asymmetry(position), symmetric,
                       "rounding of the factorisation");
      }
  }
}

/// ISO 6336-1, 7: face load factor of a face of independent springs under a misalignment, with k the mesh stiffness of
/// the whole face: 1 + k m / (2 F) while all of it touches, sqrt(2 k m / F) on a part b_c / b = 2 / K beyond K = 2.
double misalignment_of(double factor, double stiffness, double load) {
  return load / stiffness * (factor < 2 ? 2 * (factor - 1) : factor * factor / 2);
}
/// From the place e of the resultant: e = 1/2 - (K - 1) / 6 of the trapezium, b_c / 3 of the triangle.
double factor_of(double place) { return place > 1.0 / 3 ? 1 + 6 * (0.5 - place) : 2 / (3 * place); }

BOOST_AUTO_TEST_CASE(misaligned_teeth_carry_like_a_row_of_springs) {
  annulus::test::Verification record("Face load factor of misaligned teeth",
                                     "ISO 6336-1, 7: a row of independent springs; 1 + k m / (2 F), sqrt(2 k m / F)");
  annulus::test::RecordedPlot::Curve light{"a thousandth of the load", {}, {}, {}}, nominal{"nominal load", {}, {}, {}};
  ContactBench bench(modified(false, 0, 0), 0, Fidelity::solid);
  constexpr double phase = 0.05;  // a single pair, in the middle of its flank
  double light_excess = 0;
  for (const double load : {1e-3, 1.0}) {
    const double force = load * nominal_load;
    bench.misalign(0);
    const auto aligned = bench.solve(phase, force);
    // Small tilts change the load little: the stiffness for them is that of a small change.
    const double stiffness = aligned.entry.stiffness_tangent;
    for (const double expected : {1.25, 1.5, 2.5, 3.5}) {
      const double misalignment = misalignment_of(expected, stiffness, force);
      bench.misalign(misalignment);
      const auto position = bench.solve(phase, force);
      const double found = factor_of(resultant_place(position)),
                   slices = static_cast<double>(bench.bodies().pinion->slices());
      const double excess = (found - 1) / (expected - 1) - 1;
      const auto lifted = std::count(position.line_load.begin(), position.line_load.end(), 0.0);
      // Mean over the most loaded slice.
      const double end = expected - (expected < 2 ? expected - 1 : expected * expected / 4) / slices;
      BOOST_TEST_MESSAGE("load " << load << ", K_H_beta of springs " << expected << ", from the resultant " << found
                                 << " (excess " << excess << "), largest line load " << position.face_load_factor
                                 << " against " << end << ", slices without contact " << lifted);
      BOOST_TEST(position.force_balance_relative < 1e-9);
      BOOST_TEST(position.energy_balance_relative < 1e-9);
      // A slice is not a spring of its own. Loads next to it press it down as well, through the tooth and the rim, so
      // that an uneven load meets a stiffer face than an even one: the factor is larger, never smaller. At a thousandth
      // of the load the contact itself, which the neighbours do not feel, takes the larger part of the deflection (it
      // grows with the logarithm of one over the load). Beyond lift-off the part that still touches is also stiffer by
      // its higher load (Hertz), and at the nominal load its larger deflection closes the gaps of the neighbouring
      // teeth there.
      BOOST_TEST(excess > 0);
      const double most = expected < 2 ? (load < 1 ? 0.05 : 0.08) : (load < 1 ? 0.08 : 0.35);
      record.near(
          load < 1 ? "factor from the resultant, a thousandth of the load" : "factor from the resultant, nominal load",
          "", found, expected, most * (expected - 1),
          "slices are coupled: an uneven load meets a stiffer face, more so at high load");
      auto& curve = load < 1 ? light : nominal;
      curve.x.push_back(misalignment * 1e6 / load);
      curve.computed.push_back(found);
      curve.reference.push_back(expected);
      BOOST_TEST(position.face_load_factor > end);
      BOOST_TEST(position.face_load_factor < (1 + (load < 1 ? 0.08 : 0.4)) * end);
      if (load < 1)
        light_excess = excess;
      else if (expected > 3)
        BOOST_TEST(excess > light_excess);
      // Lift-off where the springs have it, to a slice and a half.
      const double touching = slices * (expected < 2 ? 1 : 2 / expected);
      record.near("slices in contact", "", slices - static_cast<double>(lifted), touching, 1.5, "a slice and a half");
    }
  }
  record.plot({"Face load factor", "misalignment over load, um", "", {light, nominal}});
}

// What a level states of its largest face load factor covers the next level, which has 4/3 as many slices.
BOOST_AUTO_TEST_CASE(the_error_of_the_face_load_factor_covers_a_finer_level) {
  annulus::test::Verification record("Error of the face load factor", "the next level, on finer elements and slices");
  for (const bool internal : {true, false}) {
    auto problem = modified(internal, 10e-6, 0);
    problem.misalignment = 30e-6;
    annulus::fem::LoadedMeshSettings settings;
    settings.fidelity = Fidelity::solid;
    settings.level = 1;
    const auto solved = solve_loaded_mesh(problem, settings);
    settings.level = 2;
    const auto finer = solve_loaded_mesh(problem, settings);
    const auto largest = [&](const annulus::fem::LoadedMeshResult& result) {
      double most = 0;
      for (std::size_t i = problem.loads.size() / 2; i < result.positions.size(); i += problem.loads.size())
        most = std::max(most, result.positions[i].face_load_factor);
      return most;
    };
    BOOST_TEST(largest(solved) > 1.2);
    BOOST_TEST(solved.face_load_factor_error > 0);
    BOOST_TEST(solved.face_load_factor_error < 0.1 * largest(solved));
    record.near(internal ? "ring mesh" : "sun mesh", "", largest(solved), largest(finer), solved.face_load_factor_error,
                "the stated error");
  }
}

BOOST_AUTO_TEST_CASE(a_misalignment_of_the_other_sign_is_the_mirror_image) {
  annulus::test::Verification record("A misalignment and its mirror image", "symmetry");
  ContactBench bench(modified(true, 0, 0), 0, Fidelity::solid);
  bench.misalign(30e-6);
  auto position = bench.solve(0.3, nominal_load);
  bench.misalign(-30e-6);
  const auto mirrored = bench.solve(0.3, nominal_load);
  record.close("transmission error", "m", position.entry.lte, mirrored.entry.lte, symmetric,
               "rounding of the factorisation");
  const double mean = nominal_load / bench.face_width();
  std::reverse(position.line_load.begin(), position.line_load.end());
  for (std::size_t s = 0; s < position.line_load.size(); ++s)
    BOOST_TEST(std::abs(position.line_load[s] - mirrored.line_load[s]) < symmetric * mean);
}

BOOST_AUTO_TEST_CASE(crowned_teeth_carry_symmetrically_and_in_their_middle) {
  annulus::test::Verification record("Crowned teeth", "symmetry; without load crowns touch where nothing is missing");
  constexpr double crowning = 20e-6;
  ContactBench bench(modified(true, crowning, 0), 0, Fidelity::solid);
  ContactBench straight(modified(true, 0, 0), 0, Fidelity::solid);
  for (const double load : {1e-3, 1.0}) {
    const auto position = bench.solve(0.3, load * nominal_load), plain = straight.solve(0.3, load * nominal_load);
    const auto& q = position.line_load;
    BOOST_TEST(asymmetry(position) < symmetric);
    BOOST_TEST(std::is_sorted(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(q.size() / 2)));
    BOOST_TEST(position.face_load_factor > plain.face_load_factor);
    BOOST_TEST(position.entry.lte > plain.entry.lte);  // material is missing
    BOOST_TEST(position.entry.lte < plain.entry.lte + crowning);
    // Nothing is missing in the middle of the face, although a slice has a gap of its own there.
    record.at_most("unloaded transmission error: the crowns touch", "m", std::abs(position.entry.unloaded_te), 1e-15,
                   "rounding of the flanks' coordinates");
    BOOST_TEST_MESSAGE("crowned, load " << load << ": K_H_beta " << position.face_load_factor);
    BOOST_TEST(position.energy_balance_relative < 1e-9);
  }
  // Hardly any load: the middle alone touches.
  const auto light = bench.solve(0.3, 1e-3 * nominal_load);
  BOOST_TEST(light.line_load.front() == 0);
  BOOST_TEST(light.face_load_factor > 3);

  // A slice's mean gap is larger than what is missing in its middle: counted as part of the deflection that would make
  // few slices stiffer.
  ContactBench finer(modified(true, crowning, 0), 1, Fidelity::solid);
  const double coarse = bench.solve(0.3, nominal_load).entry.stiffness_secant,
               fine = finer.solve(0.3, nominal_load).entry.stiffness_secant;
  record.near("stiffness, 18 slices against 24", "N/m", coarse, fine, 2e-3 * fine, "two levels of a solid");
}

BOOST_AUTO_TEST_CASE(a_slope_and_the_opposite_misalignment_cancel) {
  annulus::test::Verification record("A lead slope and the opposite misalignment", "they cancel but for the mean gap");
  constexpr double slope = 25e-6;
  for (const double sign : {1.0, -1.0}) {
    // Misaligned from the start, it has as many slices as the other.
    auto misaligned = modified(true, 0, 0);
    misaligned.misalignment = sign * slope;
    ContactBench bench(modified(true, 0, sign * slope), 0, Fidelity::solid), straight(misaligned, 0, Fidelity::solid);
    // Alone the slope is the misalignment; a slope takes material away (half of it in the mean), a misalignment tilts.
    bench.misalign(0);
    const auto sloping = bench.solve(0.6, nominal_load), tilted = straight.solve(0.6, nominal_load);
    BOOST_TEST(sloping.entry.lte - slope / 2 == tilted.entry.lte, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(sloping.face_load_factor == tilted.face_load_factor, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(sloping.face_load_factor > 1.3);
    bench.misalign(-sign * slope);
    straight.misalign(0);
    const auto cancelled = bench.solve(0.6, nominal_load), plain = straight.solve(0.6, nominal_load);
    // Equal gaps but for the mean, to the round-off of their sums.
    record.close("transmission error less half the slope", "m", cancelled.entry.lte - slope / 2, plain.entry.lte, 1e-9,
                 "rounding");
    BOOST_TEST(std::abs(cancelled.entry.unloaded_te - slope / 2 - plain.entry.unloaded_te) < 1e-15);  // m
    record.close("secant stiffness", "N/m", cancelled.entry.stiffness_secant, plain.entry.stiffness_secant, 1e-9,
                 "rounding");
    record.close("face load factor", "", cancelled.face_load_factor, plain.face_load_factor, 1e-9, "rounding");
  }
}

BOOST_AUTO_TEST_SUITE_END()
