#pragma once

#include <string>

#include "core/stiffness_table.h"

/// A stiffness table as text of programs for multibody systems: transmission errors and stiffnesses over
/// `mesh_cycles`, the number of mesh cycles passed (ring position + mesh phase), closed over the whole period, and over
/// the load.
namespace annulus::app {

/// Modelica text tables for CombiTable1D and CombiTable2D (Modelica Standard Library): matrices `<quantity>` over
/// mesh_cycles x load_N, and `curves_<i>` with all quantities over mesh_cycles at the i-th load.
[[nodiscard]] std::string modelica_text(const StiffnessTable& table);

/// Four statements of an Adams dataset (Adams Solver), SPLINE/`base_id` and those that follow, for CUBSPL or AKISPL: x
/// mesh_cycles, z load_N.
[[nodiscard]] std::string adams_text(const StiffnessTable& table, int base_id);

/// A set of input functions z(x, y) of Simpack: x mesh_cycles, y load_N. Its layout follows a published header; Simpack
/// itself has not read it.
[[nodiscard]] std::string simpack_text(const StiffnessTable& table);

}  // namespace annulus::app
