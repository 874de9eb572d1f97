#pragma once

#include <filesystem>
#include <string>

#include "app/scene/new_scene.h"
#include "app/scene/scene.h"

/// REXS (Reusable Engineering EXchange Standard, FVA, version 1.4): the gear data of a stage as XML. What each kind of
/// gear system says and reads stands with it.
namespace annulus::app {

/// The variant of that name (empty where there is a single one). What REXS has no attribute for stands in custom
/// attributes `custom_annulus_<key>`, with the key, unit and value of the scene. Throws InputError for a variant that
/// is not there and for kinds that REXS cannot describe.
[[nodiscard]] std::string rexs_text(const Scene& scene, const std::string& variant);

/// What a file of REXS 1.x says about the first stage that one of the kinds recognises, in the order of the kinds.
struct RexsScene {
  std::string kind;
  NewValues values{};
};
/// Throws InputError naming the file and what it lacks or contradicts.
[[nodiscard]] RexsScene read_rexs(const std::filesystem::path& file);

}  // namespace annulus::app
