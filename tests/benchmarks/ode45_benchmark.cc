// Time integration against ode45 of GNU Octave: the same stage, start and tolerances. Exit status 77: no Octave.

#include <fmt/format.h>
#include <fmt/os.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include "benchmarks/stopwatch.h"
#include "dynamics/stages.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/time_integration/integrate.h"

namespace {

using namespace annulus::dynamics;
using annulus::benchmarks::Stopwatch;

constexpr int table_phases = 32;

struct Options {
  double tolerance = 1e-6;
  int ode45_cycles = 3;  ///< mesh cycles given to Octave, and to both for the comparison of their errors
  int cycles = 200;      ///< mesh cycles over which annulus is timed
};

void print_matrix(fmt::ostream& out, const std::string& name, const Eigen::MatrixXd& m) {
  out.print("{} = [", name);
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) out.print("{:.17g} ", m(i, j));
    out.print(";\n");
  }
  out.print("];\n");
}

/// The curve as a piecewise polynomial of Octave: knots and the coefficients of every piece, highest power first.
void print_curve(fmt::ostream& out, const std::string& name, const annulus::PeriodicCurve& curve, int pieces) {
  Eigen::MatrixXd coefficients(pieces, 4);
  const double h = 1.0 / pieces;
  for (int i = 0; i < pieces; ++i) {
    const double y = curve(i * h), rise = curve((i + 1) * h) - y;
    const double low = curve.derivative(i * h) * h, high = curve.derivative((i + 1) * h) * h;
    coefficients.row(i) << (low + high - 2 * rise) / (h * h * h), (3 * rise - 2 * low - high) / (h * h), low / h, y;
  }
  print_matrix(out, "coefficients", coefficients);
  out.print("p.{} = mkpp(linspace(0, 1, {}), coefficients);\n", name, pieces + 1);
}

/// k per mesh, as an expression of Octave in t.
std::string stiffness_expression(fmt::ostream& out, const LumpedSystem& system) {
  const auto& first = system.meshes().front().excitation;
  Eigen::MatrixXd law(system.meshes().size(), 4);
  for (Eigen::Index m = 0; m < law.rows(); ++m) {
    const auto& mesh = system.meshes()[static_cast<std::size_t>(m)];
    law.row(m) << 0, 0, mesh.frequency, mesh.phase_offset;
    if (const auto* wave = std::get_if<HarmonicStiffness>(&mesh.excitation)) {
      law(m, 0) = wave->mean;
      law(m, 1) = wave->mean * wave->ripple;
    }
  }
  print_matrix(out, "p.law", law);
  if (std::holds_alternative<HarmonicStiffness>(first))
    return "p.law(:,1) + p.law(:,2) .* cos(2 * pi * (p.law(:,3) * t + p.law(:,4)))";
  const auto half = system.meshes().size() / 2;
  print_curve(out, "sun", std::get<TableStiffness>(first).secant, table_phases);
  print_curve(out, "ring", std::get<TableStiffness>(system.meshes()[half].excitation).secant, table_phases);
  return fmt::format(
      "[ppval(p.sun, mod(p.law(1:{0},3) * t + p.law(1:{0},4), 1)); "
      "ppval(p.ring, mod(p.law({1}:end,3) * t + p.law({1}:end,4), 1))]",
      half, half + 1);
}

