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

/// All meshes of a run with a name for readers, the rings' first, then the sun's; the index is their colour.
[[nodiscard]] std::vector<std::pair<std::string, const MeshResult*>> all_meshes(const RunResult& result);
/// The same with the sun mesh first and each ring's named `ring_head` + its name, as tables list them.
[[nodiscard]] std::vector<std::pair<std::string, const MeshResult*>> sun_then_rings(const RunResult& result,
                                                                                    const std::string& ring_head);
/// The same with titles, the rings' meshes first.
[[nodiscard]] std::vector<std::pair<std::string, const MeshResult*>> titled_meshes(const RunResult& result);
/// The rings whose dynamics were asked for.
[[nodiscard]] std::vector<const RingResult*> rings_with_response(const RunResult& result);
/// One colour per planet.
[[nodiscard]] Legend planet_legend(int planets);
/// A line per planet in a plot per ring, all on one scale, read from a table of the response over its mesh cycles.
struct PlanetLines {
  std::function<const Csv&(const StageResponse&)> table;
  std::string stem;             ///< of the columns, before the number of the planet
  std::string line, low, high;  ///< suffixes of the columns; empty: none
  const char* y_label = "";
  double scale = 1;
  double cycles = shown_cycles;
  std::optional<double> level{};  ///< reference line, always in the range
};
[[nodiscard]] Pictures planet_lines(const RunResult& result, const PlanetLines& lines, const Text& caption);

// geometry.cc
[[nodiscard]] Section drawings_section(const RunResult& result);  ///< the gears to scale
/// The transverse section of one ring's stage; `id` makes identifiers unique within a page.
[[nodiscard]] TransverseSection stage_section(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                              const std::string& id);
// key_figures.cc
[[nodiscard]] Blocks stage_verdict(const RunResult& result);  ///< what came out, in plain words
[[nodiscard]] Section key_figures_section(const RunResult& result);
[[nodiscard]] Section comparison_section(const RunResult& result);  ///< with the published results
// stiffness.cc
[[nodiscard]] Section stiffness_section(const RunResult& result);  ///< transmission error, stiffness, shares
// supports.cc, contact.cc
[[nodiscard]] Section supports_section(const RunResult& result);  ///< pins, bolts and splines
[[nodiscard]] Section contact_section(const RunResult& result);   ///< face width, pressure, stress
// load_sharing.cc, coupling.cc, motion.cc, modes.cc
[[nodiscard]] Section dynamics_section(const RunResult& result);  ///< load sharing, dynamic factors, spectra
[[nodiscard]] Section coupling_section(const RunResult& result);  ///< of the planets through the ring
[[nodiscard]] Section motion_section(const RunResult& result);    ///< bearing forces, sun orbit, Poincaré section
[[nodiscard]] Section modes_section(const RunResult& result);     ///< frequencies, shapes, Campbell diagram
// quality.cc
[[nodiscard]] Section quality_section(const RunResult& result);  ///< invariants, timings, versions

}  // namespace annulus::app
