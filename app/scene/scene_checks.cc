#include "app/scene/scene_checks.h"

#include "app/scene/key_rules.h"
#include "app/scene/scene_kind.h"

namespace annulus::app {

void complete_and_check(Scene& scene, std::vector<Problem>& problems) {
  const auto& kind = scene_kind(scene.stage.kind);
  check_key_rules(schema(kind.name), scene, problems);
  kind.check(scene, problems);
  // Paths are looked up among the inputs, which have to be right for that.
  if (problems.empty()) check_study_keys(scene, problems);
}

}  // namespace annulus::app
