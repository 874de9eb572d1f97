#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "fem/body/gear_body.h"
#include "fem/problem/loaded_mesh_result.h"
#include "fem/problem/solved_face.h"
#include "fem/problem/support_sites.h"

namespace annulus::fem {

/// How a row of supports lies on the sectors of a ring: which distinct arc loads a sector has to be prepared for, and
/// which of them make up each support force. Equal supports on N teeth share p / gcd(p, N) places.
class SupportPlan {
 public:
  /// `slice_edges`: z of the slices of the face width, each with its own forces; in the plane one slice. `part`: of the
  /// face that they cover (see SolvedFace). `turn`: rad, of helical teeth in the middle of the
  /// face against z = 0 (BodyPlan::turn); sites are at angles from there.
  SupportPlan(SupportSites sites, int teeth, std::vector<double> slice_edges, FacePart part = FacePart::whole,
              double turn = 0);
  /// Adds forces that are given instead of sought: on every tooth at so many places of its other flank, in that order.
  void apply_on_other_flank(int places);

  enum class Kind { support, torque, applied };
  struct Force {
    Kind kind = Kind::support;
    int site = 0, direction = 0, slice = 0;   ///< of a support
    std::vector<std::pair<int, int>> pieces;  ///< sector, acting load of GearBody
    double weight = 1;                        ///< of each piece
  };
  [[nodiscard]] const SupportSites& sites() const { return sites_; }
  [[nodiscard]] const std::vector<double>& slice_edges() const { return slice_edges_; }
  [[nodiscard]] bool half_face() const { return part_ == FacePart::half; }
  /// Neither moves along the axis nor tilts: an end face of a helical ring bears its axial force.
  [[nodiscard]] bool held_axially() const { return turn_ != 0; }
  /// [site][direction][slice], the torque, applied forces
  [[nodiscard]] const std::vector<Force>& forces() const { return forces_; }
  [[nodiscard]] int applied() const { return applied_; }  ///< number of applied forces: the last ones
  [[nodiscard]] const std::vector<ArcLoad>& arcs() const { return arcs_; }
  [[nodiscard]] const SupportDirection& direction(const Force& force) const {
    return sites_.sites[force.site].directions[force.direction];
  }
  /// Compliance of the supports themselves between all forces, m/N.
  [[nodiscard]] Eigen::MatrixXd own_compliance() const;

 private:
  SupportSites sites_;
  std::vector<double> slice_edges_;
  FacePart part_;
  double turn_;
  std::vector<Force> forces_;
  std::vector<ArcLoad> arcs_;
  int teeth_ = 0, applied_ = 0;
};

/// The supports around a floating body, a ring or a planet on rollers, as unknown forces of the contact problem.
class SupportRow {
 public:
  /// `ring` has the plan's arcs as its first acting loads; it is referred to.
  SupportRow(SupportPlan plan, const GearBody& ring);

  [[nodiscard]] int size() const { return static_cast<int>(plan_.forces().size()); }  ///< number of forces
  [[nodiscard]] int unknowns() const { return size() - plan_.applied(); }  ///< those that are sought: the first ones
  [[nodiscard]] const SupportPlan& plan() const { return plan_; }
  /// Rigid motions of the ring: x, y, rotation about z; of a whole solid one also about x and y, unless the plan holds
  /// it axially. Else axial motion is not resisted, and not loaded.
  [[nodiscard]] int rigid_motions() const { return static_cast<int>(resultants_.cols()); }
  /// forces x rigid motions: resultants of unit forces (N, N m), of applied ones too
  [[nodiscard]] const Eigen::MatrixXd& resultants() const { return resultants_; }
  /// Displacements at the supports under unit support forces, m/N, the supports' own compliance included. Here and
  /// below a column belongs to an unknown force.
  [[nodiscard]] const Eigen::MatrixXd& compliance() const { return compliance_; }
  [[nodiscard]] const Eigen::VectorXd& gap() const { return gap_; }  ///< m
  [[nodiscard]] const std::vector<bool>& unilateral() const { return unilateral_; }

  /// Displacement of loads of a tooth under unit support forces, m/N: the work of `port_weights` (ports x k) is asked
  /// for; k x forces.
  [[nodiscard]] Eigen::MatrixXd at_ports(int tooth, const Eigen::MatrixXd& port_weights) const;
  /// Displacement of the supports, and of the flank ports of a tooth, under applied forces alone, m.
  [[nodiscard]] Eigen::VectorXd applied_at_supports(const Eigen::VectorXd& applied) const;
  [[nodiscard]] Eigen::VectorXd applied_at_flank(int tooth, const Eigen::VectorXd& applied) const;
  /// Displacement of the flank ports of a tooth under all forces, m.
  [[nodiscard]] Eigen::VectorXd at_flank(int tooth, const Eigen::VectorXd& forces) const;
  /// Displacements of interface `interface` under unit support forces, m/N: m x forces. Formed when first asked for.
  [[nodiscard]] const Eigen::MatrixXd& at_interface(int interface) const;
  /// Displacements of an interface under all forces, m; a column per column of the forces.
  [[nodiscard]] Eigen::MatrixXd interface_displacement(int interface,
                                                       const Eigen::Ref<const Eigen::MatrixXd>& forces) const;
  /// The same number for an interface and for those that are whole turns away from it.
  [[nodiscard]] int number_of(int interface) const { return tooth_number(interface); }
  /// Work of loads first ... first + count - 1 of a sector under unit support forces, per N: count x forces.
  [[nodiscard]] Eigen::MatrixXd at_loads(int sector, int first, int count) const;

  /// The part of such work that passes inside the sector, its interfaces held, under all forces: count.
  [[nodiscard]] Eigen::VectorXd within_sector(int sector, int first, int count, const Eigen::VectorXd& forces) const;

  /// Force of every site, N: all its slices, in its first direction.
  [[nodiscard]] std::vector<double> site_forces(const Eigen::VectorXd& forces) const;
  /// What forces mean for pins (or spline teeth), and for the patches of a housing bore.
  void fill_states(const Eigen::VectorXd& forces, LoadedPosition& position) const;

 private:
  /// Unknown or applied forces of the row that act on one sector, each through one of its acting loads.
  struct OnSector {
    std::vector<int> force, arc;
    std::vector<double> weight;
  };
  [[nodiscard]] int tooth_number(int tooth) const { return ((tooth % ring_.teeth) + ring_.teeth) % ring_.teeth; }

  SupportPlan plan_;
  const GearBody& ring_;
  double per_width_ = 1;  ///< plane compliances are per unit of width
  [[nodiscard]] Eigen::VectorXd within(const OnSector& here, int first, int count, const Eigen::VectorXd& forces) const;
  /// Adds the displacement of an interface under applied forces, m.
  void add_applied(int interface, const Eigen::VectorXd& applied, Eigen::VectorXd& displacement) const;
  std::vector<OnSector> on_sector_, applied_on_sector_;  ///< forces numbered on their own
  Eigen::MatrixXd compliance_, resultants_;
  Eigen::VectorXd gap_;
  std::vector<bool> unilateral_;
  struct Interface {
    std::once_flag formed;
    Eigen::MatrixXd displacement;
  };
  std::unique_ptr<Interface[]> interfaces_;
};

}  // namespace annulus::fem
