#include "benchmarks/calculix/stage_job.h"

#include <fmt/format.h>
#include <fmt/os.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "benchmarks/calculix/deck.h"
#include "benchmarks/calculix/support_arc.h"
#include "core/errors.h"

namespace annulus::benchmarks {
namespace {

using geometry::Boundary;

/// Nodes beside those of the bodies, whose displacements stand for motions of rigid hubs, pins and supports.
struct References {
  std::vector<int> centre, rotation;  ///< sun, then planets; a rotation is displacement 1 of its node
  std::vector<int> pin, site;
};

class StageDeck {
 public:
  StageDeck(const StageJob& job, const std::filesystem::path& file) : job_(job), out_(fmt::output_file(file.string())) {
    add_body(job.sun.body, "sun");
    for (std::size_t n = 0; n < job.planets.size(); ++n) add_body(job.planets[n].body, fmt::format("planet{}", n));
    add_body(job.ring, "ring");
    add_references();
    hub(job.sun, 0);
    for (std::size_t n = 0; n < job.planets.size(); ++n) hub(job.planets[n], n + 1);
    sites();
    material();
    contact();
    for (std::size_t step = 0; step < job.steps.size(); ++step) write(job.steps[step], step == 0);
  }
  [[nodiscard]] const References& references() const { return references_; }
  [[nodiscard]] int nodes() const { return nodes_; }

 private:
  struct Part {
    std::string name;
    const QuadraticBody* body;
    int first_node, first_cell;
  };

  void add_body(const QuadraticBody& body, const std::string& name) {
    write_body(out_, body, name, nodes_, cells_);
    parts_.push_back({name, &body, nodes_, cells_});
    nodes_ += static_cast<int>(body.nodes.size());
    cells_ += static_cast<int>(body.cells.size());
  }
  int add_reference() {
    out_.print("*NODE, NSET=references\n{}, 0, 0, 0\n", ++nodes_);
    return nodes_;
  }
  void add_references() {
    for (std::size_t hub = 0; hub <= job_.planets.size(); ++hub) {
      references_.centre.push_back(add_reference());
      references_.rotation.push_back(add_reference());
      if (hub > 0) references_.pin.push_back(add_reference());
    }
    for (std::size_t i = 0; i < job_.ring_supports.sites.size(); ++i) references_.site.push_back(add_reference());
  }
  /// u = u_centre + phi x arm at every node of the bore.
  void hub(const HubGear& gear, std::size_t number) {
    const auto& part = parts_[number];
    for (const int node : gear.body.nodes_on(Boundary::support)) {
      const Eigen::Vector2d arm = (gear.body.nodes[node] - gear.axis) / deck_mm;
      for (const int direction : {1, 2})
        write_equation(out_, {{part.first_node + node + 1, direction, 1},
                              {references_.centre[number], direction, -1},
                              {references_.rotation[number], 1, direction == 1 ? arm.y() : -arm.x()}});
    }
  }
  /// Displacements 1 and 2 of a site's node are those of the site in its two directions.
  void sites() {
    const int first = parts_.back().first_node;
    for (std::size_t i = 0; i < references_.site.size(); ++i) {
      const auto& site = job_.ring_supports.sites[i];
      require(site.directions.size() <= 2, "a site has two directions at most");
      for (std::size_t d = 0; d < site.directions.size(); ++d) {
        const auto& direction = site.directions[d];
        require(!direction.unilateral && direction.clearance == 0, "supports of the peer are two-sided springs");
        const double angle = site.angle + std::numbers::pi - std::atan2(direction.counter_clockwise, direction.inward);
        write_mean_displacement(out_, {job_.ring, first}, site, angle, references_.site[i], static_cast<int>(d) + 1);
      }
    }
  }
  void spring(const std::string& name, const std::string& type, const std::vector<std::vector<int>>& ends,
              int direction, double stiffness) {
    out_.print("*ELEMENT, TYPE={}, ELSET={}\n", type, name);
    for (const auto& nodes : ends) out_.print("{}, {}\n", ++cells_, fmt::join(nodes, ", "));
    out_.print("*SPRING, ELSET={}\n{}{}\n{}\n", name, direction,
               ends.front().size() == 2 ? fmt::format(", {}", direction) : "",
               spring_field(stiffness * slice_width * deck_mm / job_.face_width * deck_mm));
  }
  void material() {
    for (const int direction : {1, 2}) {
      std::vector<std::vector<int>> bearings;
      for (std::size_t n = 0; n < job_.planets.size(); ++n)
        bearings.push_back({references_.centre[n + 1], references_.pin[n]});
      spring(fmt::format("bearing{}", direction), "SPRING2", bearings, direction, job_.planet_stiffness);
      for (std::size_t i = 0; i < references_.site.size(); ++i)
        spring(fmt::format("site{}x{}", i, direction), "SPRING1", {{references_.site[i]}}, direction,
               job_.ring_supports.sites[i].directions.at(direction - 1).total_stiffness());
    }
    std::vector<std::string> names;
    for (const auto& part : parts_) names.push_back(part.name);
    write_material(out_, job_.material, names);
  }
  void surface(const std::string& name, const Part& part, Boundary flank, int tooth, const FlankPair& pair,
               double reach) {
    out_.print("*SURFACE, NAME={}, TYPE=ELEMENT\n", name);
    int sides = 0;
    for (const auto& side : part.body->sides) {
      if (side.boundary != flank || side.tooth != tooth) continue;
      const auto& cell = part.body->cells[side.cell];
      const auto distance = [&](int corner) { return (part.body->nodes[cell[corner]] - pair.place).norm(); };
      if (std::min(distance(side.number), distance((side.number + 1) % 4)) > reach) continue;
      out_.print("{}, S{}\n", part.first_cell + side.cell + 1, side.number + 1);
      ++sides;
    }
    require(sides > 0, "no flank near a contact");
  }
  void contact() {
    write_interaction(out_, job_.contact_stiffness);
    for (std::size_t i = 0; i < job_.pairs.size(); ++i) {
      const auto& pair = job_.pairs[i];
      constexpr double wheel_reaches_further = 1.6;
      surface(fmt::format("planet_flank{}", i), parts_[pair.planet + 1],
              pair.with_ring ? Boundary::trailing_flank : Boundary::leading_flank, pair.planet_tooth, pair, pair.reach);
      surface(fmt::format("wheel_flank{}", i), pair.with_ring ? parts_.back() : parts_.front(), Boundary::leading_flank,
              pair.wheel_tooth, pair, wheel_reaches_further * pair.reach);
      out_.print("*CONTACT PAIR, INTERACTION=flanks, TYPE=SURFACE TO SURFACE\nplanet_flank{}, wheel_flank{}\n", i, i);
    }
  }
  void write(const StageStep& step, bool first) {
    out_.print("*STEP, INC=100\n*STATIC, DIRECT\n1., 1.\n*BOUNDARY, OP=NEW\n{}, 1, 3\n", references_.centre.front());
    for (std::size_t hub = 0; hub < references_.rotation.size(); ++hub) {
      out_.print("{}, 2, 3\n", references_.rotation[hub]);
      if (hub > 0) out_.print("{}, 3, 3\n", references_.centre[hub]);
      if (!step.rotations.empty())
        out_.print("{}, 1, 1, {}\n", references_.rotation[hub], deck_field(step.rotations.at(hub)));
    }
    for (std::size_t n = 0; n < references_.pin.size(); ++n) {
      const Eigen::Vector2d error = step.pin_errors.empty() ? Eigen::Vector2d::Zero() : step.pin_errors.at(n);
      out_.print("{0}, 1, 1, {1}\n{0}, 2, 2, {2}\n{0}, 3, 3\n", references_.pin[n], deck_field(error.x() / deck_mm),
                 deck_field(error.y() / deck_mm));
    }
    for (const int site : references_.site) out_.print("{}, 3, 3\n", site);
    if (step.rotations.empty())  // N mm per slice
      out_.print("*CLOAD{}\n{}, 1, {}\n", first ? "" : ", OP=NEW", references_.rotation.front(),
                 deck_field(job_.sun_torque / deck_mm * slice_width * deck_mm / job_.face_width));
    out_.print("*NODE PRINT, NSET=references\nU\n*END STEP\n");
  }

