#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/plan/mesh_model.h"
#include "app/report/drawings/deformed_mesh.h"
#include "core/bytes.h"
#include "core/csv.h"
#include "core/face_shape.h"
#include "core/file_set.h"
#include "core/pair_shares.h"
#include "core/stiffness_table.h"

namespace annulus::app {

struct SolvedCoupling;

/// A figure of merit with its estimated error, relative to the value.
struct Estimate {
  double value = 0;
  double error_relative = 0;
  ErrorParts parts{};  ///< of error_relative, where it is known what it is made of; else zero
};

/// Where in the mesh cycles something happens.
struct PositionKey {
  double mesh_phase = 0;
  int ring_tooth = 0;
};

/// The largest value (by magnitude, with its sign) of something over all positions at the nominal load.
struct Peak {
  double value = 0;
  PositionKey at;
};

/// What is known about one mesh after its solve.
struct MeshResult {
  MeshModel model;
  double contact_ratio = 0;
  StiffnessTable table;
  Csv positions{};  ///< lte_<mesh>.csv: every position and load, with tooth pair shares and invariants; may be empty
  // The others hold for the nominal load and are empty when there is nothing to tell (mesh_tables.h).
  Csv housing{};                       ///< housing_<mesh>.csv: where the rim touches a housing bore
  Csv rollers{};                       ///< rollers_<mesh>.csv: load of a planet's rollers around its bore
  Csv pins{};                          ///< pins_<mesh>.csv: states of pins, bolts or spline teeth
  Csv pressure{};                      ///< pressure_<mesh>.csv: pressure on the flanks
  Csv line_load{};                     ///< line_load_<mesh>.csv: load over the face width
  Csv stress{};                        ///< stress_<mesh>.csv: stress along roots and rim; its header names the curves
  Csv gauges{};                        ///< gauges_<mesh>.csv: strain gauges on the wheel, by this mesh alone
  std::string picture{};               ///< SVG of the meshes in contact; empty when none was meshed
  std::vector<DeformedMesh> fields{};  ///< deformation and stress of both bodies in mesh; in no file, may be empty
  FileSet bodies{};  ///< OUT/<variant>/mesh: .msh and .vtu of both bodies; empty once they are written
  /// Invariants and sizes by name: force_balance_relative, max_penetration_m, unknowns, mesh_seconds ...
  std::map<std::string, double> facts{};
  /// Ring meshes: how those of all planets act on each other through the ring; null when that was not looked at.
  std::shared_ptr<const SolvedCoupling> coupling{};
  /// Solid gears along their face, where the dynamics moves them in space; else null.
  std::shared_ptr<const FaceShape> face{};
  PairShares shares{};  ///< none of prescribed stiffnesses
  /// m/N at the phases of the table, at the nominal load, the mean over all ring positions: by which the other mesh of
  /// a planet on rollers deflects this one (fem::LoadedPosition::partner_compliance). Empty for planets on hubs.
  std::vector<double> partner_compliance{};
  std::size_t nominal = 0;  ///< index of the nominal load in the table
  /// Whether the lumped model reads the table; else the scene prescribes a stiffness, and the table shows it.
  bool tabulated = true;
  bool reused = false;

  [[nodiscard]] Estimate mean_stiffness() const;  ///< N/m, secant, at the nominal load
  [[nodiscard]] Estimate mean_tangent() const;    ///< N/m, of small vibrations about the nominal load: for modes
  /// Relative, of any position at the nominal load.
  [[nodiscard]] double worst_stiffness_error() const;
  [[nodiscard]] Estimate lte_mean() const;  ///< m, at the nominal load
  /// m, at the nominal load, over all ring positions; its error contains what lies between the positions.
  [[nodiscard]] Estimate lte_peak_to_peak() const;
  /// Largest less smallest secant stiffness over the mean one, in the same way.
  [[nodiscard]] Estimate stiffness_ripple() const;
  [[nodiscard]] double fact(const std::string& name) const;  ///< NaN when not known
  /// Pa: the largest over all positions at the nominal load of one of stress_columns, "root_tension". Nothing for a
  /// body without it.
  [[nodiscard]] std::optional<Estimate> largest_stress(const std::string& body, const std::string& kind) const;
  /// K_Hβ: the largest over all positions at the nominal load. Nothing where the face is not divided.
  [[nodiscard]] std::optional<Estimate> face_load_factor() const;
  /// Of a column of `positions`; nothing when there is no such column.
  [[nodiscard]] std::optional<Peak> peak(const std::string& column) const;

 private:
  /// The largest of a column of `positions` at the nominal load, with its error by `discretisation` (in its unit) and
  /// by what lies between the positions.
  [[nodiscard]] std::optional<Estimate> largest(const std::string& column, double discretisation) const;
};

/// The tables beside the positions, by the first part of their file names.
inline constexpr std::pair<const char*, Csv MeshResult::*> side_tables[] = {
    {"pins", &MeshResult::pins},         {"housing", &MeshResult::housing},     {"rollers", &MeshResult::rollers},
    {"pressure", &MeshResult::pressure}, {"line_load", &MeshResult::line_load}, {"stress", &MeshResult::stress},
    {"gauges", &MeshResult::gauges}};

/// What lumped models read of a mesh: without pictures and tables for people.
[[nodiscard]] MeshResult stiffness_alone(const MeshResult& mesh);

/// Leaves out how the solve went, which is another time another: seconds, and how many teeth were found in the cache.
void leave_out_course_of_solve(MeshResult& result);

/// Packs the finite-element result of a model into its tables and pictures.
[[nodiscard]] MeshResult pack(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// The stiffness a scene gives instead: a table read from its file, or the wave sampled over one cycle.
[[nodiscard]] MeshResult prescribed_stiffness(const MeshModel& model, const MeshInput& input, const Scene& scene,
                                              double contact_ratio, double nominal_load);

/// Writes lte_, stiffness_, pins_, ... <mesh>.csv, the picture and the bodies into `folder` (OUT/<variant>). What a
/// result does not have leaves no file behind.
void save(const MeshResult& result, const std::filesystem::path& folder);

}  // namespace annulus::app

namespace annulus {

ANNULUS_MEMBERS(PairShares, phases, first, share);

/// Without the model, the coupling, the face and how it was found, which its reader knows.
template <>
struct Members<app::MeshResult> {
  template <class Value>
  static auto of(Value& value) {
    auto& [model, contact_ratio, table, positions, housing, rollers, pins, pressure, line_load, stress, gauges, picture,
           fields, bodies, facts, coupling, face, shares, partner_compliance, nominal, tabulated, reused] = value;
    return std::tie(contact_ratio, table, positions, housing, rollers, pins, pressure, line_load, stress, gauges,
                    picture, fields, bodies, facts, shares, partner_compliance, nominal, tabulated);
  }
};

}  // namespace annulus
