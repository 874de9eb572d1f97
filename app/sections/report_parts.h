#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/model/measured.h"
#include "app/model/system_run.h"
#include "app/report/page.h"
#include "app/report/section.h"
#include "core/not_known.h"
#include "core/readable_unit.h"
#include "dynamics/steady_state/steady_response.h"

/// The sections of report pages, made from the results alone. A section without blocks has nothing to show and is left
/// out.
namespace annulus::app {

/// Meshes with their names for readers. The index in the list is the colour.
using NamedMeshes = std::vector<std::pair<std::string, const MeshResult*>>;

// results.cc
/// "1.364 ± 0.012": as many digits as the error leaves, five when there is no error.
[[nodiscard]] std::string measured(double value, double error);
[[nodiscard]] std::string measured(const Figure& figure, double scale);
/// "2.973 ± 0.076 kN/µm", "12.3 N" for a value in SI, in the unit that suits it (core/readable_unit.h).
[[nodiscard]] std::string measured_in_unit(const Figure& figure, const ShownUnit& declared);
[[nodiscard]] std::string text_in_unit(double value, const ShownUnit& declared, int digits = 4);
/// "1.21 (1.16 to 1.29)": median, and 5 % to 95 % of the samples, to two digits of their distance.
[[nodiscard]] std::string spread_text(const Spread& spread, double scale);
/// Behind the name of a result: its spread, and its value as the scene gives the inputs.
inline constexpr const char *spread_words = ", median (5 % to 95 %)", *nominal_words = ", nominal inputs";
/// "1.2e-10"; "–" for what is not known.
[[nodiscard]] std::string small_text(double x);
/// What the errors of these results are made of.
[[nodiscard]] Blocks error_parts(const std::vector<FigureSpec>& specs, const std::vector<VariantFigures>& variants);
/// `text` with a unit behind a comma when there is one.
[[nodiscard]] std::string with_unit(const std::string& text, const std::string& unit);
/// A heading in the table of results, above those whose keys begin with `prefix` and that no group before has.
struct ResultGroup {
  std::string prefix, heading;
};
/// All declared results of a run, one column per variant, and what their errors are made of. `conditions`: for which
/// operating point.
[[nodiscard]] Section key_results(const SystemRun& run, const std::vector<ResultGroup>& groups, const Text& conditions);
/// The words that the results of a run use, each with an anchor that `key_results` links to.
[[nodiscard]] Section definitions_section(const SystemRun& run);
/// The most important ones as lines of text.
[[nodiscard]] std::string key_results_text(const SystemRun& run);

// plots.cc
/// A plot over the whole width of the page, with a legend.
[[nodiscard]] Plot wide_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                             int height = 320);
/// The plots on one y axis.
[[nodiscard]] std::vector<Picture> on_one_scale(std::vector<Plot> plots);
/// A column of a table, of the rows whose first column lies below `rows_to`, each value times `scale`.
[[nodiscard]] std::vector<double> column_values(const Csv& csv, const std::string& name, double rows_to = 1e99,
                                                double scale = 1);
/// A line of a plot: a column over another one.
struct Line {
  std::string column, label{};
  std::size_t colour = 0;
  bool dashed = false;
  Series::Style style = Series::Style::line;
  std::string low{}, high{};  ///< columns of the band; empty: none
  double offset = 0;          ///< taken off the column
};
struct LineTable {
  std::string x;
  double x_scale = 1, y_scale = 1;
  double rows_to = 1e99;  ///< as of column_values
};
/// `frame` with lines from a table.
[[nodiscard]] Plot line_plot(Plot frame, const Csv& csv, const LineTable& table, const std::vector<Line>& lines);
/// Mesh cycles shown of a window: two error periods of planets with 55 teeth; longer windows are cut in the plots.
inline constexpr double shown_cycles = 110;

/// A table with a row for every line and a column for every subject.
template <class Subject>
struct TableRow {
  Text label;
  std::function<Text(const Subject&)> cell;
};
/// `subjects`: with their names.
template <class Subject>
[[nodiscard]] PageTable side_by_side(const std::vector<std::pair<std::string, const Subject*>>& subjects,
                                     const std::vector<TableRow<Subject>>& rows) {
  PageTable table{.head = {""}, .style = PageTable::Style::numbers};
  for (const auto& [name, subject] : subjects) table.head.emplace_back(name);
  for (const auto& row : rows) {
    auto& cells = table.rows.emplace_back(1, row.label);
    for (const auto& [name, subject] : subjects) cells.push_back(row.cell(*subject));
  }
  return table;
}

