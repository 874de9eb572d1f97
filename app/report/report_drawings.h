#pragma once

#include <string>

#include "app/pair/pair_run.h"
#include "app/report/svg_section.h"
#include "app/stage/planetary_run.h"
#include "app/two_k_v/two_k_v_run.h"

/// Drawings of the gears to scale: how they stand together, their teeth in mesh, how the ring is made.
namespace annulus::app {

[[nodiscard]] std::string drawings_section(const RunResult& result);
[[nodiscard]] std::string drawings_section(const PairRunResult& result);
[[nodiscard]] std::string drawings_section(const TwoKVResult& result);

/// The transverse section of one ring's stage; `id` makes identifiers unique within a page.
[[nodiscard]] TransverseSection stage_section(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                              const std::string& id);

}  // namespace annulus::app
