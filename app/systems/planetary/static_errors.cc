#include "app/systems/planetary/static_errors.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace annulus::app {

using dynamics::StaticTurn;

namespace {

enum class Positions { places, phases };

/// One of its places, or phases, in two.
StaticTurn every_second(const StaticTurn& turn, Positions of, std::size_t from) {
  const bool places = of == Positions::places;
  StaticTurn half = turn;
  half.positions.clear();
  const auto phases = static_cast<std::size_t>(turn.schedule.phases);
  if (places) {
    half.schedule.cycles.clear();
    for (std::size_t i = from; i < turn.schedule.cycles.size(); i += 2)
      half.schedule.cycles.push_back(turn.schedule.cycles[i]);
  } else {
    half.schedule.phases = static_cast<int>((phases + 1 - from) / 2);
  }
  for (std::size_t i = 0; i < turn.positions.size(); ++i)
    if ((places ? i / phases : i % phases) % 2 == from) half.positions.push_back(turn.positions[i]);
  return half;
}

std::vector<StaticTurn> one_by_one(const StaticTurn& turn) {
  std::vector<StaticTurn> list;
  const auto phases = static_cast<std::ptrdiff_t>(turn.schedule.phases);
  for (std::size_t i = 0; i < turn.schedule.cycles.size(); ++i) {
    auto& place = list.emplace_back();
    place.schedule = {{turn.schedule.cycles[i]}, turn.schedule.phases};
    const auto first = turn.positions.begin() + static_cast<std::ptrdiff_t>(i) * phases;
    place.positions.assign(first, first + phases);
  }
  return list;
}

std::vector<double> by_place(const StaticResult& result, const std::vector<StaticTurn>& places) {
  std::vector<double> list;
  for (const auto& place : places) list.push_back(result.largest(place));
  return list;
}
std::size_t largest_of(const std::vector<double>& list) {
  return static_cast<std::size_t>(std::max_element(list.begin(), list.end()) - list.begin());
}

}  // namespace

StaticTurn decisive_places(const StaticResults& results, const StaticTurn& turn) {
  const auto places = one_by_one(turn);
  std::set<std::size_t> decisive;
  for (const auto& result : results) decisive.insert(largest_of(by_place(result, places)));
  StaticTurn part = turn;
  part.positions.clear();
  part.schedule.cycles.clear();
  for (const auto place : decisive) {
    part.schedule.cycles.push_back(turn.schedule.cycles[place]);
    part.positions.insert(part.positions.end(), places[place].positions.begin(), places[place].positions.end());
  }
  return part;
}

void StaticErrors::add(const std::string& key, double ErrorParts::*part, double error) {
  const auto entry = *figures_.find(key);
  auto parts = entry.parts;
  parts.*part += error;
  figures_.set(key, {entry.figure.value, parts.total()}, parts);
}

void StaticErrors::add_difference(const StaticTurn& other, double ErrorParts::*part, double weight) {
  for (const auto& result : results_)
    add(result.key, part,
        (result.course == Course::smooth ? weight : 1) * std::abs(result.largest(other) - figures_.value(result.key)));
}

/// What the largest values may be missed by between places that follow each other smoothly around a turn: the sagitta
/// of a parabola through the largest and its neighbours.
void StaticErrors::add_between(const StaticTurn& turn) {
  const auto places = one_by_one(turn);
  const std::size_t count = places.size();
  if (count < 3) return;
  for (const auto& result : results_) {
    const auto list = by_place(result, places);
    const auto at = largest_of(list);
    add(result.key, &ErrorParts::interpolation,
        std::abs(list[(at + count - 1) % count] - 2 * list[at] + list[(at + 1) % count]) / 8);
  }
}

void StaticErrors::add_positions(const StaticTurn& turn, Periods periods) {
  if (periods == Periods::one) add_between(turn);
  // The other half has the largest value where one does not.
  for (const std::size_t from : {0u, 1u}) {
    if (turn.schedule.cycles.size() > 1)
      add_difference(every_second(turn, Positions::places, from), &ErrorParts::interpolation,
                     periods == Periods::one ? of_half_the_points : 1);
    if (turn.schedule.phases > 1)
      add_difference(every_second(turn, Positions::phases, from), &ErrorParts::interpolation, of_half_the_points);
  }
}

}  // namespace annulus::app
