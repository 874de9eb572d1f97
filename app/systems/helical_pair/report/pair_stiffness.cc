#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "fem/closed_form/helical_table.h"

namespace annulus::app {

namespace {

const char* source_words(const std::string& source) {
  if (source == "iso_6336") return "ISO 6336-1 formula";
  if (source == "closed_form") return "closed form";
  return source == "computed" ? "finite elements" : "prescribed by the scene";
}

PageTable means_table(const PairRunResult& result) {
  double reference = result.stiffnesses.front().value;
  for (const auto& s : result.stiffnesses)
    if (s.taken) reference = s.value;
  PageTable table{.head = {"source", "along the normal, N/µm", "along the transverse line of action, N/µm",
                           "relative to the applied one", "description", ""}};
  for (const auto& s : result.stiffnesses) {
    auto& row = table.rows.emplace_back(1, source_words(s.source));
    if (std::isfinite(s.value)) {
      const std::string error =
          std::isfinite(s.error_relative) ? fmt::format(" ± {:.1f} %", 100 * s.error_relative) : "";
      row.insert(row.end(), {to_text(s.value / 1e6, 5) + error, to_text(s.value / result.geometry.to_normal() / 1e6, 5),
                             fmt::format("{:+.1f} %", 100 * (s.value / reference - 1))});
    } else {
      row.insert(row.end(), 3, "–");
    }
    row.insert(row.end(), {s.note, s.taken ? tag(Text::Look::agrees, "applied") : Text()});
  }
  return table;
}

/// How far the sources lie apart, in words.
Blocks means_sentence(const PairRunResult& result) {
  std::vector<const MeanStiffness*> known;
  for (const auto& s : result.stiffnesses)
    if (std::isfinite(s.value) && s.source != "prescribed") known.push_back(&s);
  if (known.size() < 2) return {};
  std::sort(known.begin(), known.end(), [](const auto* a, const auto* b) { return a->value < b->value; });
  const auto &low = *known.front(), &high = *known.back();
  return paragraph(
      fmt::format("The difference between the softest ({}) and the stiffest ({}) is {:.1f} %. The ISO formula holds "
                  "for standard teeth and solid bodies. It contains no bores, no rims and not the actual load. In the "
                  "closed form each slice of the helix bends as a separate spur tooth in plane strain. Finite elements "
                  "have free end faces, contact lines of finite length and slices that support each other.",
                  source_words(low.source), source_words(high.source), 100 * (high.value / low.value - 1)));
}

/// N/µm over one mesh cycle.
Series over_cycle(const std::string& label, std::size_t colour, int points,
                  const std::function<double(double)>& stiffness) {
  Series series{.label = label, .colour = colour};
  for (int i = 0; i <= points; ++i) {
    series.x.push_back(static_cast<double>(i) / points);
    series.y.push_back(stiffness(series.x.back()) / 1e6);
  }
  return series;
}

Series over_cycle(const std::string& label, std::size_t colour, const StiffnessTable& transverse,
                  const PairGeometry& geometry) {
  const auto table = fem::along_normal(transverse, geometry.base_helix_angle);
  const double wanted = geometry.transverse_force / std::cos(geometry.base_helix_angle);
  return over_cycle(
      label, colour, 200,
      curves_at_load(table, std::clamp(wanted, table.loads().front(), table.loads().back())).stiffness_secant);
}

/// The wave that a scene prescribes.
Series prescribed_wave(const std::string& label, double mean, const MeshInput& input) {
  const double ripple = input.ripple.value_or(0), phase = input.phase.value_or(0), duty = input.duty.value_or(0.5);
  return over_cycle(label, 0, 400, [&](double at) {
    const double lag = at - phase;
    const double shape = input.stiffness == StiffnessShape::rectangular ? (lag - std::floor(lag) < duty ? 1 : 0) - duty
                                                                        : std::cos(2 * std::numbers::pi * lag);
    return mean * (1 + ripple * shape);
  });
}

Pictures cycle_picture(const PairRunResult& result) {
  Plot plot = wide_plot("Mesh stiffness along the normal, over a mesh cycle", "mesh cycle", "N/µm");
  const auto& input = helical_pair(result.scene).pinion_wheel;
  const auto& geometry = result.geometry;
  for (const auto& s : result.stiffnesses) {
    if (s.source == "closed_form" && std::isfinite(s.value))
      plot.series.push_back(over_cycle(
          "closed form", 1,
          s.taken ? *result.mesh.table : closed_form_pair_table(result.scene, geometry, geometry.transverse_force),
          geometry));
    if (s.taken && (s.source == "iso_6336" || (s.source == "prescribed" && !result.mesh.table))) {
      plot.series.push_back(prescribed_wave(std::string(source_words(s.source)) + ", applied", s.value, input));
    } else if (s.source == "iso_6336") {
      plot.series.push_back(over_cycle("ISO 6336-1 mean", 6, 1, [&](double) { return s.value; }));
      plot.series.back().dashed = true;
    }
  }
  if (result.mesh.computed)
    plot.series.push_back(over_cycle("finite elements", 2, *result.mesh.table, geometry));
  else if (input.stiffness == StiffnessShape::table)
    plot.series.push_back(over_cycle("table", 0, *result.mesh.table, geometry));
  return Pictures{{plot},
                  {},
                  "Secant stiffness at the nominal mesh force. Each source has its own phase. A prescribed wave begins "
                  "at the phase of the scene. The others begin where a tooth pair touches at the pitch point in the "
                  "middle of the face width."};
}

}  // namespace

Section pair_stiffness_section(const PairRunResult& result, const NamedMeshes& meshes) {
  return {"stiffness", "Mesh stiffness",
          paragraph(fmt::format("Mean over a mesh cycle at the nominal mesh force of {} kN along the transverse line "
                                "of action.",
                                to_text(result.geometry.transverse_force / 1e3, 5))) +
              means_table(result) + means_sentence(result) + cycle_picture(result) +
              (meshes.empty() ? Blocks() : stiffness_blocks(meshes))};
}

}  // namespace annulus::app
