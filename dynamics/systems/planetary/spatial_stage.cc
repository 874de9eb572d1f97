#include "dynamics/systems/planetary/spatial_stage.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"
#include "dynamics/spatial/rolling_rows.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;
using Eigen::Vector3d;

constexpr std::array<Kind, 3> central_bodies{Kind::sun, Kind::ring, Kind::carrier};

Vector3d radial(double phi) { return {std::cos(phi), std::sin(phi), 0}; }
Vector3d tangential(double phi) { return {-std::sin(phi), std::cos(phi), 0}; }

const CentralBody& central(const SpatialStage& stage, Kind kind) {
  return kind == Kind::sun ? stage.plane.sun : kind == Kind::ring ? stage.plane.ring : stage.plane.carrier;
}

/// On the axis of a body, at the middle of the stage.
Vector3d centre_of(const SpatialStage& stage, const StageBody& body) {
  if (body.kind != Kind::planet && body.kind != Kind::pin) return Vector3d::Zero();
  return stage.plane.carrier.radius * radial(stage.plane.planet_angles[static_cast<std::size_t>(body.planet)]);
}

class Assembly {
 public:
  Assembly(const SpatialStage& stage, double t)
      : stage_(stage),
        time_(t),
        space_(!stage.reasons_for_space().empty()),
        result_{.mechanism = Mechanism(stage.plane.carrier.radius)},
        bearings_(result_.mechanism, space_ ? Motions::in_space : Motions::in_plane) {}

  StageMechanism build() && {
    for (const auto kind : central_bodies) mechanism().add_body({name_of_body({kind}), Vector3d::Zero(), space_});
    for (int n = 0; n < stage_.planets(); ++n)
      mechanism().add_body({name_of_body({Kind::planet, n}), centre_of(stage_, {Kind::planet, n}), space_});
    if (stage_.pins)
      for (int n = 0; n < stage_.planets(); ++n)
        mechanism().add_body({name_of_body({Kind::pin, n}), centre_of(stage_, {Kind::pin, n}), space_});
    if (stage_.housing) add_housing_places();
    for (const auto& bearing : stage_.bearings) add_bearing(bearing);
    for (const auto kind : central_bodies) add_support({kind});
    for (int n = 0; n < stage_.planets(); ++n) add_support({Kind::planet, n});
    if (stage_.pins) add_pins();
    if (stage_.housing) add_housing();
    add_rotations();
    for (int n = 0; n < stage_.planets(); ++n) result_.meshes.push_back(add_mesh(true, n));
    for (int n = 0; n < stage_.planets(); ++n) result_.meshes.push_back(add_mesh(false, n));
    if (stage_.plane.ring_coupling) couple();
    add_loads();
    result_.shared = bearings_.shared();
    return std::move(result_);
  }

 private:
  Mechanism& mechanism() { return result_.mechanism; }
  [[nodiscard]] int number(const StageBody& body) const { return body_number(stage_, body); }

  /// What a bearing stands on: those of planets on pins, those in the housing on its places, where these give way.
  [[nodiscard]] int seat_of(const StageBearing& b) const {
    if (stage_.housing)
      for (std::size_t i = 0; i < stage_.housing->bearings.size(); ++i)
        if (&stage_.bearings[stage_.housing->bearings[i]] == &b) return housing_place(i);
    const bool on_pin = stage_.pins && b.body.kind == Kind::planet && b.on.kind == Kind::carrier;
    return number(on_pin ? StageBody{Kind::pin, b.body.planet} : b.on);
  }

  [[nodiscard]] BearingPlace place_of(const StageBearing& b) const {
    return {number(b.body), seat_of(b), centre_of(stage_, b.body), frame_axes(stage_, b.frame(), b.body, time_)};
  }

  void add_bearing(const StageBearing& b) { result_.bearings.push_back(bearings_.add(b, place_of(b))); }

