#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::test {

/// A scene as lines, to change one key of it wherever it stands.
class SceneEdit {
 public:
  explicit SceneEdit(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const auto end = std::min(text.find('\n', begin), text.size());
      lines_.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }

  [[nodiscard]] std::string text() const {
    std::string result;
    for (const auto& line : lines_) result += line + "\n";
    return result;
  }

  /// Line of a key, counted from 1, in the first table that has it; 0 without.
  [[nodiscard]] int find(const app::Table& table, const std::string& name) const {
    std::string header;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].starts_with('[')) header = lines_[i].substr(0, lines_[i].rfind(']') + 1);
      if (header == (table.path.empty() ? "" : table.header()) && names(lines_[i], name))
        return static_cast<int>(i) + 1;
    }
    return 0;
  }

  /// Gives a key this value, in its place or in a place made for it; its line.
  int set(const app::Table& table, const std::string& name, const std::string& value) {
    const std::string line = name + " = " + value;
    if (const int at = find(table, name); at > 0) {
      lines_[static_cast<std::size_t>(at - 1)] = line;
      return at;
    }
    if (table.path.empty()) {
      lines_.insert(lines_.begin(), line);
      return 1;
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].starts_with(table.header())) continue;
      lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(i) + 1, line);
      return static_cast<int>(i) + 2;
    }
    lines_.push_back(table.header());
    lines_.push_back(line);
    return static_cast<int>(lines_.size());
  }

  void remove(int line) { lines_.erase(lines_.begin() + line - 1); }
  void repeat(int line) { lines_.insert(lines_.begin() + line, lines_[static_cast<std::size_t>(line - 1)]); }

 private:
  static bool names(const std::string& line, const std::string& name) {
    return line.starts_with(name) && line.find_first_not_of(' ', name.size()) == line.find('=') &&
           line.find('=') != std::string::npos;
  }

  std::vector<std::string> lines_;
};

}  // namespace annulus::test
