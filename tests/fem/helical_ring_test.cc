#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "contact_bench.h"
#include "fem/body/gear_body.h"
#include "fem/ring/ring_coupling.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Helical rings on pins and bolts: the outside is parallel to the axis, the teeth are not.
BOOST_AUTO_TEST_SUITE(helical_ring)

using namespace annulus::tests;
using annulus::fem::Fidelity;

constexpr double degree = M_PI / 180;
constexpr double first_pin = 0.03;  // rad: no symmetry with the teeth

annulus::fem::PinHeld bolts(int count) {
  auto held = paper_pins(count, first_pin);
  held.unilateral = false;
  return held;
}

/// Mean transmission error of a mesh cycle, m.
double mean_lte(const annulus::fem::RingStructure& structure, double helix_angle) {
  ContactBench bench(with_helix(ring_mesh(structure, 2), helix_angle), 0, Fidelity::solid);
  const auto positions = bench.sweep(8, nominal_load);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) sum += positions[i].entry.lte / 8;
  return sum;
}

BOOST_AUTO_TEST_CASE(teeth_do_not_feel_whether_a_fixed_outside_is_twisted) {
  annulus::test::Verification record("Flank compliance of a helical tooth, outside twisted and straight",
                                     "the same body in another mesh");
  const auto problem = with_helix(ring_mesh(annulus::fem::OutsideHeld{}, 2), 15 * degree);
  const annulus::geometry::ToothProfile profile(problem.pair.wheel());
  annulus::fem::GearBodyOptions options;
  options.sector.flank = annulus::geometry::Boundary::trailing_flank;
  options.sector.outputs = {annulus::fem::SectorOutput::stress};
  options.extent.max_offset = 2;
  // Of an even load on the flank, m/N.
  const auto compliance = [&](bool straight, int cells) -> double {
    annulus::geometry::SectorResolution resolution;
    resolution.flank_cells = resolution.thickness_cells = resolution.rim_cells = cells;
    annulus::geometry::ExtrudeOptions extrude;
    extrude.twist = profile.twist();
    if (straight) extrude.straight = {profile.gear().root_radius(), ring_outside, problem.face_width / 2};
    const auto mesh =
        annulus::geometry::extrude(annulus::geometry::make_sector_mesh(profile.gear(), {ring_outside, {}}, resolution),
                                   {{0, problem.face_width, 2 * cells}}, extrude);
    const auto body =
        compose_body(condense_tooth(mesh, profile, ring_outside, problem.materials.wheel, options), options);
    const auto ports = body.flank_ports();
    const Eigen::VectorXd even = Eigen::VectorXd::Constant(ports, 1.0 / ports);
    return even.dot(body.compliance.block(0).topLeftCorner(ports, ports) * even);
  };
  // The outside is fixed, so that both are one body. Cells of the rim lean by up to 30 degrees along the axis.
  const double coarse = std::abs(compliance(true, 3) / compliance(false, 3) - 1),
               fine = std::abs(compliance(true, 5) / compliance(false, 5) - 1);
  record.at_most("difference under an even load", "", fine, 3e-3, "discretisation of the rim");
  record.at_most("that difference over that of cells 5/3 larger", "", fine / coarse, 0.6, "at least first order");
}

BOOST_AUTO_TEST_CASE(a_hardly_helical_ring_on_pins_is_a_spur_ring) {
  annulus::test::Verification record("Ring on 24 pins with hardly helical teeth, 0.01 degrees", "limit: spur teeth");
  const auto pins = paper_pins(24, first_pin);
  ContactBench helical(with_helix(ring_mesh(pins, 2), 0.01 * degree), 0, Fidelity::solid);
  ContactBench spur(with_helix(ring_mesh(pins, 2), 0), 0, Fidelity::solid);
  double worst = 0, pin = 0;
  for (const double phase : {0.1, 0.4, 0.7}) {
    const auto p = helical.solve(phase, nominal_load), q = spur.solve(phase, nominal_load);
    worst = std::max(worst, std::abs(p.entry.lte / q.entry.lte - 1));
    for (std::size_t i = 0; i < p.pins.size(); ++i)
      pin = std::max(pin, std::abs(p.pins[i].radial_force - q.pins[i].radial_force) / nominal_load);
  }
  // The end face that carries the axial force cannot bulge: over a tenth of the width plane strain, stiffer by nu^2.
  const char* origin = "one end face is held along the axis";
  record.at_most("transmission error, largest relative difference", "", worst, 1e-2, origin);
  record.at_most("pin forces over the mesh force, largest difference", "", pin, 1e-2, origin);
}

BOOST_AUTO_TEST_CASE(pins_carry_the_transverse_force) {
  annulus::test::Verification record("Forces on 24 pins under helical teeth of 12 degrees",
                                     "statics: the planet's force in the transverse section, its torque");
  const auto problem = with_helix(ring_mesh(paper_pins(24, first_pin), 2), 12 * degree);
  ContactBench bench(problem, 0, Fidelity::solid);
  double size = 0, torque = 0, direction = 0;
  for (const double phase : {0.0, 0.3, 0.6}) {
    const auto p = bench.solve(phase, nominal_load);
    BOOST_TEST(p.force_balance_relative < 1e-8);
    BOOST_TEST(p.energy_balance_relative < 1e-8);
    for (const auto& pin : p.pins) BOOST_TEST(pin.radial_force >= 0);
    const auto felt = pin_resultant(p, first_pin);
    size = std::max(size, std::abs(felt.force / nominal_load - 1));
    direction = std::max(direction, std::abs(felt.direction - problem.pair.working_pressure_angle()));
    torque = std::max(torque, std::abs(felt.torque / nominal_load / problem.pair.wheel().base_radius() - 1));
  }
  record.at_most("direction of the resultant, error", "rad", direction, 3e-3, "teeth bend and turn the normals");
  record.at_most("size of the resultant, relative error", "", size, 5e-5, "square of that, a few times");
  record.at_most("torque, relative error", "", torque, 1e-8, "fourth power of the half arc of a pin");
}