  /// The support of the plane, in the middle of the face.
  void add_support(const StageBody& body) {
    if (stage_.has_radial_bearings(body)) return;
    StageBearing b;
    b.body = body;
    if (!stage_.has_bearings(body)) b.axial = b.tilt = rigid;
    b.name = name_of_body(body) + (body.kind == Kind::planet ? " bearing" : " support");
    if (body.kind == Kind::planet) {
      const auto bearing = stage_.plane.planet_bearing(body.planet);
      b.on = {Kind::carrier};
      b.x = bearing.radial;
      b.y = bearing.tangential;
      b.play = bearing.play;
      b.seat = bearing.pin;
    } else {
      b.x = b.y = central(stage_, body.kind).support;
    }
    add_bearing(b);
  }

  /// The pins on the carrier, in which they do not turn: one element, as they act on each other through its structure.
  void add_pins() {
    const int each = space_ ? 5 : 2, planets = stage_.planets();
    Eigen::MatrixXd measures(each * planets, 6 * static_cast<Eigen::Index>(mechanism().bodies()));
    Eigen::MatrixXd stiffness(each * planets, each * planets);
    for (int i = 0; i < each * planets; ++i)
      for (int j = 0; j < each * planets; ++j)
        stiffness(i, j) = (*stage_.pins)(5 * (i / each) + i % each, 5 * (j / each) + j % each);
    std::vector<MadeBearing> made;
    for (int n = 0; n < planets; ++n) {
      StageBearing b;
      b.body = {Kind::pin, n};
      b.on = {Kind::carrier};
      b.name = name_of_body(b.body);
      const auto place = place_of(b);
      auto& pin = made.emplace_back(MadeBearing{b, place.axes});
      for (int i = 0; i < each; ++i) {
        measures.row(each * n + i) = bearings_.measure(b, place, i);
        pin.coordinate.at(static_cast<std::size_t>(i)) = each * n + i;
      }
      mechanism().hold(fmt::format("the rotation of {}", b.name),
                       mechanism().rotation(number(b.body), number(b.on), Vector3d::UnitZ()));
    }
    const int element = mechanism().add_element("pins", measures, std::make_shared<LinearLaw>(stiffness),
                                                Eigen::VectorXd::Zero(measures.rows()));
    for (auto& pin : made) {
      std::fill_n(pin.element.begin(), each, element);
      result_.bearings.push_back(std::move(pin));
    }
  }

  [[nodiscard]] int housing_place(std::size_t i) const { return first_housing_place_ + static_cast<int>(i); }

  void add_housing_places() {
    first_housing_place_ = mechanism().bodies();
    for (const std::size_t i : stage_.housing->bearings) {
      const auto& b = stage_.bearings.at(i);
      if (b.on.kind != Kind::housing)
        throw InputError(fmt::format("bearing '{}' stands on the {}, not on the housing", b.name, name_of_body(b.on)));
      auto name = "housing_" + b.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      mechanism().add_body({std::move(name), b.place * Vector3d::UnitZ()});
    }
  }

  void add_housing() {
    const auto& housing = *stage_.housing;
    const auto axes = frame_axes(stage_, StageFrame::housing, {}, time_);
    const Eigen::Index each = 5, places = std::ssize(housing.bearings);
    const Eigen::Index size = each * places + (housing.ring_bearing ? 1 : 0);
    if (housing.stiffness.rows() != size || housing.stiffness.cols() != size)
      throw InputError(fmt::format("the stiffness of the housing has {} x {} entries; {} bearings need {} x {}",
                                   housing.stiffness.rows(), housing.stiffness.cols(), places, size, size));
    Eigen::MatrixXd measures(size, 6 * static_cast<Eigen::Index>(mechanism().bodies()));
    for (std::size_t n = 0; n < housing.bearings.size(); ++n) {
      const int place = housing_place(n);
      const Eigen::Index first = each * static_cast<Eigen::Index>(n);
      for (int i = 0; i < 5; ++i)
        measures.row(first + i) =
            i < 3 ? mechanism().displacement(place, Mechanism::ground, mechanism().body(place).reference, axes.col(i))
                  : mechanism().rotation(place, Mechanism::ground, axes.col(i - 3));
      const auto turn = mechanism().rotation(place, Mechanism::ground, Vector3d::UnitZ());
      if (housing.ring_bearing == n)
        measures.row(size - 1) = turn;
      else
        mechanism().hold(fmt::format("the rotation of the {}", mechanism().body(place).name), turn);
    }
    (void)mechanism().add_element("housing", measures, std::make_shared<LinearLaw>(housing.stiffness),
                                  Eigen::VectorXd::Zero(size));
  }

