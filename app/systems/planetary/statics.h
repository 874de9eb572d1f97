#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/model/run_options.h"
#include "app/plan/warning.h"
#include "app/report/section.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/figure.h"
#include "core/json.h"
#include "dynamics/systems/planetary/stage_statics.h"

/// annulus statics: a planetary stage in equilibrium over a turn of the carrier.
namespace annulus::app {

/// A bearing over the turn: largest values with their errors, SI.
struct BearingStatics {
  std::string name, body;
  Figure radial{}, axial{}, moment{};
  std::optional<Figure> element{};  ///< N, the most loaded roller or ball
  double mean_radial = 0;           ///< N
};

struct RingStatics {
  std::string ring;
  dynamics::StaticTurn turn;  ///< as the scene counts, not its mirror image
  FigureSet figures;
  std::vector<BearingStatics> bearings;
  std::vector<Figure> tilt{};        ///< rad, largest of every body
  std::vector<std::string> reasons;  ///< for degrees of freedom in space; empty: plane
  int period = 1;                    ///< mesh cycles after which the forces repeat, but for their change within a cycle
  double mean_mesh_force = 0;        ///< N, in the transverse section
  double worst_residual = 0;         ///< relative
  std::vector<Warning> warnings;
};

struct StageStatics {
  const Scene& scene;
  std::vector<RingStatics> rings;
};

/// Stiffness tables first where meshes are computed. Throws what solving throws, with its place in the scene.
[[nodiscard]] StageStatics solve_statics(const Scene& scene, const GearGeometry& geometry, const RunOptions& options);

/// OUT/statics/<ring>/*.csv, statics.json, statics.html with its pictures.
void write_statics(const StageStatics& statics, const RunOptions& options);
[[nodiscard]] std::string statics_text(const StageStatics& statics);
[[nodiscard]] Json statics_json(const StageStatics& statics);
[[nodiscard]] Page statics_page(const StageStatics& statics, const RunOptions& options);

}  // namespace annulus::app
