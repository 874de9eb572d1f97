#include <cmath>
#include <numbers>
#include <string>

#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;

/// A rotation as u = r theta with its mass J/r^2; empty forms and zero 1/mass where it is held.
struct TurningForm {
  LinearForm u;
  double radius = 0;
  double inverse_mass = 0;  ///< r^2/J, 1/kg
};

/// Collects the stage; a member function per kind of element.
class TwoKVAssembler {
 public:
  explicit TwoKVAssembler(const TwoKVStage& stage) : stage_(stage) {}

  LumpedSystem build() {
    add_dofs();
    add_shafts_and_supports();
    for (int i = 0; i < stage_.cranks; ++i) add_sun_mesh(i);
    for (int j = 0; j < stage_.arc_gears; ++j) add_arc_mesh(j);
    for (int i = 0; i < stage_.cranks; ++i)
      for (int j = 0; j < stage_.arc_gears; ++j) add_arc_bearing(i, j);
    add_loads();
    return builder_.build();
  }

 private:
  /// A body whose rotation a rigid support may hold.
  TurningForm supported(const std::string& name, double inertia, double radius, double support) {
    return support == rigid ? TurningForm{{}, radius, 0} : turning(name, inertia, radius);
  }

  TurningForm turning(const std::string& name, double inertia, double radius) {
    TurningForm body{builder_.add_dof(name + "_u"), radius, radius * radius / inertia};
    builder_.add_mass(body.u, inertia / (radius * radius));
    return body;
  }

  LinearForm moving_centre(const std::string& name, double mass) {
    auto x = builder_.add_dof(name + "_x");
    builder_.add_mass(x, mass);
    return x;
  }

  void add_dofs() {
    const double r_c = stage_.crank_circle_radius();
    input_ = supported("input", stage_.input_inertia, stage_.sun_base_radius(), stage_.input_support);
    sun_ = turning("sun", stage_.sun_inertia, stage_.sun_base_radius());
    const auto numbered = [](const char* body, int i) { return body + std::to_string(i + 1); };
    for (int i = 0; i < stage_.cranks; ++i)
      planets_.push_back(turning(numbered("planet", i), stage_.planet_inertia, stage_.planet_base_radius()));
    for (int i = 0; i < stage_.cranks; ++i)
      cranks_.push_back(turning(numbered("crank", i), stage_.crank_inertia, stage_.eccentricity));
    for (int j = 0; j < stage_.arc_gears; ++j) arcs_.push_back(turning(numbered("arc", j), stage_.arc_inertia, r_c));
    output_ = supported("output", stage_.output_inertia, r_c, stage_.output_support);
    for (int i = 0; i < stage_.cranks; ++i)
      planet_x_.push_back(moving_centre(numbered("planet", i), stage_.planet_mass));
    for (int j = 0; j < stage_.arc_gears; ++j) arc_x_.push_back(moving_centre(numbered("arc", j), stage_.arc_mass));
  }

  /// A spring between bodies, 1/m_e = a^T M^-1 a.
  void add_spring(const LinearForm& a, double stiffness, double inverse_mass, const std::optional<double>& ratio,
                  const std::string& name) {
    builder_.add_spring(a, stiffness, damper(ratio, stiffness, inverse_mass), name);
  }
  [[nodiscard]] double damper(const std::optional<double>& ratio, double stiffness, double inverse_mass) const {
    return 2 * ratio.value_or(stage_.support_damping_ratio) * std::sqrt(stiffness / inverse_mass);
  }

  void add_shafts_and_supports() {
    const double r_s = sun_.radius;
    add_spring(input_.u + (-1.0) * sun_.u, stage_.input_shaft / (r_s * r_s), input_.inverse_mass + sun_.inverse_mass,
               stage_.input_damping_ratio, "input_shaft");
    for (int i = 0; i < stage_.cranks; ++i) {
      const auto number = std::to_string(i + 1);
      const auto &planet = planets_[i], &crank = cranks_[i];
      const double to_planet = planet.radius / crank.radius;
      add_spring(planet.u + (-to_planet) * crank.u, stage_.crank_shaft / (planet.radius * planet.radius),
                 planet.inverse_mass + to_planet * to_planet * crank.inverse_mass, stage_.crank_shaft_damping_ratio,
                 "planet" + number + "_shaft");
      add_spring(planet_x_[i] + (-1.0) * output_.u, stage_.crank_bearing, 1 / stage_.planet_mass + output_.inverse_mass,
                 stage_.crank_bearing_damping_ratio, "crank" + number + "_bearing");
    }
    const auto support = [&](const TurningForm& body, double stiffness, const std::optional<double>& ratio,
                             const std::string& name) {
      if (stiffness != rigid && stiffness != 0)
        add_spring(body.u, stiffness / (body.radius * body.radius), body.inverse_mass, ratio, name + "_support_u");
    };
    support(input_, stage_.input_support, stage_.input_damping_ratio, "input");
    support(output_, stage_.output_support, stage_.output_damping_ratio, "output");
  }

