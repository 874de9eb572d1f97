#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "discretised_body.h"
#include "fem/contact/complementarity.h"
#include "fem/contact/half_plane.h"
#include "fem/elasticity/trace_basis.h"
#include "structured_mesh.h"
#include "tests/verification_record.h"

/// Contact patch test: two blocks pressed on each other through meshes that do not match. The exact pressure is
/// uniform.
BOOST_AUTO_TEST_SUITE(contact_patch)

using annulus::fem::HalfPlane;
using annulus::fem::Material;
using annulus::fem::TraceBasis;
using annulus::geometry::Boundary;

constexpr double width = 1, height = 0.4, line_load = 1e6;  // m, m, N per metre of the third direction
const Material steel{};

/// One block below (or, mirrored, above) the contact: its far side slides on a rigid plate.
struct Block {
  TraceBasis trace;            ///< of the contact side over x
  Eigen::MatrixXd compliance;  ///< of unit forces on its nodes into the block, m per N/m
};

/// `cells` along the contact, graded by x = u^grading and bent inside, so that no two cells are alike.
Block make_block(int cells, int layers, double grading, int degree) {
  const auto mesh =
      annulus::tests::structured_mesh(cells, layers,
                                      [&](double u, double v) -> Eigen::Vector2d {
                                        const double x = std::pow(u, grading), inside = x * (1 - x) * v * (1 - v);
                                        return {width * (x + 0.4 * inside), -height * (1 - v) + 0.3 * height * inside};
                                      },
                                      {Boundary::none, Boundary::none, Boundary::support, Boundary::tip});
  const auto body = annulus::tests::discretise_body(
      mesh, [](Boundary, const Eigen::Vector2d& p) { return p; }, steel, degree);
  std::vector<bool> fixed(body.stiffness.rows(), false);
  for (const int n : body.boundary_nodes(Boundary::support)) {
    fixed[body.dof[2 * n + 1]] = true;
    if (body.nodes[n].x() == 0) fixed[body.dof[2 * n]] = true;
  }
  const annulus::tests::FreeSystem system(body.stiffness, fixed);
  auto surface = body.boundary_nodes(Boundary::tip);
  std::sort(surface.begin(), surface.end(), [&](int a, int b) { return body.nodes[a].x() < body.nodes[b].x(); });
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(body.stiffness.rows(), static_cast<Eigen::Index>(surface.size()));
  std::vector<double> stations;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    stations.push_back(body.nodes[surface[i]].x());
    loads(body.dof[2 * surface[i] + 1], static_cast<Eigen::Index>(i)) = -1;
  }
  const Eigen::MatrixXd free_loads = system.restrict_rows(loads);
  return {TraceBasis(stations, degree),
          free_loads.transpose() * annulus::tests::SparseCholesky(system.matrix).solve(free_loads)};
}

/// Ends of the pressure elements, unlike both meshes.
std::vector<double> element_edges(int elements) {
  std::vector<double> edges;
  for (int e = 0; e <= elements; ++e) {
    const double t = static_cast<double>(e) / elements;
    edges.push_back(width * (t + 0.08 * std::sin(2 * M_PI * t)));
  }
  return edges;
}

/// Unit force spread evenly over each element, stations x elements.
Eigen::MatrixXd even_weights(const TraceBasis& trace, const std::vector<double>& edges) {
  Eigen::MatrixXd weights(trace.size(), static_cast<Eigen::Index>(edges.size()) - 1);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const auto mean = trace.mean_over(edges[e], edges[e + 1]);
    for (int i = 0; i < trace.size(); ++i) weights(i, static_cast<Eigen::Index>(e)) = mean[i];
  }
  return weights;
}

struct Spread {
  double centre = 0, half_length = 0, spread = 0;
};

/// As a flank's elements are: semi-ellipses that the mesh resolves, at the ends as wide as they fit.
std::vector<Spread> spreads(const std::vector<double>& edges, double resolved) {
  std::vector<Spread> result;
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const double centre = (edges[e] + edges[e + 1]) / 2, half = (edges[e + 1] - edges[e]) / 2;
    const double spread = std::max(2 / std::sqrt(3.0) * half, resolved);
    result.push_back({centre, half, std::min({spread, centre, width - centre})});
  }
  return result;
}

