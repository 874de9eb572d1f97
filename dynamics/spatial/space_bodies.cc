#include "dynamics/spatial/space_bodies.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/errors.h"
#include "dynamics/spatial/bearing_laws.h"
#include "dynamics/system/support.h"

namespace annulus::dynamics {

namespace {

using Forms = std::vector<LinearForm>;
using Vector = LinearBearing::Vector;

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
  SpaceBodies(LumpedSystemBuilder& builder, const SpaceSupports& supports, const std::vector<SpaceBody>& bodies,
              const SpaceFrame& frame, const SeatOf& seat)
      : builder_(builder), supports_(supports), bodies_(bodies), frame_(frame), seat_(seat) {}

  std::vector<BodyForms> build() && {
    for (const auto& body : bodies_) add_body(body);
    for (std::size_t i = 0; i < supports_.bearings.size(); ++i) add_bearing(i);
    for (const auto& coupling : supports_.couplings) add_coupling(coupling);
    for (const auto& load : supports_.loads) add_load(load);
    for (const auto& load : supports_.standing_loads) add_load(load);
    add_dampers();
    return std::move(forms_);
  }

 private:
  void add_body(const SpaceBody& body) {
    const auto name = name_of_body(body.body);
    Constraints constraints(body.radius);
    for (const auto& b : supports_.bearings) {
      if (b.body != body.body) continue;
      for (Eigen::Index i = 0; i < 5; ++i) {
        if (!b.rigid.at(static_cast<std::size_t>(i))) continue;
        const Vector row = to_place(b.place).row(i);
        LinearForm right;
        const auto on = seat_(forms_, body.body, b.on);
        for (Eigen::Index j = 0; j < 5; ++j)
          if (row[j] != 0) right = right + row[j] * on[static_cast<std::size_t>(j)];
        constraints.add(row, right);
      }
    }
    constexpr std::array<const char*, 5> dofs{"_x", "_y", "_z", "_tiltx", "_tilty"};
    const auto d =
        constraints.solve([&](int i) { return builder_.add_dof(name + dofs.at(static_cast<std::size_t>(i))); });
    BodyForms forms{d[0], d[1], {}, d[2], d[3], d[4]};
    const double off = body.mass_place, in_centre = body.tilt_inertia - body.mass * off * off;
    if (!(in_centre > 0))
      throw InputError(
          fmt::format("the tilting inertia of the {}, {:g} kg m^2 about its middle, is less than that of its "
                      "mass of {:g} kg at z = {:g} m",
                      name, body.tilt_inertia, body.mass, off));
    builder_.add_rotating_mass(forms.x + off * forms.tilt_y, forms.y + (-off) * forms.tilt_x, body.mass, frame_.speed);
    builder_.add_mass(forms.z, body.mass);
    builder_.add_tilting_mass(forms.tilt_x, forms.tilt_y, in_centre, body.inertia, body.spin, frame_.speed);
    const double rotating = body.inertia / (body.radius * body.radius);
    if (body.torsional_support != rigid) {
      forms.u = builder_.add_dof(name + "_u");
      builder_.add_mass(forms.u, rotating);
      const bool coupled = supports_.coupling_that_turns(body.body) != nullptr;
      builder_.add_spring(forms.u, coupled ? 0 : body.torsional_support,
                          critical_share(body.damping_ratio, body.torsional_support, rotating), name + "_support_u");
    }
    forms_.push_back(std::move(forms));
  }

