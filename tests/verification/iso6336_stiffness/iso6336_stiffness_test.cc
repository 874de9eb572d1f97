#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/loaded_mesh.h"
#include "geometry/iso6336.h"
#include "tests/verification/body_torsion.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(iso6336_stiffness)

BOOST_AUTO_TEST_CASE(single_pair_of_the_sun_mesh) {
  annulus::test::Verification record("Single stiffness of the sun mesh of the ring paper", "ISO 6336-1:2006, method B");
  using annulus::geometry::Gear;
  using annulus::geometry::GearKind;
  const double degree = std::acos(-1.0) / 180, width = 88e-3;
  const Gear planet({GearKind::external, 55, 3.8e-3, 22.5 * degree, 0.7361, width});
  const Gear sun({GearKind::external, 48, 3.8e-3, 22.5 * degree, 0.7608, width});
  // The formula is for solid bodies: the hubs are kept away from the teeth, the torsion down to them is taken off.
  const double planet_hub = 0.060, sun_hub = 0.045, load = 59460;
  annulus::fem::LoadedMeshProblem problem{
      annulus::geometry::GearPair(planet, sun, 0.201), {}, width, planet_hub, sun_hub};
  problem.loads = {load};
  problem.phases = 32;
  const auto result = annulus::fem::solve_loaded_mesh(problem, {});

  double largest = 0;
  for (const auto& position : result.positions)
    for (const double share : position.pair_share)
      if (share > 1 - 1e-9) largest = std::max(largest, position.entry.stiffness_secant);
  BOOST_TEST_REQUIRE(largest > 0);  // the contact ratio 1.54 leaves positions with a single pair
  const double torsion =
      annulus::test::body_torsion(planet, planet_hub, {}) + annulus::test::body_torsion(sun, sun_hub, {});
  const double computed = 1 / (width / largest - torsion) * 1e-9;
  const double published = annulus::geometry::iso_6336_stiffness(problem.pair).theoretical * 1e-9;
  BOOST_TEST_MESSAGE("single stiffness " << computed << " N/(mm um), ISO 6336-1 " << published);
  record.near("largest stiffness with a single pair, bodies taken off", "N/(mm um)", computed, published,
              0.10 * published, "accuracy ascribed to the formula (tests/verification/iso6336_stiffness/README.md)");
}

BOOST_AUTO_TEST_SUITE_END()
