#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/figure.h"
#include "core/json.h"
#include "dynamics/systems/planetary/sharing_tolerances.h"

/// [tolerances]: K_γ of many assemblies of a stage.
namespace annulus::app {

struct RunOptions;

/// The quantiles that are shown.
struct SharingQuantile {
  const char *key, *symbol, *share;  ///< "p95", "P95", "95 %"
  dynamics::Interval dynamics::SharingQuantiles::*interval;
};
[[nodiscard]] const std::vector<SharingQuantile>& sharing_quantiles();

/// The zones of one ring's stage: radii are half the runouts and half the diameter of the pin position zone. Throws
/// GeometryError for gears that [ISO1328-1] does not cover.
[[nodiscard]] dynamics::StageTolerances stage_tolerances(const Scene& scene, const GearGeometry& geometry,
                                                         std::size_t ring);

struct ToleranceSharing {
  dynamics::AssemblySharing sharing;
  /// Of K_γ - 1, relative: forces that errors cause are at most proportional to the mesh stiffness.
  double stiffness_error = 0;

  /// A quantile at one torque, with its numerical error and half the interval of the finite number of draws.
  [[nodiscard]] Figure figure(dynamics::Interval dynamics::SharingQuantiles::*quantile, std::size_t torque) const;
};
/// From the cache if unchanged, else computed on all threads; nothing without [tolerances]. Writes
/// tolerance_sharing.csv, tolerance_contributions.csv and assemblies.csv into OUT/<ring>/dynamics.
[[nodiscard]] std::optional<ToleranceSharing> tolerance_sharing(const Scene& scene, const GearGeometry& geometry,
                                                                std::size_t ring, const dynamics::PlanetaryStage& stage,
                                                                const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                                                const RunOptions& options);

/// Rough time, s, on one core.
[[nodiscard]] double tolerance_seconds(const Scene& scene);

/// What it adds to the results of a stage: K_γ of the assemblies at the stage's torque.
[[nodiscard]] const std::vector<FigureSpec>& tolerance_figures();
[[nodiscard]] FigureSet figures(const ToleranceSharing& sharing);
[[nodiscard]] Json to_json(const ToleranceSharing& sharing);
/// Forces beyond the tables.
[[nodiscard]] std::vector<Warning> tolerance_warnings(const ToleranceSharing& sharing,
                                                      const std::vector<const MeshResult*>& tables,
                                                      const std::string& ring);

/// "planet pins within ⌀ 20 µm", "runout of the sun 37 µm".
[[nodiscard]] std::string tolerance_text(const dynamics::AssemblySharing::Contribution& contribution);

/// Load-sharing factors that standards tabulate for rigid rings, by the number of planets.
struct TabulatedSharing {
  int planets = 0;
  double low = 0, high = 0;
};
[[nodiscard]] std::string text(const TabulatedSharing& tabulated);  ///< "1.2 to 1.25"
/// Nothing for a number of planets without one.
[[nodiscard]] std::optional<TabulatedSharing> tabulated_sharing(int planets);

}  // namespace annulus::app
