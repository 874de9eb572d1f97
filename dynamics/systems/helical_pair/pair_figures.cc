#include "dynamics/systems/helical_pair/pair_figures.h"

#include "dynamics/figures/common_figures.h"

namespace annulus::dynamics {

namespace {

FigureSpec length(const char* key, const char* title, const char* definition) {
  return {.key = key, .title = title, .unit = "µm", .scale = 1e6, .definition = definition, .better = Better::smaller};
}

FigureSpec acceleration(const char* key, const char* title, const char* definition) {
  return {.key = key, .title = title, .unit = "m/s²", .definition = definition, .better = Better::smaller};
}

std::vector<FigureSpec> pair_specs() {
  std::vector<FigureSpec> list;
  auto tooth = acceleration("acceleration_max_m_per_s2", "Largest acceleration of the teeth",
                            "largest over time and both gears of |(u'' ± y'', z'')| of the teeth in mesh");
  tooth.headline = tooth.compared = tooth.cost_study = tooth.plotted = tooth.spread = tooth.ordering = true;
  list.push_back(tooth);
  list.push_back(acceleration("acceleration_line_of_action_m_per_s2",
                              "Largest acceleration of the axes along the line of action",
                              "largest over time and both gears of |y''|"));
  list.push_back(acceleration("acceleration_axial_m_per_s2", "Largest axial acceleration",
                              "largest over time and both gears of |z''|"));
  list.push_back(acceleration("acceleration_rotation_m_per_s2", "Largest acceleration of the base circles",
                              "largest over time and both gears of |r θ''|"));
  list.push_back({.key = "mesh_force_max_N",
                  .title = "Largest mesh force",
                  .unit = "kN",
                  .scale = 1e-3,
                  .definition = "largest mesh force over time, in the direction of the load",
                  .better = Better::smaller,
                  .headline = true,
                  .compared = true,
                  .plotted = true,
                  .spread = true});
  list.push_back({.key = "mesh_force_min_N",
                  .title = "Smallest mesh force",
                  .unit = "kN",
                  .scale = 1e-3,
                  .definition = "smallest mesh force over time, in the direction of the load"});
  auto factors = force_factor_figures("", "the mesh", "T_1 / (r_b1 cos β_b)");
  factors.back().ordering = true;
  list.insert(list.end(), factors.begin(), factors.end());
  list.push_back(contact_loss_figure("contact_loss", "Time without contact", "",
                                     "fraction of the time in which no tooth touches"));
  auto largest = length("transmission_error_max_m", "Largest transmission error",
                        "largest over time of |u_1 + u_2|, the mean included");
  largest.plotted = largest.spread = true;
  largest.beside = "transmission_error_static_max_m";
  list.push_back(largest);
  auto range = length("transmission_error_peak_to_peak_m", "Transmission error, peak to peak",
                      "peak-to-peak value over time of u_1 + u_2");
  range.headline = range.compared = range.cost_study = range.plotted = range.spread = range.ordering = true;
  range.beside = "transmission_error_static_peak_to_peak_m";
  list.push_back(range);
  list.push_back(length("transmission_error_mean_m", "Transmission error, mean", "mean over time of u_1 + u_2"));
  list.push_back(length("transmission_error_static_mean_m", "Transmission error, mean, quasi-static",
                        "mean over the positions of u_1 + u_2, without inertia and damping"));
  list.push_back(length("transmission_error_static_max_m", "Largest transmission error, quasi-static",
                        "largest over the positions of |u_1 + u_2|, without inertia and damping"));
  list.push_back(length("transmission_error_static_peak_to_peak_m", "Transmission error, peak to peak, quasi-static",
                        "peak-to-peak value over the positions of u_1 + u_2, without inertia and damping"));
  list.push_back(length("relative_motion_mean_m", "Relative motion with the bending of shafts and bearings, mean",
                        "mean over time of y_1 + u_1 - y_2 + u_2"));
  list.push_back(length("relative_motion_max_m", "Largest relative motion with the bending of shafts and bearings",
                        "largest over time of |y_1 + u_1 - y_2 + u_2|, the mean included"));
  list.push_back(length("relative_motion_peak_to_peak_m",
                        "Relative motion with the bending of shafts and bearings, peak to peak",
                        "peak-to-peak value over time of y_1 + u_1 - y_2 + u_2"));
  list.push_back(shaft_figure());
  list.push_back(steady_figure());
  list.push_back(motions_figure());
  const auto frequencies = frequency_specs(
      pair_frequencies, "undamped natural frequencies above zero, rising, with the mean mesh stiffness");
  list.insert(list.end(), frequencies.begin(), frequencies.end());
  return list;
}

}  // namespace

const std::vector<FigureSpec>& pair_figures() {
  static const auto list = pair_specs();
  return list;
}

LoadedForce loaded_force(const PairResponse& r) {
  if (r.static_force >= 0) return {r.force_max, r.force_min};
  return {{-r.force_min.value, r.force_min.error}, {-r.force_max.value, r.force_max.error}};
}

FigureSet figures(const PairResponse& r) {
  const auto& te = r.dynamic.transmission_error;
  const auto& still = r.quasi_static.transmission_error;
  const auto force = loaded_force(r);
  FigureSet set;
  set.set("acceleration_max_m_per_s2", r.acceleration.tooth);
  set.set("acceleration_line_of_action_m_per_s2", r.acceleration.line_of_action);
  set.set("acceleration_axial_m_per_s2", r.acceleration.axial);
  set.set("acceleration_rotation_m_per_s2", r.acceleration.rotation);
  set.set("mesh_force_max_N", force.largest);
  set.set("mesh_force_min_N", force.smallest);
  set.set("dynamic_factor", r.dynamic_factor);
  set.set("peak_factor", r.peak_factor);
  set.set("contact_loss", r.contact_loss);
  set.set("transmission_error_max_m", te.largest);
  set.set("transmission_error_peak_to_peak_m", te.peak_to_peak);
  set.set("transmission_error_mean_m", te.mean);
  set.set("transmission_error_static_mean_m", still.mean);
  set.set("transmission_error_static_max_m", still.largest);
  set.set("transmission_error_static_peak_to_peak_m", still.peak_to_peak);
  set.set("relative_motion_mean_m", r.dynamic.relative.mean);
  set.set("relative_motion_max_m", r.dynamic.relative.largest);
  set.set("relative_motion_peak_to_peak_m", r.dynamic.relative.peak_to_peak);
  add_shafts(set, r.shafts);
  set.set("steady", r.steady ? 1 : 0);
  set.set(motions_key, number_of(r.motions));
  return set;
}

FigureSet frequency_figures(const HelicalPair& pair) {
  return frequency_figures(modes(pair), pair_frequencies, Multiples::listed);
}

}  // namespace annulus::dynamics
