#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/systems/helical_pair/pair_model.h"
#include "dynamics/system/mesh_excitation.h"

/// Where the stiffness of a helical pair's mesh comes from.
///
/// Tables (finite elements, closed form, file) hold forces and transmission errors along the transverse line of action,
/// as all tables of annulus do; the lumped model and every prescribed stiffness those along the normal of the flanks.
namespace annulus::app {

/// The mesh as a solid finite-element model, or "prescribed" where something else is asked for.
[[nodiscard]] MeshModel pair_mesh_model(const Scene& scene, const PairGeometry& geometry);
/// Why the plane and closed-form models cannot represent it; empty when they can.
[[nodiscard]] std::string pair_solid_reason(const Scene& scene, const PairGeometry& geometry);

/// N/m along the normal [ISO6336-1, method B].
[[nodiscard]] double iso_pair_stiffness(const Scene& scene, const PairGeometry& geometry);

/// Why there is no closed form of this pair; empty when there is.
[[nodiscard]] std::string no_closed_form(const Scene& scene, const PairGeometry& geometry);
/// fem::helical_closed_form, with loads around `transverse_force` as in every table. Throws InputError where there is
/// none.
[[nodiscard]] StiffnessTable closed_form_pair_table(const Scene& scene, const PairGeometry& geometry,
                                                    double transverse_force);

/// The stiffness that the scene asks for: finite elements solved into OUT or read back, the closed form, or a table
/// from its file; without a table where a wave or ISO 6336 is prescribed. Throws InputError for a table that cannot be
/// read.
[[nodiscard]] MeshResult pair_stiffness(const Scene& scene, const PairGeometry& geometry, const MeshModel& model,
                                        const RunOptions& options);
/// As the lumped model takes it. Needs [dynamics].
[[nodiscard]] dynamics::MeshExcitation pair_excitation(const Scene& scene, const PairGeometry& geometry,
                                                       const StiffnessTable& table);

/// The same for summary and report.
struct PairMesh {
  explicit PairMesh(const MeshResult& mesh);

  MeshModel model;
  std::optional<MeshResult> computed{};   ///< by finite elements
  std::optional<StiffnessTable> table{};  ///< transverse; of computed, closed_form and table
};

/// A mean stiffness at the operating point, N/m along the normal.
struct MeanStiffness {
  std::string source;         ///< "iso_6336", "closed_form", "computed", "prescribed"
  double value = 0;           ///< NaN: not available
  double error_relative = 0;  ///< NaN: not controlled
  std::string note;           ///< what it is, or why it is not available
  bool taken = false;         ///< by the lumped model
};
/// ISO formula, closed form and finite elements beside each other, and what the scene gives instead if it does.
[[nodiscard]] std::vector<MeanStiffness> mean_stiffnesses(const Scene& scene, const PairGeometry& geometry,
                                                          const PairMesh& mesh);

}  // namespace annulus::app
