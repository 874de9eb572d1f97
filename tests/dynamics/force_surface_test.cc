#include "dynamics/system/force_surface.h"
#include "core/floating_point.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "dynamics/system/mesh_excitation.h"
#include "tests/dynamics/tables.h"

BOOST_AUTO_TEST_SUITE(force_surface)

using namespace annulus::dynamics;
using tables::BentTable;

BentTable ring_like() {
  BentTable bent;
  bent.positions = 3;
  return bent;
}

BOOST_AUTO_TEST_CASE(tabulated_points_are_passed_with_their_tangents) {
  const auto table = ring_like().table();
  const ForceSurface surface(table);
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase)
      for (int load = 0; load < 3; ++load) {
        const auto& e = table.at(position, phase, load);
        const auto value = surface(position + static_cast<double>(phase) / table.phases(), e.lte - e.unloaded_te);
        // A least-squares solve of some 60 values, then sums of 16 coefficients.
        BOOST_TEST(std::abs(value.force / table.loads()[load] - 1) <= 1e-11);
        BOOST_TEST(std::abs(value.tangent / e.stiffness_tangent - 1) <= 1e-11);
      }
  BOOST_TEST(surface.resampling_error() <= 1e-11);
}

BOOST_AUTO_TEST_CASE(between_the_loads_it_follows_the_law_the_table_was_made_from) {
  // F ~ g^(1/0.9). The interpolant has the exact tangents, so it is of fourth order in the distance of the loads:
  // halved distances leave a sixteenth. Below the lowest load the parabola stands,
  // and the cell it ends in resamples the change of curvature there (some 1e-4 of the load): both are left out.
  double previous = 0;
  for (const int intervals : {2, 4}) {
    BentTable bent;
    bent.ripple = 0;
    bent.phases = 1;
    bent.shares.clear();
    for (int i = 0; i <= intervals; ++i) bent.shares.push_back(0.5 + 1.5 * i / intervals);
    const ForceSurface surface(bent.table());
    double worst = 0;
    for (double share = 0.8; share < 2; share += 0.01) {
      const double load = share * bent.nominal;
      worst = std::max(worst, std::abs(surface(0, bent.deflection(0, load)).force / load - 1));
    }
    if (previous > 0) {
      BOOST_TEST(std::log2(previous / worst) > 3);
    }
    previous = worst;
  }
  BOOST_TEST(previous < 3e-5);
}

BOOST_AUTO_TEST_CASE(at_the_nominal_load_it_agrees_with_the_secant_curve) {
  const auto bent = ring_like();
  const auto table = bent.table();
  const auto linear = table_stiffness(table, bent.nominal);
  const ForceSurface surface(table);
  double worst = 0;
  for (double x = 0; x < 3; x += 0.01) {
    const double g = bent.nominal / linear.secant(x);
    worst = std::max(worst, std::abs(surface(x, g).force / bent.nominal - 1));
  }
  // Both interpolate 16 values of a cosine of amplitude 0.13, one of the stiffness, one of the force: makima is second
  // order near extrema, (2 pi/16)^2/16 x 0.13 = 1e-3 at most.
  BOOST_TEST(worst <= 1e-3);
}

BOOST_AUTO_TEST_CASE(tangent_and_energy_are_consistent_with_the_force) {
  const auto bent = ring_like();
  const ForceSurface surface(bent.table());
  const double scale = bent.deflection(0, bent.nominal), h = 1e-4 * scale, dx = 1e-4;
  for (double x = -0.37; x < 7; x += 0.317)
    for (const double g : {-1.3 * scale, -0.2 * scale, 0.04 * scale, 0.5 * scale, 1.1 * scale, 3.1 * scale}) {
      const auto value = surface(x, g);
      const double slope = (surface(x, g + h).force - surface(x, g - h).force) / (2 * h);
      // Cubic pieces: (h/step)^2 = 1e-6 of the change of the tangent over a cell.
      BOOST_TEST(std::abs(slope / value.tangent - 1) <= 1e-6);
      const double work = (surface.energy(x, g + h) - surface.energy(x, g - h)) / (2 * h);
      BOOST_TEST(std::abs(work / value.force - 1) <= 1e-5);  // h^2/6 F''/F, at 0.04 x scale (h/g)^2/6
      const double rate = (surface.energy(x + dx, g) - surface.energy(x - dx, g)) / (2 * dx);
      // (16 dx)^2 = 3e-6 of the largest rate over a cycle, 0.8 x ripple x energy.
      BOOST_TEST(std::abs(rate - surface.energy_rate(x, g)) <= 1e-5 * surface.energy(x, g));
      BOOST_TEST(surface.energy(x, g) > 0);
    }
}

