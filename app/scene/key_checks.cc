#include "app/scene/key_checks.h"

#include <fmt/format.h>

#include "app/scene/scene_limits.h"

namespace annulus::app {

const Input* KeyChecks::find(const std::string& key, const std::string& ring) const {
  for (const auto& input : scene_.inputs) {
    if (input.key == key && input.ring == ring) return &input;
  }
  return nullptr;
}

bool KeyChecks::given(const std::string& key, const std::string& ring) const {
  const Input* input = find(key, ring);
  return input && input->origin == Origin::scene;
}

bool KeyChecks::usable(const std::string& key, const std::string& ring) const {
  const Input* input = find(key, ring);
  return input && !std::holds_alternative<std::monostate>(input->value);
}

void KeyChecks::problem(const std::string& key, const std::string& ring, const std::string& rule) {
  const Input* input = find(key, ring);
  std::string head = key;
  if (input && input->origin == Origin::scene) head += " = " + shown(to_text(input->value));
  if (!ring.empty()) head += " (ring '" + shown(ring) + "')";
  problems_.push_back({input ? input->line : 0, input ? input->column : 0, head + ": " + rule});
}

void KeyChecks::required_if(bool condition, const std::vector<std::string>& keys, const std::string& ring,
                            const char* why) {
  if (!condition) return;
  for (const auto& key : keys) {
    if (!given(key, ring)) problem(key, ring, fmt::format("is required by {}", why));
  }
}

void KeyChecks::forbidden_unless(bool condition, const std::vector<std::string>& keys, const std::string& ring,
                                 const char* why) {
  if (condition) return;
  for (const auto& key : keys) {
    if (given(key, ring)) problem(key, ring, fmt::format("has a meaning only with {}", why));
  }
}

void KeyChecks::derive(const std::string& key, double value, const char* how) {
  for (auto& input : scene_.inputs) {
    if (input.key != key) continue;
    input.value = value;
    input.origin = Origin::derived;
    input.note = how;
    return;
  }
}

void KeyChecks::mesh(const MeshInput& m, const std::string& path) {
  if (given(path + ".stiffness") && !usable(path + ".stiffness")) return;
  const auto needs = [&](bool condition, const char* key, const char* shapes) {
    if (condition && !given(path + key)) problem(path + key, "", std::string("is required by stiffness = ") + shapes);
    if (!condition && given(path + key))
      problem(path + key, "", std::string("has a meaning only with stiffness = ") + shapes);
  };
  const bool wave = m.stiffness == StiffnessShape::harmonic || m.stiffness == StiffnessShape::rectangular;
  needs(wave || m.stiffness == StiffnessShape::constant, ".mean_N_per_m",
        "\"constant\", \"harmonic\" or \"rectangular\"");
  needs(wave, ".ripple", "\"harmonic\" or \"rectangular\"");
  needs(m.stiffness == StiffnessShape::rectangular, ".duty", "\"rectangular\"");
  needs(m.stiffness == StiffnessShape::table, ".file", "\"table\"");
  if (!wave && given(path + ".phase")) problem(path + ".phase", "", "has a meaning only with a wave");
  if (m.stiffness == StiffnessShape::harmonic && m.ripple && *m.ripple >= 1) {
    problem(path + ".ripple", "", "must stay below 1: the stiffness would become negative");
  }
  if (m.stiffness == StiffnessShape::rectangular && m.ripple && m.duty && *m.ripple * *m.duty >= 1) {
    problem(path + ".ripple", "", "times duty must stay below 1: the stiffness would become negative");
  }
}

void KeyChecks::integrator() {
  const bool fixed = scene_.dynamics->integrator == dynamics::Integrator::runge_kutta_4;
  if (fixed && !scene_.dynamics->steps_per_cycle)
    problem("dynamics.steps_per_cycle", "", "is required by integrator = \"runge_kutta_4\", which has fixed steps");
  if (!fixed && scene_.dynamics->steps_per_cycle)
    problem("dynamics.steps_per_cycle", "",
            "goes with integrator = \"runge_kutta_4\" only; the others choose their steps");
}

}  // namespace annulus::app
