#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "app/model/measured.h"
#include "app/model/system_run.h"
#include "app/report/page.h"
#include "app/report/section.h"
#include "dynamics/steady_state/steady_response.h"

/// The sections of report pages, made from the results alone. A section without blocks has nothing to show and is left
/// out.
namespace annulus::app {

/// "1.364 ± 0.012": as many digits as the error leaves, five when there is no error.
[[nodiscard]] std::string measured(double value, double error);
/// "1.2e-10"; "–" for what is not known.
[[nodiscard]] std::string small_text(double x);
/// `text` with a unit behind a comma when there is one.
[[nodiscard]] std::string with_unit(const std::string& text, const std::string& unit);

// sections/shared_plots.cc: what several sections draw
/// The plots on one y axis.
[[nodiscard]] std::vector<Picture> on_one_scale(std::vector<Plot> plots, const RangeFinder& range);
/// One quantity of a stiffness table over the mesh cycles at the nominal load: the solved positions, and the periodic
/// curve through them that the dynamics uses, with the estimated error around it.
struct CycleCurve {
  std::vector<double> cycles, value, low, high;
  std::vector<double> solved_cycles, solved;
  double mean = 0;
};
/// `pieces`: of the curve between two solved positions; 1: the positions themselves.
[[nodiscard]] CycleCurve cycle_curve(const MeshResult& mesh, const std::function<double(const StiffnessEntry&)>& pick,
                                     int pieces);
[[nodiscard]] double secant_N_per_um(const StiffnessEntry& entry);
/// Mean over all positions of a table at one of its loads.
[[nodiscard]] double mean_at_load(const StiffnessTable& table, std::size_t load,
                                  const std::function<double(const StiffnessEntry&)>& pick);
/// A column of a table, of the rows whose first column lies below `rows_to`, each value times `scale`.
[[nodiscard]] std::vector<double> column_values(const Csv& csv, const std::string& name, double rows_to = 1e99,
                                                double scale = 1);
/// Mesh cycles shown of a window: two error periods of planets with 55 teeth; longer windows are cut in the plots.
inline constexpr double shown_cycles = 110;

// sections/answers.cc
/// What the stiffness of the ring mesh, load sharing and dynamic factors of several rings say, and the last two in one
/// picture: by how much the most loaded planet and the largest dynamic load exceed the ideal. `names`: of the rings, in
/// the order of their colours.
[[nodiscard]] Blocks answer_sentences(const std::vector<RingQuantity>& quantities);
[[nodiscard]] Blocks answer_picture(const std::vector<RingQuantity>& quantities, const std::vector<std::string>& names);

// sections/shared.cc, sections/meshes.cc: the same for all kinds of gear systems
/// A page of a run: version, scene and `stage_words` in the line below the title; the sections group after group.
[[nodiscard]] Page scene_page(const Scene& scene, const Text& stage_words, const Blocks& summary,
                              const std::vector<std::vector<Section>>& groups);
/// Source, DOI and note of the published results.
[[nodiscard]] Blocks source_blocks(const Reference& reference);
[[nodiscard]] Section model_section(const Plan& plan);   ///< what was modelled and why
[[nodiscard]] Section inputs_section(const Plan& plan);  ///< every input with its origin, the assumed ones first
/// Invariants of the contact solves; meshes that were not computed have none.
[[nodiscard]] Blocks mesh_checks(const std::vector<std::pair<std::string, const MeshResult*>>& meshes);
/// How responses were found and how well: method, window, balances.
struct NamedOutcome {
  std::string name;
  const dynamics::SteadyOutcome* outcome = nullptr;
  double force_balance = std::numeric_limits<double>::quiet_NaN();  ///< relative; NaN: not known
};
[[nodiscard]] Blocks solution_checks(const std::vector<NamedOutcome>& responses);
/// Predicted and actual cost of the steps, wall time of the stages and the peak of the memory.
[[nodiscard]] Blocks cost_blocks(const SystemRun& run);
/// Deformation and stress of meshes with their titles; those that are null or were not solved have none.
[[nodiscard]] Section fields_section(const std::vector<std::pair<std::string, const MeshResult*>>& meshes);
/// Pictures of the finite-element meshes, each with its title and caption; empty without any.
[[nodiscard]] Blocks mesh_pictures(const std::vector<std::pair<std::string, const MeshResult*>>& meshes);
/// Errors of the stiffness of meshes by cause; empty when none was computed.
[[nodiscard]] Blocks stiffness_errors(const std::vector<std::pair<std::string, const MeshResult*>>& meshes);

// sections/spread.cc, sweeps.cc, grids.cc, sensitivity.cc, optimise.cc
[[nodiscard]] Section spread_section(const StudyResults& studies);  ///< Monte Carlo samples
[[nodiscard]] Section sweeps_section(const Scene& scene, const StudyResults& studies);
[[nodiscard]] Section grids_section(const Scene& scene, const StudyResults& studies);
[[nodiscard]] Section sensitivity_section(const StudyResults& studies);
[[nodiscard]] Section optimise_section(const StudyResults& studies);
/// All of these, in their order on the page.
[[nodiscard]] std::vector<Section> study_sections(const Scene& scene, const StudyResults& studies);
/// One colour per variant; empty for a kind without variants.
[[nodiscard]] Legend variant_legend(const StudyResults& studies);

}  // namespace annulus::app
