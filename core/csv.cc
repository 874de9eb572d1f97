#include "core/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "core/errors.h"
#include "core/files.h"

namespace annulus {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = " \t\r";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const auto comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

InputError at_line(const std::filesystem::path& file, int line, const std::string& what) {
  return InputError(fmt::format("{}:{}: {}", file.string(), line, what));
}

/// For messages: whatever stands in a file that is no table.
std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result(text.substr(0, longest));
  for (char& c : result)
    if (c < ' ' || c > '~') c = '?';
  return result + (text.size() > longest ? "..." : "");
}

double to_number(std::string_view cell, const std::filesystem::path& file, int line, const std::string& column) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size())
    throw at_line(file, line, fmt::format("'{}' in column {} is not a number", shown(cell), shown(column)));
  return value;
}

Csv parsed(std::istream& stream, const std::filesystem::path& file) {
  Csv csv;
  csv.file = file.string();
  std::string text;
  int line = 0;
  bool ended = false;
  while (std::getline(stream, text)) {
    ++line;
    // A line is written whole or not at all: without its end, its last number may have lost digits.
    if (stream.eof()) throw at_line(file, line, "the last line has no end; is the file complete?");
    const auto content = trimmed(text);
    if (content.empty()) {
      ended = true;  // blank lines are fine at the end, a hole in the data is not
      continue;
    }
    if (ended) throw at_line(file, line, "data after an empty line; remove the empty line");
    if (csv.columns.empty() && content.front() == '#') {
      const auto colon = content.find(':');
      if (colon == std::string_view::npos) throw at_line(file, line, "expected '# key: value'");
      csv.header.emplace_back(trimmed(content.substr(1, colon - 1)), trimmed(content.substr(colon + 1)));
      continue;
    }
    const auto cells = split(content);
    if (csv.columns.empty()) {
      csv.columns.assign(cells.begin(), cells.end());
      continue;
    }
    if (cells.size() != csv.columns.size())
      throw at_line(file, line, fmt::format("{} cells where the header has {}", cells.size(), csv.columns.size()));
    auto& row = csv.rows.emplace_back();
    row.reserve(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) row.push_back(to_number(cells[i], file, line, csv.columns[i]));
  }
  if (csv.columns.empty()) throw at_line(file, line + 1, "no line with column names");
  return csv;
}

bool single_line(const std::string& text) { return text.find_first_of("\r\n") == std::string::npos; }

}  // namespace

std::string Csv::text() const {
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  for (const auto& [key, value] : header) {
    // Such a file could not be read back.
    if (key.empty() || key.find(':') != std::string::npos || !single_line(key) || !single_line(value))
      throw InputError(fmt::format("header '{}: {}' must be one line with no colon in the key", key, value));
    fmt::format_to(to, "# {}: {}\n", key, value);
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty() || columns[i].find(',') != std::string::npos || !single_line(columns[i]))
      throw InputError(fmt::format("column name '{}' is empty or holds a comma", columns[i]));
    fmt::format_to(to, "{}{}", i ? "," : "", columns[i]);
  }
  fmt::format_to(to, "\n");
  for (const auto& row : rows) {
    require(row.size() == columns.size(), "CSV row and header differ in length");
    for (std::size_t i = 0; i < row.size(); ++i) fmt::format_to(to, "{}{}", i ? "," : "", row[i]);
    fmt::format_to(to, "\n");
  }
  return fmt::to_string(out);
}

void Csv::write(const std::filesystem::path& target) const {
  try {
    write_file(target, text());
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.find(target.string()) == std::string::npos ? target.string() + ": " + what : what);
  }
}

Csv Csv::read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError(fmt::format("cannot read {}: no such file, or not readable", file.string()));
  return parsed(stream, file);
}

Csv Csv::parse(const std::string& text, const std::filesystem::path& name) {
  std::istringstream stream(text);
  return parsed(stream, name);
}

void Csv::add_column(const std::string& name, const Eigen::VectorXd& values) {
  columns.push_back(name);
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row].push_back(values[static_cast<Eigen::Index>(row)]);
}

void Csv::round(const std::vector<std::string>& exact) {
  std::vector<bool> stays;
  for (const auto& name : columns) stays.push_back(std::find(exact.begin(), exact.end(), name) != exact.end());
  for (auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (stays[i] || !std::isfinite(row[i])) continue;
      char text[40];
      const auto end = fmt::format_to_n(text, sizeof text, "{:.{}e}", row[i], i == 0 ? 8 : 5).out;
      std::from_chars(text, end, row[i]);
    }
  }
}

std::size_t Csv::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw at_columns(fmt::format("no column '{}'; there are: {}", name, column_names()));
  return static_cast<std::size_t>(found - columns.begin());
}

std::optional<std::string> Csv::header_value(const std::string& key) const {
  for (const auto& [name, value] : header)
    if (name == key) return value;
  return std::nullopt;
}

// No blank line is accepted in between, so the line of a row is known.
InputError Csv::at_row(std::size_t row, const std::string& what) const {
  return at_line(file, static_cast<int>(header.size() + 2 + row), what);
}

InputError Csv::at_columns(const std::string& what) const {
  return file.empty() ? InputError(what) : at_line(file, static_cast<int>(header.size() + 1), what);
}

std::string Csv::column_names() const {
  constexpr std::size_t most = 40;
  std::string names;
  for (std::size_t i = 0; i < std::min(columns.size(), most); ++i) names += (i ? ", " : "") + shown(columns[i]);
  return names;
}

namespace {

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

std::string csv_remark(const std::string& text) {
  std::string line = on_one_line(text);
  for (auto at = line.find(','); at != std::string::npos; at = line.find(',', at + 1)) {
    const auto next = line.find_first_not_of(' ', at + 1);
    if (next != std::string::npos && std::string_view("=+-@").find(line[next]) != std::string_view::npos)
      line.insert(next, 1, '\'');
  }
  return line;
}

std::string csv_cell(const std::string& text) {
  std::string cell = on_one_line(text);
  const auto first = cell.find_first_not_of(' ');
  if (first != std::string::npos && std::string_view("=+-@").find(cell[first]) != std::string_view::npos)
    cell.insert(cell.begin(), '\'');
  for (auto at = cell.find('"'); at != std::string::npos; at = cell.find('"', at + 2)) cell.insert(at, 1, '"');
  return text.find_first_of(",\"") == std::string::npos ? cell : '"' + cell + '"';
}

std::string csv_cell(double number) { return std::isfinite(number) ? fmt::format("{:.17g}", number) : ""; }

}  // namespace annulus
