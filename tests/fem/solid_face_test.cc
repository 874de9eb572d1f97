#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "core/errors.h"
#include "fem/face_shape.h"
#include "fem/problem/solved_pair.h"
#include "fem/solid_face.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Solid gears in contact under given approaches.
BOOST_AUTO_TEST_SUITE(solid_face)

using namespace annulus::tests;
using annulus::FaceLaw;
using annulus::fem::Fidelity;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedMeshSettings;
using annulus::fem::SolidFace;

constexpr double degree = M_PI / 180;

std::unique_ptr<SolidFace> face_of(const LoadedMeshProblem& problem) {
  LoadedMeshSettings settings;
  settings.fidelity = Fidelity::solid;
  return std::make_unique<SolidFace>(problem, settings, 0);
}

double normal_factor(const LoadedMeshProblem& problem) { return std::cos(problem.pair.pinion().base_helix_angle()); }

Eigen::VectorXd even_approach(const FaceLaw& law, double approach) {
  Eigen::VectorXd a = Eigen::VectorXd::Constant(law.size(), approach);
  a[law.size() - 1] = 0;
  return a;
}

// The transmission error under a load, imposed instead, gives the load: the same bodies with their pressure elements
// sized for twice the load, so 1.4 times as long.
BOOST_AUTO_TEST_CASE(imposed_transmission_error_gives_the_load) {
  annulus::test::Verification record("Solid gears under a given approach", "the same gears under a given load");
  for (const auto& problem :
       {with_helix(sun_mesh(2), 12 * degree), with_helix(ring_mesh(annulus::fem::OutsideHeld{}, 2), 12 * degree),
        with_planet_lead(sun_mesh(2), 10e-6, 15e-6)}) {
    auto as_solved = problem;
    as_solved.pair = annulus::fem::solved_pair(problem.pair);
    ContactBench bench(as_solved, 0, Fidelity::solid);
    const auto face = face_of(problem);
    const double c = normal_factor(problem);
    for (const double phase : {0.0, 0.3125, 0.75}) {
      const auto position = bench.solve(phase, nominal_load);
      const auto law = face->at(7 + phase, nominal_load / c);
      const auto approach = even_approach(*law, c * position.entry.lte);
      const auto state = law->at(approach);
      record.close("load of three meshes, three phases", "N", c * law->force(state), nominal_load, 3e-3,
                   "length of the pressure elements");
      const double tangent = c * c * state.tangent.topLeftCorner(law->size() - 1, law->size() - 1).sum();
      record.close("tangent stiffness", "N/m", tangent, position.entry.stiffness_tangent, 1e-2,
                   "length of the pressure elements");
      const Eigen::VectorXd line = law->line_load(approach, state);
      double worst = 0;
      for (std::size_t s = 0; s < position.line_load.size(); ++s)
        worst = std::max(worst, std::abs(c * line[static_cast<Eigen::Index>(s)] - position.line_load[s]));
      record.at_most("line load, largest difference over the mean", "", worst * problem.face_width / nominal_load, 1e-2,
                     "length of the pressure elements");
    }
  }
}

// Energy by differences: a smooth part of the law, where no contact begins or ends.
BOOST_AUTO_TEST_CASE(force_and_tangent_belong_to_the_energy) {
  annulus::test::Verification record("Law of solid gears along their face", "differences of its energy and its force");
  const auto problem = with_helix(sun_mesh(2), 12 * degree);
  const auto face = face_of(problem);
  const auto law = face->at(0.4, nominal_load);
  auto at = even_approach(*law, 30e-6);
  for (Eigen::Index s = 0; s + 1 < at.size(); ++s) at[s] += 2e-4 * law->stations()[static_cast<std::size_t>(s)];
  at[at.size() - 1] = 5e-5;
  const auto state = law->at(at);
  BOOST_TEST((state.tangent - state.tangent.transpose()).cwiseAbs().maxCoeff() == 0.0);
  double force = 0, tangent = 0;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double step = i + 1 < at.size() ? 1e-9 : 1e-7;
    Eigen::VectorXd up = at, down = at;
    up[i] += step;
    down[i] -= step;
    const auto high = law->at(up), low = law->at(down);
    force = std::max(force, std::abs((high.energy - low.energy) / (2 * step) - state.force[i]) /
                                state.force.head(at.size() - 1).maxCoeff());
    tangent = std::max(tangent, ((high.force - low.force) / (2 * step) - state.tangent.col(i)).cwiseAbs().maxCoeff() /
                                    state.tangent.col(i).cwiseAbs().maxCoeff());
  }
  record.at_most("force, largest relative difference", "", force, 1e-5, "rounding over the step");
  record.at_most("tangent, largest relative difference", "", tangent, 1e-3, "contacts that change within the step");
}

