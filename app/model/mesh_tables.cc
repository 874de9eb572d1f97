#include "app/model/mesh_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/not_known.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double MPa = 1e6;

std::size_t most_pairs(const fem::LoadedMeshResult& solved) {
  std::size_t pairs = 0;
  for (const auto& p : solved.positions) pairs = std::max(pairs, p.pair_share.size());
  return pairs;
}

/// Visits the positions at the nominal load.
template <class Visit>
void at_nominal_load(const MeshModel& model, const fem::LoadedMeshResult& solved, Visit visit) {
  const double nominal = model.problem->loads[model.nominal_load()];
  for (const auto& p : solved.positions) {
    if (p.load == nominal) visit(p);
  }
}

/// A column of positions and loads.
struct PositionColumn {
  std::string name;
  std::function<double(const fem::LoadedPosition&)> value;
};

/// um, the part of the deflection that a relative error of the stiffness is.
double error_um(const fem::LoadedPosition& p, double relative) {
  return std::abs(relative * (p.entry.lte - p.entry.unloaded_te)) / units::um;
}

std::vector<PositionColumn> position_columns(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  using Position = fem::LoadedPosition;
  std::vector<PositionColumn> list = {
      {"mesh_phase", [](const Position& p) { return p.mesh_phase; }},
      {"ring_tooth", [](const Position& p) { return static_cast<double>(p.ring_tooth); }},
      {"ring_angle_deg", [](const Position& p) { return p.ring_angle / units::deg; }},
      {"load_N", [](const Position& p) { return p.load; }},
      {"unloaded_te_um", [](const Position& p) { return p.entry.unloaded_te / units::um; }},
      {"lte_um", [](const Position& p) { return p.entry.lte / units::um; }},
      {"error_um", [](const Position& p) { return error_um(p, p.entry.error_relative); }}};
  for (const auto& [name, part] : stiffness_error_part_names)
    list.push_back({fmt::format("error_{}_um", name),
                    [part = part](const Position& p) { return error_um(p, p.entry.error_parts.*part); }});
  list.insert(list.end(), {{"max_pressure_MPa", [](const Position& p) { return p.max_pressure / MPa; }},
                           {"tip_edge_contact", [](const Position& p) { return p.tip_edge_contact ? 1.0 : 0.0; }},
                           {"force_balance_relative", [](const Position& p) { return p.force_balance_relative; }},
                           {"energy_balance_relative", [](const Position& p) { return p.energy_balance_relative; }},
                           {"max_penetration_um", [](const Position& p) { return p.max_penetration / units::um; }}});
  if (over_face_width(solved))
    list.push_back({"face_load_factor", [](const Position& p) { return p.face_load_factor; }});
  for (const auto& [body, member] :
       {std::pair{model.pinion_body, &Position::pinion_stress}, {model.wheel_body, &Position::wheel_stress}}) {
    const auto has_stress = [m = member](const Position& p) { return (p.*m).has_value(); };
    if (std::none_of(solved.positions.begin(), solved.positions.end(), has_stress)) continue;
    for (const auto& [name, stress] : stress_columns) {
      list.push_back({fmt::format("{}_{}_MPa", body, name), [m = member, stress = stress](const Position& p) {
                        return p.*m ? (*(p.*m)).*stress / MPa : not_known;
                      }});
      list.push_back({fmt::format("{}_{}_error_MPa", body, name), [m = member, stress = stress](const Position& p) {
                        const double error = p.*m ? (*(p.*m)).error.*stress / MPa : not_known;
                        return std::isfinite(error) ? error : not_known;
                      }});
    }
  }
  for (std::size_t i = 0; i < most_pairs(solved); ++i) {
    const auto there = [i](const Position& p) { return i < p.pair_share.size() && i < p.pair_roll.size(); };
    list.push_back({fmt::format("pair{}_roll_mm", i + 1),
                    [i, there](const Position& p) { return there(p) ? p.pair_roll[i] / units::mm : not_known; }});
    list.push_back(
        {fmt::format("pair{}_share", i + 1), [i, there](const Position& p) { return there(p) ? p.pair_share[i] : 0; }});
  }
  return list;
}

}  // namespace

bool over_face_width(const fem::LoadedMeshResult& solved) { return solved.slice_edges.size() > 2; }

Csv position_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  const auto list = position_columns(model, solved);
  Csv csv;
  for (const auto& column : list) csv.columns.push_back(column.name);
  for (const auto& p : solved.positions) {
    auto& row = csv.rows.emplace_back();
    for (const auto& column : list) row.push_back(column.value(p));
  }
  return csv;
}

Csv pin_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase",    "ring_tooth", "ring_angle_deg", "pin",
                 "pin_angle_deg", "touching",   "radial_force_N", "tangential_force_N"};
  at_nominal_load(model, solved, [&](const fem::LoadedPosition& p) {
    for (std::size_t i = 0; i < p.pins.size(); ++i) {
      csv.rows.push_back({p.mesh_phase, static_cast<double>(p.ring_tooth), p.ring_angle / units::deg,
                          static_cast<double>(i + 1), solved.pin_angles.at(i) / units::deg,
                          p.pins[i].touching ? 1.0 : 0.0, p.pins[i].radial_force, p.pins[i].tangential_force});
    }
  });
  return csv;
}

