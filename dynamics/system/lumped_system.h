#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/system/curve_bundle.h"
#include "dynamics/system/force_law.h"
#include "dynamics/system/mesh_excitation.h"

namespace annulus::dynamics {

/// A coordinate as a linear combination of DOFs: sum of factor x DOF. Empty: the coordinate is fixed.
using LinearForm = std::vector<std::pair<int, double>>;
[[nodiscard]] LinearForm operator+(const LinearForm& a, const LinearForm& b);
[[nodiscard]] LinearForm operator*(double factor, const LinearForm& a);

/// A part of a mesh vector that changes in time: factor(t) x DOF is added to the approach b^T q, where
/// factor(t) = curve(frequency t + phase_offset of the mesh) + amount x sin(rate t + phase).
struct MovingShare {
  int dof = 0;
  PeriodicCurve curve;
  HarmonicError wave{};
};

/// Friction on the flanks of a mesh: beside -b F the force -|F| curve(frequency t + phase_offset of the mesh) acts on
/// the DOFs along a form.
struct FrictionShare {
  LinearForm along;
  PeriodicCurve curve;
};

/// Oil between flanks that do not touch: it resists with coefficient h^(-3/2) h' to flanks that approach across a gap
/// h, the driving ones or the back flanks; flanks that part leave it without force.
struct SqueezeFilm {
  double coefficient = 0;  ///< N s m^(1/2), along the line of action
  double least_gap = 0;    ///< m, > 0: thinner films resist as this one
  bool operator==(const SqueezeFilm&) const = default;
};

/// One gear mesh of any kind. b^T q is the approach of the bodies and delta = b^T q - e(t) the deflection, both along
/// the line of action. The force on the DOFs is -b F with F = k(t) g(delta) + c delta', where g takes off half the
/// backlash. c acts while the teeth are in contact (or always). A ForceSurface replaces k(t) g by its law Fs(t, g).
struct MeshElement {
  std::string name;
  LinearForm b;
  MeshExcitation excitation;
  double frequency = 0;                 ///< Hz, mesh cycles per second; negative: they run backwards
  double phase_offset = 0;              ///< mesh cycles at t = 0: the excitation is read at frequency t + phase_offset
  double damping = 0;                   ///< N s/m
  std::optional<double> half_backlash;  ///< m
  bool damping_without_contact = false;
  std::optional<SqueezeFilm> film{};  ///< within the backlash
  std::vector<HarmonicError> errors;
  std::vector<ToothError> tooth_errors;
  std::vector<MovingShare> moving;      ///< at most one per DOF
  std::vector<FrictionShare> friction;  ///< F with its damping
  bool shaft = false;                   ///< a shaft with its couplings, which has no teeth
};

/// Meshes that act on each other through a common elastic body: the ring, or a planet. The law of mesh i acts on the
/// deflection
///   delta_i - sum_j D_ij(t) F_j,
/// so the forces F solve a system of equations. F is the elastic force alone: dampers of the meshes act on the approach
/// rate of the rigid bodies as without coupling and do not deflect the common body.
///
/// 1/k + D of the meshes in contact must be positive definite; 1/k contains the compliance of the body under the mesh
/// itself. Newton's method finds the forces to 1e-13. Where it fails they are NaN, which integrators report.
struct MeshCoupling {
  std::vector<int> meshes;  ///< in the order of add_mesh; at most 20
  /// D, m/N, over the cycles of the first mesh: the lower triangle row by row ((0,0), (1,0), (1,1), (2,0) ...).
  std::vector<PeriodicCurve> compliance;
  /// An elastic mode of the common body that is a DOF of the system and contributes its compliance itself. Its static
  /// compliance factor_i factor_j / stiffness is therefore subtracted from D; the factors are the moving shares of the
  /// meshes in the DOF.
  struct RetainedMode {
    int dof = 0;
    double stiffness = 0;  ///< N/m
  };
  std::vector<RetainedMode> retained;
  std::string body = "common_body";  ///< its strain energy is reported under this name
};

/// The curves of MeshCoupling::compliance from symmetric matrices (m/N), `per_cycle` of them per mesh cycle. Throws
/// InputError without a matrix.
[[nodiscard]] std::vector<PeriodicCurve> compliance_curves(const std::vector<Eigen::MatrixXd>& matrices, int per_cycle);

/// Meshes that are the components of a motion, in a bearing say: their elastic forces are those of a law of all of
/// them. The stiffness of the meshes is that of small motions about the nominal load; their dampers act as in any mesh.
struct LawElement {
  std::vector<int> meshes;  ///< in the order of add_mesh; without backlash and coupling
  std::shared_ptr<const ForceLaw> law;
};

/// A mesh along its face, as two meshes: the approach in the middle of the face, with the excitation, the errors and
/// the damping of the whole mesh, and its tilt, by which the flanks approach further at the end of the face. The law of
/// the whole mesh is spread over places on the face: with the approach a less the errors and the tilt d,
///
///   F = sum w_i f(a + z_i d - g_i),   F_tilt = sum w_i z_i f(a + z_i d - g_i),
///
/// z_i from -1 to 1, f the force beyond the backlash. Each place has contact of its own, which no integrator looks for:
/// both elastic forces are continuous. The dampers act on the whole face while any part of it touches. The excitation
/// of the tilt is that of small motions while the whole face carries.
struct FaceElement {
  int approach = 0, tilt = 0;           ///< in the order of add_mesh; without backlash of their own
  std::optional<double> half_backlash;  ///< m; absent: the flanks pull as well
  struct Place {
    double z = 0, weight = 0;  ///< the weights add up to 1
    double gap = 0;            ///< m, of the driving flanks
  };
  std::vector<Place> places;
  /// What changes over the phase of the approach, as in FaceShape: weights by 1 + slope z + curvature P(z), gaps by
  /// gap_slope (z - slope / 3), along the line of action.
  struct Course {
    PeriodicCurve slope, curvature, gap_slope;
  };
  std::optional<Course> course{};
};

/// A spring with its damper along a coordinate a: force k a^T q + c a^T q', part of K and C. The name states the
/// machine part (sun_support_x, planet1_bearing_radial, ...); energies and bearing forces are reported under it.
struct SpringElement {
  std::string name;
  LinearForm a;
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
};

/// What a constant load follows when speed and torque change: nothing, the torque, or the square of the speed. Losses
/// are what friction takes from driven bodies (with_balanced_friction); they follow the torque.
enum class LoadCause { none, torque, rotation, losses };

/// Loads that change in time with one rate: cosine x cos(rate t) + sine x sin(rate t).
struct HarmonicLoad {
  double rate = 0;               ///< rad/s, not 0
  Eigen::VectorXd cosine, sine;  ///< N, one per DOF
};

/// M q'' + (C + G) q' + (K + K_Omega) q + sum_m (b_m F_m + g_m |F_m|) = f(t), immutable; g_m contains the friction of
/// the mesh. Built by LumpedSystemBuilder.
class LumpedSystem {
 public:
  /// Contact state of a mesh, held between the events that the integrator finds.
  enum class Contact : signed char { back = -1, open = 0, drive = 1 };
  enum class ContactStates {
    held,      ///< as in the workspace
    following  ///< set from the deflections
  };

