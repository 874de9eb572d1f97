#include "dynamics/systems/planetary/working_point.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dynamics/spatial/bearing_laws.h"
#include "dynamics/spatial/linearised.h"
#include "dynamics/spatial/series_law.h"

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;
using Stiffness = LinearBearing::Stiffness;
using Vector = LinearBearing::Vector;

/// The mean of a stiffness that stands in the housing, as the carrier turns past it: 5 coordinates each, and one about
/// the axis at the end, if any.
Eigen::MatrixXd mean_over_turn(const Eigen::MatrixXd& stiffness) {
  constexpr int angles = 8;  // second harmonics of the angle vanish
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(stiffness.rows(), stiffness.cols());
  for (int k = 0; k < angles; ++k) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(2 * std::numbers::pi * k / angles).toRotationMatrix();
    Eigen::MatrixXd all = Eigen::MatrixXd::Identity(stiffness.rows(), stiffness.cols());
    for (Eigen::Index first = 0; first + 5 <= all.rows(); first += 5)
      all.block<2, 2>(first, first) = all.block<2, 2>(first + 3, first + 3) = turn;
    sum += all.transpose() * stiffness * all / angles;
  }
  return sum;
}

/// The forces of a bearing in the housing stand there, but for that along the axis.
void stand(LinearBearing& bearing) {
  constexpr Eigen::Index axial = 2;
  bearing.standing = bearing.preload;
  bearing.preload = bearing.standing[axial] * Vector::Unit(axial);
  bearing.standing[axial] = 0;
}

/// Mounts of a ring beside its axis as one bearing in the middle of the face: their mean over a turn of the carrier, in
/// which displacements and tilts do not turn the ring.
class Mounts {
 public:
  void add(const Linearised& found, const Eigen::Vector2d& beside) {
    using Row = Eigen::Matrix<double, 1, 6>;
    Eigen::Matrix<double, 5, 6> move = Eigen::Matrix<double, 5, 6>::Zero();
    move.leftCols<5>() = to_place(found.bearing.place);
    move.row(0) += -beside.y() * Row::Unit(5);
    move.row(1) += beside.x() * Row::Unit(5);
    move.row(2) += beside.y() * Row::Unit(3) - beside.x() * Row::Unit(4);
    stiffness_ += move.transpose() * found.bearing.stiffness * move;
    const Vector force = found.bearing.stiffness * found.deflection + found.bearing.preload;
    force_ += move.transpose() * force;
    sum_ += force.cwiseAbs().sum() * (1 + beside.norm() + std::abs(found.bearing.place));
    if (!bearing_.name.empty()) bearing_.name += " ";
    bearing_.name += found.bearing.name;
    any_ = true;
  }
  [[nodiscard]] bool any() const { return any_; }
  /// N m/rad.
  [[nodiscard]] double torsion() const { return stiffness_(5, 5); }
  /// `motion`: of the ring, at which the forces act.
  [[nodiscard]] LinearBearing bearing(const Vector& motion, bool turns) const {
    LinearBearing result = bearing_;
    result.body = {Kind::ring};
    const Eigen::MatrixXd mean = mean_over_turn(stiffness_);
    result.stiffness = mean.topLeftCorner<5, 5>();
    result.preload = force_.head<5>() - result.stiffness * motion;
    // Rounding of mounts that balance each other would make the motion repeat after a turn of the carrier only.
    constexpr double rounding = 1e-12;
    for (double& force : result.preload)
      if (std::abs(force) <= rounding * sum_) force = 0;
    if (turns) stand(result);
    return result;
  }

 private:
  double sum_ = 0;  // N, N m: amounts of all forces and moments
  Eigen::Matrix<double, 6, 6> stiffness_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> force_ = Eigen::Matrix<double, 6, 1>::Zero();
  LinearBearing bearing_;
  bool any_ = false;
};

/// A bearing in the housing under loads that stand there: its mean stiffness, and the force beside it that stands.
LinearBearing under_standing_loads(const Linearised& found) {
  LinearBearing result = found.bearing;
  result.stiffness = mean_over_turn(found.bearing.stiffness);
  result.preload += (found.bearing.stiffness - result.stiffness) * found.deflection;
  stand(result);
  return result;
}

