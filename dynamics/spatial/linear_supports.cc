#include "dynamics/spatial/linear_supports.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "core/errors.h"
#include "dynamics/system/input_checks.h"

namespace annulus::dynamics {

std::string name_of_body(const StageBody& body) {
  constexpr const char* names[] = {"housing", "sun", "ring", "carrier", "pinion", "wheel"};
  if (body.kind == StageBody::Kind::planet) return fmt::format("planet{}", body.planet + 1);
  if (body.kind == StageBody::Kind::pin) return fmt::format("pin{}", body.planet + 1);
  return names[static_cast<std::size_t>(body.kind)];
}

Eigen::MatrixXd SpaceSupports::whole(const LinearCoupling& coupling) const {
  Eigen::MatrixXd all = coupling.stiffness;
  Eigen::Index first = 0;
  for (const std::size_t i : coupling.bearings) {
    all.block<5, 5>(first, first) += bearings[i].stiffness;
    first += 5;
  }
  return all;
}

const LinearCoupling* SpaceSupports::coupling_of(std::size_t bearing) const {
  for (const auto& coupling : couplings)
    if (std::find(coupling.bearings.begin(), coupling.bearings.end(), bearing) != coupling.bearings.end())
      return &coupling;
  return nullptr;
}

const LinearCoupling* SpaceSupports::coupling_that_turns(const StageBody& body) const {
  for (const auto& coupling : couplings)
    if (coupling.turned == body) return &coupling;
  return nullptr;
}

std::string LinearBearing::element() const {
  auto result = name_of_body(body) + "_" + name;
  std::replace(result.begin(), result.end(), ' ', '_');
  return result;
}

namespace {

void check_coupling(const SpaceSupports& space, const LinearCoupling& coupling) {
  const Eigen::Index size = 5 * std::ssize(coupling.bearings) + (coupling.turned ? 1 : 0);
  const auto& k = coupling.stiffness;
  if (k.rows() != size || k.cols() != size || !k.allFinite())
    throw InputError(fmt::format("the stiffness of {} between {} bearings has {} x {} finite entries, not {} x {}",
                                 coupling.name, coupling.bearings.size(), k.rows(), k.cols(), size, size));
  for (const std::size_t i : coupling.bearings) {
    const auto& b = space.bearings.at(i);
    if (std::find(b.rigid.begin(), b.rigid.end(), true) != b.rigid.end())
      throw InputError(fmt::format("bearing '{}' is rigid on a {} that gives way", b.name, name_of_body(b.on)));
  }
}

}  // namespace

void SpreadFace::check(const std::string& name) const {
  check_positive(width, fmt::format("face width of the {}", name));
  if (!std::isfinite(middle)) throw InputError(fmt::format("the middle of the face of the {} is {} m", name, middle));
  if (shape && (shape->slope.empty() || shape->slope.size() != shape->curvature.size() ||
                shape->slope.size() != shape->gap_slope.size()))
    throw InputError(fmt::format("the face of the {} has {} slopes, {} curvatures and {} gaps over its phases", name,
                                 shape->slope.size(), shape->curvature.size(), shape->gap_slope.size()));
  if (!gap.empty() && gap.size() != face_places().size())
    throw InputError(
        fmt::format("the face of the {} has {} gaps for {} places", name, gap.size(), face_places().size()));
}

void SpaceSupports::check_supports() const {
  for (const auto& b : bearings) {
    if (!b.stiffness.allFinite() || !b.preload.allFinite() || !b.standing.allFinite() || !std::isfinite(b.place))
      throw InputError(fmt::format("bearing '{}' has a stiffness, force or place that is not finite", b.name));
    constexpr double rounding = 1e-9;
    if (const double skew = (b.stiffness - b.stiffness.transpose()).cwiseAbs().maxCoeff();
        skew > rounding * b.stiffness.cwiseAbs().maxCoeff())
      throw InputError(fmt::format("the stiffness of bearing '{}' differs from its transpose by {:g}", b.name, skew));
    if ((b.on.kind != StageBody::Kind::housing && b.standing.any()) || b.standing[2] != 0)
      throw InputError(fmt::format(
          "bearing '{}' has a force that stands in the housing, but is not in it, or acts along the axis", b.name));
    if (b.body.kind == StageBody::Kind::housing)
      throw InputError(fmt::format("bearing '{}' supports the housing", b.name));
  }
  for (const auto& coupling : couplings) check_coupling(*this, coupling);
  const auto check_load = [&](const StageBody& body, bool finite) {
    if (body.kind == StageBody::Kind::housing || !finite)
      throw InputError(fmt::format("a load on the {} is not finite or acts on the housing", name_of_body(body)));
  };
  for (const auto& load : loads) check_load(load.body, load.load.allFinite());
  for (const auto& load : standing_loads) check_load(load.body, load.cosine.allFinite() && load.sine.allFinite());
}

bool SpaceSupports::depends_on_carrier_angle() const {
  return !standing_loads.empty() ||
         std::any_of(bearings.begin(), bearings.end(), [](const auto& b) { return b.standing.any(); });
}

LinearBearing::Vector quarter_turn_later(const LinearBearing::Vector& s) { return {s[1], -s[0], 0, s[4], -s[3]}; }

const std::vector<FacePlace>& face_places() {
  using Rule = boost::math::quadrature::gauss<double, 20>;
  static const std::vector<FacePlace> places = [] {
    std::vector<FacePlace> list;
    for (std::size_t i = Rule::abscissa().size(); i-- > 0;)
      list.push_back({-Rule::abscissa()[i], Rule::weights()[i] / 2});
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i)
      list.push_back({Rule::abscissa()[i], Rule::weights()[i] / 2});
    return list;
  }();
  return places;
}

LinearBearing::Stiffness to_place(double place) {
  LinearBearing::Stiffness move = LinearBearing::Stiffness::Identity();
  move(0, 4) = place;
  move(1, 3) = -place;
  return move;
}

LinearBearing::Stiffness moved_along_axis(const LinearBearing::Stiffness& stiffness, double place) {
  const auto move = to_place(place);
  return move.transpose() * stiffness * move;
}

}  // namespace annulus::dynamics
