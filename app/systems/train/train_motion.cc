#include "app/systems/train/train_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/model/dynamics_members.h"
#include "app/model/excitation.h"
#include "app/model/table_errors.h"
#include "app/model/time_series.h"
#include "app/results/cached_value.h"
#include "app/results/content_id.h"
#include "app/systems/shared/face_loads.h"
#include "app/systems/shared/space_members.h"
#include "core/files.h"
#include "core/log.h"
#include "dynamics/figures/common_figures.h"
#include "dynamics/modes/modal_energy.h"
#include "dynamics/steady_state/integration_cost.h"

namespace annulus {

ANNULUS_MEMBERS(dynamics::TrainMesh, part, name, frequency, mean_force, dynamic_factor, largest_force, smallest_force,
                contact_loss);
/// Without its time series.
template <>
struct Members<dynamics::TrainResponse> {
  template <class Response>
  static auto of(Response& r) {
    return std::tie(static_cast<dynamics::SteadyOutcome&>(r), r.mesh_frequency, r.meshes, r.shafts);
  }
};
ANNULUS_MEMBERS(app::TrainMode, frequency, body, element, kinetic, strain);
ANNULUS_MEMBERS(app::TrainMotion, response, figures, modes, shafts, space, time_series);
ANNULUS_MEMBERS(dynamics::TrainShaft::End, part, body);
ANNULUS_MEMBERS(dynamics::TrainShaft, name, from, to, stiffness, damping_ratio, half_backlash);

}  // namespace annulus

namespace annulus::app {

namespace {

constexpr const char* cached_motions = "responses";
constexpr const char* train_point_method = "train 1";

dynamics::SimulationOptions train_simulation(const Scene& scene, const dynamics::Train& train) {
  return accurate_simulation(scene, dynamics::steady_problem(train).mesh_frequency);
}

/// Identity of everything that the answers depend on: the parts' own lumped models contain their scenes and tables.
std::string train_id(const Scene& scene, const std::vector<WorkingPart>& parts,
                     const std::vector<const MeshResult*>& tables, const dynamics::Train& train,
                     const dynamics::SimulationOptions& options) {
  std::string of_parts;
  const auto own = tables_of_parts(parts, tables);
  for (std::size_t i = 0; i < parts.size(); ++i)
    of_parts += parts[i].name + " " + parts[i].system->model(0, own[i])->id() + "\n";
  return identity_of(of_parts, train.shafts, train.rotors, scene.accuracy, options);
}

dynamics::Evaluation evaluation_of(const dynamics::Train& train, const dynamics::TrainResponse& response) {
  dynamics::Evaluation evaluation{.figures = dynamics::figures(response),
                                  .outcome = static_cast<const dynamics::SteadyOutcome&>(response)};
  evaluation.figures.add(
      dynamics::frequency_figures(dynamics::modes(train), dynamics::train_frequencies, dynamics::Multiples::once));
  dynamics::add_each_shaft(evaluation.figures, response.shafts);
  for (const auto& mesh : response.meshes) {
    evaluation.figures.set(mesh.name + "_dynamic_factor", mesh.dynamic_factor);
    evaluation.figures.set(mesh.name + "_force_N", mesh.largest_force);
  }
  return evaluation;
}

std::vector<TrainMode> modes_of(const dynamics::Train& train) {
  const auto system = assemble(train);
  const auto found = dynamics::modes(system);
  const auto energy = dynamics::modal_energy(system, dynamics::mean_tangents(system), found);
  std::vector<TrainMode> list;
  for (std::size_t i = 0; i < found.modes.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    auto& mode = list.emplace_back(TrainMode{.frequency = found.modes[i].frequency});
    Eigen::Index body = 0, element = 0;
    mode.kinetic = energy.kinetic.col(column).maxCoeff(&body);
    mode.body = energy.bodies[static_cast<std::size_t>(body)];
    if (mode.frequency == 0) continue;
    mode.strain = energy.strain.col(column).maxCoeff(&element);
    mode.element = energy.elements[static_cast<std::size_t>(element)];
  }
  return list;
}

/// Torque of every shaft over its nominal one.
Csv shaft_courses(const dynamics::TrainResponse& response) {
  Csv csv{.header = {}, .columns = {"time_s"}, .rows = {}};
  constexpr double shown = 60;  // cycles of the fastest mesh
  const auto& series = response.series;
  std::vector<Eigen::Index> rows;
  for (const auto& shaft : response.shafts) {
    // Those of the rotors carry their names.
    const auto element = std::find_if(series.meshes.begin(), series.meshes.end(), [&](const std::string& name) {
      return name == shaft.name || name == shaft.name + "_shaft";
    });
    rows.push_back(element - series.meshes.begin());
    csv.columns.push_back(shaft.name);
  }
  for (Eigen::Index i = 0; i < series.time.size(); ++i) {
    if ((series.time[i] - series.time[0]) * response.mesh_frequency > shown) break;
    auto& row = csv.rows.emplace_back(1, series.time[i] - series.time[0]);
    // Forces in the elements are torques over a radius that belongs to the shaft: in proportion to the mean.
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double mean = series.force.row(rows[k]).mean();
      row.push_back(series.force(rows[k], i) / mean * response.shafts[k].mean_torque /
                    response.shafts[k].nominal_torque);
    }
  }
  csv.round();
  return csv;
}

/// The series of a part by its own names, in its own order.
dynamics::TimeSeries series_of_part(const dynamics::TimeSeries& train, const std::string& part) {
  const auto prefix = part + ".";
  const auto own = [&](const std::vector<std::string>& names, std::vector<std::string>& of_part) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i].starts_with(prefix)) {
        rows.push_back(static_cast<Eigen::Index>(i));
        of_part.push_back(names[i].substr(prefix.size()));
      }
    return rows;
  };
  dynamics::TimeSeries series;
  const auto dofs = own(train.dofs, series.dofs), meshes = own(train.meshes, series.meshes);
  series.time = train.time;
  series.displacement = train.displacement(dofs, Eigen::all);
  series.velocity = train.velocity(dofs, Eigen::all);
  series.force = train.force(meshes, Eigen::all);
  return series;
}

