#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/errors.h"
#include "discretised_body.h"
#include "fem/body/gear_body.h"
#include "fem/contact/support_row.h"
#include "fem/recovery/stress_recovery.h"
#include "geometry/sector_mesh.h"
#include "tests/verification_record.h"

/// The condensed ring against a monolithic solve of the same mesh, node by node.
BOOST_AUTO_TEST_SUITE(condensation)

using annulus::fem::GearBody;
using annulus::fem::GearBodyOptions;
using annulus::fem::HeldBoundary;
using annulus::fem::Material;
using annulus::fem::SectorModel;
using annulus::fem::SupportDirection;
using annulus::fem::SupportPlan;
using annulus::fem::SupportRow;
using annulus::fem::SupportSites;
using annulus::geometry::Boundary;
using annulus::geometry::Gear;
using annulus::geometry::GearKind;
using annulus::geometry::Mesh;
using annulus::geometry::ToothProfile;
using annulus::tests::DiscretisedBody;
using annulus::tests::FreeSystem;

struct Case {
  Gear gear;
  double support_radius;
  Mesh sector;
  GearBodyOptions options;
};

Case plane_case(GearKind kind, int teeth) {
  annulus::geometry::GearParameters p;
  p.kind = kind;
  p.teeth = teeth;
  p.module = 2e-3;
  p.pressure_angle = 20 * M_PI / 180;
  p.profile_shift = 0.2;
  p.face_width = 0.01;
  const Gear gear(p);
  Case c{gear, gear.root_radius() + (kind == GearKind::external ? -3e-3 : 4e-3), {}, {}};
  annulus::geometry::SectorResolution coarse;
  coarse.flank_cells = 3;
  coarse.fillet_cells = 2;
  coarse.thickness_cells = 4;
  coarse.root_cells = 1;
  coarse.rim_cells = 2;
  c.sector = annulus::geometry::make_sector_mesh(gear, {c.support_radius, {}}, coarse);
  c.options.extent.max_offset = teeth;
  if (kind == GearKind::internal) c.options.sector.flank = Boundary::trailing_flank;
  return c;
}

GearBody condensed(const Case& c) {
  return compose_body(condense_tooth(c.sector, ToothProfile(c.gear), c.support_radius, Material{}, c.options),
                      c.options);
}

DiscretisedBody monolithic(const Case& c) {
  const ToothProfile profile(c.gear);
  const double pitch = c.gear.pitch_angle(), support = c.support_radius;
  // The projection of sector 0, turned to where the point is.
  const auto project = [profile, pitch, support](Boundary boundary, const Eigen::Vector2d& point) -> Eigen::Vector2d {
    const Eigen::Rotation2Dd turn(pitch * std::round(std::atan2(point.y(), point.x()) / pitch));
    return turn * profile.project(boundary, turn.inverse() * point, support);
  };
  const int teeth = c.gear.teeth();
  return annulus::tests::discretise_body(repeat(c.sector, teeth, teeth), project, Material{}, c.options.sector.degree);
}

int nearest_node(const DiscretisedBody& ring, const Eigen::Vector3d& point) {
  int best = 0;
  for (std::size_t n = 1; n < ring.nodes.size(); ++n)
    if ((ring.nodes[n] - point).squaredNorm() < (ring.nodes[best] - point).squaredNorm()) best = static_cast<int>(n);
  BOOST_TEST_REQUIRE((ring.nodes[best] - point).norm() < 1e-12);  // round-off of two ways to turn 0.1 m
  return best;
}

/// Unit load of a port of a sector as a load vector of the whole ring.
Eigen::VectorXd unit_load(const DiscretisedBody& ring, const GearBody& body, int port, int sector) {
  const Eigen::AngleAxisd turn(sector * body.pitch_angle, Eigen::Vector3d::UnitZ());
  const int node = nearest_node(ring, turn * body.port_points[port]);
  const Eigen::Vector3d direction = turn * body.ports[port].direction;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(ring.stiffness.rows());
  for (int d = 0; d < ring.dimension; ++d) load[ring.dof[node * ring.dimension + d]] = direction[d];
  return load;
}