  [[nodiscard]] std::size_t number(const StageBody& body) const {
    const auto found = std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& b) { return b.body == body; });
    require(found != bodies_.end(), fmt::format("the {} is no body of this system", name_of_body(body)));
    return static_cast<std::size_t>(found - bodies_.begin());
  }
  [[nodiscard]] const SpaceBody& data_of(const StageBody& body) const { return bodies_[number(body)]; }

  /// Coordinates of a bearing's body in its middle.
  [[nodiscard]] Forms motion_of(const LinearBearing& bearing) const {
    return against(forms_[number(bearing.body)], seat_(forms_, bearing.body, bearing.on));
  }

  void add_bearing(std::size_t index) {
    const auto bearing =
        supports_.laws == BearingLaws::whole ? beside_law(supports_, index) : supports_.bearings[index];
    const auto d = motion_of(bearing);
    const auto move = to_place(bearing.place);
    const Vector force = move.transpose() * bearing.preload;
    const Vector standing = move.transpose() * bearing.standing, later = quarter_turn_later(standing);
    for (Eigen::Index i = 0; i < 5; ++i) {
      const auto& coordinate = d[static_cast<std::size_t>(i)];
      builder_.add_load(coordinate, -force[i]);
      builder_.add_harmonic_load(coordinate, frame_.carrier_speed, -standing[i], -later[i]);
    }
    if (supports_.coupling_of(index)) return;  // add_coupling()
    const std::string name = bearing.element();
    for (const auto& [stiffness, form] :
         squares(moved_along_axis(bearing.stiffness, bearing.place), d, data_of(bearing.body).radius))
      builder_.add_spring(form, stiffness, 0, name);
  }

  [[nodiscard]] double length_of(const LinearCoupling& coupling) const {
    return data_of(supports_.bearings[coupling.bearings.front()].body).radius;
  }

  void add_coupling(const LinearCoupling& coupling) {
    for (const auto& [stiffness, form] :
         squares(supports_.whole(coupling), coordinates_of(coupling), length_of(coupling)))
      builder_.add_spring(form, stiffness, 0, coupling.name);
    if (coupling.turned && !(coupling.law && supports_.laws == BearingLaws::whole))
      builder_.add_load(forms_[number(*coupling.turned)].u, -coupling.turning_preload);
  }

  [[nodiscard]] Forms coordinates_of(const LinearCoupling& coupling) const {
    Forms all;
    for (const std::size_t i : coupling.bearings)
      for (auto& form : at_place(motion_of(supports_.bearings[i]), supports_.bearings[i].place))
        all.push_back(std::move(form));
    if (coupling.turned) all.push_back(forms_[number(*coupling.turned)].u);
    return all;
  }

  /// The coordinates of a body on which forces and moments do work.
  [[nodiscard]] std::array<LinearForm, 6> loaded(const StageBody& body) const {
    const BodyForms& b = forms_[number(body)];
    return {b.x, b.y, b.z, b.tilt_x, b.tilt_y, (1 / data_of(body).radius) * b.u};
  }

  void add_load(const SpaceLoad& load) {
    Eigen::Index i = 0;
    for (const auto& form : loaded(load.body)) builder_.add_load(form, load.load[i++]);
  }

  void add_load(const StandingLoad& load) {
    Eigen::Index i = 0;
    for (const auto& form : loaded(load.body)) {
      builder_.add_harmonic_load(form, frame_.carrier_speed, load.cosine[i], load.sine[i]);
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

  /// Bodies on the same one that act on each other through it.
  struct Together {
    StageBody on;
    std::vector<StageBody> bodies;

    [[nodiscard]] Eigen::Index first_of(const StageBody& body) const {
      return 5 * (std::find(bodies.begin(), bodies.end(), body) - bodies.begin());
    }
    [[nodiscard]] bool has(const LinearBearing& b) const {
      return b.on == on && std::find(bodies.begin(), bodies.end(), b.body) != bodies.end();
    }
  };

  [[nodiscard]] std::vector<Together> bodies_together() const {
    std::vector<Together> list;
    for (const auto& b : supports_.bearings)
      if (std::none_of(list.begin(), list.end(), [&](const auto& t) { return t.has(b); }))
        list.push_back({b.on, {b.body}});
    for (const auto& coupling : supports_.couplings) {
      const auto with = [&](std::size_t i) {
        return std::find_if(list.begin(), list.end(), [&](const auto& t) { return t.has(supports_.bearings[i]); });
      };
      for (const std::size_t i : coupling.bearings) {
        const auto first = with(coupling.bearings.front()), other = with(i);
        if (first == other) continue;
        first->bodies.insert(first->bodies.end(), other->bodies.begin(), other->bodies.end());
        list.erase(other);
      }
    }
    return list;
  }

  /// In the middles of the bodies, 5 coordinates each.
  [[nodiscard]] Eigen::MatrixXd stiffness_of(const Together& together) const {
    const Eigen::Index size = 5 * std::ssize(together.bodies);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
    for (const auto& b : supports_.bearings)
      if (together.has(b)) {
        const auto first = together.first_of(b.body);
        sum.block<5, 5>(first, first) += moved_along_axis(b.stiffness, b.place);
      }
    for (const auto& coupling : supports_.couplings)
      for (std::size_t i = 0; i < coupling.bearings.size(); ++i)
        for (std::size_t j = 0; j < coupling.bearings.size(); ++j) {
          const auto &a = supports_.bearings[coupling.bearings[i]], &b = supports_.bearings[coupling.bearings[j]];
          if (!together.has(a)) continue;
          const auto from = 5 * static_cast<Eigen::Index>(i), to = 5 * static_cast<Eigen::Index>(j);
          sum.block<5, 5>(together.first_of(a.body), together.first_of(b.body)) +=
              to_place(a.place).transpose() * coupling.stiffness.block<5, 5>(from, to) * to_place(b.place);
        }
    return sum;
  }

  [[nodiscard]] Eigen::MatrixXd mass_of(const Together& together) const {
    const Eigen::Index size = 5 * std::ssize(together.bodies);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
    for (const auto& body : together.bodies) {
      const auto& data = data_of(body);
      auto own = all.block<5, 5>(together.first_of(body), together.first_of(body));
      own.diagonal() << data.mass, data.mass, data.mass, data.tilt_inertia, data.tilt_inertia;
      own(0, 4) = own(4, 0) = data.mass * data.mass_place;
      own(1, 3) = own(3, 1) = -data.mass * data.mass_place;
    }
    return all;
  }

  /// Every mode of a body on its bearings has its damping ratio: C = 2 zeta M^1/2 (M^-1/2 K
  /// M^-1/2)^1/2 M^1/2. With a bearing in the middle these are the dampers of the plane.
  void add_dampers() {
    for (const auto& together : bodies_together()) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> mass(mass_of(together));
      const Eigen::MatrixXd root = mass.operatorSqrt(), inverse = mass.operatorInverseSqrt();
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(inverse * stiffness_of(together) * inverse);
      const Eigen::MatrixXd rates = modes.eigenvectors() * modes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
                                    modes.eigenvectors().transpose();
      Eigen::VectorXd share(rates.rows());  // of both sides: the ratio itself where all bodies have the same
      for (const auto& body : together.bodies)
        share.segment<5>(together.first_of(body)).setConstant(std::sqrt(data_of(body).damping_ratio));
      const Eigen::MatrixXd damping = 2 * root * share.asDiagonal() * rates * share.asDiagonal() * root;
      Forms all, turned;
      for (const auto& body : together.bodies) {
        const auto d = against(forms_[number(body)], seat_(forms_, body, together.on));
        all.insert(all.end(), d.begin(), d.end());
        // In the housing the turning frame adds Omega x (-y, x).
        turned.insert(turned.end(), {(-1.0) * d[1], d[0], {}, (-1.0) * d[4], d[3]});
      }
      const auto name = name_of_body(together.bodies.front()) + "_dampers";
      for (const auto& [value, form] : squares(damping, all, data_of(together.bodies.front()).radius))
        builder_.add_spring(form, 0, value, name);
      if (together.on.kind != StageBody::Kind::housing) continue;
      for (Eigen::Index r = 0; r < damping.rows(); ++r)
        for (Eigen::Index c = 0; c < damping.cols(); ++c)
          if (damping(r, c) != 0)
            builder_.add_circulatory(all[static_cast<std::size_t>(r)], turned[static_cast<std::size_t>(c)],
                                     damping(r, c) * frame_.speed);
    }
  }

  LumpedSystemBuilder& builder_;
  const SpaceSupports& supports_;
  const std::vector<SpaceBody>& bodies_;
  const SpaceFrame& frame_;
  const SeatOf& seat_;
  std::vector<BodyForms> forms_;
};

}  // namespace

