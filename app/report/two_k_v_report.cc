#include "app/report/two_k_v_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/content_id.h"
#include "app/plan/cost_actual.h"
#include "app/report/report_drawings.h"
#include "app/report/report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// What is computed under the name references use; nothing when unknown.
std::optional<double> reducer_quantity(const TwoKVResult& result, const TwoKVCase& c, const std::string& name) {
  if (name == "frequency_1_Hz" && c.vibration) return c.vibration->first_frequency();
  if (name == "torsional_stiffness_Nm_per_rad" && c.vibration) return c.vibration->torsion.mean();
  for (const auto& q : result.plan.quantities)
    if (q.key == name) return q.value;
  return std::nullopt;
}

std::string percent_off(double computed, double published) {
  return fmt::format("{:+.2f} %", 100 * (computed / published - 1));
}

/// Uncertainty of f1, relative, from the assumed inputs alone: each known to `known` only, root of the sum of squares.
struct AssumedPart {
  int assumed = 0, of = 0;
  double uncertainty = 0;
};
constexpr double known_to = 0.2;

AssumedPart assumed_part(const TwoKVResult& result) {
  AssumedPart part;
  double squares = 0;
  for (const auto& input : result.own.vibration->inputs) {
    ++part.of;
    if (!result.scene.assumed.contains(input.key)) continue;
    ++part.assumed;
    squares += input.sensitivity * input.sensitivity;
  }
  part.uncertainty = known_to * std::sqrt(squares);
  return part;
}

const Reference::Value* published_frequency(const TwoKVResult& result, std::size_t which) {
  if (!result.reference) return nullptr;
  for (const auto& value : result.reference->values)
    if (value.quantity == "frequency_1_Hz" && which-- == 0) return &value;
  return nullptr;
}

/// What an agreement with the published first frequency is worth.
std::string worth(const TwoKVResult& result, bool in_short) {
  const auto* first = published_frequency(result, 0);
  if (!first) return "";
  const auto& v = *result.own.vibration;
  const double f = v.first_frequency();
  const auto part = assumed_part(result);
  double widest = 0;
  std::string text = "<p>";
  for (std::size_t i = 0; const auto* value = published_frequency(result, i); ++i) {
    text += fmt::format("{}{} Hz published: {}", i ? "; " : "", to_text(value->value), percent_off(f, value->value));
    widest = std::max(widest, std::abs(f / value->value - 1));
  }
  text += fmt::format(
      ". {} of the {} inputs the first frequency depends on are assumed; if each were known to {:.0f} %, the frequency "
      "would be known to ±{:.0f} % (root of the sum of squares). ",
      part.assumed, part.of, 100 * known_to, 100 * part.uncertainty);
  text += widest < part.uncertainty
              ? "<b>The differences are smaller than that: the agreement shows that the chosen inputs are possible, it "
                "confirms neither them nor the model.</b>"
              : "<b>The differences are larger than that: model and published values disagree beyond the assumed "
                "inputs.</b>";
  if (in_short) return text + " <a href=\"#comparison\">More</a></p>\n";
  const auto& strongest = v.inputs.front();
  for (const auto& input : v.inputs) {
    if (!result.scene.assumed.contains(input.key)) continue;
    text += fmt::format(" The strongest assumed input is <code>{}</code>", escape(input.key));
    if (!input.reaching.empty() && input.reaching.back())
      text += fmt::format(": {} times its value alone would give {} Hz", to_text(*input.reaching.back(), 4),
                          to_text(v.targets.back()));
    text += ".";
    break;
  }
  if (!result.scene.assumed.contains(strongest.key))
    text += fmt::format(" Of all inputs <code>{}</code> weighs most ({:+.3f}).", escape(strongest.key),
                        strongest.sensitivity);
  return text + "</p>\n";
}

