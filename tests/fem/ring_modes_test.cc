#include "fem/ring/ring_modes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "fem/ring/ring_coupling.h"
#include "ring_paper_problems.h"
#include "small_ring.h"
#include "structured_mesh.h"
#include "tests/verification_record.h"

/// Elastic modes of rings.
BOOST_AUTO_TEST_SUITE(ring_modes)

using namespace annulus::tests;
using annulus::RingMode;
using annulus::fem::held_ring_modes;
using annulus::fem::Material;
using annulus::fem::ModeLimits;
using annulus::fem::MotionOrder;
using annulus::fem::RingFlexibility;
using annulus::fem::RingOnSupports;
using annulus::fem::supported_ring_modes;
using annulus::geometry::Boundary;

constexpr int all_modes = 1000000;
// Two exact ways that differ by round-off: 2e-16 times a condition number of some 1e6.
constexpr double round_off = 1e-9;

/// A plain floating ring of unit mean radius, modulus and density; its mesh force is radial, at a node.
RingFlexibility plain_ring(double height, int sectors, const MotionOrder& motions) {
  const double inner = 1 - height / 2, outer = 1 + height / 2, pitch = 2 * M_PI / sectors;
  const auto mesh = structured_mesh(2, 384 / sectors,
                                    [&](double u, double v) -> Eigen::Vector2d {
                                      const double r = inner + (outer - inner) * u, angle = pitch * (v - 0.5);
                                      return {r * std::cos(angle), r * std::sin(angle)};
                                    },
                                    {Boundary::root, Boundary::support, Boundary::side_low, Boundary::side_high});
  const auto project = [&](Boundary boundary, const Eigen::Vector2d& p) -> Eigen::Vector2d {
    if (boundary == Boundary::root) return p * (inner / p.norm());
    return boundary == Boundary::support ? Eigen::Vector2d(p * (outer / p.norm())) : p;
  };
  const auto body = discretise_body(mesh, project, {1.0, 0.3, 1}, 2);
  annulus::fem::SectorModel model;
  model.pitch_angle = pitch;
  model.stiffness = body.stiffness;
  model.nodal_mass = body.nodal_mass;
  model.nodes = body.nodes;
  model.dof = body.dof;
  const auto by_radius = [&](int a, int b) { return body.nodes[a].norm() < body.nodes[b].norm(); };
  model.low_nodes = body.boundary_nodes(Boundary::side_low);
  model.high_nodes = body.boundary_nodes(Boundary::side_high);
  std::sort(model.low_nodes.begin(), model.low_nodes.end(), by_radius);
  std::sort(model.high_nodes.begin(), model.high_nodes.end(), by_radius);

  annulus::fem::SectorLoads loads;
  int middle = 0;
  for (std::size_t n = 0; n < body.nodes.size(); ++n)
    if ((body.nodes[n] - Eigen::Vector3d(1, 0, 0)).norm() < (body.nodes[middle] - Eigen::Vector3d(1, 0, 0)).norm())
      middle = static_cast<int>(n);
  loads.acting.push_back({{middle, Eigen::Vector3d(-1, 0, 0)}});
  for (auto& load : inertia_loads(model, 1, motions)) loads.acting.push_back(std::move(load));
  RingFlexibility ring;
  ring.teeth = sectors;
  ring.pitch_angle = pitch;
  ring.base_radius = 1;
  ring.motions = static_cast<int>(loads.acting.size()) - 1;
  ring.resultants = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(loads.acting.size()));
  ring.compliance = compose_loads(condense(model, loads, annulus::fem::SectorSupport::floating), sectors,
                                  annulus::fem::SectorSupport::floating, 1, 1);
  return ring;
}

/// Lowest frequency with so many waves.
const RingMode& first_with(const std::vector<RingMode>& modes, int waves) {
  const auto found = std::find_if(modes.begin(), modes.end(), [&](const auto& m) { return m.waves == waves; });
  BOOST_TEST_REQUIRE((found != modes.end()));
  return *found;
}

