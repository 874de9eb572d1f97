#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "contact_bench.h"
#include "core/result_store.h"
#include "fem/body/body_plan.h"
#include "fem/condensation/altered_ring.h"
#include "fem/condensation/cyclic_body.h"
#include "fem/cost_size.h"
#include "fem/problem/solved_face.h"
#include "ring_paper.h"
#include "ring_paper_problems.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// Solid meshes on half of their face width.
BOOST_AUTO_TEST_SUITE(symmetric_face)

using namespace annulus::tests;
using annulus::fem::BodyStress;
using annulus::fem::Fidelity;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedMeshSettings;
using annulus::fem::LoadedPosition;
using annulus::fem::PinHeld;
using annulus::fem::PinState;
using annulus::fem::RingStructure;

constexpr double crowning = 15e-6;
LoadedMeshProblem crowned_ring(const RingStructure& structure) {
  return with_planet_lead(ring_mesh(structure, 2), crowning, 0);
}

/// Two systems with the same solution, of condition numbers up to 1e6 and factorised in another order.
constexpr double round_off = 1e-9;

/// Largest difference of two rows of values, relative to the largest value.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  BOOST_TEST_REQUIRE(a.size() == b.size());
  double worst = 0, largest = 1e-300;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]));
    largest = std::max(largest, std::abs(b[i]));
  }
  return worst / largest;
}

std::vector<double> forces(const std::vector<PinState>& supports) {
  std::vector<double> list;
  for (const auto& s : supports) list.insert(list.end(), {s.radial_force, s.tangential_force, s.touching ? 1.0 : 0.0});
  return list;
}

std::vector<double> figures(const BodyStress& s) {
  return {s.root_tension, s.root_compression, s.root_von_mises, s.rim_tension, s.rim_compression, s.rim_von_mises};
}

/// A position and the stresses that belong to it.
struct Solved {
  LoadedPosition position;
  std::vector<double> stresses;
};
std::vector<Solved> solve(const LoadedMeshProblem& problem, int degree, bool symmetry,
                          const std::vector<double>& phases) {
  constexpr int level = 1;  // an even number of cells along the face
  LoadedMeshSettings settings;
  settings.fidelity = Fidelity::solid;
  settings.degree = degree;
  settings.symmetry = symmetry;
  settings.threads = 2;
  const annulus::fem::FlankContact flanks(problem.pair);
  const auto bodies = annulus::fem::build_bodies(problem, flanks, settings, level);
  BOOST_TEST(bodies.face.half == symmetry);
  annulus::fem::ContactOptions options;
  options.elements = 6;
  options.half_face = bodies.face.half;
  const annulus::fem::ContactSystem system(flanks, *bodies.pinion, *bodies.wheel, bodies.supports.get(),
                                           problem.materials, bodies.slice_edges, options);
  std::vector<Solved> results;
  for (const double phase : phases) {
    annulus::fem::ContactSystem::PairsCache cache;
    annulus::fem::ContactSystem::WarmStart warm;
    annulus::fem::ContactForces forces;
    Solved result{system.solve(0, phase, nominal_load, cache, warm, &forces), {}};
    result.stresses = figures(bodies.pinion_stress->stresses(forces.pinion, {}).largest);
    const auto wheel = figures(bodies.wheel_stress->stresses(forces.wheel, forces.supports).largest);
    result.stresses.insert(result.stresses.end(), wheel.begin(), wheel.end());
    results.push_back(std::move(result));
  }
  return results;
}

/// Everything that is told of a position.
double largest_difference(const LoadedPosition& half, const LoadedPosition& whole) {
  const auto of_entry = [](const LoadedPosition& p) {
    return std::vector<std::vector<double>>{{p.load},
                                            {p.entry.lte},
                                            {p.entry.unloaded_te},
                                            {p.entry.stiffness_secant},
                                            {p.entry.stiffness_tangent},
                                            {p.max_pressure},
                                            {p.face_load_factor},
                                            p.pair_share,
                                            p.line_load,
                                            forces(p.pins),
                                            forces(p.housing)};
  };
  const auto of_half = of_entry(half), of_whole = of_entry(whole);
  double worst = 0;
  for (std::size_t i = 0; i < of_half.size(); ++i) worst = std::max(worst, difference(of_half[i], of_whole[i]));
  const auto of_pressure = [](const LoadedPosition& p) {
    std::vector<double> place, pressure;
    for (const auto& patch : p.pressure) {
      place.insert(place.end(), {patch.z_low, patch.z_high, patch.roll_low, patch.roll_high});
      pressure.push_back(patch.pressure);
    }
    return std::pair(place, pressure);
  };
  const auto [half_place, half_pressure] = of_pressure(half);
  const auto [whole_place, whole_pressure] = of_pressure(whole);
  return std::max({worst, difference(half_place, whole_place), difference(half_pressure, whole_pressure)});
}

