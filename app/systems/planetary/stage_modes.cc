#include "app/systems/planetary/stage_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/shared/mesh_names.h"
#include "core/units.h"
#include "dynamics/figures/common_figures.h"
#include "dynamics/systems/planetary/campbell.h"
#include "dynamics/systems/planetary/planetary_figures.h"
#include "fem/ring/ring_coupling.h"

namespace annulus::app {

namespace {

constexpr int campbell_steps = 40;
constexpr double campbell_reach = 1.5;  // times the operating speed
constexpr int campbell_orders = 5;

std::vector<double> column(const Eigen::MatrixXd& shares, std::size_t mode) {
  const auto values = shares.col(static_cast<Eigen::Index>(mode));
  return {values.begin(), values.end()};
}

void add_campbell(StageModes& result, const dynamics::PlanetaryStage& stage) {
  const double rolling = std::abs(stage.carrier_speed - stage.ring_speed);
  std::vector<double> speeds;
  for (int i = 0; i <= campbell_steps; ++i) speeds.push_back(rolling * campbell_reach * i / campbell_steps);
  const auto diagram = dynamics::campbell(stage, speeds, {.orders = campbell_orders});
  using geometry::StageMember;
  const auto members =
      geometry::member_speeds(stage.sun_teeth, stage.ring_teeth, {StageMember::carrier, stage.carrier_speed},
                              {StageMember::ring, stage.ring_speed});
  // Magnitudes of the speeds of sun, carrier and ring, r/min, where the carrier turns at `speed` against the ring.
  const auto row_of = [&](double speed) {
    std::vector<double> row;
    for (const auto member : {StageMember::sun, StageMember::carrier, StageMember::ring})
      row.push_back(std::abs(members[member]) * speed / rolling / units::rpm);
    return row;
  };
  result.campbell.columns = {"sun_speed_rpm", "carrier_speed_rpm", "ring_speed_rpm", "mesh_frequency_Hz"};
  for (std::size_t i = 0; i < diagram.curves.size(); ++i)
    result.campbell.columns.push_back(fmt::format("mode{}_Hz", i + 1));
  for (std::size_t s = 0; s < speeds.size(); ++s) {
    auto& row = result.campbell.rows.emplace_back(row_of(speeds[s]));
    row.push_back(diagram.mesh_frequency[s]);
    for (const auto& curve : diagram.curves) row.push_back(curve.frequency[s]);
  }
  result.critical_speeds.columns = {
      "sun_speed_rpm", "carrier_speed_rpm", "ring_speed_rpm", "frequency_Hz", "mesh_order", "mode", "participation"};
  for (const auto& c : diagram.crossings) {
    auto& row = result.critical_speeds.rows.emplace_back(row_of(c.speed));
    row.insert(row.end(),
               {c.frequency, static_cast<double>(c.order), static_cast<double>(c.curve + 1), c.participation});
  }
}

}  // namespace

MeshStiffnessErrors stiffness_errors(const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  const auto sun = sun_mesh.mean_tangent(), ring = ring_mesh.mean_tangent();
  MeshStiffnessErrors errors = {{.groups = {sun_planet}, .relative = sun.error_relative, .parts = sun.parts},
                                {.groups = {ring_planet}, .relative = ring.error_relative, .parts = ring.parts}};
  if (!ring_mesh.coupling) return errors;
  auto& elastic = errors.emplace_back(dynamics::GroupError{.groups = {"ring_mode", "ring_body", "ring_and_planets"},
                                                           .relative = ring_mesh.coupling->frequency_error_relative,
                                                           .sensitivity = 1});
  elastic.parts.model = fem::plane_strain_bounds(*ring_mesh.model.problem).frequency;
  elastic.parts.discretisation = elastic.relative - elastic.parts.model;
  return errors;
}

StageModes stage_modes(const dynamics::PlanetaryStage& stage, const MeshStiffnessErrors& errors) {
  const auto modes = dynamics::modes(stage);
  StageModes result;
  result.shapes.columns = {"mode", "frequency_Hz"};
  result.shapes.columns.insert(result.shapes.columns.end(), modes.dofs.begin(), modes.dofs.end());
  if (modes.modes.empty()) return result;
  // These columns are there for every stage; elements of other kinds follow.
  const auto energy = dynamics::by_group(
      dynamics::modal_energy(stage, modes),
      {"sun_planet", "ring_planet", "planet_bearing", "sun_support", "ring_support", "carrier_support"},
      {"sun", "ring", "carrier", "planet"});
  const auto frequencies = dynamics::frequency_errors(modes, energy, errors);
  const auto turning = dynamics::modes_at_speed(stage);
  result.groups = energy.groups;
  result.bodies = energy.bodies;
  std::replace(result.bodies.begin(), result.bodies.end(), std::string("planet"), std::string("planets"));
  const auto motions = stage.space ? dynamics::Motions::in_space : dynamics::Motions::in_plane;
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    const auto& [frequency, shape] = modes.modes[i];
    result.list.push_back({frequency, frequencies[i].figure.error, frequencies[i].parts,
                           dynamics::to_string(modes.kinds[i], motions), turning[i].frequency, turning[i].damping_ratio,
                           column(energy.strain, i), column(energy.kinetic, i)});
    auto& row = result.shapes.rows.emplace_back(std::vector{static_cast<double>(i + 1), frequency});
    // The largest amplitude is 1: only the shape means something.
    Eigen::Index top = 0;
    (void)shape.cwiseAbs().maxCoeff(&top);
    for (const double value : shape) row.push_back(value / shape[top]);
  }
  if (stage.mesh_frequency() > 0) add_campbell(result, stage);
  return result;
}

void add_model_change(StageModes& modes, const dynamics::PlanetaryStage& other) {
  const auto changed = dynamics::modes(other).modes;
  for (std::size_t i = 0; i < modes.list.size(); ++i) {
    auto& mode = modes.list[i];
    mode.error_parts.model += std::abs(changed.at(i).frequency - mode.frequency);
    mode.frequency_error = mode.error_parts.total();
  }
}

FigureSet frequency_figures(const StageModes& modes) {
  std::vector<dynamics::Frequency> list;
  for (const auto& mode : modes.list) list.push_back({{mode.frequency, mode.frequency_error}, mode.error_parts});
  return dynamics::frequency_figures(list, dynamics::planetary_frequencies, dynamics::Multiples::once);
}

std::string modes_csv(const StageModes& modes) {
  std::string text = "index,frequency_Hz,kind,damped_frequency_Hz,damping_ratio";
  for (const auto& group : modes.groups) text += ",strain_" + group;
  for (const auto& body : modes.bodies) text += ",kinetic_" + body;
  text += ",frequency_error_Hz";
  for (const auto& [name, part] : stiffness_error_part_names) text += fmt::format(",error_{}_Hz", name);
  text += "\n";
  for (std::size_t i = 0; i < modes.list.size(); ++i) {
    const auto& m = modes.list[i];
    text +=
        fmt::format("{},{:.17g},{},{:.17g},{:.17g}", i + 1, m.frequency, m.kind, m.damped_frequency, m.damping_ratio);
    for (const double share : m.strain) text += fmt::format(",{:.17g}", share);
    for (const double share : m.kinetic) text += fmt::format(",{:.17g}", share);
    text += fmt::format(",{:.17g}", m.frequency_error);
    for (const auto& [name, part] : stiffness_error_part_names) text += fmt::format(",{:.17g}", m.error_parts.*part);
    text += "\n";
  }
  return text;
}

}  // namespace annulus::app
