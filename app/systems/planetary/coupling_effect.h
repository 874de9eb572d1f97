#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/rim_coupling.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// What the coupling of the meshes through the ring does to the response: the same stage integrated over the same time
/// from the same kind of start, without coupling, with the static one, and with the elastic modes of the ring besides.
/// Integrated in all three cases because moving modes repeat only with the whole ring.
struct CouplingEffect {
  struct Row {
    RimCoupling model = RimCoupling::none;
    double averaged = 0, instantaneous = 0, quasi_static = 0;  ///< load sharing of the sun meshes
    double sun_factor = 0, ring_factor = 0;                    ///< largest peak factors
  };
  std::vector<Row> rows;  ///< none, static, and elastic when there are modes; without those that failed
  int cycles = 0;         ///< mesh cycles evaluated
};

[[nodiscard]] CouplingEffect coupling_effect(const dynamics::PlanetaryStage& uncoupled, const SolvedCoupling& solved,
                                             const dynamics::SimulationOptions& options);

inline constexpr const char* effect_file = "rim_coupling.csv";

void save(const CouplingEffect& effect, const std::string& id, const std::filesystem::path& folder);

}  // namespace annulus::app
