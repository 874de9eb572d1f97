#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/plan/gear_geometry.h"
#include "app/plan/warning.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_schema.h"
#include "app/systems/planetary/planetary_input.h"
#include "core/figure.h"
#include "core/json.h"
#include "geometry/planetary.h"

/// Strain gauges on the ring: where the scene puts them, and what they show over a revolution of the carrier.
namespace annulus::app {

/// [[strain_gauge]]
[[nodiscard]] Table strain_gauge_table();
/// Names, rings and what a ring structure has no place for.
void check_strain_gauges(Scene& scene, std::vector<Problem>& problems);

/// The gauges on a ring, one per axial position, on a common face of this width (m).
[[nodiscard]] std::vector<fem::StrainGauge> gauges_on(const Scene& scene, const RingInput& ring, double face_width);
/// Whether any of them stands beside the middle of the face, or measures along the axis.
[[nodiscard]] bool gauges_need_solid(const Scene& scene, const RingInput& ring);
/// Adds a warning for each ring whose gauges show less than all planets together do.
void warn_of_gauges(std::vector<Warning>& list, const Scene& scene);

/// A strain with its largest and smallest value over a revolution of the carrier.
struct GaugeReading {
  std::string gauge;           ///< as in the scene, with the axial position where there are several
  std::size_t of = 0;          ///< index in Scene::strain_gauges
  std::vector<double> strain;  ///< at GaugeReadings::angle
  double largest = 0, smallest = 0;
  double error = 0;  ///< of either; NaN: not known

  [[nodiscard]] double range() const { return largest - smallest; }
};

/// What the gauges on one ring show while the carrier turns once against the ring.
struct GaugeReadings {
  std::vector<double> angle;  ///< rad, of planet 1 in the ring's frame, over one revolution
  std::vector<GaugeReading> gauges;

  /// K_H_beta as strain gauges measure it: of gauges of the scene with several axial positions the largest range over
  /// their mean one. Nothing of others.
  [[nodiscard]] std::optional<double> face_load_factor(std::size_t gauge) const;
};
/// Strain of each gauge (MeshResult::gauges, µm/m) under one planet over its turns against the ring, from the first row
/// of the table on: there the contact is in the pitch point of the first tooth.
[[nodiscard]] std::vector<PeriodicCurve> gauge_curves(const Csv& gauges);
/// Nothing without gauges. Every planet carries the mean mesh force, and its mesh strains the ring as if it were alone.
[[nodiscard]] std::optional<GaugeReadings> gauge_readings(const Scene& scene, const geometry::PlanetarySet& set,
                                                          const MeshResult& ring_mesh);

/// Results of all gauges on a ring together.
[[nodiscard]] std::vector<FigureSpec> gauge_figure_specs();
[[nodiscard]] FigureSet figures(const GaugeReadings& readings);

/// Frame of the readings: that of the ring, or of a stage that is computed as its mirror image.
enum class GaugeFrame { ring, mirrored };
/// strain_gauges.csv of a ring.
[[nodiscard]] Csv to_csv(const GaugeReadings& readings, GaugeFrame frame);
[[nodiscard]] Json to_json(const Scene& scene, const GaugeReadings& readings);

}  // namespace annulus::app
