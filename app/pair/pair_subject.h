#pragma once

#include <string>
#include <vector>

#include "app/pair/pair_run.h"
#include "app/study/study_subject.h"
#include "dynamics/systems/helical_pair/pair_response.h"

namespace annulus::app {

/// The figures a helical pair answers with.
[[nodiscard]] std::vector<StudyFigure> pair_figures();
/// Of one response, in that order. `frequencies`: Hz above zero, rising.
[[nodiscard]] std::vector<double> pair_figure_values(const dynamics::PairResponse& response,
                                                     const std::vector<double>& frequencies);
/// Natural frequencies above zero, rising, Hz.
[[nodiscard]] std::vector<double> pair_frequencies(const dynamics::HelicalPair& pair);

/// A helical pair, on the stiffness table of the nominal run where it serves and on others where not.
class PairSubject final : public StudySubject {
 public:
  PairSubject(const PairRunResult& nominal, const RunOptions& options) : nominal_(nominal), options_(options) {}

  [[nodiscard]] const Scene& scene() const override { return nominal_.scene; }
  [[nodiscard]] const RunOptions& options() const override { return options_; }
  [[nodiscard]] std::vector<std::string> variants() const override { return {""}; }
  [[nodiscard]] std::vector<StudyFigure> figures() const override { return pair_figures(); }
  [[nodiscard]] NominalFigures nominal(std::size_t variant) const override;
  bool prepare(const std::vector<Override>& overrides, const std::string& where,
               const std::string& folder) const override;
  [[nodiscard]] ChangedModel model(const std::vector<Override>& overrides, const std::string& where,
                                   std::size_t variant, const std::string& folder, bool with_id) const override;

 private:
  /// Whether the finite elements of the nominal run answer for the changed scene as well.
  [[nodiscard]] bool table_serves_pair(const MeshModel& changed, const PairGeometry& geometry) const;

  const PairRunResult& nominal_;
  const RunOptions& options_;
};

}  // namespace annulus::app
