#include "app/systems/planetary/stage_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/rim_coupling.h"
#include "core/units.h"
#include "dynamics/systems/planetary/campbell.h"
#include "dynamics/systems/planetary/planetary_figures.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "fem/ring/ring_coupling.h"

namespace annulus::app {

namespace {

constexpr int campbell_steps = 40;
constexpr double campbell_reach = 1.5;  // times the operating speed
constexpr int campbell_orders = 5;

void add_energies(StageModes& result, const dynamics::PlanetaryStage& stage, const dynamics::Modes& modes) {
  const auto energy = dynamics::modal_energy(stage, modes);
  const auto grouped = dynamics::by_group(energy);
  // These columns are there for every stage; elements of other kinds follow.
  result.groups = {"sun_planet", "ring_planet", "planet_bearing", "sun_support", "ring_support", "carrier_support"};
  for (const auto& group : grouped.groups) {
    if (std::find(result.groups.begin(), result.groups.end(), group) == result.groups.end())
      result.groups.push_back(group);
  }
  result.bodies = {"sun", "ring", "carrier", "planets"};
  for (std::size_t i = 0; i < result.list.size(); ++i) {
    auto& mode = result.list[i];
    const auto column = static_cast<Eigen::Index>(i);
    mode.strain.assign(result.groups.size(), 0.0);
    for (std::size_t g = 0; g < grouped.groups.size(); ++g) {
      const auto place = std::find(result.groups.begin(), result.groups.end(), grouped.groups[g]);
      mode.strain[static_cast<std::size_t>(place - result.groups.begin())] =
          grouped.strain(static_cast<Eigen::Index>(g), column);
    }
    mode.kinetic.assign(result.bodies.size(), 0.0);
    for (std::size_t b = 0; b < energy.bodies.size(); ++b) {
      const auto place = std::find(result.bodies.begin(), result.bodies.end() - 1, energy.bodies[b]);
      mode.kinetic[static_cast<std::size_t>(place - result.bodies.begin())] +=
          energy.kinetic(static_cast<Eigen::Index>(b), column);
    }
  }
}

/// Frequency and damping ratio at the operating speed, each mode followed from rest by its shape.
void add_operating_speed(StageModes& result, dynamics::PlanetaryStage stage) {
  const auto turning = dynamics::rotating_modes(stage, dynamics::ModeDamping::damped);
  stage.carrier_speed = 0;
  const auto rest = dynamics::rotating_modes(stage, dynamics::ModeDamping::undamped);
  const auto next = dynamics::continued_modes(rest, turning, dynamics::assemble(stage).mass());
  for (std::size_t i = 0; i < result.list.size(); ++i) {
    result.list[i].damped_frequency = turning.modes[next[i]].frequency;
    result.list[i].damping_ratio = turning.modes[next[i]].damping_ratio;
  }
}

void add_campbell(StageModes& result, const dynamics::PlanetaryStage& stage) {
  std::vector<double> speeds;
  for (int i = 0; i <= campbell_steps; ++i) speeds.push_back(stage.carrier_speed * campbell_reach * i / campbell_steps);
  const auto diagram = dynamics::campbell(stage, speeds, {.orders = campbell_orders});
  const double sun_per_carrier = 1 + static_cast<double>(stage.ring_teeth) / stage.sun_teeth;
  result.campbell.columns = {"sun_speed_rpm", "carrier_speed_rpm", "mesh_frequency_Hz"};
  for (std::size_t i = 0; i < diagram.curves.size(); ++i)
    result.campbell.columns.push_back(fmt::format("mode{}_Hz", i + 1));
  for (std::size_t s = 0; s < speeds.size(); ++s) {
    auto& row = result.campbell.rows.emplace_back(
        std::vector{speeds[s] * sun_per_carrier / units::rpm, speeds[s] / units::rpm, diagram.mesh_frequency[s]});
    for (const auto& curve : diagram.curves) row.push_back(curve.frequency[s]);
  }
  result.critical_speeds.columns = {"sun_speed_rpm", "carrier_speed_rpm", "frequency_Hz", "mesh_order",
                                    "mode",          "participation"};
  for (const auto& c : diagram.crossings) {
    result.critical_speeds.rows.push_back({c.carrier_speed * sun_per_carrier / units::rpm, c.carrier_speed / units::rpm,
                                           c.frequency, static_cast<double>(c.order), static_cast<double>(c.curve + 1),
                                           c.participation});
  }
}

}  // namespace

MeshStiffnessErrors stiffness_errors(const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  const auto sun = sun_mesh.mean_stiffness(), ring = ring_mesh.mean_stiffness();
  MeshStiffnessErrors errors{sun.error_relative, ring.error_relative, sun.parts, ring.parts};
  if (!ring_mesh.coupling) return errors;
  errors.ring_mode = ring_mesh.coupling->frequency_error_relative;
  errors.ring_mode_parts.model = fem::plane_strain_bounds(*ring_mesh.model.problem).frequency;
  errors.ring_mode_parts.discretisation = errors.ring_mode - errors.ring_mode_parts.model;
  return errors;
}

StageModes stage_modes(const dynamics::PlanetaryStage& stage, const MeshStiffnessErrors& errors) {
  const auto modes = dynamics::modes(stage);
  StageModes result;
  result.shapes.columns = {"mode", "frequency_Hz"};
  result.shapes.columns.insert(result.shapes.columns.end(), modes.dofs.begin(), modes.dofs.end());
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    const auto& mode = modes.modes[i];
    result.list.push_back(
        {.frequency = mode.frequency, .kind = dynamics::to_string(modes.kinds[i]), .strain = {}, .kinetic = {}});
    auto& row = result.shapes.rows.emplace_back(std::vector{static_cast<double>(result.list.size()), mode.frequency});
    // The largest amplitude is 1: only the shape means something.
    Eigen::Index top = 0;
    (void)mode.shape.cwiseAbs().maxCoeff(&top);
    for (const double value : mode.shape) row.push_back(value / mode.shape[top]);
  }
  if (modes.modes.empty()) return result;
  add_energies(result, stage, modes);
  const auto share_of = [&](const StageModes::Mode& mode, const char* group) {
    const auto found = std::find(result.groups.begin(), result.groups.end(), group);
    return found == result.groups.end() ? 0 : mode.strain[static_cast<std::size_t>(found - result.groups.begin())];
  };
  for (auto& mode : result.list) {  // the first two groups are the meshes
    const double of_sun = mode.frequency / 2 * mode.strain[0], of_ring = mode.frequency / 2 * mode.strain[1],
                 of_ring_mode = mode.frequency * std::abs(share_of(mode, "ring_mode") + share_of(mode, "ring_body"));
    mode.frequency_error = of_sun * errors.sun_planet + of_ring * errors.ring_planet + of_ring_mode * errors.ring_mode;
    mode.error_parts = of_sun * errors.sun_parts;
    mode.error_parts += of_ring * errors.ring_parts;
    mode.error_parts += of_ring_mode * errors.ring_mode_parts;
  }
  add_operating_speed(result, stage);
  if (stage.carrier_speed > 0) add_campbell(result, stage);
  return result;
}

FigureSet frequency_figures(const StageModes& modes) {
  constexpr double same = 1e-6;  // modes in pairs agree to rounding, neighbours of different kind do not
  FigureSet set;
  double last = 0;
  int count = 0;
  for (const auto& mode : modes.list) {
    if (!(mode.frequency > last * (1 + same)) || count == dynamics::planetary_frequencies) continue;
    set.set(fmt::format("frequency_{}_Hz", ++count), {mode.frequency, mode.frequency_error}, mode.error_parts);
    last = mode.frequency;
  }
  return set;
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
