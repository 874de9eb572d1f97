#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/interactive_plot.h"
#include "app/report/report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// One quantity over the mesh cycles of a table: the solved positions, and the periodic curve through them that the
/// dynamics uses, with the estimated error around it.
struct Curve {
  std::vector<double> cycles, value, low, high;
  std::vector<double> solved_cycles, solved;
  double mean = 0;
};

template <class Pick>
Curve curve_of(const MeshResult& mesh, Pick pick) {
  Curve curve;
  const auto& table = mesh.table;
  const int phases = table.phases(), total = phases * table.positions();
  std::vector<double> error;
  for (int i = 0; i < total; ++i) {
    const auto& e = table.at(i / phases, i % phases, static_cast<int>(mesh.nominal));
    curve.solved_cycles.push_back(static_cast<double>(i) / phases);
    curve.solved.push_back(pick(e));
    error.push_back(e.error_relative);
  }
  // A given wave is sampled densely already, and a rectangular one must not be rounded.
  const int pieces = !mesh.model.computed() ? 1 : table.positions() > 1 ? 4 : 10;
  const PeriodicCurve through(curve.solved, phases);
  curve.mean = through.mean();
  for (int i = 0; i <= total * pieces; ++i) {
    const double cycle = static_cast<double>(i) / (phases * pieces);
    const double value = pieces == 1 ? curve.solved[static_cast<std::size_t>(i % total)] : through(cycle);
    const double e = error[static_cast<std::size_t>(((i + pieces / 2) / pieces) % total)];
    curve.cycles.push_back(cycle);
    curve.value.push_back(value);
    curve.low.push_back(value * (1 - e));
    curve.high.push_back(value * (1 + e));
  }
  return curve;
}

/// The curve as a line with its band, and dots where it was solved when there are few enough to tell apart.
void add_curve(Plot& plot, const std::string& label, const Curve& c, std::size_t colour, bool dots) {
  plot.series.push_back({.label = label, .x = c.cycles, .y = c.value, .low = c.low, .high = c.high, .colour = colour});
  if (dots)
    plot.series.push_back(
        {.label = {}, .x = c.solved_cycles, .y = c.solved, .colour = colour, .style = Series::Style::dots});
}

double lte_um(const StiffnessEntry& e) { return e.lte / units::um; }
double secant(const StiffnessEntry& e) { return e.stiffness_secant / 1e6; }
double tangent(const StiffnessEntry& e) { return e.stiffness_tangent / 1e6; }

const char* cycle_label(const MeshResult& mesh) {
  return mesh.table.positions() > 1 ? "ring teeth passed (mesh cycles)" : "mesh cycle";
}

/// The same quantity of every ring, side by side on one scale.
template <class Pick>
std::string per_ring(const RunResult& result, const char* y_label, Pick pick, bool about_mean,
                     const std::string& caption) {
  std::vector<Curve> curves;
  RangeFinder range;
  for (const auto& ring : result.rings) {
    auto curve = curve_of(ring.mesh, pick);
    if (about_mean) {
      for (auto& v : curve.value) v -= curve.mean;
      for (auto& v : curve.solved) v -= curve.mean;
      curve.low.clear();
      curve.high.clear();
    }
    range.add(curve.value);
    range.add(curve.low);
    range.add(curve.high);
    curves.push_back(std::move(curve));
  }
  std::vector<std::string> plots;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& c = curves[i];
    Plot plot{.title = result.rings[i].name,
              .x_label = cycle_label(result.rings[i].mesh),
              .y_label = y_label,
              .y_range = range.range()};
    const auto& mesh = result.rings[i].mesh;
    add_curve(plot, result.rings[i].name, c, i, mesh.model.computed() && mesh.table.positions() == 1);
    plots.push_back(plot_html(plot));
  }
  return figure(plots, "", caption);
}

/// All rings in one plot, the repeating ones repeated over the longest period.
std::string overlay(const RunResult& result) {
  int longest = 2;
  for (const auto& ring : result.rings) longest = std::max(longest, ring.mesh.table.positions());
  Plot plot{.title = "Ring mesh stiffness (secant)",
            .x_label = "ring teeth passed (mesh cycles)",
            .y_label = "N/µm",
            .legend = true,
            .width = 900,
            .height = 320};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.rings[i];
    const auto c = curve_of(ring.mesh, secant);
    Series series{.label = ring.name, .colour = i};
    const std::size_t period = c.value.size() - 1;
    for (double x = 0; x < longest; x += ring.mesh.table.positions()) {
      for (std::size_t k = 0; k <= period && x + c.cycles[k] <= longest + 1e-9; ++k) {
        series.x.push_back(x + c.cycles[k]);
        series.y.push_back(c.value[k]);
      }
    }
    plot.series.push_back(std::move(series));
  }
  return figure({plot_html(plot)}, "",
                "Rings that repeat with every tooth are continued over the period of the others.");
}

