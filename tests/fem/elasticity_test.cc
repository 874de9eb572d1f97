#include "fem/dealii/elastic_problem.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "discretised_body.h"
#include "elastic_integrals.h"
#include "structured_mesh.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(elasticity)

using annulus::fem::ElasticProblem;
using annulus::fem::Material;
using annulus::geometry::Boundary;
using annulus::tests::FreeSystem;

template <int dim>
using Vector = dealii::Tensor<1, dim>;
template <int dim>
using Gradient = dealii::Tensor<2, dim>;

const Material steel_like{2.5, 0.3, 1};  // E of order one: errors are then relative to the displacement

/// u_i = A_i sin(k_i . x + c_i): no symmetry, all components coupled, every derivative alive.
template <int dim>
struct Manufactured {
  Vector<dim> amplitude, shift;
  Gradient<dim> wave;  // rows k_i

  Manufactured() {
    const double a[3] = {1.0, -0.7, 0.8}, c[3] = {0.3, 1.1, -0.4};
    const double k[3][3] = {{2.0, 1.1, -0.7}, {-0.9, 1.8, 1.2}, {1.3, -0.6, 1.7}};
    for (int i = 0; i < dim; ++i) {
      amplitude[i] = a[i];
      shift[i] = c[i];
      for (int j = 0; j < dim; ++j) wave[i][j] = k[i][j];
    }
  }
  double phase(int i, const dealii::Point<dim>& x) const { return wave[i] * Vector<dim>(x) + shift[i]; }
  Vector<dim> operator()(const dealii::Point<dim>& x) const {
    Vector<dim> u;
    for (int i = 0; i < dim; ++i) u[i] = amplitude[i] * std::sin(phase(i, x));
    return u;
  }
  Gradient<dim> gradient(const dealii::Point<dim>& x) const {
    Gradient<dim> g;
    for (int i = 0; i < dim; ++i) g[i] = amplitude[i] * std::cos(phase(i, x)) * wave[i];
    return g;
  }
  /// f = -(lambda + mu) grad div u - mu laplace u
  Vector<dim> force(const dealii::Point<dim>& x, const Material& m) const {
    const double E = m.youngs_modulus, nu = m.poisson_ratio;
    const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
    Vector<dim> f;
    for (int i = 0; i < dim; ++i) {
      const double s = amplitude[i] * std::sin(phase(i, x));
      f += (lambda + mu) * s * wave[i][i] * wave[i];
      f[i] += mu * s * wave[i].norm_square();
    }
    return f;
  }
  double longest_wave_number() const {
    double k = 0;
    for (int i = 0; i < dim; ++i) k = std::max(k, wave[i].norm());
    return k;
  }
};

/// Solves with the displacement `exact` prescribed at every boundary node.
template <int dim, typename Exact>
Eigen::VectorXd solve_dirichlet(const ElasticProblem<dim>& problem, const Exact& exact, const Eigen::VectorXd& load) {
  const Eigen::SparseMatrix<double> stiffness = problem.stiffness();
  std::vector<bool> fixed(problem.dofs(), false);
  Eigen::VectorXd prescribed = Eigen::VectorXd::Zero(problem.dofs());
  for (const int n : problem.boundary_nodes(Boundary::inner)) {
    const auto u = exact(problem.node_points()[n]);
    for (int c = 0; c < dim; ++c) {
      fixed[problem.node_dofs()[n][c]] = true;
      prescribed[problem.node_dofs()[n][c]] = u[c];
    }
  }
  const FreeSystem system(stiffness, fixed);
  const Eigen::VectorXd rest = load - stiffness * prescribed;
  return prescribed +
         system.extend_rows(annulus::tests::SparseCholesky(system.matrix).solve(system.restrict_rows(rest)));
}