std::vector<SpaceResults> parts_in_space(const std::vector<WorkingPart>& parts,
                                         const std::vector<const MeshResult*>& tables,
                                         const dynamics::TrainResponse& response, const RunOptions& options) {
  std::vector<SpaceResults> list;
  const auto own = tables_of_parts(parts, tables);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto model = parts[i].system->model(0, own[i]);
    list.push_back(
        space_results(model->in_space(series_of_part(response.series, parts[i].name)), response.window_cycles));
    if (!list.back().meshes.empty())
      add_face_loads(list.back(), parts[i].system->moving_faces(0, own[i], options), options.threads);
  }
  return list;
}

/// The totals of the errors back into what they belong to.
void set_errors(dynamics::TrainResponse& response, const FigureSet& figures) {
  dynamics::set_errors(response.shafts, figures);
  for (auto& mesh : response.meshes) {
    mesh.dynamic_factor.error = figures.figure(mesh.name + "_dynamic_factor").error;
    mesh.largest_force.error = figures.figure(mesh.name + "_force_N").error;
  }
}

TrainMotion motion_of(const Scene& scene, const std::vector<WorkingPart>& parts,
                      const std::vector<const MeshResult*>& tables, const dynamics::Train& train,
                      const dynamics::SimulationOptions& options, const RunOptions& run) {
  TrainMotion motion{.response = dynamics::simulate(train, options)};
  auto& response = motion.response;
  const auto way = dynamics::comparison_options(response, options);
  motion.figures = with_table_errors(
      evaluation_of(train, response), tables,
      [&](const std::vector<const MeshResult*>& changed) {
        const auto other = make_train(scene, parts, changed);
        return evaluation_of(other, dynamics::simulate(other, way.simulation));
      },
      way);
  set_errors(response, motion.figures);
  motion.modes = modes_of(train);
  motion.shafts = shaft_courses(response);
  motion.space = parts_in_space(parts, tables, response, run);
  for (auto& part : motion.space) part.table.round();
  motion.time_series = time_series_table(response.series, response.window_cycles).text();
  response.series = {};
  return motion;
}

StudyPoint point_of(const dynamics::Train& train, const dynamics::TrainResponse& response) {
  return {.figures = {dynamics::train_figures(), [&] {
                        auto figures = dynamics::figures(response);
                        figures.add(dynamics::frequency_figures(dynamics::modes(train), dynamics::train_frequencies,
                                                                dynamics::Multiples::once));
                        return figures;
                      }()}};
}

}  // namespace

