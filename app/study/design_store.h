#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study_result.h"

namespace annulus::app {

/// The figures of a design and its steady motions from several initial conditions, kept in `folder` under the identity
/// of all they depend on: a search that is read back need not follow its best design again.
class DesignStore {
 public:
  DesignStore(std::filesystem::path folder, std::string id, const std::vector<FigureSpec>& figures)
      : folder_(std::move(folder)), id_(std::move(id)), figures_(figures) {}

  /// Nothing when it is not there or damaged.
  [[nodiscard]] std::optional<Design> find(const std::vector<double>& x) const;
  void save(const Design& design) const;

 private:
  [[nodiscard]] std::filesystem::path point_file() const { return folder_ / (id_ + ".json"); }
  [[nodiscard]] std::filesystem::path starts_file() const { return folder_ / (id_ + "_starts.csv"); }

  std::filesystem::path folder_;
  std::string id_;
  const std::vector<FigureSpec>& figures_;
};

}  // namespace annulus::app