  const StageJob& job_;
  fmt::ostream out_;
  std::vector<Part> parts_;  ///< sun, planets, ring
  References references_;
  int nodes_ = 0, cells_ = 0;
};

}  // namespace

StageJobResult run_calculix(const StageJob& job, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  StageJobResult result;
  References references;
  {
    const StageDeck deck(job, folder / "job.inp");
    references = deck.references();
    result.nodes = static_cast<std::size_t>(deck.nodes());
  }
  const auto run = run_deck(folder, job.threads);
  result.wall_seconds = run.wall_seconds;
  result.cpu_seconds = run.cpu_seconds;
  result.iterations = run.iterations;
  result.failure = run.failure;
  const auto steps = read_displacements(folder / "job.dat", "REFERENCES");
  if (result.failure.empty() && steps.size() != job.steps.size())
    result.failure = "ccx did not finish, see " + (folder / "job.log").string();
  if (!result.failure.empty()) return result;
  for (const auto& step : steps) {
    auto& state = result.states.emplace_back();
    state.sun_rotation = step.at(references.rotation.front()).x();
    for (std::size_t n = 0; n < job.planets.size(); ++n) {
      state.planet_rotations.push_back(step.at(references.rotation[n + 1]).x());
      state.pin_forces.emplace_back(job.planet_stiffness * deck_mm *
                                    (step.at(references.pin[n]) - step.at(references.centre[n + 1])));
    }
  }
  return result;
}

}  // namespace annulus::benchmarks
