#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "contact_bench.h"
#include "fem/loaded_mesh.h"
#include "geometry/flank_topography.h"
#include "ring_paper.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Flanks that were measured, and tip chamfers, of the ring paper's gears.
BOOST_AUTO_TEST_SUITE(measured_flanks)

using namespace annulus::tests;
using annulus::fem::Fidelity;
using annulus::fem::LoadedMeshProblem;
using annulus::geometry::FlankTopography;
using annulus::geometry::Gear;
using annulus::geometry::GearParameters;
using annulus::geometry::ToothProfile;

namespace {

using Side = std::shared_ptr<const FlankTopography> GearParameters::*;

LoadedMeshProblem mesh(bool internal) {
  auto problem = internal ? ring_mesh(annulus::fem::OutsideHeld{}, 2) : sun_mesh(2);
  problem.phases = 8;
  return problem;
}

/// With one gear replaced by another.
LoadedMeshProblem with(LoadedMeshProblem problem, bool planet, const GearParameters& parameters) {
  const auto& pair = problem.pair;
  problem.pair = planet ? annulus::geometry::GearPair(Gear(parameters), pair.wheel(), pair.centre_distance())
                        : annulus::geometry::GearPair(pair.pinion(), Gear(parameters), pair.centre_distance());
  return problem;
}

std::vector<double> row(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

/// What is removed at a radius (m) and a position from the middle of the face (m), sampled over the whole flank.
std::shared_ptr<const FlankTopography> sampled(const Gear& gear, int radii, const std::vector<double>& positions,
                                               const std::function<double(double, double)>& removed) {
  const auto [low, high] = std::minmax({gear.form_radius(), gear.tip_radius()});
  const auto places = row(low, high, radii);
  Eigen::MatrixXd grid(radii, static_cast<Eigen::Index>(positions.size()));
  for (int i = 0; i < radii; ++i)
    for (std::size_t j = 0; j < positions.size(); ++j)
      grid(i, static_cast<Eigen::Index>(j)) = removed(places[static_cast<std::size_t>(i)], positions[j]);
  return std::make_shared<const FlankTopography>(places, positions, grid);
}

}  // namespace

// The planet meets the sun with the leading flanks of its teeth and the ring with the trailing ones; sun and ring carry
// with their leading ones.
BOOST_AUTO_TEST_CASE(a_measured_profile_counts_as_the_modification_of_its_shape) {
  annulus::test::Verification record("Transmission error of measured flanks that have the shape of a modification",
                                     "the same modification, of any gear and mesh; the flanks that carry nothing");
  for (const bool internal : {false, true})
    for (const bool planet : {true, false}) {
      const auto plain = mesh(internal);
      const auto& gear = planet ? plain.pair.pinion() : plain.pair.wheel();
      auto modified = gear.parameters(), measured = gear.parameters(), other = gear.parameters();
      modified.profile_crowning = 8e-6;
      modified.profile_slope = planet ? 12e-6 : -12e-6;
      const ToothProfile shape{Gear(modified)};
      const auto flank =
          sampled(gear, 25, {0.0}, [&](double r, double) { return shape.modification(shape.roll_length_at(r)); });
      const bool leading = !planet || !internal;
      const Side carries = leading ? &GearParameters::leading_topography : &GearParameters::trailing_topography,
                 idle = leading ? &GearParameters::trailing_topography : &GearParameters::leading_topography;
      measured.*carries = flank;
      other.*idle = flank;
      const auto of = [&](const GearParameters& p) { return solve_plane(with(plain, planet, p)); };
      const auto involute = solve_plane(plain), by_keys = of(modified), by_grid = of(measured);
      BOOST_TEST(largest_lte_difference(by_keys, involute) > 0.02);
      // 25 points on a flank of 9 mm: the local cubics of a square root (the roll length over the radius) and a
      // parabola.
      record.at_most("largest difference of the transmission errors", "", largest_lte_difference(by_grid, by_keys),
                     1e-4, "interpolation");
      for (std::size_t i = 0; i < by_grid.positions.size(); ++i)
        record.near("unloaded transmission error", "m", by_grid.positions[i].entry.unloaded_te,
                    by_keys.positions[i].entry.unloaded_te, 1e-8, "interpolation, a thousandth of what is removed");
      record.at_most("largest difference with the flanks that carry nothing", "",
                     largest_lte_difference(of(other), involute), 1e-12, "rounding");
    }
}

BOOST_AUTO_TEST_CASE(measured_flanks_that_change_along_the_face_load_it_as_lead_modifications_do) {
  annulus::test::Verification record("Measured flanks of a planet that change along the face",
                                     "lead crowning and slope of the same shape");
  // The planet is wider than the sun: its flanks begin 4 mm below it and end 2 mm above it.
  auto problem = sun_mesh(2);
  problem.face_width -= 6e-3;
  problem.pinion_overhang = {4e-3, 2e-3};
  auto modified = problem.pair.pinion().parameters(), measured = modified;
  modified.lead_crowning = 10e-6;
  modified.lead_slope = 24e-6;
  modified.profile_slope = 6e-6;
  const ToothProfile shape{Gear(modified)};
  const double width = modified.face_width;
  measured.leading_topography =
      sampled(problem.pair.pinion(), 25, row(-width / 2, width / 2, 13), [&](double r, double z) {
        return shape.lead_modification(z + width / 2) + shape.modification(shape.roll_length_at(r));
      });
  ContactBench by_keys(with(problem, true, modified), 0, Fidelity::solid),
      by_grid(with(problem, true, measured), 0, Fidelity::solid);
  for (const double phase : {0.05, 0.5}) {
    const auto a = by_keys.solve(phase, nominal_load), b = by_grid.solve(phase, nominal_load);
    BOOST_TEST(a.face_load_factor > 1.1);
    record.close("transmission error", "m", b.entry.lte, a.entry.lte, 1e-4, "interpolation");
    record.close("face load factor", "", b.face_load_factor, a.face_load_factor, 1e-3, "interpolation");
    record.near("unloaded transmission error", "m", b.entry.unloaded_te, a.entry.unloaded_te, 2e-8,
                "interpolation, a thousandth of what is removed");
  }
}

// What is missing on one flank is left over on the other, or taken back by a misalignment: the load is even again.
BOOST_AUTO_TEST_CASE(deviations_that_compensate_each_other_change_nothing) {
  annulus::test::Verification record("Measured flanks of planet and sun that compensate each other along the face",
                                     "flanks without deviations");
  const auto plain = sun_mesh(2);
  auto planet = plain.pair.pinion().parameters(), sun = plain.pair.wheel().parameters();
  const double width = planet.face_width;
  const auto sloped = [&](const Gear& gear, double slope) {
    return sampled(gear, 9, row(-width / 2, width / 2, 5), [=](double, double z) { return slope * z / width; });
  };
  planet.leading_topography = sloped(plain.pair.pinion(), 40e-6);
  sun.leading_topography = sloped(plain.pair.wheel(), -40e-6);
  ContactBench even(plain, 0, Fidelity::solid), both(with(with(plain, true, planet), false, sun), 0, Fidelity::solid),
      tilted(with(plain, true, planet), 0, Fidelity::solid);
  tilted.misalign(-40e-6);
  const auto expected = even.solve(0.3, nominal_load);
  for (auto* bench : {&both, &tilted}) {
    const auto found = bench->solve(0.3, nominal_load);
    record.near("unloaded transmission error", "m", found.entry.unloaded_te, expected.entry.unloaded_te, 1e-12,
                "rounding");
    record.close("transmission error", "m", found.entry.lte, expected.entry.lte, 1e-5, "three slices a cell, not two");
    record.close("face load factor", "", found.face_load_factor, expected.face_load_factor, 1e-3,
                 "three slices a cell, not two");
  }
}

BOOST_AUTO_TEST_CASE(models_refuse_measured_flanks_that_they_cannot_represent) {
  auto problem = mesh(false);
  auto measured = problem.pair.pinion().parameters();
  const auto solve = [&](const std::vector<double>& positions, Fidelity fidelity) {
    measured.leading_topography =
        sampled(problem.pair.pinion(), 8, positions, [](double, double z) { return 1e-4 * z; });
    annulus::fem::LoadedMeshSettings settings;
    settings.fidelity = fidelity;
    (void)annulus::fem::solve_loaded_mesh(with(problem, true, measured), settings);
  };
  const auto says = [](const char* part) {
    return [part](const annulus::InputError& e) { return std::string(e.what()).find(part) != std::string::npos; };
  };
  BOOST_CHECK_EXCEPTION(solve(row(-0.04, 0.04, 5), Fidelity::plane), annulus::InputError, says("model = \"solid\""));
  for (const auto fidelity : {Fidelity::closed_form, Fidelity::resolved_plane, Fidelity::resolved_solid})
    BOOST_CHECK_EXCEPTION(solve({0.01}, fidelity), annulus::InputError, says("model = \"automatic\""));
}

// The teeth are solved as if they ended where their chamfers begin. Left whole, and kept from touching there by a
// measured flank that falls off as the chamfer does, they have too much material instead of too little.
BOOST_AUTO_TEST_CASE(a_chamfered_tip_lies_between_a_tip_cut_off_and_a_whole_one) {
  annulus::test::Verification record("Transmission error of gears with tip chamfers of 0.1 to 0.4 modules",
                                     "whole teeth, which do not touch where the chamfer is");
  for (const bool internal : {false, true})
    for (const bool planet : {true, false})
      for (const double modules : {0.1, 0.2, 0.4}) {
        const auto plain = mesh(internal);
        const auto& gear = planet ? plain.pair.pinion() : plain.pair.wheel();
        auto chamfered = gear.parameters(), whole = chamfered;
        chamfered.tip_chamfer = modules * chamfered.module;
        const Gear cut(chamfered);
        const double end = cut.tip_form_radius(), outwards = planet || !internal ? 1 : -1;
        BOOST_TEST(end == cut.tip_radius() - outwards * chamfered.tip_chamfer);
        // Normal to the flank, under a chamfer of 45 degrees at a pressure angle of some 30.
        const Side carries =
            planet && internal ? &GearParameters::trailing_topography : &GearParameters::leading_topography;
        whole.*carries =
            sampled(gear, 400, {0.0}, [&](double r, double) { return 0.3 * std::max(0.0, outwards * (r - end)); });
        const auto problem = with(plain, planet, chamfered);
        BOOST_TEST(problem.pair.contact_ratio() < plain.pair.contact_ratio());
        const auto by_chamfer = solve_plane(problem), by_gap = solve_plane(with(plain, planet, whole));
        BOOST_TEST_MESSAGE("chamfer " << modules << ": " << largest_lte_difference(by_chamfer, by_gap) << ", sharp "
                                      << largest_lte_difference(by_chamfer, solve_plane(plain)));
        record.at_most("largest difference of the transmission errors over the stated error of the chamfer", "",
                       largest_lte_difference(by_chamfer, by_gap) / annulus::fem::chamfer_error(problem), 1,
                       "the stated error");
      }
}

BOOST_AUTO_TEST_SUITE_END()
