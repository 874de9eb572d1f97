#include "app/export/named_arrays.h"

#include <fmt/format.h>

#include "core/units.h"

namespace annulus::app {

std::string unit_of_name(const std::string& name) {
  // Those that end like others stand before them.
  static constexpr std::pair<const char*, const char*> endings[] = {{"_N_s_per_m", "N s/m"},
                                                                    {"_N_per_m", "N/m"},
                                                                    {"_m_per_N", "m/N"},
                                                                    {"_m_per_s2", "m/s2"},
                                                                    {"_m_per_s", "m/s"},
                                                                    {"_N_per_mm", "N/mm"},
                                                                    {"_N_per_um", "N/um"},
                                                                    {"_Nm_per_rad", "N m/rad"},
                                                                    {"_per_sqrt_kg", ""},
                                                                    {"_kg_m2", "kg m2"},
                                                                    {"_N_m", "N m"},
                                                                    {"_deg", "deg"},
                                                                    {"_rad", "rad"},
                                                                    {"_MPa", "MPa"},
                                                                    {"_Pa", "Pa"},
                                                                    {"_Hz", "Hz"},
                                                                    {"_rpm", "r/min"},
                                                                    {"_um", "um"},
                                                                    {"_mm", "mm"},
                                                                    {"_kg", "kg"},
                                                                    {"_J", "J"},
                                                                    {"_W", "W"},
                                                                    {"_N", "N"},
                                                                    {"_m", "m"},
                                                                    {"_s", "s"},
                                                                    {"_relative", "1"}};
  for (const auto& [ending, unit] : endings)
    if (name.ends_with(ending)) return unit;
  return {};
}

NamedArrays arrays_of(const StiffnessTable& table) {
  const auto positions = static_cast<std::size_t>(table.positions()), phases = static_cast<std::size_t>(table.phases()),
             loads = table.loads().size();
  NamedArrays all;
  all.provenance = {{"mesh", table.mesh()}};
  all.provenance.insert(all.provenance.end(), table.provenance.begin(), table.provenance.end());
  NamedArray angle{"ring_angle_deg", {positions}, {}, {}}, phase{"mesh_phase", {phases}, {}, {}};
  for (const double a : table.ring_angles()) angle.values.push_back(a / units::deg);
  for (std::size_t i = 0; i < phases; ++i) phase.values.push_back(static_cast<double>(i) / static_cast<double>(phases));
  all.arrays = {std::move(angle), std::move(phase), {"load_N", {loads}, table.loads(), {}}};

  const auto add = [&](const std::string& name, auto value) {
    NamedArray array{name, {positions, phases, loads}, {}, {"ring_angle_deg", "mesh_phase", "load_N"}};
    array.values.reserve(positions * phases * loads);
    for (int r = 0; r < table.positions(); ++r)
      for (int p = 0; p < table.phases(); ++p)
        for (std::size_t l = 0; l < loads; ++l) array.values.push_back(value(table.at(r, p, static_cast<int>(l))));
    all.arrays.push_back(std::move(array));
  };
  for (const auto& column : table_columns) add(column.name, [&](const StiffnessEntry& e) { return e.*column.value; });
  add("error_relative", [](const StiffnessEntry& e) { return e.error_relative; });
  for (const auto& [name, part] : stiffness_error_part_names)
    add(fmt::format("error_{}_relative", name),
        [member = part](const StiffnessEntry& e) { return e.error_parts.*member; });
  return all;
}

NamedArrays arrays_of(const Csv& csv) {
  NamedArrays all{csv.header, {}};
  for (std::size_t c = 0; c < csv.columns.size(); ++c) {
    NamedArray array{csv.columns[c], {csv.rows.size()}, {}, {}};
    array.values.reserve(csv.rows.size());
    for (const auto& row : csv.rows) array.values.push_back(row[c]);
    all.arrays.push_back(std::move(array));
  }
  return all;
}

}  // namespace annulus::app
