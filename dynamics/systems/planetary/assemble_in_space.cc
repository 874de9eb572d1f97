#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/errors.h"
#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;
using Forms = std::vector<LinearForm>;
using Stiffness = LinearBearing::Stiffness;
using Vector = LinearBearing::Vector;

template <class Bodies>
auto& forms_of(Bodies& bodies, const StageBody& body) {
  if (body.kind == Kind::planet) return bodies.planets[static_cast<std::size_t>(body.planet)];
  return body.kind == Kind::sun ? bodies.sun : body.kind == Kind::ring ? bodies.ring : bodies.carrier;
}

/// What the dynamics need to know of a body.
struct BodyData {
  double mass = 0, inertia = 0, radius = 0, tilt_inertia = 0;
  double spin = 0;  ///< rad/s, absolute
  double torsional_support = 0;
};

BodyData data_of(const PlanetaryStage& stage, const StageBody& body) {
  const auto& tilt = stage.space->tilt_inertia;
  const auto central = [](const CentralBody& b, double across, double spin) {
    return BodyData{b.mass, b.inertia, b.radius, across, spin, b.torsional_support};
  };
  const auto of_ring = [&](BodyData ring) {
    if (const auto* coupling = stage.space->coupling_of_ring())
      ring.torsional_support = coupling->stiffness.bottomRightCorner<1, 1>().value();
    return ring;
  };
  switch (body.kind) {
    case Kind::sun:
      return central(stage.sun, tilt.sun, stage.sun_speed());
    case Kind::ring:
      return of_ring(central(stage.ring, tilt.ring, stage.ring_speed));
    case Kind::carrier:
      return central(stage.carrier, tilt.carrier, stage.carrier_speed);
    default:
      return {stage.planet.mass, stage.planet.inertia, stage.planet.radius, tilt.planet, stage.planet_speed(), 0};
  }
}

/// Coordinates (x, y, z, about x, about y) of body `on` in the middle of a body, in the axes of the latter.
Forms seat(const PlanetaryStage& stage, const StageForms& bodies, const StageBody& body, const StageBody& on) {
  if (on.kind == Kind::housing) return Forms(5);
  const BodyForms& b = forms_of(bodies, on);
  if (body.kind != Kind::planet) return {b.x, b.y, b.z, b.tilt_x, b.tilt_y};
  const double phi = stage.planet_angles[static_cast<std::size_t>(body.planet)];
  const double c = std::cos(phi), s = std::sin(phi), a = stage.carrier.radius;
  const LinearForm about_radial = c * b.tilt_x + s * b.tilt_y, about_tangential = (-s) * b.tilt_x + c * b.tilt_y;
  return {c * b.x + s * b.y, (-s) * b.x + c * b.y + (a / data_of(stage, on).radius) * b.u,
          b.z + (-a) * about_tangential, about_radial, about_tangential};
}

/// Equations rows x d = right between the coordinates of a body, solved for as many of them as there are equations.
class Constraints {
 public:
  explicit Constraints(double length) : unit_{1, 1, 1, 1 / length, 1 / length} {}

  void add(const Vector& row, const LinearForm& right) {
    Row next{row.cwiseProduct(unit_), right};
    for (const auto& known : rows_) subtract(next, known);
    Eigen::Index pivot = 0;
    constexpr double rounding = 1e-9;
    if (next.factors.cwiseAbs().maxCoeff(&pivot) < rounding) return;  // held already
    const double size = next.factors[pivot];
    next.factors /= size;
    next.right = (1 / size) * next.right;
    next.pivot = pivot;
    for (auto& known : rows_) subtract(known, next);
    rows_.push_back(std::move(next));
  }

