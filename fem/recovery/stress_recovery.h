#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/body/gear_body.h"
#include "fem/contact/contact_forces.h"
#include "fem/contact/support_row.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// What a finer section adds to the stresses in a fillet, as factors: cells of a solid body follow its curve with too
/// few points.
struct NotchFactors {
  double tension = 1, compression = 1;
  double error = 0;  ///< relative, of what they multiply
};

/// Surface stresses of a whole body under given forces on its teeth and supports.
///
/// A stress is a functional of the displacement and thereby one more load of the condensed body: by reciprocity it
/// costs a few products, no solve. Under a support itself the surface is not free: there the tangential stress lacks
/// nu / (1 - nu) of the support's pressure.
class StressRecovery {
 public:
  /// `body` has stress lines and is referred to, `supports` may be null. Plane bodies are looked at all around, solid
  /// ones a few teeth to either side of the forces. Stresses in roots are multiplied by the factors.
  StressRecovery(const GearBody& body, double face_width, double poisson_ratio, const SupportRow* supports,
                 const NotchFactors& notch = {});

  /// The stresses of one line of the body: the root of a tooth space, or the whole rim.
  struct Line {
    std::vector<double> abscissa;
    Eigen::MatrixXd tangential, von_mises;  ///< Pa, points x axial stations
  };
  struct Result {
    RecoveredStress largest;  ///< without its error
    Line root;  ///< of the tooth space with the largest von Mises stress, counter-clockwise; abscissa: arc length, m
    Line rim;   ///< abscissa: polar angle in the body's frame, rad, ascending
  };
  [[nodiscard]] Result stresses(const std::vector<ToothForces>& teeth, const Eigen::VectorXd& supports) const;

  enum class Look { around, near };  ///< near: three teeth to either side of the forces, in any body
  /// Forces on teeth and supports, which are referred to.
  struct Forces {
    const std::vector<ToothForces>* teeth = nullptr;
    const Eigen::VectorXd* supports = nullptr;
    Look look = Look::around;
  };
  /// The largest stresses under each of many forces.
  [[nodiscard]] std::vector<RecoveredStress> largest(const std::vector<Forces>& list) const;

 private:
  /// Stresses of all lines of the looked-at sectors `first`, `first` + 1, ..., as numbered among the observed loads:
  /// a column per sector.
  struct Observed {
    int first = 0;
    Eigen::MatrixXd stress;
  };
  [[nodiscard]] Observed looked_at(const Forces& forces) const;
  [[nodiscard]] std::vector<Observed> by_sector(const std::vector<Forces>& list) const;
  enum class Lines { left_out, wanted };
  [[nodiscard]] Result evaluated(const Forces& forces, const Observed& observed, Lines lines) const;
  [[nodiscard]] Line whole_rim(const Observed& observed) const;
  /// Tangential and von Mises stress of the points of a line in one sector, [point][axial station].
  [[nodiscard]] Line on_sector(const StressLine& line, const Eigen::Ref<const Eigen::VectorXd>& observed) const;
  [[nodiscard]] int number(int sector) const { return ((sector % body_.teeth) + body_.teeth) % body_.teeth; }

  const GearBody& body_;
  const SupportRow* supports_;
  double per_width_, poisson_ratio_;
  NotchFactors notch_;
  int first_load_, loads_;
};

/// The largest stresses in the root of plane section `fine` over those in `coarse`, both under the same force on the
/// flank, where that stresses the root most. `degree` of the elements of the body that they correct.
[[nodiscard]] NotchFactors notch_factors(const GearBody& fine, const GearBody& coarse, double poisson_ratio,
                                         int degree);

}  // namespace annulus::fem