/// Linear springs on something elastic: they give way together until the forces are equal.
struct Series {
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd preload;
};
/// `springs`, `preload`: K and f of forces K d + f. `held`: rows of deflections of the springs that stay zero. `below`:
/// stiffness of what they stand on, in the same coordinates.
Series in_series(const Eigen::MatrixXd& springs, const Eigen::VectorXd& preload, const Eigen::MatrixXd& held,
                 const Eigen::MatrixXd& below) {
  const Eigen::Index size = below.rows();
  const auto free = free_coordinates(held);
  Series result{below, Eigen::VectorXd::Zero(size)};
  if (free.cols() == 0) return result;
  const Eigen::MatrixXd inner = free.transpose() * (springs + below) * free;
  const Eigen::MatrixXd share = below * free * inner.inverse() * free.transpose();
  result.stiffness -= share * below;
  result.stiffness = (result.stiffness + result.stiffness.transpose()).eval() / 2;
  result.preload = share * preload;
  return result;
}

void add_row(Eigen::MatrixXd& rows, Eigen::Index first, const Eigen::RowVectorXd& row) {
  rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
  rows.bottomRows<1>().setZero();
  rows.bottomRows<1>().segment(first, row.size()) = row;
}

/// Takes the stiffness of every bearing's own coordinates out of that of all.
std::vector<Stiffness> own_blocks(Eigen::MatrixXd& stiffness, std::size_t bearings) {
  std::vector<Stiffness> own;
  for (std::size_t n = 0; n < bearings; ++n) {
    auto block = stiffness.block<5, 5>(5 * static_cast<Eigen::Index>(n), 5 * static_cast<Eigen::Index>(n));
    own.push_back(block);
    block.setZero();
  }
  return own;
}

/// Is what remains of a stiffness between bearings no more than rounding of `whole`?
bool couples(const Eigen::MatrixXd& between, const Eigen::MatrixXd& whole) {
  constexpr double rounding = 1e-9;
  const Eigen::VectorXd inverse = whole.diagonal().cwiseSqrt().unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  return (inverse.asDiagonal() * between * inverse.asDiagonal()).cwiseAbs().maxCoeff() > rounding;
}

bool any_nonlinear(const BearingsInSeries& series) {
  return std::any_of(series.bearings.begin(), series.bearings.end(),
                     [](const auto& seated) { return is_nonlinear(seated.bearing); });
}

/// The bearings of a planet, made and for small motions.
struct PlanetBearings {
  std::vector<StageBearing> made;
  std::vector<LinearBearing> linear;
};

/// Puts the bearings of planets on their pins in series with these: one in the middle of every planet. `pins`:
/// SpatialStage::pins.
void put_on_pins(StageSpace& space, const std::vector<PlanetBearings>& bearings, const Eigen::MatrixXd& pins,
                 Motions motions) {
  const Eigen::Index size = pins.rows();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size), held(0, size);
  Eigen::VectorXd preload = Eigen::VectorXd::Zero(size);
  BearingsInSeries law{motions, pins, {}};
  for (std::size_t n = 0; n < bearings.size(); ++n) {
    const auto first = 5 * static_cast<Eigen::Index>(n);
    for (const auto& b : bearings[n].linear) {
      const auto move = to_place(b.place);
      sum.block<5, 5>(first, first) += move.transpose() * b.stiffness * move;
      preload.segment<5>(first) += move.transpose() * b.preload;
      for (Eigen::Index i = 0; i < 5; ++i)
        if (b.rigid.at(static_cast<std::size_t>(i))) add_row(held, first, move.row(i));
    }
    for (const auto& b : bearings[n].made) law.bearings.push_back({b, static_cast<int>(first), b.place});
  }
  auto all = in_series(sum, preload, held, pins);
  LinearCoupling coupling{"planet_bearing", {}, all.stiffness};
  const auto own = own_blocks(coupling.stiffness, bearings.size());
  for (std::size_t n = 0; n < bearings.size(); ++n) {
    LinearBearing result;
    result.name = "bearing";
    result.body = {Kind::planet, static_cast<int>(n)};
    result.on = {Kind::carrier};
    result.stiffness = own[n];
    result.preload = all.preload.segment<5>(5 * static_cast<Eigen::Index>(n));
    coupling.bearings.push_back(space.bearings.size());
    space.bearings.push_back(std::move(result));
  }
  if (any_nonlinear(law)) {
    law.held = held;
    coupling.law = std::move(law);
  }
  if (coupling.law || couples(coupling.stiffness, pins)) space.couplings.push_back(std::move(coupling));
}

