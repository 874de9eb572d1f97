#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/model/lumped_model.h"
#include "app/scene/scene.h"
#include "core/csv.h"
#include "core/figure.h"
#include "core/not_known.h"
#include "dynamics/optimisation/optimise.h"
#include "dynamics/statistics/statistics.h"
#include "dynamics/transient/transient_figures.h"

/// What studies find: named figures of many responses to changed inputs, whatever the kind of the stage.
namespace annulus::app {

/// Branches of periodic motions over the input of a sweep.
struct SweepBranches {
  std::vector<dynamics::Branch> branches{};
  std::string failure{};  ///< empty: none
};

struct SweepResult {
  SweepInput sweep;
  std::string unit;                                  ///< of the input, for people
  std::vector<double> values;                        ///< in that unit
  int tables = 0;                                    ///< how many of the values needed stiffness tables of their own
  std::vector<std::vector<StudyPoint>> variants;     ///< [variant][value]; up where both directions are asked for
  std::vector<std::vector<StudyPoint>> downwards{};  ///< the same down; empty where not both are asked for
  std::vector<SweepBranches> branches{};             ///< by variant; empty where they are not asked for
};

/// Two inputs run through a grid.
struct GridResult {
  GridInput grid;
  std::string x_unit, y_unit;
  std::vector<double> x, y;
  int tables = 0;
  std::vector<std::vector<StudyPoint>> variants;  ///< [variant][y * x.size() + x]
};

/// Results of every class of a load spectrum.
struct LoadSpectrumResult {
  std::vector<std::string> inputs, units;
  std::vector<LoadClassInput> classes;
  int tables = 0;
  std::vector<std::vector<StudyPoint>> variants;  ///< [variant][class]

  /// Over all classes; not known where one failed.
  struct Overall {
    std::size_t of_class = 0;                      ///< that of the largest value
    double largest = not_known, mean = not_known;  ///< mean: over the time
  };
  [[nodiscard]] Overall overall(std::size_t variant, const std::string& figure) const;
  [[nodiscard]] double duration() const;  ///< s
};

/// What a variant does while speed and torque follow a course.
struct VariantCourse {
  dynamics::TransientResponse response{};
  FigureSet figures{};    ///< dynamics::transient_figures(), and those of each mesh and shaft
  std::string failure{};  ///< empty: none
};

struct TransientResult {
  TransientInput input;
  std::vector<VariantCourse> variants{};

  /// What a user must know of a variant.
  [[nodiscard]] std::vector<std::string> warnings(std::size_t variant) const;
};

struct FigureStatistics {
  std::string figure;       ///< its key
  dynamics::Interval mean;  ///< Student's interval
  double deviation = 0;
  dynamics::Interval q05, median, q95;  ///< intervals between order statistics
};

struct VariantSamples {
  Csv samples;  ///< sample, failed, inputs drawn, figures
  int failed = 0, not_steady = 0;
  std::vector<FigureStatistics> statistics;  ///< over the samples that did not fail

  /// nullptr: none.
  [[nodiscard]] const FigureStatistics* find(const std::string& figure) const {
    for (const auto& s : statistics)
      if (s.figure == figure) return &s;
    return nullptr;
  }
};

/// In what share of the samples variant a's figure lies above variant b's, both with the same draws.
struct PairedOrder {
  std::size_t a = 0, b = 0;
  std::string figure;
  long above = 0, equal = 0, samples = 0;  ///< samples: both succeeded
  dynamics::Interval share{};              ///< above / samples [ClopperPearson1934]
  dynamics::Interval difference{};         ///< mean of a's figure less b's, Student
};

struct MonteCarloResult {
  int samples = 0, seed = 0;
  bool by_default = false;            ///< see Sampling
  std::vector<std::string> inputs{};  ///< drawn
  std::vector<VariantSamples> variants{};
  std::vector<PairedOrder> orders{};
};

/// One input divided and multiplied by the factor.
struct SensitivityRow {
  std::string input, unit;
  std::vector<double> values;                   ///< nominal value by variant; NaN where it has none
  std::vector<StudyPoint> divided, multiplied;  ///< by variant
  bool order_stays = false;                     ///< the order of the variants by the ordering figure, both times
};

struct SensitivityResult {
  double factor = 0;
  std::vector<StudyPoint> nominal;  ///< by variant
  std::vector<SensitivityRow> rows;
};

/// One search by one optimiser.
struct OptimiseRun {
  std::string optimiser;
  int repeat = 0;
  dynamics::OptimiseResult search;  ///< its values are to be made small: negative where the goal is the largest
  int reused = 0;                   ///< evaluations answered from an earlier run
};

/// A design and its figures.
struct Design {
  std::vector<double> x;  ///< values of the variables, in the unit of the inputs
  double objective = 0;   ///< NaN when the response fails
  StudyPoint point{};
  std::optional<StartSpread> starts{};
};

struct OptimiseResults {
  OptimiseInput settings;
  std::vector<VariableInput> variables;
  std::vector<std::string> units{};  ///< of the variables
  std::size_t variant = 0;
  std::vector<OptimiseRun> runs{};
  std::size_t best_run = 0;
  Design given{}, best{};
  double numerical_error = 0;        ///< of the objective, where the scene's own results have one
  dynamics::ObjectiveRange range{};  ///< over all evaluations of all runs, of values to be made small
  /// Evaluations until the objective of the best run was met within 1 % of the gain (at least the numerical error), by
  /// run; absent: never.
  std::vector<std::optional<long>> evaluations_to_best{};
};

/// The result that orders the variants; nullptr when none does.
[[nodiscard]] inline const FigureSpec* ordering_figure(const std::vector<FigureSpec>& figures) {
  for (const auto& figure : figures)
    if (figure.ordering) return &figure;
  return nullptr;
}

/// How long a study took.
struct StudyTime {
  double seconds = 0;   ///< wall
  double computed = 1;  ///< share of its responses that were not reused
};

struct StudyResults {
  std::vector<std::string> variants;  ///< names; a single empty one for kinds without variants
  std::string variant_word;           ///< what these are: "ring"
  std::vector<FigureSpec> figures;
  std::vector<FigureSet> nominal{};  ///< by variant
  std::vector<SweepResult> sweeps{};
  std::vector<GridResult> grids{};
  std::optional<LoadSpectrumResult> load_spectrum{};
  std::vector<TransientResult> transients{};
  std::optional<MonteCarloResult> monte_carlo{};
  std::optional<SensitivityResult> sensitivity{};
  std::optional<OptimiseResults> optimise{};
  std::map<std::string, StudyTime> times{};  ///< by StudyPlan::name, of those that computed anything

  [[nodiscard]] const FigureSpec* ordering() const { return ordering_figure(figures); }
};

}  // namespace annulus::app
