#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <vector>

#include "fem/contact/complementarity.h"
#include "fem/contact/contact_body.h"
#include "fem/contact/contact_forces.h"
#include "fem/contact/flank_contact.h"
#include "fem/contact/support_row.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// Half-width of a line contact after Hertz, b = sqrt(4 F' / (pi E* kappa)), E* = E / (2 (1 - nu^2)) for two bodies of
/// the same material (Johnson, Contact Mechanics, 4.2). F' in N/m, kappa the relative curvature in 1/m.
[[nodiscard]] double hertz_half_width(double line_load, double relative_curvature, const Material& material);

struct ContactOptions {
  /// Pressure elements to either side of the centre of a pair, over a half-window of `window`: independent of the mesh,
  /// fine at the centre, so that a pair that carries little has its share of them too. Bodies whose mesh alone carries
  /// the elements have elements as short as it allows instead.
  int elements = 10;
  double first = 0.35;      ///< length of the elements at the centre relative to a uniform split
  double window = 1.25;     ///< half-length of a pair's contact window in Hertz half-widths of the whole load
  double misalignment = 0;  ///< m, as in LoadedMeshProblem
  /// Bodies and slices are the lower half of a symmetric face (see SolvedFace); loads and results are those of the
  /// whole.
  bool half_face = false;
};

/// All tooth pairs (and supports) of one gear mesh as one complementarity problem per position.
class ContactSystem {
 public:
  /// References are kept; `supports` may be null. `slice_edges` as for the bodies.
  ContactSystem(const FlankContact& flanks, const ContactBody& planet, const ContactBody& wheel,
                const SupportRow* supports, const Material& material, std::vector<double> slice_edges,
                ContactOptions options);

  /// What carried at the neighbouring position, to start from: elements by pair, and supports (empty: not known).
  struct WarmStart {
    std::map<int, std::vector<bool>> pairs;
    std::vector<bool> supports;
  };
  /// The tooth pairs of one phase and load: the same in every mesh cycle, only the supports move on.
  struct Pairs;
  using PairsCache = std::shared_ptr<const Pairs>;

  /// Position in mesh cycles from the pitch-point contact of teeth 0. `cache` and `warm` are used when they fit, and
  /// replaced. `forces` may be null.
  [[nodiscard]] LoadedPosition solve(int cycle, double phase, double load, PairsCache& cache, WarmStart& warm,
                                     ContactForces* forces) const;

  /// Tooth pairs that may touch at a position: number, and planet roll length of their theoretical contact.
  [[nodiscard]] static std::vector<std::pair<int, double>> possible_pairs(const FlankContact& flanks, double phase);
  /// Hertz half-width (m) if a pair that touches at planet roll `roll` carried a whole line load (N/m).
  [[nodiscard]] static double half_width(const FlankContact& flanks, double roll, double line_load,
                                         const Material& material);
  /// Number of the wheel's tooth in pair `index` during mesh cycle `cycle`.
  [[nodiscard]] static int wheel_tooth(const FlankContact& flanks, int index, int cycle);

 private:
  struct Pair;
  struct Facing;
  /// Number and planet roll length of the pairs within the path of contact and a base pitch beyond.
  [[nodiscard]] static std::vector<std::pair<int, double>> candidate_pairs(const FlankContact& flanks, double phase);
  /// Wherever flanks may face each other at a phase; places, domains and gaps are not looked for.
  [[nodiscard]] std::vector<Facing> find_facing(double phase) const;
  /// m, how far a theoretical contact stands before (negative) or behind the path of contact.
  [[nodiscard]] double beyond_path(double roll) const;
  /// m, transmission error at which they touch in a slice.
  [[nodiscard]] double gap_without_load(const Facing& facing, int slice) const;
  /// Those that load may close: the pairs of `setup`, from its phase, load, window and reach.
  void find_pairs(Pairs& setup) const;
  void add_elements(Pair& pair, const Facing& facing, double load, double window) const;
  /// Distances of the elements' edges from the centre of a window towards one of its ends, `half` away, from 0 on. Arc
  /// lengths on the planet: `centre`, and `direction` 1 or -1.
  [[nodiscard]] std::vector<double> element_edges(const Pair& pair, double centre, double direction, double half,
                                                  int per_side) const;
  /// Length of the shortest element both flanks carry at a planet arc length, m.
  [[nodiscard]] double shortest_element(const Pair& pair, double arc) const;
  /// Change of the planet's roll at the contact along the face width: tan(base helix angle), signed.
  [[nodiscard]] static double roll_per_z(const FlankContact& flanks);
  [[nodiscard]] double slice_roll(int slice) const;
  [[nodiscard]] PairsCache prepare(double phase, double load, double window, double reach) const;
  [[nodiscard]] int wheel_tooth(int index, int cycle) const;
  [[nodiscard]] ComplementarityProblem assemble(const Pairs& pairs, int cycle) const;
  /// Resultants on the wheel (x, y, moments about z, x, y) of unit (element, slice) forces of a pair.
  [[nodiscard]] Eigen::MatrixXd wheel_resultants(const Pair& pair, int tooth) const;
  /// Final forces at the ports of both bodies and at the supports.
  [[nodiscard]] ContactForces port_forces(const Pairs& pairs, int cycle, const ComplementaritySolution& solution) const;
  [[nodiscard]] LoadedPosition evaluate(const Pairs& pairs, const ComplementarityProblem& problem,
                                        const ComplementaritySolution& solution) const;

  const FlankContact& flanks_;
  const ContactBody& planet_;
  const ContactBody& wheel_;
  const SupportRow* supports_;
  Material material_;
  std::vector<double> slice_edges_;
  std::vector<double> lead_gap_, smallest_lead_gap_;  // of every slice, the mean and the least, m
  ContactOptions options_;
  double normal_factor_;  // cos(base helix angle): normal approach of the flanks per transmission error
  double roll_per_z_;
};

}  // namespace annulus::fem