BOOST_AUTO_TEST_CASE(a_free_thin_ring_bends_at_the_frequencies_of_hoppe_and_breathes) {
  annulus::test::Verification record(
      "Modes of a free thin ring composed of 48 sectors",
      "Hoppe 1871 (Love, Mathematical Theory of Elasticity, art. 293) less Timoshenko's shear and rotary inertia");
  annulus::test::RecordedPlot plot{"Frequency over that of Hoppe", "waves", "", {}};
  const double modulus = 1 / (1 - 0.3 * 0.3), density = 1;  // plane strain
  for (const double height : {0.01, 0.02, 0.04}) {
    const auto modes = held_ring_modes(plain_ring(height, 48, {2, 0}), {all_modes});
    const auto named = ", h/R = " + std::to_string(height).substr(0, 4);
    annulus::test::RecordedPlot::Curve curve{"h/R = " + std::to_string(height).substr(0, 4), {}, {}, {}};
    for (const int n : {2, 3, 4, 6}) {
      // omega^2 = E I / (rho A R^4) n^2 (n^2 - 1)^2 / (n^2 + 1) (Hoppe 1871; Love, Mathematical Theory of Elasticity,
      // art. 293).
      const double square = modulus * height * height / (12 * density) * n * n * std::pow(n * n - 1.0, 2) / (n * n + 1);
      const double exact = std::sqrt(square) / (2 * M_PI);
      const double off = first_with(modes, n).frequency / exact - 1;
      BOOST_TEST_MESSAGE("h/R " << height << ", " << n << " waves: " << off);
      // Shear and rotary inertia, left out of the thin ring, take (1 + E / kappa G) (n h / R)^2 / 24 off (Timoshenko's
      // beam), and of that an unknown part as much as the curvature counts.
      const double shear = (1 + modulus / (5.0 / 6 / 2.6)) * std::pow(n * height, 2) / 24;
      record.near(std::to_string(n) + " waves: frequency over Hoppe's" + named, "", 1 + off, 1 - shear,
                  0.6 * shear + 1e-5, "curvature, as large a part as shear");
      curve.x.push_back(n);
      curve.computed.push_back(1 + off);
      curve.reference.push_back(1 - shear);
      const auto& deflection = first_with(modes, n).deflection;
      // Inextensional, w = cos n theta: unit modal mass is 2 pi rho h (1 + 1 / n^2) / 2 w^2.
      record.close("radial displacement of a mode of unit mass", "", deflection[0],
                   1 / std::sqrt(M_PI * density * height * (1 + 1.0 / (n * n))), 0.01, "thin ring");
      BOOST_TEST(std::abs(deflection[48 / 2] - (n % 2 == 0 ? 1 : -1) * deflection[0]) < 1e-6 * deflection[0]);
    }
    // omega^2 = E / (rho R^2), purely radial.
    const auto& breathing = first_with(modes, 0);
    record.close("breathing: sqrt(E / rho) / (2 pi R)" + named, "Hz", breathing.frequency,
                 std::sqrt(modulus) / (2 * M_PI), height * height + 1e-5, "(h / R)^2");
    BOOST_TEST(std::abs(breathing.deflection[0]) == 1 / std::sqrt(2 * M_PI * density * height),
               boost::test_tools::tolerance(height));
    plot.curves.push_back(curve);
  }
  record.plot(plot);
}

BOOST_AUTO_TEST_CASE(shorter_sectors_and_higher_orders_come_down_to_the_frequency) {
  annulus::test::Verification record("Frequencies with ever shorter sectors",
                                     "limit: 96 sectors, motions of fourth order");
  const auto frequency = [](int sectors, int order, int waves) {
    return first_with(held_ring_modes(plain_ring(0.05, sectors, {order, 0}), {all_modes}), waves).frequency;
  };
  for (const int waves : {2, 3}) {
    const double limit = frequency(96, 4, waves);
    double before = 0;
    std::vector<double> lengths, errors;
    for (const int sectors : {12, 24, 48}) {
      const double above = frequency(sectors, 1, waves) / limit - 1;
      BOOST_TEST_MESSAGE(waves << " waves, " << sectors << " sectors: " << above);
      BOOST_TEST(above > 0);
      // Energies of what linear motions leave: of a wave's shift of the section it is of fourth order in the length of
      // a sector, of its turn of second order, with (h / R)^2.
      if (before > 0)
        record.at_least("order of convergence", "", std::log2(before / above), 0.9 * 2, "0.9 of the order 2");
      before = above;
      lengths.push_back(1.0 / sectors);
      errors.push_back(above);
    }
    record.at_most("frequency above the limit, 48 sectors, relative", "", before, 3e-5, "ceiling beside the rate");
    record.convergence("Frequency above the limit; dashed: order 2", "sector over circumference", "relative difference",
                       std::to_string(waves) + " waves", lengths, errors, 2);
    double lower = 1;
    for (const int order : {1, 2, 3}) {
      const double above = frequency(12, order, waves) / limit - 1;
      BOOST_TEST(above > -1e-12);
      BOOST_TEST(above < 0.3 * lower);
      lower = above;
    }
  }
}

