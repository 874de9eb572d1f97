#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

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
  ContactBench bench(ring_mesh(structure, 2), 0, annulus::fem::Fidelity::solid);
  const auto positions = bench.sweep(4, nominal_load);
  check_positions(positions);
  BOOST_TEST(positions.back().entry.lte == positions.front().entry.lte, boost::test_tools::tolerance(1e-9));
  State state;
  for (const auto& p : positions) {
    state.lte = std::max(state.lte, p.entry.lte);
    state.face_load_factor = std::max(state.face_load_factor, p.face_load_factor);
    // Held at the lower end, the ring carries most there and less and less towards its free end.
    if (!annulus::fem::held_outside(structure)) BOOST_TEST(std::is_sorted(p.line_load.rbegin(), p.line_load.rend()));
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
  annulus::test::Verification record("Solid rings held outside, by a flange, by a sleeve with and without a hoop",
                                     "each other: a stiffer structure yields less and loads the face more evenly");
  const State held = solve_structure("held", OutsideHeld{});
  const State flange = solve_structure("flange", FlangeHeld{20e-3, ring_outside + 15e-3});
  const State hoop = solve_structure("hoop", with_hoop(20e-3, 15e-3));
  const State bare = solve_structure("thin-walled", thin);
  // A hoop at the free end keeps the rim from opening there, the more the nearer to the load's own end; a flange holds
  // the lower end without a sleeve between. The whole outside is held most. Differences are some 10 %, errors of the
  // coarsest solid mesh less than one.
  const double margin = 1.05;
  const auto exceeds = [&](const char* quantity, double softer, double stiffer) {
    record.at_least(quantity, "", softer / stiffer, margin, "beyond the errors of the coarsest solid mesh");
    BOOST_TEST(margin * stiffer < softer, quantity);
  };
  exceeds("transmission error, flange over held outside", flange.lte, held.lte);
  exceeds("transmission error, hoop over flange", hoop.lte, flange.lte);
  exceeds("transmission error, bare sleeve over hoop", bare.lte, hoop.lte);
  record.at_most("face load factor, held outside", "", held.face_load_factor, 1.02,
                 "a section that is the same everywhere loads its face evenly");
  BOOST_TEST(held.face_load_factor < 1.02);
  exceeds("face load factor, flange over held outside", flange.face_load_factor, held.face_load_factor);
  exceeds("face load factor, bare sleeve over flange", bare.face_load_factor, flange.face_load_factor);
  exceeds("face load factor, bare sleeve over hoop", bare.face_load_factor, hoop.face_load_factor);
}

BOOST_AUTO_TEST_CASE(a_hoop_stiffens_the_more_the_larger_it_is) {
  annulus::test::Verification record("Hoops of three sizes on a thin-walled ring",
                                     "each other: a larger hoop yields less and loads the face more evenly");
  const State thin_hoop = solve_structure("narrow hoop", with_hoop(20e-3, 6e-3));
  const State thick_hoop = solve_structure("thick hoop", with_hoop(20e-3, 24e-3));
  const State whole = solve_structure("hoop over the whole face", with_hoop(88e-3, 24e-3));
  const auto falls = [&](const char* quantity, double larger, double smaller) {
    record.at_most(quantity, "", larger / smaller, 1, "more material only ever stiffens");
    BOOST_TEST(larger < smaller, quantity);
  };
  falls("transmission error, thick over thin hoop", thick_hoop.lte, thin_hoop.lte);
  falls("face load factor, thick over thin hoop", thick_hoop.face_load_factor, thin_hoop.face_load_factor);
  falls("transmission error, hoop over the whole face over thick hoop", whole.lte, thick_hoop.lte);
}

BOOST_AUTO_TEST_SUITE_END()
