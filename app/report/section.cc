#include "app/report/section.h"

#include "core/errors.h"

namespace annulus::app {

PageTable labelled_rows(const std::vector<Text>& labels) {
  PageTable table{.head = {""}, .style = PageTable::Style::numbers};
  for (const auto& label : labels) table.rows.push_back({label});
  return table;
}

void add_column(PageTable& table, const Text& head, const std::vector<Text>& cells) {
  require(cells.size() == table.rows.size(), "a column of another length than its table");
  table.head.push_back(head);
  for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(cells[i]);
}

Blocks& Blocks::operator+=(const Blocks& other) {
  list_.insert(list_.end(), other.list_.begin(), other.list_.end());
  return *this;
}
Blocks operator+(Blocks a, const Blocks& b) { return a += b; }

Box verdict_box(const Blocks& blocks) { return {.kind = Box::Kind::verdict, .blocks = blocks.list()}; }
Box details(const Text& summary, const Blocks& blocks) {
  return {.kind = Box::Kind::details, .blocks = blocks.list(), .summary = summary};
}
Heading heading(const Text& text, const std::string& anchor) { return {text, anchor}; }
Paragraph paragraph(const Text& text) { return {text}; }

}  // namespace annulus::app
