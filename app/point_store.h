#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/changed_stage.h"
#include "app/study_result.h"

namespace annulus::app {

/// Finished points of sweeps and sensitivities in OUT/<ring>/dynamics/points, one file each, named by the identity of
/// all inputs: an interrupted study goes on where it stopped, and studies share the points they have in common.
class PointStore {
 public:
  explicit PointStore(const ChangedStages& stages) : stages_(stages) {}

  /// Kept, or found and kept. A response that fails is a point too, with its reason; wrong input throws.
  [[nodiscard]] StudyPoint point(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                                 const std::string& folder) const;

 private:
  const ChangedStages& stages_;
};

/// Evaluates a stage; errors of solver and input become the failure of the point.
[[nodiscard]] StudyPoint evaluate(const ChangedStage& changed, bool motion);

}  // namespace annulus::app
