#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace annulus::app {

/// The size of one step of a run, and what it cost where it was measured.
struct CostRun {
  /// A mesh by its model ("closed_form", "plane", "solid", "resolved_plane", "resolved_solid"), "solid_half" on half of
  /// a symmetric face or "solid_helical",
  /// "coupling_plane", "coupling_pins" (on pins or splines) and "coupling_solid", or the "response" of one ring:
  /// "response_elastic" where its elastic modes may take part, "response_given" with stiffness that is given, where no
  /// errors of tables are carried through, "response_direct" where nothing is integrated in time, "response_pair",
  /// "response_two_k_v" and "response_two_k_v_given" of the other stages.
  std::string kind;
  int degree = 2;
  int level = 0;                          ///< of resolution reached
  int levels = 1;                         ///< solved on the way, the reached one included
  double unknowns = 0;                    ///< of the reached level; a response: planets x mesh cycles of the
                                          ///< period, of a pair: responses x mesh cycles; a coupling on pins: times
                                          ///< the ring positions
  int loads = 0, phases = 0, cycles = 0;  ///< of the table: loads, phases per mesh cycle, mesh cycles
  int threads = 1;
  double supports = 0;   ///< forces of pins or splines in every contact problem of a solid ring
  double error = 0;      ///< estimated relative error at the reached level; 0: not known
  double body_s = 0;     ///< s, meshing and condensing; all there is of a coupling or a response
  double contact_s = 0;  ///< s
  double peak_MB = 0;    ///< of the process; 0: not measured
  double saved_s = 0;    ///< s, what teeth condensed before have saved of body_s; NaN: not known. Not kept.

  [[nodiscard]] double seconds() const { return body_s + contact_s; }
  /// Contact problems of one mesh cycle, and of all, closure included, per level.
  [[nodiscard]] double first_problems() const { return loads * (phases + 1.0); }
  [[nodiscard]] double problems() const { return loads * (static_cast<double>(phases) * cycles + 1.0); }
};

/// One line each, after a line that names the columns; `#` begins a comment. Throws InputError naming `name` and the
/// line for anything else, and for numbers that are negative or not finite.
[[nodiscard]] std::vector<CostRun> parse_cost_runs(const std::string& text, const std::string& name);
[[nodiscard]] std::string cost_runs_text(const std::vector<CostRun>& runs);

/// The runs kept with the program (data/cost_runs.csv).
[[nodiscard]] const std::vector<CostRun>& kept_cost_runs();

/// Where the costs measured on this machine are kept: $ANNULUS_CACHE/costs.csv, else $XDG_CACHE_HOME/annulus/costs.csv,
/// else ~/.cache/annulus/costs.csv. Empty, so that none are kept, when ANNULUS_CACHE is set to nothing or no home is
/// known.
[[nodiscard]] std::filesystem::path user_costs_file();
/// Nothing when there is no such file or it is damaged.
[[nodiscard]] std::vector<CostRun> read_user_costs(const std::filesystem::path& file);
/// Adds runs, of which the last 200 are kept. What cannot be written is let be: costs are only a help.
void add_user_costs(const std::filesystem::path& file, const std::vector<CostRun>& runs);

}  // namespace annulus::app