const char* const whole_face = "symmetry: the whole face";

void check_half_is_whole(annulus::test::Verification& record, const std::string& name, const LoadedMeshProblem& problem,
                         int degree) {
  const std::vector<double> phases = {0.3, 0.75};
  const auto halves = solve(problem, degree, true, phases), wholes = solve(problem, degree, false, phases);
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const auto &half = halves[i], &whole = wholes[i];
    const double worst = largest_difference(half.position, whole.position);
    const double stresses = difference(half.stresses, whole.stresses);
    BOOST_TEST_MESSAGE(name << ", phase " << phases[i] << ": figures " << worst << ", stresses " << stresses);
    record.at_most(name + ": all figures of a position, largest relative difference", "", worst, round_off,
                   "rounding x condition number");
    record.at_most(name + ": stresses, largest relative difference", "", stresses, round_off,
                   "rounding x condition number");
    BOOST_TEST(half.position.force_balance_relative < round_off);
    BOOST_TEST(half.position.energy_balance_relative < round_off);
    BOOST_TEST(half.position.reciprocity_relative < round_off);
  }
}

BOOST_AUTO_TEST_CASE(half_of_a_crowned_ring_held_outside_is_its_whole) {
  annulus::test::Verification record("Half the face of a crowned ring", whole_face);
  check_half_is_whole(record, "held outside", crowned_ring(annulus::fem::OutsideHeld{}), 2);
}

BOOST_AUTO_TEST_CASE(half_of_a_crowned_sun_mesh_is_its_whole) {
  annulus::test::Verification record("Half the face of a crowned sun mesh", whole_face);
  check_half_is_whole(record, "sun mesh", with_planet_lead(sun_mesh(2), crowning, 0), 1);
}

BOOST_AUTO_TEST_CASE(half_of_a_ring_on_pins_is_its_whole) {
  annulus::test::Verification record("Half the face of rings on pins and bolts", whole_face);
  PinHeld pins = paper_pins(18, 0.1);
  pins.clearance = 5e-6;
  pins.free_span = 6e-3;  // the ends of the pins carry by the lever rule
  pins.housing_clearance = 4e-6;
  check_half_is_whole(record, "pins", crowned_ring(pins), 1);
  pins = paper_pins(5, 0);
  pins.unilateral = false;
  pins.radial_stiffness = 3e9;
  pins.tangential_stiffness = 1e9;
  check_half_is_whole(record, "bolts", crowned_ring(pins), 1);
}

BOOST_AUTO_TEST_CASE(half_of_a_splined_ring_is_its_whole) {
  annulus::fem::SplineHeld spline;
  spline.teeth = 27;
  spline.flank_angle = 0.5;
  spline.clearance = 3e-6;
  annulus::test::Verification record("Half the face of a ring in a spline", whole_face);
  check_half_is_whole(record, "splines", crowned_ring(spline), 1);
}

