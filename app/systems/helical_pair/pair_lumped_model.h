#pragma once

#include <memory>
#include <string>

#include "app/model/lumped_model.h"
#include "app/systems/helical_pair/pair_stiffness.h"
#include "dynamics/systems/helical_pair/pair_figures.h"

namespace annulus::app {

/// The pair of a scene, which is referred to, on a stiffness.
struct LumpedPair {
  const Scene& scene;
  PairGeometry geometry;
  MeshResult mesh;        ///< stiffness_alone
  double mesh_error = 0;  ///< m, amplitude at mesh frequency
  dynamics::HelicalPair pair;

  /// Identity of everything a response with these options depends on.
  [[nodiscard]] std::string id(const dynamics::SimulationOptions& options) const;
};
/// Needs [dynamics].
[[nodiscard]] LumpedPair lumped_pair(const Scene& scene, const PairGeometry& geometry, const MeshResult& mesh,
                                     double mesh_error);

/// As studies ask it.
[[nodiscard]] std::unique_ptr<LumpedModel> pair_lumped_model(const LumpedPair& lumped);

/// The ways of the cost study to it.
[[nodiscard]] ModelWays pair_ways(const LumpedPair& lumped);

/// The results of a response that was found with `options`, with the errors that the stiffness table brings;
/// `response` receives their totals.
[[nodiscard]] FigureSet propagated_pair_errors(const LumpedPair& lumped, const dynamics::SimulationOptions& options,
                                               dynamics::PairResponse& response);

/// Losses and efficiency (friction_losses.h); nothing without [friction].
[[nodiscard]] FigureSet pair_losses(const Scene& scene, const PairGeometry& geometry, const PairShares& shares);
/// The results of studies.
[[nodiscard]] const std::vector<FigureSpec>& pair_study_figures();

}  // namespace annulus::app