/// Largest difference of the compliances between some ports of some teeth, relative to the largest compliance.
double worst_difference(const Case& c, const std::vector<Boundary>& held) {
  const GearBody body = condensed(c);
  const DiscretisedBody ring = monolithic(c);
  std::vector<bool> fixed(ring.stiffness.rows(), false);
  for (const auto boundary : held) {
    const auto held_nodes = ring.boundary_nodes(boundary);
    BOOST_TEST_REQUIRE(!held_nodes.empty());
    for (const int n : held_nodes)
      for (int d = 0; d < ring.dimension; ++d) fixed[ring.dof[n * ring.dimension + d]] = true;
  }
  const FreeSystem system(ring.stiffness, fixed);

  const int teeth = c.gear.teeth(), last = static_cast<int>(body.ports.size()) - 1;
  std::vector<std::pair<int, int>> points;  // port, sector
  for (const int sector : {0, 1, 2, teeth / 2, teeth / 2 + 1, teeth - 1})
    for (const int port : {0, last / 3, last}) points.emplace_back(port, sector);
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd loads(ring.stiffness.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) loads.col(i) = unit_load(ring, body, points[i].first, points[i].second);
  const Eigen::MatrixXd free_loads = system.restrict_rows(loads);
  const Eigen::MatrixXd exact =
      free_loads.transpose() * annulus::tests::SparseCholesky(system.matrix).solve(free_loads);
  double worst = 0, smallest = exact.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto [port_i, sector_i] = points[i];
      const auto [port_j, sector_j] = points[j];
      const double value = body.compliance.block(sector_i - sector_j)(port_i, port_j);
      worst = std::max(worst, std::abs(value - exact(i, j)) / exact.cwiseAbs().maxCoeff());
      smallest = std::min(smallest, std::abs(exact(i, j)));
    }
  BOOST_TEST_MESSAGE(teeth << " teeth, " << ring.dimension << "D, " << ring.stiffness.rows() << " degrees of freedom: "
                           << worst << ", smallest compliance " << smallest / exact.cwiseAbs().maxCoeff());
  return worst;
}

// Both ways are exact; what differs is round-off: 2e-16 times a condition number of some 1e6.
constexpr double round_off = 1e-9;
const char* const whole_matrix = "one matrix of all sectors, solved directly (CHOLMOD)";

void check_monolithic(annulus::test::Verification& record, const char* what, double worst) {
  record.at_most(std::string("compliance between teeth, largest difference over the largest: ") + what, "", worst,
                 round_off, "rounding x condition number of some 1e6");
}

BOOST_AUTO_TEST_CASE(plane_gears_held_at_the_bore) {
  annulus::test::Verification record("Plane gears composed of condensed sectors", whole_matrix);
  for (const int teeth : {18, 19})
    check_monolithic(record, teeth == 18 ? "18 teeth" : "19 teeth",
                     worst_difference(plane_case(GearKind::external, teeth), {Boundary::support}));
}

BOOST_AUTO_TEST_CASE(plane_ring_held_outside) {
  annulus::test::Verification record("A plane ring composed of condensed sectors", whole_matrix);
  check_monolithic(record, "41 teeth", worst_difference(plane_case(GearKind::internal, 41), {Boundary::support}));
}

BOOST_AUTO_TEST_CASE(other_degrees_and_refinements_of_the_elements) {
  annulus::test::Verification record("Elements of degree 1 and 3", whole_matrix);
  for (const int degree : {1, 3}) {
    auto c = plane_case(GearKind::external, 19);
    c.options.sector.degree = degree;
    check_monolithic(record, degree == 1 ? "degree 1" : "degree 3", worst_difference(c, {Boundary::support}));
  }
}

BOOST_AUTO_TEST_CASE(solid_gear_held_at_the_bore) {
  annulus::test::Verification record("A solid gear composed of condensed sectors", whole_matrix);
  auto c = plane_case(GearKind::external, 17);
  c.sector = extrude(c.sector, {{0, 0.01, 2}});
  check_monolithic(record, "17 teeth", worst_difference(c, {Boundary::support}));
}

BOOST_AUTO_TEST_CASE(thin_walled_ring_held_at_the_end_of_its_sleeve) {
  annulus::test::Verification record("A thin-walled ring on its sleeve composed of condensed sectors", whole_matrix);
  auto c = plane_case(GearKind::internal, 29);
  const double sleeve_radius = c.gear.root_radius() + 2e-3;
  annulus::geometry::SectorResolution coarse;
  coarse.flank_cells = 2;
  coarse.fillet_cells = 2;
  coarse.thickness_cells = 2;
  coarse.root_cells = 1;
  coarse.rim_cells = 2;
  c.sector = annulus::geometry::make_sector_mesh(c.gear, {c.support_radius, {sleeve_radius}}, coarse);
  annulus::geometry::Layers sleeve{-0.006, 0, 2};
  sleeve.region = Mesh::Region::sleeve;
  sleeve.toothed = false;
  sleeve.radius_low = sleeve_radius;
  c.sector = extrude(c.sector, {sleeve, {0, 0.01, 2}});
  c.options.sector.held = HeldBoundary::end_low;
  check_monolithic(record, "29 teeth", worst_difference(c, {Boundary::end_low}));
}

