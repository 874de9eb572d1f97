#include "benchmarks/calculix/contact_job.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "benchmarks/stopwatch.h"

namespace annulus::benchmarks {
namespace {

// CalculiX is given mm, N and MPa: some of its tolerances are absolute and made for such numbers.
constexpr double mm = 1e-3, MPa = 1e6;
constexpr double width = 1;  // mm, of the slice

/// Free fields of an input deck are read to 20 characters only.
std::string field(double value) { return fmt::format("{:.12g}", value); }

class Deck {
 public:
  Deck(const ContactJob& job, const std::filesystem::path& file) : job_(job), out_(fmt::output_file(file.string())) {
    body(*job.planet, "planet", 0, 0);
    body(*job.wheel, "wheel", planet_nodes(), static_cast<int>(job.planet->cells.size()));
    node_set("hub", job.planet->nodes_on(geometry::Boundary::support), 0);
    node_set("support", job.wheel->nodes_on(geometry::Boundary::support), planet_nodes());
    material();
    contact();
    out_.print("*BOUNDARY\nsupport, 1, 2\n");
    for (const double rotation : job.hub_rotations) step(rotation);
  }

 private:
  [[nodiscard]] int planet_nodes() const { return static_cast<int>(job_.planet->nodes.size()); }

  void body(const QuadraticBody& body, const std::string& name, int first_node, int first_cell) {
    out_.print("*NODE\n");
    for (std::size_t i = 0; i < body.nodes.size(); ++i)
      out_.print("{}, {}, {}, 0\n", first_node + i + 1, field(body.nodes[i].x() / mm), field(body.nodes[i].y() / mm));
    out_.print("*ELEMENT, TYPE=CPE8, ELSET={}\n", name);
    for (std::size_t i = 0; i < body.cells.size(); ++i) {
      out_.print("{}", first_cell + i + 1);
      for (const int node : body.cells[i]) out_.print(", {}", first_node + node + 1);
      out_.print("\n");
    }
  }
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
  void material() {
    out_.print("*MATERIAL, NAME=steel\n*ELASTIC\n{}, {}\n", field(job_.material.youngs_modulus / MPa),
               field(job_.material.poisson_ratio));
    for (const char* part : {"planet", "wheel"})
      out_.print("*SOLID SECTION, ELSET={}, MATERIAL=steel\n{}\n", part, width);
  }
  void contact() {
    out_.print("*SURFACE INTERACTION, NAME=flanks\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{}\n",
               field(job_.contact_stiffness / MPa * mm));
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
      out_.print("{}, 1, 1, {}\n{}, 2, 2, {}\n", node + 1, field(-rotation * arm.y() / mm), node + 1,
                 field(rotation * arm.x() / mm));
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
    torques.back() += (arm.x() * fy - arm.y() * fx) / (width * mm);
  }
  return torques;
}

}  // namespace

bool calculix_is_installed() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

ContactJobResult run_calculix(const ContactJob& job, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  { const Deck deck(job, folder / "job.inp"); }
  const std::string command =
      fmt::format("cd '{}' && OMP_NUM_THREADS={} ccx job > job.log 2>&1", folder.string(), job.threads);
  ContactJobResult result;
  const Stopwatch watch;
  const int status = std::system(command.c_str());
  result.wall_seconds = watch.wall();
  result.cpu_seconds = watch.cpu();
  std::ifstream log(folder / "job.log");
  std::string line;
  while (std::getline(log, line)) {
    if (line.find("iteration") == 1) ++result.iterations;
    if (line.find("*ERROR") != std::string::npos && result.failure.empty()) result.failure = line;
  }
  result.torque = read_torques(job, folder / "job.dat");
  if (result.failure.empty() && (status != 0 || result.torque.size() != job.hub_rotations.size()))
    result.failure = "ccx did not finish, see " + (folder / "job.log").string();
  return result;
}

}  // namespace annulus::benchmarks
