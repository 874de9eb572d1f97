#include "app/export/rexs.h"

#include <system_error>

#include "app/model/gear_system.h"
#include "app/rexs/rexs_reader.h"
#include "core/errors.h"

namespace annulus::app {

std::string rexs_text(const Scene& scene, const std::string& variant) { return make_system(scene)->rexs(variant); }

RexsScene read_rexs(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw InputError(path.string() + ": there is no such file");
  const RexsFile file(path);
  for (const auto& kind : system_kinds()) {
    const auto found = kind.from_rexs ? kind.from_rexs(file) : std::nullopt;
    if (!found) continue;
    RexsScene scene{kind.scene.name, *found};
    scene.values["stage.kind"] = {toml_text(Value(scene.kind)), ""};
    scene.values.try_emplace("accuracy", NewValue{"0.01"});
    scene.values.try_emplace("title", NewValue{toml_text(Value(path.stem().string()))});
    return scene;
  }
  throw file.refusal("has no stage of cylindrical gears");
}

}  // namespace annulus::app
