#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "app/scene/overrides.h"
#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

/// A sweep with what all its pictures need.
class SweepPictures {
 public:
  SweepPictures(const StudyResults& studies, const SweepResult& sweep) : studies_(studies), sweep_(sweep) {
    // Sweeps may be given in any order.
    order_.resize(sweep.values.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return sweep.values[a] < sweep.values[b]; });
    for (const std::size_t i : order_) x_.push_back(sweep.values[i]);
  }

  /// All variants in one picture; nothing when the result is nowhere known or zero throughout.
  [[nodiscard]] std::optional<Plot> result(const FigureSpec& figure) const {
    Plot plot = empty_plot(figure.title, figure.axis_label());
    for (std::size_t variant = 0; variant < studies_.variants.size(); ++variant) {
      for (const auto& column : {figure.key, figure.beside}) {
        if (column.empty()) continue;
        Series line{.label = studies_.variants[variant],
                    .x = x_,
                    .y = values(variant, column, figure.scale),
                    .colour = variant,
                    .dashed = column == figure.beside,
                    .size = 3.5};
        plot.series.push_back(line);
        line.style = Series::Style::dots;
        line.dashed = false;
        plot.series.push_back(line);
        if (sweep_.downwards.empty() || column == figure.beside) continue;
        line.style = Series::Style::line;
        line.label = (line.label.empty() ? "" : line.label + ", ") + std::string("down");
        line.y = values_of(sweep_.downwards[variant], column, figure.scale);
        line.colour = studies_.variants.size() + variant;
        plot.series.push_back(line);
      }
    }
    return shows_something(plot) ? std::optional(plot) : std::nullopt;
  }

  /// Branches of periodic motions: stable parts drawn through, others dashed, one picture per variant.
  [[nodiscard]] std::vector<Picture> branches() const {
    std::vector<Picture> pictures;
    for (std::size_t variant = 0; variant < sweep_.branches.size(); ++variant) {
      const auto& name = studies_.variants[variant];
      Plot plot = wide_plot((name.empty() ? "" : name + ": ") + "periodic motions", "largest mesh force, kN");
      for (const auto& branch : sweep_.branches[variant].branches)
        for (std::size_t first = 0; first + 1 < branch.points.size();) {
          std::size_t last = first + 1;
          while (last + 1 < branch.points.size() && branch.points[last].stable == branch.points[first].stable) ++last;
          Series part{.label = "", .colour = variant, .dashed = !branch.points[first].stable};
          for (std::size_t i = first; i <= last; ++i) {
            part.x.push_back(branch.points[i].input);
            part.y.push_back(branch.points[i].largest_force / 1e3);
          }
          plot.series.push_back(std::move(part));
          first = last;
        }
      if (!plot.series.empty()) pictures.emplace_back(plot);
    }
    return pictures;
  }

  /// The lowest natural frequencies, one picture per variant; nothing when the input does not move them.
  [[nodiscard]] std::vector<Picture> frequencies() const {
    std::vector<Picture> pictures;
    bool moved = false;
    for (std::size_t variant = 0; variant < studies_.variants.size(); ++variant) {
      const auto& name = studies_.variants[variant];
      Plot plot = wide_plot((name.empty() ? "" : name + ": ") + "natural frequencies", "frequency, Hz");
      for (const auto& figure : studies_.figures) {
        if (!figure.key.starts_with("frequency_")) continue;
        const auto y = values(variant, figure.key, 1);
        for (const double f : y) moved = moved || std::abs(f - y.front()) > 1e-3 * y.front();
        plot.series.push_back({.label = figure.title, .x = x_, .y = y, .colour = variant});
      }
      if (!plot.series.empty()) pictures.emplace_back(plot);
    }
    return moved ? pictures : std::vector<Picture>{};
  }

  [[nodiscard]] std::vector<Picture> bifurcation() const {
    std::vector<Plot> plots;
    for (std::size_t variant = 0; variant < studies_.variants.size(); ++variant) {
      Series series{.label = studies_.variants[variant], .colour = variant, .style = Series::Style::dots, .size = 1.8};
      for (std::size_t i = 0; i < sweep_.values.size(); ++i)
        for (const auto& p : sweep_.variants[variant][i].poincare) {
          series.x.push_back(sweep_.values[i]);
          series.y.push_back(p.force / 1e3);
        }
      if (series.x.empty()) continue;
      plots.push_back(wide_plot(series.label, "force, kN"));
      plots.back().series.push_back(std::move(series));
    }
    return on_one_scale(plots);
  }

 private:
  [[nodiscard]] Plot empty_plot(const std::string& title, const std::string& y_label) const {
    return {.title = title,
            .x_label = with_unit(sweep_.sweep.input, sweep_.unit),
            .y_label = y_label,
            .x_log = sweep_.sweep.scale == SweepScale::logarithmic};
  }
  /// Twice as wide where it is alone in its row.
  [[nodiscard]] Plot wide_plot(const std::string& title, const std::string& y_label) const {
    Plot plot = empty_plot(title, y_label);
    if (studies_.variants.size() == 1) plot.width = 2 * plot.width;
    return plot;
  }
  [[nodiscard]] std::vector<double> values(std::size_t variant, const std::string& column, double scale) const {
    return values_of(sweep_.variants[variant], column, scale);
  }
  [[nodiscard]] std::vector<double> values_of(const std::vector<StudyPoint>& points, const std::string& column,
                                              double scale) const {
    std::vector<double> list;
    for (const std::size_t i : order_) list.push_back(scale * points[i].value(column));
    return list;
  }

  const StudyResults& studies_;
  const SweepResult& sweep_;
  std::vector<std::size_t> order_;
  std::vector<double> x_;
};

