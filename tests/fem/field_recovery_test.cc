#include "fem/recovery/field_recovery.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/contact/contact_system.h"
#include "fem/levels/mesh_bodies.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Fields inside condensed bodies, against what the condensed bodies themselves say of their surfaces: the sectors are
/// solved a second time, and have to come out alike.
BOOST_AUTO_TEST_SUITE(field_recovery)

using namespace annulus::tests;
using annulus::fem::BodyField;
using annulus::fem::ContactForces;
using annulus::fem::ContactSystem;
using annulus::fem::FieldRecovery;
using annulus::fem::FlankContact;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedMeshSettings;
using annulus::fem::MeshBodies;
using annulus::fem::OutsideHeld;
using annulus::fem::ToothForces;

// Two exact ways that differ by round-off: 2e-16 times a condition number of some 1e6.
constexpr double round_off = 1e-9;

struct Solved {
  explicit Solved(const LoadedMeshProblem& p)
      : problem(p), flanks(p.pair), bodies(annulus::fem::build_bodies(problem, flanks, LoadedMeshSettings{}, 1)) {}
  LoadedMeshProblem problem;
  FlankContact flanks;
  MeshBodies bodies;
};

/// Any forces on the flank ports of a tooth.
ToothForces some_forces(int tooth, int ports) {
  ToothForces forces{tooth, Eigen::VectorXd(ports)};
  for (int p = 0; p < ports; ++p) forces.ports[p] = 1e4 * (1 + std::sin(p + tooth));
  return forces;
}

BOOST_AUTO_TEST_CASE(flanks_move_as_the_condensed_body_says) {
  annulus::test::Verification record("Displacement inside a condensed ring",
                                     "its condensed compliance on the flanks; continuity across a cut");
  const Solved solved(ring_mesh(OutsideHeld{}, 4));
  const auto& body = solved.bodies.wheel->body();
  const double width = solved.problem.face_width;
  const FieldRecovery recovery(body, solved.bodies.wheel_source, solved.problem.materials.wheel, width, nullptr);
  const std::vector<ToothForces> teeth = {some_forces(5, body.flank_ports()), some_forces(6, body.flank_ports())};
  double largest = 0, worst = 0;
  for (const int sector : {4, 5, 6, 10}) {
    const Eigen::VectorXd u = recovery.sector_displacement(sector, teeth, {});
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(body.flank_ports());
    for (const auto& t : teeth)
      expected += body.compliance.block(sector - t.tooth).topLeftCorner(body.flank_ports(), body.flank_ports()) *
                  t.ports / width;
    for (int p = 0; p < body.flank_ports(); ++p) {
      const auto& port = body.ports[p];
      worst = std::max(worst, std::abs(port.direction.head<2>().dot(u.segment<2>(2 * port.node)) - expected[p]));
    }
    largest = std::max(largest, expected.cwiseAbs().maxCoeff());
  }
  record.at_most("displacement of the flanks, error over the largest", "", worst / largest, round_off,
                 "rounding x condition number of some 1e6");
  // The held outside does not move, and a cut moves alike from both sides.
  const auto& model = recovery.model();
  const Eigen::VectorXd left = recovery.sector_displacement(5, teeth, {}),
                        right = recovery.sector_displacement(6, teeth, {});
  const double c = std::cos(model.pitch_angle), s = std::sin(model.pitch_angle);
  double gap = 0;
  for (std::size_t i = 0; i < model.low_nodes.size(); ++i) {
    const Eigen::Vector2d from_left = left.segment<2>(2 * model.high_nodes[i]),
                          own = right.segment<2>(2 * model.low_nodes[i]);
    gap = std::max(gap, (from_left - Eigen::Vector2d(c * own.x() - s * own.y(), s * own.x() + c * own.y())).norm());
  }
  record.at_most("gap across a cut over the largest displacement", "", gap / largest, round_off,
                 "rounding x condition number of some 1e6");
}

BOOST_AUTO_TEST_CASE(a_ring_leans_on_its_pins) {
  annulus::test::Verification record("Field of a ring on pins",
                                     "the law of every pin: force x compliance closes its gap");
  // Force and gap of every pin from the field: its arc's displacement, rigid motion included, is what the pin gives
  // way.
  const Solved solved(ring_mesh(paper_pins(24, 0.01), 4));
  const auto& supports = *solved.bodies.supports;
  const auto& body = solved.bodies.wheel->body();
  const ContactSystem system(solved.flanks, *solved.bodies.pinion, *solved.bodies.wheel, &supports,
                             solved.problem.materials, solved.bodies.slice_edges, {});
  ContactSystem::PairsCache cache;
  ContactSystem::WarmStart warm;
  ContactForces forces;
  (void)system.solve(1, 0.25, nominal_load, cache, warm, &forces);
  const FieldRecovery recovery(body, solved.bodies.wheel_source, solved.problem.materials.wheel,
                               solved.problem.face_width, &supports);
  const auto& model = recovery.model();
  const Eigen::VectorXd own = supports.plan().own_compliance() * forces.supports;
  int touching = 0, parted = 0;
  double largest = 0, worst = 0, least = 1;
  for (int i = 0; i < supports.size(); ++i) {
    const auto& force = supports.plan().forces()[static_cast<std::size_t>(i)];
    double moved = supports.resultants().row(i).dot(forces.rigid);
    for (const auto& [sector, arc] : force.pieces) {
      const Eigen::VectorXd u = recovery.sector_displacement(sector, forces.wheel, forces.supports);
      for (const auto& load : on_outside(supports.plan().arcs()[static_cast<std::size_t>(arc)], model.outside))
        moved += load.force.head<2>().dot(u.segment<2>(2 * load.node));
    }
    const double gap = moved + own[i] + supports.gap()[i];
    largest = std::max(largest, std::abs(own[i]));
    if (forces.supports[i] != 0 || !supports.unilateral()[static_cast<std::size_t>(i)]) {
      ++touching;
      worst = std::max(worst, std::abs(gap));
    } else {
      ++parted;
      least = std::min(least, gap);
    }
  }
  BOOST_TEST(touching > 24);  // tangentially all of them
  BOOST_TEST(parted > 0);
  record.at_most("gap under touching pins over the largest deflection of a pin", "", worst / largest, 1e-8,
                 "rounding x condition number");
  BOOST_TEST(least > 0);
}

