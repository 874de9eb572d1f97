#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "app/model/gear_system.h"
#include "app/results/result_folder.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_declare.h"
#include "app/scene/scene_files.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/train/train_parts.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

Table train_stage_table() {
  Declarations<TrainInput> stage("stage", "");
  stage.key("speed_factor", &TrainInput::speed_factor, "Speeds of the train over those of the scene of its first part.")
      .fallback(1.0, "as in that scene")
      .above(0, 1e6);
  return stage.done();
}

Table part_table() {
  Declarations part("part",
                    "A gear set of the train, by a scene of its own. The first one states speed and torque; "
                    "those of the others follow through the shafts.",
                    &TrainInput::parts);
  part.key("name", &TrainInput::Part::name, "Name in results, and of the folder of its results.").required();
  part.key("file", &TrainInput::Part::file,
           "Scene of the part, with [dynamics] and a single ring; a path relative to this scene, in its folder or "
           "below. Its studies are left out, and the accuracy is that of the train.")
      .required();
  return part.done();
}

Table shaft_table() {
  Declarations shaft("shaft", "A shaft between two parts.", &TrainInput::shafts);
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
    auto& input = scene_.own<TrainInput>();
    for (std::size_t i = 0; i < input.parts.size(); ++i) {
      name("part.name", "parts", input.parts, i);
      if (usable("part.name", i) && is_name_of_run(input.parts[i].name))
        problem("part.name", i, "is the name of a file or folder that a run writes itself; choose another one");
      if (usable("part.file", i)) read(input.parts[i], i);
    }
    for (std::size_t i = 0; i < input.shafts.size(); ++i) name("shaft.name", "shafts", input.shafts, i);
    const bool all_read =
        std::all_of(input.parts.begin(), input.parts.end(), [](const auto& part) { return part.scene != nullptr; });
    if (all_read)
      places(input);
    else
      check_ripple_lists(scene_, problems_);
  }

 private:
  template <class Named>
  void name(const char* key, const char* what, const std::vector<Named>& list, std::size_t i) {
    simple_name(key, i, list[i].name);
    for (std::size_t k = 0; k < i; ++k)
      if (usable(key, i) && list[k].name == list[i].name)
        return problem(key, i, fmt::format("'{}' is used for two {}", list[i].name, what));
  }

  /// Where shafts and rotors lead to.
  void places(const TrainInput& input) {
    dynamics::Train train;
    for (const auto& part : input.parts) train.parts.push_back({part.name, {}, shaft_ends(*make_system(*part.scene))});
    for (std::size_t i = 0; i < input.shafts.size(); ++i) {
      const auto& shaft = input.shafts[i];
      for (const auto& [key, end] : {std::pair{"shaft.from", &shaft.from}, {"shaft.to", &shaft.to}})
        if (usable(key, i)) place(key, i, *end, train.shaft_ends());
      const auto [from, from_body] = part_and_body(shaft.from);
      const auto [to, to_body] = part_and_body(shaft.to);
      train.shafts.push_back({shaft.name, {from, from_body}, {to, to_body}});
    }
    check_rotors(scene_, problems_, train.shaft_ends());
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
      else if (!read.rotors.empty())
        problem("part.file", i, "has rotors of its own; give them to the train, on \"part.body\"");
      else if (system->turning_bodies().empty())
        problem("part.file", i, fmt::format("is of the kind {}, which cannot be part of a train", read.stage.kind));
      else
        return;
    } catch (const Error& error) {
      problem("part.file", i, error.what());
    }
    part.scene = nullptr;
  }

  void place(const char* key, std::size_t i, const std::string& end, const std::vector<dynamics::ShaftEnd>& ends) {
    std::vector<std::string> names;
    for (const auto& known : ends) {
      if (known.name != end) {
        names.push_back(known.name);
        continue;
      }
      if (!known.refusal.empty())
        problem(key, i, fmt::format("no other shaft can lead to '{}': {}", end, known.refusal));
      return;
    }
    problem(key, i, fmt::format("'{}' must be one of {}", end, fmt::join(names, ", ")));
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
