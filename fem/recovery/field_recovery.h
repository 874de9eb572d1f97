#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/body/body_source.h"
#include "fem/body/gear_body.h"
#include "fem/contact/contact_forces.h"
#include "fem/contact/support_row.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// Displacement and stress inside a condensed body: its sectors solved once more, their interfaces moved as the
/// composed body moves them. Exact for the discretised body, as the condensation is.
class FieldRecovery {
 public:
  /// `body` was made of `source`; `supports` may be null. All of them are referred to.
  FieldRecovery(const GearBody& body, const BodySource& source, const Material& material, double face_width,
                const SupportRow* supports);
  ~FieldRecovery();
  FieldRecovery(const FieldRecovery&) = delete;
  FieldRecovery& operator=(const FieldRecovery&) = delete;

  /// Under `teeth` and the supports' forces, and moved by `rigid` (both empty without supports): as BodyField::mesh
  /// says. `mirrored`: the real body is the mirror image of the solved one (y -> -y).
  [[nodiscard]] BodyField field(const std::vector<ToothForces>& teeth, const Eigen::VectorXd& supports,
                                const Eigen::VectorXd& rigid, bool mirrored) const;
  /// Displacements of all DOFs of one sector in its own frame, [node][component], without the rigid motion.
  [[nodiscard]] Eigen::VectorXd sector_displacement(int sector, const std::vector<ToothForces>& teeth,
                                                    const Eigen::VectorXd& supports) const;
  [[nodiscard]] const SectorModel& model() const { return model_; }

 private:
  struct Interior;  // the factorised sector, its interfaces held

  [[nodiscard]] Eigen::MatrixXd interface_displacement(int interface, const std::vector<ToothForces>& teeth,
                                                       const Eigen::VectorXd& supports) const;

  const GearBody& body_;
  const SupportRow* supports_;
  double per_width_;
  SectorModel model_;
  std::vector<NodalLoad> acting_;  ///< as GearBody::acting_wrenches
  std::unique_ptr<Interior> interior_;
};

}  // namespace annulus::fem
