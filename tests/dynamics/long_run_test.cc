#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>

#include "dynamics/systems/planetary/response.h"
#include "dynamics/time_integration/integrator_choice.h"
#include "tests/dynamics/allocation_counter.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(long_runs)

using namespace annulus::dynamics;

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

long resident_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stol(line.substr(6));
  return 0;
}

struct Integrated {
  IntegratorStatistics statistics;
  double seconds = 0, worst = 0;  ///< N, largest force difference to the periodic response
};

/// One error period from the periodic response, sampled.
Integrated integrated_in_time(const PlanetaryStage& stage, const PeriodicResponse& periodic, Integrator method,
                              double tolerance) {
  const auto system = assemble(stage);
  auto workspace = system.workspace();
  SystemState state;
  state.q = periodic.displacement.col(0);
  state.v = periodic.velocity.col(0);
  IntegratorOptions options;
  options.method = method;
  options.relative_tolerance = tolerance;
  Integrated result;
  const double begin = processor_time();
  result.statistics =
      integrate(system, state, stage.error_period() / stage.mesh_frequency(), options, workspace,
                {.samples = static_cast<int>(periodic.time.size()), .sample = [&](int i, const SystemState&) {
                   for (Eigen::Index m = 0; m < periodic.force.rows(); ++m)
                     result.worst = std::max(result.worst, std::abs(workspace.force[m] - periodic.force(m, i)));
                 }});
  result.seconds = processor_time() - begin;
  return result;
}

BOOST_AUTO_TEST_CASE(the_chosen_integrator_is_the_cheaper_one) {
  annulus::test::Verification record("Chosen and rejected integrator over an error period",
                                     "the periodic response by harmonic balance");
  const double tolerance = 1e-6;
  const auto metal = stages::ring_paper();
  auto stiff = metal;
  stiff.ring.support = 1e13;
  stiff.support_damping_ratio = 3;
  PeriodicOptions options;
  options.tolerance = 1e-8;
  for (const auto& [stage, expected] :
       {std::pair(metal, Integrator::arkode_explicit), std::pair(stiff, Integrator::cvode_bdf)}) {
    const auto choice = choose_integrator(assemble(stage), tolerance);
    BOOST_TEST((choice.method == expected), choice.reason);
    BOOST_TEST(!choice.reason.empty());
    const auto other = expected == Integrator::cvode_bdf ? Integrator::arkode_explicit : Integrator::cvode_bdf;
    const auto periodic = periodic_response(stage, options);
    BOOST_TEST(periodic.converged);
    const auto chosen = integrated_in_time(stage, periodic, choice.method, tolerance),
               rejected = integrated_in_time(stage, periodic, other, tolerance);
    // Measured factors: three for metal, five for the stiff stage.
    BOOST_TEST(chosen.seconds < rejected.seconds);
    // Local errors within the tolerance add up over the decay time of the stage: a hundred of them.
    const char* origin = "tolerance x a decay time of a hundred steps";
    record.at_most("chosen: largest difference of a mesh force over the mean", "",
                   chosen.worst / stage.mean_mesh_force(), 100 * tolerance, origin);
    record.at_most("rejected: largest difference of a mesh force over the mean", "",
                   rejected.worst / stage.mean_mesh_force(), 100 * tolerance, origin);
    if (expected == Integrator::cvode_bdf) {
      BOOST_TEST(chosen.statistics.rhs_evaluations < rejected.statistics.rhs_evaluations / 10);
      // The stability limit is where the choice says (steps of the stiff stage are all at it): within 20 %.
      const double step = 55 / stage.mesh_frequency() / static_cast<double>(rejected.statistics.steps);
      BOOST_TEST(std::abs(step / choice.stability_step - 1) <= 0.2);
    }
  }
  // Stiff but ringing: BDF would have to follow 1e13 N/m through every cycle.
  stiff.support_damping_ratio = 0.03;
  BOOST_TEST((choose_integrator(assemble(stiff), tolerance).method == Integrator::arkode_explicit));
}

