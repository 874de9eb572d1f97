#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Gears whose teeth reach beyond the face on which they touch.
BOOST_AUTO_TEST_SUITE(overhang)

using namespace annulus::tests;
using annulus::fem::Fidelity;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedPosition;

constexpr double module = 3.8e-3, width = 10 * module;

/// Spur meshes 10 modules wide under the load of that width.
LoadedMeshProblem narrow(LoadedMeshProblem problem) {
  for (double& load : problem.loads) load *= width / problem.face_width;
  problem.face_width = width;
  return problem;
}

LoadedMeshProblem wider(LoadedMeshProblem problem, double below, double above) {
  problem.pinion_overhang = {below, above};
  return problem;
}

double mean_lte(const std::vector<LoadedPosition>& positions) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) sum += positions[i].entry.lte;
  return sum / static_cast<double>(positions.size() - 1);
}

double solid_lte(const LoadedMeshProblem& problem, Symmetry symmetry = Symmetry::used) {
  ContactBench bench(problem, 1, Fidelity::solid, symmetry);
  return mean_lte(bench.sweep(4, problem.loads.front()));
}

BOOST_AUTO_TEST_CASE(teeth_beyond_the_face_stiffen_and_the_plane_section_knows_by_how_much) {
  annulus::test::Verification record("Sun mesh of a planet wider than the sun, by 0.5, 1 and 4 modules on either side",
                                     "solid elements; the stated error of the plane section");
  const auto problem = narrow(sun_mesh(2));
  const double even = solid_lte(problem);
  double before = even;
  for (const double modules : {0.5, 1.0, 4.0}) {
    const auto wide = wider(problem, modules * module, modules * module);
    const double lte = solid_lte(wide), gain = even / lte - 1;
    BOOST_TEST_MESSAGE(modules << " modules: stiffer by " << gain);
    BOOST_TEST(lte < before);
    before = lte;
    record.at_most("stiffer than without, over what the plane section allows for", "",
                   gain / (plane_error(wide) - plane_error(problem)), 1, "the stated error");
    BOOST_TEST(gain > 0.1 * (plane_error(wide) - plane_error(problem)));
  }
}

// Up to this offset a plane section stands for the mesh (mesh_model.cc).
BOOST_AUTO_TEST_CASE(faces_apart_by_a_twentieth_are_within_the_error_of_the_plane_section) {
  annulus::test::Verification record("Sun mesh whose faces are apart by a twentieth of their width",
                                     "solid elements; the stated error of the plane section");
  const auto even = narrow(sun_mesh(2));
  auto apart = even;
  apart.face_width *= 0.95;
  apart.pinion_overhang = {0.05 * width, 0};
  apart.wheel_overhang = {0, 0.05 * width};
  const double gain = solid_lte(even) / solid_lte(apart) / 0.95 - 1;  // per width of the common face
  BOOST_TEST_MESSAGE("stiffer by " << gain << " per width");
  record.at_most("change of the stiffness per width, over the stated error", "",
                 std::abs(gain) / annulus::fem::plane_error(apart), 1, "the stated error");
}

BOOST_AUTO_TEST_CASE(half_of_a_centred_face_is_the_whole) {
  annulus::test::Verification record("A wider planet, solved on half of the face", "the same on the whole face");
  const auto problem = wider(narrow(sun_mesh(2)), module, module);
  record.close("mean transmission error", "m", solid_lte(problem, Symmetry::used), solid_lte(problem, Symmetry::off),
               1e-9, "rounding");
}

BOOST_AUTO_TEST_CASE(which_end_does_not_matter) {
  annulus::test::Verification record("A planet wider at one end or at the other", "symmetry");
  ContactBench low(wider(narrow(sun_mesh(2)), 2 * module, 0), 1, Fidelity::solid),
      high(wider(narrow(sun_mesh(2)), 0, 2 * module), 1, Fidelity::solid);
  auto p = low.solve(0.3, 2e4);
  const auto q = high.solve(0.3, 2e4);
  record.close("transmission error", "m", p.entry.lte, q.entry.lte, 1e-9, "rounding");
  std::reverse(p.line_load.begin(), p.line_load.end());
  for (std::size_t i = 0; i < p.line_load.size(); ++i)
    record.close("line load of a slice, mirrored", "N/m", p.line_load[i], q.line_load[i], 1e-8, "rounding");
  // The end that is supported carries more.
  BOOST_TEST(p.line_load.back() > p.line_load.front());
}

