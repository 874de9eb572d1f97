#pragma once

#include <string>
#include <vector>

#include "app/report/svg_plot.h"
#include "app/stage/measured.h"
#include "app/stage/planetary_run.h"

/// The parts of report.html, each a piece of HTML made from the results alone.
namespace annulus::app {

/// "1.364 ± 0.012": as many digits as the error leaves, five when there is no error.
[[nodiscard]] std::string measured(double value, double error);

struct HtmlTable {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;  ///< cells are HTML
  std::string css_class{};
};
[[nodiscard]] std::string html(const HtmlTable& table);

[[nodiscard]] std::string cost_html(const std::vector<std::pair<std::string, double>>& timings, double peak_memory_MB);
/// Invariants of a contact solve, for `mesh_check_table`.
[[nodiscard]] std::vector<std::string> mesh_check_row(const std::string& label, const MeshResult& mesh);
[[nodiscard]] HtmlTable mesh_check_table();

/// Plots side by side under one legend and one caption (HTML).
[[nodiscard]] std::string figure(const std::vector<std::string>& pictures, const std::string& legend,
                                 const std::string& caption);
/// All meshes of a run with a name for people, the rings' first, then the sun's; the index is their colour.
[[nodiscard]] std::vector<std::pair<std::string, const MeshResult*>> all_meshes(const RunResult& result);

/// Legend shared by the plots of a figure: label and palette index.
[[nodiscard]] std::string legend_html(const std::vector<std::pair<std::string, std::size_t>>& entries);

/// A part of a report page; without text it is left out.
struct Section {
  std::string anchor, name, text;
};
/// The whole page: title, line below it, verdict, links and sections, group after group. `title` and `sub` are HTML.
[[nodiscard]] std::string report_page(const std::string& title, const std::string& sub, const std::string& verdict,
                                      const std::vector<std::vector<Section>>& groups);

/// The rings whose dynamics were asked for.
[[nodiscard]] std::vector<const RingResult*> rings_with_response(const RunResult& result);
/// A column of a table, of the rows whose first column lies below `rows_to`.
[[nodiscard]] std::vector<double> column_values(const Csv& csv, const std::string& name, double rows_to = 1e99);
/// One colour per planet.
[[nodiscard]] std::string planet_legend(int planets);
/// Mesh cycles shown of a window: two error periods of planets with 55 teeth; longer windows are cut in the plots.
inline constexpr double shown_cycles = 110;

// report_tables.cc
[[nodiscard]] std::string verdict_section(const RunResult& result);  ///< what came out, in plain words
/// What the stiffness of the ring mesh, load sharing and dynamic factors of several rings say, and the last two in one
/// picture: by how much the most loaded planet and the largest dynamic load exceed the ideal. `names`: of the rings, in
/// the order of their colours.
[[nodiscard]] std::string answer_sentences(const std::vector<RingQuantity>& quantities);
[[nodiscard]] std::string answer_picture(const std::vector<RingQuantity>& quantities,
                                         const std::vector<std::string>& names);
[[nodiscard]] std::string key_figures_section(const RunResult& result);
[[nodiscard]] std::string comparison_section(const RunResult& result);  ///< with the published results
// report_inputs.cc
[[nodiscard]] std::string model_section(const RunResult& result);  ///< what was modelled and why
[[nodiscard]] std::string inputs_section(
    const RunResult& result);  ///< every input with its origin, the assumed ones first
[[nodiscard]] std::string model_section(const Plan& plan);
[[nodiscard]] std::string inputs_section(const Plan& plan);
[[nodiscard]] std::string quality_section(const RunResult& result);  ///< invariants, timings, versions
// report_fields.cc: deformation and stress; empty where nothing was solved
[[nodiscard]] std::string fields_section(const RunResult& result);
/// Of meshes with their titles; those that are null or were given have none.
[[nodiscard]] std::string fields_section(const std::vector<std::pair<std::string, const MeshResult*>>& meshes);
// report_stiffness.cc
[[nodiscard]] std::string meshes_section(const RunResult& result);
[[nodiscard]] std::string stiffness_section(const RunResult& result);        ///< transmission error, stiffness, shares
[[nodiscard]] std::string stiffness_error_section(const RunResult& result);  ///< their errors by cause
// report_supports.cc
[[nodiscard]] std::string supports_section(const RunResult& result);  ///< pins, bolts and splines; empty without
// report_contact.cc
[[nodiscard]] std::string contact_section(const RunResult& result);  ///< face width, pressure, stress; empty if unknown
// report_dynamics.cc
[[nodiscard]] std::string dynamics_section(const RunResult& result);  ///< load sharing, dynamic factors, spectra
// report_spread.cc, report_sweeps.cc, report_grids.cc, report_sensitivity.cc, report_optimise.cc; empty where the scene
// does not ask
[[nodiscard]] std::string spread_section(const StudyResults& studies);  ///< Monte Carlo samples
[[nodiscard]] std::string sweeps_section(const Scene& scene, const StudyResults& studies);
[[nodiscard]] std::string grids_section(const Scene& scene, const StudyResults& studies);
[[nodiscard]] std::string sensitivity_section(const StudyResults& studies);
[[nodiscard]] std::string optimise_section(const StudyResults& studies);
/// All of these, in their order on the page.
[[nodiscard]] std::vector<Section> study_sections(const Scene& scene, const StudyResults& studies);
/// One colour per variant; empty for a kind without variants.
[[nodiscard]] std::string variant_legend(const StudyResults& studies);
// report_coupling.cc
[[nodiscard]] std::string coupling_section(const RunResult& result);  ///< of the planets through the ring
// report_motion.cc
[[nodiscard]] std::string motion_section(const RunResult& result);  ///< bearing forces, sun orbit, Poincaré section
// report_modes.cc
[[nodiscard]] std::string modes_section(const RunResult& result);  ///< frequencies, shapes, Campbell diagram

}  // namespace annulus::app
