#include "small_ring.h"
#include "discretised_body.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "fem/problem/structures/pin_held.h"
#include "geometry/sector_mesh.h"

namespace annulus::tests {

using geometry::Boundary;

namespace {

constexpr double rim = 4e-3, width = 0.01;

geometry::Gear small_gear(int teeth) {
  geometry::GearParameters p;
  p.kind = geometry::GearKind::internal;
  p.teeth = teeth;
  p.module = 2e-3;
  p.pressure_angle = 20 * M_PI / 180;
  p.profile_shift = 0.2;
  p.face_width = width;
  return geometry::Gear(p);
}

/// Finds nodes by their place.
class NodeFinder {
 public:
  explicit NodeFinder(const std::vector<Eigen::Vector3d>& nodes) : nodes_(nodes) {
    for (std::size_t n = 0; n < nodes.size(); ++n) by_x_.emplace_back(nodes[n].x(), static_cast<int>(n));
    std::sort(by_x_.begin(), by_x_.end());
  }
  [[nodiscard]] int at(const Eigen::Vector3d& point) const {
    constexpr double same = 1e-12;  // m, round-off of two ways to turn 0.1 m
    for (auto i = std::lower_bound(by_x_.begin(), by_x_.end(), std::pair(point.x() - same, 0));
         i != by_x_.end() && i->first < point.x() + same; ++i)
      if ((nodes_[i->second] - point).norm() < same) return i->second;
    BOOST_FAIL("a node of the sector is not in the ring");
    return -1;
  }

 private:
  const std::vector<Eigen::Vector3d>& nodes_;
  std::vector<std::pair<double, int>> by_x_;
};

}  // namespace

Eigen::VectorXd SmallRing::whole_load(int number, int load) const {
  const Eigen::AngleAxisd turn(number * sector.pitch_angle, Eigen::Vector3d::UnitZ());
  Eigen::VectorXd result = Eigen::VectorXd::Zero(whole.stiffness.rows());
  const int dim = whole.dimension;
  for (const auto& f : loads.acting[load]) {
    const Eigen::Vector3d turned = turn * f.force;
    for (int c = 0; c < dim; ++c) result[whole.dof[node_of[number][f.node] * dim + c]] += turned[c] * per_width();
  }
  return result;
}

Eigen::VectorXd SmallRing::support_load(const fem::SupportPlan& plan, int force) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(whole.stiffness.rows());
  for (const auto& [number, arc] : plan.forces()[force].pieces)
    result += whole_load(number, flexibility.first_arc() + arc);
  return result;
}

Eigen::SparseMatrix<double> SmallRing::support_stiffness(const fem::SupportPlan& plan) const {
  Eigen::SparseMatrix<double> result(whole.stiffness.rows(), whole.stiffness.rows());
  for (int i = 0; i < static_cast<int>(plan.forces().size()); ++i) {
    const Eigen::SparseMatrix<double> load = Eigen::VectorXd(support_load(plan, i) / per_width()).sparseView();
    const double stiffness = plan.direction(plan.forces()[i]).total_stiffness();
    result += Eigen::SparseMatrix<double>(stiffness * per_width() * load * load.transpose());
  }
  return result;
}

Eigen::SparseMatrix<double> SmallRing::whole_mass() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < whole.nodal_mass.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(whole.nodal_mass, column); it; ++it)
      for (int c = 0; c < whole.dimension; ++c)
        entries.emplace_back(whole.dof[it.row() * whole.dimension + c],
                             whole.dof[static_cast<Eigen::Index>(column) * whole.dimension + c], it.value());
  Eigen::SparseMatrix<double> mass(whole.stiffness.rows(), whole.stiffness.rows());
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

fem::SupportPlan small_ring_pins(int teeth, std::vector<double> angles, double radial, double tangential,
                                 SmallPins kind, double clearance) {
  fem::PinHeld pins;
  pins.angles = std::move(angles);
  pins.pin_diameter = 2e-3;
  pins.clearance = clearance;
  pins.radial_stiffness = radial;
  pins.tangential_stiffness = tangential;
  pins.unilateral = kind == SmallPins::unilateral;
  const double outside = small_gear(teeth).root_radius() + rim;
  return {pins.supports({teeth, outside, width, {}}), teeth, {0, width}};
}

