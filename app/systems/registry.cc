#include <utility>

#include "app/model/gear_system.h"
#include "app/systems/helical_pair/pair_system.h"
#include "app/systems/planetary/planetary_system.h"
#include "app/systems/train/train_system.h"
#include "app/systems/two_k_v/two_k_v_system.h"

namespace annulus::app {

namespace {

std::vector<SystemKind>& registered_kinds() {
  static std::vector<SystemKind> kinds = {planetary_kind(), helical_pair_kind(), two_k_v_kind(), train_kind()};
  return kinds;
}

}  // namespace

const std::vector<SystemKind>& system_kinds() { return registered_kinds(); }

void register_system(SystemKind kind) { registered_kinds().push_back(std::move(kind)); }

const std::vector<SceneKind>& scene_kinds() {
  static const auto kinds = [] {
    std::vector<SceneKind> list;
    for (const auto& kind : system_kinds()) list.push_back(kind.scene);
    return list;
  }();
  return kinds;
}

}  // namespace annulus::app
