#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "app/model/study_result.h"
#include "core/csv.h"

namespace annulus {
class ResultStore;
}

namespace annulus::app {

/// The evaluations of one search, cached together as they come: an interrupted search is repeated with the answers it
/// already had. Values of variables are compared to the last bit.
class EvaluationStore {
 public:
  /// Reads what an earlier run with this identity cached; `variables` name the first columns, keys of results among
  /// `specs` the others. `store` may be null.
  EvaluationStore(const ResultStore* store, std::string id, std::vector<std::string> variables,
                  std::vector<std::string> figures, const std::vector<FigureSpec>& specs);

  /// nullptr: not known.
  [[nodiscard]] const StudyPoint* find(const std::vector<double>& x) const;
  /// Saves now and then.
  void add(const std::vector<double>& x, StudyPoint point);
  void save();
  /// A row per evaluation: variables, failed (0 or 1), results; reasons of failures in front.
  [[nodiscard]] Csv table() const;
  [[nodiscard]] int kept() const { return kept_; }  ///< evaluations of earlier runs

 private:
  void read();

  const ResultStore* store_;
  std::string id_;
  std::vector<std::string> variables_, figures_;
  const std::vector<FigureSpec>& specs_;
  std::vector<std::vector<double>> order_;  ///< as they came
  std::map<std::vector<double>, StudyPoint> points_;
  int kept_ = 0;
  bool changed_ = false;
  std::chrono::steady_clock::time_point saved_;
};

}  // namespace annulus::app
