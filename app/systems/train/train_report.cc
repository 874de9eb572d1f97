#include <fmt/format.h>

#include "app/model/found_motions.h"
#include "app/sections/report_parts.h"
#include "app/sections/shafts.h"
#include "app/study/summary_studies.h"
#include "app/systems/train/train_motion.h"
#include "core/json.h"
#include "core/units.h"

namespace annulus::app {

namespace {

const TrainMotion* motion_of(const SystemRun& run) {
  return run.responses.empty() ? nullptr : &static_cast<const TrainRunResponse&>(*run.responses.front()).motion;
}

Section parts_section(const std::vector<WorkingPart>& parts) {
  PageTable table{.head = {"part", "body", "speed, r/min", "torque, N m", "power into the part, kW"},
                  .style = PageTable::Style::numbers};
  for (const auto& part : parts) {
    table.rows.push_back({part.name + ": " + part.system->describe()});
    for (const auto& body : part.system->turning_bodies())
      table.rows.push_back({"", body.name, to_text(std::abs(body.speed) / units::rpm, 6),
                            to_text(std::abs(body.torque), 6), to_text(body.speed * body.torque / units::kW, 6)});
  }
  return {"parts", "Parts",
          table + paragraph("Speeds and torques follow from those of the first part. A body with positive power drives "
                            "its part.")};
}

Section meshes_section(const TrainMotion& motion) {
  PageTable table{.head = {"mesh", "mesh frequency, Hz", "mean force", "largest force", "smallest force", "K_V",
                           "without contact, % of the time"},
                  .style = PageTable::Style::numbers};
  for (const auto& mesh : motion.response.meshes)
    table.rows.push_back({mesh.name, to_text(mesh.frequency, 6), text_in_unit(mesh.mean_force, shown_units::force),
                          measured_in_unit(mesh.largest_force, shown_units::force),
                          text_in_unit(mesh.smallest_force, shown_units::force), measured(mesh.dynamic_factor, 1),
                          measured(mesh.contact_loss, 100)});
  return {"meshes-in-motion", "Meshes in motion",
          table + paragraph("Forces of all meshes over the evaluated window. K_V: largest force over the mean of its "
                            "mesh cycle.")};
}

Section courses_section(const TrainMotion& motion) {
  Section section{"courses", "Torques in time"};
  if (motion.shafts.rows.empty()) return section;
  std::vector<Line> lines;
  Legend legend;
  for (std::size_t i = 1; i < motion.shafts.columns.size(); ++i) {
    lines.push_back({.column = motion.shafts.columns[i], .label = motion.shafts.columns[i], .colour = i - 1});
    legend.emplace_back(motion.shafts.columns[i], i - 1);
  }
  section.blocks = Pictures{
      {line_plot(wide_plot("Torques of the shafts", "time, ms", "torque / nominal torque"), motion.shafts,
                 {.x = "time_s", .x_scale = 1e3}, lines)},
      {},
      phrase("The beginning of the evaluated window. All motions and forces: {}.", code("dynamics/time_series.csv"))};
  return section;
}

Section modes_section(const TrainMotion& motion) {
  PageTable table{.head = {"mode", "frequency, Hz", "most kinetic energy", "share", "most strain energy", "share"},
                  .style = PageTable::Style::numbers};
  const auto percent = [](double share) { return fmt::format("{:.0f} %", 100 * share); };
  for (const auto& mode : motion.modes) {
    const bool free = mode.frequency == 0;
    table.rows.push_back({fmt::format("{}", table.rows.size() + 1),
                          free ? "0 " + muted("free rotation") : Text(to_text(mode.frequency, 6)), mode.body,
                          percent(mode.kinetic), free ? "–" : mode.element, free ? "–" : percent(mode.strain)});
  }
  return {"modes", "Natural frequencies",
          paragraph("Undamped modes of the whole train with the mean mesh stiffness.") + table};
}

Section space_section(const TrainMotion& motion, const std::vector<WorkingPart>& parts) {
  Section section{"bearings-and-faces", "Bearings and faces"};
  for (std::size_t i = 0; i < parts.size(); ++i)
    section.blocks += space_blocks(motion.space[i], fmt::format(" of '{}'", parts[i].name));
  return section;
}

}  // namespace

Json train_summary(const SystemRun& run, const std::vector<WorkingPart>& parts) {
  Json json = Json::object();
  if (const auto* motion = motion_of(run)) {
    const auto& r = motion->response;
    for (const auto& mesh : r.meshes)
      json["meshes"].push_back({{"mesh", mesh.name},
                                {"mesh_frequency_Hz", mesh.frequency},
                                {"mean_force_N", json_number(mesh.mean_force)},
                                {"largest_force_N", to_json(mesh.largest_force)},
                                {"smallest_force_N", json_number(mesh.smallest_force)},
                                {"dynamic_factor", to_json(mesh.dynamic_factor)},
                                {"contact_loss", to_json(mesh.contact_loss)}});
    json["shafts"] = to_json(r.shafts);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (const auto& space = motion->space[i]; !space.bearings.empty()) add_json(json["parts"][parts[i].name], space);
    json["motions"] = to_json(r.motions);
    for (const auto& mode : motion->modes)
      json["natural_frequencies"].push_back({{"frequency_Hz", mode.frequency},
                                             {"body", mode.body},
                                             {"kinetic_energy", mode.kinetic},
                                             {"element", mode.element},
                                             {"strain_energy", mode.strain}});
    json["dynamics"] = {{"steady", r.steady},
                        {"steady_difference", json_number(r.steady_difference)},
                        {"window_cycles", r.window_cycles},
                        {"whole_period", r.whole_period},
                        {"total_cycles", r.total_cycles},
                        {"energy_balance_relative", json_number(r.energy.relative)},
                        {"reused", run.responses.front()->reused}};
  }
  if (!run.studies.variants.empty()) json.update(variant_studies_json(run.studies, 0));
  return json;
}

Page train_report(const SystemRun& run, const std::vector<WorkingPart>& parts) {
  NamedMeshes solved;
  for (const auto* mesh : run.meshes()) solved.emplace_back(mesh->model.label(), mesh);
  std::vector<Section> sections;
  Blocks checks;
  if (const auto* motion = motion_of(run)) {
    sections = {meshes_section(*motion), courses_section(*motion), space_section(*motion, parts),
                modes_section(*motion)};
    checks = solution_checks({{"train", &motion->response}});
  }
  sections.push_back({"stiffness", "Mesh stiffness", solved.empty() ? Blocks() : stiffness_blocks(solved)});
  sections.push_back(contact_section(solved));
  return run_page(run, {.words = run.system->describe(),
                        .results = {key_results(run, {{"frequency_", "Natural frequencies"}, {"", "Train"}}, ""),
                                    parts_section(parts)},
                        .meshes = solved,
                        .sections = sections,
                        .checks = checks});
}

}  // namespace annulus::app
