#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace annulus {

/// A natural mode of the ring with its supports, normalised to unit modal mass. Deflections are displacements of the
/// ring's teeth along the line of action, positive where they add to the deflection of the mesh, at the place of a
/// contact in the pitch point (phase 0): deflection[t] is that of a planet at ring position coordinate t. The ring's
/// frame has x through the centre of tooth 0; the pitch point stands at StiffnessTable::ring_angles.
struct RingMode {
  double frequency = 0;            ///< Hz
  int waves = 0;                   ///< dominant number of waves around the ring
  std::vector<double> deflection;  ///< kg^-1/2, one per ring tooth
  /// Inertial coupling to the rigid motions of the ring (unit amplitudes): integral of density x shape . motion.
  double translation_x = 0, translation_y = 0;  ///< kg^1/2, in the ring's frame
  double rotation = 0;                          ///< kg^1/2, motion: base radius x angle = 1
};

/// How the meshes of all planets with one ring act on each other through the ring: the contract between the
/// finite-element and the lumped side, next to the stiffness table of a single mesh.
///
/// The deflection of mesh n falls by sum_m compliance(n, m) F_m beyond that of the stiffness table of the single mesh.
/// The diagonal is therefore zero for a ring with linear supports; where pins lift off it shows how the presence of the
/// other planets changes the mesh itself.
struct RingCoupling {
  int planets = 0;
  int ring_teeth = 0;
  double load = 0;  ///< N per mesh, under which the supports were found to touch
  /// m/N, planets x planets, symmetric. One per ring position (see StiffnessTable), planet 1 meshing at its phase 0;
  /// `per_cycle` of them per mesh cycle, then the next tooth.
  std::vector<Eigen::MatrixXd> compliance;
  int per_cycle = 1;
  std::vector<RingMode> modes;  ///< rising frequency; may be empty
  /// kg, of what moves of the ring, and its moment of inertia / base radius^2: what the inertial couplings of all modes
  /// would add up to in squares. 0: not known.
  double mass = 0, rotational_mass = 0;

  /// Key: value lines in front of the file (provenance).
  std::vector<std::pair<std::string, std::string>> provenance;

  void write_csv(const std::filesystem::path& compliance_file, const std::filesystem::path& modes_file) const;
  /// Throws InputError naming file and line.
  [[nodiscard]] static RingCoupling read_csv(const std::filesystem::path& compliance_file,
                                             const std::filesystem::path& modes_file);
};

}  // namespace annulus
