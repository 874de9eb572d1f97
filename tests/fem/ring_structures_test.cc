#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "ring_paper_problems.h"

/// Rings held at one end: sleeves, hoops and flanges.
BOOST_AUTO_TEST_SUITE(ring_structures)

using namespace annulus::tests;
using annulus::fem::EndFaceHeld;
using annulus::fem::FlangeHeld;
using annulus::fem::Hoop;
using annulus::fem::OutsideHeld;
using annulus::fem::RingStructure;

struct State {
  double lte = 0, face_load_factor = 0;
};

/// The largest of a few positions; every one has to keep its balances.
State solve_structure(const char* name, const RingStructure& structure) {
  ContactBench bench(ring_mesh(structure, 2), 0, annulus::fem::Rung::solid);
  const auto positions = bench.sweep(4, nominal_load);
  check_positions(positions);
  BOOST_TEST(positions.back().entry.lte == positions.front().entry.lte, boost::test_tools::tolerance(1e-9));
  State state;
  for (const auto& p : positions) {
    state.lte = std::max(state.lte, p.entry.lte);
    state.face_load_factor = std::max(state.face_load_factor, p.face_load_factor);
    // Held at the lower end, the ring carries most there and less and less towards its free end.
    if (!std::holds_alternative<OutsideHeld>(structure))
      BOOST_TEST(std::is_sorted(p.line_load.rbegin(), p.line_load.rend()));
  }
  BOOST_TEST_MESSAGE(name << ": LTE " << state.lte << " m, K_H_beta " << state.face_load_factor);
  return state;
}

const EndFaceHeld thin{18e-3, 10.6e-3};

EndFaceHeld with_hoop(double width, double thickness) {
  EndFaceHeld held = thin;
  held.hoop = Hoop{width, thickness};
  return held;
}

BOOST_AUTO_TEST_CASE(what_stiffens_a_ring_evens_its_load) {
  const State held = solve_structure("held", OutsideHeld{});
  const State flange = solve_structure("flange", FlangeHeld{20e-3, ring_outside + 15e-3});
  const State hoop = solve_structure("hoop", with_hoop(20e-3, 15e-3));
  const State bare = solve_structure("thin-walled", thin);
  // A hoop at the free end keeps the rim from opening there, the more the nearer to the load's own end; a flange holds
  // the lower end without a sleeve between. The whole outside is held most. Differences are some 10 %, errors of the
  // coarsest solid mesh less than one.
  const double margin = 1.05;
  BOOST_TEST(margin * held.lte < flange.lte);
  BOOST_TEST(margin * flange.lte < hoop.lte);
  BOOST_TEST(margin * hoop.lte < bare.lte);
  BOOST_TEST(held.face_load_factor < 1.02);
  BOOST_TEST(margin * held.face_load_factor < flange.face_load_factor);
  BOOST_TEST(flange.face_load_factor < bare.face_load_factor / margin);
  BOOST_TEST(hoop.face_load_factor < bare.face_load_factor / margin);
}

BOOST_AUTO_TEST_CASE(a_hoop_stiffens_the_more_the_larger_it_is) {
  const State thin_hoop = solve_structure("narrow hoop", with_hoop(20e-3, 6e-3));
  const State thick_hoop = solve_structure("thick hoop", with_hoop(20e-3, 24e-3));
  const State whole = solve_structure("hoop over the whole face", with_hoop(88e-3, 24e-3));
  BOOST_TEST(thick_hoop.lte < thin_hoop.lte);
  BOOST_TEST(thick_hoop.face_load_factor < thin_hoop.face_load_factor);
  BOOST_TEST(whole.lte < thick_hoop.lte);
}

BOOST_AUTO_TEST_SUITE_END()
