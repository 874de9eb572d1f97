#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

double sign_of(const OptimiseResults& o) { return o.settings.goal == Goal::smallest ? 1 : -1; }

std::string name_of(const OptimiseResults& o, const OptimiseRun& run) {
  std::string name = run.optimiser == "cma_es" ? "CMA-ES" : run.optimiser;
  std::replace(name.begin(), name.end(), '_', ' ');
  return o.settings.repeats > 1 ? fmt::format("{} {}", name, run.repeat) : name;
}

std::string objective_text(const StudyResults& studies, const OptimiseResults& o) {
  std::string text;
  for (std::size_t i = 0; i < o.settings.objective.size(); ++i) {
    const auto* figure = find_figure(studies.figures, o.settings.objective[i]);
    const std::string weight =
        o.settings.weights.empty()
            ? (o.settings.objective.size() > 1 ? "1/" + std::to_string(o.settings.objective.size()) + " × " : "")
            : to_text(o.settings.weights[i], 4) + " × ";
    text += (text.empty() ? "" : " + ") + weight + "“" + figure->title + "”";
  }
  return text;
}

Text values_text(const OptimiseResults& o, const Design& design) {
  std::vector<Text> values;
  for (std::size_t i = 0; i < design.x.size(); ++i)
    values.push_back(phrase("{} = {} {}", code(o.variables[i].input),
                            std::isfinite(design.x[i]) ? to_text(design.x[i], 5) : "–", o.units[i]));
  return joined(values, ", ");
}

/// What the search gained.
Text gain_text(const OptimiseResults& o) {
  const double gain = sign_of(o) * (o.given.objective - o.best.objective);
  if (o.range.flat) return bold("No improvement possible.") + " " + o.range.verdict;
  const auto given = to_text(o.given.objective, 6), best = to_text(o.best.objective, 6);
  if (!std::isfinite(o.given.objective))
    return bold("Best objective " + best + ".") + " The values of the scene give no response.";
  if (gain <= o.range.least_meaning)
    return bold("The values of the scene are as good as the best values found:") + " " + given + " against " + best +
           ".";
  return bold("The objective goes from " + given + " to " + best) +
         fmt::format(" ({:.1f} % of its value).",
                     100 * std::abs(o.given.objective - o.best.objective) / std::abs(o.given.objective));
}

Box verdict(const StudyResults& studies, const OptimiseResults& o) {
  Blocks blocks = paragraph(gain_text(o));
  for (const auto& loss : studies.figures) {
    if (!loss.key.ends_with("contact_loss")) continue;
    blocks += paragraph(fmt::format("{}: {} % with the values of the scene, {} % with the best values.", loss.title,
                                    to_text(100 * o.given.point.value(loss.key), 3),
                                    to_text(100 * o.best.point.value(loss.key), 3)));
  }
  return verdict_box(blocks);
}

void add_starts(List& list, const StudyResults& studies, const OptimiseResults& o, const Design& design,
                const std::string& which) {
  if (!design.starts) return;
  const auto& s = *design.starts;
  std::string text = fmt::format("{}: {} initial conditions lead to {} steady motion{}", which, s.starts, s.motions,
                                 s.motions == 1 ? "" : "s");
  if (s.not_steady) text += fmt::format(" ({} did not become steady)", s.not_steady);
  for (const auto& f : studies.figures) {
    const auto& wanted = o.settings.objective;
    if (f.effort == FigureEffort::motion || s.low.empty()) continue;
    if (std::find(wanted.begin(), wanted.end(), f.key) != wanted.end())
      text +=
          fmt::format("; {} from {} to {}", f.title, to_text(s.low.value(f.key), 6), to_text(s.high.value(f.key), 6));
  }
  list.items.emplace_back(text + ".");
}

