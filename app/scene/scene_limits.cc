#include "app/scene/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/scene_value.h"

namespace annulus::app {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Walks through TOML outside of texts and comments, and counts the parts of dotted keys: a parser that makes a table
/// for each part, and then takes them apart again one inside the other, runs out of stack.
class KeyDepth {
 public:
  explicit KeyDepth(const std::string& text) : text_(text) {}

  /// Line of the first key of too many parts; 0 without one.
  int find() {
    int dots = 0;
    for (at_ = 0; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (c == '"' || c == '\'') {
        skip_text(c);
      } else if (c == '#') {
        while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
      } else if (c == '.') {
        if (++dots >= deepest_key) return line_;
      } else if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) {
        dots = 0;
      }
    }
    return 0;
  }

 private:
  [[nodiscard]] bool three(char quote) const { return text_.compare(at_, 3, std::string(3, quote)) == 0; }

  /// Leaves `at_` at the closing quote.
  void skip_text(char quote) {
    const bool several_lines = three(quote);
    at_ += several_lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        if (!several_lines) return;  // not closed: the parser reports it
      } else if (c == '\\' && quote == '"') {
        ++at_;
      } else if (c == quote && (!several_lines || three(quote))) {
        if (several_lines) at_ += 2;
        return;
      }
    }
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

enum class LineEnds { keep, escape };

std::string escaped(const std::string& text, LineEnds line_ends) {
  std::string result;
  for (const char c : text) {
    if (!is_control(c) || (line_ends == LineEnds::keep && c == '\n'))
      result += c;
    else if (c == '\n')
      result += "\\n";
    else
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
  }
  return result;
}

}  // namespace

void check_scene_text(const std::string& text, const std::string& file) {
  if (text.size() > largest_scene)
    throw SceneError(
        file,
        {{0, 0,
          fmt::format("is larger than {} bytes, the most a scene may have; is it the right file?", largest_scene)}});
  if (const int line = KeyDepth(text).find(); line > 0)
    throw SceneError(
        file,
        {{line, 1,
          fmt::format("a key of more than {} parts; tables lie no deeper than two, as mesh.sun_planet", deepest_key)}});
}

std::string shown(const std::string& text, std::size_t longest) {
  std::string result = escaped(text.substr(0, longest + 1), LineEnds::escape);
  if (text.size() <= longest && result.size() <= 2 * longest) return result;
  result.resize(std::min(result.size(), longest));
  // Not in the middle of a character.
  while (!result.empty() && (static_cast<unsigned char>(result.back()) & 0xC0) == 0x80) result.pop_back();
  if (!result.empty() && static_cast<unsigned char>(result.back()) >= 0xC0) result.pop_back();
  return result + "…";
}

std::string without_controls(const std::string& text) { return escaped(text, LineEnds::keep); }

bool has_controls(const std::string& text) { return std::any_of(text.begin(), text.end(), is_control); }

}  // namespace annulus::app
