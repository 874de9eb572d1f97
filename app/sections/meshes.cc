#include <fmt/format.h>

#include <cmath>

#include "app/sections/report_parts.h"

namespace annulus::app {

Section fields_section(const std::vector<std::pair<std::string, const MeshResult*>>& meshes) {
  Blocks views;
  for (const auto& [title, mesh] : meshes) {
    if (mesh == nullptr || mesh->fields.empty()) continue;
    Pictures figure{.layout = Pictures::Layout::fields};
    for (const auto& view : mesh->fields) figure.list.emplace_back(view);
    views += heading(title) + figure;
  }
  Section section{"fields", "Deformation and stress"};
  if (!views.empty())
    section.blocks =
        paragraph(
            "Both bodies near the contact, in the position where the root of the second is stressed most, this mesh "
            "alone at the nominal load. Displacements are exaggerated; those of a gear on a hub are relative to it. "
            "Grey: the outline without load. The " +
            code("_field.vtu") + " files hold more teeth, for ParaView.") +
        views;
  return section;
}

Blocks mesh_pictures(const std::vector<std::pair<std::string, const MeshResult*>>& meshes) {
  Pictures figure{.layout = Pictures::Layout::meshes};
  for (const auto& [title, mesh] : meshes) {
    if (mesh == nullptr || mesh->picture.empty()) continue;
    figure.list.emplace_back(Drawing{mesh->picture}, title,
                             mesh->model.fidelity.ends_with("solid")
                                 ? "Fixed faces orange, driven flanks blue."
                                 : "Planet blue; the fixed surface is orange; the circle marks the pitch point.");
  }
  return figure.list.empty() ? Blocks() : Blocks(figure);
}

Blocks stiffness_errors(const std::vector<std::pair<std::string, const MeshResult*>>& meshes) {
  PageTable table{
      .head = {"", "error", "discretisation", "local contact", "condensation", "table interpolation", "model choice"},
      .style = PageTable::Style::numbers};
  const auto share = [](double part) {
    if (!std::isfinite(part)) return std::string("not known");
    return part == 0 ? "–" : fmt::format("{:.2g} %", 100 * part);
  };
  for (const auto& [name, mesh] : meshes) {
    if (mesh == nullptr || !mesh->model.computed()) continue;
    table.rows.push_back({name});
    for (const auto& [what, e] : {std::pair{"mean stiffness", mesh->mean_stiffness()},
                                  {"mean transmission error", mesh->lte_mean()},
                                  {"peak-to-peak transmission error", mesh->lte_peak_to_peak()}})
      table.rows.push_back({what, share(e.error_relative), share(e.parts.discretisation), share(e.parts.contact),
                            share(e.parts.condensation), share(e.parts.interpolation), share(e.parts.model)});
  }
  if (table.rows.empty()) return {};
  return heading("What the errors of the stiffness are made of", "stiffness-errors") + table +
         paragraph(
             "Discretisation: the difference of two levels of cells. Local contact: the pressure on the flanks, "
             "against twice as many pieces. Condensation: asymmetry of the compliance between tooth pairs. Model "
             "choice: plane strain for a face of finite width, formulas for teeth; the wanted accuracy does not count "
             "plane strain, which solid elements (model = \"solid\") do without.");
}

}  // namespace annulus::app
