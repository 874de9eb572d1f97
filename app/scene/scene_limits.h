#pragma once

#include <cstddef>
#include <string>

namespace annulus::app {

/// What a scene file may hold at most. Far beyond any gear set; a file that exceeds it is a mistake or worse, and is
/// refused before time goes into it.
inline constexpr std::size_t largest_scene = 1'000'000;  ///< bytes
inline constexpr int deepest_key = 16;                   ///< parts of a dotted key or table name
inline constexpr std::size_t most_tables = 100;          ///< of one array of tables ([[ring]], [[sweep]])
inline constexpr std::size_t longest_text = 1000;        ///< bytes of one text
inline constexpr std::size_t longest_list = 1000;        ///< values of one list, unless its key allows more
inline constexpr std::size_t most_problems = 50;         ///< in one message

/// Throws SceneError when the text is too large, or nests keys deeper than its parser could bear.
void check_scene_text(const std::string& text, const std::string& file);

/// For messages: without control characters, and cut where it would fill the screen.
[[nodiscard]] std::string shown(const std::string& text, std::size_t longest = 120);
/// Without control characters but for line ends.
[[nodiscard]] std::string without_controls(const std::string& text);

/// Whether a text has line ends or other control characters.
[[nodiscard]] bool has_controls(const std::string& text);

}  // namespace annulus::app
