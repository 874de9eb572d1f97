#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

using dynamics::TransientResponse;

std::vector<double> list(const Eigen::VectorXd& values, double scale = 1) {
  const Eigen::VectorXd scaled = scale * values;
  return {scaled.begin(), scaled.end()};
}

constexpr const char* time_axis = "time, s";
constexpr int most_points = 2000;  // of a line; what lies between is within its band

/// Largest and smallest force of a mesh over the time, as a band.
Series band_of(const TransientResponse& r, int mesh, std::size_t colour) {
  Series series{.label = r.meshes[static_cast<std::size_t>(mesh)], .colour = colour};
  const Eigen::Index each = std::max<Eigen::Index>(1, r.time.size() / most_points);
  for (Eigen::Index first = 0; first < r.time.size(); first += each) {
    const Eigen::Index count = std::min(each, r.time.size() - first);
    series.x.push_back(r.time.segment(first, count).mean());
    series.y.push_back(r.mean.row(mesh).segment(first, count).mean() / 1e3);
    series.high.push_back(r.largest.row(mesh).segment(first, count).maxCoeff() / 1e3);
    series.low.push_back(r.smallest.row(mesh).segment(first, count).minCoeff() / 1e3);
  }
  return series;
}

Plot force_plot(const TransientResponse& r) {
  Plot plot = wide_plot("Force of the mesh with the largest one: mean, largest and smallest of each mesh cycle",
                        time_axis, "kN");
  plot.series = {band_of(r, r.spectrum_of, 0)};
  return plot;
}

Plot course_plot(const TransientInput& input) {
  Plot plot = wide_plot("Course", time_axis, "factor", 180);
  Series speed{.label = "speed", .colour = 0}, torque{.label = "torque", .colour = 1};
  for (const auto& point : input.course().points) {
    speed.x.push_back(point.time);
    speed.y.push_back(point.speed);
    torque.x.push_back(point.time);
    torque.y.push_back(point.torque);
  }
  plot.series = {std::move(speed), std::move(torque)};
  return plot;
}

Plot cuts_plot(const TransientResponse& r) {
  Plot plot = wide_plot("Order cuts", time_axis, "amplitude, kN");
  for (const int order : {1, 2, 3}) {
    const Eigen::Index line = order * TransientResponse::window_cycles;
    plot.series.push_back({.label = fmt::format("order {}", order),
                           .x = list(r.window_time),
                           .y = list(r.amplitude.row(line).transpose(), 1e-3),
                           .colour = static_cast<std::size_t>(order - 1)});
  }
  return plot;
}

/// Amplitudes over order and time.
ColourMap waterfall(const TransientResponse& r) {
  constexpr Eigen::Index most = 160;  // of times; windows between are left out
  ColourMap::Panel panel;
  const Eigen::Index step = std::max<Eigen::Index>(1, r.window_time.size() / most), windows = r.window_time.size();
  const double half = r.order.size() > 1 ? r.order[1] / 2 : 0.5;
  double highest = 0;
  for (Eigen::Index w = 0; w < windows; w += step) {
    const double here = r.window_time[w];
    const double low = w == 0 ? here : (here + r.window_time[w - step]) / 2;
    const double high = w + step < windows ? (here + r.window_time[w + step]) / 2 : here;
    for (Eigen::Index i = 1; i < r.order.size() && std::isfinite(r.amplitude(i, w)); ++i) {
      panel.cells.push_back({{low, high}, {r.order[i] - half, r.order[i] + half}, r.amplitude(i, w) / 1e3});
      highest = std::max(highest, r.amplitude(i, w) / 1e3);
    }
  }
  panel.x_range = {r.window_time[0], r.window_time[windows - 1]};
  return {.title = "Waterfall: amplitudes over the order",
          .x_label = time_axis,
          .y_label = "order of the mesh frequency",
          .value_label = "kN",
          .y_range = {half, r.order[r.order.size() - 1] + half},
          .values = {0, highest},
          .panels = {panel}};
}

Blocks one_course(const TransientResult& course, std::size_t variant) {
  const auto& found = course.variants[variant];
  if (!found.failure.empty()) return paragraph("Not found: " + found.failure);
  const auto& r = found.response;
  const auto peak = r.peak();
  PageTable table{.head = {"result", "value"}};
  const auto row = [&](const std::string& what, const Text& value) { table.rows.push_back({what, value}); };
  for (const auto& spec : dynamics::transient_figures())
    if (const auto* entry = found.figures.find(spec.key))
      row(with_unit(spec.title, spec.unit), measured(entry->figure, spec.scale));
  row("the largest mesh force acts",
      fmt::format("at {}, {} s from the beginning, at {} of the speed", r.meshes[static_cast<std::size_t>(peak.mesh)],
                  to_text(peak.time, 4), to_text(peak.speed, 4)));
  for (int shaft = r.gears; shaft < static_cast<int>(r.meshes.size()); ++shaft)
    row("largest torque over the nominal one, " + r.meshes[static_cast<std::size_t>(shaft)],
        measured(found.figures.figure(dynamics::course_element_key(shaft)), 1));
  Blocks blocks = table;
  for (const auto& warning : course.warnings(variant)) blocks += paragraph("Warning: " + warning + ".");
  blocks += Pictures{{course_plot(course.input), force_plot(r)}};
  if (r.window_time.size() > 1)
    blocks += Pictures{{cuts_plot(r), waterfall(r)},
                       {},
                       fmt::format("Spectra of the mesh with the largest force, over {} mesh cycles each; none below "
                                   "{:g} of the speed of [stage].",
                                   TransientResponse::window_cycles, dynamics::TransientOptions::slowest)};
  return blocks;
}

}  // namespace

Section transients_section(const StudyResults& studies) {
  Section section{"transients", "Speed and torque that change"};
  for (std::size_t n = 0; n < studies.transients.size(); ++n) {
    const auto& course = studies.transients[n];
    section.blocks += heading(course.input.name);
    section.blocks += paragraph(phrase(
        "Followed in time from the steady motion at the first speed and torque. Tables: {}, {}. Error bars contain "
        "those of the integration and of the stiffness tables.",
        code(fmt::format("dynamics/transient_{}.csv", n + 1)),
        code(fmt::format("dynamics/transient_{}_waterfall.csv", n + 1))));
    for (std::size_t variant = 0; variant < studies.variants.size(); ++variant) {
      if (!studies.variants[variant].empty()) section.blocks += heading(studies.variants[variant]);
      section.blocks += one_course(course, variant);
    }
  }
  return section;
}

}  // namespace annulus::app
