#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/errors.h"

namespace annulus::app {

/// A value as written in a scene file, in the unit of its key; monostate when absent.
using Value = std::variant<std::monostate, long, double, std::string, std::vector<double>, std::vector<std::string>>;

/// Short text of a value for people ("0.1516", "[15, 36]", "rigid" for an infinite stiffness).
[[nodiscard]] std::string to_text(const Value& value);
/// Shortest text that reads back as the same number, at most `digits` significant digits.
[[nodiscard]] std::string to_text(double value, int digits = 10);

enum class Origin { scene, default_value, derived };
[[nodiscard]] const char* to_text(Origin origin);

/// One input of a scene, with where it came from.
struct Input {
  std::string key;        ///< "stage.module_mm", "ring.pins"
  std::string variant{};  ///< name of the variant the value belongs to (Table::variants); empty elsewhere
  Value value{};
  std::string unit{};  ///< for people: "mm", "kg m²"
  Origin origin = Origin::scene;
  std::string meaning{};
  std::string note{};     ///< source of a default, formula of a derived value, what absence means
  std::string assumed{};  ///< reason, when the scene declares the value as assumed
  int line = 0, column = 0;
  std::size_t entry = 0;  ///< counts the tables of an array ([[ring]], [[sweep]])
};

/// One thing wrong with a scene.
struct Problem {
  int line = 0, column = 0;  ///< 0: not at one place
  std::string message;       ///< starts with the key path
};

/// Everything wrong with a scene, one line each: "file:line:column: key = value: rule; cure".
class SceneError : public InputError {
 public:
  SceneError(const std::string& file, std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The candidate with the smallest edit distance to `word`, if it is near enough to be what was meant; else empty.
[[nodiscard]] std::string nearest(const std::string& word, const std::vector<std::string>& candidates);
/// "; did you mean CANDIDATE?", or `otherwise` where none is near.
[[nodiscard]] std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                                       const std::string& otherwise = "");

}  // namespace annulus::app
