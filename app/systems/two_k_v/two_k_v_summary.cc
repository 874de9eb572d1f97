#include "app/model/found_motions.h"
#include "app/sections/report_parts.h"
#include "app/sections/shafts.h"
#include "app/study/summary_studies.h"
#include "app/systems/two_k_v/two_k_v_run.h"
#include "core/json.h"

namespace annulus::app {

namespace {

Json mesh_json_of(const MeshResult& mesh) {
  const auto k = mesh.mean_stiffness();
  Json json = {{"model", mesh.model.fidelity},
               {"mean_stiffness_N_per_m",
                {{"value", json_number(k.value)},
                 {"error_relative", json_number(k.error_relative)},
                 {"error_parts_relative", to_json(k.parts)}}},
               {"nominal_load_N", mesh.table.loads()[mesh.nominal]},
               {"reused", mesh.reused}};
  for (const auto& [name, value] : mesh.facts) json[name] = json_number(value);
  return json;
}

Json vibration_json(const TwoKVVibration& v) {
  Json json = {
      {"first_frequency_Hz", v.first_frequency()}, {"frequencies_Hz", Json::array()}, {"modes", Json::array()}};
  for (std::size_t m = 0; m < v.modes.modes.size(); ++m) {
    json["frequencies_Hz"].push_back(v.modes.modes[m].frequency);
    const auto row = v.over_crank.frequency.row(static_cast<Eigen::Index>(m));
    json["modes"].push_back({{"frequency_Hz", v.modes.modes[m].frequency},
                             {"name", v.names[m]},
                             {"smallest_over_crank_Hz", row.minCoeff()},
                             {"largest_over_crank_Hz", row.maxCoeff()}});
  }
  json["torsional_stiffness"] = {{"mean_Nm_per_rad", v.torsion.mean()}, {"ripple", v.torsion.ripple()}};
  json["one_degree_of_freedom"] = {{"stiffness_Nm_per_rad", v.estimate.stiffness},
                                   {"input_inertia_at_output_kg_m2", v.estimate.input_inertia},
                                   {"train_inertia_at_output_kg_m2", v.estimate.train_inertia},
                                   {"frequency_of_input_Hz", v.estimate.input_frequency},
                                   {"frequency_of_train_Hz", v.estimate.train_frequency}};
  json["lost_motion"] = {
      {"backlash_rad", v.lost.backlash}, {"elastic_rad", v.lost.elastic}, {"wind_up_rad", v.lost.wind_up}};
  for (const auto& input : v.inputs)
    json["first_frequency_inputs"].push_back({{"input", input.key},
                                              {"value_SI", input.value},
                                              {"d_ln_f_per_d_ln_p", input.sensitivity},
                                              {"factor_low", json_number(input.band.low)},
                                              {"factor_high", json_number(input.band.high)}});
  return json;
}

Json motion_summary(const TwoKVMotion& m) {
  Json json = {{"motions", to_json(m.motions)},
               {"steady", m.steady},
               {"steady_difference", json_number(m.steady_difference)},
               {"largest_multiplier", json_number(m.largest_multiplier)},
               {"torque_balance_relative", json_number(m.torque_balance_relative)},
               {"energy_balance_relative", json_number(m.energy_relative)},
               {"output_error_peak_to_peak_rad", to_json(m.error_peak_to_peak)},
               {"output_error_mean_rad", m.error_mean},
               {"output_error_quasi_static_rad", m.static_error_peak_to_peak}};
  for (const bool arc : {false, true})
    for (const auto& mesh : arc ? m.arc_pins : m.sun_planet)
      json[arc ? "arc_pins" : "sun_planet"].push_back({{"dynamic_factor", to_json(mesh.dynamic_factor)},
                                                       {"peak_factor", to_json(mesh.peak_factor)},
                                                       {"smallest_factor", mesh.smallest_factor},
                                                       {"contact_loss", mesh.contact_loss.value}});
  if (!m.shafts.empty()) json["shafts"] = to_json(m.shafts);
  json["arc_bearing_force_N"] = to_json(m.results.figure("arc_bearing_force_N"));
  json["reused"] = m.reused;
  return json;
}

Json case_json(const TwoKVCase& c) {
  Json json = {{"sun_planet", mesh_json_of(c.tables.sun)}, {"arc_pins", mesh_json_of(c.tables.arc)}};
  if (c.vibration) json["vibration"] = vibration_json(*c.vibration);
  if (c.motion) json["motion"] = motion_summary(*c.motion);
  return json;
}

}  // namespace

Json two_k_v_summary(const TwoKVResult& result) {
  Json json = Json::object();
  for (const auto& q : result.plan.quantities) json["operating_point"][q.key] = q.value;
  json.update(case_json(result.own));
  if (result.computed) json["computed"] = case_json(*result.computed);
  json.update(variant_studies_json(result.studies, 0));
  return json;
}

std::string two_k_v_text(const TwoKVResult& result) { return key_results_text(result); }

}  // namespace annulus::app