  /// The angle of the carrier is that of the position; what the ring's torsional support gives way is elastic.
  void add_rotations() {
    const Vector3d axis = Vector3d::UnitZ();
    const int carrier = number({Kind::carrier}), ring = number({Kind::ring});
    result_.carrier_hold =
        mechanism().hold("the rotation of the carrier", mechanism().rotation(carrier, Mechanism::ground, axis));
    const bool in_housing = stage_.housing && stage_.housing->ring_bearing;
    const auto turn =
        mechanism().rotation(ring, in_housing ? housing_place(*stage_.housing->ring_bearing) : Mechanism::ground, axis);
    const double torsional = stage_.plane.ring.torsional_support;
    if (torsional == 0 && stage_.ring_turns_in_mounts()) return;
    if (torsional == rigid || torsional == 0) {
      result_.ring_hold = mechanism().hold("the rotation of the ring", turn);
      return;
    }
    const double stiffness = torsional * stage_.plane.ring.radius * stage_.plane.ring.radius;  // u = r_b phi
    result_.ring_support = mechanism().add_element(
        "ring torsional support", turn, std::make_shared<LinearLaw>(Eigen::MatrixXd::Constant(1, 1, stiffness)),
        Eigen::VectorXd::Zero(1));
  }

  StageMechanism::Mesh add_mesh(bool of_sun, int n) {
    const auto& plane = stage_.plane;
    const auto& face = of_sun ? stage_.sun_face : stage_.ring_face;
    const auto at = [n](const std::vector<double>& list) {
      return list.empty() ? 0.0 : list[static_cast<std::size_t>(n)];
    };
    const double phase = of_sun ? -at(plane.sun_phase_lag) : at(plane.ring_tooth_offset) - at(plane.ring_phase_lag);
    const double cycles = plane.mesh_rate() * time_;
    double of_teeth = 0;
    const auto& tooth_errors = of_sun ? plane.sun_tooth_errors : plane.ring_tooth_errors;
    if (!tooth_errors.empty())
      for (const auto& e : tooth_errors[static_cast<std::size_t>(n)]) of_teeth += e.curve(cycles + e.phase_offset);
    // Of the transverse section, of flanks with this working angle.
    const auto error = [&](double angle) {
      double sum = of_teeth;
      for (const auto& e : of_sun ? sun_mesh_errors(plane, n, angle) : ring_mesh_errors(plane, n, angle))
        sum += e.amount * std::sin(e.rate * time_ + e.phase);
      return sum;
    };
    const double alpha = of_sun ? plane.sun_working_angle : plane.ring_working_angle;
    StageMechanism::Mesh mesh;
    mesh.law = face.law(cycles + phase, StageFace::Flank::driving);
    auto driving = flank(of_sun, n, *mesh.law, 1, error(alpha));
    if (!of_sun && plane.ring_coupling)
      coupled_.push_back(std::move(driving));
    else
      mesh.driving = add_flank(of_sun, n, std::move(driving), mesh.law);
    if (face.backlash) {
      mesh.back_law = face.law(cycles + phase, StageFace::Flank::back);
      const double apart = *face.backlash / std::cos(stage_.base_helix_angle) - error(-alpha);
      mesh.back = add_flank(of_sun, n, flank(of_sun, n, *mesh.back_law, -1, apart), mesh.back_law);
    }
    return mesh;
  }

