#include "dynamics/systems/planetary/initial_spread.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "stages.h"
#include "tests/verification_record.h"

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr const char *sun_sharing = "sun_planet_load_sharing_instantaneous",
                     *ring_sharing = "ring_planet_load_sharing_instantaneous";

PlanetaryStage at_speed(double revolutions) {
  auto stage = stages::backlash_paper();
  stage.set_half_backlash(10e-6);
  stage.carrier_speed *= revolutions / 1500;
  return stage;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(initial_spread_of_motions)

BOOST_AUTO_TEST_CASE(all_starts_lead_to_the_one_exact_motion_where_it_is_the_only_one) {
  test::Verification record("Motions from random starts where there is one only", "the exact piecewise solution");
  const auto stage = at_speed(1500);
  const auto spread = initial_spread(stage, {.random_starts = 3});
  BOOST_TEST(spread.starts.size() == 4u);
  BOOST_TEST(spread.attractors == 1);
  BOOST_TEST(spread.unsteady == 0);
  BOOST_TEST(spread.high.value("sun_planet_contact_loss") == 0.0);
  BOOST_TEST(spread.high.value("ring_planet_contact_loss") == 0.0);
  // Windows agree to 1e-3 of the mean force where they count as steady, mostly far better.
  record.at_most("spread of the load sharing coefficient", "",
                 spread.high.value(sun_sharing) - spread.low.value(sun_sharing), 1e-3, "windows that count as steady");
  const auto exact = evaluate_point(stage, {.simulation = {}, .motion = false}).figures;
  record.close("load sharing coefficient, sun meshes", "", spread.starts[0].figures.value(sun_sharing),
               exact.value(sun_sharing), 1e-3, "windows that count as steady");
  // The peak of the ring meshes stands between samples of the time integration.
  record.close("load sharing coefficient, ring meshes", "", spread.starts[0].figures.value(ring_sharing),
               exact.value(ring_sharing), 5e-3, "peak between samples of the time integration");
}

// Below a resonance gap makes soft, a motion with closed teeth and one that loses contact stand side by side.
BOOST_AUTO_TEST_CASE(two_motions_are_found_beside_a_softening_resonance) {
  test::Verification record("Two motions beside a softening resonance",
                            "the exact piecewise solution, where contact holds");
  const auto stage = at_speed(5000);
  const auto spread = initial_spread(stage), again = initial_spread(stage);
  BOOST_TEST(spread.attractors == 2);
  BOOST_TEST(spread.low.value("ring_planet_contact_loss") == 0.0);
  BOOST_TEST(std::max(spread.high.value("sun_planet_contact_loss"), spread.high.value("ring_planet_contact_loss")) >
             0.1);
  BOOST_TEST(spread.high.value(ring_sharing) > 1.3 * spread.low.value(ring_sharing));
  const auto exact = evaluate_point(stage, {.simulation = {}, .motion = false}).figures;
  record.close("lower load sharing coefficient, sun meshes", "", spread.low.value(sun_sharing),
               exact.value(sun_sharing), 2e-3, "windows that count as steady");
  for (std::size_t i = 0; i < spread.starts.size(); ++i) {
    BOOST_TEST(spread.starts[i].attractor == again.starts[i].attractor);
    BOOST_TEST(spread.starts[i].figures.value(sun_sharing) == again.starts[i].figures.value(sun_sharing));
  }
}

BOOST_AUTO_TEST_CASE(wrong_options_are_refused) {
  BOOST_CHECK_THROW((void)initial_spread(at_speed(1500), {.factor = 0}), InputError);
  BOOST_CHECK_THROW((void)initial_spread(at_speed(1500), {.random_starts = -1}), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
