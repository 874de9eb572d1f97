#include <memory>

#include "app/model/gear_system.h"
#include "app/model/system_run.h"
#include "app/model/table_errors.h"
#include "app/sections/report_parts.h"
#include "app/study/summary_studies.h"

/// What a run, its summary and its report are for a kind that has nothing beyond its lumped models: results with the
/// errors of the tables, and a page with the sections that all kinds have.
namespace annulus::app {

std::unique_ptr<RunResponse> GearSystem::respond(const SystemRun& run, std::size_t variant,
                                                 const RunOptions& /*options*/) const {
  auto response = std::make_unique<RunResponse>();
  response->figures = model_results(*this, variant, run.tables_of(variant));
  return response;
}

Json GearSystem::summary(const SystemRun& run) const {
  Json json = Json::object();
  for (const auto& q : run.plan.quantities) json["derived"][q.key] = json_number(q.value);
  for (std::size_t i = 0; i < run.studies.variants.size(); ++i)
    json["studies"][run.studies.variants[i]] = variant_studies_json(run.studies, i);
  return json;
}

std::string GearSystem::text(const SystemRun& run) const { return key_results_text(run); }

Page GearSystem::report(const SystemRun& run) const {
  NamedMeshes solved;
  for (const auto* mesh : run.meshes()) solved.emplace_back(mesh->model.label(), mesh);
  return run_page(run,
                  {.words = describe(),
                   .results = {key_results(run, {{"", ""}}, "")},
                   .meshes = solved,
                   .sections = {{"stiffness", "Mesh stiffness", solved.empty() ? Blocks() : stiffness_blocks(solved)},
                                contact_section(solved)}});
}

}  // namespace annulus::app
