#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study_subject.h"

namespace annulus::app {

/// Finished points of studies in OUT/<variant>/dynamics/points, one file each, named by the identity of all inputs: an
/// interrupted study goes on where it stopped, and studies share the points they have in common.
class PointStore {
 public:
  explicit PointStore(const StudySubject& subject) : subject_(subject), figures_(subject.figures()) {}

  /// Kept, or found and kept. A response that fails is a point too, with its reason; wrong input throws.
  [[nodiscard]] StudyPoint point(const std::vector<Override>& overrides, const std::string& where, std::size_t variant,
                                 const std::string& folder) const;

 private:
  const StudySubject& subject_;
  const std::vector<FigureSpec>& figures_;
};

/// A point as a file of this identity, and read back from one: nothing when there is none, or another, or a damaged
/// one. The declarations are referred to by the point.
[[nodiscard]] std::string point_text(const StudyPoint& point, const std::vector<FigureSpec>& figures,
                                     const std::string& id);
[[nodiscard]] std::optional<StudyPoint> read_point(const std::filesystem::path& file,
                                                   const std::vector<FigureSpec>& figures, const std::string& id);

}  // namespace annulus::app