std::vector<PlannedResponse> train_responses(const Scene& scene, const std::vector<WorkingPart>& parts) {
  if (!scene.dynamics) return {};
  const auto train = rough_train(scene, parts);
  const auto system = assemble(train);
  const auto problem = dynamics::steady_problem(train);
  const auto options = train_simulation(scene, train);
  int tables = 0;
  for (const auto& part : parts)
    for (const auto& mesh : part.system->model_meshes()) tables += mesh.computed() ? 1 : 0;
  const auto stiffness = tables > 0 ? dynamics::StiffnessCourse::sudden : dynamics::StiffnessCourse::smooth;
  const int period = std::min(problem.period_in_cycles, options.max_window_cycles);
  const auto course = dynamics::steady_course(system, problem.mesh_frequency, period, options, stiffness);
  const double per_cycle =
      dynamics::integration_seconds(system, problem.mesh_frequency, 1, options.integrator, stiffness);
  // And on the unchanged tables in the same way.
  const double runs = comparisons(tables) + (tables > 0 ? 1 : 0);
  const auto& asked = scene.dynamics->mesh_cycles;
  const double searched_s = course.expected_search() * per_cycle;
  const double motion_s = (course.cycles + runs * course.compared_cycles) * per_cycle + searched_s;
  const double balances = course.balance_s * (1 + (course.compared_cycles > 0 ? 0 : runs));
  const double study_s = course.balance_s + asked.value_or(0) * per_cycle;
  // Motions and forces of the window and of those it is compared with, and the time series as text.
  constexpr double copies = 6.5, bytes_per_MB = 1e6;
  const double numbers = static_cast<double>(course.samples) * period *
                         static_cast<double>(2 * system.dofs() + static_cast<int>(system.meshes().size()));
  return {{.label = "dynamics of the train",
           .variant = "",
           .size = {.work = tables > 0 ? Work::response : Work::response_prescribed,
                    .motion_s = balances + motion_s,
                    .held_MB = copies * sizeof(double) * numbers / bytes_per_MB},
           .search_s = asked ? 0 : std::max(0.0, course.possible_search_s(per_cycle) - searched_s),
           .study_s = study_s,
           .study_search_s = asked ? 0 : searched_s,
           .sample_s = study_s}};
}

std::unique_ptr<LumpedModel> train_model(const Scene& scene, const std::vector<WorkingPart>& parts,
                                         const std::vector<const MeshResult*>& tables) {
  const auto train = std::make_shared<const dynamics::Train>(make_train(scene, parts, tables));
  auto simulation = train_simulation(scene, *train);
  simulation.confirmation = dynamics::Confirmation::where_needed;
  simulation.estimate_error = false;
  simulation.keep_series = false;
  return std::make_unique<LumpedModel>(
      identity_of(train_id(scene, parts, tables, *train, simulation), std::string(train_point_method)),
      [train, simulation](Answer /*wanted*/) { return point_of(*train, dynamics::simulate(*train, simulation)); },
      LumpedModel::Abilities{{},
                             [train, simulation](const dynamics::SystemState* start) -> LumpedModel::FollowedPoint {
                               const auto response =
                                   dynamics::simulate(*train, dynamics::followed_from(simulation, start));
                               return {point_of(*train, response), response.end};
                             },
                             [train] { return dynamics::lumped_case(*train); }});
}

std::unique_ptr<TrainRunResponse> train_response(const Scene& scene, const std::vector<WorkingPart>& parts,
                                                 const std::vector<const MeshResult*>& tables,
                                                 const RunOptions& options) {
  const auto train = make_train(scene, parts, tables);
  auto simulation = train_simulation(scene, train);
  simulation.other_motions.threads = options.threads;
  const auto id = train_id(scene, parts, tables, train, simulation);
  auto [motion, reused] = cached_value(options.store.get(), cached_motions, id,
                                       [&] { return motion_of(scene, parts, tables, train, simulation, options); });
  note_reuse(options, "dynamics of the train", source_of(reused));
  const auto folder = options.out / "dynamics";
  std::filesystem::create_directories(folder);
  auto shafts = motion.shafts;
  shafts.header = {{"annulus_version", version()}, {"inputs_id", id}};
  shafts.write(folder / "shafts.csv");
  write_file(folder / "time_series.csv", motion.time_series);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto write = [&](const char* name, Csv table) {
      if (table.columns.empty()) return;
      table.header = shafts.header;
      table.write(folder / fmt::format("{}_{}.csv", name, parts[i].name));
    };
    write("bearings_in_space", motion.space[i].table);
    write("face_loads", face_loads_table(motion.space[i]));
  }
  motion.time_series.clear();
  const auto& found = motion.response;
  log::info("dynamics of the train: " +
            (reused ? "unchanged, reused"
                    : fmt::format("{} mesh cycles of the fastest mesh, {}", found.window_cycles,
                                  found.steady ? "periodic steady state" : "no periodic steady state")));
  auto result = std::make_unique<TrainRunResponse>();
  result->figures = motion.figures;
  result->motions = found.motions;
  result->shafts = found.shafts;
  result->reused = reused;
  result->motion = std::move(motion);
  return result;
}

}  // namespace annulus::app
