#include "app/systems/planetary/alternative_stages.h"

#include <utility>

#include "app/systems/planetary/planet_coupling.h"
#include "app/systems/planetary/rim_coupling.h"

namespace annulus::app {

std::vector<dynamics::PlanetaryStage> alternative_stages(const dynamics::PlanetaryStage& stage,
                                                         const MeshResult& sun_mesh, const MeshResult& ring_mesh) {
  std::vector<dynamics::PlanetaryStage> list;
  if (auto coupled = with_omitted_coupling(stage, ring_mesh)) list.push_back(std::move(*coupled));
  if (auto other = with_deviating_coupling(stage, sun_mesh, ring_mesh)) list.push_back(std::move(*other));
  if (!stage.space) return list;
  for (const auto face : {&dynamics::StageSpace::sun_face, &dynamics::StageSpace::ring_face}) {
    const auto& shape = ((*stage.space).*face).shape;
    if (!shape || !shape->tilted) continue;
    auto other = stage;
    ((*other.space).*face).shape = shape->tilted;
    list.push_back(std::move(other));
  }
  return list;
}

}  // namespace annulus::app
