// Nanoseconds of one right-hand side of the stage of the ring paper (24 DOFs, 10 meshes) and of a helical stage in
// space (6 meshes along their faces), and the same equations with dense matrices of Eigen as the peer.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "core/units.h"
#include "dynamics/system/lumped_system.h"
#include "tests/dynamics/lumped_stages.h"
#include "tests/dynamics/stages.h"
#include "tests/dynamics/tables.h"

namespace {

using namespace annulus;
using namespace annulus::dynamics;

struct Case {
  std::string name;
  PlanetaryStage stage;
};

/// A ring through which each mesh takes some tenths of its own deflection from its neighbours.
std::shared_ptr<const RingCoupling> coupled_ring(int planets, int teeth) {
  auto ring = std::make_shared<RingCoupling>();
  ring->planets = planets;
  ring->ring_teeth = teeth;
  ring->per_cycle = 4;
  for (int i = 0; i < 27 * ring->per_cycle; ++i) {
    auto& d = ring->compliance.emplace_back(Eigen::MatrixXd::Zero(planets, planets));
    for (int n = 0; n < planets; ++n)
      for (int m = 0; m < n; ++m) d(n, m) = d(m, n) = 1e-10 * std::cos(n - m) * (1 + 0.1 * std::cos(0.1 * i));
  }
  return ring;
}

/// Excitations of sun and ring meshes from tables of a stage.
PlanetaryStage on_tables(PlanetaryStage stage, LoadDependence dependence) {
  const double load = stage.mean_mesh_force();
  const auto sun = tables::BentTable{.mesh = "sun_planet", .mean = 1.364e9, .ripple = 0.2, .nominal = load}.table();
  const auto ring = tables::BentTable{.nominal = load, .positions = 27}.table();
  stage.sun_mesh = table_stiffness(sun, load, 0, dependence);
  stage.ring_mesh = table_stiffness(ring, load, 0, dependence);
  return stage;
}

/// All bodies move along the axis and tilt; the meshes are spread over their faces.
PlanetaryStage helical_in_space() {
  auto stage = stages::reliability_stage(7.5 * units::deg);
  stages::lumped_in_space::add_all_bearings(stage);
  return on_tables(stages::lumped_in_space::lumped(stage), LoadDependence::table);
}

/// M q'' = f - (C + G) q' - (K + K_Omega) q - B F with dense matrices.
class DensePeer {
 public:
  explicit DensePeer(const LumpedSystem& system)
      : system_(system),
        factor_(system.mass()),
        stiffness_(system.stiffness() + system.rotating_stiffness()),
        damping_(system.damping() + system.gyroscopic()),
        b_(system.mesh_vectors()),
        force_(b_.cols()),
        approach_(b_.cols()),
        approach_rate_(b_.cols()),
        right_(system.dofs()) {}
  void operator()(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy, LumpedSystem::Workspace& w) {
    const auto n = right_.size();
    const auto q = y.head(n), v = y.tail(n);
    approach_.noalias() = b_.transpose() * q;
    approach_rate_.noalias() = b_.transpose() * v;
    system_.evaluate_forces(t, approach_.data(), approach_rate_.data(), w);
    right_ = system_.load();
    right_.noalias() -= stiffness_ * q;
    right_.noalias() -= damping_ * v;
    right_.noalias() -= b_ * Eigen::Map<const Eigen::VectorXd>(w.force.data(), b_.cols());
    factor_.solveInPlace(right_);
    dy.head(n) = v;
    dy.tail(n) = right_;
  }

 private:
  const LumpedSystem& system_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd stiffness_, damping_, b_;
  Eigen::VectorXd force_, approach_, approach_rate_, right_;
};

/// Smallest nanoseconds per call of several rounds: what the machine does when nothing else runs.
template <class Call>
double nanoseconds(int rounds, int calls, Call call) {
  double best = 1e99;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call(round * calls + i);
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / calls);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 200, calls = 2000;
  CLI::App app{"Time of one right-hand side of a planetary stage"};
  app.add_option("--rounds", rounds, "rounds; the fastest counts")->capture_default_str();
  app.add_option("--calls", calls, "evaluations in a round")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const auto plane = stages::ring_paper();
  const auto law = on_tables(plane, LoadDependence::table);
  auto coupled = law;
  coupled.ring_coupling = coupled_ring(plane.planets(), plane.ring_teeth);
  const std::vector<Case> cases = {{"harmonic", plane},
                                   {"table, linear", on_tables(plane, LoadDependence::nominal)},
                                   {"table, law", law},
                                   {"law, coupled", coupled},
                                   {"law, faces", helical_in_space()}};
  fmt::print("{:<14} {:>8} {:>12} {:>12} {:>8} {:>14}\n", "mesh", "DOFs", "ns", "dense, ns", "ratio", "ns per mesh");
  bool right = true;
  for (const auto& c : cases) {
    const auto& stage = c.stage;
    const auto system = assemble(stage);
    const int n = system.dofs();
    auto w = system.workspace();
    // Meshes closed by the nominal deflection and a little different from each other, so that all carry.
    Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * n), dy(2 * n), expected(2 * n);
    for (int i = 0; i < n; ++i) y[i] = 1e-6 * std::sin(i), y[n + i] = 1e-3 * std::cos(i);
    y[system.find("sun_u")] += 1.5e-4;
    for (int p = 1; p <= stage.planets(); ++p) y[system.find("planet" + std::to_string(p) + "_y")] -= 9e-5;
    system.detect_contact(0, y.data(), w);
    DensePeer peer(system);
    const double step = 1 / stage.mesh_frequency() / 40;
    const double own = nanoseconds(rounds, calls, [&](int i) { system.rhs(i * step, y.data(), dy.data(), w); });
    const double dense = nanoseconds(rounds, calls, [&](int i) { peer(i * step, y, expected, w); });
    fmt::print("{:<14} {:>8} {:>12.0f} {:>12.0f} {:>8.2f} {:>14.0f}\n", c.name, n, own, dense, dense / own,
               own / (2 * stage.planets()));
    const double t = 0.0123;
    system.detect_contact(t, y.data(), w);  // the peer's states follow the deflections
    system.rhs(t, y.data(), dy.data(), w);
    peer(t, y, expected, w);
    // Both round sums of some ten terms.
    const double difference = (dy - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
    if (!(difference <= 1e-12)) {
      fmt::print(stderr, "the two right-hand sides differ by {:.2e}\n", difference);
      right = false;
    }
  }
  return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
