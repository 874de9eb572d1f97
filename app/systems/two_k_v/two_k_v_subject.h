#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/study_subject.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_motion.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"

namespace annulus::app {

/// A 2K-V stage, on the table of the nominal sun mesh where it serves and on another where not. One variant, without a
/// name.
class TwoKVSubject final : public StudySubject {
 public:
  TwoKVSubject(const Scene& scene, const TwoKVTables& nominal, const TwoKVMotion* motion, const RunOptions& options)
      : scene_(scene), nominal_(nominal), motion_(motion), options_(options) {}

  [[nodiscard]] const Scene& scene() const override { return scene_; }
  [[nodiscard]] const RunOptions& options() const override { return options_; }
  [[nodiscard]] std::vector<std::string> variants() const override { return {""}; }
  [[nodiscard]] const std::vector<FigureSpec>& figures() const override { return dynamics::two_k_v_figures(); }
  [[nodiscard]] FigureSet nominal(std::size_t variant) const override;
  bool prepare(const std::vector<Override>& overrides, const std::string& where,
               const std::string& folder) const override;
  [[nodiscard]] ChangedModel model(const std::vector<Override>& overrides, const std::string& where,
                                   std::size_t variant, const std::string& folder, bool with_id) const override;

 private:
  const Scene& scene_;
  const TwoKVTables& nominal_;
  const TwoKVMotion* motion_;
  const RunOptions& options_;
};

}  // namespace annulus::app
