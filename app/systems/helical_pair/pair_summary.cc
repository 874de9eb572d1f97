#include <fmt/format.h>

#include <cmath>

#include "app/model/found_motions.h"
#include "app/sections/report_parts.h"
#include "app/sections/shafts.h"
#include "app/study/summary_studies.h"
#include "app/systems/helical_pair/pair_run.h"
#include "core/json.h"
#include "core/units.h"

namespace annulus::app {

namespace {

Json motion_json(const dynamics::MotionFigures& m) {
  return {{"mean_m", to_json(m.mean)}, {"peak_to_peak_m", to_json(m.peak_to_peak)}, {"largest_m", to_json(m.largest)}};
}

Json errors_json(const PairRunResult& result) {
  const auto& problem = *result.errors.problem;
  Json json = {{"samples", problem.samples},       {"seed", problem.seed},       {"probability", problem.probability},
               {"confidence", problem.confidence}, {"divisor", problem.divisor}, {"eta_1_m", problem.eta_1(0)},
               {"eta_2_m", problem.eta_2(0)}};
  for (const auto& r : result.errors.law->readings)
    json["readings"][r.name] = {{"quantity", r.quantity},
                                {"sample_m", r.sample.value},
                                {"low_m", json_number(r.sample.low)},
                                {"high_m", json_number(r.sample.high)},
                                {"exact_m", r.exact}};
  const auto* taken = result.errors.taken(result.scene);
  json["applied"] = taken ? Json(taken->name) : Json(nullptr);
  return json;
}

Json share_json(const ShareRow& row) {
  if (!row.failure.empty()) return {{"pinion_torque_Nm", row.pinion_torque}, {"failure", row.failure}};
  const auto& s = row.shares;
  const auto range = [](const dynamics::PeakToPeak& p) {
    return Json{{"dynamic", json_number(p.dynamic)}, {"quasi_static", json_number(p.quasi_static)}};
  };
  return {{"pinion_torque_Nm", row.pinion_torque},
          {"load_deflection_m", s.load_deflection},
          {"peak_to_peak_m", range(s.all)},
          {"errors_alone_m", range(s.errors_alone)},
          {"stiffness_alone_m", range(s.stiffness_alone)},
          {"error_share", range(s.error_share())},
          {"largest_m", range({row.largest_dynamic, row.largest_static})}};
}

Json response_json_of(const PairResponseResult& response) {
  const auto& f = response.figures;
  Json json = {{"mesh_frequency_Hz", f.mesh_frequency},
               {"static_force_N", f.static_force},
               {"mesh_force_max_N", to_json(dynamics::loaded_force(f).largest)},
               {"mesh_force_min_N", to_json(dynamics::loaded_force(f).smallest)},
               {"dynamic_factor", to_json(f.dynamic_factor)},
               {"peak_factor", to_json(f.peak_factor)},
               {"contact_loss", to_json(f.contact_loss)},
               {"acceleration_m_per_s2",
                {{"tooth", to_json(f.acceleration.tooth)},
                 {"line_of_action", to_json(f.acceleration.line_of_action)},
                 {"axial", to_json(f.acceleration.axial)},
                 {"rotation", to_json(f.acceleration.rotation)}}},
               {"transmission_error", motion_json(f.dynamic.transmission_error)},
               {"transmission_error_quasi_static", motion_json(f.quasi_static.transmission_error)},
               {"relative_motion", motion_json(f.dynamic.relative)},
               {"motions", to_json(f.motions)},
               {"steady", f.steady},
               {"confirmed", f.confirmed},
               {"window_cycles", f.window_cycles},
               {"total_cycles", f.total_cycles},
               {"energy_balance_relative", json_number(f.energy.relative)}};
  if (!f.shafts.empty()) json["shafts"] = to_json(f.shafts);
  auto frequencies = Json::array();
  for (const auto& mode : response.modes.modes) frequencies.push_back(mode.frequency);
  json["natural_frequencies_Hz"] = std::move(frequencies);
  add_json(json, response.space);
  return json;
}

}  // namespace

Json pair_summary(const PairRunResult& result) {
  Json json = Json::object();
  for (const auto& q : result.plan.quantities) json["derived"][q.key] = json_number(q.value);
  for (const auto& s : result.stiffnesses)
    json["mean_stiffness_N_per_m"][s.source] = {
        {"value", json_number(s.value)}, {"error_relative", json_number(s.error_relative)}, {"applied", s.taken}};
  if (const auto& computed = result.mesh.computed) {
    auto& item =
        json["pinion_wheel"] = {{"model", computed->model.fidelity},
                                {"contact_ratio", computed->contact_ratio},
                                {"transverse_mean_stiffness_N_per_m", computed->mean_stiffness().value},
                                {"lte_mean_m", computed->lte_mean().value},
                                {"lte_peak_to_peak_m", computed->lte_peak_to_peak().value},
                                {"stiffness_error_parts_relative", to_json(computed->mean_stiffness().parts)},
                                {"lte_peak_to_peak_error_parts_relative", to_json(computed->lte_peak_to_peak().parts)},
                                {"reused", computed->reused},
                                {"inputs_id", computed->model.id()}};
    for (const auto& [name, value] : computed->facts) item[name] = json_number(value);
  }
  json["mesh_error_m"] = result.errors.amplitude;
  if (result.errors.law) json["manufacturing_error"] = errors_json(result);
  if (result.response) json["response"] = response_json_of(*result.response);
  if (!result.shares.empty()) {
    auto list = Json::array();
    for (const auto& row : result.shares) list.push_back(share_json(row));
    json["transmission_error_shares"] = std::move(list);
  }
  for (const auto& row : result.speeds) {
    if (!row.failure.empty()) continue;
    const auto motion = [](const SpeedRow::Motion& m) {
      return Json{{"acceleration_m_per_s2", m.acceleration},
                  {"force_peak_to_peak_N", m.peak_to_peak_force},
                  {"transmission_error_m", m.peak_to_peak_te}};
    };
    json["causes_over_speed"].push_back({{"pinion_speed_rpm", row.pinion_speed / units::rpm},
                                         {"all", motion(row.all)},
                                         {"errors_alone", motion(row.errors_alone)},
                                         {"stiffness_alone", motion(row.stiffness_alone)}});
  }
  if (!result.studies.variants.empty()) json.update(variant_studies_json(result.studies, 0));
  return json;
}

std::string pair_text(const PairRunResult& result) {
  std::string text;
  for (const auto& s : result.stiffnesses) {
    if (!std::isfinite(s.value)) continue;
    text += fmt::format("mean stiffness {:<12} {} along the normal{}\n", s.source,
                        text_in_unit(s.value, shown_units::stiffness), s.taken ? "  (applied)" : "");
  }
  if (const auto* taken = result.errors.taken(result.scene))
    text += fmt::format("mesh error     {:.2f} µm: {}, quantile at {}, {} draws ({:.2f} to {:.2f}; exact {:.2f})\n",
                        1e6 * result.errors.amplitude, taken->name, to_text(result.errors.problem->probability),
                        result.errors.problem->samples, 1e6 * taken->sample.low, 1e6 * taken->sample.high,
                        1e6 * taken->exact);
  return text + key_results_text(result);
}

}  // namespace annulus::app
