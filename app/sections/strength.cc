#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/sections/report_parts.h"
#include "core/errors.h"
#include "core/not_known.h"
#include "core/units.h"
#include "geometry/iso6336.h"

namespace annulus::app {

namespace {

constexpr double MPa = 1e6;

/// A gear in one of its meshes.
struct MeshedGear {
  const MeshResult& mesh;
  geometry::GearRole which = geometry::GearRole::pinion;

  [[nodiscard]] bool is_pinion() const { return which == geometry::GearRole::pinion; }
  [[nodiscard]] const geometry::GearPair& pair() const { return mesh.model.problem->pair; }
  [[nodiscard]] const geometry::Gear& gear() const { return is_pinion() ? pair().pinion() : pair().wheel(); }
  [[nodiscard]] const std::string& name() const { return mesh.model.body_name(which); }
  [[nodiscard]] bool internal() const { return !is_pinion() && pair().internal(); }
  /// N, of one mesh.
  [[nodiscard]] double normal_force() const { return mesh.table.loads()[mesh.nominal]; }
  /// N, at the reference circle.
  [[nodiscard]] double tangential_force() const {
    return normal_force() * gear().base_radius() / gear().reference_radius();
  }
  /// m, between the root and a free rim or a bore.
  [[nodiscard]] double rim() const {
    const auto& problem = *mesh.model.problem;
    const double other = is_pinion() ? problem.pinion_bore_radius : problem.wheel_support_radius;
    return std::abs(gear().root_radius() - other);
  }
};

std::string in_MPa(double stress) { return to_text(stress / MPa, 4); }

/// The root of one gear: local stress, then nominal one and its factors. Empty cells where the standard has no formula.
std::vector<Text> root_row(const std::string& mesh_name, const MeshedGear& g) {
  const auto local = g.mesh.largest_stress(g.name(), "root_tension");
  if (!local) return {};
  std::vector<Text> row = {fmt::format("{}, {}", g.name(), mesh_name),
                           measured(local->value / MPa, std::abs(local->value) * local->error_relative / MPa)};
  try {
    const auto root = geometry::root_section(g.pair(), g.gear());
    const double stress = geometry::nominal_root_stress(g.gear(), root, g.tangential_force());
    const double compression =
        root.stress_correction * g.normal_force() * std::sin(root.load_angle) / (root.face_width * root.chord);
    for (const auto& cell :
         {in_MPa(stress), in_MPa(stress - compression), to_text(root.form_factor, 4),
          to_text(root.stress_correction, 4), to_text(geometry::rim_thickness_factor(g.gear(), g.rim()), 3)})
      row.emplace_back(cell);
  } catch (const GeometryError&) {
    row.resize(7, "–");
  }
  return row;
}

/// The largest pressure at the nominal load away from tip edges, Pa; NaN without.
double largest_pressure(const MeshResult& mesh) {
  const auto& csv = mesh.positions;
  const auto load = csv.column("load_N"), edge = csv.column("tip_edge_contact"),
             pressure = csv.column("max_pressure_MPa");
  double largest = not_known;
  for (const auto& row : csv.rows)
    if (row[load] == mesh.table.loads()[mesh.nominal] && row[edge] == 0)
      largest = std::fmax(largest, row[pressure] * MPa);
  return largest;
}

/// The largest of a stress over the positions of a mesh at one load, with the error of that position; empty without.
std::string largest_at_load(const Csv& positions, double load, const std::string& stress) {
  const auto name = stress + "_MPa";
  if (std::find(positions.columns.begin(), positions.columns.end(), name) == positions.columns.end()) return "";
  const auto value = positions.column(name), error = positions.column(stress + "_error_MPa"),
             at = positions.column("load_N");
  const std::vector<double>* best = nullptr;
  for (const auto& row : positions.rows)
    if (row[at] == load && std::isfinite(row[value]) && (!best || std::abs(row[value]) > std::abs((*best)[value])))
      best = &row;
  return best && (*best)[value] != 0 ? measured((*best)[value], (*best)[error]) : "";
}

}  // namespace

Blocks stresses_by_load(const NamedMeshes& meshes) {
  Blocks blocks;
  for (const auto& [name, mesh] : meshes) {
    if (!mesh->model.computed() || mesh->positions.rows.empty() || mesh->table.loads().size() < 2) continue;
    const auto &pinion = mesh->model.pinion_body, &wheel = mesh->model.wheel_body;
    PageTable table{.head = {"load, kN"}};
    std::vector<std::string> columns;
    for (const auto& [body, kind, words] : {std::tuple{pinion, "root_tension", "root, tension"},
                                            {wheel, "root_tension", "root, tension"},
                                            {wheel, "rim_von_mises", "rim, von Mises"}}) {
      const auto stress = fmt::format("{}_{}", body, kind);
      if (largest_at_load(mesh->positions, mesh->table.loads()[mesh->nominal], stress).empty()) continue;
      columns.push_back(stress);
      table.head.emplace_back(fmt::format("{}: {}, MPa", body, words));
    }
    if (columns.empty()) continue;
    for (const double load : mesh->table.loads()) {
      auto& row = table.rows.emplace_back(std::vector<Text>{to_text(load / 1e3, 4)});
      for (const auto& stress : columns) row.emplace_back(largest_at_load(mesh->positions, load, stress));
    }
    blocks += heading("Stress over the load: " + name) + table;
  }
  if (!blocks.empty())
    blocks += paragraph(
        "Largest over the mesh cycles, with the error by discretisation. At the nominal load plane bodies are looked "
        "at "
        "all around; else stresses are those within some teeth of the contact.");
  return blocks;
}

Blocks beside_iso_6336(const NamedMeshes& meshes) {
  PageTable roots{.head = {"root", "largest local tension, MPa", phrase("σ{}, MPa", subscript("F0")),
                           phrase("σ{} less the radial force, MPa", subscript("F0")), phrase("Y{}", subscript("F")),
                           phrase("Y{}", subscript("S")), phrase("Y{}", subscript("B"))}},
      flanks{.head = {"mesh", "largest pressure away from tip edges, MPa", phrase("σ{}, MPa", subscript("H0"))}};
  for (const auto& [name, mesh] : meshes) {
    if (!mesh->model.computed() || mesh->positions.rows.empty()) continue;
    for (const auto gear : {geometry::GearRole::pinion, geometry::GearRole::wheel})
      if (auto row = root_row(name, {*mesh, gear}); !row.empty()) roots.rows.push_back(std::move(row));
    const auto& problem = *mesh->model.problem;
    if (const double pressure = largest_pressure(*mesh);
        std::isfinite(pressure) && problem.pair.pinion().helix_angle() == 0)
      flanks.rows.push_back({name, in_MPa(pressure),
                             in_MPa(geometry::nominal_flank_pressure(
                                 problem.pair, MeshedGear{*mesh, geometry::GearRole::pinion}.tangential_force(),
                                 problem.materials.contact_modulus()))});
  }
  if (roots.rows.empty() && flanks.rows.empty()) return {};
  Blocks blocks = heading("Beside ISO 6336");
  if (!roots.rows.empty())
    blocks +=
        roots +
        paragraph(phrase(
            "Local tension: finite elements, the largest over the fillet and the mesh cycles. σ{}: nominal stress "
            "of ISO 6336-3, method B, with the force at the outer point of single contact. It is a bending "
            "stress; the column beside it takes off what the radial force compresses. Y{} of thin rims is not "
            "contained. The standard has no formula here for helical teeth, contact ratios above 2 and internal "
            "gears without a given cutter (–).",
            subscript("F0"), subscript("B")));
  if (!flanks.rows.empty())
    blocks += flanks + paragraph(phrase("σ{}: nominal pressure of ISO 6336-2 at the pitch point. All values hold for "
                                        "the nominal force of one mesh, without load sharing and dynamics: multiply "
                                        "stresses by the peak factor and pressures by its root.",
                                        subscript("H0")));
  return blocks;
}

}  // namespace annulus::app