  /// The coordinates, with a new DOF (named by `add_dof`) for each one that is free; in units of lengths.
  template <class AddDof>
  [[nodiscard]] Forms solve(const AddDof& add_dof) const {
    Forms result(5);
    std::array<bool, 5> bound{};
    for (const auto& row : rows_) bound.at(static_cast<std::size_t>(row.pivot)) = true;
    for (std::size_t i = 0; i < 5; ++i)
      if (!bound.at(i)) result[i] = add_dof(static_cast<int>(i));
    for (const auto& row : rows_) {
      LinearForm form = row.right;
      for (Eigen::Index i = 0; i < 5; ++i)
        if (!bound.at(static_cast<std::size_t>(i)) && row.factors[i] != 0)
          form = form + (-row.factors[i]) * result[static_cast<std::size_t>(i)];
      result[static_cast<std::size_t>(row.pivot)] = std::move(form);
    }
    for (std::size_t i = 0; i < 5; ++i) result[i] = unit_[static_cast<Eigen::Index>(i)] * result[i];
    return result;
  }

 private:
  struct Row {
    Vector factors;
    LinearForm right;
    Eigen::Index pivot = 0;
  };
  static void subtract(Row& from, const Row& known) {
    const double share = from.factors[known.pivot];
    if (share == 0) return;
    from.factors -= share * known.factors;
    from.right = from.right + (-share) * known.right;
  }

  Vector unit_;
  std::vector<Row> rows_;
};

class SpaceBodies {
 public:
  SpaceBodies(LumpedSystemBuilder& builder, const PlanetaryStage& stage)
      : builder_(builder), stage_(stage), speed_(stage.rotating_frame ? stage.carrier_speed : 0) {
    forms_.planets.resize(static_cast<std::size_t>(stage.planets()));
  }

  StageForms build() && {
    for (const auto kind : {Kind::sun, Kind::ring, Kind::carrier}) add_body({kind});
    for (int n = 0; n < stage_.planets(); ++n) add_body({Kind::planet, n});
    for (std::size_t i = 0; i < stage_.space->bearings.size(); ++i) add_bearing(i);
    for (const auto& coupling : stage_.space->couplings) add_coupling(coupling);
    for (const auto& load : stage_.space->loads) add_load(load);
    for (const auto& load : stage_.space->standing_loads) add_load(load);
    add_dampers();
    return std::move(forms_);
  }

 private:
  void add_body(const StageBody& body) {
    const BodyData data = data_of(stage_, body);
    const auto name = name_of_body(body);
    Constraints constraints(data.radius);
    for (const auto& b : stage_.space->bearings) {
      if (b.body != body) continue;
      for (Eigen::Index i = 0; i < 5; ++i) {
        if (!b.rigid.at(static_cast<std::size_t>(i))) continue;
        const bool planet = body.kind == Kind::planet;
        if (b.on.kind != Kind::housing && !planet)
          throw InputError(fmt::format("bearing '{}' of the {} stands rigidly on the {}: give it a stiffness", b.name,
                                       name, name_of_body(b.on)));
        const Vector row = to_place(b.place).row(i);
        LinearForm right;
        const auto on = seat(stage_, forms_, body, b.on);
        for (Eigen::Index j = 0; j < 5; ++j)
          if (row[j] != 0) right = right + row[j] * on[static_cast<std::size_t>(j)];
        constraints.add(row, right);
      }
    }
    constexpr std::array<const char*, 5> dofs{"_x", "_y", "_z", "_tiltx", "_tilty"};
    const auto d =
        constraints.solve([&](int i) { return builder_.add_dof(name + dofs.at(static_cast<std::size_t>(i))); });
    BodyForms& forms = forms_of(forms_, body);
    forms.x = d[0];
    forms.y = d[1];
    forms.z = d[2];
    forms.tilt_x = d[3];
    forms.tilt_y = d[4];
    builder_.add_rotating_mass(forms.x, forms.y, data.mass, speed_);
    builder_.add_mass(forms.z, data.mass);
    builder_.add_tilting_mass(forms.tilt_x, forms.tilt_y, data.tilt_inertia, data.inertia,
                              stage_.rotating_frame ? data.spin : 0, speed_);
    const double rotating = data.inertia / (data.radius * data.radius);
    if (data.torsional_support != rigid) {
      forms.u = builder_.add_dof(name + "_u");
      builder_.add_mass(forms.u, rotating);
      const bool coupled = body.kind == Kind::ring && stage_.space->coupling_of_ring();
      builder_.add_spring(forms.u, coupled ? 0 : data.torsional_support,
                          critical_share(stage_.support_damping_ratio, data.torsional_support, rotating),
                          name + "_support_u");
    }
    if (body.kind == Kind::planet) add_centrifugal(body.planet);
  }