BOOST_AUTO_TEST_CASE(solid_ring_clamped_at_both_end_faces) {
  annulus::test::Verification record("A ring clamped at the rims of both end faces composed of condensed sectors",
                                     whole_matrix);
  auto c = plane_case(GearKind::internal, 29);
  const double inner = c.gear.root_radius() + 2e-3;
  annulus::geometry::SectorResolution coarse;
  coarse.flank_cells = 2;
  coarse.fillet_cells = 2;
  coarse.thickness_cells = 2;
  coarse.root_cells = 1;
  coarse.rim_cells = 2;
  c.sector = annulus::geometry::make_sector_mesh(c.gear, {c.support_radius, {inner}}, coarse);
  annulus::geometry::ExtrudeOptions options;
  options.end_low_radius = options.end_high_radius = inner;
  c.sector = extrude(c.sector, {{0, 0.01, 3}}, options);
  c.options.sector.held = HeldBoundary::both_ends;
  check_monolithic(record, "29 teeth", worst_difference(c, {Boundary::end_low, Boundary::end_high}));
}

/// Rigid supports over an arc, at angles without symmetry that straddle the borders of sectors as well.
SupportPlan uneven_supports(const Case& c, std::vector<double> slice_edges) {
  SupportSites sites;
  SupportDirection radial, inclined;
  radial.stiffness = inclined.stiffness = std::numeric_limits<double>::infinity();
  inclined.inward = 0.6;
  inclined.counter_clockwise = 0.8;
  const double pitch = c.gear.pitch_angle();
  for (const double teeth : {0.0, 0.5, 3.2, 7.45, 11.9, 20.0})
    sites.sites.push_back({teeth * pitch, 0.4 * pitch, teeth != 3.2, {radial, inclined}});
  return {sites, c.gear.teeth(), std::move(slice_edges)};
}

/// A support force as a load vector of the whole ring.
Eigen::VectorXd support_load(const DiscretisedBody& ring, const SectorModel& sector, const SupportPlan& plan,
                             int force) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(ring.stiffness.rows());
  for (const auto& [number, arc] : plan.forces()[force].pieces) {
    const Eigen::AngleAxisd turn(number * sector.pitch_angle, Eigen::Vector3d::UnitZ());
    for (const auto& f : on_outside(plan.arcs()[arc], sector.outside)) {
      const int node = nearest_node(ring, turn * sector.nodes[f.node]);
      const Eigen::Vector3d turned = turn * f.force;
      for (int d = 0; d < ring.dimension; ++d) load[ring.dof[node * ring.dimension + d]] += turned[d];
    }
  }
  return load;
}