/// Where the field is largest, and how large.
std::size_t largest_at(const BodyField& field) {
  std::size_t at = 0;
  for (std::size_t v = 0; v < field.stress.size(); ++v)
    if (field.von_mises(v) > field.von_mises(at)) at = v;
  return at;
}

BOOST_AUTO_TEST_CASE(stresses_of_the_field_are_those_of_the_surface) {
  annulus::test::Verification record("Largest stress of the field in the roots",
                                     "surface stress by reciprocity at the same position");
  LoadedMeshSettings settings;
  settings.level = 2;
  settings.recovery = annulus::fem::Recovery::fields;
  for (const auto& problem : {ring_mesh(OutsideHeld{}, 8), ring_mesh(paper_pins(24, 0.01), 2), sun_mesh(8)}) {
    const auto result = solve_loaded_mesh(problem, settings);
    BOOST_TEST_REQUIRE(result.fields.size() == 2U);
    for (const auto& field : result.fields) {
      const bool planet = field.body == annulus::geometry::GearRole::pinion;
      const auto& position = result.positions[field.position];
      const auto& gear = planet ? problem.pair.pinion() : problem.pair.wheel();
      BOOST_TEST(field.mesh.worst_scaled_jacobian() > 0.3);  // not turned inside out by the mirror
      // The largest stress lies where the teeth touch: of the ring at the angle of the contact in its own frame.
      const auto at = largest_at(field);
      const auto& place = field.mesh.vertices[at];
      if (!planet && problem.pair.internal())
        BOOST_TEST(std::abs(std::remainder(std::atan2(place.y(), place.x()) - position.ring_angle, 2 * M_PI)) <
                   1.5 * gear.pitch_angle());
      // Root fillets: the surface's own stress, at the same position, between vertices up to 1 % higher (the fillet of
      // a ring is the narrowest). Not beside the form circle, where a tip may touch: the inside is stressed there.
      const double module = gear.parameters().module, form = gear.form_radius();
      double root = 0;
      for (std::size_t v = 0; v < field.stress.size(); ++v) {
        const double radius = field.mesh.vertices[v].head<2>().norm();
        const bool below = problem.pair.internal() && !planet
                               ? radius > form + 0.1 * module && radius < 1.002 * gear.root_radius()
                               : radius < form - 0.1 * module && radius > 0.998 * gear.root_radius();
        if (below) root = std::max(root, field.von_mises(v));
      }
      const auto& surface = planet ? *position.pinion_stress : *position.wheel_stress;
      record.close("von Mises stress", "Pa", root, surface.root_von_mises, 0.01, "vertices beside the largest");
      // Displacements are of the size of the transmission error.
      double largest = 0;
      for (const auto& u : field.displacement) largest = std::max(largest, u.norm());
      BOOST_TEST(largest > 0.1 * position.entry.lte);
      BOOST_TEST(largest < 3 * position.entry.lte);
    }
  }
}

BOOST_AUTO_TEST_CASE(solid_bodies_have_fields_near_the_contact) {
  annulus::test::Verification record("Displacement field of a thin-walled ring",
                                     "the held end; a cantilever gives way most at its free end");
  LoadedMeshSettings settings;
  settings.level = 1;
  settings.fidelity = annulus::fem::Fidelity::solid;
  settings.recovery = annulus::fem::Recovery::fields;
  const auto problem = ring_mesh(annulus::fem::EndFaceHeld{18e-3, 10.6e-3, {}}, 2);
  const auto result = solve_loaded_mesh(problem, settings);
  BOOST_TEST_REQUIRE(result.fields.size() == 2U);
  const auto& ring = result.fields.back();
  const auto& position = result.positions[ring.position];
  BOOST_TEST(ring.mesh.dimension == 3);
  BOOST_TEST(ring.mesh.worst_scaled_jacobian() > 0.1);
  // The cantilever: the held end, below the sleeve, stays; the free end of the face gives way more than the other one.
  double held = 0, low = 0, high = 0;
  for (std::size_t v = 0; v < ring.displacement.size(); ++v) {
    const double z = ring.mesh.vertices[v].z(), u = ring.displacement[v].norm();
    if (z < -17.999e-3) held = std::max(held, u);
    if (std::abs(z) < 1e-6) low = std::max(low, u);
    if (std::abs(z - problem.face_width) < 1e-6) high = std::max(high, u);
  }
  record.near("largest displacement of the held end", "m", held, 0, 0, "held");
  BOOST_TEST_REQUIRE(low > 0);
  record.at_least("largest displacement at the free end of the face over that at the other", "", high / low, 1,
                  "a cantilever");
  BOOST_TEST(high > low);
  record.at_most("largest displacement of the face over the transmission error", "", high / position.entry.lte, 3,
                 "its size");
  BOOST_TEST(high < 3 * position.entry.lte);
}

BOOST_AUTO_TEST_SUITE_END()
