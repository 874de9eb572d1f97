#include "dynamics/systems/two_k_v/two_k_v_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "core/units.h"
#include "dynamics/figures/common_figures.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"

namespace annulus::dynamics {

namespace {

constexpr std::pair<const char*, const char*> mesh_kinds[] = {{"sun_planet_", "sun meshes"},
                                                              {"arc_pins_", "arc meshes"}};

FigureSpec angle(const char* key, const char* title, const char* definition) {
  return {.key = key,
          .title = title,
          .unit = "arc seconds",
          .scale = 1 / units::arc_second,
          .definition = definition,
          .better = Better::smaller};
}

void declare_statics(std::vector<FigureSpec>& list) {
  list = frequency_specs(two_k_v_frequencies,
                         "undamped natural frequencies above zero, rising, at the crank angle of the scene and with "
                         "the mean mesh stiffness");
  for (auto& spec : list) spec.effort = FigureEffort::forces;
  list.front().plotted = list.front().spread = list.front().ordering = true;
  list.push_back({.key = "torsional_stiffness_Nm_per_rad",
                  .title = "Torsional stiffness from the output",
                  .unit = "kN m/rad",
                  .scale = 1e-3,
                  .definition = "mean over a crank turn of torque over twist of the output, with the input fixed",
                  .term = "torsional_stiffness",
                  .better = Better::larger,
                  .digits = 5,
                  .headline = true,
                  .compared = true,
                  .plotted = true,
                  .spread = true,
                  .ordering = true});
  list.push_back({.key = "torsional_stiffness_ripple",
                  .title = "Range of the torsional stiffness over a crank turn",
                  .unit = "%",
                  .scale = 100,
                  .axis = "% of the mean",
                  .definition = "(largest - smallest) / mean over a crank turn",
                  .better = Better::smaller,
                  .spread = true});
  auto wind_up = angle("wind_up_rad", "Wind-up of the output under load", "output torque / mean torsional stiffness");
  wind_up.spread = true;
  list.push_back(wind_up);
  auto lost =
      angle("lost_motion_rad", "Lost motion of the output",
            "rotation of the output between -3 % and +3 % of its torque, with the input fixed and with backlash");
  lost.spread = lost.headline = true;
  list.push_back(lost);
}

void declare_motion(std::vector<FigureSpec>& list) {
  list.push_back(steady_figure());
  list.push_back(motions_figure());
  auto error = angle("output_error_peak_to_peak_rad", "Error of the output",
                     "peak-to-peak value over the window of θ_output - θ_input / ratio");
  error.axis = "peak to peak, arc seconds";
  error.effort = FigureEffort::motion;
  error.headline = error.compared = error.cost_study = error.plotted = error.ordering = true;
  error.beside = "output_error_quasi_static_rad";
  list.push_back(error);
  auto still =
      angle("output_error_quasi_static_rad", "Error of the output, quasi-static",
            "peak-to-peak value over the positions of θ_output - θ_input / ratio, without inertia and damping");
  still.axis = error.axis;
  still.effort = FigureEffort::motion;
  list.push_back(still);
  const auto first = list.size();
  for (const auto& [prefix, meshes] : mesh_kinds) {
    const auto factors =
        force_factor_figures(prefix, std::string("the ") + meshes, "that of equal shares without motion");
    list.insert(list.end(), factors.begin(), factors.end());
  }
  for (const auto& [prefix, meshes] : mesh_kinds)
    list.push_back(contact_loss_figure(
        std::string(prefix) + "contact_loss", std::string("Time without contact, ") + meshes, "worst, %",
        "largest over the meshes of the fraction of the time in which no tooth touches"));
  for (auto i = first; i < list.size(); ++i) {
    list[i].effort = FigureEffort::motion;
    list[i].spread = false;  // samples do not simulate the motion
  }
  list.push_back(shaft_figure());
  list.back().effort = FigureEffort::motion;
  list.back().spread = false;
  list.push_back({.key = "arc_bearing_force_N",
                  .title = "Largest force of an eccentric's bearing",
                  .unit = "N",
                  .definition = "largest over the bearings and instants of the resultant force",
                  .better = Better::smaller,
                  .effort = FigureEffort::motion});
}

/// Positions over a crank turn. No mesh has a whole number of cycles between two of them, so each meets as many phases.
int stiffness_positions(const TwoKVStage& stage) {
  int count = 37;
  while (std::gcd(count, stage.planet_teeth) != 1 || std::gcd(count, stage.arc_teeth) != 1) ++count;
  return count;
}

}  // namespace

const std::vector<FigureSpec>& two_k_v_figures() {
  static const auto list = [] {
    std::vector<FigureSpec> specs;
    declare_statics(specs);
    declare_motion(specs);
    return specs;
  }();
  return list;
}

bool output_moves(double peak_to_peak, double static_peak_to_peak, double mean) {
  constexpr double rounding = 1e-9;  // of the wind-up: a thousandth of what the integrators resolve
  return std::max(peak_to_peak, static_peak_to_peak) > rounding * std::abs(mean);
}

FigureSet static_figures(const TwoKVStage& at_nominal, double arc_clearance) {
  FigureSet set = frequency_figures(modes(at_nominal), two_k_v_frequencies, Multiples::listed);
  const auto torsion = torsional_stiffness(at_nominal, stiffness_positions(at_nominal));
  const auto lost = lost_motion(at_nominal, torsion.mean(), arc_clearance);
  constexpr double rounding = 1e-10;  // of the condensation
  // Statics and modes are exact for the stage that they are asked of.
  const auto exact = [&](const char* key, double value) { set.set(key, Figure{value, 0}); };
  exact("torsional_stiffness_Nm_per_rad", torsion.mean());
  exact("torsional_stiffness_ripple", torsion.ripple() > rounding ? torsion.ripple() : 0);
  exact("wind_up_rad", lost.wind_up);
  exact("lost_motion_rad", lost.total());
  return set;
}

FigureSet figures(const TwoKVStage& stage, const TwoKVResponse& r) {
  const auto& range = r.dynamic.peak_to_peak;
  const double static_range = r.quasi_static.peak_to_peak.value;
  const bool still = constant_stiffness(stage) && r.steady && !output_moves(range.value, static_range, r.dynamic.mean);
  FigureSet set;
  set.set("steady", r.steady ? 1 : 0);
  set.set(motions_key, number_of(r.motions));
  set.set("output_error_peak_to_peak_rad", still ? Figure{} : range);
  set.set("output_error_quasi_static_rad", still ? Figure{} : r.quasi_static.peak_to_peak);
  const std::vector<BranchResult>* kinds[] = {&r.sun_planet, &r.arc_pins};
  for (std::size_t k = 0; k < std::size(kinds); ++k) {
    const std::string prefix = mesh_kinds[k].first;
    for (const auto& [key, factor] :
         {std::pair{"peak_factor", &BranchResult::peak_factor}, {"dynamic_factor", &BranchResult::dynamic_factor}})
      set.set(prefix + key, still ? Figure{1, 0} : largest(*kinds[k], factor));
    set.set(prefix + "contact_loss", largest(*kinds[k], &BranchResult::contact_loss));
  }
  add_shafts(set, r.shafts);
  Figure bearing;
  for (const auto& b : r.arc_bearings)
    if (b.largest.value > bearing.value) bearing = b.largest;
  set.set("arc_bearing_force_N", bearing);
  return set;
}

}  // namespace annulus::dynamics
