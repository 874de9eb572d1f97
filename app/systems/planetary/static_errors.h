#pragma once

#include <string>
#include <utility>

#include "app/systems/planetary/static_results.h"

/// Errors of an equilibrium over a turn: what other turns make of its results.
namespace annulus::app {

/// The positions of the places at which any result is largest: a small change of the stage changes it there.
[[nodiscard]] dynamics::StaticTurn decisive_places(const StaticResults& results, const dynamics::StaticTurn& turn);

/// Results whose errors are added up part by part.
class StaticErrors {
 public:
  /// `figures`: the values with the errors that they have already.
  StaticErrors(const StaticResults& results, FigureSet figures) : results_(results), figures_(std::move(figures)) {}

  /// The difference to another turn, as an error of `part`; `weight`: of results that change smoothly.
  void add_difference(const dynamics::StaticTurn& other, double ErrorParts::*part, double weight = 1);
  /// What lies between the positions of the turn. `periods` of the housing: one is met smoothly by the places, several
  /// at once by chance.
  enum class Periods { one, several };
  void add_positions(const dynamics::StaticTurn& turn, Periods periods);

  [[nodiscard]] const FigureSet& figures() const { return figures_; }

 private:
  void add(const std::string& key, double ErrorParts::*part, double error);
  void add_between(const dynamics::StaticTurn& turn);

  const StaticResults& results_;
  FigureSet figures_;
};

/// The weight of a difference to half as many points of a smooth course: what lies between points falls with the square
/// of their distance, so half of them leave four times as much.
inline constexpr double of_half_the_points = 1.0 / 3;

}  // namespace annulus::app
