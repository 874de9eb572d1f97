#pragma once

#include <string>

#include "app/model/mesh_result.h"
#include "app/results/content_id.h"
#include "app/scene/scene.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/mesh_excitation.h"

/// What lumped models of several kinds take from a scene and its meshes.
namespace annulus::app {

/// How the lumped model sees a mesh: the wave the scene gives, or the curves of its table at the nominal load (N) or
/// over all of them.
[[nodiscard]] dynamics::MeshExcitation excitation_of(const MeshInput& input, const MeshResult& mesh,
                                                     double nominal_load, dynamics::LoadDependence dependence);
/// Adds everything an excitation depends on: its parameters, or the numbers and errors of its table and whether all
/// loads are taken.
void add_excitation(ContentId& id, const std::string& name, const dynamics::MeshExcitation& excitation,
                    const StiffnessTable& table);

/// What [dynamics] says of the integration, whatever the kind of stage; fixed steps are counted per cycle of this
/// frequency (Hz).
[[nodiscard]] dynamics::SimulationOptions given_simulation(const DynamicsInput& input, double mesh_frequency);
/// Adds all options that a response depends on; its start is not among them.
void add_simulation(ContentId& id, const dynamics::SimulationOptions& options);

}  // namespace annulus::app
