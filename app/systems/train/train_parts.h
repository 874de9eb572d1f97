#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "app/model/gear_system.h"
#include "app/systems/train/train_scene.h"
#include "dynamics/systems/train/train.h"

namespace annulus::app {

/// A part at the operating point of its train, with the accuracy of the train.
struct WorkingPart {
  std::string name;
  std::unique_ptr<const Scene> scene;
  std::unique_ptr<const GearSystem> system;  ///< of this scene
};

/// The parts of a train, each with the speed and torque that follow from the first one through the shafts. Throws
/// InputError for parts that no shaft reaches, for ends of shafts without speed or torque, for shafts whose ends both
/// deliver or both take the power, and for speeds and torques that a part cannot have.
[[nodiscard]] std::vector<WorkingPart> working_parts(const Scene& scene);

/// The bodies of a gear set to which shafts can lead.
[[nodiscard]] std::vector<dynamics::ShaftEnd> shaft_ends(const GearSystem& system);
/// What is wrong with a part, with the key and the part in front.
[[nodiscard]] std::string fault_of_part(const std::string& part, const std::exception& error);

/// The stiffness of the meshes of each part, from those of all parts one behind the other.
[[nodiscard]] std::vector<std::vector<const MeshResult*>> tables_of_parts(const std::vector<WorkingPart>& parts,
                                                                          const std::vector<const MeshResult*>& tables);
/// The train on the stiffness of its meshes, which are referred to.
[[nodiscard]] dynamics::Train make_train(const Scene& scene, const std::vector<WorkingPart>& parts,
                                         const std::vector<const MeshResult*>& tables);
/// The same before anything is solved.
[[nodiscard]] dynamics::Train rough_train(const Scene& scene, const std::vector<WorkingPart>& parts);

}  // namespace annulus::app
