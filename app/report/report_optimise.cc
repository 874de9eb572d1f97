#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/interactive_plot.h"
#include "app/report/report_parts.h"
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
    text += (text.empty() ? "" : " + ") + weight + "“" + escape(figure->title) + "”";
  }
  return text;
}

std::string values_text(const OptimiseResults& o, const Design& design) {
  std::string text;
  for (std::size_t i = 0; i < design.x.size(); ++i)
    text += fmt::format("{}<code>{}</code> = {} {}", i ? ", " : "", escape(o.variables[i].input),
                        std::isfinite(design.x[i]) ? to_text(design.x[i], 5) : "–", o.units[i]);
  return text;
}

/// What the search is worth, in plain words.
std::string verdict(const StudyResults& studies, const OptimiseResults& o) {
  std::string text = "<div class=\"verdict\"><p>";
  const double gain = sign_of(o) * (o.given.objective - o.best.objective);
  if (o.range.flat) {
    text += "<b>Nothing to gain.</b> " + escape(o.range.verdict);
  } else if (!std::isfinite(o.given.objective)) {
    text += fmt::format("<b>Best objective {}.</b> The scene as given has no response.", to_text(o.best.objective, 6));
  } else if (gain <= o.range.least_meaning) {
    text += fmt::format("<b>The scene as given is as good as the best found:</b> {} against {}.",
                        to_text(o.given.objective, 6), to_text(o.best.objective, 6));
  } else {
    text += fmt::format("<b>The objective goes from {} to {}</b> ({:.1f} % of its value).",
                        to_text(o.given.objective, 6), to_text(o.best.objective, 6),
                        100 * std::abs(o.given.objective - o.best.objective) / std::abs(o.given.objective));
  }
  text += "</p>\n";
  for (const std::string mesh : {"sun_planet", "ring_planet", "mesh"}) {
    const auto* loss = find_figure(studies.figures, mesh + "_contact_loss");
    if (!loss) continue;
    text +=
        fmt::format("<p>{}: {} % with the given values, {} % with the best.</p>\n", escape(loss->title),
                    to_text(100 * o.given.point.value(loss->key), 3), to_text(100 * o.best.point.value(loss->key), 3));
  }
  return text + "</div>\n";
}

std::string starts_text(const StudyResults& studies, const OptimiseResults& o, const Design& design,
                        const std::string& which) {
  if (!design.starts) return "";
  const auto& s = *design.starts;
  std::string text = fmt::format("<li>{}: {} initial conditions lead to {} steady motion{}", which, s.starts, s.motions,
                                 s.motions == 1 ? "" : "s");
  if (s.not_steady) text += fmt::format(" ({} did not become steady)", s.not_steady);
  for (const auto& f : studies.figures) {
    const auto& wanted = o.settings.objective;
    if (f.effort == FigureEffort::motion || s.low.empty()) continue;
    if (std::find(wanted.begin(), wanted.end(), f.key) != wanted.end())
      text += fmt::format("; {} from {} to {}", escape(f.title), to_text(s.low.value(f.key), 6),
                          to_text(s.high.value(f.key), 6));
  }
  return text + ".</li>\n";
}

std::string history_picture(const OptimiseResults& o) {
  Plot plot{.title = "Best objective so far", .x_label = "evaluations", .y_label = "objective"};
  plot.x_log = true;
  for (std::size_t i = 0; i < o.runs.size(); ++i) {
    Series series{.label = name_of(o, o.runs[i]), .colour = i};
    for (const auto& g : o.runs[i].search.history) {
      series.x.push_back(static_cast<double>(std::max(1L, g.evaluations)));
      series.y.push_back(sign_of(o) * g.best);
    }
    plot.series.push_back(std::move(series));
  }
  return plot_html(plot);
}

