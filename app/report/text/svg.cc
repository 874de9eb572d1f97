#include "app/report/text/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "core/text_columns.h"

namespace annulus::app {

std::string escape(const std::string& text) {
  static const std::map<char, std::string> names = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string out;
  for (const char c : text) {
    const auto name = names.find(c);
    out += name == names.end() ? std::string(1, c) : name->second;
  }
  return out;
}

namespace svg {

std::string through(const std::vector<Point>& points) {
  std::string d;
  for (const auto& p : points) d += fmt::format("{}{:.2f} {:.2f}", d.empty() ? 'M' : 'L', p.x(), p.y());
  return d;
}

std::string path(const std::string& d, const std::string& style) {
  return fmt::format("<path d=\"{}\" {}/>", d, style);
}
std::string line(const Point& a, const Point& b, const std::string& style) { return path(through({a, b}), style); }

std::string circle(const Point& centre, double radius, const std::string& style) {
  return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>", centre.x(), centre.y(), radius, style);
}

std::string rectangle(const Point& a, const Point& b, const std::string& style) {
  const Point low = a.cwiseMin(b), size = (b - a).cwiseAbs();
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>", low.x(), low.y(),
                     size.x(), size.y(), style);
}

std::string words(const Point& at, const std::string& text, const std::string& style) {
  if (text.empty()) return {};
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>", at.x(), at.y(), style, escape(text));
}

std::string group(const std::string& style, const std::string& content) {
  return fmt::format("<g {}>{}</g>", style, content);
}

std::string window(const Point& corner, const Point& size, const Point& origin, const std::string& content) {
  return fmt::format(
      "<svg x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" viewBox=\"{:.1f} {:.1f} {:.1f} "
      "{:.1f}\">{}</svg>",
      corner.x(), corner.y(), size.x(), size.y(), origin.x(), origin.y(), size.x(), size.y(), content);
}

std::string picture(const std::string& label, const Point& corner, const Point& size, const std::string& content,
                    const std::string& style) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.10g} {:.10g} {:.10g} {:.10g}\" role=\"img\" "
      "aria-label=\"{}\" {}>{}</svg>",
      corner.x(), corner.y(), size.x(), size.y(), escape(label), style, content);
}

namespace {

constexpr double title_line = 16;

double length_of(const std::string& text) { return static_cast<double>(characters(text)); }

}  // namespace

std::vector<std::string> title_lines(const std::string& title, double width, double title_left) {
  constexpr double per_letter = 7.6;  // of bold letters of 13 units, wide ones
  std::vector<std::string> lines;
  std::istringstream text(title);
  for (std::string word; text >> word;) {
    const bool fits = !lines.empty() && title_left + per_letter * length_of(lines.back() + " " + word) <= width;
    if (fits)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

double title_height(const std::vector<std::string>& lines) {
  return 10 + title_line * static_cast<double>(lines.size());
}

std::string titled_picture(const std::string& title, const std::string& label, double width, double height,
                           double title_left, const std::string& content) {
  std::string head;
  double y = 15;
  for (const auto& text : title_lines(title, width, title_left)) {
    head += words({title_left, y}, text, R"(font-size="13" font-weight="600")");
    y += title_line;
  }
  return picture(label.empty() ? title : label, {0, 0}, {width, std::floor(height)}, head + content,
                 R"(font-family="system-ui, sans-serif" font-size="11" fill="#333")");
}

}  // namespace svg

}  // namespace annulus::app
