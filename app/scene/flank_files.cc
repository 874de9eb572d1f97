#include "app/scene/flank_files.h"

#include <utility>

#include "app/scene/key_checks.h"
#include "app/scene/scene_files.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

class FlankFiles : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    const auto read = [this](const std::string& table, GearInput& gear, const Entry& entry = std::size_t{0}) {
      gear.leading_flank = flank(table + ".left_topography", gear.left_topography, entry);
      gear.trailing_flank = flank(table + ".right_topography", gear.right_topography, entry);
    };
    read("sun", scene_.sun);
    read("planet", scene_.planet);
    read("pinion", scene_.pinion);
    read("wheel", scene_.wheel);
    for (auto& ring : scene_.rings) read("ring", ring, ring.name);
  }

 private:
  std::shared_ptr<const geometry::FlankTopography> flank(const std::string& key, const std::optional<std::string>& name,
                                                         const Entry& entry) {
    if (!name) return nullptr;
    try {
      if (scene_.fidelity == Fidelity::closed_form || scene_.fidelity == Fidelity::resolved)
        throw InputError(
            "formulas and resolved models do not cover measured flanks; use model = \"automatic\", \"plane\" or "
            "\"solid\"");
      return std::make_shared<const geometry::FlankTopography>(
          geometry::read_flank_topography(file_below_scene(scene_, *name)));
    } catch (const InputError& error) {
      problem(key, entry, error.what());
      return nullptr;
    }
  }
};

}  // namespace

void read_flank_files(Scene& scene, std::vector<Problem>& problems) { FlankFiles(scene, problems).run(); }

}  // namespace annulus::app