Csv housing_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase", "ring_tooth", "ring_angle_deg", "tooth", "radial_force_N"};
  at_nominal_load(model, solved, [&](const fem::LoadedPosition& p) {
    for (std::size_t i = 0; i < p.housing.size(); ++i) {
      if (!p.housing[i].touching) continue;
      csv.rows.push_back({p.mesh_phase, static_cast<double>(p.ring_tooth), p.ring_angle / units::deg,
                          static_cast<double>(i), p.housing[i].radial_force});
    }
  });
  return csv;
}

Csv roller_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase", "ring_tooth", "angle_deg", "load_N_per_deg"};
  const double pitch = model.problem->pair.pinion().pitch_angle();
  // The ring mesh is solved in a mirror image.
  const double side = model.problem->pair.internal() ? -1 : 1;
  at_nominal_load(model, solved, [&](const fem::LoadedPosition& p) {
    std::vector<std::pair<double, double>> around;
    if (p.rollers.empty()) return;
    const auto patches = static_cast<double>(p.rollers.size());
    const double spacing = 2 * std::numbers::pi / patches;
    for (std::size_t i = 0; i < p.rollers.size(); ++i) {
      const double behind = (static_cast<double>(i) + 0.5) * spacing - pitch / 2;
      const double angle = std::remainder(p.pinion_angle + behind, 2 * std::numbers::pi);
      around.emplace_back(side * angle / units::deg, p.rollers[i] / (spacing / units::deg));
    }
    std::sort(around.begin(), around.end());
    for (const auto& [angle, load] : around)
      csv.rows.push_back({p.mesh_phase, static_cast<double>(p.ring_tooth), angle, load});
  });
  return csv;
}

Csv pressure_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase", "ring_tooth",  "pair",         "z_low_mm",
                 "z_high_mm",  "roll_low_mm", "roll_high_mm", "pressure_MPa"};
  at_nominal_load(model, solved, [&](const fem::LoadedPosition& p) {
    for (const auto& patch : p.pressure) {
      csv.rows.push_back({p.mesh_phase, static_cast<double>(p.ring_tooth), static_cast<double>(patch.pair + 1),
                          patch.z_low / units::mm, patch.z_high / units::mm, patch.roll_low / units::mm,
                          patch.roll_high / units::mm, patch.pressure / MPa});
    }
  });
  return csv;
}

Csv line_load_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase", "ring_tooth", "z_low_mm", "z_high_mm", "line_load_N_per_mm"};
  if (!over_face_width(solved)) return csv;
  const auto& edges = solved.slice_edges;
  at_nominal_load(model, solved, [&](const fem::LoadedPosition& p) {
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      csv.rows.push_back({p.mesh_phase, static_cast<double>(p.ring_tooth), edges[i] / units::mm,
                          edges[i + 1] / units::mm, p.line_load.at(i) * units::mm});
    }
  });
  return csv;
}

Csv stress_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"curve",         "mesh_phase",      "ring_tooth",     "ring_angle_deg", "load_N",
                 "arc_length_mm", "polar_angle_deg", "tangential_MPa", "von_mises_MPa"};
  for (std::size_t c = 0; c < solved.stress_curves.size(); ++c) {
    const auto& curve = solved.stress_curves[c];
    const auto& at = solved.positions.at(curve.position);
    const bool around = curve.along == fem::StressCurve::Along::rim;
    csv.header.emplace_back(fmt::format("curve_{}", c + 1), model.body_name(curve.body) + (around ? " rim" : " root"));
    for (std::size_t i = 0; i < curve.abscissa.size(); ++i) {
      csv.rows.push_back({static_cast<double>(c + 1), at.mesh_phase, static_cast<double>(at.ring_tooth),
                          at.ring_angle / units::deg, at.load, around ? not_known : curve.abscissa[i] / units::mm,
                          around ? curve.abscissa[i] / units::deg : not_known, curve.tangential.at(i) / MPa,
                          curve.von_mises.at(i) / MPa});
    }
  }
  return csv;
}

Csv gauge_table(const fem::LoadedMeshResult& solved) {
  constexpr double micro = 1e-6;
  Csv csv;
  if (solved.gauges.empty()) return csv;
  csv.columns = {"ring_angle_deg"};
  for (std::size_t g = 0; g < solved.gauges.size(); ++g) {
    csv.header.emplace_back(fmt::format("gauge_{}", g + 1), solved.gauges[g].name);
    csv.columns.push_back(fmt::format("gauge_{}_um_per_m", g + 1));
  }
  for (std::size_t i = 0; i < solved.gauges.front().angle.size(); ++i) {
    auto& row = csv.rows.emplace_back(1, solved.gauges.front().angle[i] / units::deg);
    for (const auto& gauge : solved.gauges) row.push_back(gauge.strain[i] / micro);
  }
  return csv;
}

}  // namespace annulus::app