BOOST_AUTO_TEST_CASE(a_result_on_half_of_the_face_is_one_of_the_whole) {
  annulus::test::Verification record("A crowned mesh solved on half of its face", "the whole face on the same cells");
  LoadedMeshSettings settings;
  settings.fidelity = Fidelity::solid;
  settings.degree = 1;
  settings.level = 2;  // between an even number of cells and another one
  settings.threads = 2;
  const auto problem = with_planet_lead(sun_mesh(2, {0.5 * nominal_load, nominal_load}), crowning, 0);
  const auto half = solve_loaded_mesh(problem, settings);
  settings.symmetry = false;
  const auto whole = solve_loaded_mesh(problem, settings);
  BOOST_TEST(half.half_face);
  BOOST_TEST(!whole.half_face);
  BOOST_TEST(static_cast<double>(half.unknowns) < 0.55 * static_cast<double>(whole.unknowns));
  settings.symmetry = true;
  // Held nodes are counted by the estimate: an eighth of all with linear elements.
  BOOST_TEST(annulus::fem::estimated_unknowns(problem, settings, 2) == static_cast<double>(half.unknowns),
             boost::test_tools::tolerance(0.15));
  BOOST_TEST_REQUIRE(half.positions.size() == whole.positions.size());
  double worst = 0;
  for (std::size_t i = 0; i < half.positions.size(); ++i) {
    const auto &p = half.positions[i], &q = whole.positions[i];
    worst = std::max({worst, largest_difference(p, q), difference({p.entry.error_relative}, {q.entry.error_relative})});
    BOOST_TEST(p.pinion_stress.has_value() == q.pinion_stress.has_value());
    if (p.wheel_stress) worst = std::max(worst, difference(figures(*p.wheel_stress), figures(*q.wheel_stress)));
  }
  BOOST_TEST_MESSAGE("largest difference " << worst);
  // The error is a difference of two levels, the stiffnesses of which agree to round-off.
  record.at_most("transmission error, stiffness, shares, stresses, error estimates, largest relative difference", "",
                 worst, 10 * round_off, "rounding; errors are differences of two levels");
  BOOST_TEST(difference(half.slice_edges, whole.slice_edges) < 1e-12);
  record.close("volume of the wheel's tooth", "m^3", half.wheel_sector.area_or_volume(),
               whole.wheel_sector.area_or_volume(), 1e-12, "rounding");
  BOOST_TEST(half.pinion_sector.cells.size() == whole.pinion_sector.cells.size());
  BOOST_TEST(half.stress_curves.size() == whole.stress_curves.size());
  for (std::size_t i = 0; i < half.stress_curves.size(); ++i)
    BOOST_TEST(difference(half.stress_curves[i].von_mises, whole.stress_curves[i].von_mises) < round_off);
}

BOOST_AUTO_TEST_CASE(an_odd_number_of_cells_is_as_good_halved) {
  annulus::test::Verification record("Half the face of a crowned ring with an odd number of cells",
                                     "the whole face; what the level leaves, against quadratic elements");
  // Five linear cells: the one in the middle is cut in two. Of what the level leaves, compared with a quadratic
  // one, that changes the deflection by little, the load of the most loaded slice by up to as much.
  const auto problem = crowned_ring(annulus::fem::OutsideHeld{});
  ContactBench half(problem, 0, Fidelity::solid, Symmetry::used, 1),
      whole(problem, 0, Fidelity::solid, Symmetry::off, 1), finer(problem, 1, Fidelity::solid, Symmetry::used);
  BOOST_TEST(half.bodies().slice_edges.size() == 6U);
  const auto a = half.solve(0.3, nominal_load), b = whole.solve(0.3, nominal_load), c = finer.solve(0.3, nominal_load);
  const double softer = a.entry.lte / b.entry.lte - 1, left = c.entry.lte / b.entry.lte - 1;
  const double uneven = a.face_load_factor / b.face_load_factor - 1,
               left_uneven = c.face_load_factor / b.face_load_factor - 1;
  BOOST_TEST_MESSAGE("odd cells: softer by " << softer << " of " << left << ", face load factor " << uneven << " of "
                                             << left_uneven << ", line load " << difference(a.line_load, b.line_load));
  record.at_most("transmission error, change by halving over what the level leaves", "",
                 std::abs(softer) / std::abs(left), 0.01, "the cell in the middle is cut in two");
  BOOST_TEST(std::abs(softer) < 0.01 * std::abs(left));
  record.at_most("face load factor, change by halving over what the level leaves", "",
                 std::abs(uneven) / std::abs(left_uneven), 1, "up to as much");
  BOOST_TEST(std::abs(uneven) < std::abs(left_uneven));
}

