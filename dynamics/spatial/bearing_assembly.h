#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/spatial/mechanism.h"
#include "dynamics/spatial/stage_bearing.h"

namespace annulus::dynamics {

/// A bearing in a mechanism, or the support that a body without one has.
struct MadeBearing : StageBearing {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of its frame, as columns
  /// x, y, z, about x, about y: the element and coordinate that resists it, or the hold; -1: nothing.
  std::array<int, 5> element{-1, -1, -1, -1, -1}, coordinate{}, held{-1, -1, -1, -1, -1};
  std::shared_ptr<const RollingRowLaw> rolling{};  ///< of its first element; null: it has no rolling elements
};

/// Where a bearing stands: numbers of its bodies in a mechanism, the middle of what it holds, axes of its frame
/// (columns).
struct BearingPlace {
  int body = 0, on = Mechanism::ground;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// Adds bearings to a mechanism.
class BearingAssembly {
 public:
  BearingAssembly(Mechanism& mechanism, Motions motions) : mechanism_(mechanism), motions_(motions) {}

  [[nodiscard]] MadeBearing add(const StageBearing& bearing, const BearingPlace& place);
  /// x, y, z, about x, about y of a bearing: 0 ... 4.
  [[nodiscard]] Mechanism::Measure measure(const StageBearing& bearing, const BearingPlace& place,
                                           int coordinate) const;
  /// Per hold of the mechanism: bearings that hold the same. They are its first holds.
  [[nodiscard]] const std::vector<int>& shared() const { return shared_; }

 private:
  void add_part(MadeBearing& made, const StageBearing& bearing, const BearingPlace& place, const BearingPart& part);
  void hold(MadeBearing& made, const StageBearing& bearing, const BearingPlace& place, int coordinate);

  Mechanism& mechanism_;
  Motions motions_;
  std::vector<Mechanism::Measure> holds_;
  std::vector<int> shared_;
};

}  // namespace annulus::dynamics
