#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/body/gear_body.h"
#include "fem/contact/flank_patch.h"
#include "fem/contact/half_plane.h"

namespace annulus::fem {

/// A gear prepared for contact: the compliance of its flanks under loads on pressure elements that are constant over
/// slices of the face width.
class ContactBody {
 public:
  virtual ~ContactBody() = default;
  ContactBody(const ContactBody&) = delete;
  ContactBody& operator=(const ContactBody&) = delete;

  [[nodiscard]] int slices() const { return slices_; }

  /// The load that stands for an element on the mesh of a tooth.
  [[nodiscard]] virtual FlankLoad make_load(int tooth, double arc, double half_length) const = 0;
  /// Length of the shortest element that the compliance distinguishes from its neighbours there on a flank, m.
  [[nodiscard]] virtual double shortest_element(int tooth, double arc) const = 0;
  /// Fills the weights of a patch whose loads are given.
  void find_weights(FlankPatch& patch, int tooth) const;

  /// Mean displacement into the material over the elements of `a` on tooth `tooth_a` under unit forces on those of `b`,
  /// m/N, as the mesh gives it.
  [[nodiscard]] Eigen::MatrixXd compliance(const FlankPatch& a, int tooth_a, const FlankPatch& b, int tooth_b) const;
  /// Whether there is but one compliance between two teeth, whichever of them is loaded: then it shows nothing of
  /// reciprocity.
  [[nodiscard]] virtual bool same_both_ways() const = 0;
  /// What is missing within one patch: the near field of loads that the mesh does not resolve.
  [[nodiscard]] virtual Eigen::MatrixXd near_field(const FlankPatch& patch) const = 0;
  /// Displacement into the material along the flank of tooth `at` under forces (N) on the elements of a patch, m, as
  /// the mesh gives it: [profile station * slices + slice].
  [[nodiscard]] Eigen::VectorXd displacement(int at, const FlankPatch& patch, int tooth,
                                             const Eigen::VectorXd& forces) const;
  /// A lower bound, slice by slice, of the displacement() over the height of the flank, m. A condensed body has it at a
  /// fraction of the cost.
  [[nodiscard]] virtual Eigen::VectorXd least_displacement(int at, const FlankPatch& patch, int tooth,
                                                           const Eigen::VectorXd& forces) const;
  /// The least value of every slice over the height of a flank: [slice].
  [[nodiscard]] Eigen::VectorXd least_by_slice(const Eigen::VectorXd& displacement) const;
  /// Means over the slices of values at the flank ports: [profile station * slices + slice].
  [[nodiscard]] Eigen::VectorXd slice_means(const Eigen::VectorXd& at_ports) const;
  /// Displacement into the material along the flank of a tooth by unit motions of the body (x, y, rotation about the
  /// axis), m per (m, m, rad): [profile station * slices + slice] x 3.
  [[nodiscard]] Eigen::MatrixXd motions(int tooth) const;
  /// Resultants (x, y, moment about the axis) of unit element forces on a tooth: elements x 3.
  [[nodiscard]] Eigen::MatrixXd resultants(const FlankPatch& patch, int tooth) const;
  /// Port forces of unit element forces: flank ports x elements.
  [[nodiscard]] Eigen::MatrixXd port_weights(const FlankPatch& patch) const;

 protected:
  /// `slice_edges`: z of the slice borders (m), ascending; in the plane {0, width} with one slice. `axial`: empty in
  /// the plane.
  ContactBody(double base_radius, const TraceBasis& axial, const std::vector<double>& slice_edges);

  /// Compliance between profile stations and slices, rows and columns [station * slices + slice], from that between all
  /// flank ports.
  [[nodiscard]] Eigen::MatrixXd compress(const Eigen::MatrixXd& ports) const;
  [[nodiscard]] Eigen::MatrixXd weights_on(const TraceBasis& flank, const std::vector<FlankLoad>& loads) const;
  /// Distance to the nearer end of a flank, m.
  [[nodiscard]] double distance_to_end(const TraceBasis& flank, double arc) const;
  [[nodiscard]] double base_radius() const { return base_radius_; }
  /// Loads of the elements of a patch, N: [profile station * slices + slice].
  [[nodiscard]] Eigen::VectorXd loads_of(const FlankPatch& patch, const Eigen::VectorXd& forces) const;

  struct Block {
    const Eigen::MatrixXd& compliance;  ///< compressed
    bool transposed = false;
  };
  [[nodiscard]] virtual Block block(int tooth_a, int tooth_b) const = 0;
  /// A body that has the flank ports of a tooth, what its number is there, and their motions in the frame of the tooth.
  struct Flank {
    const GearBody& body;
    const Eigen::MatrixXd& motions;
    int number;
  };
  [[nodiscard]] virtual Flank flank_of(int tooth) const = 0;
  /// motions() of tooth 0.
  [[nodiscard]] Eigen::MatrixXd own_motions(const GearBody& body) const;

