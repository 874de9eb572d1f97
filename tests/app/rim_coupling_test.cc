#include "app/systems/planetary/rim_coupling.h"

#include <boost/test/unit_test.hpp>

#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_input.h"
#include "tests/app/scenes.h"

namespace annulus {

BOOST_AUTO_TEST_SUITE(rim_coupling)

/// A coupling whose largest entry is `share` of the compliance of a planet's path.
app::SolvedCoupling coupling_of(double share) {
  app::SolvedCoupling solved;
  solved.coupling.compliance = {Eigen::MatrixXd::Constant(2, 2, -share * 1e-9)};
  solved.mesh_compliance = 0.5e-9;
  solved.path_compliance = 1e-9;
  return solved;
}

BOOST_AUTO_TEST_CASE(what_is_taken_and_looked_at_follows_from_the_accuracy) {
  auto scene = app::parse_scene(test::small_stage(), "scene.toml");
  scene.accuracy = 0.01;
  const auto taken = [&](const app::SolvedCoupling& solved) { return app::coupling_choice(scene, solved).taken; };
  BOOST_CHECK(taken(coupling_of(0.011)) == app::RimCoupling::statical);
  BOOST_CHECK(!app::is_negligible(scene, coupling_of(0.011)));
  // What is left out is in no error: it stays well below the wanted accuracy.
  BOOST_CHECK(taken(coupling_of(0.0011)) == app::RimCoupling::statical);
  BOOST_CHECK(!app::is_negligible(scene, coupling_of(0.0011)));
  BOOST_CHECK(taken(coupling_of(0.0009)) == app::RimCoupling::none);
  BOOST_CHECK(app::is_negligible(scene, coupling_of(0.0009)));
  // A mode within reach may be excited however small the static coupling is.
  auto ringing = coupling_of(0.0009);
  ringing.coupling.modes.emplace_back();
  BOOST_CHECK(!app::is_negligible(scene, ringing));
  // Who asks for it gets it, and what it changes.
  planetary(scene).rim_coupling = app::RimCoupling::statical;
  BOOST_CHECK(taken(coupling_of(0.0009)) == app::RimCoupling::statical);
  BOOST_CHECK(!app::is_negligible(scene, coupling_of(0.0009)));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