  /// The centrifugal preload of a planet's bearing, which turns and tilts with the carrier (see assemble.cc).
  void add_centrifugal(int n) {
    const double centrifugal = stage_.planet.mass * speed_ * speed_, a = stage_.carrier.radius;
    const double phi = stage_.planet_angles[static_cast<std::size_t>(n)];
    const auto& carrier = forms_.carrier;
    const auto& planet = forms_.planets[static_cast<std::size_t>(n)];
    const LinearForm translation = (-std::sin(phi)) * carrier.x + std::cos(phi) * carrier.y;
    const LinearForm tilt = a * ((-std::sin(phi)) * carrier.tilt_x + std::cos(phi) * carrier.tilt_y);
    builder_.add_rotating_stiffness(planet.y, carrier.u, 2 * centrifugal);
    builder_.add_rotating_stiffness(carrier.u, carrier.u, -centrifugal);
    builder_.add_rotating_stiffness(translation, carrier.u, -2 * centrifugal);
    // The radial direction of the seat tilts with the carrier: m a Omega^2 (-a tilt^2 / 2 - z tilt) of a planet at z.
    builder_.add_rotating_stiffness(tilt, tilt, -centrifugal);
    builder_.add_rotating_stiffness(planet.z, tilt, -2 * centrifugal);
    builder_.add_rotating_stiffness(carrier.z, tilt, 2 * centrifugal);
  }

  void add_bearing(std::size_t number) {
    const LinearBearing& bearing = stage_.space->bearings[number];
    const auto d = relative_motion(stage_, forms_, bearing.body, bearing.on);
    const auto move = to_place(bearing.place);
    const Vector force = move.transpose() * bearing.preload;
    const Vector standing = move.transpose() * bearing.standing, later = quarter_turn_later(standing);
    for (Eigen::Index i = 0; i < 5; ++i) {
      const auto& coordinate = d[static_cast<std::size_t>(i)];
      builder_.add_load(coordinate, -force[i]);
      builder_.add_harmonic_load(coordinate, stage_.carrier_speed, -standing[i], -later[i]);
    }
    if (stage_.space->coupling_of(number)) return;  // add_coupling()
    const std::string name = bearing.element();
    for (const auto& [stiffness, form] :
         squares(moved_along_axis(bearing.stiffness, bearing.place), d, data_of(stage_, bearing.body).radius))
      builder_.add_spring(form, stiffness, 0, name);
  }

  void add_coupling(const LinearCoupling& coupling) {
    for (const auto& [stiffness, form] :
         squares(stage_.space->whole(coupling), coordinates_of(coupling), stage_.planet.radius))
      builder_.add_spring(form, stiffness, 0, coupling.name);
    if (coupling.turns_ring) builder_.add_load(forms_.ring.u, -coupling.ring_preload);
  }

  [[nodiscard]] Forms coordinates_of(const LinearCoupling& coupling) const {
    Forms all;
    for (const std::size_t i : coupling.bearings)
      for (auto& form : bearing_motion(stage_, forms_, stage_.space->bearings[i])) all.push_back(std::move(form));
    if (coupling.turns_ring) all.push_back(forms_.ring.u);
    return all;
  }

  /// The coordinates of a body on which forces and moments do work.
  [[nodiscard]] std::array<LinearForm, 6> loaded(const StageBody& body) {
    const BodyForms& b = forms_of(forms_, body);
    return {b.x, b.y, b.z, b.tilt_x, b.tilt_y, (1 / data_of(stage_, body).radius) * b.u};
  }

  void add_load(const SpaceLoad& load) {
    Eigen::Index i = 0;
    for (const auto& form : loaded(load.body)) builder_.add_load(form, load.load[i++]);
  }

