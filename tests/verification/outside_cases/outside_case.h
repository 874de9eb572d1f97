#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tests/temporary_folder.h"

/// The cases in data/cases: published results with their scenes.
namespace annulus::test {

/// A number as a source prints it.
struct PrintedValue {
  std::string unit;
  double value = 0;
  double half_unit = 0;  ///< half a unit of the last printed digit
};

class OutsideCase {
 public:
  /// Reads data/cases/NAME/printed.csv.
  explicit OutsideCase(const std::string& name);

  [[nodiscard]] const PrintedValue& printed(const std::string& quantity) const { return printed_.at(quantity); }
  [[nodiscard]] std::filesystem::path scene(const std::string& file) const;
  /// `annulus check`, then `annulus run`; the folder of its results, which lives as long as this. A failed check of the
  /// test when either fails.
  [[nodiscard]] std::filesystem::path run(const std::string& file) const;
  /// `annulus solve` with further arguments; the folder of its results.
  [[nodiscard]] std::filesystem::path solve(const std::string& file, const std::string& arguments) const;
  /// `annulus statics` with further arguments; the folder of its results.
  [[nodiscard]] std::filesystem::path statics(const std::string& file, const std::string& arguments) const;

 private:
  [[nodiscard]] std::filesystem::path with_arguments(const std::string& command, const std::string& file,
                                                     const std::string& arguments) const;

  std::string name_;
  std::map<std::string, PrintedValue> printed_;
  TemporaryFolder folder_;
};

}  // namespace annulus::test
