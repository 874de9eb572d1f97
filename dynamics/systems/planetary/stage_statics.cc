#include "dynamics/systems/planetary/stage_statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/not_known.h"
#include "core/parallel.h"

namespace annulus::dynamics {

namespace {

/// Places of one phase of which each starts from the one before. It does not depend on the number of threads: results
/// stay the same to the last digit.
constexpr std::size_t run_of_places = 8;

/// `loss`: m, of its approach through the other meshes.
StaticMesh mesh_in(const StageMechanism::Mesh& mesh, const Mechanism::Equilibrium& at, double normal_factor,
                   double loss) {
  StaticMesh result;
  const auto& law = *mesh.law;
  const auto element = static_cast<std::size_t>(mesh.driving);
  Eigen::VectorXd approach = at.deflection[element].segment(mesh.first, law.size());
  approach.head(std::ssize(law.stations())).array() -= loss;
  const auto state = law.at(approach);
  const Eigen::VectorXd line = law.line_load(approach, state);
  result.line_load.assign(line.begin(), line.end());
  const double force = law.force(state);
  result.force = normal_factor * force;
  if (force > 0) {
    result.mean_line_load = force / law.face_width();
    for (Eigen::Index i = 0; i < std::ssize(law.stations()); ++i)
      result.place += law.stations()[static_cast<std::size_t>(i)] * state.force[i] / force;
  }
  if (mesh.back < 0) return result;
  const double back = mesh.back_law->force(at.state[static_cast<std::size_t>(mesh.back)]);
  result.force -= normal_factor * back;
  result.back_flanks = back > 0;
  return result;
}

StaticBearing bearing_in(const StageMechanism& made, const MadeBearing& bearing, const Mechanism::Equilibrium& at) {
  StaticBearing result;
  for (std::size_t i = 0; i < bearing.element.size(); ++i) {
    double value = 0;
    if (bearing.element[i] >= 0)
      value = -at.state[static_cast<std::size_t>(bearing.element[i])].force[bearing.coordinate[i]];
    else if (bearing.held[i] >= 0)
      value = -at.holding[bearing.held[i]] / made.shared[static_cast<std::size_t>(bearing.held[i])];
    if (i < 3)
      result.force[static_cast<Eigen::Index>(i)] = value;
    else
      result.moment[static_cast<Eigen::Index>(i) - 3] = value;
  }
  if (bearing.rolling)
    result.largest_element =
        bearing.rolling->largest_element_load(at.deflection[static_cast<std::size_t>(bearing.element.front())]);
  return result;
}

/// N m, from the housing: through what holds its rotation, or through mounts beside the axis.
double torque_on_ring(const SpatialStage& stage, const StageMechanism& made, const StaticPosition& p,
                      const Mechanism::Equilibrium& at) {
  double torque = 0;
  if (made.ring_hold >= 0) torque -= at.holding[made.ring_hold];
  if (made.ring_support >= 0) torque -= at.state[static_cast<std::size_t>(made.ring_support)].force[0];
  for (std::size_t i = 0; i < stage.bearings.size(); ++i) {
    const auto& b = made.bearings[i];
    if (b.body.kind == StageBody::Kind::ring)
      torque += b.beside.x() * p.bearings[i].force.y() - b.beside.y() * p.bearings[i].force.x();
  }
  return torque;
}

/// `start`: motion that the search starts from; empty: none.
StaticPosition solved_position(const SpatialStage& stage, double cycles, const Eigen::VectorXd& start) {
  const auto& plane = stage.plane;
  StaticPosition p;
  p.mesh_cycles = cycles;
  // Mesh cycles count in the sense in which the stage turns.
  const double frequency = plane.mesh_frequency();
  p.time = frequency > 0 ? cycles / frequency : 0;
  p.carrier_angle = plane.carrier_speed * p.time;
  const auto made = assemble(stage, p.time);
  const auto at = [&] {
    try {
      return made.mechanism.solve(start);
    } catch (const SolverError& error) {
      throw SolverError(fmt::format("statics at mesh cycle {:.4f}: {}", cycles, error.what()));
    }
  }();
  p.residual_relative = at.residual_relative;
  p.motion = at.motion;
  const double normal_factor = std::cos(stage.base_helix_angle);
  const auto planets = static_cast<std::size_t>(stage.planets());
  Eigen::VectorXd losses = Eigen::VectorXd::Zero(stage.planets());
  if (made.coupling) losses = made.coupling->losses(at.state[static_cast<std::size_t>(made.meshes.back().driving)]);
  for (std::size_t n = 0; n < planets; ++n) {
    p.sun_meshes.push_back(mesh_in(made.meshes[n], at, normal_factor, 0));
    p.ring_meshes.push_back(mesh_in(made.meshes[planets + n], at, normal_factor, losses[static_cast<Eigen::Index>(n)]));
  }
  for (const auto& bearing : made.bearings) p.bearings.push_back(bearing_in(made, bearing, at));
  for (int b = 0; b < made.mechanism.bodies(); ++b) {
    const int of_planets = stage.planets() * (stage.pins ? 2 : 1);  // or their pins
    const bool planet = b >= 3 && b < 3 + of_planets, housing = b >= 3 + of_planets;
    const StageBody body{planet ? StageBody::Kind::planet : StageBody::Kind::housing,
                         planet ? (b - 3) % stage.planets() : 0};
    const auto frame = planet ? StageFrame::planet : housing ? StageFrame::housing : StageFrame::carrier;
    const auto axes = frame_axes(stage, frame, body, p.time);
    p.bodies.push_back(
        {axes.transpose() * at.motion.segment<3>(6 * b), axes.transpose() * at.motion.segment<3>(6 * b + 3)});
  }
  p.carrier_torque = -at.holding[made.carrier_hold];
  p.ring_torque = torque_on_ring(stage, made, p, at);
  return p;
}

double mean_force(const std::vector<StaticMesh>& meshes) {
  double sum = 0;
  for (const auto& mesh : meshes) sum += std::abs(mesh.force);
  return sum / static_cast<double>(meshes.size());
}

/// One planet's mesh over a mesh cycle.
struct MeshCycle {
  double force = 0, mean_line_load = 0;  // sums
  Eigen::VectorXd line_load;
  void add(const StaticMesh& mesh) {
    force += mesh.force;
    mean_line_load += mesh.mean_line_load;
    const auto along = Eigen::Map<const Eigen::VectorXd>(mesh.line_load.data(), std::ssize(mesh.line_load));
    line_load = line_load.size() == 0 ? Eigen::VectorXd(along) : Eigen::VectorXd(line_load + along);
  }
};

StaticFigures::Mesh mesh_figures(const StaticTurn& turn, std::vector<StaticMesh> StaticPosition::*meshes) {
  constexpr double light = StaticFigures::light_mesh;
  StaticFigures::Mesh result;
  const std::size_t planets = (turn.positions.front().*meshes).size();
  const auto phases = static_cast<std::size_t>(turn.schedule.phases);
  const auto share = [&](const std::vector<double>& forces) {
    double sum = 0, largest = 0;
    for (const double f : forces) {
      sum += f;
      largest = std::max(largest, std::abs(f));
    }
    return sum == 0 ? not_known : largest * static_cast<double>(planets) / std::abs(sum);
  };
  for (std::size_t place = 0; place < turn.schedule.cycles.size(); ++place) {
    std::vector<MeshCycle> cycle(planets);
    for (std::size_t k = 0; k < phases; ++k) {
      const auto& list = turn.positions[place * phases + k].*meshes;
      std::vector<double> now;
      for (std::size_t n = 0; n < planets; ++n) {
        now.push_back(list[n].force);
        cycle[n].add(list[n]);
        if (std::abs(list[n].force) >= light * mean_force(list))
          result.line_load_ratio_instantaneous =
              std::max(result.line_load_ratio_instantaneous, list[n].line_load_ratio());
      }
      result.sharing_instantaneous = std::max(result.sharing_instantaneous, share(now));
    }
    std::vector<double> forces;
    for (const auto& mesh : cycle) forces.push_back(mesh.force);
    result.sharing = std::max(result.sharing, share(forces));
    double mean = 0;
    for (const double f : forces) mean += std::abs(f) / static_cast<double>(planets);
    for (const auto& mesh : cycle)
      if (std::abs(mesh.force) >= light * mean && mesh.mean_line_load > 0)
        result.line_load_ratio = std::max(result.line_load_ratio, mesh.line_load.maxCoeff() / mesh.mean_line_load);
  }
  return result;
}

}  // namespace

double StaticMesh::line_load_ratio() const {
  return mean_line_load > 0 ? *std::max_element(line_load.begin(), line_load.end()) / mean_line_load : 0.0;
}

int period_of(const SpatialStage& stage) {
  // A position error of the housing has the period that everything has that stands still in it.
  auto plane = stage.plane;
  if (stage.depends_on_carrier_angle()) plane.carrier.errors.position.amount = 1;
  return plane.error_period();
}

StaticSchedule places_over(int cycles, int places, int phases) {
  StaticSchedule schedule;
  schedule.phases = phases;
  schedule.cycles.clear();
  const int count = std::min(places, cycles);
  for (int i = 0; i < count; ++i)
    schedule.cycles.push_back(std::floor(static_cast<double>(i) * static_cast<double>(cycles) / count));
  return schedule;
}

StaticTurn solve_turn(const SpatialStage& stage, const StaticSchedule& schedule, int threads, const StaticTurn* near) {
  StaticTurn turn;
  turn.schedule = schedule;
  turn.positions.resize(schedule.positions());
  const auto phases = static_cast<std::size_t>(schedule.phases);
  const std::size_t places = schedule.cycles.size(), runs = (places + run_of_places - 1) / run_of_places;
  // Phase by phase: positions at one share what is prepared for it.
  for_each_task(runs * phases, threads, [&](std::size_t task) {
    const std::size_t phase = task / runs, first = task % runs * run_of_places;
    for (std::size_t place = first; place < std::min(places, first + run_of_places); ++place) {
      const std::size_t position = place * phases + phase;
      const StaticPosition* from = near != nullptr ? &near->positions.at(position)
                                   : place > first ? &turn.positions[position - phases]
                                                   : nullptr;
      turn.positions[position] =
          solved_position(stage, schedule.cycles[place] + static_cast<double>(phase) / static_cast<double>(phases),
                          from != nullptr ? from->motion : Eigen::VectorXd());
    }
  });
  const auto made = assemble(stage, 0);
  for (const auto& bearing : made.bearings) turn.bearing_names.push_back(bearing.name);
  for (int b = 0; b < made.mechanism.bodies(); ++b) turn.body_names.push_back(made.mechanism.body(b).name);
  turn.sun_stations = made.meshes.front().law->stations();
  turn.ring_stations = made.meshes.back().law->stations();
  return turn;
}

StaticFigures figures_of(const StaticTurn& turn) {
  StaticFigures figures;
  figures.sun = mesh_figures(turn, &StaticPosition::sun_meshes);
  figures.ring = mesh_figures(turn, &StaticPosition::ring_meshes);
  return figures;
}

}  // namespace annulus::dynamics