std::string reducer_verdict(const TwoKVResult& result) {
  std::string text = "<div class=\"verdict\">\n";
  if (!result.own.vibration) {
    text += fmt::format("<p>Mean stiffness of a sun mesh {} N/µm, of an arc mesh {} N/µm.</p>\n",
                        to_text(result.own.tables.sun.mean_stiffness().value / 1e6, 4),
                        to_text(result.own.tables.arc.mean_stiffness().value / 1e6, 4));
    return text + "</div>\n";
  }
  const auto& v = *result.own.vibration;
  text += fmt::format("<p>First natural frequency: <b>{:.2f} Hz</b>", v.first_frequency());
  if (result.computed)
    text += fmt::format(", with computed mesh stiffness <b>{:.2f} Hz</b> ({})",
                        result.computed->vibration->first_frequency(),
                        percent_off(result.computed->vibration->first_frequency(), v.first_frequency()));
  std::size_t mode = 0;
  while (v.modes.modes[mode].frequency == 0) ++mode;
  const auto& e = v.estimate;
  text += fmt::format(
      ". It is the mode “{}”. The input's inertia times the ratio squared, {} kg m², on the torsional stiffness of {} "
      "N m/rad alone makes {:.1f} Hz; with all bodies that turn with it {:.1f} Hz: the whole train swings as one "
      "against its bearings.</p>\n",
      escape(mode_words(v.names[mode])), to_text(e.input_inertia, 4), to_text(e.stiffness, 4), e.input_frequency,
      e.train_frequency);
  text += worth(result, true);
  text += fmt::format(
      "<p>Torsional stiffness from the output: <b>{} N m/arc minute</b>, wind-up under the load {} arc seconds, lost "
      "motion {} arc seconds.</p>\n",
      to_text(v.torsion.mean() * arc_minute, 4), to_text(v.lost.wind_up / arc_second, 4),
      to_text(v.lost.total() / arc_second, 3));
  for (const auto& shown : shown_cases(result)) {
    if (!shown.result->motion) continue;
    const auto& m = *shown.result->motion;
    text += fmt::format("<p>Output error under load, {}: <b>{}</b> arc seconds peak to peak", escape(shown.name),
                        error_text(m));
    text += m.output_moves()
                ? fmt::format(", {} without inertia.", to_text(m.static_error_peak_to_peak / arc_second, 4))
                : ": nothing beyond rounding.";
    if (!m.steady) text += " No periodic steady state was reached; the figure holds for the window only.";
    text += "</p>\n";
  }
  return text + "</div>\n";
}

std::string reducer_figures(const TwoKVResult& result) {
  if (!result.own.vibration) return "";
  HtmlTable table{.head = {""}, .rows = {}, .css_class = "numbers"};
  const char* names[] = {
      "sun mesh stiffness, mean, N/µm", "arc mesh stiffness, mean, N/µm", "first frequency, Hz",
      "second frequency, Hz",           "torsional stiffness, N m/rad",   "output error, peak to peak, arc seconds",
      "dynamic factor, largest"};
  std::vector<std::vector<std::string>> rows;
  for (const auto* name : names) rows.push_back({name});
  for (const auto& shown : shown_cases(result)) {
    table.head.push_back(escape(shown.name));
    const auto& c = *shown.result;
    std::size_t mode = 0;
    while (c.vibration->modes.modes[mode].frequency == 0) ++mode;
    rows[0].push_back(to_text(c.tables.sun.mean_stiffness().value / 1e6, 4));
    rows[1].push_back(to_text(c.tables.arc.mean_stiffness().value / 1e6, 4));
    rows[2].push_back(fmt::format("{:.2f}", c.vibration->modes.modes[mode].frequency));
    rows[3].push_back(fmt::format("{:.2f}", c.vibration->modes.modes.at(mode + 1).frequency));
    rows[4].push_back(to_text(c.vibration->torsion.mean(), 5));
    rows[5].push_back(c.motion ? error_text(*c.motion) : "–");
    rows[6].push_back(c.motion ? to_text(std::max(c.motion->dynamic_factor(false), c.motion->dynamic_factor(true)), 5)
                               : "–");
  }
  table.rows = std::move(rows);
  return "<h2 id=\"figures\">Key figures</h2>\n" + html(table);
}

