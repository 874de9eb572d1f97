#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

/// What the scene of a train has of its own.
struct TrainInput {
  struct Part {
    std::string name, file;
    std::shared_ptr<const Scene> scene{};  ///< that file, read; null where it could not be
  };
  struct Shaft {
    std::string name, from, to;             ///< ends: "part.body"
    double stiffness = 0;                   ///< N m/rad
    std::optional<double> damping_ratio{};  ///< absent: that of the supports
    double backlash = 0;                    ///< rad, the whole of it
  };
  std::vector<Part> parts;
  std::vector<Shaft> shafts;
  double speed_factor = 1;
};

[[nodiscard]] std::vector<Table> train_tables();
/// Reads the scenes of the parts; checks names and ends of shafts.
void check_train_scene(Scene& scene, std::vector<Problem>& problems);

/// "first.sun" -> {"first", "sun"}; both empty for a text without a dot.
[[nodiscard]] std::pair<std::string, std::string> part_and_body(const std::string& end);

}  // namespace annulus::app