/// The equations of `system` with all meshes at once, as an Octave user would vectorise them.
void write_script(const LumpedSystem& system, const SystemState& start, double end, double tolerance,
                  double absolute_tolerance, const std::filesystem::path& file, const std::filesystem::path& result) {
  auto out = fmt::output_file(file.string());
  const int n = system.dofs();
  const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass());
  const Eigen::MatrixXd b = system.mesh_vectors();
  std::size_t terms = 0;
  for (const auto& mesh : system.meshes()) terms = std::max(terms, mesh.errors.size());
  const auto columns = static_cast<Eigen::Index>(terms);
  Eigen::MatrixXd amount = Eigen::MatrixXd::Zero(meshes, columns), rate = amount, phase = amount, contact(meshes, 2);
  for (Eigen::Index m = 0; m < meshes; ++m) {
    const auto& mesh = system.meshes()[static_cast<std::size_t>(m)];
    for (std::size_t i = 0; i < mesh.errors.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      amount(m, column) = mesh.errors[i].amount;
      rate(m, column) = mesh.errors[i].rate;
      phase(m, column) = mesh.errors[i].phase;
    }
    contact.row(m) << mesh.damping, mesh.half_backlash.value();
  }
  Eigen::VectorXd state(2 * n);
  state << start.q, start.v;
  // Velocities count as in annulus: a displacement at the mesh frequency.
  Eigen::VectorXd absolute = Eigen::VectorXd::Constant(2 * n, absolute_tolerance);
  absolute.tail(n) *= 2 * std::numbers::pi * system.meshes().front().frequency;
  out.print("1;\n");
  const std::string stiffness = stiffness_expression(out, system);
  out.print(R"(function dy = rhs(t, y, p)
  q = y(1:p.n); v = y(p.n+1:end);
  angle = p.rate * t + p.phase;
  d = p.Bt * q - sum(p.amount .* sin(angle), 2);
  dd = p.Bt * v - sum(p.amount .* p.rate .* cos(angle), 2);
  k = {};
  gap = p.contact(:,2);
  closed = abs(d) > gap;
  F = closed .* (k .* (d - sign(d) .* gap) + p.contact(:,1) .* dd);
  dy = [v; p.a0 - p.K * q - p.C * v - p.B * F];
endfunction
)",
            stiffness);
  out.print("p.n = {};\n", n);
  print_matrix(out, "p.Bt", b.transpose());
  print_matrix(out, "p.B", mass.solve(b));
  print_matrix(out, "p.K", mass.solve(system.stiffness() + system.rotating_stiffness()));
  print_matrix(out, "p.C", mass.solve(system.damping() + system.gyroscopic()));
  print_matrix(out, "p.a0", mass.solve(system.load()));
  print_matrix(out, "p.amount", amount);
  print_matrix(out, "p.rate", rate);
  print_matrix(out, "p.phase", phase);
  print_matrix(out, "p.contact", contact);
  print_matrix(out, "y0", state);
  print_matrix(out, "atol", absolute);
  out.print("opt = odeset('RelTol', {:.17g}, 'AbsTol', atol, 'Refine', 1);\n", tolerance);
  out.print("start = cputime;\n");
  out.print("[t, y] = ode45(@(t, y) rhs(t, y, p), [0 {:.17g}], y0, opt);\n", end);
  out.print("seconds = cputime - start;\n");
  out.print("f = fopen('{}', 'w'); fprintf(f, '%.17g ', seconds, numel(t) - 1, y(end,:)); fclose(f);\n",
            result.string());
}

struct Peer {
  double seconds = 0, steps = 0;
  Eigen::VectorXd state;
};

Peer run_ode45(const LumpedSystem& system, const SystemState& start, double end, const Options& options,
               double absolute_tolerance) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("annulus_ode45_{}", getpid());
  std::filesystem::create_directories(folder);
  const auto script = folder / "stage.m", result = folder / "result.txt";
  write_script(system, start, end, options.tolerance, absolute_tolerance, script, result);
  const std::string command = fmt::format("octave-cli --norc --no-gui --quiet '{}'", script.string());
  Peer peer;
  if (std::system(command.c_str()) != 0) return peer;
  std::ifstream in(result);
  peer.state.resize(2 * system.dofs());
  in >> peer.seconds >> peer.steps;
  for (double& value : peer.state) in >> value;
  if (!in) peer.seconds = 0;
  std::filesystem::remove_all(folder);
  return peer;
}

/// Largest error of the displacements after the short run, relative to the deflection of the sun meshes.
double error_of(const Eigen::VectorXd& state, const Eigen::VectorXd& reference, double deflection) {
  const auto n = state.size() / 2;
  return (state.head(n) - reference.head(n)).cwiseAbs().maxCoeff() / deflection;
}

SystemState advance(const LumpedSystem& system, SystemState state, double end, double tolerance, double absolute,
                    IntegratorStatistics* statistics = nullptr) {
  IntegratorOptions integrator;
  integrator.relative_tolerance = tolerance;
  integrator.absolute_tolerance = absolute;
  auto workspace = system.workspace();
  const auto s = integrate(system, state, end, integrator, workspace);
  if (statistics) *statistics = s;
  return state;
}