/// The best of all searches over their evaluations.
Plot history_picture(const OptimiseResults& o) {
  Plot plot{.title = "Best objective so far", .x_label = "evaluations", .y_label = "objective", .x_log = true};
  for (const auto& run : o.runs) {
    Series series{.label = name_of(o, run), .colour = plot.series.size()};
    for (const auto& g : run.search.history) {
      series.x.push_back(static_cast<double>(std::max(1L, g.evaluations)));
      series.y.push_back(sign_of(o) * g.best);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// Every evaluation over one variable.
Plot cloud_picture(const OptimiseResults& o, std::size_t variable) {
  const auto& v = o.variables[variable];
  Plot plot{.title = "All designs tried", .x_label = with_unit(v.input, o.units[variable]), .y_label = "objective"};
  plot.x_log = v.scale == SweepScale::logarithmic;
  for (const auto& run : o.runs) {
    Series series{.label = name_of(o, run), .colour = plot.series.size(), .style = Series::Style::dots, .size = 2};
    for (const auto& e : run.search.evaluations) {
      if (!std::isfinite(e.value)) continue;
      series.x.push_back(e.x[variable]);
      series.y.push_back(sign_of(o) * e.value);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

PageTable runs_table(const OptimiseResults& o) {
  PageTable table{.head = {"search", "best objective"}, .style = PageTable::Style::numbers};
  for (std::size_t i = 0; i < o.variables.size(); ++i)
    table.head.push_back(with_unit(o.variables[i].input, o.units[i]));
  for (const auto* head : {"evaluations", "failed", "to the best", "ended"}) table.head.emplace_back(head);
  for (std::size_t i = 0; i < o.runs.size(); ++i) {
    const auto& run = o.runs[i];
    std::vector<Text> cells = {name_of(o, run), to_text(sign_of(o) * run.search.value, 6)};
    for (const double x : run.search.x) cells.push_back(to_text(x, 5));
    for (const auto& text :
         {std::to_string(run.search.evaluations.size()), std::to_string(run.search.failed),
          o.evaluations_to_best[i] ? std::to_string(*o.evaluations_to_best[i]) : "never", run.search.stopped})
      cells.emplace_back(text);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

PageTable figures_table(const StudyResults& studies, const OptimiseResults& o) {
  PageTable table{.head = {"", "as in the scene", "best"}, .style = PageTable::Style::numbers};
  for (const auto& f : studies.figures) {
    if (!std::isfinite(o.best.point.value(f.key)) || f.key == "steady") continue;
    const double scale = f.axis_label().empty() ? 1 : f.scale;
    table.rows.push_back({with_unit(f.title, f.axis_label()), to_text(scale * o.given.point.value(f.key), 6),
                          to_text(scale * o.best.point.value(f.key), 6)});
  }
  return table;
}

}  // namespace

Section optimise_section(const StudyResults& studies) {
  Section section{"optimisation", "Optimisation"};
  if (!studies.optimise) return section;
  const auto& o = *studies.optimise;
  auto& blocks = section.blocks;
  blocks = paragraph(fmt::format("Objective, to be made as {} as possible: {}{}.",
                                 o.settings.goal == Goal::smallest ? "small" : "large", objective_text(studies, o),
                                 studies.variants[o.variant].empty() ? "" : ", " + studies.variants[o.variant])) +
           verdict(studies, o) +
           paragraph("In the scene: " + values_text(o, o.given) + ". Best: " + values_text(o, o.best) + ".");
  if (!o.best.point.failure.empty())
    blocks += paragraph("The best design failed when repeated: " + o.best.point.failure);
  List starts;
  add_starts(starts, studies, o, o.given, "As in the scene");
  add_starts(starts, studies, o, o.best, "Best");
  if (!starts.items.empty()) blocks += starts;
  std::vector<std::string> names;
  for (const auto& run : o.runs) names.push_back(name_of(o, run));
  std::vector<Picture> pictures = {history_picture(o)};
  for (std::size_t i = 0; i < std::min<std::size_t>(o.variables.size(), 5); ++i)
    pictures.emplace_back(cloud_picture(o, i));
  blocks += Pictures{pictures, legend_of(names),
                     phrase("Tables: {}. The best design as a scene: {} in the same folder.", code("dynamics/optimise"),
                            code("best.toml"))};
  blocks += paragraph(
                "“To the best”: number of evaluations until a search reached the best objective of all searches. The "
                "tolerance is 1 % of the gain or the error of the objective, whichever is larger.") +
            runs_table(o) + heading("Results of both designs") + figures_table(studies, o);
  return section;
}

}  // namespace annulus::app