  /// Scratch memory and discrete state of one evaluation thread. Make one per thread with `workspace()`.
  struct Workspace {
    double time = 0;
    double pace = 1;     ///< rate of the time of excitations, where that is a nominal one (Pacing)
    double sliding = 1;  ///< factor of friction
    bool excitation_valid = false;
    /// One entry per mesh at `time`. Where a law replaces the stiffness, `stiffness` is its secant at the nominal load.
    std::vector<double> stiffness, error, error_rate;  // rates over the time of the excitations
    std::vector<PhaseLocation> location;               ///< per mesh at `time`, on the grid of its law
    std::vector<double> delta, delta_rate, force;      ///< per mesh, of the last evaluation
    std::vector<double> elastic;                       ///< per mesh, force without damping of the last evaluation
    std::vector<double> damping;                       ///< per mesh, dF/d delta' of the last evaluation, N s/m
    std::vector<double> tangent;                       ///< per mesh, dF/d delta of the last evaluation, N/m
    std::vector<double> law;                           ///< scratch of one law: deflections, forces
    std::vector<double> law_tangent;                   ///< per law, d elastic / d delta of its meshes, N/m
    std::vector<double> across_face;  ///< per face, d elastic of the tilt / d delta of the approach, N/m
    /// Per face at `time`: slope, curvature, gap_slope of its course, then their rates, 1/s and m/s.
    std::vector<std::array<double, 6>> face_shape;
    std::vector<Contact> contact;  ///< per mesh
    /// Per mesh: value of a rectangular wave (1 high, 0 low) held up to the next jump; -1: from the time.
    std::vector<signed char> wave;
    std::vector<double> factor, factor_rate;  ///< of the moving shares of all meshes at `time`
    std::vector<double> friction;             ///< curves of the friction shares of all meshes at `time`
    std::vector<double> approach;             ///< per mesh, approach b^T q - e of the last evaluation
    std::vector<double> compliance;           ///< D of all couplings at `time`
    std::vector<double> sine, cosine;         ///< of the error rates and mesh frequencies at `time`
    std::vector<double> pairs;                ///< scratch: (q_j, v_j) of every DOF, then the mesh forces
  };

