#pragma once

#include "app/model/gear_system.h"

namespace annulus::app {

/// A gear system to copy: pinion and wheel on rigid bearings, whose teeth are a torsional spring. It has everything
/// that a kind needs and nothing else: scene tables, checks, meshes, a lumped model and its results. Tests compile and
/// run it; the program does not contain it.
[[nodiscard]] SystemKind torsional_pair_kind();

}  // namespace annulus::app