/// Every evaluation over one variable.
std::string cloud_picture(const OptimiseResults& o, std::size_t variable) {
  const auto& v = o.variables[variable];
  Plot plot{.title = "All designs tried",
            .x_label = v.input + (o.units[variable].empty() ? "" : ", " + o.units[variable]),
            .y_label = "objective"};
  plot.x_log = v.scale == SweepScale::logarithmic;
  for (std::size_t i = 0; i < o.runs.size(); ++i) {
    Series series{.label = name_of(o, o.runs[i]), .colour = i, .style = Series::Style::dots, .size = 2};
    for (const auto& e : o.runs[i].search.evaluations) {
      if (!std::isfinite(e.value)) continue;
      series.x.push_back(e.x[variable]);
      series.y.push_back(sign_of(o) * e.value);
    }
    plot.series.push_back(std::move(series));
  }
  return plot_html(plot);
}

HtmlTable runs_table(const OptimiseResults& o) {
  HtmlTable table{.head = {"search", "best objective"}, .rows = {}, .css_class = "numbers"};
  for (std::size_t i = 0; i < o.variables.size(); ++i)
    table.head.push_back(escape(o.variables[i].input + (o.units[i].empty() ? "" : ", " + o.units[i])));
  for (const auto* head : {"evaluations", "failed", "to the best", "ended"}) table.head.emplace_back(head);
  for (std::size_t i = 0; i < o.runs.size(); ++i) {
    const auto& run = o.runs[i];
    std::vector<std::string> cells = {escape(name_of(o, run)), to_text(sign_of(o) * run.search.value, 6)};
    for (const double x : run.search.x) cells.push_back(to_text(x, 5));
    cells.push_back(std::to_string(run.search.evaluations.size()));
    cells.push_back(std::to_string(run.search.failed));
    cells.push_back(o.evaluations_to_best[i] ? std::to_string(*o.evaluations_to_best[i]) : "never");
    cells.push_back(escape(run.search.stopped));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

HtmlTable figures_table(const StudyResults& studies, const OptimiseResults& o) {
  HtmlTable table{.head = {"", "as given", "best"}, .rows = {}, .css_class = "numbers"};
  for (const auto& f : studies.figures) {
    if (!std::isfinite(o.best.point.value(f.key)) || f.key == "steady") continue;
    const double scale = f.axis_label().empty() ? 1 : f.scale;
    table.rows.push_back({escape(f.title + (f.axis_label().empty() ? "" : ", " + f.axis_label())),
                          to_text(scale * o.given.point.value(f.key), 6),
                          to_text(scale * o.best.point.value(f.key), 6)});
  }
  return table;
}

}  // namespace

std::string optimise_section(const StudyResults& studies) {
  if (!studies.optimise) return "";
  const auto& o = *studies.optimise;
  std::string text = fmt::format("<h2 id=\"optimisation\">Optimisation</h2>\n<p>Objective, to be made {}: {}{}.</p>\n",
                                 o.settings.goal == Goal::smallest ? "small" : "large", objective_text(studies, o),
                                 studies.variants[o.variant].empty() ? "" : ", " + escape(studies.variants[o.variant]));
  text += verdict(studies, o);
  text += "<p>Given: " + values_text(o, o.given) + ". Best: " + values_text(o, o.best) + ".</p>\n";
  if (!o.best.point.failure.empty())
    text += "<p>The best design failed when repeated: " + escape(o.best.point.failure) + "</p>\n";
  const std::string starts = starts_text(studies, o, o.given, "As given") + starts_text(studies, o, o.best, "Best");
  if (!starts.empty()) text += "<ul>" + starts + "</ul>\n";
  std::vector<std::pair<std::string, std::size_t>> entries;
  for (std::size_t i = 0; i < o.runs.size(); ++i) entries.emplace_back(name_of(o, o.runs[i]), i);
  std::vector<std::string> pictures = {history_picture(o)};
  for (std::size_t i = 0; i < std::min<std::size_t>(o.variables.size(), 5); ++i)
    pictures.push_back(cloud_picture(o, i));
  text += figure(pictures, legend_html(entries),
                 "Tables: <code>dynamics/optimise</code>; the best design as a scene: <code>best.toml</code> there.");
  text +=
      "<p>“To the best”: evaluations until the best objective of all searches was met within 1 % of the gain, or "
      "within "
      "the error of the objective where that is larger.</p>\n";
  return text + "<div class=\"wide\">" + html(runs_table(o)) + "</div>\n<h3>Figures of both designs</h3>\n" +
         html(figures_table(studies, o));
}

}  // namespace annulus::app
