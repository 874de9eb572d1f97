#include "benchmarks/calculix/contact_job.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "benchmarks/calculix/deck.h"

namespace annulus::benchmarks {
namespace {

class Deck {
 public:
  Deck(const ContactJob& job, const std::filesystem::path& file) : job_(job), out_(fmt::output_file(file.string())) {
    write_body(out_, *job.planet, "planet", 0, 0);
    write_body(out_, *job.wheel, "wheel", planet_nodes(), static_cast<int>(job.planet->cells.size()));
    node_set("hub", job.planet->nodes_on(geometry::Boundary::support), 0);
    node_set("support", job.wheel->nodes_on(geometry::Boundary::support), planet_nodes());
    write_material(out_, job.material, {"planet", "wheel"});
    contact();
    out_.print("*BOUNDARY\nsupport, 1, 2\n");
    for (const double rotation : job.hub_rotations) step(rotation);
  }

 private:
  [[nodiscard]] int planet_nodes() const { return static_cast<int>(job_.planet->nodes.size()); }

  void node_set(const std::string& name, const std::vector<int>& nodes, int first_node) {
    out_.print("*NSET, NSET={}\n", name);
    for (const int node : nodes) out_.print("{},\n", first_node + node + 1);
  }
  void surface(const std::string& name, const QuadraticBody& body, geometry::Boundary flank, int tooth,
               int first_cell) {
    out_.print("*SURFACE, NAME={}, TYPE=ELEMENT\n", name);
    for (const auto& side : body.sides)
      if (side.boundary == flank && side.tooth == tooth)
        out_.print("{}, S{}\n", first_cell + side.cell + 1, side.number + 1);
  }
  void contact() {
    write_interaction(out_, job_.contact_stiffness);
    for (std::size_t i = 0; i < job_.pairs.size(); ++i) {
      surface(fmt::format("planet{}", i), *job_.planet, job_.planet_flank, job_.pairs[i].first, 0);
      surface(fmt::format("wheel{}", i), *job_.wheel, job_.wheel_flank, job_.pairs[i].second,
              static_cast<int>(job_.planet->cells.size()));
      out_.print("*CONTACT PAIR, INTERACTION=flanks, TYPE=SURFACE TO SURFACE\nplanet{}, wheel{}\n", i, i);
    }
  }
  /// A small rotation of the hub as displacements of its nodes; the whole of it at once.
  void step(double rotation) {
    out_.print("*STEP\n*STATIC, DIRECT\n1., 1.\n*BOUNDARY\n");
    for (const int node : job_.planet->nodes_on(geometry::Boundary::support)) {
      const Eigen::Vector2d arm = job_.planet->nodes[node] - job_.planet_axis;
      out_.print("{}, 1, 1, {}\n{}, 2, 2, {}\n", node + 1, deck_field(-rotation * arm.y() / deck_mm), node + 1,
                 deck_field(rotation * arm.x() / deck_mm));
    }
    out_.print("*NODE PRINT, NSET=hub\nRF\n*END STEP\n");
  }

  const ContactJob& job_;
  fmt::ostream out_;
};

/// Torque of the hub's reactions about the planet's axis at the end of every step, N m per m of width. Steps last one
/// unit of time; those that CalculiX has cut into increments give tables in between, too.
std::vector<double> read_torques(const ContactJob& job, const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<double> torques;
  std::string line;
  bool wanted = false;
  const std::string heading = "for set HUB and time";
  while (std::getline(in, line)) {
    if (const auto found = line.find(heading); found != std::string::npos) {
      wanted = std::stod(line.substr(found + heading.size())) == static_cast<double>(torques.size() + 1);
      if (wanted) torques.push_back(0);
      continue;
    }
    int node = 0;
    double fx = 0, fy = 0, fz = 0;
    std::istringstream row(line);
    if (!wanted || !(row >> node >> fx >> fy >> fz)) continue;
    const Eigen::Vector2d arm = job.planet->nodes[node - 1] - job.planet_axis;
    torques.back() += (arm.x() * fy - arm.y() * fx) / (slice_width * deck_mm);
  }
  return torques;
}

}  // namespace

bool calculix_is_installed() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

ContactJobResult run_calculix(const ContactJob& job, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  { const Deck deck(job, folder / "job.inp"); }
  const auto run = run_deck(folder, job.threads);
  ContactJobResult result;
  result.wall_seconds = run.wall_seconds;
  result.cpu_seconds = run.cpu_seconds;
  result.iterations = run.iterations;
  result.failure = run.failure;
  result.torque = read_torques(job, folder / "job.dat");
  if (result.failure.empty() && result.torque.size() != job.hub_rotations.size())
    result.failure = "ccx did not finish, see " + (folder / "job.log").string();
  return result;
}

}  // namespace annulus::benchmarks
