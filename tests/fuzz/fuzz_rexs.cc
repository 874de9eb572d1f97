#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "app/export/rexs.h"
#include "app/scene/new_scene.h"
#include "core/errors.h"

namespace {

/// Whether the scene itself is: "not valid TOML ...", or "KEY: unknown key ...". Texts of the scene stand in messages
/// too, but not there.
bool is_broken(const std::string& message) {
  const auto space = message.find(' ');
  return message.starts_with("not valid TOML") ||
         (space != std::string::npos && message.substr(0, space).ends_with(':') &&
          message.substr(space + 1).starts_with("unknown"));
}

}  // namespace

/// Any bytes as a REXS file: refused with InputError, or made into a scene file in which nothing is wrong but what the
/// REXS file does not say or says out of range.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace annulus;
  static const auto file = std::filesystem::temp_directory_path() / fmt::format("annulus_fuzz_{}.rexs", ::getpid());
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const auto rexs = app::read_rexs(file);
    const auto text = app::new_scene(rexs.kind, rexs.values);
    try {
      (void)app::parse_scene(text, "/nowhere/scene.toml");
    } catch (const app::SceneError& error) {
      for (const auto& problem : error.problems()) require(!is_broken(problem.message), "a written scene can be read");
    }
  } catch (const InputError& error) {
    require(error.what()[0] != '\0', "a refusal says why");
  }
  return 0;
}
