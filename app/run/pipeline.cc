#include "app/run/pipeline.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include <algorithm>

#include "app/model/cost_actual.h"
#include "app/model/gear_system.h"
#include "app/model/run_warnings.h"
#include "app/report/page.h"
#include "app/results/content_id.h"
#include "app/results/figure_table.h"
#include "app/results/result_folder.h"
#include "app/scene/inputs_json.h"
#include "app/scene/scene_files.h"
#include "app/scene/scene_schema.h"
#include "app/study/studies.h"
#include "app/study/study_subject.h"
#include "app/study/summary_studies.h"
#include "core/files.h"

namespace annulus::app {

namespace {

/// Meshes by their own times, then the steps that the run measured.
std::vector<std::pair<std::string, double>> timings_of(const SystemRun& run) {
  double mesh = 0, condense = 0, contact = 0, total = 0;
  for (const auto* result : run.meshes()) {
    if (result->reused) continue;
    mesh += result->fact("mesh_seconds");
    condense += result->fact("condense_seconds");
    contact += result->fact("contact_seconds");
  }
  std::vector<std::pair<std::string, double>> list = {{"mesh", mesh}, {"condense", condense}, {"contact", contact}};
  double named = mesh + condense + contact;
  for (const auto& [step, seconds] : run.timers.report()) {
    if (step == "total") total = seconds;
    if (step == "total" || step == "other") continue;
    list.emplace_back(step, seconds);
    named += seconds;
  }
  list.emplace_back("other", std::max(0.0, total - named));
  list.emplace_back("total", total);
  return list;
}

/// Identity of the inputs and of what is solved.
std::string inputs_id(const SystemRun& run) {
  ContentId id;
  for (const auto& input : run.scene.inputs) id.add(input.variant + "." + input.key, to_text(input.value));
  for (const auto& mesh : run.tables) id.add("mesh", mesh.model.id());
  for (const auto& file : input_files(run.scene))
    id.add(file, file_checksum(run.scene.file.parent_path() / file).value_or("missing"));
  return id.id();
}

}  // namespace

std::shared_ptr<const SystemRun> run_system(const Scene& scene, const RunOptions& given) {
  const RunOptions options = with_reuse(given);
  const auto result = std::make_shared<SystemRun>(scene);
  auto& run = *result;
  run.command = options.command;
  const bool timed = options.times == Times::stated;
  if (timed) run.date = fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(std::time(nullptr)));
  if (scene.reference) run.reference = read_reference(file_of_scene(scene, "reference", *scene.reference));
  if (options.with_dynamics) check_studies(scene);  // before anything expensive
  run.plan = run.system->plan(options.threads);
  auto& meshes = run.plan.meshes;
  if (options.remodel) std::transform(meshes.begin(), meshes.end(), meshes.begin(), options.remodel);
  if (options.folder)
    options.folder->begin();
  else
    std::filesystem::create_directories(options.out);
  run.solve_meshes(options);
  if (options.with_dynamics && scene.dynamics) run.respond(options);
  if (options.with_dynamics) {
    const auto timer = run.timers.measure("studies");
    run.studies = run_studies(StudySubject(run, options));
  }
  run.reuse = options.reuse;
  if (timed) {
    run.timings = timings_of(run);
    run.peak_memory_MB = peak_memory_MB();
    run.cost = actual_costs(run);
    keep_costs(run.cost);
  }
  const auto& specs = system_kind(scene.stage.kind).figures();
  write_file(options.out / "figures.csv", figures_csv(specs, run.variants()));
  write_file(options.out / "summary.json", text_of(summary_json(run)));
  write_report(options.out / "report.html", run.system->report(run));
  return result;
}

Json summary_json(const SystemRun& run) {
  const auto& scene = run.scene;
  Json json = {{"title", scene.title},
               {"annulus_version", version()},
               {"kind", scene.stage.kind},
               {"accuracy_wanted", scene.accuracy}};
  json.update(run.system->summary(run));
  json["variants"] = Json::array();
  for (const auto& variant : run.variants())
    json["variants"].push_back({{"name", variant.name}, {"figures", to_json(variant.figures)}});
  json["warnings"] = to_json(run_warnings(run));
  json.update(studies_json(run.studies));
  json["inputs_id"] = inputs_id(run);
  json["inputs"] = inputs_json(run.plan.inputs);
  for (const auto& [step, seconds] : run.timings) json["timings_s"][step] = seconds;
  if (!run.timings.empty()) json["peak_memory_MB"] = run.peak_memory_MB;
  if (!run.cost.empty()) json["cost"] = cost_json(run.cost);
  if (run.reuse) json["reuse"] = run.reuse->json();
  return json;
}

std::string run_text(const SystemRun& run) {
  std::string text = run.system->text(run) + "\n";
  std::size_t notes = 0;
  for (const auto& warning : run_warnings(run)) {
    if (warning.severity == Severity::note)
      ++notes;
    else
      text += to_text(warning) + "\n";
  }
  if (notes > 0) text += fmt::format("{} notes: in the report and in summary.json\n", notes);
  text += "\n";
  if (!run.timings.empty()) {
    text += "time   ";
    for (const auto& [step, seconds] : run.timings) text += fmt::format(" {} {:.2f} s ", step, seconds);
    text += fmt::format("\nmemory  {:.0f} MB at the peak\n", run.peak_memory_MB);
  }
  if (const std::string cost = cost_sentence(run); !cost.empty()) text += "cost    " + cost + "\n";
  if (run.reuse) text += run.reuse->text();
  return text + "results all of them in figures.csv\n";
}

}  // namespace annulus::app