/// All frequencies above those of the whole mesh, and how much at most of the first `count`.
double most_above(annulus::test::Verification& record, const std::vector<RingMode>& modes,
                  const Eigen::VectorXd& exact) {
  double most = 0;
  for (Eigen::Index k = 0; k < exact.size(); ++k) {
    const double above = modes[k].frequency / exact[k] - 1;
    record.at_least("frequency over that of the whole mesh", "", 1 + above, 1 - 1e-8,
                    "from above, as by Rayleigh and Ritz; subspace iteration");
    most = std::max(most, above);
  }
  return most;
}

BOOST_AUTO_TEST_CASE(held_rings_against_the_modes_of_the_whole_mesh) {
  annulus::test::Verification record("Reduced modes of held rings", "modes of the whole mesh by subspace iteration");
  for (const auto held : {SmallHeld::outside, SmallHeld::sleeve}) {
    const int teeth = held == SmallHeld::outside ? 37 : 29;
    Eigen::VectorXd exact;
    double before = 1;
    for (const auto& motions : {MotionOrder{1, 1}, {2, 3}, {3, 5}}) {
      const SmallRing ring = small_ring(teeth, held, motions);
      if (exact.size() == 0) {
        const FreeSystem stiffness(ring.whole.stiffness, ring.fixed), mass(ring.whole_mass(), ring.fixed);
        exact = lowest_frequencies(stiffness.matrix, mass.matrix, 7);
      }
      const double above = most_above(record, held_ring_modes(ring.flexibility, {20}), exact);
      BOOST_TEST_MESSAGE("motions of order " << motions.section << ", " << motions.axial << ": " << above << " of "
                                             << exact[0] << " Hz");
      BOOST_TEST(above < before);
      before = above;
    }
    // A rim a module high under teeth of two: parts of the section move for themselves.
    record.at_most("first seven frequencies, most above, motions of order 3", "", before, 2e-3,
                   "a thin rim: parts of the section move for themselves");
  }
}

BOOST_AUTO_TEST_CASE(rings_on_bolts_against_the_modes_of_the_whole_mesh) {
  annulus::test::Verification record("Reduced modes of a ring on bolts", "modes of the whole mesh on springs");
  constexpr int teeth = 36;
  const auto plan = small_ring_pins(teeth, {0.1, 1.3, 2.2, 3.5, 4.05, 5.4}, 2e8, 7e7, SmallPins::unilateral);
  const SmallRing ring = small_ring(teeth, SmallHeld::floating, {2, 0}, &plan);
  const Eigen::VectorXd exact =
      lowest_frequencies(ring.whole.stiffness + ring.support_stiffness(plan), ring.whole_mass(), 10);
  const RingOnSupports supports(ring.flexibility, plan);
  const auto modes = supported_ring_modes(ring.flexibility, supports, {10});
  const double above = most_above(record, modes, exact);
  BOOST_TEST_MESSAGE("first " << exact[0] << " Hz, above by " << above);
  record.at_most("first ten frequencies, most above", "", above, 1e-3, "motions of order 2 of a sector");
}