// What a misalignment of the flanks takes off the approach, a tilt of the bodies takes off; what a slope of the
// planet's profile does along the path of contact, a lean does.
BOOST_AUTO_TEST_CASE(tilt_and_lean_are_what_flanks_of_that_form_do) {
  annulus::test::Verification record("Tilt and lean of solid gears", "misaligned and sloped flanks of straight bodies");
  const auto problem = with_helix(sun_mesh(2), 12 * degree);
  const auto straight = face_of(problem);
  const double c = normal_factor(problem);
  auto misaligned = problem;
  misaligned.misalignment = 40e-6;
  const auto other = face_of(misaligned);
  auto parameters = problem.pair.pinion().parameters();
  parameters.profile_slope = 20e-6;
  auto sloped = problem;
  sloped.pair = {annulus::geometry::Gear(parameters), problem.pair.wheel(), problem.pair.centre_distance()};
  const auto of_slope = face_of(sloped);
  // 20 um over the usable flank, from its root (roll length of the form circle) to the tip; the sun drives, so that the
  // planet's roll lengths fall along the line of action into it.
  const auto& planet = problem.pair.pinion();
  const auto roll = [&](double radius) {
    return std::sqrt(radius * radius - planet.base_radius() * planet.base_radius());
  };
  const double per_metre = 20e-6 / (roll(planet.tip_form_radius()) - roll(planet.form_radius()));
  for (const double phase : {0.0, 0.4}) {
    const auto law = straight->at(phase, nominal_load), with = other->at(phase, nominal_load),
               slope = of_slope->at(phase, nominal_load);
    const auto even = even_approach(*law, 40e-6);
    auto tilted = even;
    for (Eigen::Index s = 0; s + 1 < tilted.size(); ++s)
      tilted[s] -= 40e-6 * law->stations()[static_cast<std::size_t>(s)] / problem.face_width;
    const auto a = law->at(tilted), b = with->at(even);
    const double mean = law->force(a) / static_cast<double>(law->size() - 1);
    record.at_most("tilt: forces of slices, largest difference over the mean", "",
                   (a.force - b.force).head(law->size() - 1).cwiseAbs().maxCoeff() / mean, 1e-9, "rounding");
    auto leaning = even;
    leaning[law->size() - 1] = per_metre;
    // The slope begins at the root, the lean at the pitch point.
    leaning.head(law->size() - 1).array() -=
        c * per_metre * (problem.pair.roll_length_pitch() - roll(planet.form_radius())) / c;
    const auto l = law->at(leaning), m = slope->at(even);
    const auto without = law->at(even);
    BOOST_TEST((without.force - m.force).head(law->size() - 1).cwiseAbs().maxCoeff() > 0.2 * mean);
    record.at_most("lean: forces of slices, largest difference over the mean", "",
                   (l.force - m.force).head(law->size() - 1).cwiseAbs().maxCoeff() / mean, 2e-2,
                   "slope normal to the flank along an arc; windows of the elements");
  }
}

