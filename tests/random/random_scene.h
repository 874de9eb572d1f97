#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/random/scene_draft.h"

namespace annulus::random {

struct RandomScene {
  std::uint64_t seed = 0;
  std::string kind, model;
  SceneDraft draft;
  std::string more{};                                        ///< further tables, as text
  std::vector<std::pair<std::string, std::string>> files{};  ///< beside the scene: their names and texts

  [[nodiscard]] std::string toml() const;
};

/// The scene of a seed: gears that mesh, and every other key drawn from the declarations of the schema, with their
/// conditions. Some are refused by the checks of the program, as a user's are.
[[nodiscard]] RandomScene random_scene(std::uint64_t seed);

/// A train of two pairs, each a scene of its own, with a shaft between them.
[[nodiscard]] RandomScene random_train(std::uint64_t seed);
/// What a campaign draws: a train for one seed in sixteen.
[[nodiscard]] RandomScene scene_of_campaign(std::uint64_t seed);

/// Keys that no scene draws: `{"title", "a text"}`, with the reason.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& undrawn_keys();

}  // namespace annulus::random