BOOST_AUTO_TEST_CASE(it_is_smooth_across_cells_and_periodic) {
  const auto bent = ring_like();
  const ForceSurface surface(bent.table());
  const double largest = 1.75 * bent.nominal, scale = 3.4e-5 * 2;
  const double tiny = 1e-9;
  for (int piece = 0; piece < 48; ++piece)
    for (const double g : {0.3 * scale, 0.77 * scale}) {
      const double x = piece / 16.0;
      const auto before = surface(x - tiny, g), after = surface(x + tiny, g), again = surface(x + 3, g);
      // 2e-9 cycles x slope of some 2 pi x 0.13 x F.
      BOOST_TEST(std::abs(before.force - after.force) <= 1e-8 * largest);
      BOOST_TEST(std::abs(before.tangent / after.tangent - 1) <= 1e-7);
      BOOST_TEST(std::abs(surface(x, g).force - again.force) <= 1e-12 * largest);
      const double left = surface.energy_rate(x - tiny, g), right = surface.energy_rate(x + tiny, g);
      BOOST_TEST(std::abs(left - right) <= 1e-6 * surface.energy(x, g));  // once continuously differentiable
    }
  // Along g: walk over all cells with a step far below their size; the tangent never jumps.
  for (double g = 0; g < 1.5 * scale; g += scale / 5000)
    BOOST_TEST(std::abs(surface(0.4, g).tangent / surface(0.4, g + scale / 5000).tangent - 1) <= 0.01);
}

BOOST_AUTO_TEST_CASE(it_is_odd_and_straight_beyond_the_largest_load) {
  const auto bent = ring_like();
  const auto table = bent.table();
  const ForceSurface surface(table);
  const auto& e = table.at(1, 5, 2);
  const double x = 1 + 5.0 / 16, g = e.lte - e.unloaded_te;
  for (const double share : {0.1, 0.6, 1.0, 2.5})
    BOOST_TEST(surface(x, -share * g).force == -surface(x, share * g).force);
  BOOST_TEST(surface(x, 0).force == 0.0);
  // The cells end at the largest deflection of all phases; up to there the straight line is resampled, too.
  for (const double beyond : {1.5, 3.0, 100.0}) {
    const auto value = surface(x, beyond * g);
    BOOST_TEST(std::abs(value.force / (table.loads()[2] + e.stiffness_tangent * (beyond - 1) * g) - 1) <= 1e-4);
    BOOST_TEST(std::abs(value.tangent / e.stiffness_tangent - 1) <= 1e-4);
  }
  const annulus::UntrappedFloatingPoint untrapped;
  BOOST_TEST(std::isnan(surface(x, NAN).force));
}

BOOST_AUTO_TEST_CASE(a_linear_table_gives_a_linear_law) {
  BentTable bent = ring_like();
  bent.bend = 0;
  const ForceSurface surface(bent.table());
  for (int i = 0; i < 48; ++i)
    for (const double g : {1e-6, 2e-5, 5e-5, 1e-4}) {
      BOOST_TEST(std::abs(surface(i / 16.0, g).force / (bent.stiffness(i / 16.0) * g) - 1) <= 1e-12);
      BOOST_TEST(std::abs(surface.energy(i / 16.0, g) / (0.5 * bent.stiffness(i / 16.0) * g * g) - 1) <= 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(strongly_bent_laws_still_rise) {
  BentTable bent = ring_like();
  for (const double bend : {0.3, 0.6, -0.5}) {  // tangents 1.4, 2.5 and 0.67 times the secant
    bent.bend = bend;
    const ForceSurface surface(bent.table());
    double force = 0;
    for (double g = 1e-7; g < 2e-4; g += 1e-6) {
      const double next = surface(0.21, g).force;
      BOOST_TEST(next > force);
      force = next;
    }
  }
}

BOOST_AUTO_TEST_CASE(a_falling_deflection_is_refused) {
  std::vector<annulus::StiffnessEntry> entries{{0, 2e-6, 1e9, 1e9, 0}, {0, 1.9e-6, 2.1e9, 1e9, 0}};
  entries[0].stiffness_secant = 2e3 / 2e-6;
  entries[1].stiffness_secant = 4e3 / 1.9e-6;
  BOOST_CHECK_THROW(ForceSurface(annulus::StiffnessTable("sun_planet", 1, {0}, {2e3, 4e3}, entries)),
                    annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
