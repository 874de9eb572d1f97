#pragma once

#include <optional>

#include "app/model/mesh_result.h"
#include "app/scene/scene.h"
#include "dynamics/modes/structural_damping.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/mesh_excitation.h"

/// What lumped models of several kinds take from a scene and its meshes.
namespace annulus::app {

/// How the lumped model sees a mesh: the wave the scene gives, or the curves of its table at the nominal load (N) or
/// over all of them. `back_flank_phase`: that of the pair; back flanks have no other table, so that they have the
/// mirror image of this one. Where it changes from tooth to tooth, that is right for the teeth, but the supports of the
/// ring are then mirrored too, and stand elsewhere (propagated_errors.h).
[[nodiscard]] dynamics::MeshExcitation excitation_of(const MeshInput& input, const MeshResult& mesh,
                                                     double nominal_load, dynamics::LoadDependence dependence,
                                                     std::optional<double> back_flank_phase = {});
/// The table that an excitation was made from, as an input of identities: without its provenance. Nothing where the
/// scene prescribes the stiffness.
[[nodiscard]] std::optional<StiffnessTable> table_behind(const dynamics::MeshExcitation& excitation,
                                                         const StiffnessTable& table);

[[nodiscard]] dynamics::StructuralDamping structural_damping(const DynamicsInput& input);

/// What [dynamics] says of the integration, whatever the kind of stage; fixed steps are counted per cycle of this
/// frequency (Hz).
[[nodiscard]] dynamics::SimulationOptions given_simulation(const DynamicsInput& input, double mesh_frequency);
/// The same with what the wanted accuracy asks of the motion (motion_choice). Needs [dynamics].
[[nodiscard]] dynamics::SimulationOptions accurate_simulation(const Scene& scene, double mesh_frequency);

}  // namespace annulus::app