// answers.cc
/// What stiffnesses, load sharing and dynamic factors of several variants say, and the last two in one picture: by how
/// much the most loaded planet and the largest dynamic load exceed the ideal. `names`: of the variants, in the order of
/// their colours.
[[nodiscard]] Blocks answer_sentences(const std::vector<VariantQuantity>& quantities);
[[nodiscard]] Blocks answer_picture(const std::vector<VariantQuantity>& quantities,
                                    const std::vector<std::string>& names);

// run_page.cc
/// What the page of a kind shows besides the sections that all kinds have.
struct RunPage {
  Text words;                          ///< line below the title
  Blocks answer{};                     ///< what came out
  std::vector<Section> results{};      ///< in front of the meshes
  NamedMeshes meshes{};                ///< finite-element models
  std::vector<Section> sections{};     ///< of the motion and the meshes, the most important first
  std::vector<Section> geometry{};     ///< drawings
  Blocks checks{};                     ///< of the responses
  std::vector<std::string> choices{};  ///< kinds of meshes whose pictures are shown one at a time
  std::string line_kind{};             ///< see Page
  std::vector<std::string> lines{};
};
/// Version and scene, results, spread, these sections, studies, bodies, geometry, model, inputs, checks and cost.
[[nodiscard]] Page run_page(const SystemRun& run, const RunPage& page);
/// Source, DOI and note of the published results.
[[nodiscard]] Blocks source_blocks(const Reference& reference);
/// Invariants of the contact solves; meshes that were not computed have none.
[[nodiscard]] Blocks mesh_checks(const NamedMeshes& meshes);
/// How responses were found and how well: method, window, balances.
struct NamedOutcome {
  std::string name;
  const dynamics::SteadyOutcome* outcome = nullptr;
  double force_balance = not_known;  ///< relative; NaN: not known
};
[[nodiscard]] Blocks solution_checks(const std::vector<NamedOutcome>& responses);

// stiffness.cc
/// Loaded transmission error and stiffness over the mesh cycles, stiffness over load, load shares of the tooth pairs.
[[nodiscard]] Blocks stiffness_blocks(const NamedMeshes& meshes);
/// N/µm, mean secant and tangent stiffness at one of the loads of a table.
[[nodiscard]] double mean_at_load(const StiffnessTable& table, std::size_t load, double StiffnessEntry::*stiffness);
// contact.cc
[[nodiscard]] Section contact_section(const NamedMeshes& meshes);  ///< face width, pressure, stress
/// Largest root and rim stresses at every load of the tables, with their errors; empty without computed ones.
[[nodiscard]] Blocks stresses_by_load(const NamedMeshes& meshes);
/// Local stresses and pressures beside the nominal ones of [ISO6336-2] and [ISO6336-3]; empty without computed ones.
[[nodiscard]] Blocks beside_iso_6336(const NamedMeshes& meshes);

// studies.cc, sweeps.cc, grids.cc, load_spectrum.cc, transients.cc, spread.cc, sensitivity.cc, optimise.cc
/// All studies but the samples, in their order on the page.
[[nodiscard]] std::vector<Section> study_sections(const Scene& scene, const StudyResults& studies);
[[nodiscard]] Section sweeps_section(const Scene& scene, const StudyResults& studies);
[[nodiscard]] Section grids_section(const Scene& scene, const StudyResults& studies);
[[nodiscard]] Section load_spectrum_section(const StudyResults& studies);
[[nodiscard]] Section transients_section(const StudyResults& studies);
[[nodiscard]] Section spread_section(const StudyResults& studies);  ///< Monte Carlo samples
[[nodiscard]] Section sensitivity_section(const StudyResults& studies);
[[nodiscard]] Section optimise_section(const StudyResults& studies);
/// One colour per name; empty for a single one that is empty.
[[nodiscard]] Legend legend_of(const std::vector<std::string>& names);
/// Sentences on the points that failed or are not periodic.
struct StudyOutcome {
  int points = 0, failed = 0, not_steady = 0;
  std::string first{};  ///< failure

  void add(const StudyPoint& point, const std::string& place);
  [[nodiscard]] std::string text() const;
};
/// The pictures of all plotted results that `draw` has one of.
template <class Draw>
[[nodiscard]] std::vector<Picture> result_pictures(const StudyResults& studies, Draw draw) {
  std::vector<Picture> pictures;
  for (const auto& figure : studies.figures)
    if (figure.plotted)
      if (auto drawn = draw(figure)) pictures.emplace_back(*std::move(drawn));
  return pictures;
}
/// Whether a plot shows something: values that are known and not zero throughout.
[[nodiscard]] bool shows_something(const Plot& plot);

}  // namespace annulus::app
