#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "app/model/study_cases.h"
#include "app/study/study_subject.h"
#include "core/csv.h"
#include "core/json.h"

/// Points of studies: evaluated, cached and as tables.
namespace annulus::app {

/// What `respond` returns; an error of solver or input becomes the failure of the point, on one line.
[[nodiscard]] StudyPoint attempted(const std::function<StudyPoint()>& respond);

/// Points of a list of changed scenes: [variant][case]. Tables are solved first, one after the other with all threads;
/// then the responses, in parallel. A table that cannot be solved fails its points.
struct CasePoints {
  std::vector<std::vector<StudyPoint>> variants;
  int tables = 0;  ///< cases that needed tables of their own
};
[[nodiscard]] CasePoints run_cases(const StudySubject& subject, const std::vector<StudyCase>& cases,
                                   const std::string& label);
/// ", ring 'pinned'"; empty for kinds without variants.
[[nodiscard]] std::string variant_words(const StudySubject& subject, std::size_t variant);
/// Logs the points that failed, and returns their number.
std::size_t warn_of_failures(const StudySubject& subject, const std::vector<StudyCase>& cases,
                             const CasePoints& points);

/// A point and a design as JSON, and read back. The declarations are referred to by the point.
[[nodiscard]] Json to_json(const StudyPoint& point, const std::vector<FigureSpec>& figures);
[[nodiscard]] StudyPoint study_point_of(const Json& json, const std::vector<FigureSpec>& figures);
[[nodiscard]] Json to_json(const Design& design, const std::vector<FigureSpec>& figures);
[[nodiscard]] Design design_of(const Json& json, const std::vector<double>& x, const std::vector<FigureSpec>& figures);

/// What is cached under this identity, else what `make` returns. It counts as a response of the studies.
[[nodiscard]] Json cached_response(const RunOptions& options, const std::string& kind, const std::string& id,
                                   const std::function<Json()>& make);

/// A table of points: inputs, failed (0 or 1), results; reasons of failures in front.
struct PointColumns {
  std::vector<std::pair<std::string, std::string>> header{};  ///< the version of annulus is added
  std::vector<std::string> inputs{}, results{};               ///< results: their keys

  [[nodiscard]] Csv empty_table() const;
  /// Appends a point; `number`: of the point in the whole study, from 1.
  void add(Csv& csv, std::size_t number, const std::vector<double>& inputs, const StudyPoint& point) const;
};

/// Points by the values of their inputs, which are compared to the last bit, cached together as they come: what was
/// interrupted is repeated with the answers that were there already. Of several workers each caches its own points, and
/// reads those of all. Any number of threads at once.
class PointTable {
 public:
  /// Together: other workers compute points of the same table now. What they have found is looked for before a point is
  /// made, and what is found here is cached at once.
  enum class Work { alone, together };

  /// Reads what an earlier run with this identity cached. `store` may be null.
  PointTable(const ResultStore* store, const char* kind, std::string id, PointColumns columns,
             const std::vector<FigureSpec>& specs, Work work = Work::alone);

  /// The point, known or made. Saves now and then.
  const StudyPoint& point(const std::vector<double>& inputs, const std::function<StudyPoint()>& make);
  void save();
  /// Leaves these points alone, in this order: an earlier run may have cached others.
  void restrict_to(const std::vector<std::vector<double>>& inputs) { order_ = inputs; }
  [[nodiscard]] Csv table() const;
  [[nodiscard]] int reused() const { return reused_; }  ///< points that were asked for and had been cached

 private:
  void read_others();
  void add(const Csv& csv);
  [[nodiscard]] const StudyPoint* find(const std::vector<double>& inputs);
  void save_locked();
  [[nodiscard]] Csv table_of(const std::vector<std::vector<double>>& list) const;

  const ResultStore* store_;
  const char* kind_;
  std::string id_;
  PointColumns columns_;
  const std::vector<FigureSpec>& specs_;
  Work work_;
  std::vector<std::vector<double>> order_{};  ///< as they came
  std::vector<std::vector<double>> own_{};    ///< those cached here
  std::map<std::vector<double>, StudyPoint> points_{};
  std::set<std::vector<double>> unasked_{};  ///< cached by earlier runs or others, not yet asked for
  int reused_ = 0;
  bool changed_ = false;
  std::mutex lock_{};
  std::chrono::steady_clock::time_point next_save_{}, next_read_{};
};

}  // namespace annulus::app
