#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "app/systems/shared/element_words.h"
#include "app/systems/two_k_v/report/reducer_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

std::vector<double> degrees(const Eigen::VectorXd& angle) {
  std::vector<double> list;
  for (const double a : angle) list.push_back(a / units::deg);
  list.push_back(360);
  return list;
}

/// The row with its first value again at the end: a full turn.
template <class Row>
std::vector<double> closed(const Row& row, double scale) {
  std::vector<double> list;
  for (Eigen::Index i = 0; i < row.size(); ++i) list.push_back(scale * row(i));
  list.push_back(list.front());
  return list;
}

std::size_t body_colour(const std::string& dof) {
  const std::pair<const char*, std::size_t> colours[] = {{"input", 4}, {"sun", 0}, {"planet", 1},
                                                         {"crank", 3}, {"arc", 2}, {"output", 6}};
  for (const auto& [body, colour] : colours)
    if (dof.starts_with(body)) return colour;
  return 7;
}

/// "arc gear 2 turn" for arc2_u.
std::string dof_words(const std::string& dof) {
  static const std::regex number("([a-z])([0-9])"), arc("^arc");
  const auto body = std::regex_replace(dof.substr(0, dof.find('_')), number, "$1 $2");
  return std::regex_replace(body, arc, "arc gear") + (dof.ends_with("_u") ? " turn" : " centre");
}

std::string body_words(const std::string& body) {
  return body == "arc" ? "arc gears" : body == "planet" || body == "crank" ? body + "s" : body;
}

PageTable frequency_table(const TwoKVResult& result) {
  const auto& v = *result.own.vibration;
  const auto energy = dynamics::by_group(v.energy);
  PageTable table{
      .head = {"mode", "frequency, Hz", "range over the crank angle, Hz", "strain energy in", "largest motion"}};
  if (result.computed) table.head.emplace_back("with computed stiffness, Hz");
  for (std::size_t m = 0; m < v.modes.modes.size(); ++m) {
    const auto row = v.over_crank.frequency.row(static_cast<Eigen::Index>(m));
    const bool free = v.modes.modes[m].frequency == 0;
    auto& cells = table.rows.emplace_back(std::vector<Text>{
        fmt::format("{}", m + 1), fmt::format("{:.2f}", v.modes.modes[m].frequency),
        fmt::format("{:.2f} … {:.2f}", row.minCoeff(), row.maxCoeff()),
        free ? "free rotation" : strain_words(energy.groups, energy.strain.col(static_cast<Eigen::Index>(m)), 3),
        body_words(v.names[m].substr(0, v.names[m].find(" on ")))});
    if (!result.computed) continue;
    const auto& other = result.computed->vibration->modes.modes;
    cells.emplace_back(m < other.size() ? fmt::format("{:.2f}", other[m].frequency) : "");
  }
  return table;
}

std::string mode_title(std::size_t m) { return fmt::format("mode {}", m + 1); }

Pictures over_crank_plots(const std::string& name, const TwoKVVibration& v) {
  const auto x = degrees(v.over_crank.angle);
  const auto frame = [&](const std::string& title, const char* y_label) {
    return Plot{.title = title + name,
                .x_label = "crank angle against the carrier, °",
                .y_label = y_label,
                .x_range = Range{0, 360},
                .height = 330};
  };
  Plot absolute = frame("Natural frequencies, ", "kHz"),
       change = frame("Change over the crank angle, ", "% of the mean");
  Legend legend;
  for (std::size_t m = 0; m < v.modes.modes.size(); ++m) {
    if (v.modes.modes[m].frequency > 0) legend.emplace_back(mode_title(m), m);
    const auto row = v.over_crank.frequency.row(static_cast<Eigen::Index>(m));
    if (!(row.minCoeff() > 0)) continue;
    absolute.series.push_back({.label = mode_title(m), .x = x, .y = closed(row, 1e-3), .colour = m});
    change.series.push_back({.label = mode_title(m), .x = x, .y = closed(row, 100 / row.mean()), .colour = m});
    for (auto& value : change.series.back().y) value -= 100;
  }
  return {{absolute, change},
          legend,
          "Natural frequencies at fixed crank angles, each with the mesh stiffness of its position. The directions of "
          "the arc gear bearings turn with the crank. Half a turn exchanges the arc gears."};
}