BOOST_AUTO_TEST_CASE(what_differs_along_the_face_is_solved_whole) {
  LoadedMeshSettings settings;
  settings.fidelity = Fidelity::solid;
  const auto half = [&](const LoadedMeshProblem& problem) { return annulus::fem::solved_face(problem, settings).half; };
  const annulus::fem::OutsideHeld held;
  const auto plain = ring_mesh(held, 2);
  BOOST_TEST(half(plain));
  BOOST_TEST(half(crowned_ring(held)));
  BOOST_TEST(half(ring_mesh(paper_pins(18, 0), 2)));
  BOOST_TEST(half(ring_mesh(annulus::fem::SplineHeld{27, 0.5}, 2)));
  BOOST_TEST(half(with_planet_lead(sun_mesh(2), crowning, 0)));

  BOOST_TEST(!half(with_planet_lead(plain, 0, 10e-6)));
  BOOST_TEST(!half(with_planet_lead(plain, crowning, -10e-6)));
  auto misaligned = plain;
  misaligned.misalignment = 1e-6;
  BOOST_TEST(!half(misaligned));
  BOOST_TEST(!half(ring_mesh(annulus::fem::EndFaceHeld{18e-3, 10.6e-3}, 2)));
  BOOST_TEST(!half(ring_mesh(annulus::fem::FlangeHeld{88e-3, ring_outside + 15e-3}, 2)));
  auto turned = ring_paper_planet(), sun = annulus::geometry::GearParameters(plain.pair.pinion().parameters());
  turned.helix_angle = 0.1;
  sun.helix_angle = -0.1;
  sun.tip_diameter.reset();
  const double apart = annulus::geometry::Gear(turned).reference_radius() +
                       annulus::geometry::Gear(sun).reference_radius() +
                       (turned.profile_shift + sun.profile_shift) * turned.module;
  auto helical = sun_mesh(2);
  helical.pair = {annulus::geometry::Gear(turned), annulus::geometry::Gear(sun), apart};
  BOOST_TEST(!half(helical));
  // Crowned about the middle of a gear that is wider than its mesh.
  auto narrow = crowned_ring(held);
  narrow.face_width /= 2;
  BOOST_TEST(!half(narrow));
  BOOST_TEST(annulus::fem::asymmetry_of_face(plain).empty());
  BOOST_TEST(!annulus::fem::asymmetry_of_face(misaligned).empty());
  settings.symmetry = false;
  BOOST_TEST(!half(plain));
  settings.symmetry = true;
  settings.fidelity = Fidelity::plane;
  BOOST_TEST(!half(plain));
}

/// A coarse sector of a ring, half of its face.
struct HalfSector {
  LoadedMeshProblem problem = ring_mesh(annulus::fem::OutsideHeld{}, 2);
  annulus::geometry::ToothProfile profile{problem.pair.wheel()};
  annulus::fem::BodyPlan plan{problem,
                              profile,
                              annulus::geometry::GearRole::wheel,
                              annulus::geometry::Boundary::trailing_flank,
                              1,
                              annulus::fem::BodyPlan::Dimension::solid,
                              {problem.face_width, true}};
  annulus::geometry::Mesh mesh = plan.sector({{4, 2, 2, 1, 1, 1.0}, 2, 1});

  [[nodiscard]] annulus::fem::CondensedTooth condense(const annulus::fem::GearBodyOptions& options) const {
    return condense_tooth(mesh, profile, plan.support_radius(), problem.materials.wheel, options);
  }
};

BOOST_AUTO_TEST_CASE(halves_of_teeth_can_be_exchanged) {
  annulus::test::Verification record("A half tooth replaced by its like",
                                     "the ring composed of equal halves by harmonics");
  // As the resolved model does: a tooth in the place of its like changes nothing.
  const HalfSector half;
  annulus::fem::GearBodyOptions options;
  options.sector = half.plan.model();
  const auto sector = half.condense(options).sector;
  BOOST_TEST(sector.axially_held());
  const int teeth = half.problem.pair.wheel().teeth();
  const annulus::fem::AlteredRing altered(sector, teeth, 3, 1);
  const Eigen::MatrixXd exchanged = altered.compliance({&sector, &sector});
  const auto regular = annulus::fem::compose_ring(sector, teeth, {3, false}, annulus::fem::SectorSupport::held, 1);
  const Eigen::Index ports = sector.ports;
  const double largest = regular.block(0).cwiseAbs().maxCoeff();
  record.at_most("compliance of a tooth, relative difference", "",
                 (exchanged.topLeftCorner(ports, ports) - regular.block(0)).cwiseAbs().maxCoeff() / largest, round_off,
                 "rounding");
  record.at_most("compliance between neighbours, relative difference", "",
                 (exchanged.bottomLeftCorner(ports, ports) - regular.block(1)).cwiseAbs().maxCoeff() / largest,
                 round_off, "rounding");
}

BOOST_AUTO_TEST_CASE(a_half_is_not_cached_as_a_whole) {
  const annulus::test::TemporaryFolder folder("symmetric_face");
  annulus::ResultStore store(folder.path(), "test");
  const HalfSector half;
  const auto reused = [&](bool symmetric) {
    annulus::fem::GearBodyOptions options;
    options.sector = half.plan.model();
    BOOST_TEST(options.sector.symmetric_end);
    options.sector.symmetric_end = symmetric;
    options.store = &store;
    return half.condense(options).reused;
  };
  BOOST_TEST(!reused(true));
  BOOST_TEST(!reused(false));  // the same mesh
  BOOST_TEST(reused(true));
  BOOST_TEST(reused(false));
}

BOOST_AUTO_TEST_SUITE_END()