LumpedSystem small_system() {
  LumpedSystemBuilder builder;
  MeshElement mesh;
  mesh.name = "m";
  mesh.b = builder.add_dof("x");
  mesh.excitation = HarmonicStiffness{5e4, 0.2, 0};
  mesh.frequency = 70;
  mesh.damping = 60;
  mesh.half_backlash = 1e-3;
  builder.add_mass(mesh.b, 2);
  builder.add_load(mesh.b, 30);
  builder.add_mesh(mesh);
  return builder.build();
}

/// The small system on its way from beside its equilibrium.
class SmallRun {
 public:
  explicit SmallRun(const LumpedSystem& system) : system_(system), workspace_(system.workspace()) {
    state_.q = Eigen::VectorXd::Constant(1, 1.6e-3);
    state_.v = Eigen::VectorXd::Zero(1);
    options_.method = Integrator::arkode_explicit;
    options_.absolute_tolerance = 1e-9;
  }
  template <class Sample>
  IntegratorStatistics integrate_to(double end, int samples, Sample sample) {
    return integrate(system_, state_, end, options_, workspace_, {.samples = samples, .sample = sample});
  }

 private:
  const LumpedSystem& system_;
  LumpedSystem::Workspace workspace_;
  SystemState state_;
  IntegratorOptions options_;
};

BOOST_AUTO_TEST_CASE(memory_does_not_grow_with_the_length_of_a_run) {
  annulus::test::Verification record("Memory of a run of 20 000 mesh cycles",
                                     "a run of 200, every operator new counted; 160 000 stored states would be 4 MB");
  const auto system = small_system();
  const auto run = [&](int cycles) {
    SmallRun small(system);
    double sum = 0;
    const long before = allocations();
    small.integrate_to(cycles / 70.0, 8 * cycles, [&](int, const SystemState& s) { sum += s.q[0]; });
    BOOST_TEST(std::isfinite(sum));
    return allocations() - before;
  };
  const long brief = run(200);
  const long resident = resident_kilobytes();
  const long lengthy = run(20'000);
  const long grown = resident_kilobytes() - resident;
  record.near("allocations more than in the short run", "", static_cast<double>(lengthy - brief), 0, 0, "none");
  // SUNDIALS allocates with malloc, which the counter does not see.
  record.at_most("growth of the resident memory", "kB", static_cast<double>(grown), 1000, "a quarter of the states");
}

// Samples come from dense output: they cost no steps.
BOOST_AUTO_TEST_CASE(samples_do_not_force_steps) {
  const auto system = small_system();
  const auto steps = [&](int samples) {
    return SmallRun(system).integrate_to(1.0, samples, [](int, const SystemState&) {}).steps;
  };
  annulus::test::Verification record("Steps of an integration with 50 000 samples", "the same without samples");
  record.at_most("steps more or fewer", "", static_cast<double>(std::abs(steps(50'000) - steps(0))), 2,
                 "the last step may end elsewhere");
}

BOOST_AUTO_TEST_CASE(phases_stay_after_a_million_mesh_cycles) {
  annulus::test::Verification record("Phases after a million mesh cycles", "periodicity: those of the first period");
  auto stage = stages::ring_paper();
  std::vector<double> values;
  for (int i = 0; i < 64; ++i) values.push_back(1.87e9 * (1 + 0.13 * std::cos(2 * std::numbers::pi * i / 64)));
  const annulus::PeriodicCurve curve(values, 64);
  stage.ring_mesh = TableStiffness{curve, curve, annulus::PeriodicCurve({0.0}, 1), 0};
  const auto system = assemble(stage);
  auto early = system.workspace(), late = system.workspace();
  const double f = stage.mesh_frequency();
  const double period = 55 / f;
  for (const double cycles : {0.0, 0.37, 17.2, 54.9}) {
    const int periods = 18'182;  // a million mesh cycles
    system.evaluate_excitation(cycles / f, early);
    system.evaluate_excitation(cycles / f + periods * period, late);
    for (std::size_t m = 0; m < 10; ++m) {
      // Time has 2e-16 x 1e6 cycles x 2 pi = 1.4e-9 rad of rounding; ripples and errors are a fraction of that.
      const char* origin = "rounding of the time: 1.4e-9 rad";
      record.near("mesh stiffness, early over late", "", early.stiffness[m] / late.stiffness[m], 1, 1e-9, origin);
      record.near("error of a mesh", "m", late.error[m], early.error[m], 1e-9 * 1e-4, origin);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
