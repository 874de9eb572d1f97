#include "dynamics/systems/planetary/planetary_modes.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "dynamics/modes/modal_energy.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(modal_energy)

using namespace annulus::dynamics;

Eigen::Index element(const ModalEnergy& energy, const std::string& name) {
  const auto found = std::find(energy.elements.begin(), energy.elements.end(), name);
  BOOST_REQUIRE(found != energy.elements.end());
  return found - energy.elements.begin();
}

BOOST_AUTO_TEST_CASE(elements_add_up_to_the_stiffness) {
  annulus::test::Verification record("Springs of a stage, one by one", "the assembled stiffness and damping matrices");
  for (const auto& stage : {stages::ring_paper(), stages::lin_parker(3)}) {
    const auto system = assemble(stage);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(system.dofs(), system.dofs()), damping = sum;
    for (const auto& spring : system.springs()) {
      Eigen::VectorXd a = Eigen::VectorXd::Zero(system.dofs());
      for (const auto& [i, factor] : spring.a) a[i] += factor;
      BOOST_TEST(!spring.name.empty());
      sum += spring.stiffness * a * a.transpose();
      damping += spring.damping * a * a.transpose();
    }
    // Rounding of sums in another order.
    record.at_most("stiffness, relative difference", "", (sum - system.stiffness()).norm() / sum.norm(), 1e-14,
                   "rounding of sums in another order");
    record.at_most("damping over the stiffness, difference", "s", (damping - system.damping()).norm() / sum.norm(),
                   1e-14, "rounding of sums in another order");
  }
}

// Every share against another way to it: d(omega^2)/omega^2 per dk/k, the stiffness changed by a relative 1e-3 both
// ways. Central differences err by 1e-6 x the curvature, which grows as modes of one symmetry come close.
BOOST_AUTO_TEST_CASE(shares_are_sensitivities) {
  annulus::test::Verification record("Strain energy shares of the modes",
                                     "sensitivities d(w^2)/w^2 per dk/k by central differences");
  const auto stage = stages::lin_parker(4);
  auto system = assemble(stage);
  const auto stiffness = mean_tangents(assemble(stage));
  const auto found = annulus::dynamics::modes(stage);
  const auto energy = annulus::dynamics::modal_energy(stage, found);
  const auto count = static_cast<Eigen::Index>(found.modes.size());
  BOOST_TEST(energy.strain.cols() == count);
  // Supports of sun, ring, carrier in x and y, the ring's in u, two bearings and two meshes of each planet.
  BOOST_TEST(energy.elements.size() == 6U + 1U + 4U * 4U);
  for (Eigen::Index i = 0; i < count; ++i) {
    // Sums of 23 shares.
    BOOST_TEST(std::abs(energy.strain.col(i).sum() - (found.modes[i].frequency > 0 ? 1 : 0)) <= 1e-14);
    record.near("sum of the kinetic shares", "", energy.kinetic.col(i).sum(), 1, 1e-14, "rounding");
    BOOST_TEST(energy.strain.col(i).minCoeff() >= 0.0);
  }

  // Of a whole group, so that the symmetry and with it the identity of the modes stays.
  constexpr double step = 1e-3;
  const auto squares = [&](auto change, double factor) {
    auto changed = stage;
    change(changed, factor);
    std::vector<double> list;
    for (const auto& mode : annulus::dynamics::modes(changed).modes) list.push_back(std::pow(mode.frequency, 2));
    return list;
  };
  const auto grouped = by_group(energy);
  const auto check = [&](const std::string& group, auto change) {
    const auto place = std::find(grouped.groups.begin(), grouped.groups.end(), group);
    BOOST_REQUIRE(place != grouped.groups.end());
    const auto up = squares(change, 1 + step), down = squares(change, 1 - step);
    for (Eigen::Index i = 1; i < count; ++i) {
      const double sensitivity = (up[i] - down[i]) / (2 * step) / std::pow(found.modes[i].frequency, 2);
      record.near("share of " + group, "", grouped.strain(place - grouped.groups.begin(), i), sensitivity, 2e-5,
                  "step of 1e-3: 1e-6 x curvature");
    }
  };
  check("sun_planet", [](PlanetaryStage& s, double f) { s.sun_mesh = ConstantStiffness{5e8 * f}; });
  check("ring_planet", [](PlanetaryStage& s, double f) { s.ring_mesh = ConstantStiffness{5e8 * f}; });
  check("planet_bearing", [](PlanetaryStage& s, double f) {
    s.planet_bearings.front().radial *= f;
    s.planet_bearings.front().tangential *= f;
  });
  check("sun_support", [](PlanetaryStage& s, double f) { s.sun.support *= f; });
  check("carrier_support", [](PlanetaryStage& s, double f) { s.carrier.support *= f; });
  check("ring_support", [](PlanetaryStage& s, double f) {
    s.ring.support *= f;
    s.ring.torsional_support *= f;
  });

  // One mesh alone, in the modes that are not multiple.
  for (const int mesh : {0, 6}) {
    Eigen::VectorXd up = stiffness, down = stiffness;
    up[mesh] *= 1 + step;
    down[mesh] *= 1 - step;
    const auto above = annulus::dynamics::modes(system, up), below = annulus::dynamics::modes(system, down);
    const auto row = element(energy, system.meshes()[mesh].name);
    for (Eigen::Index i = 1; i < count; ++i) {
      if (found.kinds[i] == ModeKind::translational) continue;
      const double sensitivity = (std::pow(above.modes[i].frequency, 2) - std::pow(below.modes[i].frequency, 2)) /
                                 (2 * step) / std::pow(found.modes[i].frequency, 2);
      record.near("share of one mesh", "", energy.strain(row, i), sensitivity, 2e-5, "step of 1e-3: 1e-6 x curvature");
    }
  }
}

