#include "geometry/meshing.h"

#include "core/loaded_library.h"

namespace annulus::geometry {

const Meshing& meshing() {
  static const auto& table = *static_cast<const Meshing*>(meshing_library.table());
  return table;
}

void write_msh(const Mesh& mesh, const std::filesystem::path& file) { meshing().write_msh(mesh, file); }

}  // namespace annulus::geometry