/// Largest error of interpolating sin on [0, 1] at the Lobatto nodes of one element of degree p, per (k h)^(p+1):
/// max |product of (x - x_i)| / (p + 1)!.
double interpolation_constant(int degree) {
  switch (degree) {
    case 1:
      return 1.0 / 4 / 2;
    case 2:
      return 0.04811 / 6;
    default:
      return 0.0125 / 24;
  }
}

std::string in_words(int dim, int degree) {
  return std::to_string(dim) + "D, elements of degree " + std::to_string(degree);
}

template <int dim>
void check_rates(annulus::test::Verification& record, int degree, const std::vector<int>& cells) {
  const Manufactured<dim> exact;
  std::vector<std::pair<double, double>> errors;
  for (const int n : cells) {
    const ElasticProblem<dim> problem(annulus::tests::distorted_box(dim, n, 0.15), {}, steel_like, degree);
    const auto load = annulus::tests::body_load(problem, [&](const auto& x) { return exact.force(x, steel_like); });
    const auto u = solve_dirichlet(problem, exact, load);
    errors.push_back(
        annulus::tests::solution_errors(problem, u, exact, [&](const auto& x) { return exact.gradient(x); }));
    BOOST_TEST_MESSAGE(dim << "D, degree " << degree << ", " << n << " cells a side: L2 " << errors.back().first
                           << ", H1 " << errors.back().second);
  }
  const auto finest = errors.back(), before = errors[errors.size() - 2];
  const double refinement = std::log(static_cast<double>(cells.back()) / cells[cells.size() - 2]);
  const double rate_l2 = std::log(before.first / finest.first) / refinement;
  const double rate_h1 = std::log(before.second / finest.second) / refinement;
  BOOST_TEST_MESSAGE("rates: L2 " << rate_l2 << ", H1 " << rate_h1);
  const auto model = in_words(dim, degree);
  record.at_least("order of the displacement (L2), " + model, "", rate_l2, 0.9 * (degree + 1),
                  "0.9 of the order " + std::to_string(degree + 1));
  record.at_least("order of the strain (H1), " + model, "", rate_h1, 0.9 * degree,
                  "0.9 of the order " + std::to_string(degree));
  // Ceiling: the interpolation error of a sine in each direction and component at the largest cell, (1 + 2 x 0.15) / n.
  const double kh = exact.longest_wave_number() * 1.3 / cells.back();
  record.at_most("error of the displacement (L2) on the finest mesh, " + model, "", finest.first,
                 dim * interpolation_constant(degree) * std::pow(kh, degree + 1), "interpolation error of a sine");
  std::vector<double> sizes, displacement;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    sizes.push_back(1.0 / cells[i]);
    displacement.push_back(errors[i].first);
  }
  record.convergence("Error of the displacement; dashed: order of theory", "size of a cell", "L2 error",
                     "degree " + std::to_string(degree), sizes, displacement, degree + 1);
}

BOOST_AUTO_TEST_CASE(manufactured_solution_converges_with_the_right_order_in_the_plane) {
  annulus::test::Verification record("Finite elements in the plane",
                                     "manufactured solution: sines in all components, body forces to match");
  check_rates<2>(record, 1, {8, 16, 32});
  check_rates<2>(record, 2, {4, 8, 16});
  check_rates<2>(record, 3, {4, 8, 16});
}

BOOST_AUTO_TEST_CASE(manufactured_solution_converges_with_the_right_order_in_space) {
  annulus::test::Verification record("Finite elements in space",
                                     "manufactured solution: sines in all components, body forces to match");
  check_rates<3>(record, 1, {4, 8, 16});
  check_rates<3>(record, 2, {2, 4, 8});
}

