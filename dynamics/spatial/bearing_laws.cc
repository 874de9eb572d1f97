#include "dynamics/spatial/bearing_laws.h"

#include <Eigen/Geometry>
#include <utility>

#include "core/elastic_law.h"
#include "dynamics/spatial/series_law.h"

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

std::vector<BearingPart> nonlinear_parts(const StageBearing& bearing) {
  auto parts = parts_of(bearing, Motions::in_space);
  std::erase_if(parts, [](const auto& part) { return !part.nonlinear; });
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

/// A coordinate of a law: the name of its mesh, whose deflection is `length` times the coordinate.
struct Coordinate {
  std::string name;
  LinearForm form;
  double length = 1;
};
/// Adds what a law does beyond the stiffness K of all its coordinates.
void add_beyond(LumpedSystemBuilder& builder, const std::vector<Coordinate>& coordinates,
                const std::shared_ptr<const ElasticLaw>& law, const Eigen::MatrixXd& stiffness) {
  LawElement element;
  std::vector<Eigen::Index> kept;
  Eigen::VectorXd lengths(std::ssize(coordinates));
  for (Eigen::Index i = 0; i < lengths.size(); ++i) {
    const auto& coordinate = coordinates[static_cast<std::size_t>(i)];
    lengths[i] = coordinate.length;
    if (coordinate.form.empty()) continue;
    kept.push_back(i);
    MeshElement mesh;
    mesh.name = coordinate.name;
    mesh.b = coordinate.length * coordinate.form;
    mesh.excitation = ConstantStiffness{0};
    element.meshes.push_back(builder.add_mesh(std::move(mesh)));
  }
  if (kept.empty()) return;
  element.law = std::make_shared<BeyondStiffness>(law, std::move(kept), stiffness, std::move(lengths));
  builder.add_law(std::move(element));
}

}  // namespace

void give_law(LinearBearing& linear, const StageBearing& bearing, double axes) {
  if (!is_nonlinear(bearing)) return;
  linear.law = bearing;
  linear.law_axes = axes;
}

LinearBearing beside_law(const SpaceSupports& supports, std::size_t number) {
  LinearBearing bearing = supports.bearings[number];
  if (const auto* coupling = supports.coupling_of(number); coupling && coupling->law) {
    bearing.preload.setZero();
    bearing.standing.setZero();
  } else if (bearing.law) {
    for (const auto& part : nonlinear_parts(*bearing.law))
      for (const int i : part.coordinates) bearing.preload[i] = bearing.standing[i] = 0;
  }
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
  for (const auto& part : nonlinear_parts(*bearing.law)) {
    std::vector<Coordinate> coordinates;
    for (const int i : part.coordinates) {
      const auto c = static_cast<std::size_t>(i);
      coordinates.push_back({bearing.element() + "_law" + suffixes[c], turned[c], c < 3 ? 1 : length});
    }
    add_beyond(builder, coordinates, part.law, stiffness(part.coordinates, part.coordinates));
  }
}

void add_coupling_law(LumpedSystemBuilder& builder, const LinearCoupling& coupling, const SpaceSupports& supports,
                      const std::vector<LinearForm>& motion, double length) {
  if (!coupling.law) return;
  std::vector<Coordinate> coordinates;
  for (const std::size_t i : coupling.bearings)
    for (std::size_t c = 0; c < 5; ++c)
      coordinates.push_back(
          {supports.bearings[i].element() + "_law" + suffixes[c], motion[coordinates.size()], c < 3 ? 1 : length});
  if (coupling.turned)
    coordinates.push_back({name_of_body(*coupling.turned) + "_" + coupling.name + "_law_u", motion.back(), 1});
  add_beyond(builder, coordinates, series_law(*coupling.law), supports.whole(coupling));
}

Eigen::MatrixXd beyond_stiffness(const LinearBearing& bearing, const Eigen::MatrixXd& motion) {
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(5, motion.cols());
  if (!bearing.law) return force;
  const auto turn = to_law(bearing);
  const Eigen::MatrixXd turned = turn * motion;
  const LinearBearing::Stiffness stiffness = turn * bearing.stiffness * turn.transpose();
  for (const auto& part : nonlinear_parts(*bearing.law)) {
    const Eigen::MatrixXd linear = stiffness(part.coordinates, part.coordinates);
    for (Eigen::Index t = 0; t < motion.cols(); ++t) {
      const Eigen::VectorXd d = turned(part.coordinates, t);
      force(part.coordinates, t) -= part.law->at(d).force - linear * d;
    }
  }
  return turn.transpose() * force;
}

Eigen::MatrixXd forces_by_law(const LinearCoupling& coupling, const Eigen::MatrixXd& motion) {
  const auto law = series_law(*coupling.law);
  Eigen::MatrixXd force(motion.rows(), motion.cols());
  for (Eigen::Index t = 0; t < motion.cols(); ++t) force.col(t) = -law->at(motion.col(t)).force;
  return force;
}

}  // namespace annulus::dynamics