const Legend body_legend = {{"input", 4}, {"sun", 0}, {"planets", 1}, {"cranks", 3}, {"arc gears", 2}};

Blocks shape_pictures(const TwoKVVibration& v) {
  std::vector<Picture> pictures;
  for (std::size_t m = 0; m < v.modes.modes.size(); ++m) {
    const auto& mode = v.modes.modes[m];
    if (mode.frequency == 0) continue;
    Eigen::Index most = 0;
    mode.shape.cwiseAbs().maxCoeff(&most);
    BarChart chart{.title = fmt::format("{}: {:.0f} Hz", m + 1, mode.frequency),
                   .reach = 1,
                   .two_sided = true,
                   .width = 260,
                   .label_width = 112,
                   .row_height = 14};
    for (Eigen::Index i = 0; i < mode.shape.size(); ++i) {
      const auto& dof = v.modes.dofs[static_cast<std::size_t>(i)];
      chart.bars.push_back({dof_words(dof), mode.shape[i] / mode.shape[most], body_colour(dof)});
    }
    pictures.emplace_back(chart);
  }
  return heading("Mode shapes") +
         Pictures{pictures, body_legend,
                  "Displacements as lengths; the largest is 1. Rotations are multiplied by the base radius (input, "
                  "sun, planets), the eccentricity (cranks) or the radius of the crank circle (arc gears). Centres are "
                  "shown along their directions of motion. Numbers: mode_shapes.csv.",
                  Pictures::Layout::shapes};
}

/// How every shape changes while the crank turns; modes are numbered by rising frequency at each angle.
Blocks shapes_over_crank(const TwoKVVibration& v) {
  const auto& crank = v.over_crank;
  const auto x = degrees(crank.angle);
  std::vector<Picture> pictures;
  for (std::size_t m = 0; m < v.modes.modes.size(); ++m) {
    if (!(crank.frequency.row(static_cast<Eigen::Index>(m)).minCoeff() > 0)) continue;
    Eigen::MatrixXd shape(v.modes.modes[m].shape.size(), crank.angle.size());
    for (Eigen::Index i = 0; i < crank.angle.size(); ++i)
      shape.col(i) = crank.modes[static_cast<std::size_t>(i)].modes[m].shape;
    shape /= shape.cwiseAbs().maxCoeff();
    Plot plot{.title = fmt::format("Mode {}", m + 1),
              .x_label = "crank angle, °",
              .y_label = "displacement",
              .x_range = Range{0, 360},
              .y_range = Range{-1.05, 1.05}};
    for (Eigen::Index f = 0; f < shape.rows(); ++f) {
      const auto& name = v.modes.dofs[static_cast<std::size_t>(f)];
      auto y = closed(shape.row(f), 1);
      // A shape may come back the other way round after a turn: that is no jump of the shape.
      y.back() =
          std::abs(y.front() - y[y.size() - 2]) <= std::abs(y.front() + y[y.size() - 2]) ? y.front() : -y.front();
      plot.series.push_back({.label = dof_words(name),
                             .x = x,
                             .y = std::move(y),
                             .colour = body_colour(name),
                             .dashed = name.find('2') != std::string::npos});
    }
    pictures.emplace_back(plot);
  }
  return heading("Mode shapes over the crank angle") +
         Pictures{
             pictures, body_legend,
             "Stiffness as in the scene. Modes are numbered by rising frequency at each angle; two modes that cross "
             "exchange their numbers. Dashed: the second body of its kind. Numbers: mode_shapes_over_crank.csv."};
}

std::string factor_text(const std::optional<double>& factor, const char* none) {
  return factor ? fmt::format("× {}", to_text(*factor, 4)) : std::string(none);
}

}  // namespace

std::size_t first_elastic_mode(const TwoKVVibration& vibration) {
  std::size_t mode = 0;
  while (vibration.modes.modes[mode].frequency == 0) ++mode;
  return mode;
}

