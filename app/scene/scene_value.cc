#include "app/scene/scene_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "app/scene/scene_limits.h"

namespace annulus::app {

std::string to_text(double value, int digits) {
  if (std::isnan(value)) return "not known";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  const double rounded = std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
  if (rounded == 0) return "0";
  if (std::abs(rounded) < 1e6 && std::abs(rounded) >= 1e-4) return fmt::format("{}", rounded);
  // 1e9, 1.364e9, 1e-6: without the plus sign and leading zero of "1.364e+09".
  std::array<char, 32> text{};
  auto* const end = std::to_chars(text.data(), text.data() + text.size(), rounded, std::chars_format::scientific).ptr;
  auto* const e = std::find(text.data(), end, 'e');
  return std::string(text.data(), e) + "e" + std::to_string(std::atoi(e + 1));
}

std::string to_text(const Value& value) {
  struct Visitor {
    std::string operator()(std::monostate) const { return "none"; }
    std::string operator()(long v) const { return std::to_string(v); }
    std::string operator()(double v) const { return to_text(v); }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(const std::vector<double>& v) const {
      std::vector<std::string> texts;
      texts.reserve(v.size());
      for (const double x : v) texts.push_back(to_text(x));
      return fmt::format("[{}]", fmt::join(texts, ", "));
    }
    std::string operator()(const std::vector<std::string>& v) const {
      return v.empty() ? "[]" : fmt::format("[\"{}\"]", fmt::join(v, "\", \""));
    }
  };
  return std::visit(Visitor{}, value);
}

const char* to_text(Origin origin) {
  return origin == Origin::scene ? "scene" : origin == Origin::default_value ? "default" : "derived";
}

namespace {

std::string format_problems(const std::string& file, const std::vector<Problem>& problems) {
  std::string text;
  const std::size_t shown_problems = std::min(problems.size(), most_problems);
  for (std::size_t i = 0; i < shown_problems; ++i) {
    const auto& p = problems[i];
    if (!text.empty()) text += '\n';
    text += file;
    if (p.line > 0) text += fmt::format(":{}:{}", p.line, p.column);
    text += ": " + p.message;
  }
  if (shown_problems < problems.size()) text += "\n" + file + ": there are more problems";
  return without_controls(text);
}

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours count one each.
int edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

SceneError::SceneError(const std::string& file, std::vector<Problem> problems)
    : InputError(format_problems(file, problems)), problems_(std::move(problems)) {}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  constexpr std::size_t longest_word = 100;  // no slip of the pen makes a key so long
  if (word.size() > longest_word) return best;
  // Half the letters wrong is no longer a slip of the pen; a forgotten unit suffix or first word still is.
  int best_distance = std::max<int>(2, static_cast<int>(word.size()) / 2) + 1;
  for (const auto& candidate : candidates) {
    int distance = edit_distance(word, candidate);
    const bool part = word.size() >= 3 && candidate.find(word) != std::string::npos;
    if (part) distance = std::min(distance, 2);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const std::string& otherwise) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? otherwise : "; did you mean " + near + "?";
}

}  // namespace annulus::app