  [[nodiscard]] int dofs() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Index of a DOF, -1 when it does not exist (fixed).
  [[nodiscard]] int find(const std::string& name) const;
  [[nodiscard]] const std::vector<MeshElement>& meshes() const { return meshes_; }
  [[nodiscard]] const std::vector<SpringElement>& springs() const { return springs_; }  ///< those that are not all zero
  [[nodiscard]] const Eigen::MatrixXd& mass() const { return mass_; }
  [[nodiscard]] const Eigen::MatrixXd& stiffness() const { return stiffness_; }  ///< K, symmetric, without meshes
  /// K_Omega: centripetal (symmetric) and circulatory (dampers to the housing, skew) terms.
  [[nodiscard]] const Eigen::MatrixXd& rotating_stiffness() const { return rotating_stiffness_; }
  [[nodiscard]] const Eigen::MatrixXd& damping() const { return damping_; }        ///< C, symmetric, without meshes
  [[nodiscard]] const Eigen::MatrixXd& gyroscopic() const { return gyroscopic_; }  ///< G, skew
  [[nodiscard]] const Eigen::VectorXd& load() const { return load_; }              ///< N, the constant part of f
  [[nodiscard]] const Eigen::VectorXd& load(LoadCause cause) const {               ///< N, its part that has this cause
    return load_by_cause_[static_cast<std::size_t>(cause)];
  }
  [[nodiscard]] const std::vector<HarmonicLoad>& harmonic_loads() const { return harmonic_loads_; }  ///< each rate once
  [[nodiscard]] Eigen::VectorXd load_at(double t) const;                                             ///< f, N
  [[nodiscard]] Eigen::VectorXd mesh_vector(int mesh, double t = 0) const;   ///< b at a time, dense
  [[nodiscard]] Eigen::VectorXd mesh_vector_rate(int mesh, double t) const;  ///< db/dt, 1/s
  [[nodiscard]] Eigen::MatrixXd mesh_vectors(double t = 0) const;            ///< all b, DOFs x meshes
  [[nodiscard]] Eigen::MatrixXd damping_with_meshes() const;                 ///< C + sum c b b^T, b at time 0
  [[nodiscard]] bool has_moving_vectors() const;                             ///< does any b change in time?
  [[nodiscard]] bool has_friction() const;
  /// -sum g |F| of the last evaluation, N, one per DOF.
  [[nodiscard]] Eigen::VectorXd friction_force(const Workspace& workspace) const;
  /// Do the directions of all mesh forces stay as they are? Solutions without time integration need that.
  [[nodiscard]] bool has_fixed_directions() const { return !has_moving_vectors() && !has_friction(); }
  [[nodiscard]] const std::vector<MeshCoupling>& couplings() const { return couplings_; }
  [[nodiscard]] const std::vector<LawElement>& laws() const { return laws_; }
  [[nodiscard]] const std::vector<FaceElement>& faces() const { return faces_; }
  [[nodiscard]] bool is_whole_mesh(int mesh) const;  ///< neither a component of a law nor the tilt of a mesh
  [[nodiscard]] bool is_gear_mesh(int mesh) const;   ///< whole, and no shaft
  /// Whether the force of some mesh depends on the deflection of another.
  [[nodiscard]] bool has_coupled_meshes() const { return !couplings_.empty() || !laws_.empty() || !faces_.empty(); }

