// The loaded mesh of the ring paper's held ring against CalculiX on the same gmsh mesh, position by position. Exit
// status 77: CalculiX is not installed.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "benchmarks/calculix/contact_job.h"
#include "benchmarks/stopwatch.h"
#include "fem/contact/flank_contact.h"
#include "fem/loaded_mesh.h"
#include "fem/ring_paper.h"

namespace {

using namespace annulus;
using benchmarks::ContactJob;

constexpr double load = 59460, face_width = 88e-3, bore = 86e-3, outside = 331.8e-3;  // N, m: ring paper
constexpr double accuracy = 0.01;  // largest difference of the transmission errors that is allowed

struct Options {
  std::vector<int> levels{1};
  std::vector<int> phases{0, 8};  ///< of `cycle`
  int cycle = 16;                 ///< positions of a whole mesh cycle
  int neighbours = 6;             ///< teeth beside those that may touch, either way
  double contact_stiffness = 2e16;
  int threads = 2;
  bool keep = false;  ///< the folders of CalculiX
};

struct Peer {
  double lte = 0;
  benchmarks::ContactJobResult run;
  std::size_t nodes = 0;
};

/// The same position in CalculiX: the hub is turned by annulus' transmission error, then by one per cent more, and the
/// rotation under the load lies on the line through both.
Peer solve_with_calculix(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& ours,
                         const fem::LoadedPosition& position, const Options& options) {
  const fem::FlankContact flanks(problem.pair);
  // Teeth more than a third of a base pitch from the path of contact stay apart: the gap there is some hundred
  // micrometres.
  const double reach = problem.pair.pinion().base_pitch() / 3;
  std::vector<double> rolls;
  for (const double roll : position.pair_roll)
    if (roll > problem.pair.roll_length_low() - reach && roll < problem.pair.roll_length_high() + reach)
      rolls.push_back(roll);
  const int touching = static_cast<int>(rolls.size());
  const benchmarks::Segment segment{-options.neighbours, touching - 1 + options.neighbours, 0, touching - 1};
  auto planet = make_segment(flanks.pinion(), ours.pinion_sector, bore, segment);
  auto wheel = make_segment(flanks.wheel(), ours.wheel_sector, outside, segment);
  ContactJob job;
  job.planet_axis = {problem.pair.centre_distance(), 0};
  planet.place(flanks.pinion_tooth_angle(rolls.front()), job.planet_axis);
  wheel.place(flanks.wheel_tooth_angle(rolls.front()), Eigen::Vector2d::Zero());
  job.planet = &planet;
  job.wheel = &wheel;
  for (int tooth = 0; tooth < touching; ++tooth) job.pairs.emplace_back(tooth, tooth);
  job.material = problem.materials.wheel;
  job.contact_stiffness = options.contact_stiffness;
  constexpr double more = 0.01;
  const double base = problem.pair.pinion().base_radius(), guess = position.entry.lte;
  job.hub_rotations = {guess / base, (1 + more) * guess / base};
  job.threads = options.threads;

  const auto folder = std::filesystem::temp_directory_path() / fmt::format("annulus_calculix_{}", getpid()) /
                      fmt::format("level{}_phase{:.4f}", ours.level, position.mesh_phase);
  Peer peer{0, run_calculix(job, folder), planet.nodes.size() + wheel.nodes.size()};
  if (!options.keep && peer.run.failure.empty()) std::filesystem::remove_all(folder.parent_path());
  if (peer.run.failure.empty()) {
    const double f0 = peer.run.torque[0] / base * face_width, f1 = peer.run.torque[1] / base * face_width;
    peer.lte = guess * (1 + more * (load - f0) / (f1 - f0));
  }
  return peer;
}

/// Whether all positions agree.
bool compare(int level, const Options& options) {
  fem::LoadedMeshProblem problem{tests::ring_paper_pair(true), {}, face_width, bore, outside, fem::OutsideHeld{}};
  problem.loads = {load};
  problem.phases = options.cycle;
  fem::LoadedMeshSettings settings;
  settings.level = level;
  settings.threads = options.threads;
  const benchmarks::Stopwatch watch;
  const auto ours = solve_loaded_mesh(problem, settings);
  const double our_wall = watch.wall(), our_cpu = watch.cpu();
  fmt::print(
      "\nlevel {}: annulus solves {} positions in {:.2f} s ({:.2f} s of processor time), estimated error {:.2g}\n",
      level, options.cycle, our_wall, our_cpu, ours.worst_error_relative);
  fmt::print("{:>7} {:>6} {:>9} {:>9} {:>11} {:>9} {:>7} {:>6} {:>8} {:>8}\n", "phase", "pairs", "LTE um", "ccx um",
             "difference", "estimate", "nodes", "iter.", "wall s", "cpu s");
  bool agree = true;
  double wall = 0, cpu = 0, worst = 0;
  for (const int phase : options.phases) {
    const auto& position = ours.positions.at(phase);
    const auto peer = solve_with_calculix(problem, ours, position, options);
    if (!peer.run.failure.empty()) {
      fmt::print("phase {:.4f}: {}\n", position.mesh_phase, peer.run.failure);
      return false;
    }
    const double difference = position.entry.lte / peer.lte - 1;
    const auto sharing =
        std::count_if(position.pair_share.begin(), position.pair_share.end(), [](double share) { return share > 0; });
    fmt::print("{:>7.4f} {:>6} {:>9.4f} {:>9.4f} {:>11.2e} {:>9.1e} {:>7} {:>6} {:>8.1f} {:>8.1f}\n",
               position.mesh_phase, sharing, position.entry.lte * 1e6, peer.lte * 1e6, difference,
               position.entry.error_relative, peer.nodes, peer.run.iterations, peer.run.wall_seconds,
               peer.run.cpu_seconds);
    std::fflush(stdout);
    wall += peer.run.wall_seconds, cpu += peer.run.cpu_seconds;
    worst = std::max(worst, std::abs(difference));
    agree = agree && std::abs(difference) < accuracy;
  }
  const double positions_per_run = static_cast<double>(options.cycle) / static_cast<double>(options.phases.size());
  fmt::print(
      "level {}: largest difference {:.2e}{}; a whole cycle costs CalculiX {:.0f} times the wall time and {:.0f} "
      "times the processor time\n",
      level, worst, agree ? "" : fmt::format(" IS ABOVE {}", accuracy), wall * positions_per_run / our_wall,
      cpu * positions_per_run / our_cpu);
  return agree;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"annulus against CalculiX on the same mesh of the ring paper's held ring"};
  app.add_option("--levels", options.levels, "levels of resolution")->capture_default_str();
  app.add_option("--phases", options.phases, "positions to solve with CalculiX, in fractions 1/cycle of the mesh cycle")
      ->capture_default_str();
  app.add_option("--cycle", options.cycle, "positions of a whole mesh cycle")->capture_default_str();
  app.add_option("--neighbours", options.neighbours, "teeth kept beside those that may touch")->capture_default_str();
  app.add_option("--contact-stiffness", options.contact_stiffness, "penalty of CalculiX, Pa/m")->capture_default_str();
  app.add_option("--threads", options.threads, "for both programs")->capture_default_str();
  app.add_flag("--keep", options.keep, "keep CalculiX's files");
  CLI11_PARSE(app, argc, argv);
  if (!benchmarks::calculix_is_installed()) {
    fmt::print("CalculiX (ccx) is not installed: nothing to compare with\n");
    return 77;
  }
  bool agree = true;
  for (const int level : options.levels) agree = compare(level, options) && agree;
  return agree ? EXIT_SUCCESS : EXIT_FAILURE;
}
