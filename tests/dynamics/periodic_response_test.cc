#include "dynamics/systems/planetary/response.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/errors.h"
#include "dynamics/steady_state/frequency_response.h"
#include "dynamics/time_integration/integrate.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(periodic_responses)

using namespace annulus::dynamics;

constexpr double load = 30, frequency = 20;  // N, Hz

/// A mass of 2 kg, natural frequency 25.2 Hz, pressed into its mesh with 30 N (0.6 mm).
struct MeshedMass {
  MeshElement mesh;
  MeshedMass() {
    mesh.name = "m";
    mesh.excitation = ConstantStiffness{5e4};
    mesh.frequency = frequency;
    mesh.damping = 40;  // ratio 0.06
  }
  [[nodiscard]] LumpedSystem system() const {
    LumpedSystemBuilder builder;
    MeshElement m = mesh;
    m.b = builder.add_dof("x");
    builder.add_mass(m.b, 2);
    builder.add_load(m.b, load);
    builder.add_mesh(m);
    return builder.build();
  }
};

PeriodicResponse solve(const LumpedSystem& system, int samples, double tolerance = 1e-9) {
  PeriodicOptions options;
  options.samples_per_cycle = samples;
  options.tolerance = tolerance;
  return periodic_response(system, 1 / frequency, 1, options);
}

/// Forces (meshes x samples) and displacements over the last of many periods of time integration.
struct Integrated {
  Eigen::MatrixXd force, displacement;
};

Integrated integrated(const LumpedSystem& system, double period, int periods, Eigen::Index samples, double absolute) {
  auto workspace = system.workspace();
  SystemState state;
  state.q = state.v = Eigen::VectorXd::Zero(system.dofs());
  IntegratorOptions options;
  options.method = Integrator::arkode_explicit;
  options.relative_tolerance = 1e-10;
  options.absolute_tolerance = absolute;
  integrate(system, state, (periods - 1) * period, options, workspace);
  Integrated result;
  result.force.resize(static_cast<Eigen::Index>(system.meshes().size()), samples);
  result.displacement.resize(system.dofs(), samples);
  integrate(system, state, periods * period, options, workspace,
            {.samples = static_cast<int>(samples), .sample = [&](int i, const SystemState& s) {
               for (Eigen::Index m = 0; m < result.force.rows(); ++m) result.force(m, i) = workspace.force[m];
               result.displacement.col(i) = s.q;
             }});
  return result;
}

double largest(const Eigen::MatrixXd& difference) { return difference.cwiseAbs().maxCoeff(); }

BOOST_AUTO_TEST_CASE(harmonic_error_in_closed_form) {
  using namespace std::complex_literals;
  annulus::test::Verification record("Harmonic transmission error on a linear mesh",
                                     "closed form: (k - w^2 m + i w c) x = (k + i w c) e");
  MeshedMass mass;
  const double w = 2 * std::numbers::pi * frequency, e = 1e-4;
  mass.mesh.errors = {{e, w, 0.7}};
  const auto response = solve(mass.system(), 16);
  BOOST_TEST(response.converged);
  // (k - w^2 m + i w c) x = (k + i w c) e, e sin(w t + 0.7) = Re(-i e exp(0.7 i) exp(i w t))
  const auto error = -1i * e * std::exp(0.7i), coupling = 5e4 + 40i * w;
  const auto x = coupling * error / (coupling - 2 * w * w);
  for (Eigen::Index i = 0; i < 16; ++i) {
    const auto turn = std::exp(1i * w * response.time[i]);
    // Rounding of some ten terms; the problem is linear and its linear part solves it.
    record.near("displacement", "m", response.displacement(0, i), load / 5e4 + (x * turn).real(), 1e-12 * 1e-3,
                "rounding");
    record.near("velocity", "m/s", response.velocity(0, i), (1i * w * x * turn).real(), 1e-12 * w * 1e-3, "rounding");
    record.near("mesh force", "N", response.force(0, i), load + (coupling * (x - error) * turn).real(), 1e-12 * load,
                "rounding");
  }
  BOOST_TEST(response.coarse_difference <= 1e-12 * load);
}