  [[nodiscard]] Workspace workspace() const;
  /// Sets the contact states from the deflections at (t, q).
  void detect_contact(double t, const double* q, Workspace& workspace) const;
  /// Stiffness, error and error rate of every mesh at time t.
  void evaluate_excitation(double t, Workspace& workspace) const;
  /// delta, delta' and F of every mesh in its held contact state at time t (s), q (m) and v (m/s) one per DOF. No
  /// allocation, but by laws of bearings.
  void evaluate_meshes(double t, const double* q, const double* v, Workspace& workspace) const;
  /// The same from the approaches b^T q (m) and their rates (m/s), one per mesh, from which the errors are not yet
  /// subtracted. The contact states follow the deflections. No allocation.
  void evaluate_forces(double t, const double* approach, const double* approach_rate, Workspace& workspace) const;
  /// Does the elastic force of the last evaluation lie outside the loads of the table? -1: in contact below the lowest
  /// load, +1: above the largest, 0: inside, out of contact, or not a law from a table.
  [[nodiscard]] int outside_table(int mesh, const Workspace& workspace) const;
  /// d elastic / d approach (N/m) of the last evaluation, meshes x meshes, symmetric; diagonal without coupled meshes.
  void tangent_matrix(const Workspace& workspace, Eigen::Ref<Eigen::MatrixXd> result) const;
  /// Right-hand side for the state y = (q, v) with 2 x DOFs entries: dy = (v, M^-1 (...)). No allocation.
  void rhs(double t, const double* y, double* dy, Workspace& workspace) const;
  /// d(dy)/dy in the held contact state, column-major, 2 DOFs x 2 DOFs.
  void jacobian(double t, const double* y, Eigen::Ref<Eigen::MatrixXd> result, Workspace& workspace) const;

  /// Kinetic + elastic energy (J), including the centripetal potential. Evaluates the meshes.
  [[nodiscard]] double energy(double t, const double* y, Workspace& workspace) const;
  /// Power (W) supplied by loads, errors and stiffness change and dissipated by dampers, at the last rhs evaluation.
  struct Power {
    double supplied = 0, dissipated = 0;
  };
  [[nodiscard]] Power power(double t, const double* y, const Workspace& workspace) const;

  /// Time (s) of the next jump of a rectangular stiffness strictly after t, or infinity; where the time runs backwards
  /// (`direction` -1) strictly before t, or minus infinity.
  [[nodiscard]] double next_jump(double t, int direction = 1) const;
  /// Holds the rectangular waves at their values at time t: the middle of an interval without jumps.
  void hold_waves(double t, Workspace& workspace) const;

