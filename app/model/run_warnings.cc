#include "app/model/run_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/found_motions.h"
#include "app/model/gear_system.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// Of a solved mesh.
void warn_of_mesh(std::vector<Warning>& list, const MeshResult& mesh, double accuracy) {
  if (!mesh.model.computed()) return;
  const auto where = mesh.model.label();
  const auto stiffness = mesh.mean_stiffness();
  if (std::isfinite(stiffness.error_relative) && stiffness.error_relative > accuracy)
    list.push_back({"accuracy_not_reached", Severity::warning,
                    fmt::format("the error of the mean stiffness is {:.2g} %, more than the wanted {:g} %{}",
                                100 * stiffness.error_relative, 100 * accuracy,
                                stiffness.parts.model > accuracy
                                    ? "; most of it is plane strain, which solid elements (model = \"solid\") avoid"
                                    : ""),
                    where});
  const double backlash = mesh.model.problem->pair.normal_backlash();
  const auto deflection = mesh.lte_mean();
  if (backlash < deflection.value)
    list.push_back({"backlash_below_deflection", Severity::note,
                    fmt::format("the backlash of {:.3g} µm is less than the deflection of {:.3g} µm: back flanks may "
                                "touch, and the contact solution contains only the driving flanks",
                                backlash / units::um, deflection.value / units::um),
                    where});
  if (const auto edge = mesh.peak("tip_edge_contact"); edge && edge->value != 0)
    list.push_back({"singular_pressure", Severity::note,
                    "teeth touch at a tip edge, where the pressure is singular: its peak grows with every refinement. "
                    "Tip relief avoids it",
                    where});
}

/// Of the answer of a lumped model.
void warn_of_response(std::vector<Warning>& list, const SystemRun& run, std::size_t variant,
                      const VariantFigures& answer) {
  const auto& figures = answer.figures;
  if (figures.find("steady") && figures.value("steady") == 0)
    list.push_back({"not_periodic", Severity::severe,
                    "no periodic steady state was reached. The results hold for the evaluated window only; they are "
                    "marked with †",
                    answer.name});
  double lost = 0;
  for (const auto& entry : figures.entries())
    if (entry.key.ends_with("contact_loss") && std::isfinite(entry.figure.value))
      lost = std::max(lost, entry.figure.value);
  const auto motions = motion_warnings(run.responses.at(variant)->motions, lost, answer.name);
  list.insert(list.end(), motions.begin(), motions.end());
  for (const auto* mesh : run.tables_of(variant)) {
    const auto own = mesh->model.mesh + "_peak_factor";
    const double factor = figures.value(figures.find(own) ? own : "peak_factor");
    const auto& loads = mesh->table.loads();
    if (!mesh->tabulated || loads.size() < 2 || !std::isfinite(factor)) continue;
    const double largest = factor * loads.at(mesh->nominal);
    if (largest <= loads.back()) continue;
    list.push_back({"force_beyond_table", Severity::warning,
                    fmt::format("forces up to {:.4g} kN exceed the tabulated {:.4g} kN; beyond it the force is "
                                "extrapolated with the tangent stiffness",
                                largest / 1e3, loads.back() / 1e3),
                    (answer.name.empty() ? "" : answer.name + ", ") + mesh->model.label()});
  }
  int unknown = 0;
  for (const auto& entry : figures.entries()) {
    auto of_tables = entry.parts;
    of_tables.integration = 0;  // some results of the motion have no estimate by design
    unknown += std::isfinite(entry.figure.value) && !std::isfinite(of_tables.total()) ? 1 : 0;
  }
  if (unknown > 0)
    list.push_back(
        {"errors_not_known", Severity::warning,
         fmt::format("the effect of the table errors on {} results is not known; the messages of the run state why",
                     unknown),
         answer.name});
}

void warn_of_samples(std::vector<Warning>& list, const StudyResults& studies) {
  if (!studies.monte_carlo) return;
  for (std::size_t i = 0; i < studies.variants.size(); ++i) {
    const auto& samples = studies.monte_carlo->variants[i];
    if (samples.failed + samples.not_steady == 0) continue;
    list.push_back(
        {"samples", Severity::warning,
         fmt::format("of {} samples, {} failed and {} have no periodic steady state; monte_carlo.csv lists them",
                     studies.monte_carlo->samples, samples.failed, samples.not_steady),
         studies.variants[i]});
  }
}

}  // namespace

std::vector<Warning> run_warnings(const SystemRun& run) {
  auto list = run.plan.warnings;
  for (const auto* mesh : run.meshes()) warn_of_mesh(list, *mesh, run.scene.accuracy);
  if (!run.responses.empty()) {
    const auto answers = run.variants();
    for (std::size_t i = 0; i < answers.size(); ++i) {
      warn_of_response(list, run, i, answers[i]);
      for (auto& warning : run.system->response_warnings(run, i)) list.push_back(std::move(warning));
    }
  }
  warn_of_samples(list, run.studies);
  return by_severity(std::move(list));
}

}  // namespace annulus::app