  void add_load(const StandingLoad& load) {
    Eigen::Index i = 0;
    for (const auto& form : loaded(load.body)) {
      builder_.add_harmonic_load(form, stage_.carrier_speed, load.cosine[i], load.sine[i]);
      ++i;
    }
  }

  struct Square {
    double value = 0;
    LinearForm form;
  };
  /// A symmetric matrix over coordinates d as sum of value x form^2. `length`: m, by which tilts are compared.
  /// Five coordinates per body, the last two tilts; one more at the end is a displacement.
  static std::vector<Square> squares(const Eigen::MatrixXd& matrix, const Forms& d, double length) {
    Eigen::VectorXd unit(matrix.rows());
    for (Eigen::Index i = 0; i < unit.size(); ++i) unit[i] = i % 5 < 3 ? 1 : 1 / length;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(unit.asDiagonal() * matrix * unit.asDiagonal());
    std::vector<Square> list;
    constexpr double rounding = 1e-13;
    const double least = rounding * solver.eigenvalues().cwiseAbs().maxCoeff();
    for (Eigen::Index k = 0; k < unit.size(); ++k) {
      if (std::abs(solver.eigenvalues()[k]) <= least) continue;
      Square square{solver.eigenvalues()[k], {}};
      for (Eigen::Index i = 0; i < unit.size(); ++i)
        if (const double factor = solver.eigenvectors()(i, k) / unit[i]; factor != 0)
          square.form = square.form + factor * d[static_cast<std::size_t>(i)];
      list.push_back(std::move(square));
    }
    return list;
  }

  /// Every mode of a body on its bearings has the damping ratio of the supports: C = 2 zeta M^1/2 (M^-1/2 K M^-1/2)^1/2
  /// M^1/2. Of a bearing in the middle these are the dampers of the plane.
  void add_dampers() {
    const auto& bearings = stage_.space->bearings;
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      const auto& first = bearings[i];
      const auto same = [&](const auto& b) { return b.body == first.body && b.on == first.on; };
      if (std::any_of(bearings.begin(), bearings.begin() + static_cast<std::ptrdiff_t>(i), same)) continue;
      if (stands_on_carrier(first) && stage_.space->coupling_of(i)) continue;
      Stiffness sum = Stiffness::Zero();
      for (const auto& b : bearings)
        if (same(b)) sum += moved_along_axis(b.stiffness, b.place);
      const BodyData data = data_of(stage_, first.body);
      const Eigen::MatrixXd damping = damping_of(sum, data);
      const auto d = relative_motion(stage_, forms_, first.body, first.on);
      // In the housing the turning frame adds Omega x (-y, x).
      const Forms turned{(-1.0) * d[1], d[0], {}, (-1.0) * d[4], d[3]};
      for (const auto& [value, form] : squares(damping, d, data.radius))
        builder_.add_spring(form, 0, value, name_of_body(first.body) + "_dampers");
      if (first.on.kind != Kind::housing) continue;
      for (Eigen::Index r = 0; r < 5; ++r)
        for (Eigen::Index c = 0; c < 5; ++c)
          if (damping(r, c) != 0)
            builder_.add_circulatory(d[static_cast<std::size_t>(r)], turned[static_cast<std::size_t>(c)],
                                     damping(r, c) * speed_);
    }
    for (const auto& coupling : stage_.space->couplings) {
      if (!stands_on_carrier(bearings[coupling.bearings.front()])) continue;
      for (const auto& [value, form] :
           squares(damping_of(stage_.space->whole(coupling), data_of(stage_, {Kind::planet, 0})),
                   coordinates_of(coupling), stage_.planet.radius))
        builder_.add_spring(form, 0, value, "planet_dampers");
    }
  }

  /// Of equal bodies, five coordinates each.
  [[nodiscard]] Eigen::MatrixXd damping_of(const Eigen::MatrixXd& stiffness, const BodyData& data) const {
    Eigen::VectorXd root(stiffness.rows());
    for (Eigen::Index i = 0; i < root.size(); ++i) root[i] = std::sqrt(i % 5 < 3 ? data.mass : data.tilt_inertia);
    const Eigen::VectorXd inverse = root.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inverse.asDiagonal() * stiffness *
                                                                inverse.asDiagonal());
    const Eigen::MatrixXd rates = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
                                  solver.eigenvectors().transpose();
    return 2 * stage_.support_damping_ratio * root.asDiagonal() * rates * root.asDiagonal();
  }

  LumpedSystemBuilder& builder_;
  const PlanetaryStage& stage_;
  double speed_;
  StageForms forms_;
};

}  // namespace