  /// All ring meshes as one element.
  void couple() {
    const auto planets = static_cast<std::size_t>(stage_.planets());
    const auto& plane = stage_.plane;
    const auto& coupling = *plane.ring_coupling;
    const double offset = plane.ring_tooth_offset.empty() ? 0.0 : plane.ring_tooth_offset.front();
    const double lag = plane.ring_phase_lag.empty() ? 0.0 : plane.ring_phase_lag.front();
    const double position = plane.mesh_rate() * time_ + offset - lag, c = std::cos(stage_.base_helix_angle);
    const auto curves = compliance_curves(coupling.compliance, coupling.per_cycle);
    Eigen::MatrixXd compliance(planets, planets);
    std::size_t curve = 0;
    for (Eigen::Index i = 0; i < compliance.rows(); ++i)
      for (Eigen::Index j = 0; j <= i; ++j) compliance(i, j) = compliance(j, i) = c * c * curves[curve++](position);
    std::vector<std::shared_ptr<const FaceLaw>> laws;
    for (std::size_t n = 0; n < planets; ++n) laws.push_back(result_.meshes[planets + n].law);
    result_.coupling = std::make_shared<CoupledFaces>(std::move(laws), std::move(compliance));
    Flank all{Eigen::MatrixXd(result_.coupling->size(), 6 * static_cast<Eigen::Index>(mechanism().bodies())),
              Eigen::VectorXd(result_.coupling->size())};
    for (std::size_t n = 0; n < planets; ++n) {
      const int first = result_.coupling->first(n);
      result_.meshes[planets + n].first = first;
      all.measures.middleRows(first, coupled_[n].measures.rows()) = coupled_[n].measures;
      all.offset.segment(first, coupled_[n].offset.size()) = coupled_[n].offset;
    }
    const int element = mechanism().add_element("ring meshes", all.measures, result_.coupling, all.offset);
    for (std::size_t n = 0; n < planets; ++n) result_.meshes[planets + n].driving = element;
  }

  struct Flank {
    Eigen::MatrixXd measures;
    Eigen::VectorXd offset;
  };

  int add_flank(bool of_sun, int n, Flank flank, std::shared_ptr<const ElasticLaw> law) {
    return mechanism().add_element(fmt::format("{}_planet{}", of_sun ? "sun" : "ring", n + 1),
                                   std::move(flank.measures), std::move(law), std::move(flank.offset));
  }

  /// `side`: 1 for driving flanks, -1 for back flanks. `gap`: m, of the transverse section.
  [[nodiscard]] Flank flank(bool of_sun, int n, const FaceLaw& law, double side, double gap) {
    const auto& plane = stage_.plane;
    const double phi = plane.planet_angles[static_cast<std::size_t>(n)];
    const double c = std::cos(stage_.base_helix_angle), s = std::sin(stage_.base_helix_angle);
    const double alpha = of_sun ? plane.sun_working_angle : plane.ring_working_angle;
    const Vector3d r = radial(phi), t = tangential(phi);
    const Vector3d along = (of_sun ? 1 : -1) * side * std::cos(alpha) * t + std::sin(alpha) * r;
    const Vector3d normal = c * along + side * s * Vector3d::UnitZ();
    const StageBody planet{Kind::planet, n};
    const int first = of_sun ? number({Kind::sun}) : number(planet);
    const int second = of_sun ? number(planet) : number({Kind::ring});
    const Vector3d pitch_point = of_sun ? Vector3d((plane.carrier.radius - stage_.planet_working_radius_sun) * r)
                                        : Vector3d((plane.carrier.radius + stage_.planet_working_radius_ring) * r);
    const double middle = of_sun ? stage_.sun_face.middle : stage_.ring_face.middle;
    const Eigen::Index count = std::ssize(law.stations());
    Eigen::MatrixXd measures(law.size(), 6 * static_cast<Eigen::Index>(mechanism().bodies()));
    // n . (phi x e) per metre along the transverse line of action e.
    if (law.leans()) measures.row(count) = mechanism().rotation(first, second, along.cross(normal));
    for (Eigen::Index i = 0; i < count; ++i) {
      const double z = middle + law.stations()[static_cast<std::size_t>(i)];
      measures.row(i) = mechanism().displacement(first, second, pitch_point + z * Vector3d::UnitZ(), normal);
    }
    Eigen::VectorXd offset = Eigen::VectorXd::Zero(law.size());
    offset.head(count).setConstant(c * gap);
    return {measures, offset};
  }