/// Displacement and tilt of a central body in a place on the axis.
Vector motion_at(const SpatialStage& stage, const Mechanism::Equilibrium& at, const StageBody& body, double place) {
  const Eigen::Index first = 6 * body_number(stage, body);
  return to_place(place) * at.motion.segment<5>(first);
}

/// Puts the bearings of the housing on what it gives way, in series: their mean over a turn where the carrier turns
/// past it. `found`: of HousingStructure::bearings, in the state `at`.
void put_in_housing(StageSpace& space, const SpatialStage& stage, const std::vector<Linearised>& found,
                    const StageMechanism& made, const Mechanism::Equilibrium& at, Motions motions) {
  const auto& housing = *stage.housing;
  const Eigen::Index size = housing.stiffness.rows(), last = size - 1;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size), held(0, size), below = housing.stiffness;
  Eigen::VectorXd preload = Eigen::VectorXd::Zero(size), motion = Eigen::VectorXd::Zero(size);
  BearingsInSeries law{motions, {}, {}};
  for (std::size_t n = 0; n < found.size(); ++n) {
    const auto first = 5 * static_cast<Eigen::Index>(n);
    const auto& b = found[n].bearing;
    law.bearings.push_back({made.bearings[housing.bearings[n]], static_cast<int>(first), 0});
    sum.block<5, 5>(first, first) = b.stiffness;
    preload.segment<5>(first) = b.preload;
    motion.segment<5>(first) = motion_at(stage, at, b.body, b.place);
    for (Eigen::Index i = 0; i < 5; ++i)
      if (b.rigid.at(static_cast<std::size_t>(i))) add_row(held, first + i, Eigen::RowVectorXd::Ones(1));
  }
  const double radius = stage.plane.ring.radius;
  if (housing.ring_bearing) {  // u = r_b phi
    below.row(last) /= radius;
    below.col(last) /= radius;
    motion[last] = radius * at.motion[6 * body_number(stage, {Kind::ring}) + 5];
    if (made.ring_support >= 0) {
      sum(last, last) = stage.plane.ring.torsional_support;
      law.springs.push_back({static_cast<int>(last), stage.plane.ring.torsional_support});
    } else {
      add_row(held, last, Eigen::RowVectorXd::Ones(1));
    }
  }
  auto all = in_series(sum, preload, held, below);
  const bool turns = stage.plane.carrier_speed != 0;
  const Eigen::MatrixXd mean = turns ? mean_over_turn(all.stiffness) : all.stiffness;
  const Eigen::VectorXd beside = all.preload + (all.stiffness - mean) * motion;
  LinearCoupling coupling{"housing", {}, mean};
  if (housing.ring_bearing) {
    coupling.turned = {Kind::ring};
    coupling.turning_preload = beside[last];
  }
  const auto own = own_blocks(coupling.stiffness, found.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    LinearBearing result = found[n].bearing;
    result.rigid.fill(false);
    result.stiffness = own[n];
    result.standing.setZero();
    result.preload = beside.segment<5>(5 * static_cast<Eigen::Index>(n));
    if (turns) stand(result);
    coupling.bearings.push_back(space.bearings.size());
    space.bearings.push_back(std::move(result));
  }
  if (!turns && any_nonlinear(law)) {
    law.below = below;
    law.held = held;
    coupling.law = std::move(law);
  }
  if (coupling.law || coupling.turned || couples(coupling.stiffness, housing.stiffness))
    space.couplings.push_back(std::move(coupling));
}

