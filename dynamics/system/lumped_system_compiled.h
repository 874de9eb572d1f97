#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "dynamics/system/curve_bundle.h"
#include "dynamics/system/force_surface.h"
#include "dynamics/system/lumped_system.h"

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
  SqueezeFilm film;                        ///< coefficient 0: none
  double film_backlash = 0;                ///< half of it
  double frequency = 0, phase_offset = 0;  ///< the phase shift of the excitation included
  double constant_error = 0;
  int first_error = 0, last_error = 0;        ///< of Compiled::errors
  int first_tooth = 0, last_tooth = 0;        ///< of Compiled::tooth_errors
  int first_moving = 0, last_moving = 0;      ///< of Compiled::moving
  int first_friction = 0, last_friction = 0;  ///< of Compiled::friction
  bool coupled = false;
  int face = -1;                             ///< of LumpedSystem::faces whose approach it is
  const CurveBundle* face_course = nullptr;  ///< slope, curvature, gap slope; of Compiled::bundles
  double face_phase = 0;                     ///< mesh cycles, of the course at time 0
  SlotTerm ripple;
  double low = 0, high = 0, duty = 0;
  const CurveBundle* table = nullptr;  ///< secant and unloaded transmission error; of Compiled::bundles
  const ForceSurface* surface = nullptr;
  bool mirrored = false;  ///< back flanks read the table at `back_flank_phase` less the phase
  double back_flank_phase = 0;
};

struct CompiledToothError {
  const CurveBundle* curve = nullptr;  ///< of one curve
  double phase_offset = 0;
};

struct CompiledShare {
  int dof = 0, slot = 0;  ///< slot: index into Compiled::moving_dofs
  double constant = 0;
  SlotTerm wave;
  bool waves = false;
  const CurveBundle* curve = nullptr;  ///< of one curve, or none
  double frequency = 0, phase_offset = 0;
};

struct CompiledFriction {
  Eigen::VectorXd along, acceleration;  ///< force and M^-1 force on the DOFs per |F| and value of the curve
  const CurveBundle* curve = nullptr;   ///< of one curve
  double frequency = 0, phase_offset = 0;
};

struct CompiledCoupling {
  std::vector<int> meshes;
  double frequency = 0, phase_offset = 0;
  CurveBundle compliance;  ///< lower triangle row by row
  int offset = 0;          ///< of the matrix (column-major) in Workspace::compliance
  struct RetainedMode {
    double compliance = 0;    ///< of the mode, m/N
    std::vector<int> shares;  ///< of Compiled::moving, one per mesh, -1: none
  };
  std::vector<RetainedMode> retained;
};

inline constexpr int largest_coupling = 20;
/// Matrices of a coupling live on the stack.
using CouplingMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, largest_coupling, largest_coupling>;
using CouplingVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, largest_coupling, 1>;

/// Data of the right-hand side in flat arrays.
struct LumpedSystem::Compiled {
  std::vector<int> row_start, column;      ///< common pattern of ...
  std::vector<double> stiffness, damping;  ///< ... M^-1 (K + K_Omega) and M^-1 (C + G)
  Eigen::VectorXd acceleration;            ///< M^-1 f, of the constant part
  struct HarmonicAcceleration {
    std::size_t slot = 0;
    Eigen::VectorXd sine, cosine;
  };
  std::vector<HarmonicAcceleration> harmonic;
  /// The acceleration without M^-1 f as one sparse matrix: row i is [pair_start[i], pair_start[i + 1]). A column is a
  /// pair of numbers in Workspace::pairs: first all (q_j, v_j), then two mesh forces at a time, then two forces on
  /// `moving_dofs` at a time.
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
  std::vector<CompiledToothError> tooth_errors;
  std::vector<CompiledMesh> meshes;
  std::vector<CompiledShare> moving;       ///< in the order of the meshes
  std::vector<int> moving_dofs;            ///< each once
  std::vector<CompiledFriction> friction;  ///< in the order of the meshes
  Eigen::MatrixXd inverse_moving;          ///< columns of M^-1 of moving_dofs
  std::vector<CompiledCoupling> couplings;
  std::vector<std::unique_ptr<const CurveBundle>> bundles;  ///< equal ones once
  std::vector<std::shared_ptr<const ForceSurface>> surfaces;
};

/// Deflection beyond the backlash in a held contact state.
inline double penetration(const CompiledMesh& mesh, LumpedSystem::Contact contact, double delta) {
  if (mesh.linear) return delta;
  return contact == LumpedSystem::Contact::open ? 0.0 : delta - static_cast<int>(contact) * mesh.half_backlash;
}

/// Damping of the oil between flanks that approach each other, and its slope over the deflection.
struct FilmDamping {
  double damping = 0, slope = 0;  ///< N s/m, N s/m^2
};
inline FilmDamping film_damping(const CompiledMesh& mesh, double delta, double rate) {
  const double side = rate > 0 ? 1 : -1, gap = mesh.film_backlash - side * delta;
  const double film = std::max(gap, mesh.film.least_gap);
  const double damping = mesh.film.coefficient / (film * std::sqrt(film));
  return {damping, gap > mesh.film.least_gap ? 1.5 * side * damping / film : 0.0};
}

/// dF/d delta' of a mesh over the pace.
inline double acting_damping(const CompiledMesh& mesh, LumpedSystem::Contact contact, double delta, double rate) {
  if (contact != LumpedSystem::Contact::open) return mesh.damping;
  const double of_film = mesh.film.coefficient > 0 ? film_damping(mesh, delta, rate).damping : 0.0;
  return of_film + (mesh.damping_without_contact ? mesh.damping : 0.0);
}

