#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/time_integration/course.h"

namespace annulus::app {

enum class SweepScale { linear, logarithmic };
enum class ErrorPhases { given, unknown };
enum class Goal { smallest, largest };
enum class RandomKind { uniform, normal, lognormal };

/// How the motions of a row of values are found.
enum class SweepDirection {
  each,  ///< every value by itself
  up,    ///< followed in time from value to value, rising
  down,
  both,     ///< up and down
  branches  ///< both, and the branches of periodic motions between the ends
};
inline constexpr std::array<const char*, 5> direction_names{"each", "up", "down", "both", "branches"};

/// One input run through a row of values. Values of studies are in the unit of their input, as in the file.
struct SweepInput {
  std::string input;               ///< key path (overrides.h)
  std::optional<double> from, to;  ///< these and `count`, or `values`
  std::optional<int> count;
  SweepScale scale = SweepScale::linear;
  std::vector<double> values;
  SweepDirection direction = SweepDirection::each;

  [[nodiscard]] std::vector<double> points() const;
  [[nodiscard]] bool goes_up() const { return direction != SweepDirection::each && direction != SweepDirection::down; }
  [[nodiscard]] bool goes_down() const { return direction != SweepDirection::each && direction != SweepDirection::up; }
};

/// Two inputs run through all combinations of their values.
struct GridInput {
  SweepInput x, y;
};

/// An uncertain input.
struct RandomInput {
  std::string input;  ///< key path; `[*]` draws for every planet by itself
  RandomKind distribution = RandomKind::uniform;
  std::optional<double> low, high, mean, deviation;
};

struct MonteCarloInput {
  int samples = 0, seed = 0;
  ErrorPhases phases = ErrorPhases::unknown;
};

/// An input that an optimiser may change.
struct VariableInput {
  std::string input;  ///< key path
  double low = 0, high = 0;
  SweepScale scale = SweepScale::linear;
};

struct OptimiseInput {
  std::vector<std::string> objective;  ///< columns of figures
  std::vector<double> weights;         ///< one per figure; empty: their mean
  Goal goal = Goal::smallest;
  std::optional<std::string> variant;   ///< absent: the first one
  std::vector<std::string> optimisers;  ///< names of dynamics::Optimiser
  int generations = 0, population = 0, repeats = 0, seed = 0;
  double elite = 0, crossover = 0, mutation = 0;
  int starts = 0;  ///< initial conditions tried before and after
};

/// Inputs that change from class to class of a load spectrum.
struct LoadSpectrumInput {
  std::vector<std::string> inputs;  ///< key paths
};

struct LoadClassInput {
  std::string name;
  double duration = 0;         ///< s
  std::vector<double> values;  ///< one per input
};

/// Speed and torque that change in time.
struct TransientInput {
  std::string name;
  std::vector<double> time;           ///< s, from 0 on
  std::vector<double> speed, torque;  ///< factors, one per time; empty: 1
  dynamics::AcceleratedBy accelerated_by = dynamics::AcceleratedBy::drive;
  [[nodiscard]] dynamics::Course course() const {
    dynamics::Course course;
    for (std::size_t i = 0; i < time.size(); ++i)
      course.points.push_back({time[i], speed.empty() ? 1 : speed.at(i), torque.empty() ? 1 : torque.at(i)});
    return course;
  }
};

struct SensitivityInput {
  std::vector<std::string> inputs;  ///< empty: the supports, damping ratios and backlash
  double factor = 0;
};

/// The studies that a scene requests, whatever its kind.
struct StudyInput {
  std::vector<SweepInput> sweeps;
  std::vector<GridInput> grids;
  std::optional<LoadSpectrumInput> load_spectrum;
  std::vector<LoadClassInput> load_classes;
  std::vector<TransientInput> transients;
  std::optional<MonteCarloInput> monte_carlo;
  std::vector<RandomInput> random_inputs;
  std::optional<SensitivityInput> sensitivity;
  std::optional<OptimiseInput> optimise;
  std::vector<VariableInput> variables;  ///< of [optimise]
};

}  // namespace annulus::app
