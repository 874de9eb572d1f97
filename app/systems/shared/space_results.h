#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/plan/warning.h"
#include "app/report/section.h"
#include "core/csv.h"
#include "core/json.h"
#include "core/not_known.h"
#include "dynamics/spatial/space_motion.h"

/// What bearings and meshes of a system in space do over the evaluated window.
namespace annulus::app {

struct SpaceResults {
  /// Largest and mean forces (N) and moments (N m); not known where rigid.
  struct Bearing {
    std::string name;
    double radial_mean = not_known, radial_max = not_known, axial_mean = not_known, axial_max = not_known;
    double moment_max = not_known;
    double law_deviation = 0, table_end = 0;  ///< SpaceMotion::Bearing
  };
  /// A moment of a mesh: mesh cycles, N, m by which the end approaches further, m at which the force stands.
  struct FaceMoment {
    double cycles = 0, force = 0, tilt = 0, place = 0;
  };
  /// Place of the mesh force along the face, m from its middle.
  struct Mesh {
    std::string name;
    double place_mean = not_known, place_min = not_known, place_max = not_known;
    double face_width = not_known;  ///< m
    bool solid_face = false;
    /// Of the mesh cycle in which its mean force stands furthest from the middle; empty: none, or too few samples.
    std::vector<FaceMoment> moments{};
    [[nodiscard]] double furthest() const { return std::max(std::abs(place_min), std::abs(place_max)); }
  };
  /// The load along the face of a mesh over one mesh cycle (Mesh::moments).
  struct Face {
    std::string mesh;
    double factor = not_known, error = not_known;  ///< K_Hβ, of the mean load of the cycle
    double deviation = not_known;                  ///< largest (add_face_loads())
    std::vector<double> at{}, line_load{};         ///< m from the middle, N/m
  };
  std::vector<Bearing> bearings{};
  std::vector<Mesh> meshes{};
  std::vector<Face> faces{};  ///< those that were looked at
  Csv table{};                ///< per mesh cycle
};

/// `cycles`: mesh cycles of the window. Empty without bearings.
[[nodiscard]] SpaceResults space_results(const dynamics::SpaceMotion& motion, int cycles);
/// A bearing that bears more (N, radial) than the end of its table.
[[nodiscard]] Warning beyond_bearing_table(const std::string& bearing, double most, double end,
                                           const std::string& ring);
/// Bearings that bear more than the end of their table, that act with their tangents and deviate from their law by more
/// than `accuracy`; faces of solid gears that tilt further than the results of their tables know. `remedy`: where K_Hβ
/// of gears that tilt is found, or nothing.
[[nodiscard]] std::vector<Warning> space_result_warnings(const SpaceResults& results, double accuracy,
                                                         const std::string& ring, const std::string& remedy);
/// Members bearings_in_space and places_of_mesh_forces; none where there are no results.
void add_json(Json& json, const SpaceResults& results);
/// `of`: " of 'held'", or nothing.
[[nodiscard]] Blocks space_blocks(const SpaceResults& results, const std::string& of);

}  // namespace annulus::app