template <int dim>
void check_patch(annulus::test::Verification& record, int degree) {
  const double slope[3][3] = {{0.3, -0.2, 0.5}, {0.7, 0.1, -0.4}, {-0.6, 0.2, 0.9}};
  Gradient<dim> gradient;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) gradient[i][j] = slope[i][j];
  const auto linear = [&](const dealii::Point<dim>& x) -> Vector<dim> { return gradient * Vector<dim>(x); };
  const ElasticProblem<dim> problem(annulus::tests::distorted_box(dim, 4, 0.25), {}, steel_like, degree);
  const Eigen::VectorXd u = solve_dirichlet(problem, linear, Eigen::VectorXd::Zero(problem.dofs()));
  double worst = 0;
  for (std::size_t n = 0; n < problem.node_points().size(); ++n) {
    const auto expected = linear(problem.node_points()[n]);
    for (int c = 0; c < dim; ++c) worst = std::max(worst, std::abs(u[problem.node_dofs()[n][c]] - expected[c]));
  }
  record.at_most("largest error of a displacement (of order one)", "m", worst, 1e-12,
                 "condition number (below 1e4) x rounding");

  // Energy of the uniform strain: 1/2 (lambda tr(e)^2 + 2 mu e : e) x unit volume.
  const double E = steel_like.youngs_modulus, nu = steel_like.poisson_ratio;
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
  double trace = 0, square = 0;
  for (int i = 0; i < dim; ++i) {
    trace += gradient[i][i];
    for (int j = 0; j < dim; ++j) square += std::pow((gradient[i][j] + gradient[j][i]) / 2, 2);
  }
  const double energy = 0.5 * u.dot(problem.stiffness() * u);
  // The quadrature is exact for constant strains on cells of this shape (Jacobian of degree <= dim - 1 per direction).
  record.close("strain energy: 1/2 (lambda tr(e)^2 + 2 mu e : e)", "J", energy,
               0.5 * (lambda * trace * trace + 2 * mu * square), 1e-12, "rounding: the quadrature is exact here");
}

BOOST_AUTO_TEST_CASE(patch_test_linear_displacements_are_exact_on_every_element) {
  annulus::test::Verification record("Patch test: distorted cells, degrees 1 to 3 in 2D, 1 and 2 in 3D",
                                     "closed form: a linear displacement has uniform strain");
  for (const int degree : {1, 2, 3}) check_patch<2>(record, degree);
  for (const int degree : {1, 2}) check_patch<3>(record, degree);
}

template <int dim>
void check_rigid_motions(annulus::test::Verification& record, int degree) {
  const ElasticProblem<dim> problem(annulus::tests::distorted_box(dim, 3, 0.25), {}, steel_like, degree);
  const Eigen::SparseMatrix<double> stiffness = problem.stiffness();
  const Eigen::SparseMatrix<double> transposed = stiffness.transpose();
  const double largest = stiffness.coeffs().cwiseAbs().maxCoeff();
  // Round-off of sums of some hundred entries: 100 x 2e-16.
  record.at_most("asymmetry of the stiffness matrix over its norm", "",
                 (stiffness - transposed).norm() / stiffness.norm(), 1e-14, "rounding of sums of some hundred entries");
  std::vector<Vector<dim>> translations(dim);
  for (int c = 0; c < dim; ++c) translations[c][c] = 1;
  const auto check = [&](const auto& motion) {
    Eigen::VectorXd u(problem.dofs());
    for (std::size_t n = 0; n < problem.node_points().size(); ++n)
      for (int c = 0; c < dim; ++c) u[problem.node_dofs()[n][c]] = motion(problem.node_points()[n])[c];
    record.at_most("largest force over the largest stiffness", "", (stiffness * u).cwiseAbs().maxCoeff() / largest,
                   1e-13, "rounding");
  };
  for (const auto& t : translations) check([&](const dealii::Point<dim>&) { return t; });
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < a; ++b)
      check([&](const dealii::Point<dim>& x) {
        Vector<dim> u;
        u[a] = x[b];
        u[b] = -x[a];
        return u;
      });
}

