#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dynamics/curve_bundle.h"
#include "dynamics/force_surface.h"
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
  int first_error = 0, last_error = 0;  ///< of Compiled::errors
  SlotTerm ripple;
  double low = 0, high = 0, duty = 0;
  const CurveBundle* table = nullptr;  ///< secant and unloaded transmission error; of Compiled::bundles
  const ForceSurface* surface = nullptr;
};

/// What the right-hand side reads, without the names and reasons.
struct LumpedSystem::Compiled {
  std::vector<int> row_start, column;      ///< common pattern of ...
  std::vector<double> stiffness, damping;  ///< ... M^-1 (K + K_Omega) and M^-1 (C + G)
  Eigen::VectorXd acceleration;            ///< M^-1 f
  /// The acceleration less M^-1 f as one sparse matrix: row i is [pair_start[i], pair_start[i + 1]). A column is a pair
  /// of numbers in Workspace::pairs, (q_j, v_j) first and two mesh forces at a time after them.
  std::vector<int> pair_start, pair_column;
  std::vector<double> pair_factor;
  struct PowerTerm {
    int i = 0, j = 0;
    double damping = 0, circulatory = 0;  ///< C_ij and the skew part of K_Omega
  };
  std::vector<PowerTerm> power;  ///< nonzero entries
  FlatRows b, inverse_b;         ///< b and M^-1 b per mesh
  std::vector<double> rates;     ///< rad/s, one per slot
  std::vector<SlotTerm> errors;
  std::vector<CompiledMesh> meshes;
  std::vector<std::unique_ptr<const CurveBundle>> bundles;  ///< equal ones once
  std::vector<std::shared_ptr<const ForceSurface>> surfaces;
};

/// Deflection beyond the backlash in a held contact state.
inline double penetration(const CompiledMesh& mesh, LumpedSystem::Contact contact, double delta) {
  if (mesh.linear) return delta;
  return contact == LumpedSystem::Contact::open ? 0.0 : delta - static_cast<int>(contact) * mesh.half_backlash;
}

inline double acting_damping(const CompiledMesh& mesh, LumpedSystem::Contact contact) {
  return contact != LumpedSystem::Contact::open || mesh.damping_without_contact ? mesh.damping : 0.0;
}

/// Is the rectangular wave high at this time?
bool wave_is_high(const CompiledMesh& mesh, double t);

}  // namespace annulus::dynamics
