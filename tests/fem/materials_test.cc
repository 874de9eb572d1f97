#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/contact/hertz.h"
#include "fem/loaded_mesh.h"
#include "tests/verification_record.h"

/// Gears of different materials.
BOOST_AUTO_TEST_SUITE(mesh_materials)

using namespace annulus::fem;
using annulus::geometry::Gear;
using annulus::geometry::GearPair;

const Material steel{206e9, 0.3, 7850}, plastic{3e9, 0.38, 1400};

/// Two equal gears: what the one is made of and what the other are the same but for the direction of rotation.
LoadedMeshProblem twins(const MeshMaterials& materials) {
  annulus::geometry::GearParameters parameters;
  parameters.teeth = 30;
  parameters.module = 2e-3;
  parameters.pressure_angle = M_PI / 9;
  parameters.face_width = 0.02;
  const Gear gear(parameters);
  LoadedMeshProblem problem{GearPair(gear, gear, 0.06)};
  problem.materials = materials;
  problem.face_width = 0.02;
  problem.pinion_bore_radius = problem.wheel_support_radius = 0.012;
  problem.loads = {20};
  problem.phases = 16;
  return problem;
}

double mean_compliance(const MeshMaterials& materials, Fidelity fidelity) {
  LoadedMeshSettings settings;
  settings.fidelity = fidelity;
  settings.degree = 2;
  if (fidelity == Fidelity::plane) settings.level = 1;
  const auto result = solve_loaded_mesh(twins(materials), settings);
  double sum = 0;
  for (int phase = 0; phase < 16; ++phase) sum += 1 / result.table.at(0, phase, 0).stiffness_secant;
  return sum / 16;
}

BOOST_AUTO_TEST_CASE(the_width_of_a_contact_follows_both_moduli) {
  // [Johnson1985, 4.2]: on a rigid body E* is E / (1 - nu^2), between equal ones half of it.
  const Material rigid{1e30, 0.3, 7850};
  const double alone = MeshMaterials(plastic, rigid).contact_modulus(),
               equal = MeshMaterials(plastic).contact_modulus();
  BOOST_TEST(alone == 3e9 / (1 - 0.38 * 0.38), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(equal == alone / 2, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(hertz_half_width(1e4, 100, MeshMaterials(plastic, rigid)) ==
                 hertz_half_width(1e4, 100, MeshMaterials(plastic)) / std::sqrt(2.0),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(MeshMaterials(steel, plastic).youngs_modulus() == 2 / (1 / 206e9 + 1 / 3e9),
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(twins_of_two_materials) {
  annulus::test::Verification record(
      "Equal gears of steel and plastic",
      "symmetry: either gear may be the one of steel. Superposition: the compliance is the mean of that of two steel "
      "and two plastic gears");
  for (const auto& [fidelity, name] : {std::pair{Fidelity::plane, "plane"}, {Fidelity::closed_form, "closed form"}}) {
    const double mixed = mean_compliance({steel, plastic}, fidelity),
                 other = mean_compliance({plastic, steel}, fidelity), soft = mean_compliance(plastic, fidelity),
                 hard = mean_compliance(steel, fidelity);
    record.close(std::string("mean compliance, the other one of steel, ") + name, "m/N", other, mixed, 5e-3,
                 "16 positions of a mesh cycle, passed in opposite directions");
    // The contact becomes narrower on steel, and where two pairs share the load the shares change: some per cent.
    record.close(std::string("mean compliance of steel and plastic, ") + name, "m/N", mixed, (soft + hard) / 2, 0.03,
                 "local contact and load shares are not linear");
    BOOST_TEST(soft > 50 * hard, name);
  }
  record.close("mean compliance, closed form against plane elements", "m/N",
               mean_compliance({steel, plastic}, Fidelity::closed_form),
               mean_compliance({steel, plastic}, Fidelity::plane), 0.05,
               "accuracy of the formulas for two gears of steel");
}

BOOST_AUTO_TEST_SUITE_END()