Eigen::MatrixXd spread_weights(const TraceBasis& trace, const std::vector<Spread>& elements) {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(trace.size(), static_cast<Eigen::Index>(elements.size()));
  constexpr int points = 16;  // Gauss quadrature with the weight sqrt(1 - t^2)
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (int i = 1; i <= points; ++i) {
      const double angle = i * M_PI / (points + 1), sine = std::sin(angle);
      const double x = elements[e].centre + elements[e].spread * std::cos(angle);
      const auto values = trace(std::clamp(x, trace.low(), trace.high()));
      for (std::size_t k = 0; k < values.weights.size(); ++k)
        weights(values.first + static_cast<int>(k), static_cast<Eigen::Index>(e)) +=
            2 * sine * sine / (points + 1) * values.weights[k];
    }
  return weights;
}

/// Pressures relative to the uniform one, and the approach of the two plates.
std::pair<Eigen::VectorXd, double> press(const Eigen::MatrixXd& compliance, const std::vector<double>& edges) {
  annulus::fem::ComplementarityProblem problem;
  const Eigen::Index n = compliance.rows();
  problem.compliance = (compliance + compliance.transpose()) / 2;
  problem.gap = Eigen::VectorXd::Zero(n);
  problem.rigid = Eigen::MatrixXd::Ones(n, 1);
  problem.load = Eigen::VectorXd::Constant(1, line_load);
  problem.unilateral.assign(n, true);
  const auto solution = solve_complementarity(problem, {});
  Eigen::VectorXd pressure(n);
  for (Eigen::Index e = 0; e < n; ++e)
    pressure[e] = solution.force[e] / (edges[e + 1] - edges[e]) / (line_load / width);
  return {pressure, solution.rigid[0]};
}

/// Of one block in plane strain, its sides free: (1 - nu^2) / E * pressure * height.
double exact_approach() {
  const double nu = steel.poisson_ratio;
  return (1 - nu * nu) / steel.youngs_modulus * line_load / width * height;
}

// Both blocks deform linearly: their elements contain it, the loads are consistent (every integral of a shape function
// over an element of pressure is exact), and the mean gap of every element vanishes: the uniform pressure is the unique
// solution. What is left is round-off, times the condition number of the compliance (some 1e3).
BOOST_AUTO_TEST_CASE(even_pressures_between_meshes_that_do_not_match_are_exact) {
  annulus::test::Verification record("Contact patch test: two blocks through meshes that do not match",
                                     "closed form: uniform pressure, approach (1 - nu^2) p h / E each");
  for (const int degree : {1, 2, 3}) {
    const Block below = make_block(7, 3, 1.3, degree), above = make_block(5, 4, 0.7, degree);
    for (const int elements : {1, 4, 9}) {
      const auto edges = element_edges(elements);
      const Eigen::MatrixXd u = even_weights(below.trace, edges), v = even_weights(above.trace, edges);
      BOOST_TEST((u.colwise().sum().array() - 1).abs().maxCoeff() < 1e-12);
      const auto [pressure, approach] =
          press(u.transpose() * below.compliance * u + v.transpose() * above.compliance * v, edges);
      const double worst = (pressure.array() - 1).abs().maxCoeff();
      BOOST_TEST_MESSAGE("degree " << degree << ", " << elements << " elements: pressure " << worst << ", approach "
                                   << approach / (2 * exact_approach()) - 1);
      record.at_most("largest error of the pressure, relative", "", worst, 1e-9,
                     "rounding x condition of the compliance, some 1e3");
      record.close("approach of the plates", "m", approach, 2 * exact_approach(), 1e-10, "rounding x condition");
    }
  }
}