/// The loads under which planets and bearings on the carrier are linearised. Loads that stand in the housing have their
/// part along the axis alone; planets have their centrifugal forces.
SpatialStage without_standing_loads(const SpatialStage& stage) {
  auto turning = stage;
  const auto& plane = stage.plane;
  if (plane.carrier_speed != 0) {
    turning.gravity.head<2>().setZero();
    for (auto& load : turning.loads)
      if (load.stands_in_housing()) {
        load.point.head<2>().setZero();
        load.force.head<2>().setZero();
        load.moment.setZero();
      }
  }
  const double speed = plane.rotating_frame ? plane.carrier_speed : 0;
  if (speed != 0)
    for (int n = 0; n < stage.planets(); ++n)
      turning.loads.push_back({"centrifugal force",
                               {Kind::planet, n},
                               StageFrame::planet,
                               Eigen::Vector3d::Zero(),
                               plane.planet.mass * plane.carrier.radius * speed * speed * Eigen::Vector3d::UnitX(),
                               Eigen::Vector3d::Zero()});
  return turning;
}

/// A load about the middle of its body, in the axes of the body, at time t (s).
Eigen::Matrix<double, 6, 1> about_middle(const SpatialStage& stage, const StageLoad& load, double t) {
  const auto axes = frame_axes(stage, load.frame, load.body, t);
  const Eigen::Vector3d point = axes * load.point, force = axes * load.force;
  const Eigen::Vector3d moment = axes * load.moment + point.cross(force);
  const bool planet = load.body.kind == Kind::planet;
  const auto own = frame_axes(stage, planet ? StageFrame::planet : StageFrame::carrier, load.body, 0);
  Eigen::Matrix<double, 6, 1> result;
  result << own.transpose() * force, own.transpose() * moment;
  // The shaft of the carrier bears the torque of a force beside the axis, as in the statics.
  if (load.body.kind == Kind::carrier) result[5] = 0;
  return result;
}

/// Adds the part of a load that does not change as the carrier turns, and the one that does.
void add_load(const SpatialStage& stage, const StageLoad& load, StageSpace& space) {
  const double speed = stage.plane.carrier_speed;
  const auto now = about_middle(stage, load, 0);
  if (speed == 0 || !load.stands_in_housing()) {
    space.loads.push_back({load.body, now});
    return;
  }
  const auto later = about_middle(stage, load, std::numbers::pi / speed);
  const auto quarter = about_middle(stage, load, std::numbers::pi / (2 * speed));
  SpaceLoad constant{load.body, (now + later) / 2};
  constexpr double rounding = 1e-14;
  const double force = now.head<3>().norm(), moment = now.tail<3>().norm();
  for (Eigen::Index i = 0; i < 6; ++i)
    if (std::abs(constant.load[i]) <= rounding * (i < 3 ? force : moment)) constant.load[i] = 0;
  if (constant.load.any()) space.loads.push_back(constant);
  const StandingLoad standing{load.body, now - constant.load, quarter - constant.load};
  // What does nothing would lengthen the period all the same.
  if (standing.cosine.any() || standing.sine.any()) space.standing_loads.push_back(standing);
}

/// All loads and weights of a stage.
std::vector<StageLoad> all_loads(const SpatialStage& stage) {
  auto loads = stage.loads;
  for (const auto& weight : stage.weights)
    loads.push_back({"weight", weight.body, StageFrame::housing, weight.place * Eigen::Vector3d::UnitZ(),
                     weight.mass * stage.gravity, Eigen::Vector3d::Zero()});
  return loads;
}

}  // namespace

