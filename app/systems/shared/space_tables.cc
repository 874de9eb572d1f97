#include "app/systems/shared/space_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/scene/key_checks.h"
#include "app/scene/scene_declare.h"
#include "app/systems/shared/space_input.h"
#include "core/errors.h"
#include "core/units.h"
#include "dynamics/spatial/elastic_laws.h"

namespace annulus::app {

namespace {

using dynamics::StageFrame;
using Body = dynamics::StageBody::Kind;

constexpr double furthest_mm = 1e5;

bool has_carrier(const KindInSpace& system) { return system.frames == KindInSpace::Frames::housing_and_carrier; }

std::vector<Choice<Body>> bodies(const KindInSpace& system) {
  std::vector<Choice<Body>> list;
  for (const auto& b : system.bodies) list.push_back({b.name, b.body});
  return list;
}

template <class Section>
void declare_body(Declarations<Section>& t, const KindInSpace& of, const char* meaning) {
  t.choice("body", &Section::body, bodies(of), meaning).required();
  if (!has_carrier(of)) return;
  t.key("planet", &Section::planet, "Number of the planet, from 1 on.")
      .from(1, 100)
      .only_if(is("body", {"planet"}), "other bodies have no numbers")
      .absent("every planet");
}

Table bearing_table(const KindInSpace& of) {
  Declarations bearing(
      "bearing",
      "A bearing, coupling or mount in its place on the axis. A body that has any is held by these "
      "alone. Others have their support of [supports], or the bearings of their gear. They neither move "
      "along the axis nor tilt.",
      &SpaceInput::bearings);
  bearing.on_request();
  bearing.key("name", &BearingInput::name, "Name in results.").required();
  declare_body(bearing, of, "The body that it holds.");
  if (has_carrier(of))
    bearing
        .choice("on", &BearingInput::on,
                {{"housing", Body::housing}, {"carrier", Body::carrier}, {"sun", Body::sun}, {"ring", Body::ring}},
                "The body on which it stands.")
        .absent("the housing; of planets the carrier");
  bearing
      .key("at_mm", &BearingInput::place, "Place of its middle along the axis, from the middle of the face of [stage].")
      .fallback(0.0, "in the middle of the face")
      .from(-furthest_mm, furthest_mm);
  if (has_carrier(of))
    bearing
        .key(
            "beside_axis_mm", &BearingInput::beside,
            "Place of a mount beside the axis, x and y as those of loads in the housing: a trunnion or a torque arm of "
            "a ring that does not turn. Such mounts keep the ring from turning, beside "
            "supports.ring_torsional_N_per_m where it is given.")
        .from(-furthest_mm, furthest_mm)
        .only_if(is("body", {"ring"}), "a mount stands in the housing beside what does not turn")
        .absent("on the axis");
  const auto stiffness = [&](const char* name, auto member, const char* meaning) {
    return bearing.key(name, member, meaning).from(0, 1e15).infinite().word("rigid", rigid);
  };
  const auto has_matrix = given("stiffness_5x5_N_m_rad"), has_balls = given("balls");
  const auto has_rows = given("rollers") || has_balls;
  constexpr const char* why_rows = "the stiffness of rolling elements follows from their contact";
  constexpr const char* why_matrix = "the matrix contains all stiffnesses";
  stiffness("radial_N_per_m", &BearingInput::radial, "Radial stiffness, the same in all directions.")
      .refused_if(has_matrix, why_matrix)
      .refused_if(has_rows, why_rows)
      .refused_if(given("x_N_per_m") || given("y_N_per_m"), "the stiffness has a value for each direction")
      .absent("none");
  for (const auto& [name, member, meaning] :
       {std::tuple{
            "x_N_per_m", &BearingInput::x,
            "Stiffness along x, which is fixed in the body on which the bearing stands: towards planet 1 at time 0; of "
            "planets radially outwards; of a pair from the pinion to the wheel."},
        {"y_N_per_m", &BearingInput::y, "Stiffness along y; of planets tangentially."}})
    stiffness(name, member, meaning)
        .refused_if(has_matrix, why_matrix)
        .refused_if(has_rows, why_rows)
        .absent("radial_N_per_m");
  stiffness("axial_N_per_m", &BearingInput::axial, "Stiffness along the axis.")
      .refused_if(has_matrix, why_matrix)
      .fallback(0.0, "it does not hold along the axis");
  bearing.key("tilt_Nm_per_rad", &BearingInput::tilt, "Stiffness against tilting about x and y.")
      .from(0, 1e15)
      .infinite()
      .word("rigid", rigid)
      .refused_if(has_matrix, why_matrix)
      .refused_if(has_rows, why_rows)
      .fallback(0.0, "it tilts freely");
  bearing
      .key("radial_displacement_um", &BearingInput::displacement,
           "Radial displacements of a table, rising from 0 or from where the clearance ends.")
      .from(0, 1e5)
      .together_with("radial_force_N")
      .refused_if(has_matrix || has_rows || given("radial_N_per_m") || given("x_N_per_m") || given("y_N_per_m"),
                  "the table is the radial stiffness")
      .absent("the single stiffnesses");
  bearing.key("radial_force_N", &BearingInput::force, "Forces at these displacements, along them; they must not fall.")
      .from(0, 1e9)
      .absent("the single stiffnesses");
  bearing
      .key("rollers", &BearingInput::rollers,
           "Number of rollers in the row, cylindrical or tapered. Their line contact (ISO/TS 16281, steel, logarithmic "
           "profile) gives its stiffness.")
      .from(3, 1000)
      .refused_if(has_matrix, why_matrix)
      .refused_if(has_balls, "a row has one kind of rolling elements")
      .absent("the single stiffnesses");
  bearing.key("roller_length_mm", &BearingInput::roller_length, "Effective length of the rollers.")
      .above(0, 1000)
      .needed_if(given("rollers"));
  bearing.key("roller_diameter_mm", &BearingInput::roller_diameter, "Diameter of the rollers, in their middle.")
      .above(0, 1000)
      .needed_if(given("rollers"));
  bearing
      .key("balls", &BearingInput::balls,
           "Number of balls in the row. Their contacts (ISO/TS 16281, steel) give its stiffness.")
      .from(3, 1000)
      .refused_if(has_matrix, why_matrix)
      .absent("the single stiffnesses");
  bearing.key("ball_diameter_mm", &BearingInput::ball_diameter, "Diameter of the balls.")
      .above(0, 1000)
      .needed_if(has_balls);
  bearing
      .key("pitch_diameter_mm", &BearingInput::pitch_diameter,
           "Diameter on which the middles of the rolling elements lie. Rows with a contact angle need it.")
      .above(0, 1e5)
      .required_if(has_balls)
      .only_if(has_rows, "it is that of a row of rolling elements")
      .absent("only cylindrical rollers need none");
  bearing
      .key("contact_angle_deg", &BearingInput::contact_angle,
           "Contact angle without load; of tapered rollers that of the outer raceway. Positive: the row holds the body "
           "against a displacement along +z, negative: against one along -z.")
      .only_if(has_rows, "it is that of a row of rolling elements")
      .fallback(0.0, "cylindrical rollers, or a deep groove")
      .from(-80, 80);
  for (const auto& [key, member, value, name] :
       {std::tuple{"inner_groove_ratio", &BearingInput::inner_groove, 0.52, "inner"},
        {"outer_groove_ratio", &BearingInput::outer_groove, 0.53, "outer"}})
    bearing.key(key, member, fmt::format("Radius of the groove of the {} ring over the diameter of the balls.", name))
        .only_if(has_balls, "rollers have no grooves")
        .fallback(value, "ISO/TS 16281")
        .above(0.5, 10);
  bearing
      .choice("body_ring", &BearingInput::ring,
              {{"inner", dynamics::RollingRow::Ring::inner}, {"outer", dynamics::RollingRow::Ring::outer}},
              "The ring of the row that sits on the body.")
      .only_if(has_rows, "it is that of a row of rolling elements")
      .absent("the outer one of planets, the inner one of other bodies");
  bearing
      .key("clearance_um", &BearingInput::clearance,
           "Radial clearance (ISO 5753-1): how far the body moves across it from stop to stop. Negative, of rolling "
           "elements alone: preload.")
      .only_if(given("radial_N_per_m") || has_rows, "beyond the clearance it has one stiffness in all directions")
      .fallback(0.0, "none")
      .from(-1000, 1e5);
  bearing
      .choice("clearance_law", &BearingInput::load_zone, {{"load_zone", true}, {"stop", false}},
              "Force beyond the clearance. load_zone: rollers of linear stiffness, of which more carry the larger the "
              "load is; radial_N_per_m is the stiffness without clearance. stop: radial_N_per_m times the way beyond "
              "half the clearance.")
      .only_if(given("clearance_um"), "without clearance both are the same")
      .refused_if(has_rows, "rolling elements have a law of their own")
      .fallback("load_zone", "as in rolling bearings");
  bearing
      .key("axial_clearance_um", &BearingInput::axial_clearance,
           "Axial clearance: how far the body moves along the axis from stop to stop.")
      .only_if(given("axial_N_per_m"), "beyond the clearance it needs a stiffness")
      .fallback(0.0, "none")
      .from(0, 1e5);
  bearing
      .key("tilt_clearance_deg", &BearingInput::tilt_clearance,
           "Tilt clearance: how far the body tilts in any direction from stop to stop, as a spline with backlash does.")
      .only_if(given("tilt_Nm_per_rad"), "beyond the clearance it needs a stiffness")
      .fallback(0.0, "none")
      .from(0, 10);
  bearing
      .key("stiffness_5x5_N_m_rad", &BearingInput::matrix,
           "Stiffness matrix in rows, 25 values. Rows are forces along x, y, z (N) and moments about x, y (N m). "
           "Columns "
           "are displacements along x, y, z (m) and tilts about x, y (rad) of the body in the place of the bearing. "
           "Symmetric.")
      .from(-1e15, 1e15)
      .longest(25)
      .absent("the single stiffnesses");
  return bearing.done();
}

Table load_table(const KindInSpace& of) {
  Declarations load("load", "A force and a moment on a body from without, beside the torque of [stage].",
                    &SpaceInput::loads);
  load.on_request();
  load.key("name", &LoadInput::name, "Name in results.").required();
  declare_body(load, of, "The body on which it acts.");
  if (has_carrier(of))
    load.choice("frame", &LoadInput::frame, {{"housing", StageFrame::housing}, {"carrier", StageFrame::carrier}},
                "Frame in which it is given: x towards planet 1, z along the axis. housing: as the carrier stands at "
                "time 0.")
        .fallback("housing", "it stands still while the carrier turns");
  load.key("at_mm", &LoadInput::point,
           "Point at which the force acts, x, y, z from the middle of the stage, or of the planet or gear.")
      .from(-furthest_mm, furthest_mm)
      .longest(3)
      .absent("the middle");
  load.key("force_N", &LoadInput::force, "Force, x, y, z.")
      .from(-1e9, 1e9)
      .longest(3)
      .some_of({"moment_Nm"})
      .absent("none");
  load.key("moment_Nm", &LoadInput::moment, "Moment, about x, y, z. That about z must be zero: it is a torque.")
      .from(-1e9, 1e9)
      .longest(3)
      .absent("none");
  return load.done();
}

Table gravity_table(const KindInSpace& of) {
  Declarations<GravityInput> gravity("gravity", "Weight of all bodies.", &SpaceInput::gravity);
  gravity.on_request();
  gravity.key("acceleration_m_per_s2", &GravityInput::acceleration, "Acceleration of gravity.")
      .fallback(9.80665, "standard gravity")
      .from(0, 1000);
  gravity
      .key("direction_deg", &GravityInput::direction,
           "Its direction in the transverse plane, counter-clockwise from planet 1 at time 0; of a pair from "
           "the direction of the wheel's axis.")
      .required()
      .from(-360, 360);
  gravity
      .key("inclination_deg", &GravityInput::inclination,
           "Angle by which it leans out of the transverse plane towards +z: that of the axis with the horizontal.")
      .fallback(0.0, "the axis is horizontal")
      .from(-90, 90);
  for (const auto& body : of.bodies)
    gravity
        .key(fmt::format("{}_at_mm", body.name), body.centre_of_mass,
             fmt::format("Centre of mass of the {} along the axis, from the middle of the face of [stage].", body.name))
        .fallback(0.0, "in the middle of the face")
        .from(-furthest_mm, furthest_mm);
  return gravity.done();
}

Table bearing_laws_key() {
  Declarations<SpaceInput> lumped("dynamics", "");
  lumped
      .choice(
          "bearing_laws", &SpaceInput::bearing_laws,
          {{"tangents", dynamics::BearingLaws::tangents}, {"whole", dynamics::BearingLaws::whole}},
          "How [[bearing]] with clearance, rolling elements or a table act in motion. tangents: with their stiffness "
          "at the equilibrium; whole: by their law at every instant, which takes longer.")
      .fallback("tangents", "a run measures how far the motion leaves them");
  return lumped.done();
}

Table tilt_inertia_table(const KindInSpace& of) {
  Declarations<TiltInertiaInput> tilting(
      "tilt_inertia", "Moments of inertia about an axis across the body's own, through the middle of the face.",
      &SpaceInput::tilt_inertia);
  tilting.on_request();
  for (const auto& body : of.bodies)
    tilting.key(fmt::format("{}_kg_m2", body.name), body.tilt_inertia, fmt::format("Of the {}.", body.name))
        .above(0, 1e9)
        .absent("a uniform cylinder as wide as the face about its centre of mass ([gravity]): I/2 + m b^2/12");
  return tilting.done();
}

/// Has a force a torque about the axis, beyond rounding?
bool twists(const std::vector<double>& point, const std::vector<double>& force) {
  constexpr double rounding = 1e-9;
  return std::abs(point[0] * force[1] - point[1] * force[0]) >
         rounding * std::hypot(point[0], point[1]) * std::hypot(force[0], force[1]);
}

class SpaceChecks : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    const auto& space = scene_.own<SpaceInput>();
    names("bearing.name", space.bearings);
    names("load.name", space.loads);
    for (std::size_t i = 0; i < space.bearings.size(); ++i) bearing(i, space.bearings[i]);
    for (std::size_t i = 0; i < space.loads.size(); ++i) load(i, space.loads[i]);
  }

