#include "fem/ring/ring_coupling.h"
#include "discretised_body.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "fem/ring/ring_on_supports.h"
#include "ring_paper_problems.h"
#include "small_ring.h"
#include "tests/verification_record.h"

/// How ring meshes act on each other through the ring.
BOOST_AUTO_TEST_SUITE(ring_coupling)

using namespace annulus::tests;
using annulus::InputError;
using annulus::fem::EndFaceHeld;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::OutsideHeld;
using annulus::fem::RingCouplingSettings;
using annulus::fem::RingOnSupports;
using annulus::fem::RingStructure;
using annulus::fem::solve_ring_coupling;
using annulus::fem::SolvedRingCoupling;

// Two exact ways that differ by round-off: 2e-16 times a condition number of some 1e6.
constexpr double round_off = 1e-9;

SolvedRingCoupling solve(const RingStructure& structure, const std::vector<double>& places, int per_cycle = 1,
                         int level = 1, int degree = 2) {
  RingCouplingSettings settings;
  settings.level = level;
  settings.per_cycle = per_cycle;
  settings.modes.count = 1;
  settings.motions = {1, 0};  // modes are not what is tested
  settings.degree = degree;
  return solve_ring_coupling(ring_mesh(structure, 2), places, nominal_load, settings);
}
SolvedRingCoupling solve(const RingStructure& structure, int planets, int per_cycle = 1, int level = 1,
                         int degree = 2) {
  return solve(structure, equal_places(planets), per_cycle, level, degree);
}

/// The paper's ring on pins, made of the parts of the program one by one.
struct PinnedRing {
  template <class Pins>
  PinnedRing(const LoadedMeshProblem& problem, const Pins& pins)
      : plan(pins.supports({162, ring_outside, problem.face_width, problem.materials.wheel}), 162,
             {0, problem.face_width}),
        flexibility(flexibility_of(problem, plan)),
        supported(flexibility, plan) {}

  static annulus::fem::RingFlexibility flexibility_of(const LoadedMeshProblem& problem,
                                                      const annulus::fem::SupportPlan& plan) {
    const annulus::geometry::ToothProfile profile(problem.pair.wheel());
    const annulus::fem::BodyPlan body(problem, profile, annulus::geometry::GearRole::wheel,
                                      annulus::geometry::Boundary::trailing_flank, 2,
                                      annulus::fem::BodyPlan::Dimension::plane, {problem.face_width, false});
    annulus::fem::RingFlexibilityOptions options;
    options.roll = problem.pair.wheel_roll_length(problem.pair.roll_length_pitch());
    options.face_width = problem.face_width;
    options.motions = {1, 0};
    options.arcs = plan.arcs();
    return make_ring_flexibility(body, annulus::fem::plane_resolution(problem.pair.wheel(), 1), problem.materials.wheel,
                                 options);
  }

  annulus::fem::SupportPlan plan;
  annulus::fem::RingFlexibility flexibility;
  RingOnSupports supported;
};

double largest(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().maxCoeff(); }

BOOST_AUTO_TEST_CASE(mesh_and_inertia_loads_of_a_held_ring_are_those_of_the_whole_mesh) {
  annulus::test::Verification record("Compliance of held rings under mesh and inertia loads",
                                     "one matrix of the whole ring, solved directly");
  for (const auto& [teeth, held] :
       {std::pair{40, SmallHeld::outside}, {41, SmallHeld::outside}, {29, SmallHeld::sleeve}}) {
    const SmallRing ring = small_ring(teeth, held, {1, 1});
    const FreeSystem system(ring.whole.stiffness, ring.fixed);
    const int loads = ring.flexibility.compliance.loads();
    std::vector<std::pair<int, int>> places;  // sector, load
    for (const int sector : {0, 1, 7, teeth / 2, teeth - 2})
      for (int load = 0; load < loads; load += 3) places.emplace_back(sector, load);
    const auto n = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd unit(ring.whole.stiffness.rows(), n), reduced(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      unit.col(i) = ring.whole_load(places[i].first, places[i].second);
      for (Eigen::Index j = 0; j < n; ++j)
        reduced(i, j) =
            ring.flexibility.compliance.block(places[i].first - places[j].first)(places[i].second, places[j].second);
    }
    const Eigen::MatrixXd free = system.restrict_rows(unit);
    // Both sides are per unit of width: the displacement is divided out once.
    const Eigen::MatrixXd exact =
        free.transpose() * annulus::tests::SparseCholesky(system.matrix).solve(free) / ring.per_width();
    double worst = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        worst = std::max(worst, std::abs(reduced(i, j) - exact(i, j)) / std::sqrt(exact(i, i) * exact(j, j)));
    BOOST_TEST_MESSAGE(teeth << " teeth, " << ring.whole.dimension << "D: " << worst);
    record.at_most("compliance, largest relative error", "", worst, round_off, "rounding x condition number");
    record.at_most("asymmetry", "", largest(reduced - reduced.transpose()) / largest(reduced), 1e-14, "rounding");
  }
}