  MeshElement mesh(const std::string& name, LinearForm b, const MeshExcitation& excitation, double inverse_mass) const {
    MeshElement element;
    element.name = name;
    element.b = std::move(b);
    element.excitation = excitation;
    const auto& own = &excitation == &stage_.sun_mesh ? stage_.sun_mesh_damping_ratio : stage_.arc_mesh_damping_ratio;
    element.damping =
        2 * own.value_or(stage_.mesh_damping_ratio) * std::sqrt(mean_stiffness(excitation) / inverse_mass);
    element.damping_without_contact = stage_.damping_without_contact;
    return element;
  }

  void add_sun_mesh(int i) {
    const double along = std::cos(stage_.pressure_angle);
    auto element =
        mesh("sun_planet" + std::to_string(i + 1), sun_.u + planets_[i].u + (-along) * planet_x_[i], stage_.sun_mesh,
             sun_.inverse_mass + planets_[i].inverse_mass + along * along / stage_.planet_mass);
    element.frequency = stage_.sun_mesh_frequency();
    element.phase_offset =
        -(stage_.planet_teeth * stage_.crank_angle + stage_.sun_teeth * crank_position(i)) / full_turn;
    element.half_backlash = stage_.sun_half_backlash;
    builder_.add_mesh(std::move(element));
  }

  void add_arc_mesh(int j) {
    const double lever = stage_.eccentricity * stage_.arc_teeth / arcs_[j].radius;
    auto element = mesh("arc_pins" + std::to_string(j + 1), (-1.0) * arc_x_[j] + (-lever) * arcs_[j].u, stage_.arc_mesh,
                        1 / stage_.arc_mass + lever * lever * arcs_[j].inverse_mass);
    element.frequency = stage_.arc_mesh_frequency();
    element.phase_offset = -stage_.arc_teeth * stage_.crank_angle / full_turn -
                           static_cast<double>(stage_.pins) * (j + 1) / stage_.arc_gears;
    element.half_backlash = stage_.arc_half_backlash;
    builder_.add_mesh(std::move(element));
  }

  /// |(X_a - a th_h) v_j + (r_c th_a - X_p) t_i|^2 in components along t_i and along the radius of the crank:
  /// v_j.t_i = cos(Theta_j - phi_i), v_j.(cos phi_i, sin phi_i) = -sin(Theta_j - phi_i).
  void add_arc_bearing(int i, int j) {
    const double angle = stage_.crank_angle + full_turn * (j + 1) / stage_.arc_gears - crank_position(i);
    const double rate = stage_.crank_rate();
    const LinearForm along_t = arcs_[j].u + (-1.0) * planet_x_[i], along_v = arc_x_[j] + (-1.0) * cranks_[i].u;
    // Half the trace of B^T M^-1 B, B the two vectors.
    const double inverse_mass =
        (arcs_[j].inverse_mass + 1 / stage_.planet_mass + 1 / stage_.arc_mass + cranks_[i].inverse_mass) / 2;
    const auto component = [&](const char* direction, LinearForm b, double amount, double phase) {
      MeshElement element;
      element.name = "crank" + std::to_string(i + 1) + "_arc" + std::to_string(j + 1) + direction;
      element.b = std::move(b);
      element.excitation = ConstantStiffness{stage_.arc_bearing};
      element.damping = damper(stage_.arc_bearing_damping_ratio, stage_.arc_bearing, inverse_mass);
      for (const auto& [dof, factor] : along_v) element.moving.push_back({dof, {}, {amount * factor, rate, phase}});
      builder_.add_mesh(std::move(element));
    };
    component("_tangential", along_t, 1, angle + std::numbers::pi / 2);
    component("_radial", {}, -1, angle);
  }

  void add_loads() {
    const auto ends = stage_.shaft_ends();
    builder_.add_load(input_.u, ends[0].load, LoadCause::torque);
    builder_.add_load(output_.u, ends[1].load, LoadCause::torque);
  }

  /// phi_i
  [[nodiscard]] double crank_position(int i) const { return full_turn * (i + 1) / stage_.cranks; }

  const TwoKVStage& stage_;
  LumpedSystemBuilder builder_;
  TurningForm input_, sun_, output_;
  std::vector<TurningForm> planets_, cranks_, arcs_;
  std::vector<LinearForm> planet_x_, arc_x_;
};

}  // namespace

LumpedSystem assemble(const TwoKVStage& stage) {
  stage.check();
  return with_structural_damping(with_rotors(TwoKVAssembler(stage).build(), stage.rotors, stage.shaft_ends()),
                                 stage.structural_damping);
}

}  // namespace annulus::dynamics
