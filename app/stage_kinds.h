#pragma once

#include <string>
#include <vector>

#include "app/plan/cost_plan.h"
#include "app/plan/mesh_model.h"
#include "app/scene/scene.h"
#include "app/study/study_result.h"

/// Where the kinds of stages differ, in one place: a new kind adds its tables (scene_schema.cc), its checks
/// (scene_checks.cc) and a case to each function here.
namespace annulus::app {

struct RunOptions;

/// Makes the geometry and whatever else needs no solving. Throws InputError where the scene is not a good one.
void check_stage(const Scene& scene);

/// Stiffness tables (labels for people) that a changed scene needs and the nominal one does not have.
[[nodiscard]] std::vector<std::string> tables_to_solve(const Scene& nominal, const Scene& changed);

/// What the lumped model of such a stage answers with.
[[nodiscard]] std::vector<StudyFigure> stage_figures(StageKind kind);

/// How many lumped models a scene compares (rings).
[[nodiscard]] std::size_t variant_count(const Scene& scene);

/// Rough wall time of the responses of all variants on one core.
[[nodiscard]] double response_seconds(const Scene& scene);

/// The meshes that a run solves, and those whose stiffness is given.
[[nodiscard]] std::vector<MeshModel> stage_meshes(const Scene& scene);
/// Predicted time and memory of a run.
[[nodiscard]] PlanCost stage_cost(const Scene& scene, int threads, const CostModel& costs);

/// Everything the scene asks for, into options.out; the summary for the standard output.
std::string run_scene(const Scene& scene, const RunOptions& options);

/// `annulus plan`; the cost is predicted for `threads`. `budget`: what a budget bought, if there was one.
[[nodiscard]] std::string plan_scene(const Scene& scene, bool json, int threads = 1, const std::string& budget = {});

/// What `annulus check` says of a good scene: "3 rings, 5 planets".
[[nodiscard]] std::string stage_text(const Scene& scene);

}  // namespace annulus::app
