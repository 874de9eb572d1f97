#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "core/stiffness_table.h"

namespace annulus::app {

/// A named array of numbers as files of other programs hold it.
struct NamedArray {
  std::string name{};  ///< with its unit: "stiffness_secant_N_per_m"
  std::vector<std::size_t> shape{};
  std::vector<double> values{};     ///< the last index runs fastest
  std::vector<std::string> axes{};  ///< name of the array along each dimension; empty: none
};

struct NamedArrays {
  std::vector<std::pair<std::string, std::string>> provenance{};
  std::vector<NamedArray> arrays{};
};

/// "N/m" of "stiffness_N_per_m", "1" of "error_relative"; empty where the name tells no unit.
[[nodiscard]] std::string unit_of_name(const std::string& name);

/// Axes ring_angle_deg x mesh_phase x load_N, and the columns of the table over them.
[[nodiscard]] NamedArrays arrays_of(const StiffnessTable& table);
/// Every column by itself.
[[nodiscard]] NamedArrays arrays_of(const Csv& csv);

}  // namespace annulus::app
