#pragma once

#include <string>
#include <vector>

namespace annulus::benchmark {

/// A stage on which the promise of a wanted accuracy is tried.
struct PromiseScene {
  std::string name;
  std::string what;  ///< for people
  std::string text;  ///< the scene file
};
[[nodiscard]] std::vector<PromiseScene> promise_scenes();

}  // namespace annulus::benchmark
