#include "app/scene/key_checks.h"

#include <algorithm>

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

void KeyChecks::derive(const std::string& key, double value, const char* how) {
  for (auto& input : scene_.inputs) {
    if (input.key != key) continue;
    input.value = value;
    input.origin = Origin::derived;
    input.note = how;
    return;
  }
}

void KeyChecks::wave(const MeshInput& m, const std::string& path, const std::vector<StiffnessShape>& harmonic) {
  if (std::find(harmonic.begin(), harmonic.end(), m.stiffness) != harmonic.end() && m.ripple && *m.ripple >= 1)
    problem(path + ".ripple", "", "must stay below 1: the stiffness would become negative");
  if (m.stiffness == StiffnessShape::rectangular && m.ripple && m.duty && *m.ripple * *m.duty >= 1)
    problem(path + ".ripple", "", "times duty must stay below 1: the stiffness would become negative");
}

}  // namespace annulus::app
