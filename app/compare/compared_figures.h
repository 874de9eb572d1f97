#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace annulus::app {

/// A figure of merit that runs of one kind have in common.
struct ComparedFigure {
  std::string key;     ///< "ring_stiffness"; several figures may be definitions of the same thing
  std::string name;    ///< for people: "mean stiffness of the ring mesh"
  std::string unit{};  ///< for people
  double scale = 1;    ///< SI to that unit
  int digits = 4;
  std::vector<std::string> path{};  ///< in the summary of a ring (planetary) or of the run
  /// A member of the value's object, its error beside it; of a list the largest, or the entry so far behind zeros.
  enum class Form { estimate, figure, number, largest_of_list, list_entry };
  Form form = Form::figure;
  std::size_t entry = 0;
};

/// By the name of the kind of stage ("planetary"); empty for a name that is none.
[[nodiscard]] const std::vector<ComparedFigure>& compared_figures(const std::string& kind);

/// Value and absolute error of all of them by name, from the summary of a ring (planetary) or of a run as JSON; NaN
/// where it does not have them. Throws the JSON library's exceptions where something of another type stands there.
[[nodiscard]] std::map<std::string, std::pair<double, double>> read_figures(const std::string& kind,
                                                                            const std::string& summary);

}  // namespace annulus::app
