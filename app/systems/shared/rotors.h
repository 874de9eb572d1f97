#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"
#include "dynamics/system/drive_line.h"

namespace annulus::app {

/// [[rotor]]: inertias beside the gear set, at the ends of shafts. For every kind whose stage has rotors.
[[nodiscard]] Table rotor_table();
/// Their names, where their shafts lead to, and check_ripple_lists.
void check_rotors(Scene& scene, std::vector<Problem>& problems, const std::vector<dynamics::ShaftEnd>& ends);
/// A torque, and a phase where any is given, for every order.
void check_ripple_lists(Scene& scene, std::vector<Problem>& problems);
/// The rotors of a scene with [dynamics].
[[nodiscard]] std::vector<dynamics::Rotor> rotors_of(const Scene& scene);

}  // namespace annulus::app
