#include "dynamics/spatial/bearing_laws.h"

#include <Eigen/Geometry>
#include <utility>

#include "core/elastic_law.h"

namespace annulus::dynamics {

namespace {

constexpr const char* suffixes[] = {"_x", "_y", "_z", "_tiltx", "_tilty"};

/// Coordinates in the axes of the law from those in the axes of the body, 5 x 5.
LinearBearing::Stiffness to_law(const LinearBearing& bearing) {
  LinearBearing::Stiffness all = LinearBearing::Stiffness::Identity();
  if (bearing.law_axes != 0)
    all.topLeftCorner<2, 2>() = all.bottomRightCorner<2, 2>() =
        Eigen::Rotation2Dd(-bearing.law_axes).toRotationMatrix();
  return all;
}

std::vector<BearingPart> bent_parts(const StageBearing& bearing) {
  auto parts = parts_of(bearing, Freedom::space);
  std::erase_if(parts, [](const auto& part) { return !part.bends; });
  return parts;
}

/// What a part of a bearing does beyond its stiffness. Coordinates whose deflection stays zero are left out.
class BeyondStiffness final : public ForceLaw {
 public:
  /// `kept`: of the law's coordinates. `stiffness`: of all of these. `lengths`: m, mesh deflections over coordinates.
  BeyondStiffness(std::shared_ptr<const ElasticLaw> law, std::vector<Eigen::Index> kept, Eigen::MatrixXd stiffness,
                  Eigen::VectorXd lengths)
      : law_(std::move(law)), kept_(std::move(kept)), stiffness_(std::move(stiffness)), lengths_(std::move(lengths)) {}
  [[nodiscard]] int size() const override { return static_cast<int>(kept_.size()); }

  void evaluate(const double* deflection, double* force, double* tangent) const override {
    const Eigen::VectorXd d = coordinates(deflection);
    const auto state = law_->at(d);
    const Eigen::VectorXd f = state.force - stiffness_ * d;
    for (const auto i : kept_) {
      *force++ = f[i] / lengths_[i];
      for (const auto j : kept_) *tangent++ = (state.tangent(i, j) - stiffness_(i, j)) / (lengths_[i] * lengths_[j]);
    }
  }
  [[nodiscard]] double energy(const double* deflection) const override {
    const Eigen::VectorXd d = coordinates(deflection);
    return law_->at(d).energy - d.dot(stiffness_ * d) / 2;
  }

 private:
  [[nodiscard]] Eigen::VectorXd coordinates(const double* deflection) const {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(lengths_.size());
    for (const auto i : kept_) d[i] = *deflection++ / lengths_[i];
    return d;
  }

  std::shared_ptr<const ElasticLaw> law_;
  std::vector<Eigen::Index> kept_;
  Eigen::MatrixXd stiffness_;
  Eigen::VectorXd lengths_;
};

}  // namespace

void give_law(LinearBearing& linear, const StageBearing& bearing, double axes) {
  if (!bends(bearing)) return;
  linear.law = bearing;
  linear.law_axes = axes;
}

LinearBearing beside_law(LinearBearing bearing) {
  if (bearing.law)
    for (const auto& part : bent_parts(*bearing.law))
      for (const int i : part.coordinates) bearing.preload[i] = bearing.standing[i] = 0;
  return bearing;
}

void add_bearing_law(LumpedSystemBuilder& builder, const LinearBearing& bearing, const std::vector<LinearForm>& motion,
                     double length) {
  if (!bearing.law) return;
  const auto turn = to_law(bearing);
  std::vector<LinearForm> turned = motion;
  if (bearing.law_axes != 0)
    for (const std::size_t first : {0U, 3U})
      for (const std::size_t i : {0U, 1U})
        turned[first + i] = turn(static_cast<Eigen::Index>(i), 0) * motion[first] +
                            turn(static_cast<Eigen::Index>(i), 1) * motion[first + 1];
  const LinearBearing::Stiffness stiffness = turn * bearing.stiffness * turn.transpose();
  for (const auto& part : bent_parts(*bearing.law)) {
    LawElement element;
    std::vector<Eigen::Index> kept;
    Eigen::VectorXd lengths(std::ssize(part.coordinates));
    for (Eigen::Index i = 0; i < lengths.size(); ++i) {
      const auto coordinate = static_cast<std::size_t>(part.coordinates[static_cast<std::size_t>(i)]);
      lengths[i] = coordinate < 3 ? 1 : length;
      if (turned[coordinate].empty()) continue;
      kept.push_back(i);
      MeshElement mesh;
      mesh.name = bearing.element() + "_law" + suffixes[coordinate];
      mesh.b = lengths[i] * turned[coordinate];
      mesh.excitation = ConstantStiffness{0};
      element.meshes.push_back(builder.add_mesh(std::move(mesh)));
    }
    if (kept.empty()) continue;
    element.law = std::make_shared<BeyondStiffness>(part.law, std::move(kept),
                                                    stiffness(part.coordinates, part.coordinates), std::move(lengths));
    builder.add_law(std::move(element));
  }
}

Eigen::MatrixXd beyond_stiffness(const LinearBearing& bearing, const Eigen::MatrixXd& motion) {
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(5, motion.cols());
  if (!bearing.law) return force;
  const auto turn = to_law(bearing);
  const Eigen::MatrixXd turned = turn * motion;
  const LinearBearing::Stiffness stiffness = turn * bearing.stiffness * turn.transpose();
  for (const auto& part : bent_parts(*bearing.law)) {
    const Eigen::MatrixXd linear = stiffness(part.coordinates, part.coordinates);
    for (Eigen::Index t = 0; t < motion.cols(); ++t) {
      const Eigen::VectorXd d = turned(part.coordinates, t);
      force(part.coordinates, t) -= part.law->at(d).force - linear * d;
    }
  }
  return turn.transpose() * force;
}

}  // namespace annulus::dynamics