BOOST_AUTO_TEST_CASE(a_pressure_has_the_same_resultant_and_centre_on_both_meshes) {
  annulus::test::Verification record("A contact pressure on two meshes", "statics: same resultant, same centre");
  // The pressure is the same on both bodies by construction; what the meshes make of it agrees for rigid motions.
  const Block below = make_block(7, 3, 1.3, 2), above = make_block(5, 4, 0.7, 2);
  const auto edges = element_edges(6);
  const Eigen::MatrixXd u = even_weights(below.trace, edges), v = even_weights(above.trace, edges);
  const auto coordinates = [](const TraceBasis& trace) {
    return Eigen::Map<const Eigen::VectorXd>(trace.stations().data(), trace.size());
  };
  const Eigen::VectorXd lever = u.transpose() * coordinates(below.trace) - v.transpose() * coordinates(above.trace);
  record.at_most("difference of the resultants of unit forces", "",
                 (u.colwise().sum() - v.colwise().sum()).cwiseAbs().maxCoeff(), 1e-13, "rounding");
  record.at_most("distance of the centres over the width", "", lever.cwiseAbs().maxCoeff() / width, 1e-13, "rounding");
}

// What the flanks of gears get is not exact: semi-elliptical loads on the mesh, as wide as its cells need, and the
// half-plane's difference. Semi-ellipses in a row are no uniform pressure, a block is no half-plane, and near the edge
// the loads become narrower than the cells. Where the contact ends inside the flank, as in a line contact, none of it
// matters (see the comparison with Hertz); a contact that ends at an edge with full pressure is the worst case.
BOOST_AUTO_TEST_CASE(spread_loads_and_their_half_plane_are_nearly_so_inside_and_not_at_the_edges) {
  annulus::test::Verification record("Contact patch test of spread loads with the half-plane's near field",
                                     "closed form: uniform pressure, approach (1 - nu^2) p h / E each");
  std::vector<double> sizes, errors;
  const HalfPlane plane(steel);
  double before = 0;
  for (const int refine : {1, 2, 4}) {
    const Block below = make_block(10 * refine, 4 * refine, 1, 2), above = make_block(7 * refine, 3 * refine, 1, 2);
    std::vector<double> edges;
    const int elements = 20 * refine;
    for (int e = 0; e <= elements; ++e) edges.push_back(width * e / elements);
    Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(elements, elements);
    for (const Block* block : {&below, &above}) {
      const auto loads = spreads(edges, 2.5 * width / block->trace.elements());
      const Eigen::MatrixXd w = spread_weights(block->trace, loads);
      compliance += w.transpose() * block->compliance * w;
      for (int i = 0; i < elements; ++i)
        for (int j = 0; j < elements; ++j) {
          const double distance = loads[i].centre - loads[j].centre;
          compliance(i, j) += plane.strips(distance, loads[i].half_length, loads[j].half_length) -
                              plane.semi_ellipses(distance, loads[i].spread, loads[j].spread);
        }
    }
    const auto [pressure, approach] = press(compliance, edges);
    // The inner half, and everything.
    const double inside = (pressure.segment(elements / 4, elements / 2).array() - 1).abs().maxCoeff();
    const double all = (pressure.array() - 1).abs().maxCoeff();
    BOOST_TEST_MESSAGE(elements << " elements: pressure inside " << inside << ", anywhere " << all << ", approach "
                                << approach / (2 * exact_approach()) - 1);
    // The edges spoil a few elements whatever their size: their part of the block shrinks with it, so that inside and
    // approach converge with the first power at least; at the edge a sixth of the pressure stays wrong.
    const char* origin = "edges spoil a few elements whatever their size";
    record.at_most("pressure in the inner half, relative error x refinement", "", inside * refine, 0.05, origin);
    record.at_most("pressure anywhere, relative error", "", all, 0.25,
                   "a contact that ends with full pressure at an edge");
    record.near("approach over the closed form", "", approach / (2 * exact_approach()), 1, 0.15 / refine, origin);
    sizes.push_back(1.0 / elements);
    errors.push_back(inside);
    if (before > 0) BOOST_TEST(inside < before);
    before = inside;
  }
  record.convergence("Error of the pressure in the inner half; dashed: order 1", "length of an element",
                     "relative error", "", sizes, errors, 1);
}

BOOST_AUTO_TEST_SUITE_END()
