#include "app/compare/compared_figures.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

namespace annulus::app {

namespace {

using FigureJson = nlohmann::ordered_json;
using Form = ComparedFigure::Form;
using FigureList = std::vector<ComparedFigure>;

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t shown_frequencies = 5;

void add_frequencies(FigureList& list, const std::vector<std::string>& path) {
  for (std::size_t i = 0; i < shown_frequencies; ++i)
    list.push_back({fmt::format("natural_frequency_{}", i + 1), fmt::format("natural frequency {}", i + 1), "Hz", 1, 5,
                    path, Form::list_entry, i});
}

FigureList planetary() {
  FigureList list;
  for (const std::string mesh : {"ring", "sun"}) {
    const auto in = mesh + "_planet";
    list.push_back({mesh + "_stiffness",
                    "mean stiffness, " + mesh + " mesh",
                    "N/µm",
                    1e-6,
                    4,
                    {in, "mean_stiffness_N_per_m"},
                    Form::estimate});
    list.push_back({mesh + "_lte_peak_to_peak",
                    "transmission error, peak to peak, " + mesh + " mesh",
                    "µm",
                    1e6,
                    4,
                    {in, "lte_peak_to_peak_m"},
                    Form::estimate});
  }
  for (const std::string mesh : {"sun", "ring"}) {
    for (const auto& [key, words] : {std::pair{"averaged", "averaged over a mesh cycle"},
                                     {"instantaneous", "instantaneous"},
                                     {"quasi_static", "quasi-static"}})
      list.push_back({"load_sharing",
                      fmt::format("load sharing, {} meshes, {}", mesh, words),
                      "",
                      1,
                      5,
                      {"load_sharing", mesh + "_planet", key}});
    list.push_back({"dynamic_factor",
                    "dynamic factor, largest of all " + mesh + " meshes",
                    "",
                    1,
                    4,
                    {"dynamic_factor", mesh + "_planet"},
                    Form::largest_of_list});
  }
  add_frequencies(list, {"natural_frequencies_Hz"});
  return list;
}

FigureList helical_pair() {
  FigureList list = {
      {"mean_stiffness",
       "mean stiffness, normal, as taken",
       "N/µm",
       1e-6,
       4,
       {"mean_stiffness_N_per_m"},
       Form::estimate},
      {"lte_peak_to_peak",
       "computed transmission error, peak to peak",
       "µm",
       1e6,
       4,
       {"pinion_wheel", "lte_peak_to_peak_m"},
       Form::number},
      {"dynamic_factor", "dynamic factor, mesh of pinion and wheel", "", 1, 4, {"response", "dynamic_factor"}},
      {"mesh_force_max", "largest mesh force", "kN", 1e-3, 4, {"response", "mesh_force_max_N"}},
      {"transmission_error",
       "dynamic transmission error, peak to peak",
       "µm",
       1e6,
       4,
       {"response", "transmission_error", "peak_to_peak_m"}},
      {"acceleration", "acceleration of the teeth", "m/s²", 1, 4, {"response", "acceleration_m_per_s2", "tooth"}}};
  add_frequencies(list, {"response", "natural_frequencies_Hz"});
  return list;
}

FigureList two_k_v() {
  FigureList list = {
      {"sun_stiffness",
       "mean stiffness, sun mesh",
       "N/µm",
       1e-6,
       4,
       {"sun_planet", "mean_stiffness_N_per_m"},
       Form::estimate},
      {"arc_stiffness",
       "mean stiffness, arc mesh",
       "N/µm",
       1e-6,
       4,
       {"arc_pins", "mean_stiffness_N_per_m"},
       Form::estimate},
      {"torsional_stiffness",
       "torsional stiffness at the output",
       "N m/rad",
       1,
       5,
       {"vibration", "torsional_stiffness", "mean_Nm_per_rad"},
       Form::number},
      {"output_error", "output error, peak to peak", "µrad", 1e6, 4, {"motion", "output_error_peak_to_peak_rad"}},
      {"dynamic_factor",
       "dynamic factor, largest of all sun meshes",
       "",
       1,
       4,
       {"motion", "sun_planet"},
       Form::largest_of_list},
      {"dynamic_factor",
       "dynamic factor, largest of all arc meshes",
       "",
       1,
       4,
       {"motion", "arc_pins"},
       Form::largest_of_list}};
  add_frequencies(list, {"vibration", "frequencies_Hz"});
  return list;
}

const FigureJson* member(const FigureJson& json, const std::string& key) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? nullptr : &*found;
}

double number_or_nan(const FigureJson* json) { return json ? json->get<double>() : not_known; }

/// {"value": 1, "error": 0.1}, and a bare number without an error.
std::pair<double, double> value_and_error(const FigureJson& json) {
  if (!json.is_object()) return {json.is_null() ? not_known : json.get<double>(), not_known};
  return {number_or_nan(&json.at("value")), number_or_nan(member(json, "error"))};
}

std::pair<double, double> largest(const FigureJson& list, const FigureJson* errors) {
  std::pair<double, double> found{not_known, not_known};
  for (std::size_t i = 0; i < list.size(); ++i) {
    // Planetary stages list values and errors apart, others objects of the branches.
    const auto* own = member(list.at(i), "dynamic_factor");
    auto value = value_and_error(own ? *own : list.at(i));
    if (errors && i < errors->size() && !errors->at(i).is_null()) value.second = errors->at(i).get<double>();
    if (std::isnan(found.first) || value.first > found.first) found = value;
  }
  return found;
}

std::pair<double, double> entry_behind_zeros(const FigureJson& list, std::size_t entry) {
  for (const auto& item : list) {
    const auto value = value_and_error(item);
    if (value.first > 0 && entry-- == 0) return value;
  }
  return {not_known, not_known};
}

/// A stiffness with its relative error; of several sources the one that was taken.
std::pair<double, double> estimate(const FigureJson& json) {
  const auto read = [](const FigureJson& e) {
    const double value = number_or_nan(member(e, "value"));
    return std::pair{value, std::abs(value * number_or_nan(member(e, "error_relative")))};
  };
  if (json.contains("value")) return read(json);
  for (const auto& source : json)
    if (source.value("taken", false)) return read(source);
  return {not_known, not_known};
}

std::pair<double, double> read_figure(const ComparedFigure& figure, const FigureJson& summary) {
  const FigureJson* json = &summary;
  for (const auto& key : figure.path) {
    json = member(*json, key);
    if (!json) return {not_known, not_known};
  }
  switch (figure.form) {
    case Form::estimate:
      return estimate(*json);
    case Form::number:
      return {json->get<double>(), not_known};
    case Form::largest_of_list: {
      const auto* errors = member(summary, figure.path.front() + "_error");
      return largest(*json, errors ? member(*errors, figure.path.back()) : nullptr);
    }
    case Form::list_entry:
      return entry_behind_zeros(*json, figure.entry);
    case Form::figure:
      break;
  }
  return value_and_error(*json);
}

}  // namespace

const std::vector<ComparedFigure>& compared_figures(const std::string& kind) {
  static const std::map<std::string, FigureList> figures = {
      {"planetary", planetary()}, {"helical_pair", helical_pair()}, {"two_k_v", two_k_v()}};
  static const FigureList none;
  const auto found = figures.find(kind);
  return found == figures.end() ? none : found->second;
}

std::map<std::string, std::pair<double, double>> read_figures(const std::string& kind, const std::string& summary) {
  const auto json = FigureJson::parse(summary);
  std::map<std::string, std::pair<double, double>> figures;
  for (const auto& figure : compared_figures(kind)) figures[figure.name] = read_figure(figure, json);
  return figures;
}

}  // namespace annulus::app
