#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "fem/closed_form/helical_table.h"

namespace annulus::app {

namespace {

const char* source_words(const std::string& source) {
  if (source == "iso_6336") return "ISO 6336-1 formula";
  if (source == "closed_form") return "closed form";
  if (source == "computed") return "finite elements";
  return "given by the scene";
}

PageTable means_table(const PairRunResult& result) {
  double reference = result.stiffnesses.front().value;
  for (const auto& s : result.stiffnesses) {
    if (s.taken) reference = s.value;
  }
  PageTable table{.head = {"source", "along the normal, N/µm", "along the transverse line of action, N/µm",
                           "relative to the one applied", "what it is", ""},
                  .rows = {}};
  for (const auto& s : result.stiffnesses) {
    const bool known = std::isfinite(s.value);
    const std::string error = std::isfinite(s.error_relative) ? fmt::format(" ± {:.1f} %", 100 * s.error_relative) : "";
    table.rows.push_back({source_words(s.source), known ? to_text(s.value / 1e6, 5) + error : "–",
                          known ? to_text(s.value / result.geometry.to_normal() / 1e6, 5) : "–",
                          known ? fmt::format("{:+.1f} %", 100 * (s.value / reference - 1)) : "–", s.note,
                          s.taken ? tag(Text::Look::agrees, "applied") : Text()});
  }
  return table;
}

/// How far the three sources lie apart, in words.
Blocks means_sentence(const PairRunResult& result) {
  const MeanStiffness *low = nullptr, *high = nullptr;
  int known = 0;
  for (const auto& s : result.stiffnesses) {
    if (!std::isfinite(s.value) || s.source == "given") continue;
    ++known;
    if (!low || s.value < low->value) low = &s;
    if (!high || s.value > high->value) high = &s;
  }
  if (known < 2) return {};
  return paragraph(fmt::format(
      "From the softest ({}) to the stiffest ({}) it is {:.1f} %. The formula stands for standard teeth and solid "
      "bodies and knows nothing of bores, rims or the load at hand; the closed form lets each slice of the helix bend "
      "as a spur tooth of its own in plane strain; finite elements have teeth that are free at the end faces, contact "
      "lines of finite length and slices that hold each other.",
      source_words(low->source), source_words(high->source), 100 * (high->value / low->value - 1)));
}

Series curve_over_cycle(const std::string& label, const StiffnessTable& transverse, const PairGeometry& geometry,
                        std::size_t colour) {
  const auto table = fem::along_normal(transverse, geometry.base_helix_angle);
  const double wanted = geometry.transverse_force / std::cos(geometry.base_helix_angle);
  const auto curve =
      curves_at_load(table, std::clamp(wanted, table.loads().front(), table.loads().back())).stiffness_secant;
  Series series{.label = label, .colour = colour};
  constexpr int points = 200;
  for (int i = 0; i <= points; ++i) {
    series.x.push_back(static_cast<double>(i) / points);
    series.y.push_back(curve(series.x.back()) / 1e6);
  }
  return series;
}

Pictures cycle_picture(const PairRunResult& result) {
  Plot plot{.title = "Mesh stiffness along the normal, over a mesh cycle",
            .x_label = "mesh cycle",
            .y_label = "N/µm",
            .legend = true,
            .width = 900,
            .height = 320};
  const auto& input = result.scene.pinion_wheel;
  for (const auto& s : result.stiffnesses) {
    if (s.source == "closed_form" && std::isfinite(s.value)) {
      const auto table = s.taken
                             ? *result.mesh.table
                             : closed_form_pair_table(result.scene, result.geometry, result.geometry.transverse_force);
      plot.series.push_back(curve_over_cycle("closed form", table, result.geometry, 1));
    }
    const bool wave = s.taken && (s.source == "iso_6336" || (s.source == "given" && !result.mesh.table));
    if (s.source == "iso_6336" || wave) {
      Series series{.label = wave ? std::string(source_words(s.source)) + ", applied" : "ISO 6336-1 mean",
                    .colour = wave ? 0UL : 6UL,
                    .dashed = !wave};
      const double ripple = wave ? input.ripple.value_or(0) : 0, phase = input.phase.value_or(0);
      const bool steps = wave && input.stiffness == StiffnessShape::rectangular;
      constexpr int points = 400;
      for (int i = 0; i <= points; ++i) {
        const double at = static_cast<double>(i) / points, lag = at - phase;
        const double shape = steps
                                 ? (lag - std::floor(lag) < input.duty.value_or(0.5) ? 1 : 0) - input.duty.value_or(0.5)
                                 : std::cos(2 * std::numbers::pi * lag);
        series.x.push_back(at);
        series.y.push_back(s.value / 1e6 * (1 + ripple * shape));
      }
      plot.series.push_back(std::move(series));
    }
  }
  if (result.mesh.computed)
    plot.series.push_back(curve_over_cycle("finite elements", *result.mesh.table, result.geometry, 2));
  else if (result.scene.pinion_wheel.stiffness == StiffnessShape::table)
    plot.series.push_back(curve_over_cycle("table", *result.mesh.table, result.geometry, 0));
  return Pictures{
      {plot},
      {},
      "Secant stiffness at the nominal mesh force. Phases of the sources are their own: a given wave begins "
      "where the scene says, the others where a tooth pair touches at the pitch point in the middle of the "
      "face width."};
}

Blocks solved_part(const MeshResult& mesh) {
  const auto lte = mesh.lte_mean(), range = mesh.lte_peak_to_peak();
  return paragraph(fmt::format(
             "Loaded transmission error along the transverse line of action: {} µm on average, {} µm peak to peak; {} "
             "unknowns per pair of sectors.",
             measured(1e6 * lte.value, 1e6 * lte.value * lte.error_relative),
             measured(1e6 * range.value, 1e6 * range.value * range.error_relative),
             to_text(mesh.fact("unknowns"), 9))) +
         mesh_pictures({{"Mesh of pinion and wheel", &mesh}}) + mesh_checks({{"pinion and wheel", &mesh}});
}

}  // namespace

Section pair_stiffness_section(const PairRunResult& result) {
  return {"stiffness", "Mesh stiffness",
          paragraph(fmt::format("Mean over a mesh cycle at the nominal mesh force of {} kN along the transverse line "
                                "of action.",
                                to_text(result.geometry.transverse_force / 1e3, 5))) +
              means_table(result) + means_sentence(result) + cycle_picture(result) +
              (result.mesh.computed ? solved_part(*result.mesh.computed) : Blocks())};
}

}  // namespace annulus::app