BOOST_AUTO_TEST_CASE(harmonic_load_in_closed_form) {
  using namespace std::complex_literals;
  annulus::test::Verification record("Harmonic load on a linear mesh", "closed form: (k - w^2 m + i w c) x = F");
  const MeshedMass mass;
  const double w = 2 * std::numbers::pi * frequency, cosine = 7, sine = -4;
  for (const double rate : {w, -w, 3 * w}) {
    LumpedSystemBuilder builder;
    MeshElement m = mass.mesh;
    m.b = builder.add_dof("x");
    builder.add_mass(m.b, 2);
    builder.add_load(m.b, load);
    builder.add_harmonic_load(m.b, rate, cosine, sine);
    builder.add_mesh(m);
    const auto system = builder.build();
    const auto response = solve(system, 16);
    BOOST_TEST(response.converged);
    const auto x = (cosine - 1i * sine) / (5e4 + 40i * rate - 2 * rate * rate);
    for (Eigen::Index i = 0; i < 16; ++i) {
      const auto turn = std::exp(1i * rate * response.time[i]);
      record.near("displacement", "m", response.displacement(0, i), load / 5e4 + (x * turn).real(), 1e-12 * 1e-3,
                  "rounding");
      record.near("mesh force", "N", response.force(0, i), load + ((5e4 + 40i * rate) * x * turn).real(), 1e-12 * load,
                  "rounding");
    }
    const auto found = integrated(system, 1 / frequency, 60, 16, 1e-14).displacement;
    record.at_most("displacement less that of time integration, over the static one", "",
                   largest(found - response.displacement) / (load / 5e4), 1e-8, "tolerance of the integrator");
  }
  LumpedSystemBuilder builder;
  MeshElement m = mass.mesh;
  m.b = builder.add_dof("x");
  builder.add_mass(m.b, 2);
  builder.add_load(m.b, load);
  builder.add_harmonic_load(m.b, 0.6 * w, cosine, sine);
  builder.add_mesh(m);
  const auto refused = solve(builder.build(), 16);
  BOOST_TEST(!refused.converged);
  BOOST_TEST(refused.trouble.find("does not fit a period") != std::string::npos, refused.trouble);
}

// Mathieu's equation with load and damper, against time integration until all is still (exp(-10 x 2.5) of the start).
BOOST_AUTO_TEST_CASE(parametric_excitation_agrees_with_time_integration) {
  annulus::test::Verification record("Parametric excitation (Mathieu's equation with load and damper)",
                                     "time integration by ARKODE until all is still");
  MeshedMass mass;
  mass.mesh.excitation = HarmonicStiffness{5e4, 0.4, 0.1};
  const auto system = mass.system();
  const auto response = solve(system, 64);
  BOOST_TEST(response.converged);
  BOOST_TEST(largest(response.force.array() - load) > 0.2 * load);  // the stiffness does excite
  const auto force = integrated(system, 1 / frequency, 60, 64, 1e-14).force;
  record.at_most("largest difference of the mesh force over the load", "", largest(response.force - force) / load, 1e-7,
                 "integrator: 1e-10 x steps of some decay times");
  annulus::test::RecordedPlot::Curve curve{"", {}, {}, {}};
  for (Eigen::Index i = 0; i < 64; ++i) {
    curve.x.push_back(static_cast<double>(i) / 64);
    curve.computed.push_back(response.force(0, i));
    curve.reference.push_back(force(0, i));
  }
  record.plot({"Mesh force", "period", "N", {curve}});
}

/// Largest difference of a displacement (m).
double motion_error(const PeriodicResponse& response, const Integrated& truth) {
  const Eigen::Index samples = response.time.size(), every = truth.displacement.cols() / samples;
  double error = 0;
  for (Eigen::Index i = 0; i < samples; ++i)
    error = std::max(error, largest(response.displacement.col(i) - truth.displacement.col(i * every)));
  return error;
}

// Where contact or stiffness changes between two samples, means over the time step make the error of the motion second
// order. (Next to a jump the velocity has a kink, and the force of the damper an error of first order.)
void check_second_order(annulus::test::Verification& record, const LumpedSystem& system, const Integrated& truth) {
  double previous = 0;
  std::vector<double> sizes, errors;
  for (const int samples : {64, 256, 1024}) {
    const auto response = solve(system, samples, 1e-8);
    BOOST_TEST(response.converged, response.trouble);
    const double error = motion_error(response, truth);
    if (previous > 0)
      record.at_least("order of convergence", "", std::log2(previous / error) / 2, 1.6, "0.8 of the order 2");
    previous = error;
    sizes.push_back(1.0 / samples);
    errors.push_back(error / (load / 5e4));
  }
  record.at_most("error of the motion over the static deflection, 1024 samples", "", previous / (load / 5e4), 1e-4,
                 "ceiling beside the rate");
  record.convergence("Error of the motion; dashed: order 2", "time step over period", "error over static deflection",
                     "", sizes, errors, 2);
}

BOOST_AUTO_TEST_CASE(contact_loss_agrees_with_time_integration_to_second_order) {
  annulus::test::Verification record("Teeth that part in every period", "time integration by ARKODE, tolerance 1e-10");
  MeshedMass mass;
  mass.mesh.damping = 200;
  mass.mesh.errors = {{8e-4, 2 * std::numbers::pi * frequency, 0.3}};
  mass.mesh.half_backlash = 5e-3;
  const auto system = mass.system();
  const auto truth = integrated(system, 1 / frequency, 80, 1024, 1e-14);
  const auto apart = (truth.force.array() == 0).count();
  BOOST_TEST(apart > 100);
  BOOST_TEST(std::abs(solve(system, 256, 1e-8).open[0] - static_cast<double>(apart) / 1024) <= 2.0 / 256);
  check_second_order(record, system, truth);
}