// Rayleigh: strain energy over kinetic energy of a shape is omega^2.
BOOST_AUTO_TEST_CASE(rayleigh_quotient) {
  annulus::test::Verification record("Rayleigh's quotient of all modes",
                                     "strain over kinetic energy of a shape is w^2");
  const auto stage = stages::ring_paper();
  const auto system = assemble(stage);
  const auto stiffness = stiffness_with_meshes(system, mean_tangents(assemble(stage)));
  for (const auto& mode : annulus::dynamics::modes(stage).modes) {
    if (mode.frequency == 0) continue;
    const double quotient = mode.shape.dot(stiffness * mode.shape) / mode.shape.dot(system.mass() * mode.shape);
    const double omega = 2 * std::numbers::pi * mode.frequency;
    // eps x the largest square over the smallest: (13 kHz / 60 Hz)^2 x 1e-16 x the number of DOFs.
    record.near("quotient over w^2", "", quotient / (omega * omega), 1, 1e-9,
                "eps x (highest over lowest frequency)^2 x degrees of freedom");
  }
}

// Two masses on two meshes that share a body, D = d (1 1; 1 1): in step each mesh yields 1/k + 2d, against each other
// the body does not yield at all.
BOOST_AUTO_TEST_CASE(coupled_meshes) {
  annulus::test::Verification record("Two meshes on one elastic body",
                                     "closed form: in step 1/(1/k + 2 d), against each other k");
  constexpr double k = 1e6, d = 0.25e-6, mass = 2;
  LumpedSystemBuilder builder;
  for (const std::string name : {"a", "b"}) {
    MeshElement mesh;
    mesh.name = name + "_mesh";
    mesh.b = builder.add_dof(name + "_x");
    mesh.excitation = ConstantStiffness{k};
    builder.add_mass(mesh.b, mass);
    builder.add_mesh(mesh);
  }
  builder.add_mesh_coupling({{0, 1}, compliance_curves({Eigen::MatrixXd::Constant(2, 2, d)}, 1), {}});
  const auto system = builder.build();
  const Eigen::VectorXd stiffness = Eigen::VectorXd::Constant(2, k);
  const auto found = annulus::dynamics::modes(system, stiffness);
  const double in_step = 1 / (1 / k + 2 * d);
  record.near("angular frequency in step over the closed form", "",
              2 * std::numbers::pi * found.modes[0].frequency / std::sqrt(in_step / mass), 1, 1e-12, "rounding");
  record.near("angular frequency against each other over the closed form", "",
              2 * std::numbers::pi * found.modes[1].frequency / std::sqrt(k / mass), 1, 1e-12, "rounding");
  const auto energy = annulus::dynamics::modal_energy(system, stiffness, found);
  const auto body = element(energy, "common_body");
  record.near("strain energy share of the body in step", "", energy.strain(body, 0), 2 * d * in_step, 1e-12,
              "rounding");
  BOOST_TEST(std::abs(energy.strain(body, 1)) <= 1e-12);
  for (const auto* mesh : {"a_mesh", "b_mesh"}) {
    BOOST_TEST(std::abs(energy.strain(element(energy, mesh), 0) - in_step / k / 2) <= 1e-12);
    BOOST_TEST(std::abs(energy.strain(element(energy, mesh), 1) - 0.5) <= 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(names_and_groups) {
  BOOST_TEST(element_group("planet12_bearing_radial") == "planet_bearing");
  BOOST_TEST(element_group("planet12_bearing_across") == "planet_bearing");
  BOOST_TEST(element_group("sun_planet3") == "sun_planet");
  BOOST_TEST(element_group("ring_support_u") == "ring_support");
  const auto stage = stages::ring_paper();
  const auto energy = annulus::dynamics::modal_energy(stage, annulus::dynamics::modes(stage));
  const std::vector<std::string> bodies = {"sun",     "ring",    "carrier", "planet1",
                                           "planet2", "planet3", "planet4", "planet5"};
  BOOST_TEST(energy.bodies == bodies, boost::test_tools::per_element());
  const std::vector<std::string> groups = {"sun_support",    "ring_support", "carrier_support",
                                           "planet_bearing", "sun_planet",   "ring_planet"};
  BOOST_TEST(by_group(energy).groups == groups, boost::test_tools::per_element());
}

// The fifth of 6459 ± 135 Hz may be below the fourth of 6421 Hz, whose mode strains no mesh.
BOOST_AUTO_TEST_CASE(neighbours_within_their_errors_may_change_places) {
  Modes modes;
  for (const double frequency : {700.0, 6421.0, 6459.0, 9000.0}) modes.modes.push_back({frequency, {}});
  GroupedEnergy energy{{"mesh", "bearing"}, Eigen::MatrixXd::Zero(2, 4), {}, {}};
  energy.strain.row(1).setOnes();
  energy.strain.col(2) << 1, 0;
  annulus::ErrorParts parts;
  parts.model = 0.04;
  const auto list = frequency_errors(modes, energy, {{.groups = {"mesh"}, .relative = 0.04, .parts = parts}});
  const double error = 0.02 * 6459;
  BOOST_TEST(list[0].figure.error == 0);
  BOOST_TEST(list[1].figure.error == 6421 - (6459 - error), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(list[1].parts.model == list[1].figure.error, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(list[2].figure.error == error, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(list[3].figure.error == 0);
}

BOOST_AUTO_TEST_SUITE_END()
