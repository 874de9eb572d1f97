#pragma once

#include <string>
#include <vector>

#include "app/scene/overrides.h"
#include "core/figure.h"
#include "dynamics/statistics/sampling.h"

/// What the studies of a scene consist of: lists of changed scenes, made without computing anything.
namespace annulus::app {

/// One changed scene.
struct StudyCase {
  std::vector<Override> overrides{};
  std::string where{};   ///< for messages: "[[sweep]] 1, value 7 of 20 (stage.power_kW = 900)"
  std::string folder{};  ///< of tables of its own, below OUT
  std::string place{};   ///< of the study's input in the scene: "scene.toml:40:1"; empty: not known
  /// Whether other motions are looked for (dynamics.starts): sweeps do, values by themselves; studies of thousands of
  /// points do not.
  bool other_motions = false;
};

/// The unit of a key path.
[[nodiscard]] std::string unit_of_input(const Scene& scene, const std::string& input);

/// One per value.
[[nodiscard]] std::vector<StudyCase> sweep_cases(const Scene& scene, std::size_t sweep);

/// Throws the error again as InputError "place: where: what", or "file: where: what", when it is one of the input;
/// others unchanged.
[[noreturn]] void rethrow_at(const Scene& scene, const std::string& where, const std::string& place = "");

/// The changed scene. Throws InputError naming the study and the value where it is not a good one.
[[nodiscard]] Scene change_scene(const Scene& scene, const StudyCase& study_case);

/// One per point of the grid, x fastest.
[[nodiscard]] std::vector<StudyCase> grid_cases(const Scene& scene, std::size_t grid);

/// One per class of the load spectrum.
[[nodiscard]] std::vector<StudyCase> load_cases(const Scene& scene);

/// The inputs of [sensitivity]: those listed, or the finite supports, damping ratios and backlash
/// (of a 2K-V stage: stiffnesses and inertias besides).
[[nodiscard]] std::vector<std::string> sensitivity_inputs(const Scene& scene);
/// Two per input: divided, multiplied.
[[nodiscard]] std::vector<StudyCase> sensitivity_cases(const Scene& scene);
/// The scene as it is, found in the way of the others.
[[nodiscard]] StudyCase nominal_case_of_sensitivity();

/// The cases of all sweeps, grids, the load spectrum and [sensitivity].
[[nodiscard]] std::vector<StudyCase> all_cases(const Scene& scene);

/// One random number of every sample.
struct RandomVariable {
  std::string input;  ///< key path
  dynamics::Distribution distribution;
};
/// What is drawn: the phases of errors that are there or drawn themselves, then the inputs of [[monte_carlo.input]].
struct Sampling {
  int samples = 0, seed = 0;
  std::vector<RandomVariable> variables{};
  bool by_default = false;  ///< nobody asked for it, but errors have phases that nobody stated
};
/// Phases of errors that are there, which the scene does not state or states as assumed.
[[nodiscard]] std::vector<std::string> unstated_phases(const Scene& scene);
/// As [monte_carlo] asks; without that table a few samples of the phases that the scene does not state, or states as
/// assumed. Absent: nothing is drawn.
[[nodiscard]] std::optional<Sampling> sampling_of(const Scene& scene);
/// Whether the objective of [optimise] needs the motion of the bodies: every design is then answered as a whole.
[[nodiscard]] bool asks_for_motion(const OptimiseInput& search, const std::vector<FigureSpec>& figures);
[[nodiscard]] double draw(const RandomVariable& variable, int seed, int sample);
[[nodiscard]] StudyCase sample_case(const std::vector<RandomVariable>& variables, int seed, int sample);

}  // namespace annulus::app
