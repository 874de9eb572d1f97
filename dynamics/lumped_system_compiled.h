#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/lumped_system.h"

namespace annulus::dynamics {

/// Sparse rows in flat arrays: row i is [start[i], start[i + 1]).
struct FlatRows {
  std::vector<int> start, index;
  std::vector<double> factor;
};

/// sine x sin(rate t) + cosine x cos(rate t), rate by slot.
struct SlotTerm {
  std::size_t slot = 0;
  double sine = 0, cosine = 0;
};

struct CompiledMesh {
  enum class Kind { constant, harmonic, wave, table };
  Kind kind = Kind::constant;
  bool linear = true, damping_without_contact = false;
  double mean = 0, damping = 0, half_backlash = 0;
  double frequency = 0, phase_offset = 0;  ///< the phase shift of the excitation included
  double constant_error = 0;
  std::vector<SlotTerm> errors;
  SlotTerm ripple;
  double low = 0, high = 0, duty = 0;
  PeriodicCurve secant, unloaded_te;
};

/// What the right-hand side reads, without the names and reasons.
struct LumpedSystem::Compiled {
  std::vector<int> row_start, column;      ///< common pattern of ...
  std::vector<double> stiffness, damping;  ///< ... M^-1 (K + K_Omega) and M^-1 (C + G)
  Eigen::VectorXd acceleration;            ///< M^-1 f
  struct PowerTerm {
    int i = 0, j = 0;
    double damping = 0, circulatory = 0;  ///< C_ij and the skew part of K_Omega
  };
  std::vector<PowerTerm> power;  ///< nonzero entries
  FlatRows b, inverse_b;         ///< b and M^-1 b per mesh
  std::vector<double> rates;     ///< rad/s, one per slot
  std::vector<CompiledMesh> meshes;
};

}  // namespace annulus::dynamics
