#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace annulus::manual {

/// What tests/verification_record.h writes.
struct Row {
  std::string quantity, unit, origin, kind;  ///< kind: relative, absolute, at_most, at_least
  double computed = 0, expected = 0, tolerance = 0, used = 0;
  int comparisons = 0;
};

struct Curve {
  std::string label;
  std::vector<double> x, computed, reference, reference_x;
};

struct Picture {
  std::string title, x_label, y_label;
  bool x_log = false, y_log = false, slopes = false;
  std::vector<Curve> curves;
};

struct Record {
  std::string title, reference;
  std::vector<Row> rows;
  std::vector<Picture> pictures;
};

/// Place of a test case: layer (folder of tests/), suite, name.
struct CaseName {
  std::string layer, suite, name;
  [[nodiscard]] std::string text() const { return layer + '.' + suite + '/' + name; }
  friend auto operator<=>(const CaseName&, const CaseName&) = default;
};

using Records = std::map<CaseName, Record>;
[[nodiscard]] Records read_records(const std::filesystem::path& folder);

/// Cases in the order of the tests, as the test programs list them.
struct ListedCase {
  CaseName name;
  std::string label;  ///< of CTest: unit, verification ...
};

/// `entries`: a line "label layer suite program" per CTest entry.
[[nodiscard]] std::vector<ListedCase> list_cases(const std::filesystem::path& entries);

}  // namespace annulus::manual
