#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "core/errors.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// A ring clamped between two housings at the rims of both end faces.
BOOST_AUTO_TEST_SUITE(clamped_ring)

using namespace annulus::tests;
using annulus::InputError;
using annulus::fem::Clamped;
using annulus::fem::EndFaceHeld;
using annulus::fem::Fidelity;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedPosition;
using annulus::fem::OutsideHeld;
using annulus::fem::RingStructure;

constexpr double inner_radius = 322e-3;  // m: the root lies at 313 mm, the outside at 331.8 mm

RingStructure clamped(double radius = inner_radius) {
  Clamped held;
  held.inner_radius = radius;
  return held;
}

/// The ring mesh on a face of this width, under the nominal load per width.
LoadedMeshProblem on_face(const RingStructure& structure, double width) {
  auto problem = ring_mesh(structure, 2);
  for (auto& load : problem.loads) load *= width / problem.face_width;
  problem.face_width = width;
  return problem;
}

/// Held all around at the edge of the clamped annulus, nothing beyond.
LoadedMeshProblem held_at_the_edge(double width) {
  auto problem = on_face(OutsideHeld{}, width);
  problem.wheel_support_radius = inner_radius;
  return problem;
}

constexpr double phase = 0.3;

LoadedPosition solve(const LoadedMeshProblem& problem, Symmetry symmetry = Symmetry::used) {
  ContactBench bench(problem, 0, Fidelity::solid, symmetry);
  const auto position = bench.solve(phase, problem.loads.front());
  check_positions({position});
  return position;
}

double deflection(const LoadedMeshProblem& problem) {
  const auto position = solve(problem);
  return position.entry.lte - position.entry.unloaded_te;
}

BOOST_AUTO_TEST_CASE(half_of_the_face_equals_the_whole) {
  annulus::test::Verification record("A clamped ring on half of its face, the middle a plane of symmetry",
                                     "the whole face, both ends clamped");
  const auto half = solve(ring_mesh(clamped(), 2), Symmetry::used),
             whole = solve(ring_mesh(clamped(), 2), Symmetry::off);
  // Two systems with the same solution, of condition numbers up to 1e6 and factorised in another order.
  constexpr double round_off = 1e-9;
  record.close("transmission error", "m", half.entry.lte, whole.entry.lte, round_off, "rounding x condition number");
  record.close("secant stiffness", "N/m", half.entry.stiffness_secant, whole.entry.stiffness_secant, round_off,
               "rounding x condition number");
  const auto& line = whole.line_load;
  BOOST_TEST_REQUIRE(line.size() > 2U);
  for (std::size_t i = 0; i < line.size(); ++i)
    record.close("line load at mirrored positions", "N/m", line[i], line[line.size() - 1 - i], round_off,
                 "rounding x condition number");
  // Stiff ends, compliant middle.
  BOOST_TEST(std::is_sorted(line.rbegin() + static_cast<std::ptrdiff_t>(line.size() / 2), line.rend()));
}

BOOST_AUTO_TEST_CASE(more_clamping_stiffens) {
  annulus::test::Verification record("Deflection of clamped rings",
                                     "each other: energy theorems, every further constraint stiffens");
  const double width = ring_mesh(clamped(), 2).face_width;
  const double both = deflection(on_face(clamped(), width));
  const double wider = deflection(on_face(clamped(317e-3), width));
  EndFaceHeld one_end;
  one_end.sleeve_thickness = ring_outside - inner_radius;
  const double one = deflection(on_face(one_end, width));
  const double edge = deflection(held_at_the_edge(width));
  // Differences are some 10 %, errors of the coarsest solid mesh less than one.
  constexpr double margin = 1.02;
  const auto softer = [&](const char* quantity, double soft, double stiff) {
    record.at_least(quantity, "", soft / stiff, margin, "beyond the errors of the coarsest solid mesh");
  };
  softer("one end face held over both", one, both);
  softer("clamped from 322 mm over clamped from 317 mm", both, wider);
  softer("clamped over held all around at the edge of the clamped annulus", both, edge);
}

BOOST_AUTO_TEST_CASE(on_a_narrow_face_the_clamp_holds_its_edge) {
  annulus::test::Verification record(
      "Clamped rings of narrow faces",
      "limit of a vanishing face width: the ring held all around at the edge of the clamped annulus");
  // Between the clamped faces displacements decay over a depth in proportion to the face width (Saint-Venant): so does
  // what the clamp yields beyond the held edge.
  const std::vector<double> widths = {8e-3, 4e-3, 2e-3};
  std::vector<double> excess;
  for (const double width : widths) {
    excess.push_back(deflection(on_face(clamped(), width)) / deflection(held_at_the_edge(width)) - 1);
    BOOST_TEST_MESSAGE("face of " << width << " m: " << excess.back());
  }
  for (std::size_t i = 1; i < widths.size(); ++i) {
    record.at_least("ratio of the excess when the face is halved", "", excess[i - 1] / excess[i], 1.8,
                    "first order in the face width: 0.9 of 2");
  }
  record.at_most("excess of the deflection on a face of 2 mm", "", std::abs(excess.back()), 0.01,
                 "in proportion to the face width, 2 % on one of 8 mm, with a margin of two");
}

BOOST_AUTO_TEST_CASE(every_mesh_cycle_is_the_same) {
  const auto structure = clamped();
  BOOST_TEST(structure.repeating_teeth(162) == 1);
  BOOST_TEST(structure.single_supports() == 0);
  BOOST_TEST(!annulus::fem::on_single_supports(structure));
  BOOST_TEST(annulus::fem::needs_solid(structure));
  BOOST_TEST(structure.words().asymmetry.empty());
}

BOOST_AUTO_TEST_CASE(bolts_and_dowels_are_drawn) {
  Clamped held;
  held.inner_radius = inner_radius;
  held.bolts = 36;
  held.bolt_circle_radius = 327e-3;
  held.dowels = 4;
  const auto drawing = RingStructure(held).drawing(ring_outside);
  BOOST_TEST_REQUIRE(drawing.cylinders.size() == 2U);
  BOOST_TEST(drawing.cylinders[0].angles.size() == 36U);
  BOOST_TEST_REQUIRE(drawing.cylinders[1].angles.size() == 4U);
  const double spacing = 2 * M_PI / 36;
  for (const double dowel : drawing.cylinders[1].angles)
    for (const double bolt : drawing.cylinders[0].angles)
      BOOST_TEST(std::abs(std::remainder(dowel - bolt, 2 * M_PI)) > 0.49 * spacing);
  BOOST_TEST(RingStructure(held).words().description == "clamped between two housings by 36 bolts and 4 dowels");
}

BOOST_AUTO_TEST_CASE(what_cannot_be_represented_is_refused) {
  for (const auto fidelity : {Fidelity::plane, Fidelity::closed_form}) {
    annulus::fem::LoadedMeshSettings settings;
    settings.fidelity = fidelity;
    BOOST_CHECK_THROW((void)solve_loaded_mesh(ring_mesh(clamped(), 2), settings), InputError);
  }
  annulus::fem::LoadedMeshSettings solid;
  solid.fidelity = Fidelity::solid;
  for (const double radius : {0.0, ring_outside, 2 * ring_outside})
    BOOST_CHECK_THROW((void)solve_loaded_mesh(ring_mesh(clamped(radius), 2), solid), InputError);
  auto external = sun_mesh(2);
  external.structure = clamped();
  BOOST_CHECK_THROW((void)solve_loaded_mesh(external, {}), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