/// Energies of self-equilibrated port loads and support forces on a ring that nothing holds.
void check_floating(annulus::test::Verification& record, Case c,
                    const std::vector<std::pair<Eigen::Vector3d, int>>& pinned, std::vector<double> slice_edges) {
  c.options.sector.held = HeldBoundary::none;
  c.options.sector.outputs = {annulus::fem::SectorOutput::outside};
  c.options.extent.whole_ring = true;
  SupportPlan plan = uneven_supports(c, std::move(slice_edges));
  c.options.arcs = plan.arcs();
  const GearBody body = condensed(c);
  const SupportRow supports(plan, body);
  const auto sector_model =
      make_sector_model(c.sector, ToothProfile(c.gear), c.support_radius, Material{}, c.options.sector);
  const DiscretisedBody ring = monolithic(c);
  const int dim = ring.dimension, rigid_motions = dim == 2 ? 3 : 6;
  std::vector<bool> fixed(ring.stiffness.rows(), false);
  for (const auto& [point, component] : pinned) fixed[ring.dof[nearest_node(ring, point) * dim + component]] = true;
  BOOST_TEST_REQUIRE(std::count(fixed.begin(), fixed.end(), true) == rigid_motions);
  const FreeSystem system(ring.stiffness, fixed);

  std::vector<std::pair<int, int>> points;  // port, sector
  const int ports = static_cast<int>(body.ports.size());
  for (const int sector : {0, 1, c.gear.teeth() / 3, c.gear.teeth() / 2 + 1})
    for (int port = 0; port < ports; port += std::max(1, ports / 6)) points.emplace_back(port, sector);
  const auto at_ports = static_cast<Eigen::Index>(points.size()), at_supports = Eigen::Index{supports.size()};
  const auto n = at_ports + at_supports;
  Eigen::MatrixXd unit(ring.stiffness.rows(), n), compliance(n, n);
  for (Eigen::Index i = 0; i < at_ports; ++i) {
    const auto [port, sector] = points[i];
    unit.col(i) = unit_load(ring, body, port, sector);
    for (Eigen::Index j = 0; j < at_ports; ++j)
      compliance(i, j) = body.compliance.block(sector - points[j].second)(port, points[j].first);
    Eigen::MatrixXd weight = Eigen::MatrixXd::Zero(ports, 1);
    weight(port, 0) = 1;
    // The row divides by the width of a plane ring.
    compliance.row(i).tail(at_supports) =
        supports.at_ports(sector, weight) * (dim == 2 ? supports.plan().slice_edges().back() : 1);
  }
  compliance.bottomRightCorner(at_supports, at_supports) =
      supports.compliance() * (dim == 2 ? supports.plan().slice_edges().back() : 1);
  compliance.bottomLeftCorner(at_supports, at_ports) = compliance.topRightCorner(at_ports, at_supports).transpose();
  for (int i = 0; i < supports.size(); ++i) unit.col(at_ports + i) = support_load(ring, sector_model, plan, i);

  // Resultants from the load vectors of the whole ring, and as the program gives them.
  Eigen::MatrixXd resultants = Eigen::MatrixXd::Zero(n, rigid_motions);
  for (std::size_t node = 0; node < ring.nodes.size(); ++node)
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::Vector3d force = Eigen::Vector3d::Zero();
      for (int d = 0; d < dim; ++d) force[d] = unit(ring.dof[node * dim + d], i);
      const Eigen::Vector3d moment = ring.nodes[node].cross(force);
      if (dim == 2)
        resultants.row(i) += Eigen::RowVector3d(force.x(), force.y(), moment.z());
      else
        resultants.row(i) << resultants.row(i).head<3>() + force.transpose(),
            resultants.row(i).tail<3>() + moment.transpose();
    }
  const int moment_z = rigid_motions - 1;
  for (Eigen::Index i = 0; i < at_ports; ++i) {
    const Eigen::RowVector3d plane(resultants(i, 0), resultants(i, 1), resultants(i, moment_z));
    // Round-off of numbers up to one.
    BOOST_TEST((body.rigid_motion(points[i].first, points[i].second) - plane).norm() < 1e-14);
  }
  for (Eigen::Index i = at_ports; i < n; ++i) {
    Eigen::RowVectorXd expected(supports.rigid_motions());
    expected.head(3) << resultants(i, 0), resultants(i, 1), resultants(i, moment_z);
    if (dim == 3) expected.tail(2) << resultants(i, 3), resultants(i, 4);
    BOOST_TEST((supports.resultants().row(i - at_ports) - expected).norm() < 1e-13);
  }

  std::mt19937 random(11);
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::VectorXd f = Eigen::VectorXd::NullaryExpr(n, [&] { return 2.0 * random() / std::mt19937::max() - 1; });
    f -= resultants *
         (resultants.transpose() * resultants).completeOrthogonalDecomposition().solve(resultants.transpose() * f);
    BOOST_TEST_REQUIRE((resultants.transpose() * f).norm() < 1e-13 * n);
    const double energy = f.dot(compliance * f);
    const Eigen::MatrixXd load = system.restrict_rows(unit * f);
    const double exact = load.col(0).dot(annulus::tests::SparseCholesky(system.matrix).solve(load).col(0));
    BOOST_TEST_MESSAGE(dim << "D floating: energy differs by " << energy / exact - 1);
    record.close("strain energy of balanced loads at teeth and supports", "J", energy, exact, round_off,
                 "rounding x condition number of some 1e6");
  }
}