BOOST_AUTO_TEST_CASE(a_ring_on_bolts_is_the_whole_mesh_on_springs_and_superposes) {
  annulus::test::Verification record("Compliance of a ring on bolts", "the whole mesh on springs, solved directly");
  constexpr int teeth = 36;
  const auto plan = small_ring_pins(teeth, {0.1, 1.3, 2.2, 3.5, 4.05, 5.4}, 2e8, 7e7, SmallPins::both_ways, 1e-6);
  const SmallRing ring = small_ring(teeth, SmallHeld::floating, {1, 0}, &plan);
  const RingOnSupports supported(ring.flexibility, plan);
  const FreeSystem system(ring.whole.stiffness + ring.support_stiffness(plan), ring.fixed);

  const std::vector<int> loaded = {0, 5, 13, 14, 30};
  const auto n = static_cast<Eigen::Index>(loaded.size());
  Eigen::MatrixXd unit(ring.whole.stiffness.rows(), n), patterns = Eigen::MatrixXd::Zero(teeth, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    unit.col(i) = ring.whole_load(loaded[i], 0);
    patterns(loaded[i], i) = 1;
  }
  const Eigen::MatrixXd exact =
      unit.transpose() * annulus::tests::SparseCholesky(system.matrix).solve(unit) / ring.per_width();
  const auto state = supported.solve(patterns, Eigen::VectorXd::Constant(n, 1e3), {});
  record.at_most("compliance, error over the largest entry", "", largest(state.tangent - exact) / largest(exact),
                 round_off, "rounding x condition number");
  // Play shifts the ring without changing what follows from the forces.
  const Eigen::VectorXd two = Eigen::Vector2d(700, 300);
  const auto both = supported.solve(patterns.leftCols(2), two, {});
  const auto none = supported.solve(patterns.leftCols(2), 1e-9 * two, {});
  const Eigen::VectorXd superposed = exact.topLeftCorner(2, 2) * two;
  BOOST_TEST((both.displacement - none.displacement - superposed).norm() < 1e-8 * superposed.norm());

  // The inertia loads as well, by what stands for all of them: the modes' matrix.
  const Eigen::MatrixXd all = supported.held_compliance();
  const int motions = ring.flexibility.motions;
  double worst = 0;
  for (const auto& [sector, motion] : {std::pair{0, 0}, {3, 2}, {17, motions - 1}}) {
    const Eigen::VectorXd load = ring.whole_load(sector, ring.flexibility.first_motion() + motion);
    const Eigen::VectorXd u = annulus::tests::SparseCholesky(system.matrix).solve(load);
    const Eigen::Index column = teeth + sector * motions + motion;
    const double own = load.dot(u) / ring.per_width();
    for (Eigen::Index i = 0; i < n; ++i)
      worst = std::max(worst, std::abs(all(loaded[i], column) - unit.col(i).dot(u) / ring.per_width()) /
                                  std::sqrt(own * exact(i, i)));
    worst = std::max(worst, std::abs(all(column, column) / own - 1));
  }
  record.at_most("compliance to inertia loads, largest relative error", "", worst, round_off,
                 "rounding x condition number");
}