 private:
  friend class LumpedSystemBuilder;
  friend class LumpedSystemCompiler;
  struct Compiled;  // flat arrays for the right-hand side, shared by copies
  void apply_forces(Workspace& workspace, ContactStates states) const;
  std::vector<std::string> names_;
  std::vector<MeshElement> meshes_;
  std::vector<MeshCoupling> couplings_;
  std::vector<LawElement> laws_;
  std::vector<FaceElement> faces_;
  std::vector<SpringElement> springs_;
  Eigen::MatrixXd mass_, stiffness_, rotating_stiffness_, damping_, gyroscopic_;
  Eigen::VectorXd load_;
  std::array<Eigen::VectorXd, 4> load_by_cause_;
  Eigen::MatrixXd neutral_;
  std::vector<HarmonicLoad> harmonic_loads_;
  std::shared_ptr<const Compiled> compiled_;
};

/// Collects bodies, supports, couplings and meshes of any system.
class LumpedSystemBuilder {
 public:
  /// Adds a system as it is: its DOFs and meshes stand behind those that are there, with `prefix` in front of all
  /// names. What balances its friction is left out.
  void add(const LumpedSystem& system, const std::string& prefix = {});
  /// Adds a DOF; its form is {{index, 1}}.
  LinearForm add_dof(const std::string& name);
  /// Adds mass (kg, or inertia / radius^2) to the coordinate: M += m a a^T.
  void add_mass(const LinearForm& coordinate, double mass);
  /// Adds a plane body (kg) in a frame that turns with `speed` (rad/s): -2 m Omega y', +2 m Omega x' and
  /// -m Omega^2 (x, y).
  void add_rotating_mass(const LinearForm& x, const LinearForm& y, double mass, double speed);
  /// Adds the tilts (rad) of a round body in that frame, with its inertia (kg m^2) across and about its axis, about
  /// which it turns with `spin` (rad/s, absolute): M, the gyroscopic moments (I_p spin - 2 I_t speed) phi' and
  /// speed (I_p spin - I_t speed) phi.
  void add_tilting_mass(const LinearForm& about_x, const LinearForm& about_y, double across, double about_axis,
                        double spin, double speed);
  /// Adds a symmetric term (N/m) of the potential: K_Omega += value (a b^T + b a^T)/2.
  void add_rotating_stiffness(const LinearForm& a, const LinearForm& b, double value);
  /// Adds a spring (N/m) and a damper (N s/m) along a coordinate: K += k a a^T, C += c a a^T.
  void add_spring(const LinearForm& coordinate, double stiffness, double damping, const std::string& name = {});
  /// Adds damping (N s/m): C += value row column^T. The sum has to be symmetric.
  void add_damping(const LinearForm& row, const LinearForm& column, double value);
  /// Gives a mesh that was added before other errors.
  void set_errors(int mesh, std::vector<HarmonicError> errors);
  /// Makes the damper of a mesh that was added before stronger, by N s/m.
  void add_mesh_damping(int mesh, double damping);
  /// Adds a force (N/m x `column`) on `row`: K_Omega += value row column^T.
  void add_circulatory(const LinearForm& row, const LinearForm& column, double value);
  /// Adds the Omega part of a damper (N s/m) to the housing in the turning frame: c (x' - Omega y), c (y' + Omega x).
  void add_housing_damper_rotation(const LinearForm& x, const LinearForm& y, double damping, double speed);
  void add_load(const LinearForm& coordinate, double force, LoadCause cause = LoadCause::none);
  /// Adds cosine x cos(rate t) + sine x sin(rate t), N.
  void add_harmonic_load(const LinearForm& coordinate, double rate, double cosine, double sine);
  int add_mesh(MeshElement mesh);  ///< its number
  /// Adds inertia (kg) between two coordinates: M += value (a b^T + b a^T).
  void add_mass_coupling(const LinearForm& a, const LinearForm& b, double value);
  /// Couples meshes that were added before. A mesh belongs to one coupling at most.
  void add_mesh_coupling(MeshCoupling coupling);
  /// Makes meshes that were added before the components of a law.
  void add_law(LawElement law);
  /// Spreads a mesh that was added before over its face; it may be part of a coupling.
  void add_face(FaceElement face);
  /// Keeps friction from doing work on motions nu (DOFs x motions, nu^T M nu = 1): g becomes (1 - M nu nu^T) g.
  void keep_friction_from(Eigen::MatrixXd motions);
  /// Throws InputError when a DOF has no mass or a coupling, law, face or moving share does not fit its meshes and
  /// DOFs.
  [[nodiscard]] LumpedSystem build() const;

 private:
  void assemble_matrices(LumpedSystem& system) const;
  static void check_mass(const LumpedSystem& system);

  std::vector<std::string> names_;
  std::vector<MeshElement> meshes_;
  std::vector<MeshCoupling> couplings_;
  std::vector<LawElement> laws_;
  std::vector<FaceElement> faces_;
  std::vector<SpringElement> springs_;
  struct Term {
    LinearForm row, column;
    double value;
  };
  std::vector<Term> mass_, stiffness_, rotating_stiffness_, damping_, gyroscopic_;
  struct Load {
    LinearForm coordinate;
    double force;
    LoadCause cause;
  };
  std::vector<Load> load_;
  struct HarmonicTerm {
    LinearForm coordinate;
    double rate, cosine, sine;
  };
  std::vector<HarmonicTerm> harmonic_load_;
  Eigen::MatrixXd neutral_;
};

}  // namespace annulus::dynamics