BOOST_AUTO_TEST_CASE(rigid_motions_cause_no_force) {
  annulus::test::Verification record("Translations and rotations", "theory: a rigid motion causes no force");
  for (const int degree : {1, 2, 3}) check_rigid_motions<2>(record, degree);
  for (const int degree : {1, 2}) check_rigid_motions<3>(record, degree);
}

BOOST_AUTO_TEST_CASE(meshes_of_the_wrong_dimension_are_refused) {
  BOOST_CHECK_THROW(ElasticProblem<3>(annulus::tests::distorted_box(2, 2, 0), {}, steel_like, 1),
                    annulus::InternalError);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(thick_ring)

using annulus::fem::ElasticProblem;
using annulus::fem::Material;
using annulus::geometry::Boundary;
using annulus::tests::FreeSystem;

constexpr double inside = 1.0, outside = 1.6, height = 0.4, pressure = 0.01;
const Material ring_material{1.0, 0.3, 1};

const char* const lame = "closed form of Lame: Timoshenko and Goodier, Theory of Elasticity, art. 28";

/// Lame: radial displacement under internal pressure, plane strain.
double exact_displacement(double r) {
  const double E = ring_material.youngs_modulus, nu = ring_material.poisson_ratio;
  return (1 + nu) * pressure * inside * inside / (E * (outside * outside - inside * inside)) *
         ((1 - 2 * nu) * r + outside * outside / r);
}

Eigen::Vector3d on_circle(Boundary boundary, const Eigen::Vector3d& point) {
  if (boundary != Boundary::root && boundary != Boundary::support) return point;
  const double radius = boundary == Boundary::root ? inside : outside, scale = radius / point.head<2>().norm();
  return {scale * point.x(), scale * point.y(), point.z()};
}

/// A quarter ring of one by two cells, straight-sided: all curvature comes from the projection.
template <int dim>
annulus::geometry::Mesh quarter() {
  const auto polar = [](double u, double v) -> Eigen::Vector2d {
    const double r = inside + (outside - inside) * u, angle = M_PI / 2 * v;
    return {r * std::cos(angle), r * std::sin(angle)};
  };
  const annulus::tests::SideTags tags = {Boundary::root,      Boundary::support, Boundary::side_low,
                                         Boundary::side_high, Boundary::end_low, Boundary::end_high};
  if constexpr (dim == 2) return annulus::tests::structured_mesh(1, 2, polar, tags);
  return annulus::tests::structured_mesh(
      1, 2, 1,
      [&](double u, double v, double w) -> Eigen::Vector3d {
        const auto p = polar(u, v);
        return {p.x(), p.y(), height * w};
      },
      tags);
}

/// Displacement under internal pressure of a quarter held in its planes of symmetry, ends flat.
template <int dim>
Eigen::VectorXd solve_quarter(const ElasticProblem<dim>& problem) {
  const Eigen::VectorXd load = annulus::tests::surface_load(
      problem, Boundary::root, [](const auto&, const auto& normal) { return -pressure * normal; });
  std::vector<bool> fixed(problem.dofs(), false);
  const auto hold = [&](Boundary boundary, int component) {
    for (const int n : problem.boundary_nodes(boundary)) fixed[problem.node_dofs()[n][component]] = true;
  };
  hold(Boundary::side_low, 1);
  hold(Boundary::side_high, 0);
  if constexpr (dim == 3) {
    hold(Boundary::end_low, 2);
    hold(Boundary::end_high, 2);
  }
  const FreeSystem system(problem.stiffness(), fixed);
  return system.extend_rows(annulus::tests::SparseCholesky(system.matrix).solve(system.restrict_rows(load)));
}

/// Largest relative error of the displacement over the nodes of both circles.
template <int dim>
double displacement_error(int degree, int refinements) {
  const ElasticProblem<dim> problem(quarter<dim>(), on_circle, ring_material, degree, refinements);
  const Eigen::VectorXd u = solve_quarter(problem);
  double worst = 0, off_circle = 0;
  for (const auto boundary : {Boundary::root, Boundary::support}) {
    const double r = boundary == Boundary::root ? inside : outside;
    const auto nodes = problem.boundary_nodes(boundary);
    BOOST_TEST_REQUIRE(!nodes.empty());
    for (const int n : nodes) {
      const auto& p = problem.node_points()[n];
      off_circle = std::max(off_circle, std::abs(std::hypot(p[0], p[1]) / r - 1));
      const auto& f = problem.node_dofs()[n];
      const double error = std::hypot(u[f[0]] - exact_displacement(r) * p[0] / r,
                                      u[f[1]] - exact_displacement(r) * p[1] / r, dim == 3 ? u[f[dim - 1]] : 0.0);
      worst = std::max(worst, error / exact_displacement(r));
    }
  }
  BOOST_TEST(off_circle < 1e-14);  // round-off of the projection
  return worst;
}

std::string in_words(int dim, int degree) {
  return std::to_string(dim) + "D, elements of degree " + std::to_string(degree);
}

template <int dim>
void check_convergence(annulus::test::Verification& record, int degree, int finest) {
  std::vector<double> errors;
  for (int refinements = 0; refinements <= finest; ++refinements) {
    errors.push_back(displacement_error<dim>(degree, refinements));
    BOOST_TEST_MESSAGE(dim << "D, degree " << degree << ", " << refinements << " refinements: " << errors.back());
  }
  const double rate = std::log2(errors[finest - 1] / errors[finest]);
  BOOST_TEST_MESSAGE("rate " << rate);
  record.at_least("order of the displacement, " + in_words(dim, degree), "", rate, 0.9 * (degree + 1),
                  "0.9 of the order " + std::to_string(degree + 1));
  // Ceiling: twice the interpolation errors of the circle (arc pi/4 a cell) and of 1/r (one cell across), both of
  // degree p: max |product of (x - x_i)| is 1/4, 0.0481, 0.0125 for p = 1, 2, 3.
  const double node_product = degree == 1 ? 0.25 : degree == 2 ? 0.0481 : 0.0125;
  const double factorial = degree == 1 ? 2 : degree == 2 ? 6 : 24;
  const double arc = std::ldexp(M_PI / 4, -finest), width = std::ldexp(outside - inside, -finest);
  record.at_most("relative error of the displacement, finest mesh, " + in_words(dim, degree), "", errors[finest],
                 2 * node_product * (std::pow(arc, degree + 1) / factorial + std::pow(width / inside, degree + 1)),
                 "twice the interpolation errors of the circle and of 1/r");
  std::vector<double> sizes;
  for (int refinements = 0; refinements <= finest; ++refinements)
    sizes.push_back(std::ldexp(outside - inside, -refinements));
  record.convergence("Error of the displacement; dashed: order of theory", "size of a cell over inner radius",
                     "relative error", "degree " + std::to_string(degree), sizes, errors, degree + 1);
}

BOOST_AUTO_TEST_CASE(internal_pressure_in_the_plane) {
  annulus::test::Verification record("Thick ring under internal pressure, plane strain", lame);
  check_convergence<2>(record, 1, 5);
  check_convergence<2>(record, 2, 4);
  check_convergence<2>(record, 3, 3);
}

BOOST_AUTO_TEST_CASE(internal_pressure_in_space_with_the_ends_held_flat) {
  annulus::test::Verification record("Thick tube under internal pressure, ends held flat", lame);
  check_convergence<3>(record, 2, 3);
}

/// Lame: hoop stress under internal pressure.
double exact_hoop_stress(double r) {
  return pressure * inside * inside / (outside * outside - inside * inside) * (1 + outside * outside / (r * r));
}

/// Largest relative error of the surface stress on both circles.
template <int dim>
double stress_error(int degree, int refinements) {
  const ElasticProblem<dim> problem(quarter<dim>(), on_circle, ring_material, degree, refinements);
  const Eigen::VectorXd u = solve_quarter(problem);
  const auto observe = [&](const annulus::fem::NodalLoad& functional) {
    double sum = 0;
    for (const auto& f : functional)
      for (int c = 0; c < dim; ++c) sum += f.force[c] * u[problem.node_dofs()[f.node][c]];
    return sum;
  };
  const double nu = ring_material.poisson_ratio;
  double worst = 0;
  for (const auto boundary : {Boundary::root, Boundary::support}) {
    const double r = boundary == Boundary::root ? inside : outside;
    // Under the pressure itself the stress lacks nu / (1 - nu) of it.
    const double exact = exact_hoop_stress(r) + (boundary == Boundary::root ? nu / (1 - nu) * pressure : 0);
    const auto stresses = problem.surface_stress({boundary});
    BOOST_TEST_REQUIRE(stresses.size() == problem.boundary_nodes(boundary).size());
    for (const auto& s : stresses) {
      worst = std::max(worst, std::abs(observe(s.tangential) / exact - 1));
      if constexpr (dim == 3) {
        worst = std::max(worst, std::abs(observe(s.axial) / exact - nu));  // plane strain
        worst = std::max(worst, std::abs(observe(s.shear) / exact));
      }
    }
  }
  return worst;
}

template <int dim>
void check_stress_convergence(annulus::test::Verification& record, int degree, int finest) {
  std::vector<double> errors;
  for (int refinements = finest - 1; refinements <= finest; ++refinements) {
    errors.push_back(stress_error<dim>(degree, refinements));
    BOOST_TEST_MESSAGE(dim << "D, degree " << degree << ", " << refinements << " refinements: stress "
                           << errors.back());
  }
  const double rate = std::log2(errors[0] / errors[1]);
  BOOST_TEST_MESSAGE("rate " << rate);
  // A derivative of the displacement: one order less.
  record.at_least("order of the surface stress, " + in_words(dim, degree), "", rate, 0.9 * degree,
                  "0.9 of the order " + std::to_string(degree));
  // Ceiling: the slope of the interpolation of the displacement at an end node, (arc)^p / (p + 1)! x product of the
  // distances of the nodes (1 and 1/2 for p = 1, 2), on arcs of pi/4 refined, twice.
  const double arc = std::ldexp(M_PI / 4, -finest);
  record.at_most("relative error of the surface stress, finest mesh, " + in_words(dim, degree), "", errors[1],
                 2 * (degree == 1 ? arc / 2 : arc * arc / 12), "twice the slope error of the interpolation");
}

BOOST_AUTO_TEST_CASE(surface_stress_of_the_pressed_ring_is_that_of_lame) {
  annulus::test::Verification record("Surface stress of a thick ring under internal pressure", lame);
  check_stress_convergence<2>(record, 1, 5);
  check_stress_convergence<2>(record, 2, 4);
  check_stress_convergence<3>(record, 2, 3);
}

BOOST_AUTO_TEST_CASE(pressure_on_a_curved_boundary_has_the_resultant_of_its_projection) {
  annulus::test::Verification record("Resultant of a pressure on a curved boundary",
                                     "statics: pressure x projection, whatever the curve");
  // Over a quarter circle: pressure x radius in x and in y; geometry of degree 3, twice refined.
  const ElasticProblem<2> problem(quarter<2>(), on_circle, ring_material, 3, 2);
  const auto load = annulus::tests::surface_load(problem, Boundary::root,
                                                 [](const auto&, const auto& normal) { return -pressure * normal; });
  double x = 0, y = 0;
  for (const auto& f : problem.node_dofs()) {
    x += load[f[0]];
    y += load[f[1]];
  }
  // The integral of the normal over a curve depends on its end points alone: round-off.
  record.close("resultant in x", "N", x, pressure * inside, 1e-13, "rounding");
  record.close("resultant in y", "N", y, pressure * inside, 1e-13, "rounding");
}

BOOST_AUTO_TEST_SUITE_END()