/// What the dashed lines are, picture by picture.
std::string dashed_caption(const std::vector<FigureSpec>& figures) {
  std::string titles;
  for (const auto& figure : figures)
    if (const auto* beside = figure.plotted ? find_figure(figures, figure.beside) : nullptr)
      titles += (titles.empty() ? "Dashed: " : "; ") + beside->title;
  return titles.empty() ? titles : titles + ".";
}

/// The lines of a picture: a variant each, and each again where the values are also followed down.
std::vector<std::string> line_names(const StudyResults& studies, const SweepResult& sweep) {
  if (sweep.downwards.empty()) return studies.variants;
  std::vector<std::string> names;
  for (const char* direction : {"up", "down"})
    for (const auto& variant : studies.variants) names.push_back((variant.empty() ? "" : variant + ", ") + direction);
  return names;
}

/// Where the stability of the branches changes.
Blocks branch_table(const StudyResults& studies, const SweepResult& sweep) {
  PageTable table{.head = {studies.variant_word, "branch", "event", with_unit(sweep.sweep.input, sweep.unit),
                           with_unit("error", sweep.unit)}};
  Blocks blocks;
  for (std::size_t variant = 0; variant < sweep.branches.size(); ++variant) {
    const auto& found = sweep.branches[variant];
    if (!found.failure.empty()) blocks += paragraph("Branches: " + found.failure);
    for (std::size_t i = 0; i < found.branches.size(); ++i) {
      for (const auto& e : found.branches[i].events)
        table.rows.push_back(
            {studies.variants[variant], std::to_string(i + 1),
             std::string(to_string(e.kind)) + (e.kind == dynamics::BranchEvent::Kind::fold ? ": the motion jumps" : ""),
             to_text(e.input, 6), small_text(e.error)});
      if (!found.branches[i].end.empty())
        blocks += paragraph(fmt::format("Branch {} ends within the range: {}.", i + 1, found.branches[i].end));
    }
  }
  if (!table.rows.empty()) blocks += table;
  return blocks;
}

Blocks one_sweep(const Scene& scene, const StudyResults& studies, std::size_t n) {
  const auto& sweep = studies.sweeps[n];
  StudyOutcome outcome;
  for (const auto* points : {&sweep.variants, &sweep.downwards})
    for (std::size_t variant = 0; variant < points->size(); ++variant)
      for (std::size_t i = 0; i < sweep.values.size(); ++i)
        outcome.add((*points)[variant][i],
                    fmt::format("{} at {}", studies.variants[variant], to_text(sweep.values[i], 6)));
  Blocks blocks =
      heading(sweep.sweep.input) +
      paragraph(
          phrase("{} {} values; all other inputs as in the scene. Table: {}.{}{}",
                 find_input(scene, sweep.sweep.input).parameter->meaning, sweep.values.size(),
                 code(fmt::format("dynamics/sweep_{}.csv", n + 1)), outcome.text(),
                 sweep.tables ? fmt::format(" {} of the values have their own stiffness tables.", sweep.tables) : ""));
  const SweepPictures draw(studies, sweep);
  blocks += Pictures{result_pictures(studies, [&](const FigureSpec& figure) { return draw.result(figure); }),
                     legend_of(line_names(studies, sweep)), dashed_caption(studies.figures)};
  if (const auto branches = draw.branches(); !branches.empty())
    blocks += Pictures{branches,
                       {},
                       "Periodic motions that repeat with the excitation, followed through folds. Dashed: unstable, "
                       "any disturbance ends them. Table: sweep_<n>_branches.csv."};
  blocks += branch_table(studies, sweep);
  if (const auto frequencies = draw.frequencies(); !frequencies.empty())
    blocks +=
        Pictures{frequencies, {}, "The lowest natural frequencies, with the tangent stiffness and without rotation."};
  if (const auto points = draw.bifurcation(); !points.empty())
    blocks +=
        Pictures{points,
                 {},
                 "Force in the first mesh, once per mesh cycle (Poincaré points). Without errors, one point means a "
                 "motion that repeats in every mesh cycle. Several points mean a motion that repeats after as many "
                 "cycles. A cloud means a chaotic motion. Errors spread the points over one error period."};
  return blocks;
}

}  // namespace

Section sweeps_section(const Scene& scene, const StudyResults& studies) {
  Section section{"sweeps", "Sweeps"};
  for (std::size_t n = 0; n < studies.sweeps.size(); ++n) section.blocks += one_sweep(scene, studies, n);
  return section;
}

}  // namespace annulus::app
