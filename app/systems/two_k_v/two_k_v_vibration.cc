#include "app/systems/two_k_v/two_k_v_vibration.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/results/content_id.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/not_known.h"
#include "core/units.h"

namespace annulus::app {

namespace {

struct NamedInput {
  const char *name, *key, *unit;
};
constexpr std::array named_inputs = {
    NamedInput{"input_inertia", "input.inertia_kg_m2", "kg m²"},
    NamedInput{"sun_inertia", "sun.inertia_kg_m2", "kg m²"},
    NamedInput{"planet_inertia", "planet.inertia_kg_m2", "kg m²"},
    NamedInput{"planet_mass", "planet.mass_kg", "kg"},
    NamedInput{"crank_inertia", "crank.inertia_kg_m2", "kg m²"},
    NamedInput{"arc_inertia", "arc_gear.inertia_kg_m2", "kg m²"},
    NamedInput{"arc_mass", "arc_gear.mass_kg", "kg"},
    NamedInput{"output_inertia", "output.inertia_kg_m2", "kg m²"},
    NamedInput{"input_shaft", "input.shaft_Nm_per_rad", "N m/rad"},
    NamedInput{"crank_shaft", "crank.shaft_Nm_per_rad", "N m/rad"},
    NamedInput{"crank_bearing", "crank.bearing_N_per_m", "N/m"},
    NamedInput{"arc_bearing", "arc_gear.bearing_N_per_m", "N/m"},
    NamedInput{"sun_mesh", "mesh.sun_planet.mean_N_per_m", "N/m"},
    NamedInput{"arc_mesh", "mesh.arc_pins.mean_N_per_m", "N/m"},
    NamedInput{"input_support", "input.support_Nm_per_rad", "N m/rad"},
    NamedInput{"output_support", "output.support_Nm_per_rad", "N m/rad"},
    NamedInput{"module", "stage.module_mm", "m"},
    NamedInput{"pressure_angle", "stage.pressure_angle_deg", "rad"},
    NamedInput{"eccentricity", "arc_gear.eccentricity_mm", "m"},
};

std::vector<FrequencyInput> frequency_inputs_of(const dynamics::TwoKVStage& stage, double first,
                                                const std::vector<double>& targets) {
  std::vector<FrequencyInput> list;
  for (const auto& s : dynamics::first_frequency_sensitivities(stage)) {
    const NamedInput* known = nullptr;
    for (const auto& named : named_inputs)
      if (s.input == named.name) known = &named;
    if (!known) throw InternalError("internal error: an input of the first frequency without a key: " + s.input);
    list.push_back({s.input,
                    known->key,
                    dynamics::input_value(stage, s.input),
                    known->unit,
                    s.value,
                    dynamics::band_of_input(stage, s.input, first, frequency_band),
                    {}});
    for (const double target : targets)
      list.back().reaching.push_back(dynamics::factor_reaching(stage, s.input, target));
  }
  return list;
}

}  // namespace

TwoKVVibration vibration_of(const dynamics::TwoKVStage& stage, double arc_clearance,
                            const std::vector<double>& targets) {
  TwoKVVibration v;
  v.targets = targets;
  v.modes = dynamics::modes(stage);
  v.energy = dynamics::modal_energy(stage, v.modes);
  const auto grouped = dynamics::by_group(v.energy);
  for (Eigen::Index m = 0; m < grouped.strain.cols(); ++m) v.names.push_back(dynamics::mode_name(grouped, m));
  const int positions = dynamics::crank_positions(stage);
  v.over_crank = dynamics::modes_over_crank(stage, positions);
  v.torsion = dynamics::torsional_stiffness(stage, positions);
  v.estimate = dynamics::one_dof(stage);
  v.lost = dynamics::lost_motion(stage, v.torsion.mean(), arc_clearance);
  v.inputs = frequency_inputs_of(stage, v.first_frequency(), targets);
  return v;
}

void write_vibration(const TwoKVVibration& v, const std::filesystem::path& folder) {
  const auto write = [&](Csv csv, const char* name) {
    csv.header.insert(csv.header.begin(), {"annulus_version", version()});
    csv.write(folder / name);
  };
  std::filesystem::create_directories(folder);
  const auto modes = static_cast<Eigen::Index>(v.modes.modes.size());

  Csv list{.header = {}, .columns = {"mode", "frequency_Hz"}, .rows = {}};
  for (const auto& body : v.energy.bodies) list.columns.push_back("kinetic_" + body);
  for (const auto& element : v.energy.elements) list.columns.push_back("strain_" + element);
  Csv shapes{.header = {{"shapes", "displacements in m, mass-normalised; angle = displacement / radius"}},
             .columns = {"mode", "frequency_Hz"},
             .rows = {}};
  for (const auto& dof : v.modes.dofs) shapes.columns.push_back(dof);
  for (Eigen::Index m = 0; m < modes; ++m) {
    const auto& mode = v.modes.modes[static_cast<std::size_t>(m)];
    auto& row = list.rows.emplace_back(std::vector{static_cast<double>(m + 1), mode.frequency});
    for (Eigen::Index i = 0; i < v.energy.kinetic.rows(); ++i) row.push_back(v.energy.kinetic(i, m));
    for (Eigen::Index i = 0; i < v.energy.strain.rows(); ++i) row.push_back(v.energy.strain(i, m));
    auto& shape = shapes.rows.emplace_back(std::vector{static_cast<double>(m + 1), mode.frequency});
    shape.insert(shape.end(), mode.shape.begin(), mode.shape.end());
    list.header.emplace_back(fmt::format("mode_{}", m + 1), v.names[static_cast<std::size_t>(m)]);
  }
  write(std::move(list), "modes.csv");
  write(shapes, "mode_shapes.csv");

  Csv crank{.header = {}, .columns = {"crank_angle_deg"}, .rows = {}};
  for (Eigen::Index m = 0; m < modes; ++m) crank.columns.push_back(fmt::format("mode{}_Hz", m + 1));
  Csv torsion{
      .header = {}, .columns = {"crank_angle_deg", "from_output_Nm_per_rad", "from_input_Nm_per_rad"}, .rows = {}};
  Csv over_crank = shapes;
  over_crank.rows.clear();
  over_crank.columns.insert(over_crank.columns.begin(), "crank_angle_deg");
  for (Eigen::Index i = 0; i < v.over_crank.angle.size(); ++i) {
    const auto& at = v.over_crank.modes[static_cast<std::size_t>(i)].modes;
    for (std::size_t m = 0; m < at.size(); ++m) {
      auto& row = over_crank.rows.emplace_back(
          std::vector{v.over_crank.angle[i] / units::deg, static_cast<double>(m + 1), at[m].frequency});
      row.insert(row.end(), at[m].shape.begin(), at[m].shape.end());
    }
    auto& row = crank.rows.emplace_back(1, v.over_crank.angle[i] / units::deg);
    for (Eigen::Index m = 0; m < modes; ++m) row.push_back(v.over_crank.frequency(m, i));
    torsion.rows.push_back({v.torsion.angle[i] / units::deg, v.torsion.from_output[i], v.torsion.from_input[i]});
  }
  write(std::move(crank), "modes_over_crank.csv");
  write(std::move(over_crank), "mode_shapes_over_crank.csv");
  write(std::move(torsion), "torsional_stiffness.csv");

  Csv inputs{
      .header = {}, .columns = {"input", "value_SI", "d_ln_f1_per_d_ln_p", "factor_low", "factor_high"}, .rows = {}};
  for (std::size_t i = 0; i < v.inputs.size(); ++i) {
    const auto& input = v.inputs[i];
    inputs.header.emplace_back(fmt::format("input_{}", i + 1), input.key);
    const double none = not_known;
    inputs.rows.push_back({static_cast<double>(i + 1), input.value, input.sensitivity, input.band.low.value_or(none),
                           input.band.high.value_or(none)});
  }
  write(std::move(inputs), "sensitivity_f1.csv");
}

}  // namespace annulus::app