  void add_loads() {
    mechanism().add_load(number({Kind::sun}), Vector3d::Zero(), Vector3d::Zero(),
                         stage_.plane.sun_torque * Vector3d::UnitZ());
    for (const auto& load : stage_.loads) {
      const auto axes = frame_axes(stage_, load.frame, load.body, time_);
      mechanism().add_load(number(load.body), centre_of(stage_, load.body) + axes * load.point, axes * load.force,
                           axes * load.moment);
    }
    const Vector3d gravity = frame_axes(stage_, StageFrame::housing, {}, time_) * stage_.gravity;
    for (const auto& weight : stage_.weights)
      mechanism().add_load(number(weight.body), centre_of(stage_, weight.body) + weight.place * Vector3d::UnitZ(),
                           weight.mass * gravity, Vector3d::Zero());
  }

  const SpatialStage& stage_;
  double time_;
  bool space_;
  StageMechanism result_;
  int first_housing_place_ = 0;
  std::vector<Flank> coupled_;  // driving flanks of ring meshes
  BearingAssembly bearings_;
};

}  // namespace

bool SpatialStage::has_bearings(const StageBody& body) const {
  return std::any_of(bearings.begin(), bearings.end(), [&](const auto& b) { return b.body == body; });
}

bool SpatialStage::has_radial_bearings(const StageBody& body) const {
  return std::any_of(bearings.begin(), bearings.end(),
                     [&](const auto& b) { return b.body == body && b.holds_radially(); });
}

bool SpatialStage::ring_turns_in_mounts() const {
  return std::any_of(bearings.begin(), bearings.end(),
                     [](const auto& b) { return b.body.kind == Kind::ring && b.resists_turning(); });
}

std::vector<std::string> SpatialStage::reasons_for_space() const {
  std::vector<std::string> reasons;
  if (base_helix_angle != 0) reasons.emplace_back("the teeth are helical");
  for (const auto& [face, name] : {std::pair{&sun_face, "sun"}, {&ring_face, "ring"}}) {
    if (!face->symmetric)
      reasons.push_back(fmt::format("the flanks of the {} meshes differ between the ends of the face", name));
    if (face->middle != 0)
      reasons.push_back(fmt::format("the face of the {} meshes lies beside the middle of the stage", name));
  }
  add_reasons(reasons, loads, weights, gravity);
  if (housing) reasons.emplace_back("the housing gives way");
  if (pins && !keeps_plane(*pins)) reasons.emplace_back("pins or carrier tilt the planets as they give way");
  add_reasons(reasons, bearings);
  return reasons;
}

bool SpatialStage::depends_on_carrier_angle() const {
  if (plane.carrier_speed == 0) return false;
  if (std::any_of(loads.begin(), loads.end(), [](const auto& load) { return load.stands_in_housing(); })) return true;
  if (gravity.head<2>().any() && !weights.empty()) return true;
  if (housing) return true;
  for (const auto& b : bearings) {
    if (b.frame() != StageFrame::housing) continue;
    if (b.matrix || b.row || b.x != b.y || b.beside.any()) return true;
  }
  const auto fixed = [](const CentralBody& body) { return body.errors.position.exists(); };
  return fixed(plane.sun) || fixed(plane.ring) || fixed(plane.carrier);
}

int body_number(const SpatialStage& stage, const StageBody& body) {
  switch (body.kind) {
    case Kind::housing:
      return Mechanism::ground;
    case Kind::sun:
      return 0;
    case Kind::ring:
      return 1;
    case Kind::carrier:
      return 2;
    case Kind::planet:
      return 3 + body.planet;
    default:
      break;
  }
  return 3 + stage.planets() + body.planet;
}

Eigen::Matrix3d frame_axes(const SpatialStage& stage, StageFrame frame, const StageBody& body, double t) {
  double angle = 0;
  if (frame == StageFrame::housing) angle = -stage.plane.carrier_speed * t;
  if (frame == StageFrame::planet) angle = stage.plane.planet_angles.at(static_cast<std::size_t>(body.planet));
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}

StageMechanism assemble(const SpatialStage& stage, double t) { return Assembly(stage, t).build(); }

}  // namespace annulus::dynamics