/// dF/d delta of its dampers.
inline double damping_tangent(const CompiledMesh& mesh, LumpedSystem::Contact contact, double delta, double rate) {
  if (contact != LumpedSystem::Contact::open || mesh.film.coefficient == 0) return 0;
  return film_damping(mesh, delta, rate).slope * rate;
}

inline LumpedSystem::Contact contact_of(const CompiledMesh& mesh, double delta) {
  if (mesh.linear || delta > mesh.half_backlash) return LumpedSystem::Contact::drive;
  return delta < -mesh.half_backlash ? LumpedSystem::Contact::back : LumpedSystem::Contact::open;
}

/// Where a table is read, mesh cycles, and how fast that moves: 1 with time or, at back flanks, -1.
struct TablePlace {
  double cycles = 0, direction = 1;
};
inline TablePlace table_place(const CompiledMesh& mesh, LumpedSystem::Contact contact, double t) {
  const double cycles = mesh.frequency * t + mesh.phase_offset;
  if (!mesh.mirrored || contact != LumpedSystem::Contact::back) return {cycles, 1};
  return {mesh.back_flank_phase - cycles, -1};
}

/// Force and tangent of mirrored back flanks, which are rarely in contact and not part of the excitation.
inline ForceSurface::Value back_flank_law(const CompiledMesh& mesh, double t, double g) {
  const auto [cycles, direction] = table_place(mesh, LumpedSystem::Contact::back, t);
  if (mesh.surface) return (*mesh.surface)(cycles, g);
  double values[2], derivatives[2];
  mesh.table->evaluate(cycles, values, derivatives);
  return {values[0] * g, values[0]};
}

/// Elastic force and tangent of mesh m at a deflection g beyond the backlash, of flanks in contact.
inline ForceSurface::Value law_in_contact(const CompiledMesh& mesh, std::size_t m, LumpedSystem::Contact contact,
                                          double g, const LumpedSystem::Workspace& w) {
  if (mesh.mirrored && contact == LumpedSystem::Contact::back) return back_flank_law(mesh, w.time, g);
  return mesh.surface ? mesh.surface->at(w.location[m], g) : ForceSurface::Value{w.stiffness[m] * g, w.stiffness[m]};
}

/// A place of a face: its contact, its deflection beyond the backlash and its weight.
struct PlaceState {
  LumpedSystem::Contact contact = LumpedSystem::Contact::open;
  double g = 0, weight = 0;
};
/// At deflections of the approach and the tilt (m), with the course of the face at that time.
inline PlaceState place_state(const FaceElement& face, const FaceElement::Place& place,
                              const std::array<double, 6>& shape, double approach, double tilt) {
  using Contact = LumpedSystem::Contact;
  const auto [slope, curvature, gap_slope, slope_rate, curvature_rate, gap_rate] = shape;
  const double z = place.z;
  const double weight = place.weight * (1 + slope * z + curvature * (1.5 * z * z - 0.5));
  const double x = approach + z * tilt, driving = x - place.gap - gap_slope * (z - slope / 3);
  if (!face.half_backlash) return {driving >= 0 ? Contact::drive : Contact::back, driving, weight};
  if (driving > *face.half_backlash) return {Contact::drive, driving - *face.half_backlash, weight};
  if (x < -*face.half_backlash) return {Contact::back, x + *face.half_backlash, weight};
  return {Contact::open, 0, weight};
}
/// d weight / dt and d gap / dt of the driving flanks.
struct PlaceRates {
  double weight = 0, gap = 0;
};
inline PlaceRates place_rates(const FaceElement::Place& place, const std::array<double, 6>& shape) {
  const auto [slope, curvature, gap_slope, slope_rate, curvature_rate, gap_rate] = shape;
  const double z = place.z;
  return {place.weight * (slope_rate * z + curvature_rate * (1.5 * z * z - 0.5)),
          gap_rate * (z - slope / 3) - gap_slope * slope_rate / 3};
}

/// Elastic forces and tangents of a mesh along its face; `across`: between its approach and its tilt.
void apply_face(const FaceElement& face, const CompiledMesh& mesh, LumpedSystem::Workspace& w, double& across);

/// Elastic force and tangent by the law of one mesh, from deflection and contact state in the workspace.
inline void apply_law(const CompiledMesh& mesh, std::size_t m, LumpedSystem::Workspace& w) {
  const auto contact = w.contact[m];
  if (!mesh.linear && contact == LumpedSystem::Contact::open) {
    w.elastic[m] = w.tangent[m] = 0;
    return;
  }
  const double g = penetration(mesh, contact, w.delta[m]);
  const auto value = law_in_contact(mesh, m, contact, g, w);
  w.elastic[m] = value.force;
  w.tangent[m] = value.tangent;
}

/// Writes D at time t, from the moving factors of the workspace, to Workspace::compliance.
void evaluate_compliance(const CompiledCoupling& coupling, double t, LumpedSystem::Workspace& w);
/// dD/dt, m/(N s).
CouplingMatrix compliance_rate(const CompiledCoupling& coupling, double t, const LumpedSystem::Workspace& w);
/// Elastic forces of the coupled meshes from Workspace::approach.
void solve_coupling(const CompiledCoupling& coupling, const std::vector<CompiledMesh>& meshes,
                    const std::vector<FaceElement>& faces, LumpedSystem::ContactStates states,
                    LumpedSystem::Workspace& w);
/// d elastic / d approach of the coupled meshes, N/m.
CouplingMatrix coupled_tangent(const CompiledCoupling& coupling, const LumpedSystem::Workspace& w);

/// Is the rectangular wave high at this time?
bool wave_is_high(const CompiledMesh& mesh, double t);

}  // namespace annulus::dynamics