// Two numbers per phase for the weights of the places, one for their gap: with them straight flanks have the force and
// the moment of the gears, and so have slightly tilted ones. The moment of helical gears moves with the phase.
BOOST_AUTO_TEST_CASE(reduced_face_has_force_and_moment_of_the_gears) {
  annulus::test::Verification record("Solid gears reduced to force and moment", "the gears themselves");
  auto misaligned = sun_mesh(2);
  misaligned.misalignment = 15e-6;
  for (const auto& problem : {sun_mesh(2), with_helix(sun_mesh(2), 12 * degree), misaligned}) {
    const auto face = face_of(problem);
    constexpr int phases = 4, places = 1000;
    const auto shape = annulus::fem::reduced_face(*face, nominal_load, phases, 2);
    double least = 1, most = -1;
    for (int p = 0; p < phases; ++p) {
      const auto law = face->at(static_cast<double>(p) / phases, nominal_load);
      const auto index = static_cast<std::size_t>(p);
      const double slope = shape.slope[index], curvature = shape.curvature[index], gap = shape.gap_slope[index];
      double low = 0, high = 80e-6;
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (law->force(law->at(even_approach(*law, middle))) < nominal_load ? low : high) = middle;
      }
      const auto state = law->at(even_approach(*law, low));
      const double tangent = state.tangent.topLeftCorner(law->size() - 1, law->size() - 1).sum();
      BOOST_TEST_REQUIRE(shape.tilted != nullptr);
      for (const double share : {0.5, -0.5}) {
        const double tilt = share * nominal_load / tangent, g = shape.tilted->gap_slope[index];
        const double mean = shape.tilted->slope[index] / 3,
                     square = 1.0 / 3 + 2.0 / 15 * shape.tilted->curvature[index];
        auto at = even_approach(*law, low);
        for (Eigen::Index s = 0; s + 1 < at.size(); ++s)
          at[s] += tilt * 2 * law->stations()[static_cast<std::size_t>(s)] / problem.face_width;
        const auto exact = law->at(at);
        double moment = 0;
        for (Eigen::Index s = 0; s + 1 < at.size(); ++s)
          moment += exact.force[s] * 2 * law->stations()[static_cast<std::size_t>(s)] / problem.face_width;
        const double found = nominal_load * mean + tangent * (tilt * square - g * (square - mean * mean));
        record.at_most("moment of the shape between tilts of half the approach, the same", "",
                       std::abs(found - moment) / nominal_load, 1e-5, "bisection of the approach");
      }
      for (const double share : {0.0, 0.05, -0.05}) {
        const double tilt = share * nominal_load / tangent;
        auto at = even_approach(*law, low);
        double moment = 0, reduced_force = 0, reduced_moment = 0;
        for (Eigen::Index s = 0; s + 1 < at.size(); ++s)
          at[s] += tilt * 2 * law->stations()[static_cast<std::size_t>(s)] / problem.face_width;
        const auto tilted = law->at(at);
        for (Eigen::Index s = 0; s + 1 < at.size(); ++s)
          moment += tilted.force[s] * 2 * law->stations()[static_cast<std::size_t>(s)] / problem.face_width;
        for (int i = 0; i < places; ++i) {
          const double z = (2 * i + 1.0) / places - 1;
          const double weight = (1 + slope * z + curvature * (1.5 * z * z - 0.5)) / places;
          const double force = weight * (nominal_load + tangent * (tilt * z - gap * (z - slope / 3)));
          reduced_force += force;
          reduced_moment += z * force;
        }
        record.close("force, straight flanks and tilts of 5 % of the approach", "N", reduced_force, law->force(tilted),
                     share == 0 ? 1e-5 : 3e-3, "second order of the tilt");
        record.at_most("moment over force x half the face width, the same", "",
                       std::abs(reduced_moment - moment) / nominal_load, 3e-3,
                       "second order of the tilt, windows of the pressure elements");
        if (share == 0) {
          least = std::min(least, moment / nominal_load);
          most = std::max(most, moment / nominal_load);
        }
      }
    }
    if (problem.pair.pinion().base_helix_angle() != 0) BOOST_TEST(most - least > 0.01);
  }
}

// One end alone: the load there is far above the expected one, and elements and search follow.
BOOST_AUTO_TEST_CASE(a_face_that_carries_at_one_end) {
  const auto problem = sun_mesh(2);
  const auto face = face_of(problem);
  const auto law = face->at(0.1, nominal_load / 20);
  auto at = even_approach(*law, 0);
  for (Eigen::Index s = 0; s + 1 < at.size(); ++s)
    at[s] = 200e-6 * (2 * law->stations()[static_cast<std::size_t>(s)] / problem.face_width);
  const auto state = law->at(at);
  BOOST_TEST(state.force[0] == 0);
  BOOST_TEST(law->force(state) > nominal_load);
  // The same from a fresh start.
  const auto fresh = face->at(0.1, nominal_load / 20)->at(at);
  BOOST_TEST((state.force - fresh.force).cwiseAbs().maxCoeff() <= 1e-9 * state.force.maxCoeff());
}

BOOST_AUTO_TEST_CASE(what_has_no_solid_face_is_refused) {
  LoadedMeshSettings settings;
  settings.fidelity = Fidelity::plane;
  BOOST_CHECK_THROW(SolidFace(sun_mesh(2), settings, 1), annulus::InputError);
  settings.fidelity = Fidelity::solid;
  BOOST_CHECK_THROW(SolidFace(ring_mesh(paper_pins(24, 0), 2), settings, 0), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