BOOST_AUTO_TEST_CASE(a_floating_ring_stores_the_right_energy_under_balanced_loads) {
  annulus::test::Verification record("A floating plane ring", whole_matrix);
  for (const int teeth : {40, 41}) {
    const auto c = plane_case(GearKind::internal, teeth);
    const double pitch = c.gear.pitch_angle(), r = c.support_radius;
    // The outside at the cuts of sectors 0 and 10: x, y of one, and what is across of the other.
    const Eigen::Vector3d a(r * std::cos(pitch / 2), r * std::sin(pitch / 2), 0);
    const Eigen::Vector3d b(r * std::cos(10.5 * pitch), r * std::sin(10.5 * pitch), 0);
    check_floating(record, c, {{a, 0}, {a, 1}, {b, 0}}, {0, 0.01});
  }
}

BOOST_AUTO_TEST_CASE(a_floating_solid_ring_as_well) {
  annulus::test::Verification record("A floating solid ring", whole_matrix);
  auto c = plane_case(GearKind::internal, 28);
  c.sector = extrude(c.sector, {{0, 0.01, 1}});
  const double pitch = c.gear.pitch_angle(), r = c.support_radius;
  const auto at = [&](double sector, double z) {
    return Eigen::Vector3d(r * std::cos((sector + 0.5) * pitch), r * std::sin((sector + 0.5) * pitch), z);
  };
  check_floating(record, c,
                 {{at(0, 0), 0}, {at(0, 0), 1}, {at(0, 0), 2}, {at(14, 0), 1}, {at(14, 0), 2}, {at(7, 0), 2}},
                 {0, 0.004, 0.01});
}

/// Stresses found by reciprocity against the same functionals applied to the monolithic displacement.
void check_stress(annulus::test::Verification& record, Case c, Boundary held) {
  c.options.sector.outputs = {annulus::fem::SectorOutput::stress};
  c.options.extent.whole_ring = c.sector.dimension == 2;
  c.options.extent.max_offset = 5;
  const GearBody body = condensed(c);
  const bool solid = c.sector.dimension == 3;
  const double width = solid ? 1 : 0.01;
  const annulus::fem::StressRecovery recovery(body, width, Material{}.poisson_ratio, nullptr);
  const auto model = make_sector_model(c.sector, ToothProfile(c.gear), c.support_radius, Material{}, c.options.sector);
  const DiscretisedBody ring = monolithic(c);
  std::vector<bool> fixed(ring.stiffness.rows(), false);
  for (const int n : ring.boundary_nodes(held))
    for (int d = 0; d < ring.dimension; ++d) fixed[ring.dof[n * ring.dimension + d]] = true;
  const FreeSystem system(ring.stiffness, fixed);

  std::mt19937 random(5);
  std::vector<annulus::fem::ToothForces> teeth;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(ring.stiffness.rows());
  for (const int tooth : {-1, 0, 1}) {
    teeth.push_back({tooth, Eigen::VectorXd::NullaryExpr(body.flank_ports(), [&] { return 1e-6 * random(); })});
    for (int port = 0; port < body.flank_ports(); ++port)
      load += teeth.back().ports[port] / width * unit_load(ring, body, port, tooth);
  }
  const Eigen::VectorXd u =
      system.extend_rows(annulus::tests::SparseCholesky(system.matrix).solve(system.restrict_rows(load)));
  const auto observe = [&](const annulus::fem::NodalLoad& functional, int sector) {
    const Eigen::AngleAxisd turn(sector * body.pitch_angle, Eigen::Vector3d::UnitZ());
    double sum = 0;
    for (const auto& f : functional) {
      const int node = nearest_node(ring, turn * model.nodes[f.node]);
      const Eigen::Vector3d turned = turn * f.force;
      for (int d = 0; d < ring.dimension; ++d) sum += turned[d] * u[ring.dof[node * ring.dimension + d]];
    }
    return sum;
  };
  // All fillets but at the cuts, where two sectors are averaged.
  double tension = 0, compression = 0;
  for (int sector = -3; sector <= 3; ++sector)
    for (const auto* side : {&model.root_low, &model.root_high}) {
      const auto axial = side->trace.axial.size(), points = side->trace.profile.size();
      for (std::size_t u_index = side == &model.root_low ? 1 : 0; u_index + (side == &model.root_low ? 0 : 1) < points;
           ++u_index)
        for (std::size_t z = 0; z < axial; ++z) {
          const double s = observe(side->stress[u_index * axial + z].tangential, sector);
          tension = std::max(tension, s);
          compression = std::min(compression, s);
        }
    }
  const auto result = recovery.stresses(teeth, {});
  BOOST_TEST_MESSAGE(ring.dimension << "D stresses " << tension << " and " << compression
                                    << " Pa, recovered / exact - 1: " << result.largest.root_tension / tension - 1
                                    << ", " << result.largest.root_compression / compression - 1);
  const std::string name = solid ? ", solid gear" : ", plane ring";
  record.close("largest tension in the roots" + name, "Pa", result.largest.root_tension, tension, round_off,
               "rounding x condition number of some 1e6");
  record.close("largest compression in the roots" + name, "Pa", result.largest.root_compression, compression, round_off,
               "rounding x condition number of some 1e6");
}

