#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace annulus::app {

/// `text` with &, <, > and " made harmless in XML and HTML.
[[nodiscard]] std::string escape(const std::string& text);

/// Elements of pictures. Points are page units (about a pixel), y downwards; `style`: attributes, R"(stroke="#888")".
namespace svg {

using Point = Eigen::Vector2d;

/// "M1.00 2.00L3.00 4.00...": a line through points.
[[nodiscard]] std::string through(const std::vector<Point>& points);

[[nodiscard]] std::string path(const std::string& d, const std::string& style);
[[nodiscard]] std::string line(const Point& a, const Point& b, const std::string& style);
[[nodiscard]] std::string circle(const Point& centre, double radius, const std::string& style);
/// Between two opposite corners.
[[nodiscard]] std::string rectangle(const Point& a, const Point& b, const std::string& style);
/// A text at a point; it is escaped.
[[nodiscard]] std::string words(const Point& at, const std::string& text, const std::string& style = {});
[[nodiscard]] std::string group(const std::string& style, const std::string& content);

/// A part of the page that clips its content.
[[nodiscard]] std::string window(const Point& corner, const Point& size, const Point& origin,
                                 const std::string& content);
/// A whole picture that scales with its container and needs nothing from outside. `label`: what those hear who cannot
/// see it.
[[nodiscard]] std::string picture(const std::string& label, const Point& corner, const Point& size,
                                  const std::string& content, const std::string& style = {});
/// A title in lines that fit into a picture of this width; none of an empty one. `title_left`: where they begin.
[[nodiscard]] std::vector<std::string> title_lines(const std::string& title, double width, double title_left = 0);
/// From the top of a picture to what is below its title.
[[nodiscard]] double title_height(const std::vector<std::string>& lines);
/// The same with letters, and with its title at `title_left` above everything when there is one.
[[nodiscard]] std::string titled_picture(const std::string& title, const std::string& label, double width,
                                         double height, double title_left, const std::string& content);

inline constexpr const char *centred = R"(text-anchor="middle")", *at_the_end = R"(text-anchor="end")";

}  // namespace svg

}  // namespace annulus::app
