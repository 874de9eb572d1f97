#pragma once

#include <string>
#include <vector>

#include "app/study/study_subject.h"
#include "app/systems/helical_pair/pair_run.h"
#include "dynamics/systems/helical_pair/pair_figures.h"

namespace annulus::app {

/// A helical pair, on the stiffness table of the nominal run where it serves and on others where not.
class PairSubject final : public StudySubject {
 public:
  PairSubject(const PairRunResult& nominal, const RunOptions& options) : nominal_(nominal), options_(options) {}

  [[nodiscard]] const Scene& scene() const override { return nominal_.scene; }
  [[nodiscard]] const RunOptions& options() const override { return options_; }
  [[nodiscard]] std::vector<std::string> variants() const override { return {""}; }
  [[nodiscard]] const std::vector<FigureSpec>& figures() const override { return dynamics::pair_figures(); }
  [[nodiscard]] FigureSet nominal(std::size_t variant) const override;
  bool prepare(const std::vector<Override>& overrides, const std::string& where,
               const std::string& folder) const override;
  [[nodiscard]] ChangedModel model(const std::vector<Override>& overrides, const std::string& where,
                                   std::size_t variant, const std::string& folder, bool with_id) const override;

 private:
  const PairRunResult& nominal_;
  const RunOptions& options_;
};

}  // namespace annulus::app
