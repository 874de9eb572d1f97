#pragma once

#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <vector>

namespace annulus::app {

/// A line of text for readers: runs of characters, each with one look. It holds no markup of any format; whoever shows
/// it escapes it.
class Text {
 public:
  enum class Look { plain, bold, code, muted, subscript, agrees, disagrees, undecided, assumed, link, line_break };
  struct Run {
    std::string text;
    Look look = Look::plain;
    std::string target{};  ///< of a link: the anchor of a section on the same page
  };

  Text() = default;
  Text(std::string plain);
  Text(const char* plain);
  explicit Text(Run run);

  Text& operator+=(const Text& other);
  friend Text operator+(Text a, const Text& b) { return a += b; }

  [[nodiscard]] bool empty() const { return runs_.empty(); }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  /// The characters alone.
  [[nodiscard]] std::string plain() const;

 private:
  std::vector<Run> runs_;
};

[[nodiscard]] Text bold(std::string text);
[[nodiscard]] Text code(std::string text);   ///< keys, file names
[[nodiscard]] Text muted(std::string text);  ///< less important than what it follows
[[nodiscard]] Text subscript(std::string text);
[[nodiscard]] Text tag(Text::Look look, std::string text);  ///< a coloured label; `look`: agrees ... assumed
[[nodiscard]] Text link(std::string text, std::string anchor);
[[nodiscard]] Text line_break();

/// "a", "a and b", "a, b and c".
[[nodiscard]] Text enumerated(const std::vector<Text>& words);
/// The parts one after the other, `between` them.
[[nodiscard]] Text joined(const std::vector<Text>& parts, const Text& between);

namespace detail {

template <class Part>
using PhraseSlot = std::conditional_t<std::is_same_v<Part, Text>, std::string, Part>;
[[nodiscard]] std::string phrase_slot(std::size_t index);
[[nodiscard]] Text filled_phrase(const std::string& text, const std::vector<Text>& slots);

}  // namespace detail

/// fmt::format, where parts may be texts with looks of their own: phrase("{} is {:.1f} % softer", bold(name), x).
template <class... Parts>
[[nodiscard]] Text phrase(fmt::format_string<const detail::PhraseSlot<Parts>&...> pattern, const Parts&... parts) {
  std::vector<Text> slots;
  const auto formatted = [&slots](const auto& part) -> decltype(auto) {
    if constexpr (std::is_same_v<std::decay_t<decltype(part)>, Text>) {
      slots.push_back(part);
      return detail::phrase_slot(slots.size() - 1);
    } else {
      return (part);
    }
  };
  const std::string text = fmt::vformat(fmt::string_view(pattern), fmt::make_format_args(formatted(parts)...));
  return detail::filled_phrase(text, slots);
}

}  // namespace annulus::app