BOOST_AUTO_TEST_CASE(jumping_stiffness_agrees_with_time_integration_to_second_order) {
  annulus::test::Verification record("Stiffness that jumps", "time integration by ARKODE, tolerance 1e-10");
  MeshedMass mass;
  mass.mesh.excitation = RectangularStiffness{5e4, 0.3, 0.37, 0.1};
  const auto system = mass.system();
  check_second_order(record, system, integrated(system, 1 / frequency, 60, 1024, 1e-14));
}

BOOST_AUTO_TEST_CASE(samples_are_doubled_until_they_do) {
  annulus::test::Verification record("Teeth that part, samples doubled until they do",
                                     "time integration by ARKODE, tolerance 1e-10");
  MeshedMass mass;
  mass.mesh.damping = 200;
  mass.mesh.errors = {{8e-4, 2 * std::numbers::pi * frequency, 0.3}};
  mass.mesh.half_backlash = 5e-3;
  const auto system = mass.system();
  PeriodicOptions options;
  options.samples_per_cycle = 16;
  options.tolerance = 1e-8;
  options.sampling_tolerance = 0.01 * load;
  options.max_samples_per_cycle = 1024;
  const auto response = periodic_response(system, 1 / frequency, 1, options);
  BOOST_TEST(response.converged);
  BOOST_TEST(response.samples_per_cycle > 32);
  BOOST_TEST(response.samples_per_cycle < 1024);
  BOOST_REQUIRE(response.time.size() == response.samples_per_cycle);
  BOOST_REQUIRE(response.displacement.cols() == response.samples_per_cycle);
  BOOST_TEST(response.coarse_difference <= *options.sampling_tolerance);
  record.at_most("largest error of a displacement over the static deflection", "",
                 motion_error(response, integrated(system, 1 / frequency, 80, 1024, 1e-14)) / (load / 5e4), 0.01,
                 "what doubling the samples may change");
  // As many as allowed, where that is not enough: the solution of that sampling.
  options.max_samples_per_cycle = 32;
  const auto stopped = periodic_response(system, 1 / frequency, 1, options);
  BOOST_TEST(stopped.converged);
  BOOST_TEST(stopped.samples_per_cycle == 32);
  BOOST_TEST(stopped.coarse_difference > *options.sampling_tolerance);
  // Both solved to 1e-8 of the deflection.
  BOOST_TEST(largest(stopped.force - solve(system, 32, 1e-8).force) <= 1e-6 * load);
}

BOOST_AUTO_TEST_CASE(stages_agree_with_time_integration) {
  annulus::test::Verification record("Harmonic balance of planetary stages over an error period",
                                     "time integration from the same state, tolerance 1e-9");
  auto with_phases = stages::ring_paper();
  for (int n = 0; n < 5; ++n) {
    with_phases.planet_errors[n].eccentricity.phase = 1.3 * n;
    with_phases.planet_errors[n].position.phase = 0.4 + 2.1 * n;
  }
  auto single = stages::ring_paper();
  single.sun.support = 1e9;  // one planet pushes the sun aside
  single.planet_angles.resize(1);
  single.planet_errors.resize(1);
  for (auto* list : {&single.sun_phase_lag, &single.ring_phase_lag, &single.ring_tooth_offset}) list->resize(1);
  for (const auto& stage : {stages::ring_paper(), with_phases, single}) {
    PeriodicOptions options;
    options.tolerance = 1e-8;
    const auto response = periodic_response(stage, options);
    BOOST_TEST(response.converged);
    BOOST_REQUIRE(response.time.size() == 55 * 32);
    // From its own state at time 0 the stage follows it: the state is part of the test.
    const auto system = assemble(stage);
    auto workspace = system.workspace();
    SystemState state;
    state.q = response.displacement.col(0);
    state.v = response.velocity.col(0);
    IntegratorOptions integrator;
    integrator.relative_tolerance = 1e-9;
    double worst = 0, drift = 0;
    integrate(system, state, 55 / stage.mesh_frequency(), integrator, workspace,
              {.samples = 55 * 32, .sample = [&](int i, const SystemState& s) {
                 for (Eigen::Index m = 0; m < response.force.rows(); ++m)
                   worst = std::max(worst, std::abs(workspace.force[m] - response.force(m, i)));
                 drift = std::max(drift, largest(s.q - response.displacement.col(i)));
               }});
    // Harmonics above the 16th are left out: the difference to half the samples bounds that; and 1e-9 x some 1e4 steps.
    BOOST_TEST(response.coarse_difference <= 1e-5 * stage.mean_mesh_force());
    record.at_most("largest difference of a mesh force over the mean force", "", worst / stage.mean_mesh_force(), 1e-6,
                   "harmonics above the 16th, 1e4 steps of 1e-9");
    // m; displacements are some 1e-4. A single planet out of balance lets the stage wander around, at no force.
    if (stage.planets() > 1)
      record.at_most("largest difference of a degree of freedom", "m", drift, 1e-6 * 1e-4,
                     "a millionth of the displacements");
  }
}

