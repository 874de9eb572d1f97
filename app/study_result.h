#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/scene.h"
#include "core/csv.h"
#include "dynamics/statistics.h"
#include "dynamics/study_point.h"

/// What studies find: the figures of many responses to changed inputs.
namespace annulus::app {

/// One response, or why there is none.
struct StudyPoint {
  dynamics::PointFigures figures;
  std::string failure{};  ///< empty: none
};

/// The figures of a point as columns of a table, with and without those of the motion.
[[nodiscard]] std::vector<std::string> figure_columns(bool motion);
/// In the same order; NaN throughout for a point that failed.
[[nodiscard]] std::vector<double> figure_row(const StudyPoint& point, bool motion);

struct SweepResult {
  SweepInput sweep;
  std::string unit;                            ///< of the input, for people
  std::vector<double> values;                  ///< in that unit
  int tables = 0;                              ///< how many of the values needed stiffness tables of their own
  std::vector<std::vector<StudyPoint>> rings;  ///< [ring][value]
};

struct FigureStatistics {
  std::string figure;       ///< column of the samples
  dynamics::Interval mean;  ///< Student's interval
  double deviation = 0;
  dynamics::Interval q05, median, q95;  ///< intervals between order statistics
};

struct MonteCarloRing {
  Csv samples;  ///< sample, failed, inputs drawn, figures
  int failed = 0, not_steady = 0;
  std::vector<FigureStatistics> statistics;  ///< over the samples that did not fail

  [[nodiscard]] const FigureStatistics* find(const std::string& figure) const;  ///< nullptr: none
};

/// In what share of the samples ring a's figure lies above ring b's, both with the same draws.
struct PairedOrder {
  std::size_t a = 0, b = 0;
  std::string figure;
  long above = 0, equal = 0, samples = 0;  ///< samples: both rings succeeded
  dynamics::Interval share{};              ///< above / samples, Clopper and Pearson
  dynamics::Interval difference{};         ///< mean of a's figure less b's, Student
};

struct MonteCarloResult {
  int samples = 0, seed = 0;
  std::vector<std::string> inputs{};  ///< drawn
  std::vector<MonteCarloRing> rings{};
  std::vector<PairedOrder> orders{};
};

/// One input divided and multiplied by the factor.
struct SensitivityRow {
  std::string input, unit;
  std::vector<double> values;                   ///< nominal value by ring; NaN where the ring has none
  std::vector<StudyPoint> divided, multiplied;  ///< by ring
  bool order_stays = false;  ///< the order of the rings by averaged load sharing of the sun meshes, both times
};

struct SensitivityResult {
  double factor = 0;
  std::vector<StudyPoint> nominal;  ///< by ring
  std::vector<SensitivityRow> rows;
};

struct StudyResults {
  std::vector<SweepResult> sweeps;
  std::optional<MonteCarloResult> monte_carlo;
  std::optional<SensitivityResult> sensitivity;
};

/// The figure that orders the rings, as in the paper: load sharing of the sun meshes, averaged over a mesh cycle.
inline constexpr const char* ordering_figure = "sun_planet_load_sharing_averaged";

}  // namespace annulus::app
