#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace annulus {

/// A table of numbers with named columns, preceded by `# key: value` lines. The units are in the column names.
struct Csv {
  std::vector<std::pair<std::string, std::string>> header;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  std::string file{};  ///< that it was read from, for messages; empty for others

  /// As few digits as give every double back.
  [[nodiscard]] std::string text() const;
  void write(const std::filesystem::path& file) const;
  /// Throws InputError naming file and line when a cell is not a number or a row has the wrong length.
  [[nodiscard]] static Csv read(const std::filesystem::path& file);
  /// `name`: of the file in messages.
  [[nodiscard]] static Csv parse(const std::string& text, const std::filesystem::path& name);

  /// A column after the others, a value for every row.
  void add_column(const std::string& name, const Eigen::VectorXd& values);
  /// Rounds to six significant digits, far below any error of a result, and the first column, the abscissa, to nine:
  /// large tables shrink to less than half. Columns in `exact` stay as they are.
  void round(const std::vector<std::string>& exact = {});
  /// Index of a column; throws InputError naming the column, and file and line, when it is missing.
  [[nodiscard]] std::size_t column(const std::string& name) const;
  /// Value of a header line; nothing where there is none.
  [[nodiscard]] std::optional<std::string> header_value(const std::string& key) const;
  /// Errors with file and line: of a data row, and of the line with the column names.
  [[nodiscard]] InputError at_row(std::size_t row, const std::string& what) const;
  [[nodiscard]] InputError at_columns(const std::string& what) const;
  /// For messages: the names of the first columns, whatever stands in them.
  [[nodiscard]] std::string column_names() const;
};

/// A cell of a table with text in it, quoted where it has to be (RFC 4180). Line ends and other control characters
/// become blanks. A text that spreadsheets would take for a formula (=, +, - or @ in front) gets an apostrophe in
/// front.
[[nodiscard]] std::string csv_cell(const std::string& text);
/// A text for a `# key: value` line: control characters become blanks. Spreadsheets cut such a line at its commas; what
/// would then be a formula gets an apostrophe in front.
[[nodiscard]] std::string csv_remark(const std::string& text);
/// 17 significant digits; nothing for what is not finite.
[[nodiscard]] std::string csv_cell(double number);

}  // namespace annulus