SmallRing small_ring(int teeth, SmallHeld held, const fem::MotionOrder& motions, const fem::SupportPlan* plan) {
  SmallRing ring{small_gear(teeth), 0, width, {}, {}, {}, {}, {}, {}};
  const geometry::ToothProfile profile(ring.gear);
  ring.outside = ring.gear.root_radius() + rim;
  const bool solid = held == SmallHeld::sleeve;
  geometry::SectorResolution coarse;
  coarse.flank_cells = 2;
  coarse.fillet_cells = 2;
  coarse.thickness_cells = 2;
  coarse.root_cells = 1;
  coarse.rim_cells = 2;
  const double sleeve_radius = ring.gear.root_radius() + 2e-3;
  geometry::Rim section{ring.outside, {}};
  if (solid) section.circles = {sleeve_radius};
  geometry::Mesh mesh = geometry::make_sector_mesh(ring.gear, section, coarse);
  if (solid) {
    geometry::Layers sleeve{-0.006, 0, 2};
    sleeve.region = geometry::Mesh::Region::sleeve;
    sleeve.toothed = false;
    sleeve.radius_low = sleeve_radius;
    mesh = geometry::extrude(mesh, {sleeve, {0, width, 2}});
  }
  fem::SectorModelOptions options;
  options.held = held == SmallHeld::outside ? fem::HeldBoundary::support
                 : solid                    ? fem::HeldBoundary::end_low
                                            : fem::HeldBoundary::none;
  options.flank = Boundary::trailing_flank;
  options.outputs = {fem::SectorOutput::mass};
  if (plan != nullptr) options.outputs.insert(fem::SectorOutput::outside);
  ring.sector = make_sector_model(mesh, profile, ring.outside, {}, options);
  fem::RingFlexibilityOptions wanted;
  wanted.roll = profile.roll_length_at(ring.gear.reference_radius());
  wanted.face_width = width;
  wanted.solid = solid;
  wanted.motions = motions;
  if (plan != nullptr) wanted.arcs = plan->arcs();
  ring.loads = fem::ring_loads(ring.sector, profile, options.flank, wanted);
  ring.flexibility = fem::compose_flexibility(ring.sector, ring.loads, ring.gear, support_of(options.held), wanted);

  const double pitch = ring.gear.pitch_angle(), support = ring.outside;
  const auto project = [profile, pitch, support](Boundary boundary, const Eigen::Vector2d& point) -> Eigen::Vector2d {
    const Eigen::Rotation2Dd turn(pitch * std::round(std::atan2(point.y(), point.x()) / pitch));
    return turn * profile.project(boundary, turn.inverse() * point, support);
  };
  ring.whole = discretise_body(repeat(mesh, teeth, teeth), project, {}, options.degree);
  ring.fixed.assign(ring.whole.stiffness.rows(), false);
  if (held != SmallHeld::floating)
    for (const int n : ring.whole.boundary_nodes(solid ? Boundary::end_low : Boundary::support))
      for (int c = 0; c < ring.whole.dimension; ++c) ring.fixed[ring.whole.dof[n * ring.whole.dimension + c]] = true;
  const NodeFinder find(ring.whole.nodes);
  for (int s = 0; s < teeth; ++s) {
    const Eigen::AngleAxisd turn(s * pitch, Eigen::Vector3d::UnitZ());
    auto& nodes = ring.node_of.emplace_back();
    for (const auto& p : ring.sector.nodes) nodes.push_back(find.at(turn * p));
  }
  return ring;
}

Eigen::VectorXd lowest_frequencies(const Eigen::SparseMatrix<double>& stiffness,
                                   const Eigen::SparseMatrix<double>& mass, int count) {
  const tests::SparseCholesky factor(stiffness);
  std::mt19937 random(3);
  const Eigen::Index spare = 8;
  Eigen::MatrixXd x = Eigen::MatrixXd::NullaryExpr(stiffness.rows(), count + spare,
                                                   [&] { return 2.0 * random() / std::mt19937::max() - 1; });
  Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
  for (int i = 0; i < 200; ++i) {
    const Eigen::MatrixXd inertia = mass * x, y = factor.solve(inertia);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small(y.transpose() * inertia,
                                                                          y.transpose() * (mass * y));
    const Eigen::VectorXd next = small.eigenvalues().head(count);
    x = y * small.eigenvectors();
    const double change = (next - values).cwiseQuotient(next).cwiseAbs().maxCoeff();
    values = next;
    if (change < 1e-10) break;
  }
  return values.cwiseSqrt() / (2 * M_PI);
}

}  // namespace annulus::tests
