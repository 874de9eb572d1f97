#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/report/page.h"
#include "app/results/content_id.h"
#include "app/results/program_identity.h"
#include "app/sections/report_parts.h"
#include "app/systems/planetary/static_results.h"
#include "app/systems/planetary/statics.h"
#include "core/csv.h"
#include "core/files.h"
#include "core/units.h"

namespace annulus::app {

namespace {

using dynamics::StaticMesh;
using dynamics::StaticPosition;

constexpr double to_micro = 1e6;

/// The meshes of a kind with their names.
struct MeshKind {
  const char *name, *title;
  std::vector<StaticMesh> StaticPosition::*meshes;
  std::vector<double> dynamics::StaticTurn::*stations;
};
constexpr MeshKind mesh_kinds[] = {
    {"sun_planet", "sun mesh", &StaticPosition::sun_meshes, &dynamics::StaticTurn::sun_stations},
    {"ring_planet", "ring mesh", &StaticPosition::ring_meshes, &dynamics::StaticTurn::ring_stations}};

std::size_t planets_of(const RingStatics& ring) { return ring.turn.positions.front().sun_meshes.size(); }

double degrees(const StaticPosition& p) { return p.carrier_angle / units::deg; }

Csv with_positions(const RingStatics& ring, std::vector<std::string> columns,
                   const std::function<void(const StaticPosition&, std::vector<double>&)>& fill) {
  Csv csv;
  csv.header = {{"annulus_version", version()}, {"ring", ring.ring}};
  csv.columns = {"mesh_cycle", "carrier_angle_deg"};
  csv.columns.insert(csv.columns.end(), columns.begin(), columns.end());
  for (const auto& p : ring.turn.positions) {
    auto& row = csv.rows.emplace_back(std::vector{p.mesh_cycles, degrees(p)});
    fill(p, row);
  }
  return csv;
}

Csv meshes_csv(const RingStatics& ring) {
  std::vector<std::string> columns;
  for (const auto& kind : mesh_kinds)
    for (std::size_t n = 1; n <= planets_of(ring); ++n)
      for (const auto* what : {"force_N", "face_load_factor", "load_at_mm"})
        columns.push_back(fmt::format("{}{}_{}", kind.name, n, what));
  return with_positions(ring, columns, [](const StaticPosition& p, std::vector<double>& row) {
    for (const auto& kind : mesh_kinds)
      for (const auto& mesh : p.*kind.meshes)
        row.insert(row.end(), {mesh.force, mesh.line_load_ratio(), mesh.place / units::mm});
  });
}

Csv bearings_csv(const RingStatics& ring) {
  std::vector<std::string> columns, names;
  for (std::size_t b = 1; b <= ring.bearings.size(); ++b) {
    names.push_back(fmt::format("{} {} ({})", b, ring.bearings[b - 1].name, ring.bearings[b - 1].body));
    for (const auto* what : {"x_N", "y_N", "z_N", "about_x_Nm", "about_y_Nm"})
      columns.push_back(fmt::format("bearing{}_{}", b, what));
    if (ring.bearings[b - 1].element) columns.push_back(fmt::format("bearing{}_rolling_element_N", b));
  }
  auto csv = with_positions(ring, columns, [&](const StaticPosition& p, std::vector<double>& row) {
    for (std::size_t i = 0; i < p.bearings.size(); ++i) {
      const auto& b = p.bearings[i];
      row.insert(row.end(), {b.force.x(), b.force.y(), b.force.z(), b.moment.x(), b.moment.y()});
      if (ring.bearings[i].element) row.push_back(b.largest_element);
    }
  });
  csv.header.emplace_back("bearings", fmt::format("{}", fmt::join(names, ", ")));
  csv.header.emplace_back("forces", "on the body, in the frame of the bearing; of planets x radial, y tangential");
  return csv;
}

Csv bodies_csv(const RingStatics& ring) {
  std::vector<std::string> columns;
  for (const auto& name : ring.turn.body_names)
    for (const auto* what : {"x_um", "y_um", "z_um", "about_x_urad", "about_y_urad", "about_z_urad"})
      columns.push_back(fmt::format("{}_{}", name, what));
  auto csv = with_positions(ring, columns, [](const StaticPosition& p, std::vector<double>& row) {
    for (const auto& body : p.bodies)
      for (const auto* part : {&body.displacement, &body.rotation})
        for (const double value : *part) row.push_back(to_micro * value);
  });
  csv.header.emplace_back("frame", "the carrier's; of planets x radial, y tangential");
  return csv;
}

/// The position in which a mesh has its most uneven load.
const StaticPosition& worst_position(const RingStatics& ring, const MeshKind& kind, std::size_t n) {
  const auto less = [&](const StaticPosition& a, const StaticPosition& b) {
    const auto ratio = [&](const StaticPosition& p) {
      const auto& mesh = (p.*kind.meshes)[n];
      return mesh.force >= dynamics::StaticFigures::light_mesh * ring.mean_mesh_force ? mesh.line_load_ratio() : 0.0;
    };
    return ratio(a) < ratio(b);
  };
  return *std::max_element(ring.turn.positions.begin(), ring.turn.positions.end(), less);
}

Csv face_csv(const RingStatics& ring, const MeshKind& kind) {
  Csv csv;
  csv.header = {{"annulus_version", version()}, {"ring", ring.ring}};
  csv.columns = {"z_mm"};
  const auto& stations = ring.turn.*kind.stations;
  for (const double z : stations) csv.rows.push_back({z / units::mm});
  std::vector<std::string> places;
  for (std::size_t n = 0; n < planets_of(ring); ++n) {
    const auto& position = worst_position(ring, kind, n);
    places.push_back(fmt::format("{} {:.4g}", n + 1, position.mesh_cycles));
    csv.columns.push_back(fmt::format("planet{}_N_per_mm", n + 1));
    const auto& load = (position.*kind.meshes)[n].line_load;
    for (std::size_t i = 0; i < stations.size(); ++i) csv.rows[i].push_back(load[i] * units::mm);
  }
  csv.header.emplace_back("mesh_cycle", fmt::format("{}", fmt::join(places, ", ")));
  return csv;
}

/// Null where the forces never repeat.
Json period_json(const RingStatics& ring) {
  if (ring.period >= dynamics::PlanetaryStage::never_repeats) return nullptr;
  return ring.period;
}

/// "32 positions of the carrier over 99 mesh cycles, 4 phases each".
std::string positions_text(const RingStatics& ring) {
  const auto& schedule = ring.turn.schedule;
  return fmt::format("{} position{} of the carrier over {}, {} phase{} each", schedule.cycles.size(),
                     schedule.cycles.size() == 1 ? "" : "s",
                     ring.period >= dynamics::PlanetaryStage::never_repeats
                         ? std::string("mesh cycles that never repeat")
                         : fmt::format("{} mesh cycle{}", ring.period, ring.period == 1 ? "" : "s"),
                     schedule.phases, schedule.phases == 1 ? "" : "s");
}

Json ring_json(const RingStatics& ring) {
  Json json;
  for (const auto& spec : static_figures())
    if (const auto* entry = ring.figures.find(spec.key)) {
      auto& json_entry = json["results"][entry->key] = to_json(entry->figure);
      json_entry["error_parts"] = to_json(entry->parts);
    }
  json["mean_mesh_force_N"] = ring.mean_mesh_force;
  json["degrees_of_freedom"] = ring.reasons.empty() ? "plane" : "space";
  json["reasons_for_space"] = ring.reasons;
  json["positions"] = ring.turn.positions.size();
  json["carrier_positions"] = ring.turn.schedule.cycles.size();
  json["period_mesh_cycles"] = period_json(ring);
  json["residual_relative"] = ring.worst_residual;
  for (const auto& b : ring.bearings) {
    Json bearing = {{"name", b.name},
                    {"body", b.body},
                    {"radial_force_max_N", to_json(b.radial)},
                    {"radial_force_mean_N", b.mean_radial},
                    {"axial_force_max_N", to_json(b.axial)},
                    {"moment_max_Nm", to_json(b.moment)}};
    if (b.element) bearing["rolling_element_force_max_N"] = to_json(*b.element);
    json["bearings"].push_back(std::move(bearing));
  }
  for (std::size_t b = 0; b < ring.tilt.size(); ++b)
    json["tilt_max_rad"][ring.turn.body_names[b]] = to_json(ring.tilt[b]);
  return json;
}

/// Without what rounding leaves of nothing.
Figure beside(const Figure& figure, double size) {
  constexpr double rounding = 1e-9;
  return std::abs(figure.value) <= rounding * size ? Figure{0, 0} : figure;
}
std::string force_text(const RingStatics& ring, const Figure& force) {
  return measured_in_unit(beside(force, ring.mean_mesh_force), shown_units::force);
}
std::string moment_text(const RingStatics& ring, const Figure& moment) {
  constexpr double arm = 1e-3;  // m, a short one
  return measured_in_unit(beside(moment, arm * ring.mean_mesh_force), shown_units::torque);
}

// The page.

Section results_section(const StageStatics& statics) {
  PageTable table{.head = {"result"}, .style = PageTable::Style::numbers};
  for (const auto& ring : statics.rings) table.head.emplace_back(ring.ring);
  for (const auto& spec : static_figures()) {
    std::vector<Text> row = {Text(spec.title + ", " + spec.symbol)};
    bool any = false;
    for (const auto& ring : statics.rings) {
      const auto* entry = ring.figures.find(spec.key);
      row.emplace_back(entry != nullptr ? measured(entry->figure, 1) : "–");
      any = any || entry != nullptr;
    }
    if (any) table.rows.push_back(std::move(row));
  }
  std::vector<VariantFigures> variants;
  for (const auto& ring : statics.rings) variants.push_back({ring.ring, ring.figures});
  return {"results", "Results", table + error_parts(static_figures(), variants)};
}

Series over_turn(const RingStatics& ring, const std::string& label, std::size_t colour,
                 const std::function<double(const StaticPosition&)>& value) {
  Series series{.label = label, .colour = colour};
  for (const auto& p : ring.turn.positions) {
    series.x.push_back(p.mesh_cycles);
    series.y.push_back(value(p));
  }
  return series;
}

constexpr const char* turn_axis = "mesh cycles";

Blocks mesh_plots(const RingStatics& ring) {
  Blocks blocks;
  for (const auto& kind : mesh_kinds) {
    Plot forces = wide_plot(fmt::format("{} forces over the mean, '{}'", kind.title, ring.ring), turn_axis,
                            "force / mean mesh force");
    Plot face = wide_plot(fmt::format("Load along the face of the {}, '{}'", kind.title, ring.ring), "z, mm", "N/mm");
    for (std::size_t n = 0; n < planets_of(ring); ++n) {
      const auto label = fmt::format("planet {}", n + 1);
      forces.series.push_back(over_turn(
          ring, label, n, [&](const StaticPosition& p) { return (p.*kind.meshes)[n].force / ring.mean_mesh_force; }));
      Series load{.label = label, .colour = n};
      const auto& position = worst_position(ring, kind, n);
      for (std::size_t i = 0; i < (ring.turn.*kind.stations).size(); ++i) {
        load.x.push_back((ring.turn.*kind.stations)[i] / units::mm);
        load.y.push_back((position.*kind.meshes)[n].line_load[i] * units::mm);
      }
      face.series.push_back(std::move(load));
    }
    if (ring.turn.positions.size() > 1) blocks += Pictures{{forces}};
    if ((ring.turn.*kind.stations).size() > 2)
      blocks += Pictures{{face}, {}, "Of each planet in the position with its most uneven load."};
  }
  return blocks;
}

Blocks bearing_blocks(const RingStatics& ring) {
  PageTable table{
      .head = {"bearing", "body", "radial force, largest", "mean", "axial force, largest", "moment, largest"},
      .style = PageTable::Style::numbers};
  const bool rolls = std::any_of(ring.bearings.begin(), ring.bearings.end(), [](const auto& b) { return b.element; });
  if (rolls) table.head.emplace_back("roller or ball");
  for (const auto& b : ring.bearings) {
    table.rows.push_back({b.name, b.body, force_text(ring, b.radial), text_in_unit(b.mean_radial, shown_units::force),
                          force_text(ring, b.axial), moment_text(ring, b.moment)});
    if (rolls) table.rows.back().push_back(b.element ? force_text(ring, *b.element) : std::string("–"));
  }
  Blocks blocks = heading(fmt::format("Bearings, '{}'", ring.ring));
  blocks += table;
  PageTable tilts{.head = {"body", "tilt, largest, µrad"}, .style = PageTable::Style::numbers};
  for (std::size_t b = 0; b < ring.tilt.size(); ++b) {
    constexpr double rounding = 1e-12;  // rad
    const bool still = ring.tilt[b].value < rounding;
    tilts.rows.push_back({ring.turn.body_names[b], still ? std::string("0") : measured(ring.tilt[b], to_micro)});
  }
  if (!ring.reasons.empty()) blocks += tilts;
  return blocks;
}

Blocks model_blocks(const RingStatics& ring) {
  Blocks blocks = heading(fmt::format("Model, '{}'", ring.ring));
  if (ring.reasons.empty()) {
    blocks += paragraph(
        "Plane: bodies move in the transverse plane and turn about their axes. Nothing in the scene moves them along "
        "the axis or tilts them, so these degrees of freedom are left out.");
  } else {
    blocks += paragraph("In space: every body has six degrees of freedom, less those that its bearings hold, because");
    List list;
    for (const auto& reason : ring.reasons) list.items.emplace_back(reason);
    blocks += list;
  }
  blocks += paragraph(fmt::format("{}; the largest force that is left over is {} of the largest force.",
                                  positions_text(ring), small_text(ring.worst_residual)));
  return blocks;
}

}  // namespace

Page statics_page(const StageStatics& statics, const RunOptions& options) {
  Page page;
  page.title = statics.scene.title;
  page.sub =
      fmt::format("Equilibrium of the stage over a turn of the carrier. annulus {}; {}", version(), options.command);
  List warnings;
  for (const auto& ring : statics.rings)
    for (const auto& warning : ring.warnings) warnings.items.emplace_back(to_text(warning));
  if (!warnings.items.empty()) page.summary += verdict_box(warnings);
  page.sections.push_back(results_section(statics));
  Section meshes{"meshes", "Meshes"}, bearings{"bearings", "Bearings and bodies"}, model{"model", "Model"};
  for (const auto& ring : statics.rings) {
    meshes.blocks += mesh_plots(ring);
    bearings.blocks += bearing_blocks(ring);
    model.blocks += model_blocks(ring);
  }
  page.sections.push_back(meshes);
  page.sections.push_back(bearings);
  page.sections.push_back(model);
  return page;
}

Json statics_json(const StageStatics& statics) {
  Json json{{"title", statics.scene.title}, {"annulus_version", version()}};
  std::vector<Warning> warnings;
  for (const auto& ring : statics.rings) {
    json["rings"][ring.ring] = ring_json(ring);
    warnings.insert(warnings.end(), ring.warnings.begin(), ring.warnings.end());
  }
  json["warnings"] = to_json(warnings);
  return json;
}

std::string statics_text(const StageStatics& statics) {
  std::string text;
  for (const auto& ring : statics.rings) {
    text += fmt::format("{}{}: {}, bodies {}\n", text.empty() ? "" : "\n", ring.ring, positions_text(ring),
                        ring.reasons.empty() ? "in the plane" : "in space, because " + ring.reasons.front());
    for (const auto& spec : static_figures())
      if (const auto* entry = ring.figures.find(spec.key))
        text += fmt::format("  {:62} {:5} {}\n", spec.title, spec.symbol, measured(entry->figure, 1));
    for (const auto& b : ring.bearings) {
      text += fmt::format("  {:28} {:9} radial {:>18}", b.name, b.body, force_text(ring, b.radial));
      if (!ring.reasons.empty())
        text += fmt::format(", axial {:>18}, moment {:>18}", force_text(ring, b.axial), moment_text(ring, b.moment));
      if (b.element) text += fmt::format(", rolling element {:>18}", force_text(ring, *b.element));
      text += "\n";
    }
  }
  return text;
}

void write_statics(const StageStatics& statics, const RunOptions& options) {
  for (const auto& ring : statics.rings) {
    const auto folder = options.out / "statics" / ring.ring;
    std::filesystem::create_directories(folder);
    meshes_csv(ring).write(folder / "mesh_forces.csv");
    bearings_csv(ring).write(folder / "bearings.csv");
    bodies_csv(ring).write(folder / "bodies.csv");
    for (const auto& kind : mesh_kinds) face_csv(ring, kind).write(folder / fmt::format("face_load_{}.csv", kind.name));
  }
  write_file(options.out / "statics.json", text_of(statics_json(statics)));
  write_report(options.out / "statics.html", statics_page(statics, options), "statics_pictures");
}

}  // namespace annulus::app
