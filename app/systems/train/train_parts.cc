#include "app/systems/train/train_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "app/scene/overrides.h"
#include "app/systems/shared/rotors.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// The scene with this accuracy, and with all speeds and torques that it states multiplied.
Scene at_work(const Scene& own, double accuracy, double speed, double torque) {
  std::vector<Override> overrides;
  for (const auto& input : own.inputs) {
    if (input.origin != Origin::scene || !std::holds_alternative<double>(input.value)) continue;
    if (!input.key.starts_with("stage.") && !input.key.starts_with("output.")) continue;
    const bool turns = input.key.ends_with("_rpm"), pushes = input.key.ends_with("_Nm"),
               works = input.key.ends_with("_kW");
    if (turns || pushes || works)
      overrides.push_back({input.key, (turns || works ? speed : 1) * (pushes || works ? torque : 1), true});
  }
  auto changed = with_overrides(with_accuracy(own, accuracy, "that of the train"), overrides);
  // A changed scene has no assumptions of its own; here they are still those of the results.
  for (auto& input : changed.inputs)
    for (const auto& original : own.inputs)
      if (original.key == input.key && original.variant == input.variant && original.entry == input.entry)
        input.assumed = original.assumed;
  return changed;
}

const TurningBody& body_of(const std::vector<TurningBody>& bodies, const std::string& name) {
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& body) { return body.name == name; });
  require(found != bodies.end(), "the ends of shafts were checked");
  return *found;
}

}  // namespace

std::vector<WorkingPart> working_parts(const Scene& scene) {
  const auto input = scene.own<TrainInput>();
  std::map<std::string, std::vector<TurningBody>> bodies;  // as in their own scenes
  std::map<std::string, std::pair<double, double>> factors;
  for (const auto& part : input.parts) bodies[part.name] = make_system(*part.scene)->turning_bodies();
  factors[input.parts.front().name] = {input.speed_factor, 1};
  for (std::size_t before = 0; before != factors.size();) {
    before = factors.size();
    for (const auto& shaft : input.shafts)
      for (const auto& [from, to] : {std::pair{shaft.from, shaft.to}, {shaft.to, shaft.from}}) {
        const auto [known, driver] = part_and_body(from);
        const auto [next, driven] = part_and_body(to);
        if (factors.count(known) == 0 || factors.count(next) > 0) continue;
        const auto &a = body_of(bodies[known], driver), &b = body_of(bodies[next], driven);
        const auto [speed, torque] = factors[known];
        for (const auto& [end, body] : {std::pair{from, &a}, {to, &b}})
          if (body->speed == 0 || body->torque == 0)
            throw InputError(
                fmt::format("shaft.from: shaft '{}': '{}' turns at {:.7g} r/min with {:.7g} N m in its own "
                            "scene; both must differ from 0, because speeds and torques of the train follow "
                            "from them",
                            shaft.name, end, body->speed / units::rpm, body->torque));
        if (a.speed * a.torque * b.speed * b.torque > 0)
          throw InputError(
              fmt::format("shaft.from: shaft '{}': '{}' and '{}' both {} power; let one of the parts turn "
                          "the other way or work the other way round",
                          shaft.name, from, to, a.speed * a.torque > 0 ? "take up" : "deliver"));
        factors[next] = {speed * std::abs(a.speed / b.speed), torque * std::abs(a.torque / b.torque)};
      }
  }
  std::vector<WorkingPart> parts;
  for (const auto& part : input.parts) {
    if (factors.count(part.name) == 0)
      throw InputError(
          fmt::format("part.name: no shaft connects part '{}' with '{}'", part.name, input.parts.front().name));
    const auto [speed, torque] = factors[part.name];
    try {
      auto own = std::make_unique<const Scene>(at_work(*part.scene, scene.accuracy, speed, torque));
      auto system = make_system(*own);
      parts.push_back({part.name, std::move(own), std::move(system)});
    } catch (const Error& error) {
      throw InputError(
          fmt::format("part.name: part '{}', with {:.7g} times the speed and {:.7g} times the torque of its "
                      "scene: {}",
                      part.name, speed, torque, error.what()));
    }
  }
  return parts;
}

std::vector<dynamics::ShaftEnd> shaft_ends(const GearSystem& system) {
  std::vector<dynamics::ShaftEnd> ends;
  for (const auto& body : system.turning_bodies())
    ends.push_back({body.name, body.radius, "", body.speed, dynamics::force_at(body.radius, body.torque)});
  return ends;
}

std::string fault_of_part(const std::string& part, const std::exception& error) {
  return fmt::format("part.name: part '{}': {}", part, error.what());
}

namespace {

dynamics::Train train_of(const Scene& scene, const std::vector<WorkingPart>& parts,
                         const std::function<dynamics::LumpedCase(std::size_t part)>& lumped) {
  const auto input = scene.own<TrainInput>();
  dynamics::Train train;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& part = parts[i];
    try {
      train.parts.push_back({part.name, lumped(i), shaft_ends(*part.system)});
    } catch (const InputError& error) {
      throw InputError(fault_of_part(part.name, error));
    }
  }
  for (const auto& shaft : input.shafts) {
    const auto [from, from_body] = part_and_body(shaft.from);
    const auto [to, to_body] = part_and_body(shaft.to);
    train.shafts.push_back({shaft.name,
                            {from, from_body},
                            {to, to_body},
                            shaft.stiffness,
                            shaft.damping_ratio.value_or(scene.dynamics->support_damping_ratio),
                            shaft.backlash / 2});
  }
  train.rotors = rotors_of(scene);
  return train;
}

}  // namespace

std::vector<std::vector<const MeshResult*>> tables_of_parts(const std::vector<WorkingPart>& parts,
                                                            const std::vector<const MeshResult*>& tables) {
  std::vector<std::vector<const MeshResult*>> list;
  auto next = tables.begin();
  for (const auto& part : parts) {
    const auto first = next;
    next += static_cast<std::ptrdiff_t>(part.system->model_meshes().size());
    list.emplace_back(first, next);
  }
  return list;
}

dynamics::Train make_train(const Scene& scene, const std::vector<WorkingPart>& parts,
                           const std::vector<const MeshResult*>& tables) {
  const auto own = tables_of_parts(parts, tables);
  return train_of(scene, parts, [&](std::size_t i) { return parts[i].system->model(0, own[i])->lumped(); });
}

dynamics::Train rough_train(const Scene& scene, const std::vector<WorkingPart>& parts) {
  return train_of(scene, parts, [&](std::size_t i) { return parts[i].system->rough_lumped().value(); });
}

}  // namespace annulus::app