Section frequencies_section(const TwoKVResult& result) {
  Section section{"frequencies", "Natural frequencies", {}, "Natural frequencies over the crank angle"};
  if (!result.own.vibration) return section;
  const auto& v = *result.own.vibration;
  section.blocks =
      paragraph(
          "Undamped natural frequencies without rotation. The table is for the mean mesh stiffness and the crank angle "
          "of the scene.") +
      frequency_table(result);
  for (const auto& [name, shown] : shown_cases(result)) section.blocks += over_crank_plots(name, *shown->vibration);
  section.blocks += shape_pictures(v) + shapes_over_crank(v);
  return section;
}

Section first_frequency_section(const TwoKVResult& result) {
  Section section{"first-frequency", "First frequency", {}, "Sensitivity of the first frequency"};
  if (!result.own.vibration) return section;
  const auto& v = *result.own.vibration;
  const auto& scene = result.scene;
  BarChart chart{
      .title = {}, .x_label = "d ln f₁ / d ln p", .bars = {}, .width = 900, .label_width = 220, .row_height = 20};
  PageTable table{.head = {"input", "value", "d ln f₁/d ln p", "f₁ within ±5 %: from", "to"},
                  .style = PageTable::Style::numbers};
  for (const double target : v.targets) table.head.emplace_back(fmt::format("for {} Hz", to_text(target)));
  for (const auto& input : v.inputs) {
    const bool assumed = scene.assumed.contains(input.key);
    chart.bars.push_back({input.key, input.sensitivity, assumed ? 1U : 0U, fmt::format("{:+.3f}", input.sensitivity)});
    std::vector<Text> row = {code(input.key) + (assumed ? " " + tag(Text::Look::assumed, "assumed") : Text()),
                             to_text(input.value, 5) + " " + input.unit, fmt::format("{:+.4f}", input.sensitivity),
                             factor_text(input.band.low, "any smaller"), factor_text(input.band.high, "any larger")};
    for (const auto& factor : input.reaching) row.emplace_back(factor_text(factor, "out of reach"));
    table.rows.push_back(std::move(row));
  }
  section.blocks =
      paragraph(
          "d ln f₁/d ln p: change of the first frequency in per cent when the input rises by one per cent. The values "
          "of all stiffnesses add up to ½, those of all inertias and masses to −½: they are shares of the energies of "
          "the mode. The range: factors on one input between which f₁ stays within ±5 %.") +
      Pictures{{chart}, {{"assumed", 1}, {"prescribed or computed", 0}}} + table;
  return section;
}

Section torsion_section(const TwoKVResult& result) {
  Section section{"torsion", "Torsional stiffness", {}, "Torsional stiffness and lost motion"};
  if (!result.own.vibration) return section;
  Plot plot =
      wide_plot("Torsional stiffness over the crank angle", "crank angle against the carrier, °", "kN m/rad", 300);
  plot.x_range = Range{0, 360};
  for (const auto& [name, shown] : shown_cases(result))
    plot.series.push_back({.label = name,
                           .x = degrees(shown->vibration->torsion.angle),
                           .y = closed(shown->vibration->torsion.from_output, 1e-3),
                           .colour = plot.series.size()});
  std::vector<TableRow<TwoKVCase>> rows;
  for (const auto& [label, value] : std::initializer_list<std::pair<const char*, double (*)(const TwoKVVibration&)>>{
           {"mean stiffness, N m/arc minute", [](const auto& v) { return v.torsion.mean() * units::arc_minute; }},
           {"lost motion by backlash, arc seconds", [](const auto& v) { return v.lost.backlash / units::arc_second; }},
           {"lost motion by ±3 % of the load, arc seconds",
            [](const auto& v) { return v.lost.elastic / units::arc_second; }}})
    rows.push_back({label, [value = value](const TwoKVCase& c) { return Text(to_text(value(*c.vibration), 4)); }});
  section.blocks = paragraph(
                       "Torque over rotation of the output with the input fixed, including all elastic parts. Seen "
                       "from the input with the output fixed, the stiffness is smaller by the ratio squared.") +
                   Pictures{{plot}} + side_by_side(shown_cases(result), rows);
  return section;
}

}  // namespace annulus::app
