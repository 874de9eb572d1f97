#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/scene/overrides.h"
#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

/// The values in rising order; sweeps may be given in any.
std::vector<std::size_t> rising(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

/// A sweep with what all its pictures need.
class SweepPictures {
 public:
  SweepPictures(const StudyResults& studies, const SweepResult& sweep)
      : studies_(studies), sweep_(sweep), order_(rising(sweep.values)) {
    for (const std::size_t i : order_) x_.push_back(sweep.values[i]);
  }

  /// All variants in one picture; nothing when the figure is nowhere known or zero throughout.
  [[nodiscard]] std::optional<Plot> figure(const FigureSpec& figure) const {
    Plot plot = empty_plot(figure.title, figure.axis_label());
    bool any = false;
    for (std::size_t variant = 0; variant < studies_.variants.size(); ++variant) {
      for (const auto& column : {figure.key, figure.beside}) {
        if (column.empty()) continue;
        auto y = values(variant, column);
        for (auto& v : y) {
          v *= figure.scale;
          any = any || (std::isfinite(v) && v != 0);
        }
        const bool dashed = column == figure.beside;
        const auto& name = studies_.variants[variant];
        plot.series.push_back({.label = name, .x = x_, .y = y, .colour = variant, .dashed = dashed});
        plot.series.push_back(
            {.label = name, .x = x_, .y = y, .colour = variant, .style = Series::Style::dots, .size = 3.5});
      }
    }
    return any ? std::optional(plot) : std::nullopt;
  }

  /// The lowest natural frequencies, one picture per variant; nothing when the input does not move them.
  [[nodiscard]] std::vector<Picture> frequencies() const {
    std::vector<Picture> pictures;
    bool moved = false;
    for (std::size_t variant = 0; variant < studies_.variants.size(); ++variant) {
      Plot plot = empty_plot(headed(variant, "natural frequencies"), "frequency, Hz");
      widen(plot);
      for (const auto& figure : studies_.figures) {
        if (!figure.key.starts_with("frequency_")) continue;
        const auto y = values(variant, figure.key);
        for (const double f : y) moved = moved || std::abs(f - y.front()) > 1e-3 * y.front();
        plot.series.push_back(
            {.label = figure.title, .x = x_, .y = y, .colour = variant, .style = Series::Style::line});
      }
      if (!plot.series.empty()) pictures.emplace_back(plot);
    }
    return moved ? pictures : std::vector<Picture>{};
  }

  [[nodiscard]] std::vector<Picture> bifurcation() const {
    std::vector<Plot> plots;
    RangeFinder range;
    for (std::size_t variant = 0; variant < studies_.variants.size(); ++variant) {
      Series series{.label = studies_.variants[variant], .colour = variant, .style = Series::Style::dots, .size = 1.8};
      for (std::size_t i = 0; i < sweep_.values.size(); ++i) {
        for (const auto& p : sweep_.variants[variant][i].poincare) {
          series.x.push_back(sweep_.values[i]);
          series.y.push_back(p.force / 1e3);
        }
      }
      if (series.x.empty()) continue;
      range.add(series.y);
      Plot plot = empty_plot(studies_.variants[variant], "force, kN");
      widen(plot);
      plot.series.push_back(std::move(series));
      plots.push_back(std::move(plot));
    }
    return on_one_scale(plots, range);
  }

 private:
  [[nodiscard]] Plot empty_plot(const std::string& title, const std::string& y_label) const {
    Plot plot{.title = title, .x_label = with_unit(sweep_.sweep.input, sweep_.unit), .y_label = y_label};
    plot.x_log = sweep_.sweep.scale == SweepScale::logarithmic;
    return plot;
  }
  void widen(Plot& plot) const {
    if (studies_.variants.size() == 1) plot.width = 2 * plot.width;  // alone in its row
  }
  [[nodiscard]] std::string headed(std::size_t variant, const std::string& what) const {
    const auto& name = studies_.variants[variant];
    return name.empty() ? what : name + ": " + what;
  }
  [[nodiscard]] std::vector<double> values(std::size_t variant, const std::string& column) const {
    std::vector<double> list;
    for (const std::size_t i : order_) list.push_back(sweep_.variants[variant][i].value(column));
    return list;
  }

  const StudyResults& studies_;
  const SweepResult& sweep_;
  std::vector<std::size_t> order_;
  std::vector<double> x_;
};

std::string remarks_of(const StudyResults& studies, const SweepResult& sweep) {
  std::string text;
  int failed = 0, not_steady = 0;
  std::string first;
  for (std::size_t variant = 0; variant < studies.variants.size(); ++variant) {
    for (std::size_t i = 0; i < sweep.values.size(); ++i) {
      const auto& point = sweep.variants[variant][i];
      if (point.failure.empty()) {
        not_steady += point.value("steady") == 0 ? 1 : 0;
      } else if (failed++ == 0) {
        first = fmt::format("{} at {}: {}", studies.variants[variant], to_text(sweep.values[i], 6), point.failure);
      }
    }
  }
  if (failed) text += fmt::format(" {} responses failed and are left out, the first: {}.", failed, first);
  if (not_steady)
    text += fmt::format(" {} of {} responses did not become periodic; their figures hold for the window only.",
                        not_steady, sweep.values.size() * studies.variants.size());
  if (sweep.tables) text += fmt::format(" {} of the values have stiffness tables of their own.", sweep.tables);
  return text;
}

Blocks one_sweep(const Scene& scene, const StudyResults& studies, std::size_t n) {
  const auto& sweep = studies.sweeps[n];
  const auto* parameter = find_input(scene, sweep.sweep.input).parameter;
  Blocks blocks =
      heading(sweep.sweep.input) +
      paragraph(phrase("{} {} values; all else as in the scene. Table: {}.{}", parameter->meaning, sweep.values.size(),
                       code(fmt::format("dynamics/sweep_{}.csv", n + 1)), remarks_of(studies, sweep)));
  const SweepPictures draw(studies, sweep);
  std::vector<Picture> pictures;
  bool dashed = false;
  for (const auto& figure : studies.figures) {
    if (!figure.plotted) continue;
    const auto picture = draw.figure(figure);
    if (!picture) continue;
    dashed = dashed || !figure.beside.empty();
    pictures.emplace_back(*picture);
  }
  blocks += Pictures{pictures, variant_legend(studies),
                     !dashed                            ? ""
                     : studies.variants.front().empty() ? "Dashed: quasi-static."
                                                        : "Largest over the planets. Load sharing: averaged over a "
                                                          "mesh cycle, dashed quasi-static."};
  if (const auto frequencies = draw.frequencies(); !frequencies.empty())
    blocks += Pictures{frequencies, {}, "The lowest natural frequencies, tangent stiffness, without rotation."};
  if (const auto points = draw.bifurcation(); !points.empty())
    blocks += Pictures{points,
                       {},
                       "Force in the first mesh, once per mesh cycle (Poincaré points): errors spread the points over "
                       "one error period; without errors a single point is a motion that repeats with the mesh, "
                       "several points one that repeats after as many cycles, a cloud a chaotic one."};
  return blocks;
}

}  // namespace

Legend variant_legend(const StudyResults& studies) {
  if (studies.variants.size() == 1 && studies.variants.front().empty()) return {};
  Legend legend;
  for (std::size_t i = 0; i < studies.variants.size(); ++i) legend.emplace_back(studies.variants[i], i);
  return legend;
}

Section sweeps_section(const Scene& scene, const StudyResults& studies) {
  Section section{"sweeps", "Sweeps"};
  for (std::size_t n = 0; n < studies.sweeps.size(); ++n) section.blocks += one_sweep(scene, studies, n);
  return section;
}

}  // namespace annulus::app
