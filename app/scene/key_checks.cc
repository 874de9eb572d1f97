#include "app/scene/key_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/scene_limits.h"

namespace annulus::app {

Input* KeyChecks::find(const std::string& key, const Entry& entry) const {
  const auto* variant = std::get_if<std::string>(&entry);
  const auto found = std::find_if(scene_.inputs.begin(), scene_.inputs.end(), [&](const Input& input) {
    return input.key == key && (variant ? input.variant == *variant : input.entry == std::get<std::size_t>(entry));
  });
  return found == scene_.inputs.end() ? nullptr : &*found;
}

bool KeyChecks::given(const std::string& key, const Entry& entry) const {
  const Input* input = find(key, entry);
  return input && input->origin == Origin::scene;
}

bool KeyChecks::usable(const std::string& key, const Entry& entry) const {
  const Input* input = find(key, entry);
  return input && !std::holds_alternative<std::monostate>(input->value);
}

void KeyChecks::problem(const std::string& key, const Entry& entry, const std::string& rule) {
  const Input* input = find(key, entry);
  const auto* named = std::get_if<std::string>(&entry);
  const std::string variant = input ? input->variant : named ? *named : "";
  std::string head = key;
  if (input && input->origin == Origin::scene) head += " = " + shown(to_text(input->value));
  if (!variant.empty()) head += fmt::format(" ({} '{}')", key.substr(0, key.find('.')), shown(variant));
  problems_.push_back({input ? input->line : 0, input ? input->column : 0, head + ": " + rule});
}

void KeyChecks::set(const std::string& key, const Value& value, Origin origin, const std::string& how,
                    const Entry& entry) {
  Input* input = find(key, entry);
  if (!input) return;
  input->origin = origin;
  input->value = value;
  input->note = how;
}

void KeyChecks::simple_name(const std::string& key, const Entry& entry, const std::string& name) {
  constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (!usable(key, entry)) return;
  if (name.empty() || name.find_first_not_of(allowed) != std::string::npos)
    problem(key, entry, "must consist of letters, digits, _ and - alone");
}

void KeyChecks::wave(const MeshInput& m, const std::string& path, const std::vector<StiffnessShape>& harmonic) {
  if (std::find(harmonic.begin(), harmonic.end(), m.stiffness) != harmonic.end() && m.ripple && *m.ripple >= 1)
    problem(path + ".ripple", "must stay below 1: the stiffness would become negative");
  if (m.stiffness == StiffnessShape::rectangular && m.ripple && m.duty && *m.ripple * *m.duty >= 1)
    problem(path + ".ripple", "times duty must stay below 1: the stiffness would become negative");
}

}  // namespace annulus::app
