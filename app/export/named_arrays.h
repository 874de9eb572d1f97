#pragma once

#include <array>
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
  std::string scene{};  ///< text of the scene file that they belong to; empty: not known
};

/// A quantity of a stiffness table as other programs take it.
struct TableColumn {
  const char *name, *unit, *what;
  double StiffnessEntry::*value;
};
inline constexpr std::array<TableColumn, 4> table_columns = {
    {{"unloaded_te_m", "m", "unloaded transmission error", &StiffnessEntry::unloaded_te},
     {"lte_m", "m", "loaded transmission error", &StiffnessEntry::lte},
     {"stiffness_secant_N_per_m", "N/m", "force over deflection", &StiffnessEntry::stiffness_secant},
     {"stiffness_tangent_N_per_m", "N/m", "derivative of the force by the deflection",
      &StiffnessEntry::stiffness_tangent}}};

/// "N/m" of "stiffness_N_per_m", "1" of "error_relative"; empty where the name states no unit.
[[nodiscard]] std::string unit_of_name(const std::string& name);

/// Axes ring_angle_deg x mesh_phase x load_N, and the columns of the table over them.
[[nodiscard]] NamedArrays arrays_of(const StiffnessTable& table);
/// Every column by itself.
[[nodiscard]] NamedArrays arrays_of(const Csv& csv);

/// Files of arrays. Each appears whole or not at all; both throw InputError naming the file.
/// HDF5: a dataset per array with its `units`, dimensions labelled and attached to their axes (dimension scales); what
/// is known of the origin as attributes of the file, and the scene as a text `scene`.
void write_hdf5(const std::filesystem::path& file, const NamedArrays& arrays);
/// MATLAB, version 5 (what MATLAB, Octave and SciPy read): a variable per array, indexed in the order of its axes, and
/// a struct `provenance`.
void write_matlab(const std::filesystem::path& file, const NamedArrays& arrays);

}  // namespace annulus::app
