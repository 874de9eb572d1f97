#include "app/model/mesh_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

bool over_face_width(const fem::LoadedMeshResult& solved) { return solved.slice_edges.size() > 2; }

/// Visits the positions at the nominal load.
template <class Visit>
void at_nominal_load(const MeshModel& model, const fem::LoadedMeshResult& solved, Visit visit) {
  const double nominal = model.problem->loads[model.nominal_load()];
  for (const auto& p : solved.positions) {
    if (p.load == nominal) visit(p);
  }
}

/// The columns of one body's largest stresses, for all positions or none.
class StressColumns {
 public:
  using Member = std::optional<fem::BodyStress> fem::LoadedPosition::*;

  StressColumns(std::string body, Member member, const fem::LoadedMeshResult& solved)
      : body_(std::move(body)),
        member_(member),
        there_(std::any_of(solved.positions.begin(), solved.positions.end(),
                           [&](const auto& p) { return (p.*member).has_value(); })) {}

  void name(std::vector<std::string>& columns) const {
    if (!there_) return;
    for (const auto* place : {"root", "rim"}) {
      for (const auto* kind : {"tension", "compression", "von_mises"})
        columns.push_back(fmt::format("{}_{}_{}_MPa", body_, place, kind));
    }
  }

  void fill(std::vector<double>& row, const fem::LoadedPosition& position) const {
    if (!there_) return;
    const auto& stress = position.*member_;
    if (!stress) return row.insert(row.end(), 6, not_known), void();
    for (const double value : {stress->root_tension, stress->root_compression, stress->root_von_mises,
                               stress->rim_tension, stress->rim_compression, stress->rim_von_mises})
      row.push_back(value / MPa);
  }

 private:
  std::string body_;
  Member member_;
  bool there_;
};

}  // namespace

Csv position_table(const MeshModel& model, const fem::LoadedMeshResult& solved) {
  Csv csv;
  csv.columns = {"mesh_phase",
                 "ring_tooth",
                 "ring_angle_deg",
                 "load_N",
                 "unloaded_te_um",
                 "lte_um",
                 "error_um",
                 "error_discretisation_um",
                 "error_local_contact_um",
                 "error_condensation_um",
                 "error_model_choice_um",
                 "max_pressure_MPa",
                 "tip_edge_contact",
                 "force_balance_relative",
                 "energy_balance_relative",
                 "max_penetration_um"};
  const bool face_load = over_face_width(solved);
  if (face_load) csv.columns.emplace_back("face_load_factor");
  const StressColumns planet("planet", &fem::LoadedPosition::planet_stress, solved),
      wheel(model.wheel_body, &fem::LoadedPosition::wheel_stress, solved);
  planet.name(csv.columns);
  wheel.name(csv.columns);
  const std::size_t pairs = most_pairs(solved);
  for (std::size_t i = 1; i <= pairs; ++i) {
    csv.columns.push_back(fmt::format("pair{}_roll_mm", i));
    csv.columns.push_back(fmt::format("pair{}_share", i));
  }
  for (const auto& p : solved.positions) {
    const double deflection = p.entry.lte - p.entry.unloaded_te;
    std::vector<double> row = {p.mesh_phase,
                               static_cast<double>(p.ring_tooth),
                               p.ring_angle / units::deg,
                               p.load,
                               p.entry.unloaded_te / units::um,
                               p.entry.lte / units::um,
                               std::abs(p.entry.error_relative * deflection) / units::um,
                               std::abs(p.entry.error_parts.discretisation * deflection) / units::um,
                               std::abs(p.entry.error_parts.contact * deflection) / units::um,
                               std::abs(p.entry.error_parts.condensation * deflection) / units::um,
                               std::abs(p.entry.error_parts.model * deflection) / units::um,
                               p.max_pressure / MPa,
                               p.tip_edge_contact ? 1.0 : 0.0,
                               p.force_balance_relative,
                               p.energy_balance_relative,
                               p.max_penetration / units::um};
    if (face_load) row.push_back(p.face_load_factor);
    planet.fill(row, p);
    wheel.fill(row, p);
    for (std::size_t i = 0; i < pairs; ++i) {
      const bool there = i < p.pair_share.size() && i < p.pair_roll.size();
      row.push_back(there ? p.pair_roll[i] / units::mm : not_known);
      row.push_back(there ? p.pair_share[i] : 0);
    }
    csv.rows.push_back(std::move(row));
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
    const bool around = curve.name.ends_with("rim");
    const bool of_wheel = curve.name.starts_with("wheel");
    csv.header.emplace_back(fmt::format("curve_{}", c + 1),
                            of_wheel ? model.wheel_body + curve.name.substr(5) : curve.name);
    for (std::size_t i = 0; i < curve.abscissa.size(); ++i) {
      csv.rows.push_back({static_cast<double>(c + 1), at.mesh_phase, static_cast<double>(at.ring_tooth),
                          at.ring_angle / units::deg, at.load, around ? not_known : curve.abscissa[i] / units::mm,
                          around ? curve.abscissa[i] / units::deg : not_known, curve.tangential.at(i) / MPa,
                          curve.von_mises.at(i) / MPa});
    }
  }
  return csv;
}

}  // namespace annulus::app
