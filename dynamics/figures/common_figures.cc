#include "dynamics/figures/common_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/not_known.h"

namespace annulus::dynamics {

namespace {

std::string frequency_key(int i) { return fmt::format("frequency_{}_Hz", i); }

}  // namespace

FigureSpec steady_figure() {
  return {.key = "steady",
          .title = "Periodic",
          .definition = "1 if a periodic steady state was found, otherwise 0",
          .term = "error_period",
          .better = Better::larger,
          .headline = true};
}

FigureSpec motions_figure() {
  return {.key = motions_key,
          .title = "Stable motions",
          .definition =
              "number of stable motions found from the initial conditions of dynamics.starts; results are "
              "those of the motion with the largest mesh force. 1 where backlash is out of reach",
          .term = "stable_motions",
          .better = Better::smaller,
          .effort = FigureEffort::motion};
}

double number_of(const FoundMotions& motions) {
  if (!motions.not_tried.empty() || std::isnan(motions.reach)) return not_known;
  return std::max<double>(1, static_cast<double>(motions.list.size()));
}

std::vector<FigureSpec> force_factor_figures(const std::string& prefix, const std::string& meshes,
                                             const std::string& nominal_force) {
  const auto peak_key = prefix + "peak_factor";
  return {{.key = prefix + "dynamic_factor",
           .title = "Dynamic factor of " + meshes,
           .symbol = "K_V",
           .axis = "largest force / mean of its mesh cycle",
           .definition = "largest over the meshes and instants of |F| over the mean of F in the mesh cycle around that "
                         "instant; without load sharing, as ISO 6336-1 defines K_V",
           .term = "dynamic_factor",
           .better = Better::smaller,
           .quantity = "dynamic_factor",
           .headline = true,
           .compared = true,
           .plotted = true,
           .spread = true,
           .beside = peak_key},
          {.key = peak_key,
           .title = "Peak factor of " + meshes,
           .symbol = "K_γ K_V",
           .axis = "largest force / nominal force",
           .definition = "largest over the meshes and instants of |F| over the nominal force, " + nominal_force +
                         "; load sharing and dynamics together",
           .term = "peak_factor",
           .better = Better::smaller,
           .guarantee = Guarantee::while_in_contact,
           .quantity = "peak_factor",
           .headline = true,
           .compared = true,
           .cost_study = true,
           .spread = true}};
}

FigureSpec contact_loss_figure(const std::string& key, const std::string& title, const std::string& axis,
                               const std::string& definition) {
  return {.key = key,
          .title = title,
          .unit = "%",
          .scale = 100,
          .axis = axis,
          .definition = definition,
          .term = "contact_loss",
          .better = Better::smaller,
          .headline = true,
          .plotted = true};
}

std::vector<FigureSpec> frequency_specs(int count, const std::string& definition) {
  std::vector<FigureSpec> list;
  for (int i = 1; i <= count; ++i)
    list.push_back({.key = frequency_key(i),
                    .title = fmt::format("Natural frequency {}", i),
                    .unit = "Hz",
                    .definition = definition,
                    .term = "natural_frequency",
                    .effort = FigureEffort::motion,
                    .guarantee = Guarantee::always,
                    .digits = 5,
                    .headline = i <= 3,
                    .compared = i <= 5,
                    .cost_study = i <= 3});
  return list;
}

FigureSet frequency_figures(const std::vector<Frequency>& frequencies, int count, Multiples multiples) {
  constexpr double same = 1e-6;  // modes in pairs agree to rounding, neighbours of different kind do not
  const double apart = multiples == Multiples::once ? 1 + same : 0;
  FigureSet set;
  double last = 0;
  int found = 0;
  for (const auto& [figure, parts] : frequencies) {
    if (found == count || !(figure.value > last * apart) || !(figure.value > 0)) continue;
    set.set(frequency_key(++found), figure, parts);
    last = figure.value;
  }
  return set;
}

FigureSet frequency_figures(const Modes& modes, int count, Multiples multiples) {
  std::vector<Frequency> list;
  for (const auto& mode : modes.modes) list.push_back({{mode.frequency, 0}});
  return frequency_figures(list, count, multiples);
}

void widen_frequencies(FigureSet& figures) {
  std::vector<Frequency> list;
  const auto next = [&] { return figures.find(frequency_key(static_cast<int>(list.size()) + 1)); };
  for (const auto* entry = next(); entry; entry = next()) list.push_back({entry->figure, entry->parts});
  widen_to_neighbours(list);
  for (std::size_t i = 0; i < list.size(); ++i)
    figures.set(frequency_key(static_cast<int>(i) + 1), list[i].figure, list[i].parts);
}

}  // namespace annulus::dynamics