 private:
  double base_radius_;
  int slices_ = 1;
  Eigen::MatrixXd axial_;  // axial stations x slices, column sum 1
  double per_width_ = 1;   // plane compliances are per unit of width
};

/// Cells of a flank's mesh along its arc length.
class FlankCells {
 public:
  FlankCells(const TraceBasis& flank, double base_radius);
  /// Length of the cells at a place, m, continuous along the flank.
  [[nodiscard]] double length(double arc) const;

 private:
  std::vector<double> centres_, lengths_;  // m
};

/// What a fine plane mesh adds to the near field of a solid body's coarse flank, applied slice by slice: the compliance
/// of the fine plane tooth less that of a plane tooth as coarse as the solid, m per N/m.
struct NearField {
  TraceBasis fine, coarse;
  Eigen::MatrixXd fine_compliance, coarse_compliance;
};

/// A body of equal teeth whose mesh does not follow the contact: a load on its mesh is as wide as the mesh needs to
/// resolve it, as near to the ends of the flank as it fits; the rest is added from the half-plane.
class CondensedBody : public ContactBody {
 public:
  /// `near_field`: solid bodies only. `contact_slant`: length of a contact line per face width.
  CondensedBody(GearBody body, double base_radius, const Material& material, const std::vector<double>& slice_edges,
                std::optional<NearField> near_field = {}, double contact_slant = 1);

  [[nodiscard]] const GearBody& body() const { return body_; }
  [[nodiscard]] bool same_both_ways() const override { return true; }
  [[nodiscard]] FlankLoad make_load(int tooth, double arc, double half_length) const override;
  /// 0: the half-plane carries what the mesh cannot.
  [[nodiscard]] double shortest_element(int, double) const override { return 0; }
  [[nodiscard]] Eigen::MatrixXd near_field(const FlankPatch& patch) const override;
  [[nodiscard]] Eigen::VectorXd least_displacement(int at, const FlankPatch& patch, int tooth,
                                                   const Eigen::VectorXd& forces) const override;

 protected:
  [[nodiscard]] Block block(int tooth_a, int tooth_b) const override;
  [[nodiscard]] Flank flank_of(int tooth) const override { return {body_, motions_, tooth}; }

 private:
  /// Least and greatest compliance of every slice over the height of a flank: slice x (station, slice).
  struct Bounds {
    Eigen::MatrixXd least, greatest;
  };
  [[nodiscard]] Bounds bounds_of(const Eigen::MatrixXd& compliance) const;
  struct Offset {
    int number = 0;           ///< of the compressed compliance
    bool transposed = false;  ///< it is that of the opposite offset
  };
  [[nodiscard]] Offset offset(int tooth_a, int tooth_b) const;

  GearBody body_;
  Eigen::MatrixXd motions_;
  HalfPlane half_plane_;
  std::vector<double> slice_length_;         // of the contact line, m
  std::vector<Eigen::MatrixXd> compressed_;  // per offset: (station, slice) x (station, slice)
  std::vector<Bounds> bounds_, transposed_bounds_;
  std::optional<NearField> near_field_;
  FlankCells cells_;
};

/// A body some neighbouring teeth of which have meshes of their own that resolve their contact.
class ResolvedBody : public ContactBody {
 public:
  /// `teeth`: neighbours counter-clockwise from `first_tooth`, without compliance; `compliance` of all their flank
  /// ports, tooth by tooth.
  ResolvedBody(std::vector<GearBody> teeth, int first_tooth, const Eigen::MatrixXd& compliance, double base_radius,
               const std::vector<double>& slice_edges);

  [[nodiscard]] bool same_both_ways() const override { return false; }
  [[nodiscard]] FlankLoad make_load(int tooth, double arc, double half_length) const override;
  /// A little longer than the cells: nothing but the mesh carries it.
  [[nodiscard]] double shortest_element(int tooth, double arc) const override;
  [[nodiscard]] Eigen::MatrixXd near_field(const FlankPatch& patch) const override;

 protected:
  [[nodiscard]] Block block(int tooth_a, int tooth_b) const override;
  [[nodiscard]] Flank flank_of(int tooth) const override;

 private:
  std::vector<GearBody> teeth_;
  std::vector<Eigen::MatrixXd> motions_;
  std::vector<FlankCells> cells_;
  int first_tooth_;
  std::vector<std::vector<Eigen::MatrixXd>> compressed_;  // [tooth][tooth]
};

}  // namespace annulus::fem
