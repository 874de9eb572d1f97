#pragma once

#include <string>
#include <vector>

#include "app/model/lumped_model.h"
#include "app/model/run_options.h"
#include "app/model/system_run.h"
#include "app/systems/shared/space_results.h"
#include "app/systems/train/train_parts.h"
#include "core/csv.h"

namespace annulus::app {

/// A natural frequency of a train, and where its energy is.
struct TrainMode {
  double frequency = 0;           ///< Hz
  std::string body{}, element{};  ///< with the largest share of the kinetic and of the strain energy
  double kinetic = 0, strain = 0;
};

/// The motion of a train.
struct TrainMotion {
  dynamics::TrainResponse response;  ///< without its time series
  FigureSet figures{};               ///< results, with the parts of their errors
  std::vector<TrainMode> modes{};
  Csv shafts{};                       ///< torque over nominal torque of every shaft over the first cycles of the window
  std::vector<SpaceResults> space{};  ///< of every part; empty where it has no bearings in space
  std::string time_series{};          ///< the file of all motions and forces; empty once it is written
};

/// The answer of a train.
struct TrainRunResponse final : RunResponse {
  TrainMotion motion;
};

/// The lumped model as studies ask it. What it refers to has to outlive it.
[[nodiscard]] std::unique_ptr<LumpedModel> train_model(const Scene& scene, const std::vector<WorkingPart>& parts,
                                                       const std::vector<const MeshResult*>& tables);
/// The response of a run, as it is planned.
[[nodiscard]] std::vector<PlannedResponse> train_responses(const Scene& scene, const std::vector<WorkingPart>& parts);
/// Simulates, propagates the errors of the tables; files in OUT/dynamics.
[[nodiscard]] std::unique_ptr<TrainRunResponse> train_response(const Scene& scene,
                                                               const std::vector<WorkingPart>& parts,
                                                               const std::vector<const MeshResult*>& tables,
                                                               const RunOptions& options);

// train_report.cc
[[nodiscard]] Json train_summary(const SystemRun& run, const std::vector<WorkingPart>& parts);
[[nodiscard]] Page train_report(const SystemRun& run, const std::vector<WorkingPart>& parts);

}  // namespace annulus::app
