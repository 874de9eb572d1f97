#pragma once

#include "app/scene/scene_declare.h"
#include "app/systems/planetary/planetary_input.h"

/// What the declarations of all ring structures share.
namespace annulus::app {

/// Declares keys that one structure has: refused with others.
struct StructureKeys {
  Declarations<RingInput>& ring;
  Condition structure;  ///< where the keys apply

  template <class Member>
  Declared optional(const char* name, Member member, const char* meaning) const {
    return ring.key(name, member, meaning).only_if(structure);
  }
  template <class Member>
  Declared needed(const char* name, Member member, const char* meaning) const {
    return ring.key(name, member, meaning).needed_if(structure);
  }
};

}  // namespace annulus::app