/// A table in the shape of the stage's harmonic stiffness with a second harmonic, as finite elements give it.
TableStiffness table_like(const MeshExcitation& excitation) {
  const auto& wave = std::get<HarmonicStiffness>(excitation);
  std::vector<double> values;
  for (int i = 0; i < table_phases; ++i) {
    const double angle = 2 * std::numbers::pi * i / table_phases;
    values.push_back(wave.mean * (1 + wave.ripple * (std::cos(angle) + 0.3 * std::cos(2 * angle + 1))));
  }
  const annulus::PeriodicCurve curve(values, table_phases);
  return {curve, curve, annulus::PeriodicCurve(std::vector<double>(table_phases, 0.0), table_phases)};
}

int compare(const PlanetaryStage& stage, const std::string& stiffness, const Options& options) {
  const LumpedSystem system = assemble(stage);
  const double cycle = 1 / stage.mesh_frequency(), end = options.ode45_cycles * cycle;
  const double deflection = stage.mean_mesh_force() / mean_stiffness(stage.sun_mesh);
  const double absolute = 0.1 * options.tolerance * deflection;
  SystemState start;
  auto workspace = system.workspace();
  StaticSolver solver(system);
  start.q = solver.solve(0, workspace);
  start.v = Eigen::VectorXd::Zero(system.dofs());

  const Peer peer = run_ode45(system, start, end, options, absolute);
  if (peer.seconds == 0) {
    fmt::print(stderr, "ode45 gave no result\n");
    return 1;
  }
  const auto exact = advance(system, start, end, 1e-12, 1e-6 * absolute);
  Eigen::VectorXd reference(2 * system.dofs());
  reference << exact.q, exact.v;
  const auto ours = advance(system, start, end, options.tolerance, absolute);
  Eigen::VectorXd state(2 * system.dofs());
  state << ours.q, ours.v;
  const double our_error = error_of(state, reference, deflection);
  const double peer_error = error_of(peer.state, reference, deflection);

  IntegratorStatistics statistics;
  const Stopwatch watch;
  (void)advance(system, start, options.cycles * cycle, options.tolerance, absolute, &statistics);
  const double seconds = watch.cpu();
  const double per_cycle = seconds / options.cycles, peer_per_cycle = peer.seconds / options.ode45_cycles;
  fmt::print("\nring paper's stage, {} degrees of freedom, {} meshes, {} stiffness, relative tolerance {:g}\n",
             system.dofs(), system.meshes().size(), stiffness, options.tolerance);
  fmt::print("                                     annulus      ode45\n");
  fmt::print("processor time per mesh cycle, ms  {:9.4f}  {:9.1f}   ratio {:.0f}\n", 1e3 * per_cycle,
             1e3 * peer_per_cycle, peer_per_cycle / per_cycle);
  fmt::print("steps per mesh cycle               {:9.1f}  {:9.1f}\n",
             static_cast<double>(statistics.steps) / options.cycles, peer.steps / options.ode45_cycles);
  fmt::print("error after {:2d} cycles / deflection  {:9.1e}  {:9.1e}\n", options.ode45_cycles, our_error, peer_error);
  fmt::print("{} mesh cycles in annulus: {:.3f} s, {:.0f} right-hand sides per cycle\n", options.cycles, seconds,
             static_cast<double>(statistics.rhs_evaluations) / options.cycles);
  // Both control the error of a step, not of the end: a hundred times the tolerance is what some hundred steps may add
  // up to, and a different model would differ by much more.
  const double allowed = 100 * options.tolerance;
  if (our_error > allowed || peer_error > allowed) {
    fmt::print(stderr, "the errors exceed {:g}: the two do not solve the same equations, or not to the tolerance\n",
               allowed);
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Time integration of the ring paper's stage against ode45 of GNU Octave");
  app.add_option("--tolerance", options.tolerance, "Relative tolerance of both")->capture_default_str();
  app.add_option("--ode45-cycles", options.ode45_cycles, "Mesh cycles given to ode45")->capture_default_str();
  app.add_option("--cycles", options.cycles, "Mesh cycles over which annulus is timed")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (std::system("command -v octave-cli >/dev/null") != 0) {
    fmt::print("octave-cli is not installed: nothing to compare with\n");
    return 77;
  }
  try {
    PlanetaryStage stage = stages::ring_paper();
    const int harmonic = compare(stage, "harmonic", options);
    stage.sun_mesh = table_like(stage.sun_mesh);
    stage.ring_mesh = table_like(stage.ring_mesh);
    return std::max(harmonic, compare(stage, "tabulated", options));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