StageSpace space_about_equilibrium(const SpatialStage& stage, const StageSpace::TiltInertia& inertia) {
  const auto turning = without_standing_loads(stage);
  const bool turns = stage.plane.carrier_speed != 0;
  const bool stands = turns && ((stage.gravity.head<2>().any() && !stage.weights.empty()) ||
                                std::any_of(stage.loads.begin(), stage.loads.end(),
                                            [](const auto& load) { return load.stands_in_housing(); }));
  const auto made = assemble(turning, 0), made_under_all = stands ? assemble(stage, 0) : made;
  const auto at = made.mechanism.solve();
  const auto under_all = stands ? made_under_all.mechanism.solve() : at;
  StageSpace space;
  space.base_helix_angle = stage.base_helix_angle;
  space.planet_working_radius_sun = stage.planet_working_radius_sun;
  space.planet_working_radius_ring = stage.planet_working_radius_ring;
  space.sun_face.middle = stage.sun_face.middle;
  space.ring_face.middle = stage.ring_face.middle;
  space.tilt_inertia = inertia;
  const bool in_space = !stage.reasons_for_space().empty();
  std::vector<PlanetBearings> of_planets(static_cast<std::size_t>(stage.planets()));
  const auto housed = stage.housing ? stage.housing->bearings : std::vector<std::size_t>{};
  std::vector<Linearised> in_housing(housed.size());
  Mounts mounts;
  for (std::size_t i = 0; i < made.bearings.size(); ++i) {
    const auto& bearing = made.bearings[i];
    if (bearing.body.kind == Kind::pin) continue;
    const bool given = i < turning.bearings.size();
    if (const auto place = std::find(housed.begin(), housed.end(), i); place != housed.end()) {
      in_housing[static_cast<std::size_t>(place - housed.begin())] = linearised(made_under_all.bearings[i], under_all);
      continue;
    }
    if (bearing.beside.any()) {
      mounts.add(linearised(made_under_all.bearings[i], under_all), bearing.beside);
      continue;
    }
    const bool on_housing = bearing.on.kind == Kind::housing && turns;
    auto found = on_housing && stands ? under_standing_loads(linearised(made_under_all.bearings[i], under_all))
                                      : linearised(bearing, at).bearing;
    if (!given) found.name = bearing.body.kind == Kind::planet ? "bearing" : "support";
    const bool directed = given && (turning.bearings[i].matrix || turning.bearings[i].x != turning.bearings[i].y);
    if (on_housing && directed) found.stiffness = mean_over_turn(found.stiffness);
    const bool seated = stage.pins && bearing.body.kind == Kind::planet && bearing.on.kind == Kind::carrier;
    if (seated) {
      auto& own = of_planets[static_cast<std::size_t>(bearing.body.planet)];
      own.made.push_back(bearing);
      own.linear.push_back(std::move(found));
      continue;
    }
    give_law(found, bearing);
    space.bearings.push_back(std::move(found));
  }
  const auto motions = in_space ? Motions::in_space : Motions::in_plane;
  if (stage.pins) put_on_pins(space, of_planets, *stage.pins, motions);
  if (mounts.any()) {
    space.bearings.push_back(mounts.bearing(motion_at(stage, under_all, {Kind::ring}, 0), turns));
    space.ring_mounts = mounts.torsion();
  }
  if (stage.housing) put_in_housing(space, stage, in_housing, made_under_all, under_all, motions);
  if (!in_space) {
    for (auto& b : space.bearings) flatten(b);
    for (auto& coupling : space.couplings)
      for (Eigen::Index i = 0; i < coupling.stiffness.rows(); ++i)
        if (i % 5 >= 2) {
          coupling.stiffness.row(i).setZero();
          coupling.stiffness.col(i).setZero();
        }
    for (const auto kind : {Kind::sun, Kind::ring, Kind::carrier}) space.bearings.push_back(plane_guide({kind}));
    for (int n = 0; n < stage.planets(); ++n) space.bearings.push_back(plane_guide({Kind::planet, n}));
  }
  for (auto load : all_loads(stage)) {
    if (!in_space) {  // moments tilt nothing
      load.moment.head<2>().setZero();
      load.point.z() = 0;
    }
    add_load(stage, load, space);
  }
  return space;
}

}  // namespace annulus::dynamics
