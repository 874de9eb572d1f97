#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/loaded_mesh.h"
#include "tests/verification_record.h"

namespace {

/// ISO 6336-1:2006, method B; N/(mm um).
double iso_single_stiffness(double z1, double x1, double z2, double x2, double alpha_deg, double dedendum) {
  const double q = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 -
                   0.24188 * x2 / z2 + 0.00529 * x1 * x1 + 0.00182 * x2 * x2;
  const double basic_rack = (1 + 0.5 * (1.2 - dedendum)) * (1 - 0.02 * (20 - alpha_deg));
  return basic_rack / q;
}

/// Tangential displacement at the base circle per force and width by the torsion of the body between hub and root:
/// u = F' r_b^2 / (4 pi G) (1/r_hub^2 - 1/r_root^2), the closed form of a ring under opposite shear tractions; m^2/N.
double body_torsion(const annulus::geometry::Gear& gear, double hub_radius, const annulus::fem::Material& material) {
  const double shear_modulus = material.youngs_modulus / (2 * (1 + material.poisson_ratio));
  return std::pow(gear.base_radius(), 2) / (4 * std::acos(-1.0) * shear_modulus) *
         (1 / (hub_radius * hub_radius) - 1 / std::pow(gear.root_radius(), 2));
}

}  // namespace

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
  const double torsion = body_torsion(planet, planet_hub, {}) + body_torsion(sun, sun_hub, {});
  const double computed = 1 / (width / largest - torsion) * 1e-9;
  const double published = iso_single_stiffness(48, 0.7608, 55, 0.7361, 22.5, 1.25);
  BOOST_TEST_MESSAGE("single stiffness " << computed << " N/(mm um), ISO 6336-1 " << published);
  record.near("largest stiffness with a single pair, bodies taken off", "N/(mm um)", computed, published,
              0.10 * published, "accuracy ascribed to the formula (tests/verification/iso6336_stiffness/README.md)");
}

BOOST_AUTO_TEST_SUITE_END()
