#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/systems/planetary/stage_statics.h"

/// What a turn of a stage in equilibrium results in: largest values over its positions.
namespace annulus::app {

/// How a result follows the positions; with kinks it changes suddenly, as the largest load along a face does.
enum class Course { smooth, with_kinks };

struct StaticResult {
  std::string key;
  std::function<double(const dynamics::StaticTurn&)> largest;  ///< SI
  Course course = Course::smooth;
};
using StaticResults = std::vector<StaticResult>;

/// Those of the meshes, bearings and bodies of a turn; they can be read from every other turn of the same stage.
[[nodiscard]] StaticResults results_of(const dynamics::StaticTurn& turn);
/// Their values by key, without errors.
[[nodiscard]] FigureSet values(const StaticResults& results, const dynamics::StaticTurn& turn);

/// The largest value of something in a turn; 0 where none is positive.
[[nodiscard]] double largest(const dynamics::StaticTurn& turn,
                             const std::function<double(const dynamics::StaticPosition&)>& value);

/// Keys among the results: `what` is radial, axial, moment or element.
[[nodiscard]] std::string bearing_key(std::size_t bearing, const char* what);
[[nodiscard]] std::string tilt_key(std::size_t body);

/// Results of the meshes as users see them.
[[nodiscard]] const std::vector<FigureSpec>& static_figures();

}  // namespace annulus::app
