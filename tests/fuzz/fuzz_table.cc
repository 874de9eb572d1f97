#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/errors.h"
#include "core/stiffness_table.h"
#include "core/table_import.h"

namespace {

/// The mesh that the file says it belongs to, so that tables of annulus itself are read as such.
std::string mesh_of(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const char* mesh : {"ring_planet", "pinion_wheel", "arc_pins"})
    if (text.find(std::string("mesh: ") + mesh) != std::string::npos) return mesh;
  return "sun_planet";
}

}  // namespace

/// Any bytes as the file of a stiffness table: it is refused with InputError, or every number of it can be used.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto file = std::filesystem::temp_directory_path() / fmt::format("annulus_fuzz_{}.csv", ::getpid());
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const auto table = annulus::import_table(file, mesh_of(data, size));
    for (const double load : table.loads()) {
      const auto curves = annulus::curves_at_load(table, load);
      for (const auto* curve : {&curves.stiffness_secant, &curves.stiffness_tangent, &curves.unloaded_te, &curves.lte})
        for (const double phase : {0.0, 0.3, 1.7})
          annulus::require(std::isfinite((*curve)(phase)), "an accepted table has values everywhere");
    }
    // What is read can be written, and is then the same table.
    table.write_csv(file);
    const auto again = annulus::StiffnessTable::read_csv(file);
    annulus::require(again.loads() == table.loads() && again.phases() == table.phases() &&
                         again.positions() == table.positions() && again.provenance == table.provenance,
                     "a table survives writing and reading");
  } catch (const annulus::InputError&) {
  }
  return 0;
}
