#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/shared/mesh_names.h"
#include "dynamics/figures/spectrum.h"

namespace annulus::app {

namespace {

/// One plot per ring and kind of mesh, of which a reader sees those of the chosen ones.
Pictures of_both_meshes(const RunResult& result, PlanetLines shown, const Text& caption) {
  Pictures all{.legend = planet_legend(result.scene.stage.planets), .caption = caption};
  for (const auto& [mesh, words] : {std::pair{sun_planet, sun_meshes}, {ring_planet, ring_meshes}}) {
    shown.mesh = mesh;
    for (auto& picture : planet_lines(result, shown, {}).list) {
      picture.mesh = words;
      all.list.push_back(std::move(picture));
    }
  }
  return all;
}

Blocks planets_over_time(const RunResult& result) {
  const std::string cut = fmt::format(
      " The plots show at most {:.0f} mesh cycles of the window; the files contain the whole window.", shown_cycles);
  return heading("Load sharing") +
         of_both_meshes(result, {&StageResponse::load_sharing, "", "_averaged", "", "", "N F / Σ|F|"},
                        "Force of each planet over the mean of all planets, averaged over a mesh cycle. The "
                        "load-sharing factor is the highest point." +
                            cut) +
         heading("Peak factor") +
         of_both_meshes(result,
                        {&StageResponse::force_factors, "", "_largest", "_smallest", "_largest", "F / nominal force"},
                        "Line: largest force of each mesh cycle over the nominal force; its highest point is the peak "
                        "factor. Band: from the smallest to the largest force. force_factors.csv contains the dynamic "
                        "factor of every mesh cycle." +
                            cut) +
         heading("Forces") +
         of_both_meshes(result, {&StageResponse::waveform, "", "", "", "", "F / nominal force", 6},
                        "The first six mesh cycles of the window, at full resolution.");
}

PageTable factors_table(const RunResult& result) {
  std::vector<TableRow<StageResponse>> rows;
  for (const auto& [kind, words] : {std::pair{&dynamics::DynamicResponse::sun_planet, "sun mesh"},
                                    {&dynamics::DynamicResponse::ring_planet, "ring mesh"}})
    for (const auto& [name, factor] : {std::pair{"dynamic", &dynamics::BranchResult::dynamic_factor},
                                       {"peak", &dynamics::BranchResult::peak_factor}})
      for (int n = 0; n < result.scene.stage.planets; ++n)
        rows.push_back({fmt::format("{} factor, {} of planet {}", name, words, n + 1),
                        [kind = kind, factor = factor, n](const StageResponse& r) {
                          return measured((r.figures.*kind).branches[static_cast<std::size_t>(n)].*factor, 1);
                        }});
  return side_by_side(responses_of(result), rows);
}

dynamics::Spectrum spectrum_of(const StageResponse& response, const std::string& branch) {
  const auto order = column_values(response.spectrum, "mesh_order");
  const auto amplitude = column_values(response.spectrum, branch + "_N");
  const auto size = static_cast<Eigen::Index>(order.size());
  return {Eigen::Map<const Eigen::VectorXd>(order.data(), size),
          Eigen::Map<const Eigen::VectorXd>(amplitude.data(), size)};
}

/// "1 − 0.018": an order read as a sideband.
std::string order_text(const dynamics::SpectralLine& line) {
  if (std::abs(line.sideband) < 1e-9) return fmt::format("{}", line.harmonic);
  auto distance = fmt::format("{:.3g}", std::abs(line.sideband));
  if (line.harmonic == 0) return distance;
  return fmt::format("{} {} {}", line.harmonic, line.sideband < 0 ? "−" : "+", distance);
}

Blocks spectra(const RunResult& result) {
  constexpr int listed = 4;
  Pictures pictures{.caption =
                        fmt::format("Force of planet 1 without its mean. Order 1 is the mesh frequency, {:.1f} Hz; "
                                    "lines beside whole orders are sidebands of the errors.",
                                    result.geometry.operating_point.mesh_frequency)};
  PageTable table{.head = {"highest lines"}, .style = PageTable::Style::numbers};
  for (const auto& [name, response] : responses_of(result)) table.head.emplace_back(name);
  for (const auto& [mesh, words] : {std::pair{sun_planet, sun_meshes}, {ring_planet, ring_meshes}}) {
    const auto first = table.rows.size();
    table.rows.push_back({words});
    for (int i = 0; i < listed; ++i) table.rows.push_back({fmt::format("{}", i + 1)});
    std::vector<Plot> plots;
    double highest = 0;
    for (const auto& [name, response] : responses_of(result)) {
      const auto spectrum = spectrum_of(*response, std::string(mesh) + "1");
      const auto lines = dynamics::highest_lines(spectrum, listed);
      for (std::size_t i = 0; i < listed; ++i)
        table.rows[first + 1 + i].push_back(
            i < lines.size() ? phrase("{:.2f} kN {}", lines[i].amplitude / 1e3, muted("at " + order_text(lines[i])))
                             : Text());
      if (spectrum.order.size() < 2) continue;
      // Without the mean.
      const Eigen::VectorXd kilonewton = spectrum.amplitude.tail(spectrum.amplitude.size() - 1) / 1e3;
      const auto order = spectrum.order.tail(kilonewton.size());
      highest = std::max(highest, kilonewton.maxCoeff());
      plots.push_back({.title = name,
                       .x_label = "order, multiples of the mesh frequency",
                       .y_label = "amplitude, kN",
                       .x_range = Range{0, order[order.size() - 1]},
                       .series = {{.label = "planet 1",
                                   .x = {order.begin(), order.end()},
                                   .y = {kilonewton.begin(), kilonewton.end()},
                                   .style = Series::Style::bars}}});
    }
    for (auto& plot : plots) {
      plot.y_range = Range{0, 1.08 * highest};
      auto& picture = pictures.list.emplace_back(plot);
      picture.variant = plot.title;
      picture.mesh = words;
    }
  }
  return pictures + table;
}

}  // namespace

Pictures planet_lines(const RunResult& result, const PlanetLines& shown, const Text& caption) {
  const int planets = result.scene.stage.planets;
  std::vector<Plot> plots;
  for (const auto& [name, response] : responses_of(result)) {
    std::vector<Line> lines;
    for (int n = 0; n < planets; ++n) {
      const auto stem = fmt::format("{}{}", shown.mesh, n + 1);
      lines.push_back({.column = stem + shown.line,
                       .label = fmt::format("planet {}", n + 1),
                       .colour = static_cast<std::size_t>(n),
                       .low = shown.low.empty() ? "" : stem + shown.low,
                       .high = shown.high.empty() ? "" : stem + shown.high});
    }
    Plot frame{.title = name, .x_label = "mesh cycle of the evaluated window", .y_label = shown.y_label};
    if (shown.level) frame.levels.emplace_back(*shown.level, "");
    plots.push_back(line_plot(frame, shown.table(*response),
                              {.x = "mesh_cycle", .y_scale = shown.scale, .rows_to = shown.cycles}, lines));
  }
  auto list = on_one_scale(plots);
  for (std::size_t i = 0; i < list.size(); ++i) list[i].variant = plots[i].title;
  return {std::move(list), planet_legend(planets), caption};
}

Section dynamics_section(const RunResult& result) {
  Section section{"dynamics", "Load sharing, dynamic and peak factors", paragraph("Not requested.")};
  if (responses_of(result).empty()) return section;
  section.blocks = planets_over_time(result) + heading("Spectrum of the mesh forces") + spectra(result) +
                   heading("Dynamic and peak factor of every planet") + factors_table(result);
  return section;
}

}  // namespace annulus::app
