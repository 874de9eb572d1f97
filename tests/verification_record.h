#pragma once

#include <string>
#include <vector>

namespace annulus::test {

/// A picture for the manual: what was computed (dots) against its reference (a line of the same colour).
struct RecordedPlot {
  struct Curve {
    std::string label;
    std::vector<double> x, computed, reference;  ///< no reference: the computed values are joined by a line
    std::vector<double> reference_x = {};        ///< where the reference is given when not at x
  };
  std::string title, x_label, y_label;  ///< labels with units
  std::vector<Curve> curves;
  bool x_log = false, y_log = false;
  bool slopes = false;  ///< references are the slopes that theory promises
};

/// What the running test case compares with an independent reference, stated once: each comparison is a check of the
/// test and, when the environment variable ANNULUS_VERIFICATION_RECORD names a folder, a row of the verification manual
/// (scripts/verification_manual.sh). Comparisons of one quantity share a row: it shows the one that comes closest to
/// its tolerance, and how many there were. One per test case; nothing is recorded of a case that fails.
class Verification {
 public:
  /// `title` says what is verified, `reference` where the expected values come from (formula, book, conservation law).
  Verification(std::string title, std::string reference);
  ~Verification();
  Verification(const Verification&) = delete;
  Verification& operator=(const Verification&) = delete;

  /// |computed - expected| <= tolerance x the smaller of both. `origin` says where the tolerance comes from.
  void close(const std::string& quantity, const std::string& unit, double computed, double expected, double tolerance,
             const std::string& origin = {}, const char* file = __builtin_FILE(), int line = __builtin_LINE());
  /// |computed - expected| <= tolerance, in the unit of the quantity.
  void near(const std::string& quantity, const std::string& unit, double computed, double expected, double tolerance,
            const std::string& origin = {}, const char* file = __builtin_FILE(), int line = __builtin_LINE());
  /// computed <= bound: residuals and other things that ought to vanish.
  void at_most(const std::string& quantity, const std::string& unit, double computed, double bound,
               const std::string& origin = {}, const char* file = __builtin_FILE(), int line = __builtin_LINE());
  /// computed >= bound: rates of convergence.
  void at_least(const std::string& quantity, const std::string& unit, double computed, double bound,
                const std::string& origin = {}, const char* file = __builtin_FILE(), int line = __builtin_LINE());

  void plot(RecordedPlot plot);
  /// Errors over a mesh size or step with the slope of the order that theory promises, through the finest.
  void convergence(const std::string& title, const std::string& x_label, const std::string& y_label,
                   const std::string& label, const std::vector<double>& sizes, const std::vector<double>& errors,
                   double order);

 private:
  enum class Kind { relative, absolute, at_most, at_least };
  struct Row {
    std::string quantity, unit, origin;
    Kind kind = Kind::relative;
    double computed = 0, expected = 0, tolerance = 0, used = -1;  ///< `used`: share of the tolerance
    int comparisons = 0;
  };
  void add(Row row, bool holds, const char* file, int line);
  [[nodiscard]] std::string text() const;

  std::string title_, reference_;
  std::vector<Row> rows_;
  std::vector<RecordedPlot> plots_;
};

}  // namespace annulus::test