BOOST_AUTO_TEST_CASE(stresses_by_reciprocity_are_those_of_the_whole_body) {
  annulus::test::Verification record("Root stresses by reciprocity", whole_matrix);
  check_stress(record, plane_case(GearKind::internal, 41), Boundary::support);
  auto solid = plane_case(GearKind::external, 17);
  solid.sector = extrude(solid.sector, {{0, 0.01, 2}});
  check_stress(record, solid, Boundary::support);
}

BOOST_AUTO_TEST_CASE(nodes_of_a_solid_flank_lie_on_the_exact_involute_at_every_height) {
  annulus::test::Verification record("Nodes of a solid flank", "the exact involute at every height");
  for (const int degree : {1, 2, 3}) {
    auto c = plane_case(GearKind::internal, 29);
    c.sector = extrude(c.sector, {{0, 0.01, 2}});
    c.options.sector.degree = degree;
    const ToothProfile profile(c.gear);
    const auto model = make_sector_model(c.sector, profile, c.support_radius, Material{}, c.options.sector);
    BOOST_TEST_REQUIRE(model.flank.axial.size() == 2U * degree + 1);
    double off_station = 0, off_flank = 0;
    for (std::size_t i = 0; i < model.flank.nodes.size(); ++i) {
      const Eigen::Vector3d& p = model.nodes[model.flank.nodes[i]];
      const double roll = model.flank.profile[i / model.flank.axial.size()];
      off_station = std::max(off_station, std::abs(profile.roll_length_at(p.head<2>().norm()) - roll));
      const Eigen::Vector2d exact = profile.flank_point(roll);  // of the leading flank
      off_flank = std::max(off_flank, (Eigen::Vector2d(p.x(), -p.y()) - exact).norm());
    }
    record.at_most("roll length, largest error", "m", off_station, 1e-12, "rounding; square root near the base circle");
    record.at_most("distance from the involute", "m", off_flank, 1e-12, "rounding");
  }
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_nothing) {
  annulus::test::Verification record("A gear condensed on several threads", "the same on one thread");
  auto c = plane_case(GearKind::external, 19);
  const GearBody one = condensed(c);
  for (const int threads : {2, 5, 16}) {
    c.options.threads = threads;
    const GearBody many = condensed(c);
    for (int d = 0; d <= one.compliance.max_offset(); ++d)
      record.at_most("compliance, largest difference over the largest entry", "",
                     (one.compliance.block(d) - many.compliance.block(d)).cwiseAbs().maxCoeff() /
                         one.compliance.block(0).cwiseAbs().maxCoeff(),
                     0, "equal to the last bit");
  }
}

BOOST_AUTO_TEST_CASE(blocks_of_both_directions_are_each_others_transpose) {
  annulus::test::Verification record("Reciprocity of a condensed gear",
                                     "Maxwell and Betti: the compliance is symmetric");
  const GearBody body = condensed(plane_case(GearKind::external, 18));
  BOOST_TEST(body.compliance.max_offset() == 9);
  BOOST_TEST((body.compliance.block(-4).array() == body.compliance.block(4).transpose().array()).all());
  BOOST_TEST((body.compliance.block(14).array() == body.compliance.block(-4).array()).all());
  // Reciprocity within a tooth and across the ring, formed by different sums: round-off.
  const Eigen::MatrixXd own = body.compliance.block(0), far = body.compliance.block(9);
  record.at_most("asymmetry within a tooth, relative", "", (own - own.transpose()).norm() / own.norm(), 1e-14,
                 "rounding");
  record.at_most("asymmetry across the gear, relative", "", (far - far.transpose()).norm() / own.norm(), 1e-12,
                 "rounding");
  auto c = plane_case(GearKind::external, 18);
  c.options.extent.max_offset = 2;
  BOOST_CHECK_THROW((void)condensed(c).compliance.block(3), annulus::InternalError);
}

BOOST_AUTO_TEST_SUITE_END()
