#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <vector>

namespace annulus::geometry {

/// What a flank differs by from its involute, over the radius: material removed normal to the flank, m. Between the
/// given radii by local cubics ([Akima1970], modified); beyond them the end value holds. Without values it is 0.
class FlankCurve {
 public:
  FlankCurve() = default;
  /// Four radii (m) at least, rising.
  FlankCurve(const std::vector<double>& radii, std::vector<double> values);
  [[nodiscard]] double operator()(double radius) const;
  explicit operator bool() const { return curve_ != nullptr; }

 private:
  struct Cubics;
  std::shared_ptr<const Cubics> curve_;
  double low_ = 0, high_ = 0;
};

/// The measured flanks of one side of the teeth of a gear, all teeth alike, on a grid of radii and positions along the
/// face.
class FlankTopography {
 public:
  /// `radii`: m, four at least, rising. `positions`: m, from the middle of the gear's face towards +z, one or at least
  /// four, rising. `removed`: m, radii x positions, material removed normal to the flank; negative where some is left
  /// over. Throws GeometryError for others, and for values that are not finite.
  FlankTopography(std::vector<double> radii, std::vector<double> positions, Eigen::MatrixXd removed);

  [[nodiscard]] const std::vector<double>& radii() const { return radii_; }          ///< m
  [[nodiscard]] const std::vector<double>& positions() const { return positions_; }  ///< m
  [[nodiscard]] const Eigen::MatrixXd& removed() const { return removed_; }          ///< m
  [[nodiscard]] bool varies_along_face() const;

  struct Slice {
    FlankCurve mean;
    /// At `slice_places` equally spaced positions from its low end to its high one; none where they are equal.
    std::vector<FlankCurve> across{};
  };
  static constexpr int slice_places = 9;
  /// Between two positions (m, from the middle of the gear's face), by local cubics too.
  [[nodiscard]] Slice slice(double low, double high) const;

 private:
  std::vector<double> radii_, positions_;
  Eigen::MatrixXd removed_;
};

/// A topography from a CSV with one row for every point of the grid, in any order: diameter_mm, position_mm (from the
/// middle of the gear's face, towards +z), removed_um. Throws InputError naming file and line, and what the grid lacks.
[[nodiscard]] FlankTopography read_flank_topography(const std::filesystem::path& file);

}  // namespace annulus::geometry