std::string reducer_comparison(const TwoKVResult& result) {
  if (!result.reference || !result.own.vibration) return "";
  const auto& reference = *result.reference;
  std::string text = "<h2 id=\"comparison\">Comparison with the source</h2>\n<p>" + escape(reference.source);
  if (!reference.doi.empty()) text += ", doi:" + escape(reference.doi);
  text += ".</p>\n<p>" + escape(reference.note) + "</p>\n";
  HtmlTable table{.head = {"published statement", "published"}, .rows = {}};
  for (const auto& shown : shown_cases(result)) table.head.push_back(escape(shown.name));
  table.head.emplace_back("");
  for (const auto& value : reference.values) {
    std::vector<std::string> row = {
        escape(value.statement) +
            (value.where.empty() ? "" : " <span class=\"muted\">(" + escape(value.where) + ")</span>"),
        to_text(value.value)};
    std::string tag = "<span class=\"tag undecided\">not computed here</span>";
    for (const auto& shown : shown_cases(result)) {
      const auto computed = reducer_quantity(result, *shown.result, value.quantity);
      row.push_back(computed ? fmt::format("{} ({})", to_text(*computed, 5), percent_off(*computed, value.value))
                             : "–");
      if (!computed || shown.result != &result.own) continue;
      tag = std::abs(*computed / value.value - 1) <= value.within ? "<span class=\"tag agrees\">agrees</span>"
                                                                  : "<span class=\"tag disagrees\">disagrees</span>";
      constexpr double told = 1e-4;  // below, the numbers are the same
      if (value.within >= told)
        tag += fmt::format(" <span class=\"muted\">within {} %</span>", to_text(100 * value.within));
    }
    row.push_back(tag);
    table.rows.push_back(std::move(row));
  }
  return text + html(table) + worth(result, false);
}

std::string reducer_quality(const TwoKVResult& result) {
  std::string text = "<h2 id=\"quality\">Checks and cost</h2>\n";
  HtmlTable checks = mesh_check_table();
  for (const auto& shown : shown_cases(result))
    if (shown.result->tables.sun.model.computed())
      checks.rows.push_back(mesh_check_row("sun mesh, " + shown.name, shown.result->tables.sun));
  if (!checks.rows.empty()) text += html(checks);
  text += predicted_and_actual_html(result);
  return text + cost_html(result.timings, result.peak_memory_MB);
}

}  // namespace

std::vector<ShownCase> shown_cases(const TwoKVResult& result) {
  if (!result.computed) return {{"as in the scene", &result.own, 0}};
  return {{"stiffness as given", &result.own, 0}, {"computed stiffness", &*result.computed, 2}};
}

std::string element_words(const std::string& group) {
  static const std::map<std::string, std::string> words = {
      {"sun_planet", "sun meshes"},         {"arc_pins", "arc meshes"},
      {"crank_arc", "arc gear bearings"},   {"crank_bearing", "crank bearings"},
      {"input_shaft", "input shaft"},       {"planet_shaft", "crank shafts"},
      {"input_support", "input's support"}, {"output_support", "output's support"}};
  const auto found = words.find(group);
  return found == words.end() ? group : found->second;
}

std::string mode_words(const std::string& name) {
  const auto at = name.find(" on ");
  return at == std::string::npos ? name : name.substr(0, at) + " on " + element_words(name.substr(at + 4));
}

std::string two_k_v_report(const TwoKVResult& result) {
  const auto& scene = result.scene;
  const auto stage = two_k_v_kinematics(scene);
  const std::string subtitle =
      fmt::format("annulus {} · scene <code>{}</code> · ratio {}, {} N m at {} r/min of the output", version(),
                  escape(scene.file.filename().string()), to_text(stage.ratio(), 6), to_text(scene.output.torque, 5),
                  to_text(scene.output.speed / units::rpm, 5));
  return report_page(escape(scene.title), subtitle, reducer_verdict(result),
                     {{{"drawings", "Geometry", drawings_section(result)},
                       {"figures", "Key figures", reducer_figures(result)},
                       {"comparison", "Comparison with the source", reducer_comparison(result)},
                       {"frequencies", "Natural frequencies", frequencies_section(result)},
                       {"first-frequency", "First frequency", first_frequency_section(result)},
                       {"torsion", "Torsional stiffness", torsion_section(result)},
                       {"motion", "Motion under load", reducer_motion_section(result)},
                       {"meshes", "Mesh stiffness", reducer_meshes_section(result)},
                       {"fields", "Deformation and stress",
                        fields_section({{"Sun mesh", &(result.computed ? *result.computed : result.own).tables.sun}})}},
                      study_sections(scene, result.studies),
                      {{"model", "What was modelled", model_section(result.plan)},
                       {"inputs", "Inputs", inputs_section(result.plan)},
                       {"quality", "Checks and cost", reducer_quality(result)}}});
}

}  // namespace annulus::app