BOOST_AUTO_TEST_CASE(on_soft_bolts_the_first_modes_are_rigid_motions) {
  annulus::test::Verification record("A ring on soft bolts", "closed form: a rigid body on springs");
  constexpr int teeth = 36, pins = 9;
  const double radial = 3e4, tangential = 2e4;
  const auto plan =
      small_ring_pins(teeth, annulus::fem::equal_angles(pins, 0.1), radial, tangential, SmallPins::both_ways);
  const SmallRing ring = small_ring(teeth, SmallHeld::floating, {1, 0}, &plan);
  const RingOnSupports supports(ring.flexibility, plan);
  const auto modes = supported_ring_modes(ring.flexibility, supports, {3});
  BOOST_TEST_REQUIRE(modes.size() == 3U);

  const auto nodes = static_cast<Eigen::Index>(ring.whole.nodes.size());
  Eigen::MatrixXd coordinates(nodes, 3);
  for (Eigen::Index n = 0; n < nodes; ++n) coordinates.row(n) << 1, ring.whole.nodes[n].head<2>().transpose();
  const Eigen::Matrix3d moments = ring.width * coordinates.transpose() * (ring.whole.nodal_mass * coordinates);
  const double mass = moments(0, 0), inertia = moments(1, 1) + moments(2, 2);
  const double half_arc = 1e-3 / ring.outside, lever = ring.outside * (1 - half_arc * half_arc / 10);
  const double translation = std::sqrt(pins / 2.0 * (radial + tangential) / mass) / (2 * M_PI);
  const double rotation = std::sqrt(pins * tangential * lever * lever / inertia) / (2 * M_PI);
  const double base = ring.gear.base_radius();
  const annulus::geometry::ToothProfile profile(ring.gear);
  const double roll = profile.roll_length_at(ring.gear.reference_radius());
  const Eigen::Vector2d normal = profile.flank_normal(roll), point = profile.flank_point(roll);
  for (const auto& mode : modes) {
    const bool turns = std::abs(mode.rotation) > 1e-3;
    // Springs a thousand times softer than the ring.
    record.close(turns ? "frequency of rotation" : "frequency of translation", "Hz", mode.frequency,
                 turns ? rotation : translation, 1e-3, "springs a thousand times softer than the ring");
    BOOST_TEST(mode.waves == (turns ? 0 : 1));
    const double modal_mass = turns ? std::pow(mode.rotation * base, 2) / inertia
                                    : (std::pow(mode.translation_x, 2) + std::pow(mode.translation_y, 2)) / mass;
    record.close("modal mass", "", modal_mass, 1, 1e-5, "springs a thousand times softer than the ring");
    // Rigid motion of the real ring, whose leading flanks the planets touch: out of the material adds to the
    // deflection.
    const Eigen::Vector2d shift = Eigen::Vector2d(mode.translation_x, mode.translation_y) / mass;
    const double turn = mode.rotation * base / inertia;
    double worst = 0, scale = 0;
    for (int tooth = 0; tooth < teeth; ++tooth) {
      const Eigen::Vector2d n = Eigen::Rotation2Dd(tooth * ring.gear.pitch_angle()) * normal;
      const double deflection = n.dot(shift) + turn * (point.x() * normal.y() - point.y() * normal.x());
      worst = std::max(worst, std::abs(mode.deflection[tooth] - deflection));
      scale = std::max(scale, std::abs(deflection));
    }
    BOOST_TEST(worst < 5e-3 * scale);  // deformation, and the fanned-out mesh force
  }
}

BOOST_AUTO_TEST_CASE(all_modes_together_give_the_static_compliance_and_the_mass) {
  annulus::test::Verification record("All modes of a ring together", "static compliance of the mesh; its mass");
  for (const auto held : {SmallHeld::outside, SmallHeld::sleeve}) {
    const int teeth = held == SmallHeld::outside ? 36 : 29;
    const SmallRing ring = small_ring(teeth, held, {2, 2});
    const auto modes = held_ring_modes(ring.flexibility, {all_modes});
    BOOST_TEST(modes.size() == static_cast<std::size_t>(teeth * ring.flexibility.motions));
    const auto compliance = [&](int d) { return ring.flexibility.compliance.block(d)(0, 0); };
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(teeth);
    double x = 0, y = 0, rotation = 0;
    for (const auto& mode : modes) {
      const double flexibility = std::pow(2 * M_PI * mode.frequency, -2);
      const double before = sum[0];
      // The mirrored teeth of the solve count backwards: tooth 0 moves under a force on tooth d.
      for (int d = 0; d < teeth; ++d) sum[d] += flexibility * mode.deflection[0] * mode.deflection[d];
      BOOST_TEST(sum[0] >= before);
      x += mode.translation_x * mode.translation_x;
      y += mode.translation_y * mode.translation_y;
      rotation += std::pow(mode.rotation * ring.gear.base_radius(), 2);
    }
    // From below: what deforms a single tooth is not held in the modes.
    BOOST_TEST_MESSAGE("own compliance by modes " << sum[0] / compliance(0) << ", next tooth " << sum[1] / compliance(1)
                                                  << ", third " << sum[3] / compliance(3));
    BOOST_TEST(sum[0] < compliance(0));
    BOOST_TEST(sum[0] > 0.2 * compliance(0));
    for (const int d : {2, 3, 5})
      record.at_most("compliance between two teeth, error over that of neighbours", "",
                     std::abs(sum[d] - compliance(d)) / std::abs(compliance(1)), 0.05,
                     "what deforms a single tooth is not held in the modes");
    // All mass moves with the modes but what hangs on the held nodes.
    Eigen::Vector3d all = Eigen::Vector3d::Zero();
    for (int s = 0; s < teeth; ++s)
      all += ring.flexibility.resultants_of(s, 1, ring.flexibility.motions).rowwise().squaredNorm();
    record.close("mass that moves in x with all modes, per width", "kg/m", x, all.x(), round_off,
                 "rounding x condition number");
    record.close("mass that moves in y with all modes, per width", "kg/m", y, all.y(), round_off,
                 "rounding x condition number");
    record.close("moment of inertia of all modes, per width", "kg m", rotation, all.z(), round_off,
                 "rounding x condition number");
    const double total = ring.whole.nodal_mass.sum() / ring.per_width();
    BOOST_TEST(all.x() < total);
    BOOST_TEST(all.x() > 0.8 * total);
  }
}

