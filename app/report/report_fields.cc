#include "app/report/report_parts.h"
#include "app/report/svg_frame.h"

namespace annulus::app {

std::string fields_section(const std::vector<std::pair<std::string, const MeshResult*>>& meshes) {
  std::string text;
  for (const auto& [title, mesh] : meshes)
    if (mesh != nullptr && !mesh->fields.empty())
      text += "<h3>" + escape(title) + "</h3>\n<figure class=\"fields\"><div class=\"row\">" + mesh->fields +
              "</div></figure>\n";
  if (text.empty()) return "";
  return "<h2 id=\"fields\">Deformation and stress</h2>\n<p>Both bodies near the contact, in the position where the "
         "root "
         "of the second is stressed most, this mesh alone at the nominal load. Displacements are exaggerated; those of "
         "a gear on a hub are relative to it. Grey: the outline without load. The <code>_field.vtu</code> files hold "
         "more teeth, for ParaView.</p>\n" +
         text;
}

std::string fields_section(const RunResult& result) {
  std::vector<std::pair<std::string, const MeshResult*>> meshes;
  meshes.reserve(result.rings.size() + 1);
  for (const auto& ring : result.rings) meshes.emplace_back("Ring mesh, " + ring.name, &ring.mesh);
  meshes.emplace_back("Sun mesh", &result.sun_mesh);
  return fields_section(meshes);
}

}  // namespace annulus::app
