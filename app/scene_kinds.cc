#include "app/scene/helical_pair/pair_scene.h"
#include "app/scene/planetary/planetary_scene.h"
#include "app/scene/scene_kind.h"
#include "app/scene/two_k_v/two_k_v_scene.h"
#include "app/stage_kinds.h"
#include "example_scenes.h"

namespace annulus::app {

namespace {

template <StageKind kind>
std::vector<std::string> result_columns() {
  std::vector<std::string> names;
  for (const auto& figure : stage_figures(kind)) names.push_back(figure.column);
  return names;
}

}  // namespace

const std::vector<SceneKind>& scene_kinds() {
  static const std::vector<SceneKind> kinds = {
      {"planetary", StageKind::planetary, planetary_tables, check_planetary_scene, result_columns<StageKind::planetary>,
       planetary_example},
      {"helical_pair", StageKind::helical_pair, pair_tables, check_pair_scene, result_columns<StageKind::helical_pair>,
       helical_pair_example},
      {"two_k_v", StageKind::two_k_v, two_k_v_tables, check_two_k_v_scene, result_columns<StageKind::two_k_v>,
       two_k_v_example},
  };
  return kinds;
}

}  // namespace annulus::app
