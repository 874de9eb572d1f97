#include "dynamics/modes/structural_damping.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/modes/modes.h"
#include "dynamics/systems/helical_pair/helical_pair.h"
#include "dynamics/systems/planetary/planetary_stage.h"
#include "dynamics/systems/two_k_v/two_k_v.h"
#include "tests/dynamics/pairs.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

/// Damping of single meshes and bearings, and of whole systems.
BOOST_AUTO_TEST_SUITE(structural_damping)

using namespace annulus::dynamics;

/// Natural rates (rad/s) and damping ratios of decaying vibrations, rising.
std::vector<std::pair<double, double>> decays(const LumpedSystem& system) {
  const auto n = system.dofs();
  auto workspace = system.workspace();
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  const Eigen::VectorXd rest =
      Eigen::VectorXd::Constant(2 * n, 1e-3)
          .cwiseProduct((Eigen::VectorXd(2 * n) << Eigen::VectorXd::Ones(n), Eigen::VectorXd::Zero(n)).finished());
  system.detect_contact(0, rest.data(), workspace);
  system.jacobian(0, rest.data(), matrix, workspace);
  std::vector<std::pair<double, double>> list;
  for (const auto& value : eigenvalues(matrix, "the decays"))
    if (value.imag() > 1e-3) list.emplace_back(std::abs(value), -value.real() / std::abs(value));
  std::sort(list.begin(), list.end());
  return list;
}

/// Without dampers of meshes and bearings.
HelicalPair undamped_pair() {
  auto pair = pairs::error_paper();
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  pair.mesh_damping_ratio = pair.bearing_damping_ratio = 0;
  pair.half_backlash.reset();
  return pair;
}

// Proportional damping: every mode keeps its shape, and has zeta, or a / (2 w) + b w / 2.
BOOST_AUTO_TEST_CASE(modes_of_proportional_damping) {
  annulus::test::Verification record("Structural damping", "damping ratios of proportionally damped modes");
  for (const auto& damping : {StructuralDamping{0.03, 0, 0}, StructuralDamping{0, 40, 0}, StructuralDamping{0, 0, 2e-6},
                              StructuralDamping{0.01, 15, 1e-6}}) {
    auto pair = undamped_pair();
    const auto undamped = decays(assemble(pair));
    pair.structural_damping = damping;
    const auto damped = decays(assemble(pair));
    BOOST_TEST_REQUIRE(damped.size() == undamped.size());
    BOOST_TEST(damped.size() == 5U);
    for (std::size_t i = 0; i < damped.size(); ++i) {
      const double rate = undamped[i].first;
      record.close("natural rate", "rad/s", damped[i].first, rate, 1e-9, "rounding");
      record.close("damping ratio", "", damped[i].second,
                   damping.modal_ratio + damping.of_mass / (2 * rate) + damping.of_stiffness * rate / 2, 1e-8,
                   "rounding");
    }
  }
}

BOOST_AUTO_TEST_CASE(meshes_and_bearings_have_their_own) {
  auto stage = stages::ring_paper();
  stage.sun.support = 1e9;
  const auto common = assemble(stage);
  stage.sun_mesh_damping_ratio = 2 * stage.mesh_damping_ratio;
  stage.sun.damping_ratio = 3 * stage.support_damping_ratio;
  stage.planet.damping_ratio = 0;
  const auto own = assemble(stage);
  const auto share = [&](const std::string& name) {
    const auto of = [&](const LumpedSystem& system) {
      for (const auto& mesh : system.meshes())
        if (mesh.name == name) return mesh.damping;
      for (const auto& spring : system.springs())
        if (spring.name == name) return spring.damping;
      throw annulus::InputError("no element " + name);
    };
    return of(own) / of(common);
  };
  BOOST_TEST(share("sun_planet2") == 2, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(share("ring_planet2") == 1);
  BOOST_TEST(share("sun_support_x") == 3, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(share("planet1_bearing_radial") == 0);
  auto reducer = stages::reducer();
  const auto before = assemble(reducer).meshes();
  reducer.arc_mesh_damping_ratio = 4 * reducer.mesh_damping_ratio;
  const auto after = assemble(reducer).meshes();
  for (std::size_t m = 0; m < before.size(); ++m)
    if (before[m].name.starts_with("arc_pins"))
      BOOST_TEST(after[m].damping == 4 * before[m].damping, boost::test_tools::tolerance(1e-12));
    else
      BOOST_TEST(after[m].damping == before[m].damping);
}

BOOST_AUTO_TEST_CASE(negative_damping_is_refused) {
  auto pair = undamped_pair();
  pair.structural_damping.of_mass = -1;
  BOOST_CHECK_THROW((void)assemble(pair), annulus::InputError);
  auto stage = stages::ring_paper();
  stage.ring.damping_ratio = -0.1;
  BOOST_CHECK_THROW(stage.check(), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
