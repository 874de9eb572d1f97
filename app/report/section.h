#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "app/report/drawings/deformed_mesh.h"
#include "app/report/plot/plots.h"
#include "app/report/text/text.h"

/// A report is data: sections of blocks. What reads results makes it, page.h draws it.
namespace annulus::app {

struct Heading {
  Text text;
  std::string anchor{};  ///< empty: nothing links to it
};

/// Lines as they are, such as the text of a file.
struct Lines {
  std::string text;
};

struct Paragraph {
  Text text;
  enum class Tone { plain, muted } tone = Tone::plain;
};

struct List {
  std::vector<Text> items;
};

/// A row of one cell is the heading of the rows below it.
struct PageTable {
  enum class Style { text, numbers };
  std::vector<Text> head{};
  std::vector<std::vector<Text>> rows{};
  Style style = Style::text;
};
/// A drawing to scale, as an <svg> element.
struct Drawing {
  std::string svg;
};
using Drawn = std::variant<Plot, BarChart, ColourMap, SpreadPlot, Drawing, DeformedMesh>;

/// Something drawn, with a title above and a caption below when they are not empty.
struct Picture {
  Drawn drawn;
  Text title{}, caption{};
  std::string variant{}, mesh{};  ///< shown where these are chosen; empty: always

  template <class Kind>
  requires std::is_constructible_v<Drawn, Kind> Picture(Kind kind, Text above = {}, Text below = {})
      : drawn(std::move(kind)), title(std::move(above)), caption(std::move(below)) {}
};

/// Label and index into the palette.
using Legend = std::vector<std::pair<std::string, std::size_t>>;

/// Pictures side by side under one legend and one caption.
struct Pictures {
  enum class Layout { row, shapes, meshes, fields };
  std::vector<Picture> list{};
  Legend legend{};
  Text caption{};
  Layout layout = Layout::row;
};

struct Block;

/// Blocks in a frame of their own: the answer of the page or of a section, or details behind their summary.
struct Box {
  enum class Kind { verdict, details };
  Kind kind = Kind::verdict;
  std::vector<Block> blocks;
  Text summary{};  ///< of details
};

struct Block {
  std::variant<Heading, Paragraph, Lines, List, PageTable, Pictures, Box> content;
};

/// Blocks one after the other, put together with + and +=.
class Blocks {
 public:
  Blocks() = default;
  template <class Content>
  requires std::is_constructible_v<decltype(Block::content), Content> Blocks(Content content)
      : list_({{std::move(content)}}) {}

  Blocks& operator+=(const Blocks& other) {
    list_.insert(list_.end(), other.list_.begin(), other.list_.end());
    return *this;
  }
  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] const std::vector<Block>& list() const { return list_; }

 private:
  std::vector<Block> list_;
};
[[nodiscard]] inline Blocks operator+(Blocks a, const Blocks& b) { return a += b; }

[[nodiscard]] inline Box verdict_box(const Blocks& blocks) { return {.blocks = blocks.list()}; }
[[nodiscard]] inline Box details(const Text& summary, const Blocks& blocks) {
  return {Box::Kind::details, blocks.list(), summary};
}
[[nodiscard]] inline Heading heading(const Text& text, const std::string& anchor = {}) { return {text, anchor}; }
[[nodiscard]] inline Paragraph paragraph(const Text& text) { return {text}; }

/// A part of a report page; without blocks it is left out.
struct Section {
  std::string anchor;
  std::string name;  ///< in the list of links
  Blocks blocks{};
  std::string title{};  ///< empty: the name
  bool folded = false;  ///< shown when it is opened
};

/// A whole page: title, line below it, what came out, and sections.
struct Page {
  std::string title;
  Text sub{};
  Blocks summary{};
  std::vector<Section> sections{};
  std::vector<std::string> variants{}, meshes{};  ///< to choose from; a single one needs no choice
  std::string variant_word{};                     ///< what these variants are, for the reader: "ring"
  std::string line_kind{};                        ///< what the lines are, for the reader: "Planet"
  std::vector<std::string> lines{};               ///< their labels, all of them or one at a time
};

}  // namespace annulus::app
