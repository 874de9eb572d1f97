#pragma once

#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/figures/mesh_results.h"
#include "dynamics/figures/shaft_results.h"
#include "dynamics/modes/modes.h"
#include "dynamics/system/drive_line.h"

namespace annulus::dynamics {

/// A gear set as a part of a train: the lumped model of any kind, and its bodies that turn about the axis.
struct TrainPart {
  std::string name;
  LumpedCase lumped;
  std::vector<ShaftEnd> ends{};
};

/// A shaft between a body of one part and one of another.
struct TrainShaft {
  std::string name;
  struct End {
    std::string part, body;
  };
  End from, to;
  double stiffness = 0;      ///< N m/rad
  double damping_ratio = 0;  ///< as of a Rotor
  double half_backlash = 0;  ///< rad
};

/// Gear sets in line, on shafts between them. SI. A value type.
///
/// All parts carry the same power: torque and speed of the two bodies that a shaft connects agree, and one part
/// delivers what the other takes. With the constant loads of both bodies taken away, the shaft passes on the torque T
/// of
///
///   T = k g(d) + c d' ,  d = -(s_1 th_1 + s_2 th_2)
///
/// to both of them in the sense of their loads s_1, s_2 = +-1. Rotations th keep the sense that they have in their
/// parts: where both parts turn steadily, d does not change. Every part keeps its own frame.
struct Train {
  std::vector<TrainPart> parts;
  std::vector<TrainShaft> shafts;
  std::vector<Rotor> rotors{};  ///< on bodies "part.body" without a shaft between parts

  /// All bodies, by names "part.body", with the reasons why no rotor can stand on them.
  [[nodiscard]] std::vector<ShaftEnd> shaft_ends() const;
  /// Throws InputError, naming shaft, part or body, when the train cannot be assembled: names that occur twice, parts
  /// that no shaft reaches, shafts in a ring, bodies with two shafts, torques of the ends of a shaft that differ by
  /// more than 1e-6.
  void check() const;
};

/// The train as elements: DOFs and meshes of each part behind the other, their names with "part." in front; elements
/// of the shafts by their names behind them, then those of the rotors (with_rotors). Throws what `check` throws.
[[nodiscard]] LumpedSystem assemble(const Train& train);

/// Mesh cycles of the fastest mesh after which all parts and torques of rotors repeat; never_repeats where their
/// frequencies have no common multiple below 1e6 cycles. Frequencies agree with a ratio of whole numbers to 1e-9.
[[nodiscard]] SteadyProblem steady_problem(const Train& train);
[[nodiscard]] LumpedCase lumped_case(const Train& train);

/// A gear mesh of a train.
struct TrainMesh {
  std::string part, name;
  double frequency = 0;       ///< Hz
  double mean_force = 0;      ///< N
  Figure dynamic_factor;      ///< K_V, see BranchResult
  Figure largest_force;       ///< N
  double smallest_force = 0;  ///< N; negative on back flanks
  Figure contact_loss;        ///< fraction of the time
};

struct TrainResponse : SteadyOutcome {
  double mesh_frequency = 0;  ///< Hz, of the mesh cycles in which windows are counted
  std::vector<TrainMesh> meshes;
  std::vector<ShaftResult> shafts;  ///< between the parts, then of the rotors
  TimeSeries series;                ///< with `keep_series`
};

/// Steady state of the train and its results: with the common period of all meshes where it is no longer than
/// `max_window_cycles`, else over a window of that length, by time integration. Throws what `steady_response` throws.
[[nodiscard]] TrainResponse simulate(const Train& train, const SimulationOptions& options = {});

[[nodiscard]] Modes modes(const Train& train);

inline constexpr int train_frequencies = 8;
/// The results of a train, each declared once.
[[nodiscard]] const std::vector<FigureSpec>& train_figures();
[[nodiscard]] FigureSet figures(const TrainResponse& response);

}  // namespace annulus::dynamics