BOOST_AUTO_TEST_CASE(limits_keep_the_lowest_modes_and_whole_pairs) {
  annulus::test::Verification record("Some of the modes of a held ring",
                                     "all of its modes: the lowest are retained, and pairs as a whole");
  const SmallRing ring = small_ring(30, SmallHeld::outside, {1, 0});
  const auto all = held_ring_modes(ring.flexibility, {all_modes});
  for (std::size_t k = 1; k < all.size(); ++k)
    record.at_least("frequency over the one before", "", all[k].frequency / all[k - 1].frequency, 1, "rising order");
  for (const int count : {1, 2, 3, 4, 5}) {
    const auto some = held_ring_modes(ring.flexibility, {count});
    const double beyond = static_cast<double>(some.size()) - count;
    record.at_least("modes beyond the wanted number", "", beyond, 0, "as many as wanted");
    record.at_most("modes beyond the wanted number", "", beyond, 1, "one more where a pair would be parted");
    record.at_least("first frequency left out over the last one retained", "",
                    all[some.size()].frequency / some.back().frequency, 1, "a pair is not parted");
    BOOST_TEST(some.back().frequency < all[some.size()].frequency);
    int different = 0;
    for (std::size_t k = 0; k < some.size(); ++k) different += some[k].deflection != all[k].deflection;
    record.at_most("retained modes that differ", "", different, 0, "equal to the last bit");
  }
  const auto low = held_ring_modes(ring.flexibility, {all_modes, all[6].frequency});
  record.at_most("last frequency retained over the highest wanted", "", low.back().frequency / all[6].frequency, 1,
                 "the limit");
  record.at_least("first frequency left out over the highest wanted", "", all[low.size()].frequency / all[6].frequency,
                  1, "the limit");
  BOOST_TEST(all[low.size()].frequency > all[6].frequency);
}

BOOST_AUTO_TEST_CASE(the_rings_of_the_paper) {
  annulus::test::Verification record("Stated errors of the frequencies of the rings of the paper",
                                     "finer elements and motions of a higher order");
  // Finer elements and motions of a higher order together stay within the estimated error.
  annulus::fem::RingCouplingSettings settings;
  settings.modes.count = 12;
  for (const annulus::fem::RingStructure& structure :
       {annulus::fem::RingStructure(annulus::fem::OutsideHeld{}), annulus::fem::RingStructure(paper_pins(24, 0))}) {
    const auto problem = ring_mesh(structure, 2);
    const bool pinned = annulus::fem::on_single_supports(structure);
    settings.level = 1;
    settings.motions = {2, 0};
    const auto coarse = solve_ring_coupling(problem, equal_places(5), nominal_load, settings);
    settings.level = 2;
    settings.motions = {pinned ? 2 : 4, 0};
    const auto fine = solve_ring_coupling(problem, equal_places(5), nominal_load, settings);
    // Both are in plane strain, which is another matter.
    const double stated = coarse.frequency_error_relative - annulus::fem::plane_strain_bounds(problem).frequency;
    double worst = 0;
    for (std::size_t k = 0; k < 12; ++k)
      worst = std::max(worst, std::abs(coarse.coupling.modes[k].frequency / fine.coupling.modes[k].frequency - 1));
    BOOST_TEST_MESSAGE("first " << fine.coupling.modes[0].frequency << " Hz, error " << worst << ", estimated "
                                << stated);
    record.at_most(
        pinned ? "24 pins: largest error of twelve frequencies" : "held: largest error of twelve frequencies", "",
        worst, stated, "stated error");
    BOOST_TEST(stated < 0.01);
  }
}

BOOST_AUTO_TEST_SUITE_END()