BOOST_AUTO_TEST_CASE(the_hand_does_not_matter_to_pins) {
  annulus::test::Verification record("Ring on 24 pins, right- and left-handed teeth", "symmetry");
  ContactBench right(with_helix(ring_mesh(paper_pins(24, first_pin), 2), 12 * degree), 0, Fidelity::solid);
  ContactBench left(with_helix(ring_mesh(paper_pins(24, first_pin), 2), -12 * degree), 0, Fidelity::solid);
  for (const double phase : {0.1, 0.6}) {
    const auto p = right.solve(phase, nominal_load), q = left.solve(phase, nominal_load);
    record.close("transmission error", "m", p.entry.lte, q.entry.lte, 2e-3, "meshes that are not mirror images");
    double pin = 0;
    for (std::size_t i = 0; i < p.pins.size(); ++i)
      pin = std::max(pin, std::abs(p.pins[i].radial_force - q.pins[i].radial_force) / nominal_load);
    record.at_most("pin forces over the mesh force, largest difference", "", pin, 2e-3,
                   "meshes that are not mirror images");
  }
}

BOOST_AUTO_TEST_CASE(turning_pins_by_a_tooth_turns_the_ring) {
  annulus::test::Verification record("Helical ring, pins turned by a tooth", "symmetry: the next mesh cycle");
  const auto problem = with_helix(ring_mesh(paper_pins(24, first_pin), 2), 12 * degree);
  const double pitch = problem.pair.wheel().pitch_angle();
  ContactBench here(problem, 0, Fidelity::solid);
  ContactBench turned(with_helix(ring_mesh(paper_pins(24, first_pin + pitch), 2), 12 * degree), 0, Fidelity::solid);
  double same = 1, next = 0;
  for (const double phase : {0.2, 0.7}) {
    const double lte = here.solve(phase, nominal_load).entry.lte;
    same = std::min(same, std::abs(turned.solve(phase, nominal_load).entry.lte / lte - 1));
    const double ahead = turned.solve(1 + phase, nominal_load).entry.lte;
    const double behind = turned.solve(phase - 1, nominal_load).entry.lte;
    next = std::max(next, std::min(std::abs(ahead / lte - 1), std::abs(behind / lte - 1)));
  }
  record.at_most("transmission error one tooth on, largest relative difference", "", next, 1e-9, "rounding");
  BOOST_TEST(same > 1e-6);  // at the same tooth it differs
}

BOOST_AUTO_TEST_CASE(many_bolts_are_as_good_for_helical_as_for_spur_teeth) {
  annulus::test::Verification record("Ring on 81 rigid bolts over one with a fixed outside, helical over spur",
                                     "the axial force, which only helical teeth have, hardly moves the ring");
  auto held = bolts(81);
  held.radial_stiffness = held.tangential_stiffness = 1e13;
  const auto softer = [&](double angle) {
    return mean_lte(held, angle) / mean_lte(annulus::fem::OutsideHeld{}, angle);
  };
  const double spur = softer(0), helical = softer(12 * degree);
  BOOST_TEST(spur > 1);
  record.near("ratio of the mean transmission errors, helical over spur", "", helical / spur, 1, 0.03,
              "the axial part of the force, sin^2 of the helix angle, on another place of support");
}

BOOST_AUTO_TEST_CASE(coupling_through_a_helical_ring_on_pins) {
  annulus::test::Verification record("Coupling through a helical ring on 6 bolts", "limit of small helix angles");
  annulus::fem::RingCouplingSettings settings;
  settings.modes.count = 1;
  settings.motions = {1, 1};
  const auto solved = [&](double angle) {
    return solve_ring_coupling(with_helix(ring_mesh(bolts(6), 2), angle), equal_places(3), nominal_load, settings);
  };
  const auto hardly = solved(1e-4);
  settings.model = annulus::fem::RingModel::solid;
  const auto spur = solved(0);
  const auto& expected = spur.coupling.compliance[0];
  // Of planets a third of the ring apart the coupling is small: the compliance under the mesh is the scale.
  const auto difference = [&](const annulus::fem::SolvedRingCoupling& other) {
    return (other.coupling.compliance[0] - expected).cwiseAbs().maxCoeff() / spur.own_compliance;
  };
  const char* origin = "one end face is held along the axis";
  record.at_most("coupling at 1e-4 rad against spur, over the own compliance", "", difference(hardly), 2e-3, origin);
  record.close("own compliance at 1e-4 rad against spur", "m/N", hardly.own_compliance, spur.own_compliance, 0.015,
               origin);
}

BOOST_AUTO_TEST_SUITE_END()