BOOST_AUTO_TEST_CASE(pins_that_lift_off_satisfy_their_conditions_on_the_whole_mesh) {
  annulus::test::Verification record("A ring on pins that lift off",
                                     "equilibrium and complementarity, checked on the whole mesh");
  constexpr int teeth = 36;
  const auto plan = small_ring_pins(teeth, annulus::fem::equal_angles(9, 0.05), 4e8, 4e8, SmallPins::unilateral);
  const SmallRing ring = small_ring(teeth, SmallHeld::floating, {1, 0}, &plan);
  const RingOnSupports supported(ring.flexibility, plan);
  const Eigen::Index planets = 3;
  Eigen::MatrixXd patterns = Eigen::MatrixXd::Zero(teeth, planets), unit(ring.whole.stiffness.rows(), planets);
  for (Eigen::Index n = 0; n < planets; ++n) {
    patterns(12 * n, n) = 1;
    unit.col(n) = ring.whole_load(static_cast<int>(12 * n), 0);
  }
  for (const Eigen::Vector3d& forces : {Eigen::Vector3d(1e3, 1e3, 1e3), Eigen::Vector3d(1e3, 0, 200)}) {
    const auto state = supported.solve(patterns, forces, {});
    // The whole mesh under the meshes' and the supports' forces, one direction of each rigid motion held at a node.
    std::vector<bool> fixed = ring.fixed;
    const int a = ring.node_of[0][0], b = ring.node_of[teeth / 4][0];
    fixed[ring.whole.dof[2 * a]] = fixed[ring.whole.dof[2 * a + 1]] = fixed[ring.whole.dof[2 * b]] = true;
    const FreeSystem system(ring.whole.stiffness, fixed);
    Eigen::VectorXd load = unit * forces;
    for (int i = 0; i < static_cast<int>(plan.forces().size()); ++i)
      load += state.support[i] * ring.support_load(plan, i);
    // In equilibrium: the held nodes carry nothing.
    const Eigen::VectorXd u =
        system.extend_rows(annulus::tests::SparseCholesky(system.matrix).solve(system.restrict_rows(load)));
    record.at_most("residual of the equilibrium over the load", "",
                   (ring.whole.stiffness * u - load).norm() / load.norm(), 1e-8, "rounding x condition number");
    // Gaps up to the rigid motion that the touching supports fix.
    const auto count = static_cast<Eigen::Index>(plan.forces().size());
    Eigen::VectorXd gap(count);
    Eigen::MatrixXd rigid(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::VectorXd arc = ring.support_load(plan, static_cast<int>(i)) / ring.per_width();
      gap[i] = arc.dot(u) + state.support[i] / plan.direction(plan.forces()[i]).stiffness;
      rigid.row(i).setZero();
      for (std::size_t node = 0; node < ring.whole.nodes.size(); ++node) {
        const double x = arc[ring.whole.dof[2 * node]], y = arc[ring.whole.dof[2 * node + 1]];
        rigid.row(i) +=
            Eigen::RowVector3d(x, y, (ring.whole.nodes[node].x() * y - ring.whole.nodes[node].y() * x) / ring.outside);
      }
    }
    std::vector<Eigen::Index> touching;
    for (Eigen::Index i = 0; i < count; ++i)
      if (state.touching[i]) touching.push_back(i);
    BOOST_TEST(touching.size() < plan.forces().size());  // some do lift off
    const Eigen::MatrixXd of_touching = rigid(touching, Eigen::all);
    const Eigen::VectorXd motion = of_touching.colPivHouseholderQr().solve(-gap(touching));
    gap += rigid * motion;
    const double scale = gap.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool one_sided = plan.direction(plan.forces()[i]).unilateral;
      if (state.touching[i])
        record.at_most("gap under a touching pin over the largest gap", "", std::abs(gap[i]) / scale, 1e-7,
                       "rounding x condition number");
      if (!state.touching[i]) BOOST_TEST(state.support[i] == 0);
      if (one_sided) BOOST_TEST((state.support[i] >= 0 && gap[i] >= -1e-7 * scale));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_force_between_two_teeth_lies_on_four_of_them) {
  annulus::test::Verification record("A mesh force between two teeth", "cubic interpolation is exact for cubics");
  for (const double position : {0.0, 0.3, 7.5, 161.9, -2.25, 500.6}) {
    const Eigen::VectorXd weights = annulus::fem::mesh_force_on_teeth(position, 162);
    // Cubic interpolation is exact for cubics of the tooth number, counted backwards from the position.
    Eigen::Vector4d moments = Eigen::Vector4d::Zero();
    for (int tooth = 0; tooth < 162; ++tooth) {
      const double distance = std::remainder(-tooth - position, 162.0);
      for (int k = 0; k < 4; ++k) moments[k] += weights[tooth] * std::pow(distance, k);
    }
    record.at_most("moments of the weights up to the third, error", "", (moments - Eigen::Vector4d(1, 0, 0, 0)).norm(),
                   1e-12, "rounding");
  }
}

BOOST_AUTO_TEST_CASE(on_soft_bolts_the_ring_moves_like_a_rigid_body) {
  annulus::test::Verification record("Coupling of five planets through a ring on soft bolts",
                                     "closed form: a rigid body on springs");
  auto bolts = paper_pins(24, 0.01);
  bolts.unilateral = false;
  const double half_arc = pin_diameter / 2 / ring_outside, lever = ring_outside * (1 - half_arc * half_arc / 10);
  for (const auto& [radial, tangential] : {std::pair{1e4, 3e3}, {3e3, 1e4}}) {
    bolts.radial_stiffness = radial;
    bolts.tangential_stiffness = tangential;
    const auto solved = solve(bolts, 5, 3);
    const double rb = ring_mesh(bolts, 2).pair.wheel().base_radius();
    const double translation = 24 / 2.0 * (radial + tangential), rotation = 24 * tangential * lever * lever;
    for (const auto& matrix : solved.coupling.compliance)
      for (int n = 0; n < 5; ++n)
        for (int m = 0; m < 5; ++m) {
          const double rigid = n == m ? 0 : std::cos(2 * M_PI * (n - m) / 5) / translation + rb * rb / rotation;
          // What is left is the bending of the rim between supports that press all around; forces between teeth lie on
          // four of them, fanned out by at most three pitches: less than (3 * 0.039)^2 of a part that cubics miss.
          record.near("compliance between two meshes", "m/N", matrix(n, m), rigid,
                      5e-3 * (1 / translation + rb * rb / rotation), "bending of the rim between its supports");
        }
  }
}

BOOST_AUTO_TEST_CASE(the_diagonal_makes_equal_loads_exact) {
  annulus::test::Verification record("Coupling matrix of five planets on nine pins that lift off",
                                     "the states it was linearised at, solved anew");
  auto pins = paper_pins(9, 0.02);
  const std::vector<double> equal = equal_places(5), unequal = {0, 20.25, 61, 90.5, 140.75};
  for (const auto& [places, clearance] : {std::pair(equal, 0.0), {equal, 20e-6}, {unequal, 0.0}, {unequal, 20e-6}}) {
    pins.clearance = clearance;
    const auto solved = solve(pins, places);
    BOOST_TEST(solved.coupling.compliance.size() == 18U);
    // Anew from the states, at some positions.
    const PinnedRing ring(ring_mesh(pins, 2), pins);
    const auto& supported = ring.supported;
    for (const int position : {0, 7, 16}) {
      Eigen::MatrixXd patterns(162, 5);
      for (int n = 0; n < 5; ++n) patterns.col(n) = annulus::fem::mesh_force_on_teeth(position + places[n], 162);
      const Eigen::VectorXd all =
          supported.solve(patterns, Eigen::VectorXd::Constant(5, nominal_load), {}).displacement;
      const auto& coupling = solved.coupling.compliance[position];
      BOOST_TEST(largest(coupling - coupling.transpose()) < 1e-12 * largest(coupling));
      for (int n = 0; n < 5; ++n) {
        const double alone =
            supported.solve(patterns.col(n), Eigen::VectorXd::Constant(1, nominal_load), {}).displacement[0];
        record.near("displacement by the others under equal loads", "m", coupling.row(n).sum() * nominal_load,
                    all[n] - alone, 1e-10 * all[n], "rounding of the solve");
      }
      // A small change of one load moves the others by the entries off the diagonal.
      const double more = 1e-3 * nominal_load;
      Eigen::VectorXd changed = Eigen::VectorXd::Constant(5, nominal_load);
      changed[2] += more;
      const Eigen::VectorXd moved = supported.solve(patterns, changed, {}).displacement - all;
      for (const int n : {0, 1, 3, 4})
        // Unless the change lifts a pin; then the tangent is that of either side.
        BOOST_TEST(std::abs(moved[n] - coupling(n, 2) * more) < 1e-2 * std::abs(coupling.col(2).maxCoeff()) * more);
    }
  }
}

BOOST_AUTO_TEST_CASE(unequally_spaced_planets_are_some_of_many_equally_spaced_ones) {
  annulus::test::Verification record("Coupling of unequally spaced planets",
                                     "those of nine equally spaced planets at the same places: linear supports");
  // Where nothing lifts off, planets that are not there change nothing for the others.
  const std::vector<int> kept = {0, 1, 4, 7};
  const auto many = equal_places(9);
  std::vector<double> places;
  for (const int n : kept) places.push_back(many[static_cast<std::size_t>(n)]);
  auto bolts = paper_pins(27, 0.02);
  bolts.unilateral = false;
  for (const RingStructure& structure : {RingStructure(OutsideHeld{}), RingStructure(bolts)}) {
    const auto all = solve(structure, 9), some = solve(structure, places);
    BOOST_TEST_REQUIRE(all.coupling.compliance.size() == some.coupling.compliance.size());
    for (std::size_t i = 0; i < all.coupling.compliance.size(); ++i) {
      const auto &a = all.coupling.compliance[i], &b = some.coupling.compliance[i];
      for (Eigen::Index n = 0; n < 4; ++n)
        for (Eigen::Index m = 0; m < 4; ++m)
          record.at_most("coupling, relative difference", "", std::abs(b(n, m) - a(kept[n], kept[m])) / largest(a),
                         round_off, "rounding");
    }
  }
}

BOOST_AUTO_TEST_CASE(pins_turned_by_a_tooth_shift_the_ring_positions) {
  annulus::test::Verification record("Pins turned by two teeth", "symmetry: ring positions are shifted");
  const double pitch = 2 * M_PI / 162;
  const auto here = solve(paper_pins(18, 0.01), 5, 2), turned = solve(paper_pins(18, 0.01 + 2 * pitch), 5, 2);
  const auto positions = here.coupling.compliance.size();
  BOOST_TEST_REQUIRE(positions == 18U);
  double scale = 0, worst = 0, apart = 0;
  for (std::size_t i = 0; i < positions; ++i) {
    scale = std::max(scale, largest(here.coupling.compliance[i]));
    // Planets travel counter-clockwise: they meet pins turned counter-clockwise two teeth later.
    const auto& later = turned.coupling.compliance[(i + 4) % positions];
    worst = std::max(worst, largest(later - here.coupling.compliance[i]));
    apart = std::max(apart, largest(turned.coupling.compliance[i] - here.coupling.compliance[i]));
  }
  record.at_most("coupling, difference over the largest entry", "", worst / scale, 1e-7,
                 "condition of the pins' compliance");
  BOOST_TEST(apart > 0.1 * scale);  // it does tell
}

BOOST_AUTO_TEST_CASE(planets_in_equal_positions_couple_equally) {
  annulus::test::Verification record("Six planets in equal positions on 18 pins", "symmetry: a circulant matrix");
  // 18 pins and 6 planets on 162 teeth: every planet sees the same, 27 teeth apart.
  const auto solved = solve(paper_pins(18, 0.01), 6);
  for (const auto& matrix : solved.coupling.compliance) {
    double worst = 0;
    for (int n = 0; n < 6; ++n)
      for (int m = 0; m < 6; ++m) worst = std::max(worst, std::abs(matrix(n, m) - matrix((n + 1) % 6, (m + 1) % 6)));
    record.at_most("coupling, difference over the largest entry", "", worst / largest(matrix), 1e-7,
                   "condition of the pins' compliance");
  }
}

BOOST_AUTO_TEST_CASE(pins_carry_what_they_carry_in_the_loaded_mesh) {
  annulus::test::Verification record("Pin forces of the coupling model", "those of the loaded mesh at the same place");
  // The same ring position means the same place: pins next to the planet carry it in both models.
  auto pins = paper_pins(6, 0.3);
  const auto problem = ring_mesh(pins, 2);
  const auto table = solve_plane(problem);
  const PinnedRing ring(problem, pins);
  const auto& supported = ring.supported;
  for (const int i : {0, 1, 8, 21, 40}) {
    const auto& position = table.positions[i];
    const auto differ = [&](double shift) {
      const auto state =
          supported.solve(annulus::fem::mesh_force_on_teeth(position.ring_tooth + position.mesh_phase + shift, 162),
                          Eigen::VectorXd::Constant(1, nominal_load), {});
      double worst = 0;
      for (Eigen::Index pin = 0; pin < 6; ++pin) {
        worst = std::max(worst, std::abs(position.pins[pin].radial_force - state.support[2 * pin]));
        worst = std::max(worst, std::abs(position.pins[pin].tangential_force - state.support[2 * pin + 1]));
      }
      return worst / nominal_load;
    };
    const double here = differ(0);
    BOOST_TEST_MESSAGE("position " << i << ": pin forces differ by " << here << ", two teeth on by " << differ(2)
                                   << ", two teeth back by " << differ(-2));
    // Two pairs share the load and hand it to the rim up to a tooth away from where the mesh force stands.
    record.at_most("force on a pin, largest difference over the load", "", here, 0.05,
                   "two pairs share the load and hand it to the rim up to a tooth away");
    BOOST_TEST(here < 0.7 * differ(2));
    BOOST_TEST(here < 0.7 * differ(-2));
  }
}

BOOST_AUTO_TEST_CASE(many_stiff_bolts_hold_like_a_held_surface) {
  annulus::test::Verification record("Coupling through a ring on ever stiffer bolts behind every tooth",
                                     "limit: the held outer surface");
  // Bolts behind every tooth, as wide as their spacing: what is left is one tooth's far field.
  double before = 1;
  for (const double stiffness : {1e8, 1e9, 1e10}) {
    auto bolts = paper_pins(162, 0);
    bolts.unilateral = false;
    bolts.pin_diameter = ring_outside * 2 * M_PI / 162;
    bolts.radial_stiffness = bolts.tangential_stiffness = stiffness;
    const auto solved = solve(bolts, 5);
    BOOST_TEST(solved.coupling.compliance.size() == 1U);
    const double coupling = largest(solved.coupling.compliance[0]);
    BOOST_TEST_MESSAGE(stiffness << " N/m: own " << solved.own_compliance << ", coupling " << coupling);
    BOOST_TEST(coupling < 0.2 * before);
    if (before < 1)
      record.at_most("coupling over that on bolts ten times softer", "", coupling / before, 0.2,
                     "a tenth in the limit");
    before = coupling;
  }
  const auto held = solve(OutsideHeld{}, 5);
  record.at_most("coupling of a held ring over that on the stiffest bolts", "",
                 largest(held.coupling.compliance[0]) / before, 0.2, "the limit, and no springs any more");
  BOOST_TEST(held.coupling.compliance[0].diagonal().isZero(0));
}

BOOST_AUTO_TEST_CASE(the_matrix_of_the_teeth_couples_planets_as_the_coupling_does) {
  annulus::test::Verification record("Compliance matrix of all ring teeth", "the coupling of three planets");
  // Three planets 54 teeth apart; bolts that are not symmetric, so that the numbering of teeth shows.
  auto bolts = paper_pins(7, 0.3);
  bolts.unilateral = false;
  const std::vector<RingStructure> structures = {bolts, OutsideHeld{}};
  for (const auto& structure : structures) {
    const auto solved = solve(structure, 3);
    const auto& teeth = solved.teeth_compliance;
    BOOST_TEST_REQUIRE(teeth.rows() == 162);
    const double plane = annulus::fem::plane_strain_bounds(ring_mesh(structure, 2)).compliance;
    BOOST_TEST(largest(teeth - teeth.transpose()) == 0);
    BOOST_TEST((Eigen::LLT<Eigen::MatrixXd>(teeth).info() == Eigen::Success));
    double worst = 0;
    for (std::size_t i = 0; i < solved.coupling.compliance.size(); ++i)
      for (int n = 0; n < 3; ++n)
        for (int m = 0; m < 3; ++m) {
          const auto row = (static_cast<int>(i) + 54 * n) % 162, column = (static_cast<int>(i) + 54 * m) % 162;
          if (n != m) worst = std::max(worst, std::abs(solved.coupling.compliance[i](n, m) - teeth(row, column)));
        }
    record.at_most("entry, difference over the largest", "", worst / largest(teeth), round_off,
                   "rounding x condition number");
    BOOST_TEST(solved.teeth_compliance_error < (0.05 + plane) * largest(teeth));
  }
}

BOOST_AUTO_TEST_CASE(a_linear_ring_couples_equally_at_every_position) {
  annulus::test::Verification record("Ten planets on a thin-walled ring",
                                     "symmetry: a linear ring has the same coupling everywhere");
  // Ten planets on a cantilever: near enough to feel each other, 16.2 teeth apart.
  RingCouplingSettings settings;
  settings.per_cycle = 4;
  settings.modes.count = 1;
  settings.motions = {1, 0};
  const auto solved =
      solve_ring_coupling(ring_mesh(EndFaceHeld{18e-3, 10.6e-3, {}}, 2), equal_places(10), nominal_load, settings);
  BOOST_TEST_REQUIRE(solved.coupling.compliance.size() == 4U);
  const auto& first = solved.coupling.compliance.front();
  double worst = 0;
  for (const auto& matrix : solved.coupling.compliance) {
    worst = std::max(worst, largest(matrix - first));
    for (int n = 0; n < 10; ++n)
      for (int m = 0; m < 10; ++m) {
        BOOST_TEST((n != m || matrix(n, m) == 0));
        worst = std::max(worst, std::abs(matrix(n, m) - first(0, (n - m + 10) % 10)));
      }
  }
  BOOST_TEST_MESSAGE("own " << solved.own_compliance << ", neighbours " << first(0, 1) << ", varies by "
                            << worst / largest(first) << ", error estimate " << solved.compliance_error);
  // The cubic between teeth misses (pitch / wave length)^4 of a field whose waves are twenty teeth long or more:
  // (2 pi / 20)^4 / 40.
  record.at_most("coupling, variation over the largest entry", "", worst / largest(first), 3e-4,
                 "cubic between teeth: (2 pi / 20)^4 / 40");
}

/// The ring mesh of the paper with helical teeth, on a sleeve.
SolvedRingCoupling helical_sleeve(double helix_angle) {
  const auto problem = with_helix(ring_mesh(EndFaceHeld{18e-3, 10.6e-3, {}}, 2), helix_angle);
  RingCouplingSettings settings;
  settings.modes.count = 6;
  settings.motions = {1, 1};
  return solve_ring_coupling(problem, equal_places(5), nominal_load, settings);
}

BOOST_AUTO_TEST_CASE(helical_rings_of_either_hand) {
  annulus::test::Verification record("Helical rings on a sleeve", "limit of small helix angles; mirror images");
  const auto spur = helical_sleeve(0), hardly = helical_sleeve(1e-4);
  const auto right = helical_sleeve(0.1), left = helical_sleeve(-0.1);
  const double scale = largest(spur.coupling.compliance[0]);
  record.at_most("coupling at 1e-4 rad against spur, over the largest entry", "",
                 largest(hardly.coupling.compliance[0] - spur.coupling.compliance[0]) / scale, 1e-2,
                 "in proportion to the helix angle");
  record.close("own compliance at 1e-4 rad against spur", "m/N", hardly.own_compliance, spur.own_compliance, 1e-3,
               "in proportion to the helix angle");
  BOOST_TEST(largest(right.coupling.compliance[0] - spur.coupling.compliance[0]) > 1e-2 * scale);
  BOOST_TEST(right.own_compliance != left.own_compliance);  // the planet presses one towards the held end, one away
  // The bodies are mirror images of each other.
  for (std::size_t k = 0; k < 6; ++k)
    record.close("natural frequency, right against left hand", "Hz", right.coupling.modes[k].frequency,
                 left.coupling.modes[k].frequency, 1e-6, "meshes of mirrored bodies");
}

BOOST_AUTO_TEST_CASE(stiffer_structures_move_less_and_ring_higher) {
  annulus::test::Verification record("Coupling and first frequency of rings held in five ways",
                                     "each other: a stiffer structure moves less and rings higher; symmetry");
  const auto modes_of = [&](const RingStructure& structure) {
    RingCouplingSettings settings;
    settings.modes.count = 1;
    settings.motions = {1, 1};
    return solve_ring_coupling(ring_mesh(structure, 2), equal_places(5), nominal_load, settings);
  };
  const auto sleeve = modes_of(EndFaceHeld{18e-3, 10.6e-3, {}});
  const auto hoop = modes_of(EndFaceHeld{18e-3, 10.6e-3, annulus::fem::Hoop{20e-3, 8e-3}});
  const auto flange = modes_of(annulus::fem::FlangeHeld{20e-3, 0.36});
  const auto held = modes_of(OutsideHeld{});
  const auto exceeds = [&](const char* quantity, double larger, double smaller) {
    record.at_least(quantity, "", larger / smaller, 1, "order of the stiffnesses");
    BOOST_TEST(larger > smaller, quantity);
  };
  exceeds("own compliance, sleeve over sleeve with hoop", sleeve.own_compliance, hoop.own_compliance);
  exceeds("own compliance, hoop over flange", hoop.own_compliance, flange.own_compliance);
  exceeds("own compliance, flange over held outside", flange.own_compliance, held.own_compliance);
  exceeds("first frequency, flange over hoop", flange.coupling.modes[0].frequency, hoop.coupling.modes[0].frequency);
  exceeds("first frequency, held outside over flange", held.coupling.modes[0].frequency,
          flange.coupling.modes[0].frequency);
  for (const auto* solved : {&sleeve, &hoop, &flange}) {
    const auto& matrix = solved->coupling.compliance[0];
    // The flange hardly lets neighbours feel each other: what counts there is small beside the mesh's own compliance.
    BOOST_TEST(solved->compliance_error < 0.05 * largest(matrix) + 1e-4 * solved->own_compliance);
    record.at_most("asymmetry of the coupling", "m/N", largest(matrix - matrix.transpose()), 0,
                   "equal to the last bit");
  }
  // Splines as well, one-sided flanks with clearance.
  annulus::fem::SplineHeld spline;
  spline.teeth = 54;
  spline.flank_angle = 0.5;
  spline.clearance = 10e-6;
  const auto splined = modes_of(spline);
  record.near("ring positions on 54 splines", "", static_cast<double>(splined.coupling.compliance.size()), 3, 0,
              "counted by hand: 162 teeth on 54 splines");
  exceeds("own compliance, splines over held outside", splined.own_compliance, held.own_compliance);
}

BOOST_AUTO_TEST_CASE(the_error_estimate_covers_the_error) {
  annulus::test::Verification record("Stated error of the coupling", "true error: two levels of refinement finer");
  for (const auto& pins : {paper_pins(18, 0.01), paper_pins(9, 0.01)}) {
    const auto fine = solve(pins, 5, 1, 3);
    for (const int degree : {1, 2}) {
      const auto coarse = solve(pins, 5, 1, 1, degree);
      double worst = 0, scale = 0, all = 0;
      for (std::size_t i = 0; i < coarse.coupling.compliance.size(); ++i) {
        worst = std::max(worst, largest(coarse.coupling.compliance[i] - fine.coupling.compliance[i]));
        scale = std::max(scale, largest(fine.coupling.compliance[i]));
        all = std::max(all, largest(coarse.coupling.compliance[i]));
      }
      // What both levels share is another matter.
      const double plane = annulus::fem::plane_strain_bounds(ring_mesh(pins, 2)).compliance,
                   stated = coarse.compliance_error - plane * all,
                   teeth_stated = coarse.teeth_compliance_error - plane * largest(coarse.teeth_compliance);
      const double teeth = largest(coarse.teeth_compliance - fine.teeth_compliance);
      BOOST_TEST_MESSAGE("degree " << degree << ": error " << worst << ", estimate " << stated << ", largest entry "
                                   << scale << ", own " << fine.own_compliance << ", teeth " << teeth << ", estimate "
                                   << teeth_stated);
      record.at_most(degree == 1 ? "true over stated error, linear" : "true over stated error", "", worst / stated, 1,
                     "stated error");
      BOOST_TEST(teeth < teeth_stated);
      BOOST_TEST(stated < (degree == 1 ? 0.04 : 0.02) * scale);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_nothing) {
  annulus::test::Verification record("Coupling and modes of a ring on three threads", "the same on one thread");
  RingCouplingSettings settings;
  settings.modes.count = 4;
  settings.motions = {1, 1};
  const auto one = solve_ring_coupling(ring_mesh(OutsideHeld{}, 2), equal_places(3), nominal_load, settings);
  settings.threads = 3;
  const auto many = solve_ring_coupling(ring_mesh(OutsideHeld{}, 2), equal_places(3), nominal_load, settings);
  record.at_most("compliance, largest difference", "m/N",
                 largest(one.coupling.compliance[0] - many.coupling.compliance[0]), 0, "equal to the last bit");
  int different = 0;
  for (std::size_t k = 0; k < one.coupling.modes.size(); ++k)
    different += one.coupling.modes[k].deflection != many.coupling.modes[k].deflection;
  record.at_most("modes that differ", "", different, 0, "equal to the last bit");
}

BOOST_AUTO_TEST_CASE(what_is_no_ring_mesh_is_refused) {
  RingCouplingSettings settings;
  BOOST_CHECK_THROW(solve_ring_coupling(sun_mesh(2), equal_places(3), nominal_load, settings), InputError);
  const auto problem = ring_mesh(OutsideHeld{}, 2);
  BOOST_CHECK_THROW(solve_ring_coupling(problem, equal_places(0), nominal_load, settings), InputError);
  BOOST_CHECK_THROW(solve_ring_coupling(problem, equal_places(41), nominal_load, settings), InputError);
  using Places = std::vector<double>;
  for (const auto& places :
       {Places{0, 3.9, 80}, Places{0, 80, 160}, Places{1, 80}, Places{0, 80, 78}, Places{0, std::nan("")}})
    BOOST_CHECK_THROW(solve_ring_coupling(problem, places, nominal_load, settings), InputError);
  BOOST_CHECK_THROW(solve_ring_coupling(problem, equal_places(3), -1, settings), InputError);
  BOOST_CHECK_THROW(solve_ring_coupling(problem, equal_places(3), std::nan(""), settings), InputError);
  for (auto* value : {&settings.level, &settings.per_cycle, &settings.motions.section, &settings.modes.count}) {
    const int good = *value;
    *value = 0;
    BOOST_CHECK_THROW(solve_ring_coupling(problem, equal_places(3), nominal_load, settings), InputError);
    *value = good;
  }
}

BOOST_AUTO_TEST_SUITE_END()
