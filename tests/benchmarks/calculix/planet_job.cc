#include "benchmarks/calculix/planet_job.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "benchmarks/calculix/deck.h"
#include "benchmarks/calculix/support_arc.h"
#include "core/errors.h"

namespace annulus::benchmarks {
namespace {

using geometry::Boundary;

int patch_node(const PlanetJob& job, int patch) { return static_cast<int>(job.body.nodes.size()) + patch + 1; }

/// N/mm of a slice, or N of it, from that of the whole width.
double per_slice(const PlanetJob& job, double value) { return value * slice_width * deck_mm / job.face_width; }

double patch_angle(const PlanetJob& job, int patch) {
  return job.bed.first_angle + patch * 2 * std::numbers::pi / job.bed.patches;
}

fem::SupportSite patch_arc(const PlanetJob& job, int patch) {
  return {patch_angle(job, patch), std::numbers::pi / job.bed.patches, false, {}};
}

void add(NodeForces& forces, int node, const Eigen::Vector2d& force) {
  forces.emplace(node, Eigen::Vector2d::Zero()).first->second += force;
}

/// Springs of the patches that press.
void write_springs(fmt::ostream& out, const PlanetJob& job, const std::vector<bool>& pressing) {
  for (int i = 0; i < job.bed.patches; ++i) {
    out.print("*NODE, NSET=patches\n{}, 0, 0, 0\n", patch_node(job, i));
    write_mean_displacement(out, {job.body, 0}, patch_arc(job, i), patch_angle(job, i), patch_node(job, i), 1);
  }
  out.print("*ELEMENT, TYPE=SPRING1, ELSET=bed\n");
  int number = static_cast<int>(job.body.cells.size());
  for (int i = 0; i < job.bed.patches; ++i)
    if (pressing[static_cast<std::size_t>(i)]) out.print("{}, {}\n", ++number, patch_node(job, i));
  out.print("*SPRING, ELSET=bed\n1\n{}\n", spring_field(per_slice(job, job.bed.stiffness) * deck_mm));
}

/// The force -k (u + play) of a pressed patch: its second part.
NodeForces forces_of_play(const PlanetJob& job, const std::vector<bool>& pressing) {
  NodeForces forces;
  for (int i = 0; i < job.bed.patches; ++i) {
    if (!pressing[static_cast<std::size_t>(i)]) continue;
    const double angle = patch_angle(job, i), force = -job.bed.stiffness * job.bed.play;
    for (const auto& [node, share] : support_shares(job.body, patch_arc(job, i)))
      add(forces, node, share * force * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return forces;
}

/// The node of the bore next to the x axis, which is fixed against rotation: loads leave nothing for it to carry.
int held_node(const PlanetJob& job) {
  const auto bore = job.body.nodes_on(Boundary::support);
  return *std::max_element(bore.begin(), bore.end(),
                           [&](int a, int b) { return job.body.nodes[a].x() < job.body.nodes[b].x(); });
}

/// Shares of the displacements of the bore's nodes in its mean rotation, 1/m.
NodeForces rotation_shares(const PlanetJob& job) {
  NodeForces shares;
  for (const double middle : {0.0, std::numbers::pi})  // both halves
    for (const auto& [node, share] : support_shares(job.body, {middle, std::numbers::pi / 2, false, {}})) {
      const Eigen::Vector2d& arm = job.body.nodes[node];
      add(shares, node, share / 2 / arm.squaredNorm() * Eigen::Vector2d(-arm.y(), arm.x()));
    }
  return shares;
}

/// The further forces with an even traction around the bore that takes their torque.
NodeForces balanced(const PlanetJob& job) {
  double torque = 0;
  for (const auto& [node, force] : job.more) {
    const Eigen::Vector2d& arm = job.body.nodes[node];
    torque += arm.x() * force.y() - arm.y() * force.x();
  }
  auto forces = job.more;
  for (const auto& [node, share] : rotation_shares(job)) add(forces, node, -torque * share);
  return forces;
}

void write_deck(const PlanetJob& job, const std::vector<bool>& pressing, const std::filesystem::path& file) {
  auto out = fmt::output_file(file.string());
  write_body(out, job.body, "planet", 0, 0);
  // Without a law of contact CalculiX 2.20 makes no room for the degrees of freedom of springs.
  write_interaction(out, deck_MPa / deck_mm);
  write_springs(out, job, pressing);
  write_material(out, job.material, {"planet"});
  out.print("*NSET, NSET=loaded\n");
  for (const auto& [node, force] : job.load) out.print("{},\n", node + 1);
  out.print("*NSET, NSET=bore\n");
  for (const int node : job.body.nodes_on(Boundary::support)) out.print("{},\n", node + 1);
  out.print("*BOUNDARY\npatches, 2, 3\n{}, 2, 2\n", held_node(job) + 1);
  auto whole = job.load;
  for (const auto& [node, force] : forces_of_play(job, pressing)) add(whole, node, force);
  for (const auto& load : {whole, balanced(job)}) {
    out.print("*STEP\n*STATIC\n*CLOAD, OP=NEW\n");
    for (const auto& [node, force] : load)
      for (const int component : {1, 2})
        out.print("{}, {}, {}\n", node + 1, component, deck_field(per_slice(job, force[component - 1])));
    out.print("*NODE PRINT, NSET=patches\nU\n*NODE PRINT, NSET=loaded\nU\n*NODE PRINT, NSET=bore\nU\n");
    out.print("*EL FILE, NSET=bore, OUTPUT=2D\nS\n*END STEP\n");
  }
}

/// Stresses xx, yy and xy, MPa, of the nodes in the results of every step: lines " -1", the node in ten columns, then
/// six values of twelve, below a heading " -4  STRESS".
std::vector<std::map<int, Eigen::Vector3d>> read_stresses(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::map<int, Eigen::Vector3d>> steps;
  std::string line;
  bool wanted = false;
  constexpr std::size_t node_at = 3, node_columns = 10, value_columns = 12;
  const auto value = [&](int i) {
    return std::stod(line.substr(node_at + node_columns + static_cast<std::size_t>(i) * value_columns, value_columns));
  };
  while (std::getline(in, line)) {
    const auto kind = line.substr(0, node_at);
    if (kind == " -4") {
      wanted = line.find("STRESS") != std::string::npos;
      if (wanted) steps.emplace_back();
    } else if (kind == " -3") {
      wanted = false;
    } else if (wanted && kind == " -1") {
      steps.back()[std::stoi(line.substr(node_at, node_columns))] = {value(0), value(1), value(3)};
    }
  }
  return steps;
}

/// Results under both loads.
struct Solved {
  std::vector<std::map<int, Eigen::Vector2d>> patches, loaded, bore;  ///< mm
  std::vector<std::map<int, Eigen::Vector3d>> stresses;               ///< MPa
  [[nodiscard]] bool complete() const {
    return patches.size() == 2 && loaded.size() == 2 && bore.size() == 2 && stresses.size() == 2;
  }
};

Solved read_results(const std::filesystem::path& folder) {
  const auto file = folder / "job.dat";
  return {read_displacements(file, "PATCHES"), read_displacements(file, "LOADED"), read_displacements(file, "BORE"),
          read_stresses(folder / "job.frd")};
}

}  // namespace

PlanetJobResult run_calculix(const PlanetJob& job, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  PlanetJobResult result;
  // Those that a motion along the load closes.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& [node, force] : job.load) sum += force;
  std::vector<bool> pressing(static_cast<std::size_t>(job.bed.patches));
  const auto at = [](int patch) { return static_cast<std::size_t>(patch); };
  for (int i = 0; i < job.bed.patches; ++i)
    pressing[at(i)] = sum.dot(Eigen::Vector2d(std::cos(patch_angle(job, i)), std::sin(patch_angle(job, i)))) < 0;
  Solved solved;
  for (bool agrees = false; !agrees;) {
    constexpr int most = 20;
    if (result.solves++ == most) {
      result.failure = fmt::format("the patches that press are not found in {} solves", most);
      return result;
    }
    write_deck(job, pressing, folder / "job.inp");
    const auto run = run_deck(folder, job.threads);
    result.cpu_seconds += run.cpu_seconds;
    result.failure = run.failure;
    if (!result.failure.empty()) return result;
    solved = read_results(folder);
    if (!solved.complete()) {
      result.failure = "ccx did not finish, see " + (folder / "job.log").string();
      return result;
    }
    agrees = true;
    result.rollers.clear();
    for (int i = 0; i < job.bed.patches; ++i) {
      result.rollers.push_back(job.bed.force(solved.patches[0].at(patch_node(job, i)).x() * deck_mm));
      const bool presses = result.rollers.back() > 0;
      agrees = agrees && presses == pressing[at(i)];
      pressing[at(i)] = presses;
    }
  }
  double rotation = 0;
  for (const auto& [node, share] : rotation_shares(job)) rotation += share.dot(solved.bore[1].at(node + 1)) * deck_mm;
  for (const auto& [node, u] : solved.loaded[1]) {
    const Eigen::Vector2d& arm = job.body.nodes[node - 1];
    result.displacements[node - 1] = u * deck_mm - rotation * Eigen::Vector2d(-arm.y(), arm.x());
  }
  for (const int node : job.body.nodes_on(Boundary::support)) {
    const Eigen::Vector3d s = solved.stresses[0].at(node + 1) * deck_MPa;
    const Eigen::Vector2d arm = job.body.nodes[node].normalized(), along(-arm.y(), arm.x());
    result.bore_stress[node] =
        s[0] * along.x() * along.x() + s[1] * along.y() * along.y() + 2 * s[2] * along.x() * along.y();
  }
  return result;
}

}  // namespace annulus::benchmarks
