#include "app/scene/input_place.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/scene_limits.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

std::string text_of(const Scene& scene, const Input* input) {
  if (!input || input->line <= 0) return scene.file.string();
  return fmt::format("{}:{}:{}", scene.file.string(), input->line, input->column);
}

template <class Is>
const Input* first(const Scene& scene, Is is) {
  const auto found = std::find_if(scene.inputs.begin(), scene.inputs.end(), is);
  return found == scene.inputs.end() ? nullptr : &*found;
}

/// Whether the text starts with the word as a whole.
bool starts_with_word(const std::string& text, const std::string& word) {
  return text.starts_with(word) &&
         (text.size() == word.size() || std::string(" :,").find(text[word.size()]) != std::string::npos);
}

const Input* talked_about(const Scene& scene, const std::string& message) {
  if (const auto* key = first(scene, [&](const Input& i) { return i.line > 0 && starts_with_word(message, i.key); }))
    return key;
  if (const auto* name = first(scene, [&](const Input& i) {
        return !i.variant.empty() && i.key.ends_with(".name") &&
               message.starts_with(fmt::format("{} '{}'", i.key.substr(0, i.key.find('.')), i.variant));
      }))
    return name;
  if (const auto* table = first(scene, [&](const Input& i) {
        return i.line > 0 && starts_with_word(message, i.key.substr(0, i.key.find('.')));
      }))
    return table;
  return nullptr;
}

}  // namespace

std::string place_text(const Scene& scene, const std::string& key, std::size_t entry) {
  return text_of(scene, scene.find(key, entry));
}

std::string with_place(const Scene& scene, const std::string& message) {
  const auto* input = talked_about(scene, message);
  if (input == nullptr) input = scene.find("stage.kind");
  return text_of(scene, input) + ": " + without_controls(message);
}

void about(const Scene& scene, const std::string& name, const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    if (std::string(error.what()).starts_with(scene.file.string() + ":")) throw;
    const auto text = name + ": " + error.what();
    const auto* input = talked_about(scene, error.what());
    if (input == nullptr) throw InputError(with_place(scene, text));
    throw InputError(text_of(scene, input) + ": " + without_controls(text));
  }
}

std::string without_place(const Scene& scene, const std::string& message) {
  const auto file = scene.file.string() + ":";
  if (!message.starts_with(file)) return message;
  const auto end = message.find(": ", file.size() - 1);
  return end == std::string::npos ? message : message.substr(end + 2);
}

}  // namespace annulus::app