StageForms add_bodies_in_space(LumpedSystemBuilder& builder, const PlanetaryStage& stage) {
  return SpaceBodies(builder, stage).build();
}

std::vector<LinearForm> relative_motion(const PlanetaryStage& stage, const StageForms& bodies, const StageBody& body,
                                        const StageBody& on) {
  const BodyForms& b = forms_of(bodies, body);
  const auto below = seat(stage, bodies, body, on);
  std::vector<LinearForm> d{b.x, b.y, b.z, b.tilt_x, b.tilt_y};
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = d[i] + (-1.0) * below[i];
  return d;
}

std::vector<LinearForm> bearing_motion(const PlanetaryStage& stage, const StageForms& bodies,
                                       const LinearBearing& bearing) {
  const auto middle = relative_motion(stage, bodies, bearing.body, bearing.on);
  const auto move = to_place(bearing.place);
  std::vector<LinearForm> d(middle.size());
  for (Eigen::Index i = 0; i < move.rows(); ++i)
    for (Eigen::Index j = 0; j < move.cols(); ++j)
      if (move(i, j) != 0)
        d[static_cast<std::size_t>(i)] = d[static_cast<std::size_t>(i)] + move(i, j) * middle[static_cast<std::size_t>(j)];
  return d;
}

// With the normal n = c e + s z of the flanks and a contact at rho_T + z: n . (phi x rho) / c = phi . (rho_T x e) +
// tan(beta_b) phi . (rho_T x z) + z phi . (z x e). The first term is the plane's u.
MeshOutOfPlane mesh_out_of_plane(const PlanetaryStage& stage, const StageForms& bodies, MeshWith with, int planet) {
  const bool of_sun = with == MeshWith::sun;
  const auto& space = *stage.space;
  const auto n = static_cast<std::size_t>(planet);
  const double phi = stage.planet_angles[n], tangent = std::tan(space.base_helix_angle);
  const auto& wheel = of_sun ? bodies.sun : bodies.ring;
  const auto& own = bodies.planets[n];
  const LinearForm wheel_radial = std::cos(phi) * wheel.tilt_x + std::sin(phi) * wheel.tilt_y;
  const LinearForm wheel_tangential = (-std::sin(phi)) * wheel.tilt_x + std::cos(phi) * wheel.tilt_y;
  const auto& face = of_sun ? space.sun_face : space.ring_face;
  const double alpha = of_sun ? stage.sun_working_angle : stage.ring_working_angle;
  const double from_planet = of_sun ? -space.planet_working_radius_sun : space.planet_working_radius_ring;
  const double from_wheel = stage.carrier.radius + from_planet;
  // The driving body is 1: the sun, of ring meshes the planet.
  const double sign = of_sun ? 1 : -1;
  MeshOutOfPlane result;
  const double across_r = of_sun ? -std::cos(alpha) : std::cos(alpha), across_t = std::sin(alpha);  // z x e
  const LinearForm slope =
      sign * (across_r * (wheel_radial + (-1.0) * own.tilt_x) + across_t * (wheel_tangential + (-1.0) * own.tilt_y));
  result.approach = (sign * tangent) * (wheel.z + (-1.0) * own.z) +
                    (-sign * tangent) * (from_wheel * wheel_tangential + (-from_planet) * own.tilt_y) +
                    face.middle * slope;
  result.tilt = (face.width / 2) * slope;
  return result;
}

}  // namespace annulus::dynamics