std::vector<BodyForms> add_space_bodies(LumpedSystemBuilder& builder, const SpaceSupports& supports,
                                        const std::vector<SpaceBody>& bodies, const SpaceFrame& frame,
                                        const SeatOf& seat) {
  return SpaceBodies(builder, supports, bodies, frame, seat).build();
}

Forms seat_in_housing() { return Forms(5); }

Forms against(const BodyForms& body, const Forms& seat) {
  Forms d{body.x, body.y, body.z, body.tilt_x, body.tilt_y};
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = d[i] + (-1.0) * seat[i];
  return d;
}

Forms at_place(const Forms& in_middle, double place) {
  const auto move = to_place(place);
  Forms d(in_middle.size());
  for (Eigen::Index i = 0; i < move.rows(); ++i)
    for (Eigen::Index j = 0; j < move.cols(); ++j)
      if (move(i, j) != 0)
        d[static_cast<std::size_t>(i)] =
            d[static_cast<std::size_t>(i)] + move(i, j) * in_middle[static_cast<std::size_t>(j)];
  return d;
}

MeshElement spread_over_face(LumpedSystemBuilder& builder, MeshElement& mesh, const SpreadFace& face,
                             const LinearForm& tilt, int number, int second) {
  FaceElement element{number, second, mesh.half_backlash, {}, {}};
  double mean_square = 0;
  for (const auto& place : face_places()) mean_square += place.weight * place.z * place.z;
  if (face.shape) {
    const auto curve = [](const std::vector<double>& values) {
      return PeriodicCurve(values, static_cast<int>(values.size()));
    };
    element.course = {curve(face.shape->slope), curve(face.shape->curvature), curve(face.shape->gap_slope)};
    mean_square += 2.0 / 15 * element.course->curvature.mean();
  }
  for (std::size_t i = 0; i < face_places().size(); ++i) {
    const auto& [z, weight] = face_places()[i];
    element.places.push_back({z, weight, face.gap.empty() ? 0.0 : face.gap[i]});
  }
  mesh.half_backlash.reset();
  MeshElement own;
  own.name = mesh.name + "_tilt";
  own.b = tilt;
  own.excitation = ConstantStiffness{mean_square * mean_tangent_stiffness(mesh.excitation)};
  own.damping = mean_square * mesh.damping;
  own.damping_without_contact = mesh.damping_without_contact;
  builder.add_face(std::move(element));
  return own;
}

}  // namespace annulus::dynamics