std::string over_load(const RunResult& result) {
  const auto mean_at = [](const MeshResult& mesh, int load, auto pick) {
    double sum = 0;
    for (int p = 0; p < mesh.table.positions(); ++p) {
      for (int k = 0; k < mesh.table.phases(); ++k) sum += pick(mesh.table.at(p, k, load));
    }
    return sum / (mesh.table.positions() * mesh.table.phases());
  };
  Plot plot{.title = "Mean mesh stiffness over load",
            .x_label = "mesh force, kN",
            .y_label = "N/µm",
            .legend = true,
            .width = 900,
            .height = 320};
  const auto add = [&](const std::string& label, const MeshResult& mesh, std::size_t colour) {
    if (mesh.table.loads().size() < 2) return;
    Series secants{.label = label + ", secant", .colour = colour},
        tangents{.label = label + ", tangent", .colour = colour, .dashed = true};
    for (std::size_t load = 0; load < mesh.table.loads().size(); ++load) {
      secants.x.push_back(mesh.table.loads()[load] / 1e3);
      tangents.x.push_back(mesh.table.loads()[load] / 1e3);
      secants.y.push_back(mean_at(mesh, static_cast<int>(load), secant));
      tangents.y.push_back(mean_at(mesh, static_cast<int>(load), tangent));
    }
    plot.series.push_back(std::move(secants));
    plot.series.push_back(std::move(tangents));
  };
  for (std::size_t i = 0; i < result.rings.size(); ++i) add(result.rings[i].name, result.rings[i].mesh, i);
  add("sun mesh", result.sun_mesh, result.rings.size());
  if (plot.series.empty()) return "";
  return figure(
      {plot_html(plot)}, "",
      "Secant: force over deflection. Tangent: slope of the force over the deflection, what small vibrations feel.");
}

std::string shares_plot(const std::string& title, const MeshResult& mesh, std::size_t colour) {
  const auto& csv = mesh.positions;
  Series series{.label = title, .colour = colour, .style = Series::Style::dots};
  const double load = mesh.table.loads()[mesh.nominal];
  const auto load_column = csv.column("load_N");
  for (const auto& row : csv.rows) {
    if (row[load_column] != load) continue;
    for (std::size_t c = 0; c + 1 < csv.columns.size(); ++c) {
      if (!csv.columns[c].ends_with("_roll_mm") || !std::isfinite(row[c])) continue;
      series.x.push_back(row[c]);
      series.y.push_back(row[c + 1]);
    }
  }
  const Plot plot{.title = title,
                  .x_label = "roll length on the planet's flank, mm",
                  .y_label = "share of the mesh force",
                  .y_range = Range{-0.03, 1.05},
                  .series = {series}};
  return plot_html(plot);
}

std::string shares(const RunResult& result) {
  std::vector<std::string> plots;
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    if (!result.rings[i].mesh.positions.rows.empty())
      plots.push_back(shares_plot("ring mesh, " + result.rings[i].name, result.rings[i].mesh, i));
  }
  if (!result.sun_mesh.positions.rows.empty())
    plots.push_back(shares_plot("sun mesh", result.sun_mesh, result.rings.size()));
  if (plots.empty()) return "";
  return "<h3>Load shares of the tooth pairs</h3>\n" +
         figure(plots, "",
                "Share of one tooth pair while it passes through the mesh, from the planet's root to its tip. Where "
                "the share falls "
                "to zero outside the theoretical path of contact, deflection brings teeth together early and lets them "
                "part late.");
}

}  // namespace

std::string meshes_section(const RunResult& result) {
  std::string cells;
  const auto add = [&](const std::string& title, const MeshResult& mesh) {
    if (mesh.picture.empty()) return;
    cells += "<div><h3>" + escape(title) + "</h3>" + mesh.picture +
             fmt::format("<figcaption>{}</figcaption></div>\n",
                         mesh.model.fidelity.ends_with("solid")
                             ? "Held faces orange, driven flanks blue."
                             : "Planet blue; what is held is orange; the circle marks the pitch point.");
  };
  for (const auto& ring : result.rings) add("Ring mesh, " + ring.name, ring.mesh);
  add("Sun mesh", result.sun_mesh);
  if (cells.empty()) return "";
  return "<h2 id=\"meshes\">Meshes</h2>\n<figure class=\"meshes\"><div class=\"row\">" + cells + "</div></figure>\n";
}

std::string stiffness_section(const RunResult& result) {
  std::string text =
      "<h2 id=\"stiffness\">Transmission error and stiffness</h2>\n<h3>Loaded transmission error of the ring "
      "mesh</h3>\n";
  text += per_ring(result, "transmission error, µm", lte_um, false,
                   "At the nominal mean mesh force, along the line of action, one scale for all. The band is the "
                   "estimated error.");
  text += per_ring(result, "transmission error – mean, µm", lte_um, true,
                   "The same about its mean: what excites vibration.");
  text += "<h3>Mesh stiffness</h3>\n" + overlay(result);
  text += per_ring(result, "stiffness, N/µm", secant, false,
                   "Secant stiffness at the nominal load, one scale for all, with the estimated error.");
  const auto sun = curve_of(result.sun_mesh, secant);
  Plot plot{
      .title = "Sun mesh stiffness (secant)", .x_label = "mesh cycle", .y_label = "N/µm", .width = 900, .height = 300};
  add_curve(plot, "sun mesh", sun, result.rings.size(), result.sun_mesh.model.computed());
  text += figure({plot_html(plot)}, "", "The same for all rings.");
  return text + stiffness_error_section(result) + over_load(result) + shares(result);
}

}  // namespace annulus::app
