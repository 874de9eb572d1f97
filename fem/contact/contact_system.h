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
#include "fem/loaded_mesh.h"

namespace annulus::fem {

/// Half-width of a line contact after Hertz, b = sqrt(4 F' / (pi E* kappa)), E* = E / (2 (1 - nu^2)) for two bodies of
/// the same material (Johnson, Contact Mechanics, 4.2). F' in N/m, kappa the relative curvature in 1/m.
[[nodiscard]] double hertz_half_width(double line_load, double relative_curvature, const Material& material);

struct ContactOptions {
  double element = 0;    ///< m, length of a pressure element: no finer than the flank's cells, which could not tell
  double window = 1.25;  ///< half-length of a pair's contact window in Hertz half-widths of the whole load
};

/// All tooth pairs (and supports) of one gear mesh as one complementarity problem per position.
class ContactSystem {
 public:
  /// References are kept; `supports` may be null. `slice_edges` as for the bodies.
  ContactSystem(const FlankContact& flanks, const ContactBody& planet, const ContactBody& wheel,
                const SupportRow* supports, const Material& material, std::vector<double> slice_edges,
                ContactOptions options);

  /// Active elements by pair, to start the neighbouring position from.
  using WarmStart = std::map<int, std::vector<bool>>;
  /// The tooth pairs of one phase and load: the same in every mesh cycle, only the supports move on.
  struct Pairs;
  using PairsCache = std::shared_ptr<const Pairs>;

  /// Position in mesh cycles from the pitch-point contact of teeth 0. `cache` and `warm` are used when they fit, and
  /// replaced. `forces` may be null.
  [[nodiscard]] LoadedPosition solve(int cycle, double phase, double load, PairsCache& cache, WarmStart& warm,
                                     ContactForces* forces) const;

 private:
  struct Pair;
  [[nodiscard]] std::vector<Pair> find_pairs(double phase, double load, double window) const;
  [[nodiscard]] PairsCache prepare(double phase, double load, double window) const;
  /// Number of the wheel's tooth in pair `index` during mesh cycle `cycle`.
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
  ContactOptions options_;
};

}  // namespace annulus::fem
