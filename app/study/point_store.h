#pragma once

#include <string>
#include <vector>

#include "app/study/study_subject.h"
#include "core/json.h"

namespace annulus::app {

/// Finished points of studies in the cache, by the identity of all inputs: an interrupted study goes on where it
/// stopped, and studies share the points they have in common.
class PointStore {
 public:
  explicit PointStore(const StudySubject& subject) : subject_(subject), figures_(subject.figures()) {}

  /// Cached, or found and cached. A response that fails is a point too, with its reason; wrong input throws.
  [[nodiscard]] StudyPoint point(const std::vector<Override>& overrides, const std::string& where, std::size_t variant,
                                 const std::string& folder) const;

 private:
  const StudySubject& subject_;
  const std::vector<FigureSpec>& figures_;
};

/// A point as JSON, and read back. The declarations are referred to by the point.
[[nodiscard]] Json point_json(const StudyPoint& point, const std::vector<FigureSpec>& figures);
[[nodiscard]] StudyPoint point_of(const Json& json, const std::vector<FigureSpec>& figures);

}  // namespace annulus::app