 private:
  template <class List>
  void names(const std::string& key, const List& list) {
    const auto printable = [](unsigned char c) { return c >= ' ' && c != 127 && c != ',' && c != '"'; };
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!usable(key, i)) continue;
      const auto& name = list[i].name;
      if (name.empty() || !std::all_of(name.begin(), name.end(), printable))
        problem(key, i, "names it in tables: not empty, without line breaks, tabs, commas and quotes");
      for (std::size_t j = 0; j < i; ++j)
        if (column_of(list[j].name) == column_of(name)) {
          problem(key, i, "is the name of more than one; each needs its own");
          break;
        }
    }
  }

  void planet(const std::string& key, std::size_t i, const std::optional<int>& number) {
    if (number && usable(key, i) && usable("stage.planets") && *number > scene_.stage.planets)
      problem(key, i, fmt::format("is the number of no planet: there are {}", scene_.stage.planets));
  }

  void bearing(std::size_t i, const BearingInput& b) {
    planet("bearing.planet", i, b.planet);
    if (b.on && usable("bearing.on", i) && usable("bearing.body", i)) {
      if (b.body == Body::planet && *b.on != Body::carrier)
        problem("bearing.on", i, "planets stand on the carrier: use \"carrier\", or leave it out");
      else if (*b.on == b.body)
        problem("bearing.on", i, "a body cannot stand on itself; use another body, or leave it out");
      else if ((*b.on == Body::sun || *b.on == Body::ring) && b.has_directions())
        problem("bearing.on", i,
                "would turn x and y of the bearing with a body that has no frame; use bearing.radial_N_per_m, which is "
                "the same in all directions");
    }
    beside_axis(i, b);
    if (b.tilt_clearance > 0 && (b.tilt == rigid || b.tilt == 0) && usable("bearing.tilt_clearance_deg", i) &&
        usable("bearing.tilt_Nm_per_rad", i))
      problem("bearing.tilt_clearance_deg", i,
              "needs a bearing that gives way beyond it; use a finite bearing.tilt_Nm_per_rad above 0");
    const bool plays = (b.clearance > 0 && b.radial == rigid) || (b.axial_clearance > 0 && b.axial == rigid);
    if (plays && usable("bearing.clearance_um", i) && usable("bearing.axial_clearance_um", i))
      problem(b.clearance > 0 && b.radial == rigid ? "bearing.clearance_um" : "bearing.axial_clearance_um", i,
              "needs a bearing that gives way beyond it; use a finite stiffness");
    if (b.clearance > 0 && b.radial == 0.0 && usable("bearing.clearance_um", i))
      problem("bearing.clearance_um", i, "needs a stiffness beyond it: bearing.radial_N_per_m is 0");
    if (b.clearance < 0 && !b.rolls() && usable("bearing.clearance_um", i))
      problem("bearing.clearance_um", i,
              "is a preload, which rolling elements alone have (bearing.rollers, bearing.balls); use 0 or more");
    if (!b.matrix.empty()) return matrix(i, b.matrix);
    if (b.rolls()) return row(i, b);
    if (!b.displacement.empty() && usable("bearing.radial_displacement_um", i) && usable("bearing.radial_force_N", i))
      try {
        return (void)dynamics::TableLaw(b.displacement, b.force);
      } catch (const InputError& error) {
        return problem("bearing.radial_force_N", i, error.what());
      }
    const bool any =
        b.radial.value_or(0) > 0 || b.x.value_or(0) > 0 || b.y.value_or(0) > 0 || b.axial > 0 || b.tilt > 0;
    const bool all_usable = std::all_of(std::begin(stiffness_keys), std::end(stiffness_keys),
                                        [&](const char* key) { return !given(key, i) || usable(key, i); });
    if (!any && all_usable)
      problem("bearing.name", i,
              "holds nothing: give bearing.radial_N_per_m, x_N_per_m, y_N_per_m, axial_N_per_m, tilt_Nm_per_rad or "
              "stiffness_5x5_N_m_rad");
  }

  void beside_axis(std::size_t i, const BearingInput& b) {
    const std::string key = "bearing.beside_axis_mm";
    if (b.beside.empty() || !usable(key, i)) return;
    if (b.beside.size() != 2) return problem(key, i, fmt::format("needs two values, x and y, not {}", b.beside.size()));
    if (b.beside[0] == 0 && b.beside[1] == 0) return problem(key, i, "lies on the axis; leave it out");
    if (b.on.value_or(Body::housing) != Body::housing)
      return problem(key, i, "is the place of a mount in the housing; leave bearing.on out");
    if (b.along_x() == rigid || b.along_y() == rigid || b.axial == rigid || b.tilt == rigid)
      problem(key, i, "needs a mount that gives way; use finite stiffnesses");
  }

  void matrix(std::size_t i, const std::vector<double>& values) {
    const std::string key = "bearing.stiffness_5x5_N_m_rad";
    if (!usable(key, i)) return;
    if (values.size() != 25)
      return problem(key, i, fmt::format("needs 25 values, five rows of five, not {}", values.size()));
    try {
      (void)dynamics::LinearLaw(Eigen::Map<const Eigen::Matrix<double, 5, 5, Eigen::RowMajor>>(values.data()));
    } catch (const InputError& error) {
      problem(key, i, error.what());
    }
  }

  void row(std::size_t i, const BearingInput& b) {
    const bool inclined = b.balls || b.contact_angle != 0;
    const std::string count = b.balls ? "bearing.balls" : "bearing.rollers";
    const bool sized = b.balls ? b.ball_diameter.has_value() : b.roller_diameter && b.roller_length;
    if (b.rollers && inclined && !b.pitch_diameter && usable("bearing.contact_angle_deg", i))
      problem("bearing.contact_angle_deg", i, "needs the place of the contacts; give bearing.pitch_diameter_mm");
    else if (usable(count, i) && sized && (!b.balls || b.pitch_diameter))
      try {
        (void)dynamics::law_of(rolling_row(b), dynamics::Motions::in_space);
      } catch (const InputError& error) {
        problem(count, i, error.what());
      }
    if (inclined && given("bearing.axial_N_per_m", i) && usable("bearing.axial_N_per_m", i))
      problem("bearing.axial_N_per_m", i,
              "the rolling elements hold along the axis by themselves; leave it out, or give another bearing");
  }

  void load(std::size_t i, const LoadInput& l) {
    planet("load.planet", i, l.planet);
    for (const auto& [key, list] :
         {std::pair{"load.at_mm", &l.point}, {"load.force_N", &l.force}, {"load.moment_Nm", &l.moment}})
      if (!list->empty() && list->size() != 3 && usable(key, i))
        problem(key, i, fmt::format("needs three values, x, y and z, not {}", list->size()));
    if (l.moment.size() == 3 && l.moment[2] != 0 && usable("load.moment_Nm", i))
      problem("load.moment_Nm", i,
              l.body == Body::planet
                  ? "has a part about z, which is a torque; use 0 there, and load.force_N at a point "
                    "beside the middle of the planet (load.at_mm)"
                  : "has a part about z: that is a torque, which [stage] gives; use 0");
    if (l.force.size() == 3 && l.point.size() == 3 && l.body != Body::planet && usable("load.force_N", i) &&
        usable("load.at_mm", i) && twists(l.point, l.force))
      problem("load.at_mm", i,
              "gives the force a torque about the axis, which [stage] states; use a point on the line of the force "
              "through the axis");
  }

  static constexpr const char* stiffness_keys[] = {"bearing.radial_N_per_m",  "bearing.x_N_per_m",
                                                   "bearing.y_N_per_m",       "bearing.axial_N_per_m",
                                                   "bearing.tilt_Nm_per_rad", "bearing.stiffness_5x5_N_m_rad"};
};

}  // namespace

std::vector<Table> space_tables(const KindInSpace& of) {
  return {bearing_table(of), load_table(of), gravity_table(of), tilt_inertia_table(of), bearing_laws_key()};
}

void check_space(Scene& scene, std::vector<Problem>& problems) { SpaceChecks(scene, problems).run(); }

}  // namespace annulus::app
