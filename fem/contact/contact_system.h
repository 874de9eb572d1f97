#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "fem/contact/complementarity.h"
#include "fem/contact/contact_body.h"
#include "fem/contact/contact_evaluation.h"
#include "fem/contact/contact_face.h"
#include "fem/contact/contact_forces.h"
#include "fem/contact/flank_contact.h"
#include "fem/contact/pair_search.h"
#include "fem/contact/pressure_elements.h"
#include "fem/contact/support_row.h"
#include "fem/contact/tooth_pairs.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

struct ContactOptions : PressureElementOptions {
  FaceGaps gaps{};
  /// Bodies and slices are the lower half of a symmetric face (see SolvedFace); loads and results are those of the
  /// whole.
  bool half_face = false;
  /// Where pairs are looked for: possible_contacts() unless set.
  std::optional<PairRange> pairs{};
};

/// All tooth pairs (and supports) of one gear mesh as one complementarity problem per position.
class ContactSystem {
 public:
  /// Everything is referred to; `supports` and `rollers` may be null. `slice_edges` as for the bodies.
  ContactSystem(const FlankContact& flanks, const ContactBody& pinion, const ContactBody& wheel,
                const SupportRow* supports, const MeshMaterials& materials, std::vector<double> slice_edges,
                const ContactOptions& options, const PlanetOnRollers* rollers = nullptr);
  ContactSystem(const ContactSystem&) = delete;
  ContactSystem& operator=(const ContactSystem&) = delete;

  /// The contacts at the neighbouring position, to start from: elements by pair, and supports (empty: not known).
  struct WarmStart {
    std::map<int, std::vector<bool>> pairs;
    std::vector<bool> supports;
  };
  /// The tooth pairs of one phase and load, as positions needed them: the same in every mesh cycle, only the supports
  /// move on.
  struct PairsCache {
    double phase = 0, load = 0;
    std::vector<std::shared_ptr<const ToothPairs>> setups{};
  };

  /// Position in mesh cycles from the pitch-point contact of teeth 0. `cache` and `warm` are used when they fit, and
  /// replaced; they save time and do not change the result. Flanks that take no part are shown to stay apart by the
  /// solved deflections, or take part. `forces` may be null.
  [[nodiscard]] LoadedPosition solve(int cycle, double phase, double load, PairsCache& cache, WarmStart& warm,
                                     ContactForces* forces) const;
  /// The tooth pairs of a phase whose elements and search are those of this load.
  [[nodiscard]] std::shared_ptr<const ToothPairs> pairs(double phase, double load) const {
    return prepare(phase, load, window_, {});
  }

 private:
  [[nodiscard]] std::shared_ptr<const ToothPairs> prepare(double phase, double load, double window,
                                                          const PairSlices& added) const;
  /// From the cache, or prepared and put there.
  [[nodiscard]] std::shared_ptr<const ToothPairs> setup_for(double window, const PairSlices& added,
                                                            PairsCache& cache) const;
  [[nodiscard]] ComplementarityProblem assemble(const ToothPairs& setup, int cycle) const;
  /// Adds the supports of a floating body, and its motions.
  void add_floating(const ToothPairs& setup, int cycle, const FloatingUnknowns& body,
                    ComplementarityProblem& problem) const;
  /// Resultants on a body (x, y, moments about z, x, y) of unit (element, slice) forces of a pair.
  [[nodiscard]] Eigen::MatrixXd resultants(const ContactBody& body, const FlankPatch& patch, int tooth) const;

  ContactFace face_;
  ContactBodies bodies_;
  PairRange range_;
  MeshMaterials materials_;
  double window_;
  bool half_face_;
  PressureElements elements_;
};

}  // namespace annulus::fem
