#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/error_parts.h"

namespace annulus {

/// One entry of a stiffness table: a mesh at one phase, one ring position, one load.
struct StiffnessEntry {
  double unloaded_te = 0;        ///< m, along the line of action
  double lte = 0;                ///< loaded transmission error, m, along the line of action; includes unloaded_te
  double stiffness_secant = 0;   ///< F / (lte - unloaded_te), N/m
  double stiffness_tangent = 0;  ///< dF / d lte, N/m
  double error_relative = 0;     ///< estimated relative error of the stiffness
  ErrorParts error_parts{};      ///< of error_relative, where it is known what it is made of; else zero
};

/// Mesh stiffness over mesh phase x ring position x load: the contract between the finite-element and the lumped side.
///
/// Phases are equidistant in [0, 1), phase 0 being the position in which a tooth pair touches at the pitch point.
/// Ring positions count whole tooth pitches of the ring after which its structure repeats: one value when it repeats
/// with every tooth, z_r / gcd(z_r, p) values for p equal pins. Loads are strictly increasing total normal forces.
/// Advancing the phase by one moves to the next ring position.
class StiffnessTable {
 public:
  /// Entries are ordered [position][phase][load]. Throws InputError when sizes, order or values are not usable.
  StiffnessTable() = default;  ///< empty: without phases
  StiffnessTable(std::string mesh, int phases, std::vector<double> ring_angles, std::vector<double> loads,
                 std::vector<StiffnessEntry> entries);

  /// Its name; not empty.
  [[nodiscard]] const std::string& mesh() const { return mesh_; }
  [[nodiscard]] int phases() const { return phases_; }
  [[nodiscard]] int positions() const { return static_cast<int>(ring_angles_.size()); }
  [[nodiscard]] const std::vector<double>& ring_angles() const { return ring_angles_; }  ///< rad, one per position
  [[nodiscard]] const std::vector<double>& loads() const { return loads_; }              ///< N
  [[nodiscard]] const StiffnessEntry& at(int position, int phase, int load) const;

  /// Key: value lines in front of the CSV header (provenance: version, scene hash, model, ...).
  std::vector<std::pair<std::string, std::string>> provenance;

  void write_csv(const std::filesystem::path& file) const;
  /// Throws InputError naming file and line.
  [[nodiscard]] static StiffnessTable read_csv(const std::filesystem::path& file);

 private:
  std::string mesh_;
  int phases_ = 0;
  std::vector<double> ring_angles_;
  std::vector<double> loads_;
  std::vector<StiffnessEntry> entries_;
};

/// A periodic, continuously differentiable curve through equidistant values; period 1 per `values_per_unit` values.
///
/// The argument is the number of mesh cycles passed (position + phase), of any sign and size. Cubic Hermite pieces with
/// makima slopes ([Akima1970], modified): local (five values), exact for constants, no ringing beside a plateau, second
/// order in the spacing near extrema and third elsewhere. It is not monotone everywhere: beside a steep flank it may
/// pass the data slightly.
class PeriodicCurve {
 public:
  PeriodicCurve() = default;  ///< zero everywhere
  /// `values` spans the whole period: positions x phases values, `values_per_unit` of them per mesh cycle.
  PeriodicCurve(const std::vector<double>& values, int values_per_unit);

  [[nodiscard]] double operator()(double mesh_cycles) const;
  [[nodiscard]] double derivative(double mesh_cycles) const;  ///< per mesh cycle
  [[nodiscard]] double period() const { return period_; }     ///< mesh cycles
  [[nodiscard]] double mean() const { return mean_; }         ///< exact mean of the curve over its period

  [[nodiscard]] int pieces() const { return static_cast<int>(values_.size()) - 1; }  ///< in one period
  [[nodiscard]] int pieces_per_unit() const;                                         ///< in one mesh cycle
  /// c with value = c[0] + c[1] t + c[2] t^2 + c[3] t^3, t in [0, 1] within the piece.
  [[nodiscard]] std::array<double, 4> coefficients(int piece) const;
  /// Written out: annulus_fem is C++17, which has no default for it.
  [[nodiscard]] bool operator==(const PeriodicCurve& other) const {
    return values_ == other.values_ && slopes_ == other.slopes_ && step_ == other.step_ && period_ == other.period_ &&
           mean_ == other.mean_;
  }

 private:
  std::vector<double> values_{0, 0}, slopes_{0, 0};  ///< first one repeated at the end; slopes per knot distance
  double step_ = 1, period_ = 1, mean_ = 0;
};

/// The slopes of PeriodicCurve at its knots, per knot distance, for values that repeat. Needs finite values.
[[nodiscard]] std::vector<double> periodic_slopes(const std::vector<double>& values);

/// The curves the lumped model consumes, read from a table at one load (linear in load between tabulated loads).
/// Throws InputError when `load` lies outside the tabulated loads (by more than 1e-9 relative, which is rounding):
/// no silent clamping.
struct MeshCurves {
  PeriodicCurve stiffness_secant;   ///< N/m
  PeriodicCurve stiffness_tangent;  ///< N/m
  PeriodicCurve unloaded_te;        ///< m
  PeriodicCurve lte;                ///< m
};
[[nodiscard]] MeshCurves curves_at_load(const StiffnessTable& table, double load);

}  // namespace annulus
