#include <cmath>
#include <cstdint>

#include "app/model/gear_system.h"
#include "app/scene/scene_schema.h"
#include "app/study/studies.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// What the checks let through is a value the schema permits.
void require_good(const Scene& scene) {
  for (const auto& input : scene.inputs) {
    const auto* p = find_parameter(input.key);
    require(p != nullptr, "an input is a key of the schema");
    if (input.origin != Origin::scene) continue;
    if (const auto* x = std::get_if<double>(&input.value)) require(p->in_range(*x), input.key + " is in range");
    if (const auto* n = std::get_if<long>(&input.value))
      require(p->in_range(static_cast<double>(*n)), input.key + " is in range");
    if (const auto* list = std::get_if<std::vector<double>>(&input.value))
      for (const double x : *list) require(p->in_range(x), input.key + " is in range");
  }
}

/// Whether the changed scenes of the studies are made in no time.
bool few_cases(const Scene& scene) {
  constexpr std::size_t few = 10;
  std::size_t cases = 0;
  for (const auto& sweep : scene.sweeps) cases += sweep.points().size();
  for (const auto& grid : scene.grids) cases += grid.x.points().size() * grid.y.points().size();
  if (scene.monte_carlo) cases += static_cast<std::size_t>(scene.monte_carlo->samples) / 100;
  return cases <= few;
}

}  // namespace

}  // namespace annulus::app

/// Any bytes as a scene: refused with InputError and a message, or good for a plan.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace annulus;
  try {
    const auto scene = app::parse_scene({reinterpret_cast<const char*>(data), size}, "/nowhere/scene.toml");
    app::require_good(scene);
    app::check_stage(scene);
    if (app::few_cases(scene)) app::check_studies(scene);
  } catch (const InputError& error) {
    require(error.what()[0] != '\0', "a refusal says why");
  }
  return 0;
}
