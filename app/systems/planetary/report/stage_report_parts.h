#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/drawings/transverse_section.h"
#include "app/report/page.h"
#include "app/sections/report_parts.h"
#include "app/systems/planetary/planetary_run.h"

/// The sections of a planetary stage's report.
namespace annulus::app {

/// The meshes of the rings, then that of the sun.
[[nodiscard]] NamedMeshes named_meshes(const RunResult& result);
/// The responses of the rings whose dynamics were asked for.
using NamedResponses = std::vector<std::pair<std::string, const StageResponse*>>;
[[nodiscard]] NamedResponses responses_of(const RunResult& result);
/// One colour per planet.
[[nodiscard]] Legend planet_legend(int planets);

// load_sharing.cc
/// A line per planet in a plot per ring, all on one scale, read from a table of the response over its mesh cycles.
/// Names of the kinds of meshes, for the reader's choice.
inline constexpr const char *sun_meshes = "sun meshes", *ring_meshes = "ring meshes";

struct PlanetLines {
  std::function<const Csv&(const StageResponse&)> table;
  std::string mesh, line{}, low{}, high{};  ///< of the columns: head, and tails behind the number of the planet
  const char* y_label = "";
  double cycles = shown_cycles, scale = 1;
  std::optional<double> level = 1;  ///< reference line
};
[[nodiscard]] Pictures planet_lines(const RunResult& result, const PlanetLines& shown, const Text& caption);

// tolerances.cc
[[nodiscard]] Section tolerances_section(const RunResult& result);  ///< K_γ of assemblies within the tolerances

// geometry.cc
[[nodiscard]] Section drawings_section(const RunResult& result);  ///< the gears to scale
/// The transverse section of one ring's stage; `id` makes identifiers unique within a page.
[[nodiscard]] TransverseSection stage_section(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                              const std::string& id);
// answers.cc
[[nodiscard]] Blocks stage_verdict(const RunResult& result);        ///< what came out, in plain words
[[nodiscard]] Section comparison_section(const RunResult& result);  ///< with the published results
// rollers.cc
[[nodiscard]] Section rollers_section(const RunResult& result);  ///< of planets whose bore is a raceway
// supports.cc
[[nodiscard]] Section supports_section(const RunResult& result);  ///< pins, bolts and splines
// strain_gauges.cc
[[nodiscard]] Section strain_gauges_section(const RunResult& result);  ///< strains over a revolution of the carrier
// load_sharing.cc, coupling.cc, motion.cc, modes.cc
[[nodiscard]] Section dynamics_section(const RunResult& result);  ///< load sharing, dynamic factors, spectra
[[nodiscard]] Section coupling_section(const RunResult& result);  ///< of the planets through the ring
[[nodiscard]] Section motion_section(const RunResult& result);    ///< bearing forces, sun orbit, Poincaré section
[[nodiscard]] Section modes_section(const RunResult& result);     ///< frequencies, shapes, Campbell diagram

}  // namespace annulus::app