BOOST_AUTO_TEST_CASE(transfer_functions_are_those_of_the_matrices) {
  using Complex = std::complex<double>;
  annulus::test::Verification record("Transfer functions between the meshes of a turning stage",
                                     "dense complex solve of the matrices at three frequencies");
  auto stage = stages::ring_paper();
  stage.carrier_speed = 200;
  const auto system = assemble(stage);
  const Eigen::VectorXd k = Eigen::VectorXd::LinSpaced(10, 1e9, 2e9);
  const FrequencyResponse response(system, k);
  BOOST_TEST(response.by_eigenvalues());
  const double spacing = 700;
  const Eigen::Index lines = 40;
  const Eigen::VectorXd rates = Eigen::VectorXd::LinSpaced(lines, spacing, lines * spacing);
  const auto transfer = response.mesh_transfer(rates);
  const Eigen::MatrixXcd q = response.displacements(rates, Eigen::MatrixXcd::Constant(10, lines, Complex(1, 0.3)));
  for (const Eigen::Index j : {0, 7, 39}) {
    const double w = static_cast<double>(j + 1) * spacing;
    Eigen::MatrixXcd dynamic =
        (system.stiffness() + system.rotating_stiffness() - w * w * system.mass()).cast<Complex>();
    dynamic += Complex(0, w) * (system.damping() + system.gyroscopic()).cast<Complex>();
    for (int m = 0; m < 10; ++m) {
      const Eigen::VectorXcd b = system.mesh_vector(m).cast<Complex>();
      dynamic += Complex(k[m], w * system.meshes()[m].damping) * b * b.transpose();
    }
    const Eigen::MatrixXcd b = response.mesh_vectors().cast<Complex>();
    const Eigen::MatrixXcd solved = dynamic.partialPivLu().solve(b);
    const Eigen::MatrixXcd expected = b.transpose() * solved;
    // Rounding times the condition of the eigenvectors; the class itself demands 1e-9.
    const char* origin = "rounding x condition of the eigenvectors";
    record.at_most("real part, error over the largest entry", "",
                   largest(transfer.middleCols(20 * j, 10) - expected.real()) / largest(expected.cwiseAbs()), 1e-9,
                   origin);
    record.at_most("imaginary part, error over the largest entry", "",
                   largest(transfer.middleCols(20 * j + 10, 10) - expected.imag()) / largest(expected.cwiseAbs()), 1e-9,
                   origin);
    const Eigen::VectorXcd expected_q = solved * Eigen::VectorXcd::Constant(10, Complex(1, 0.3));
    BOOST_TEST(largest((q.col(j) - expected_q).cwiseAbs()) <= 1e-8 * largest(expected_q.cwiseAbs()));
  }
  // Critical damping: the eigenvectors coincide.
  MeshedMass critical;
  critical.mesh.damping = 2 * std::sqrt(5e4 * 2);
  const FrequencyResponse fallback(critical.system(), Eigen::VectorXd::Constant(1, 5e4));
  const double w = 100;
  const Complex expected = 1.0 / Complex(5e4 - 2 * w * w, w * critical.mesh.damping);
  const auto found = fallback.mesh_transfer(Eigen::VectorXd::Constant(1, w));
  BOOST_TEST(std::abs(Complex(found(0, 0), found(0, 1)) - expected) <= 1e-9 * std::abs(expected));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_solved_is_said) {
  // Rattling through a wide gap: far from the linear start, and one iteration is not enough.
  MeshedMass mass;
  mass.mesh.errors = {{2e-3, 2 * std::numbers::pi * frequency, 0}};
  mass.mesh.half_backlash = 5e-3;
  PeriodicOptions options;
  options.max_iterations = 1;
  const auto response = periodic_response(mass.system(), 1 / frequency, 1, options);
  BOOST_TEST(!response.converged);
  BOOST_TEST(!response.trouble.empty());
  BOOST_TEST(response.residual > options.tolerance);
  options.samples_per_cycle = 20;
  BOOST_CHECK_THROW((void)periodic_response(mass.system(), 1 / frequency, 1, options), annulus::InputError);
  auto free_ring = stages::ring_paper();
  free_ring.ring.torsional_support = 0;
  BOOST_CHECK_THROW((void)periodic_response(free_ring), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
