#pragma once

#include <string>
#include <utility>

#include "app/plan/mesh_model.h"
#include "core/csv.h"
#include "fem/loaded_mesh.h"

/// The files of one solved mesh as tables: units in the column names, tooth pairs and pins counted from 1, the wheel
/// called sun or ring. A table of something the solution does not have is empty.
namespace annulus::app {

/// Stresses of a body by their names in columns, "sun_root_tension_MPa".
inline constexpr std::pair<const char*, double fem::BodyStress::*> stress_columns[] = {
    {"root_tension", &fem::BodyStress::root_tension},       {"root_compression", &fem::BodyStress::root_compression},
    {"root_von_mises", &fem::BodyStress::root_von_mises},   {"rim_tension", &fem::BodyStress::rim_tension},
    {"rim_compression", &fem::BodyStress::rim_compression}, {"rim_von_mises", &fem::BodyStress::rim_von_mises}};

/// The estimated error of the largest one, Pa, among MeshResult::facts.
[[nodiscard]] inline std::string stress_error_fact(const std::string& body, const std::string& stress) {
  return body + "_" + stress + "_error_Pa";
}

/// That of the largest face load factor; only of bodies that are divided along their face.
inline constexpr const char* face_load_factor_error = "face_load_factor_error";
[[nodiscard]] bool over_face_width(const fem::LoadedMeshResult& solved);

/// lte_<mesh>.csv: every position and load, with load shares and invariants, and the face load factor and the largest
/// stresses where they are known.
[[nodiscard]] Csv position_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// pins_<mesh>.csv: state of every pin, bolt or spline tooth at the nominal load.
[[nodiscard]] Csv pin_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// housing_<mesh>.csv: force on the housing bore behind every ring tooth (numbered from 0) where the rim touches it, at
/// the nominal load.
[[nodiscard]] Csv housing_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// rollers_<mesh>.csv: load of the rollers of a planet around its bore, over the angle from the direction away from the
/// axis of the stage, at the nominal load.
[[nodiscard]] Csv roller_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// pressure_<mesh>.csv: mean pressure on the touching pieces of the flanks at the nominal load.
[[nodiscard]] Csv pressure_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// line_load_<mesh>.csv: load over the face width at the nominal load; empty when there is a single slice.
[[nodiscard]] Csv line_load_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// stress_<mesh>.csv: stress along tooth roots and rim, each where its largest von Mises stress occurs. The header
/// names the curves: `curve_1: planet root`.
[[nodiscard]] Csv stress_table(const MeshModel& model, const fem::LoadedMeshResult& solved);
/// gauges_<mesh>.csv: the strain of every gauge while this mesh alone, at the nominal load, moves once around the
/// wheel. The header names the gauges.
[[nodiscard]] Csv gauge_table(const fem::LoadedMeshResult& solved);

}  // namespace annulus::app
