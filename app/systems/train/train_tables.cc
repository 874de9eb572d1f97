#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "app/model/gear_system.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_declare.h"
#include "app/scene/scene_files.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/train/train_scene.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

TrainInput& input_of(Scene& scene) { return scene.own<TrainInput>(); }

template <class Section>
Declarations<Section> declare_list(const char* path, const char* meaning, std::vector<Section> TrainInput::*list) {
  return Declarations<Section>(
      path, meaning, [list](Scene& s, std::size_t i) -> Section& { return (input_of(s).*list).at(i); },
      [list](Scene& s, std::size_t n) { (input_of(s).*list).resize(n); });
}

Table train_stage_table() {
  Declarations<TrainInput> stage("stage", "", [](Scene& s, std::size_t) -> TrainInput& { return input_of(s); });
  stage.key("speed_factor", &TrainInput::speed_factor, "Speeds of the train over those of the scene of its first part.")
      .fallback(1.0, "as in that scene")
      .above(0, 1e6);
  return stage.done();
}

Table part_table() {
  auto part = declare_list("part",
                           "A gear set of the train, by a scene of its own. The first one states speed and torque; "
                           "those of the others follow through the shafts.",
                           &TrainInput::parts);
  part.key("name", &TrainInput::Part::name, "Name in results, and of the folder of its results.").required();
  part.key("file", &TrainInput::Part::file,
           "Scene of the part, with [dynamics] and a single ring; a path relative to this scene, in its folder or "
           "below. Its studies are left out.")
      .required();
  return part.done();
}

Table shaft_table() {
  auto shaft = declare_list("shaft", "A shaft between two parts.", &TrainInput::shafts);
  shaft.key("name", &TrainInput::Shaft::name, "Name in results.").required();
  for (const auto& [key, member] : {std::pair{"from", &TrainInput::Shaft::from}, {"to", &TrainInput::Shaft::to}})
    shaft
        .key(key, member,
             "One of its ends: part and body, such as \"first.sun\". Bodies: sun, carrier, ring; pinion, wheel; input, "
             "output.")
        .required();
  shaft.key("stiffness_Nm_per_rad", &TrainInput::Shaft::stiffness, "Torsional stiffness with its couplings.")
      .required()
      .above(0, 1e14);
  shaft
      .key("damping_ratio", &TrainInput::Shaft::damping_ratio,
           "Damping ratio ζ: c = 2ζ√(k J), 1/J = 1/J₁ + 1/J₂ of the bodies at its ends.")
      .from(0, 2)
      .absent("dynamics.support_damping_ratio");
  shaft.key("backlash_deg", &TrainInput::Shaft::backlash, "Free rotation in its couplings, from one side to the other.")
      .fallback(0.0, "couplings without backlash")
      .from(0, 360);
  return shaft.done();
}

/// While the scene of a part is read: a train in it could contain itself.
class PartBeingRead {
 public:
  PartBeingRead() { any() = true; }
  ~PartBeingRead() { any() = false; }
  PartBeingRead(const PartBeingRead&) = delete;
  PartBeingRead& operator=(const PartBeingRead&) = delete;
  static bool& any() {
    thread_local bool reading = false;
    return reading;
  }
};

class TrainChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    if (PartBeingRead::any()) return problem("stage.kind", "cannot be that of a part");
    if (!scene_.dynamics) problems_.push_back({0, 0, "dynamics: the table is missing; a train is a lumped model"});
    auto& input = input_of(scene_);
    for (std::size_t i = 0; i < input.parts.size(); ++i) {
      name(input, i);
      if (usable("part.file", i)) read(input.parts[i], i);
    }
    for (std::size_t i = 0; i < input.shafts.size(); ++i) {
      for (const auto& [key, end] : {std::pair{"shaft.from", &input.shafts[i].from}, {"shaft.to", &input.shafts[i].to}})
        if (usable(key, i)) place(key, i, *end);
    }
  }

 private:
  void name(const TrainInput& input, std::size_t i) {
    if (!usable("part.name", i)) return;
    const auto& name = input.parts[i].name;
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    if (name.empty() || name.find_first_not_of(letters) != std::string::npos)
      return problem("part.name", i, "may consist of letters, digits, _ and - alone");
    for (std::size_t k = 0; k < i; ++k)
      if (input.parts[k].name == name) return problem("part.name", i, fmt::format("'{}' is used for two parts", name));
  }

  void read(TrainInput::Part& part, std::size_t i) {
    try {
      const auto file = file_below_scene(scene_, part.file);
      {
        const PartBeingRead reading;
        part.scene = std::make_shared<const Scene>(read_scene(file));
      }
      const auto& read = *part.scene;
      const auto folder = std::filesystem::path(part.file).parent_path();
      for (const auto& name : input_files(read)) scene_.further_files.push_back((folder / name).string());
      const auto system = make_system(read);
      if (system->variants().size() != 1)
        problem("part.file", i, fmt::format("has {} rings; a part of a train has one", system->variants().size()));
      else if (!read.dynamics)
        problem("part.file", i, "has no [dynamics]");
      else if (system->turning_bodies().empty())
        problem("part.file", i, fmt::format("is of the kind {}, which cannot be part of a train", read.stage.kind));
      else
        return;
    } catch (const Error& error) {
      problem("part.file", i, error.what());
    }
    part.scene = nullptr;
  }

  void place(const char* key, std::size_t i, const std::string& end) {
    const auto [name, body] = part_and_body(end);
    std::vector<std::string> ends;
    for (const auto& part : input_of(scene_).parts) {
      if (!part.scene) return;  // said already
      for (const auto& turning : make_system(*part.scene)->turning_bodies())
        ends.push_back(part.name + "." + turning.name);
    }
    if (std::find(ends.begin(), ends.end(), end) == ends.end())
      problem(key, i, fmt::format("'{}' must be one of {}", end, fmt::join(ends, ", ")));
  }
};

}  // namespace

std::vector<Table> train_tables() { return {train_stage_table(), part_table(), shaft_table(), rotor_table()}; }

void check_train_scene(Scene& scene, std::vector<Problem>& problems) { TrainChecker(scene, problems).run(); }

std::pair<std::string, std::string> part_and_body(const std::string& end) {
  const auto dot = end.find('.');
  if (dot == std::string::npos) return {};
  return {end.substr(0, dot), end.substr(dot + 1)};
}

}  // namespace annulus::app
