#include "app/stage_kinds.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/pair/pair_run.h"
#include "app/pair/pair_subject.h"
#include "app/plan/plan.h"
#include "app/scene/helical_pair/pair_geometry_checks.h"
#include "app/scene/input_place.h"
#include "app/scene/planetary/planetary_geometry_checks.h"
#include "app/scene/two_k_v/two_k_v_geometry_checks.h"
#include "app/stage/summary.h"
#include "app/study/planetary_subject.h"
#include "app/two_k_v/two_k_v_run.h"
#include "app/two_k_v/two_k_v_subject.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

[[noreturn]] void no_such_kind() { throw InternalError("internal error: a stage of a kind that is not handled"); }

std::vector<std::string> planetary_tables_to_solve(const Scene& nominal, const Scene& changed) {
  const auto geometry = make_geometry(changed);
  const auto before = mesh_models(nominal, make_geometry(nominal)), after = mesh_models(changed, geometry);
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!table_serves(before[i], after[i], geometry.operating_point.mean_mesh_force))
      labels.push_back(after[i].label());
  }
  return labels;
}

std::vector<std::string> pair_tables_to_solve(const Scene& nominal, const Scene& changed) {
  const auto geometry = make_pair_geometry(changed);
  const auto before = pair_mesh_model(nominal, make_pair_geometry(nominal)), after = pair_mesh_model(changed, geometry);
  if (table_serves(before, after, geometry.transverse_force)) return {};
  return {after.label()};
}

double planetary_seconds(const Scene& scene) {
  const auto geometry = make_geometry(scene);
  const auto periods = period_cycles(scene, geometry);
  double seconds = 0;
  for (const int period : periods) seconds += dynamics::point_seconds(scene.stage.planets, period);
  // Studies march only where a number of cycles is asked for.
  if (scene.dynamics->mesh_cycles)
    for (const double marched : marching_seconds(scene, geometry)) seconds += marched;
  return seconds;
}

}  // namespace

void check_stage(const Scene& scene) {
  try {
    switch (scene.stage.kind) {
      case StageKind::planetary: {
        const auto geometry = make_geometry(scene);
        check_rims(scene, geometry);
        check_displacements(scene, geometry);
        return;
      }
      case StageKind::helical_pair: {
        const auto geometry = make_pair_geometry(scene);
        check_rims(scene, geometry);
        check_displacements(scene, geometry);
        return;
      }
      case StageKind::two_k_v:
        check_two_k_v(scene);
        check_rims(scene, sun_planet_pair(scene));
        check_two_k_v_displacements(scene);
        return;
    }
  } catch (const GeometryError& error) {
    throw GeometryError(with_place(scene, without_place(scene, error.what())));
  } catch (const InputError& error) {
    throw InputError(with_place(scene, without_place(scene, error.what())));
  }
  no_such_kind();
}

std::vector<std::string> tables_to_solve(const Scene& nominal, const Scene& changed) {
  switch (nominal.stage.kind) {
    case StageKind::planetary:
      return planetary_tables_to_solve(nominal, changed);
    case StageKind::helical_pair:
      return pair_tables_to_solve(nominal, changed);
    case StageKind::two_k_v:
      return two_k_v_tables_to_solve(nominal, changed);
  }
  no_such_kind();
}

std::vector<StudyFigure> stage_figures(StageKind kind) {
  switch (kind) {
    case StageKind::planetary:
      return planetary_figures();
    case StageKind::helical_pair:
      return pair_figures();
    case StageKind::two_k_v:
      return two_k_v_figures();
  }
  no_such_kind();
}

std::size_t variant_count(const Scene& scene) {
  return scene.stage.kind == StageKind::planetary ? scene.rings.size() : 1;
}

double response_seconds(const Scene& scene) {
  switch (scene.stage.kind) {
    case StageKind::planetary:
      return planetary_seconds(scene);
    case StageKind::helical_pair:
      return pair_seconds(scene);
    case StageKind::two_k_v:
      return two_k_v_seconds(scene);
  }
  no_such_kind();
}

std::vector<MeshModel> stage_meshes(const Scene& scene) {
  switch (scene.stage.kind) {
    case StageKind::planetary:
      return mesh_models(scene, make_geometry(scene));
    case StageKind::helical_pair:
      return {pair_mesh_model(scene, make_pair_geometry(scene))};
    case StageKind::two_k_v:
      return two_k_v_meshes(scene);
  }
  no_such_kind();
}

PlanCost stage_cost(const Scene& scene, int threads, const CostModel& costs) {
  const auto meshes = stage_meshes(scene);
  const auto studies = plan_studies(scene);
  switch (scene.stage.kind) {
    case StageKind::planetary:
      return plan_cost(scene, make_geometry(scene), meshes, studies, threads, costs);
    case StageKind::helical_pair:
      return plan_cost(meshes, pair_responses(scene, threads), studies, threads, costs);
    case StageKind::two_k_v:
      return plan_cost(meshes, two_k_v_responses(scene), studies, threads, costs);
  }
  no_such_kind();
}

std::string run_scene(const Scene& scene, const RunOptions& options) {
  switch (scene.stage.kind) {
    case StageKind::planetary:
      return summary_text(run(scene, options));
    case StageKind::helical_pair:
      return pair_summary_text(run_pair(scene, options));
    case StageKind::two_k_v:
      return two_k_v_text(run_two_k_v(scene, options));
  }
  no_such_kind();
}

std::string plan_scene(const Scene& scene, bool json, int threads, const std::string& budget) {
  switch (scene.stage.kind) {
    case StageKind::planetary: {
      Plan plan = make_plan(scene, make_geometry(scene), threads);
      plan.budget = budget;
      return json ? to_json(plan) : to_text(plan);
    }
    case StageKind::helical_pair: {
      Plan plan = make_pair_plan(scene, make_pair_geometry(scene), threads);
      plan.budget = budget;
      return json ? to_json(plan) : to_text(plan);
    }
    case StageKind::two_k_v: {
      Plan plan = make_two_k_v_plan(scene, threads);
      plan.budget = budget;
      return json ? to_json(plan) : to_text(plan);
    }
  }
  no_such_kind();
}

std::string stage_text(const Scene& scene) {
  switch (scene.stage.kind) {
    case StageKind::planetary:
      return fmt::format("{} ring{}, {} planets", scene.rings.size(), scene.rings.size() == 1 ? "" : "s",
                         scene.stage.planets);
    case StageKind::helical_pair:
      return fmt::format("helical pair, {} and {} teeth", scene.pinion.teeth, scene.wheel.teeth);
    case StageKind::two_k_v:
      return fmt::format("{} cranks with a planet each, {} arc gears on {} pins, ratio {}", scene.stage.planets,
                         scene.arc_gear.count, scene.arc_gear.pins, to_text(two_k_v_kinematics(scene).ratio(), 6));
  }
  no_such_kind();
}

}  // namespace annulus::app