BOOST_AUTO_TEST_CASE(rings_reach_beyond_the_face_with_all_that_they_have) {
  annulus::test::Verification record("A ring wider than the planet, on a sleeve with a hoop, on a flange, on pins",
                                     "order of stiffnesses: more material is stiffer");
  using namespace annulus::fem;
  const auto stiffer = [&](const char* what, const RingStructure& structure) {
    auto problem = narrow(ring_mesh(structure, 2));
    ContactBench even(problem, 0, Fidelity::solid);
    problem.wheel_overhang = {module, 2 * module};
    ContactBench wide(problem, 0, Fidelity::solid);
    const auto p = even.solve(0.2, problem.loads.front()), q = wide.solve(0.2, problem.loads.front());
    for (const auto* position : {&p, &q}) {
      BOOST_TEST(position->force_balance_relative < 1e-9, what);
      BOOST_TEST(position->energy_balance_relative < 1e-9, what);
    }
    record.at_least(std::string("transmission error without the overhang over that with it, ") + what, "",
                    p.entry.lte / q.entry.lte, 1, "order");
    BOOST_TEST(p.entry.lte / q.entry.lte < 1.3, what);
  };
  stiffer("fixed outside", OutsideHeld{});
  stiffer("flange", FlangeHeld{10e-3, 0.36});
  stiffer("pins", paper_pins(24, 0.03));
}

BOOST_AUTO_TEST_CASE(the_resolved_model_agrees) {
  annulus::test::Verification record("A planet wider by a module on either side",
                                     "the resolved model: meshes that follow the contact");
  const auto problem = wider(narrow(sun_mesh(2)), module, module);
  annulus::fem::LoadedMeshSettings settings;
  settings.level = 1;
  settings.threads = 2;
  const auto solved = [&](Fidelity fidelity) {
    settings.fidelity = fidelity;
    return solve_loaded_mesh(problem, settings);
  };
  const auto condensed = solved(Fidelity::solid), resolved = solved(Fidelity::resolved_solid);
  double worst = 0;
  for (std::size_t i = 0; i < condensed.positions.size(); ++i) {
    const auto &p = condensed.positions[i].entry, &q = resolved.positions[i].entry;
    worst = std::max(worst, std::abs(p.lte / q.lte - 1) / (p.error_relative + q.error_relative));
  }
  record.at_most("difference of the transmission errors over the sum of the stated errors", "", worst, 1,
                 "the stated errors");
}

BOOST_AUTO_TEST_CASE(lead_modifications_begin_at_the_ends_of_their_gear) {
  annulus::test::Verification record("Gap of a planet with a lead slope, wider than the sun by 10 and 20 mm",
                                     "the straight line of the slope");
  auto problem = with_planet_lead(sun_mesh(2), 0, 30e-6);
  const auto parameters = problem.pair.pinion().parameters();
  problem.face_width = parameters.face_width - 30e-3;
  problem.pinion_overhang = {10e-3, 20e-3};
  const annulus::fem::FlankContact flanks(problem.pair);
  const annulus::fem::ContactFace face(flanks, {0, problem.face_width},
                                       {0, problem.pinion_overhang.below, problem.wheel_overhang.below});
  const double middle = 10e-3 + problem.face_width / 2;
  record.close("mean gap", "m", face.lead_gap(0), 30e-6 * middle / parameters.face_width, 1e-12, "rounding");
  record.close("smallest gap", "m", face.smallest_lead_gap(0), 30e-6 * 10e-3 / parameters.face_width, 1e-12,
               "rounding");
}

BOOST_AUTO_TEST_SUITE_END()
