#pragma once

#include <filesystem>
#include <string>

#include "core/stiffness_table.h"

namespace annulus {

/// A stiffness table from a CSV that annulus or another program wrote. A file with the columns of the native table is
/// read as one (StiffnessTable::read_csv; its mesh has to be `mesh`). Any other one is recognised by the names of its
/// columns, which carry the unit:
///
///     mesh_phase, mesh_phase_deg or mesh_cycles     place within the mesh cycle; cycles may count beyond 1 (a ring
///     that
///                                                   repeats later), which then come in whole numbers
///     stiffness_N_per_m or stiffness_N_per_um       mean (secant) stiffness; or
///     lte_m or lte_um                               loaded transmission error, with load_N
///     load_N                                        optional with a stiffness; several loads make a law
///     unloaded_te_m or unloaded_te_um, error_relative                optional
///
/// Rows may come in any order and at any phases, four at least in each cycle; a row at the end of the period that
/// repeats the first is taken off. Phases that are not equidistant are resampled, at least 64 per mesh cycle, with the
/// local cubics of PeriodicCurve. A single load, or none, stands for a stiffness that does not depend on the load.
/// Tangents are those over the loads of the file. Throws InputError naming file, line and column.
[[nodiscard]] StiffnessTable import_table(const std::filesystem::path& file, const std::string& mesh);

}  // namespace annulus
