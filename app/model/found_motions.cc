#include "app/model/found_motions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "core/json.h"

namespace annulus::app {

std::string period_text(const dynamics::FoundMotion& motion) {
  if (motion.period == 0) return "irregular";
  return motion.period == 1 ? "with the excitation" : fmt::format("every {} periods of the excitation", motion.period);
}

Json to_json(const dynamics::FoundMotions& motions) {
  if (motions.starts == 0) return nullptr;
  Json json = {{"reach_of_backlash", json_number(motions.reach)},
               {"starts_wanted", motions.wanted},
               {"starts", motions.starts},
               {"undecided", motions.undecided},
               {"found", Json::array()}};
  for (const auto& m : motions.list)
    json["found"].push_back({{"period", m.period},
                             {"irregular", m.period == 0},
                             {"mesh_force_max_N", m.largest_force},
                             {"contact_loss", m.contact_loss},
                             {"share_of_starts", static_cast<double>(m.starts) / motions.starts},
                             {"results_are_of_it", m.taken}});
  return json;
}

std::vector<Warning> motion_warnings(const dynamics::FoundMotions& motions, double contact_loss,
                                     const std::string& variant) {
  if (!motions.not_tried.empty())
    return {{"motions_not_searched", Severity::warning,
             "backlash is within reach of the vibration, and several motions may exist. Others were not looked for: " +
                 motions.not_tried,
             variant}};
  if (motions.list.size() > 1) {
    std::vector<std::string> found;
    bool largest = false;
    for (const auto& m : motions.list) {
      found.push_back(fmt::format("{:.3g} kN ({}, {} of {} starts)", m.largest_force / 1e3, period_text(m), m.starts,
                                  motions.starts));
      largest = largest || (found.size() == 1 && m.taken);
    }
    return {
        {"several_motions", Severity::warning,
         fmt::format("{} stable motions were found at this speed and load. Their largest mesh forces: {}. The "
                     "results are those of {}. The history of the machine decides which one runs{}",
                     motions.list.size(), fmt::join(found, "; "),
                     largest ? "the first one" : "one with less force, because small disturbances end the first one",
                     motions.undecided > 0 ? fmt::format(". {} starts were not decided", motions.undecided) : ""),
         variant}};
  }
  std::vector<Warning> list;
  if (motions.starts < motions.wanted)
    list.push_back(
        {"few_starts", Severity::note,
         fmt::format("other motions were looked for from {} initial conditions instead of {}, because each "
                     "takes long: a motion to which 5 % of them lead is missed with a probability of {:.0f} %",
                     motions.starts, motions.wanted, 100 * std::pow(0.95, motions.starts)),
         variant});
  if (motions.undecided > 0)
    list.push_back(
        {"motions_undecided", 2 * motions.undecided > motions.starts ? Severity::warning : Severity::note,
         fmt::format("of {} initial conditions, {} still vibrated at the end of the search for other motions, "
                     "or could not be integrated",
                     motions.starts, motions.undecided),
         variant});
  if (contact_loss > 0 && motions.starts == 0)
    list.push_back(
        {"other_steady_states", Severity::warning,
         fmt::format(
             "teeth separate for up to {:.2g} % of the time: other initial conditions may lead to other steady states",
             100 * contact_loss),
         variant});
  return list;
}

}  // namespace annulus::app
