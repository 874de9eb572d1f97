#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/plan/plan.h"
#include "app/results/content_id.h"
#include "app/scene/inputs_json.h"
#include "core/json.h"
#include "core/text_columns.h"

namespace annulus::app {

static void to_json(Json& json, const Decision& d) {
  json = {{"subject", d.subject}, {"choice", d.choice}, {"reason", d.reason}};
}
static void to_json(Json& json, const DofPlan& d) {
  json = {{"name", d.name}, {"retained", d.retained}, {"reason", d.reason}};
}
static void to_json(Json& json, const StudyPlan& s) {
  json = {{"name", s.name},
          {"description", s.description},
          {"responses", s.responses},
          {"stiffness_tables", s.tables},
          {"seconds_on_one_core", s.seconds}};
}

namespace {

std::string quantity_lines(const std::vector<Quantity>& quantities) {
  std::string text;
  for (const auto& q : quantities)
    text += "  " + left_aligned(to_text(q.value, 8) + " " + q.unit, 26) + q.meaning + "\n";
  return text;
}

std::string decision_lines(const std::vector<Decision>& list) {
  std::size_t longest = 0;
  for (const auto& d : list) longest = std::max(longest, d.choice.size());
  std::string text;
  for (const auto& d : list)
    text += "    " + left_aligned(d.subject, 26) + left_aligned(d.choice, std::min<std::size_t>(longest, 30) + 2) +
            d.reason + "\n";
  return text;
}

Json quantities_json(const std::vector<Quantity>& quantities) {
  Json json = Json::object();
  for (const auto& q : quantities) json[q.key] = q.value;
  return json;
}

std::string cost_lines(const Plan& plan) {
  const auto& cost = plan.cost;
  if (cost.empty()) return "";
  std::string text = fmt::format("\nPredicted cost on {} thread{}\n", cost.threads, cost.threads == 1 ? "" : "s");
  for (const auto& step : cost.steps) {
    text += "  " + left_aligned(step.label, 34) + fmt::format("{:>10}", duration_text(step.predicted.seconds));
    if (step.kind == CostKind::mesh || step.kind == CostKind::response)
      text += fmt::format("{:>11}", memory_text(step.predicted.peak_MB));
    if (step.kind == CostKind::mesh && step.size.unknowns > 0)
      text += fmt::format(
          "   level {}, about {:.0f} thousand unknowns, expected error {}", step.size.level, step.size.unknowns / 1e3,
          std::isfinite(step.expected_error) ? fmt::format("{:.2g} %", 100 * step.expected_error) : "not known");
    text += "\n";
    if (step.further)
      text += "    " + left_aligned("if " + step.follow, 32) +
              fmt::format("{:>10}{:>11}\n", duration_text(step.further->seconds), memory_text(step.further->peak_MB));
  }
  text += "  " + left_aligned("in all", 34) +
          fmt::format("{:>10}{:>11}\n", duration_text(cost.seconds()), memory_text(cost.peak_MB()));
  const bool open =
      std::any_of(cost.steps.begin(), cost.steps.end(), [](const auto& s) { return s.further.has_value(); });
  if (const auto worst = cost.at_worst(); open)
    text += "  " + left_aligned("at worst", 34) +
            fmt::format("{:>10}{:>11}   --max-time and --max-memory are compared with this\n",
                        duration_text(worst.seconds()), memory_text(worst.peak_MB()));
  if (cost.pace != 1)
    text += fmt::format(
        "  Times are {:.2g} times those of the cost laws: the speed of this machine. --budget and --max-time use the "
        "cost laws.\n",
        cost.pace);
  return plan.budget.empty() ? text : text + "  " + plan.budget + "\n";
}

std::string study_lines(const Plan& plan) {
  std::string text = plan.studies.empty() ? "" : "\nStudies\n";
  for (const auto& s : plan.studies) {
    text += fmt::format("  {}: {}; {} responses{}, about {} on one core", s.name, s.description, s.responses,
                        plan.variants.empty() ? "" : fmt::format(" of all {}s", plan.variant_word),
                        duration_text(s.seconds));
    text += s.tables ? fmt::format("; {}{} own stiffness tables\n", s.tables_counted ? "" : "about ", s.tables)
                     : ", on the tables of the scene\n";
  }
  return text;
}

std::string warning_lines(const Plan& plan) {
  std::string text = plan.warnings.empty() ? "" : "\nWarnings\n";
  for (const auto& warning : plan.warnings) text += "  " + to_text(warning) + "\n";
  return text;
}

std::string input_lines(const std::vector<Input>& inputs) {
  std::string text, variant;
  for (const auto& input : inputs) {
    if (!input.variant.empty() && input.variant != variant)
      text += fmt::format("  {} '{}'\n", input.key.substr(0, input.key.find('.')), input.variant);
    variant = input.variant;
    text += "  " + left_aligned(input.key, 40) + left_aligned(to_text(input.value) + " " + input.unit, 30) +
            (input.assumed.empty() ? "  " : "* ") + to_text(input.origin);
    if (input.origin != Origin::scene && !input.note.empty()) text += " (" + input.note + ")";
    text += "\n";
  }
  return text;
}

/// Those of several variants once.
std::string assumed_lines(const std::vector<Input>& inputs) {
  std::string text;
  std::set<std::string> seen;
  for (const auto& input : inputs)
    if (!input.assumed.empty() && seen.insert(input.key).second) text += "  " + input.key + ": " + input.assumed + "\n";
  return text.empty() ? text : "\nAssumed inputs, with reasons\n" + text;
}

}  // namespace

std::string overview(const Plan& plan) {
  std::string text = plan.title + "\n\nMeshes\n";
  for (const auto& mesh : plan.meshes)
    text += "  " + left_aligned(mesh.label(), 36) + left_aligned(mesh.fidelity, 14) +
            (mesh.computed() ? fmt::format("{} phases, {} ring position{}; ", mesh.problem->phases, mesh.positions,
                                           mesh.positions == 1 ? "" : "s")
                             : "") +
            mesh.reason + "\n";
  if (!plan.motion.empty()) text += "\nMotion\n";
  for (const auto& d : plan.motion) text += "  " + left_aligned(d.subject, 36) + d.choice + "\n";
  std::vector<std::string> dropped;
  for (const auto& f : plan.dofs)
    if (!f.retained) dropped.push_back(f.name);
  if (!dropped.empty())
    text +=
        "  " + left_aligned("rigid, degrees of freedom dropped", 36) + fmt::format("{}\n", fmt::join(dropped, "; "));
  return text + study_lines(plan) + cost_lines(plan) + warning_lines(plan) +
         "\n--inputs lists every input with its origin, reasons and remarks.\n";
}

std::string to_text(const Plan& plan) {
  std::string text =
      plan.title + "\n\nInputs (origin: scene, default, derived; * assumed)\n" + input_lines(plan.inputs);
  text += "\nDerived\n" + quantity_lines(plan.quantities);
  for (const auto& [name, quantities] : plan.variants)
    text += fmt::format("  {} '{}'\n", plan.variant_word, name) + quantity_lines(quantities);

  text += "\nMeshes and bodies\n";
  for (const auto& mesh : plan.meshes) text += "  " + mesh.label() + "\n" + decision_lines(decisions(mesh));
  text += fmt::format("  {} contact problems per level of resolution\n", plan.contact_problems());
  text += cost_lines(plan);

  if (!plan.dofs.empty())
    text += plan.motion.empty() ? "\nDegrees of freedom\n" : "\nLumped model\n" + decision_lines(plan.motion);
  for (const auto& f : plan.dofs)
    text += fmt::format("  {} {} {}\n", f.retained ? "retained" : "dropped ", left_aligned(f.name, 18), f.reason);

  text += study_lines(plan) + "\nRemarks\n";
  for (const auto& remark : plan.remarks) text += "  " + remark + "\n";
  return text + warning_lines(plan) + assumed_lines(plan.inputs);
}

Json to_json(const Plan& plan) {
  Json json;
  json["annulus_version"] = version();
  json["title"] = plan.title;
  json["inputs"] = inputs_json(plan.inputs);
  json["stage"] = quantities_json(plan.quantities);
  for (const auto& [name, quantities] : plan.variants)
    json[plan.variant_word + "s"][name] = quantities_json(quantities);
  for (const auto& mesh : plan.meshes) {
    Json item = {{"mesh", mesh.mesh}, {"model", mesh.fidelity}, {"reason", mesh.reason}};
    if (!mesh.variant.empty()) item[plan.variant_word] = mesh.variant;
    item["decisions"] = decisions(mesh);
    if (mesh.computed()) {
      item["phases"] = mesh.problem->phases;
      item["ring_positions"] = mesh.positions;
      item["loads_N"] = mesh.problem->loads;
      if (mesh.has_elements()) item["degree"] = mesh.settings.degree;
      for (const auto& step : plan.cost.steps) {
        if (step.kind != CostKind::mesh || step.label != mesh.label()) continue;
        item["predicted_s"] = json_number(step.predicted.seconds);
        item["predicted_peak_MB"] = json_number(step.predicted.peak_MB);
        if (!step.further) continue;
        item["predicted_worst_s"] = json_number(step.further->seconds);
        item["predicted_worst_peak_MB"] = json_number(step.further->peak_MB);
      }
    }
    json["meshes"].push_back(std::move(item));
  }
  json["motion"] = plan.motion;
  json["degrees_of_freedom"] = plan.dofs;
  if (!plan.studies.empty()) json["studies"] = plan.studies;
  json["remarks"] = plan.remarks;
  json["warnings"] = to_json(plan.warnings);
  json["contact_problems"] = plan.contact_problems();
  if (plan.cost.empty()) return json;
  json["threads"] = plan.cost.threads;
  for (const auto& step : plan.cost.steps) {
    Json item = {{"step", to_text(step.kind)},
                 {"name", step.label},
                 {"predicted_s", json_number(step.predicted.seconds)},
                 {"predicted_peak_MB", json_number(step.predicted.peak_MB)}};
    if (step.kind == CostKind::mesh) {
      item["level"] = step.size.level;
      item["unknowns"] = std::lround(step.size.unknowns);
      item["expected_error_relative"] = json_number(step.expected_error);
    }
    json["cost"].push_back(std::move(item));
  }
  json["predicted_s"] = json_number(plan.cost.seconds());
  json["predicted_peak_MB"] = json_number(plan.cost.peak_MB());
  json["predicted_worst_s"] = json_number(plan.cost.at_worst().seconds());
  json["predicted_worst_peak_MB"] = json_number(plan.cost.at_worst().peak_MB());
  if (!plan.budget.empty()) json["budget"] = plan.budget;
  return json;
}

}  // namespace annulus::app
