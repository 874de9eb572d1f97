#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/elastic_law.h"

namespace annulus::dynamics {

/// A rigid body that moves by a small displacement u and a small rotation phi: a point of it at `point` moves by
/// u + phi x (point - reference).
struct RigidBody {
  std::string name;
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< m
  bool moves_in_space = true;                           ///< false: neither along z nor about x and y
};

/// Rigid bodies between elastic elements under constant loads, all in one frame with z along the axis; SI. It finds
/// where they rest: the minimum of a convex potential.
class Mechanism {
 public:
  /// `length`: m, by which rotations are compared with displacements: a radius of the bodies.
  explicit Mechanism(double length);

  int add_body(RigidBody body);  ///< its number
  [[nodiscard]] int bodies() const { return static_cast<int>(bodies_.size()); }
  [[nodiscard]] const RigidBody& body(int number) const { return bodies_.at(static_cast<std::size_t>(number)); }
  static constexpr int ground = -1;  ///< stands still

  /// A linear measure of the motions of all bodies: one value for each x, y, z (per m), phi_x, phi_y, phi_z (per rad)
  /// of body 0, 1, ...
  using Measure = Eigen::RowVectorXd;
  /// Displacement of a point of `body` along `direction` against `from`. Points and directions are 3-vectors.
  [[nodiscard]] Measure displacement(int body, int from, const Eigen::Vector3d& point,
                                     const Eigen::Vector3d& direction) const;
  [[nodiscard]] Measure rotation(int body, int from, const Eigen::Vector3d& direction) const;

  /// An element whose deflections are `measures` (coordinates x 6 bodies) times the motion, less `offset`. Its number.
  int add_element(std::string name, Eigen::MatrixXd measures, std::shared_ptr<const ElasticLaw> law,
                  Eigen::VectorXd offset);
  /// Keeps a measure at zero. Its number. `name` is for messages: "the axial position of the sun".
  int hold(std::string name, const Measure& measure);
  /// Force (N) at a point and moment (N m) on a body.
  void add_load(int body, const Eigen::Vector3d& point, const Eigen::Vector3d& force, const Eigen::Vector3d& moment);

  /// Deflections of an element (number) under motions (6 per body).
  [[nodiscard]] Eigen::VectorXd deflection(int element, const Eigen::VectorXd& motion) const;

  struct Equilibrium {
    Eigen::VectorXd motion;                   ///< m, rad: 6 per body
    std::vector<Eigen::VectorXd> deflection;  ///< per element
    std::vector<ElasticLaw::State> state;     ///< per element
    Eigen::VectorXd holding;                  ///< N, N m: per hold, on what its measure displaces; resists it
    double residual_relative = 0;             ///< of the largest force
    int iterations = 0;
  };
  /// What solve() refuses before it looks for an equilibrium: throws InputError, naming the motion, where a body can
  /// move and nothing resists, or two holds do the same.
  void check() const;
  /// Newton's method with a search along each step, from the motion `start` where it is given. Throws what
  /// check() throws, and SolverError where no equilibrium is found. Also refuses motions of a tenth of `length` and
  /// more, for which nothing but the rest of bearings in their play is there.
  [[nodiscard]] Equilibrium solve(const Eigen::VectorXd& start = {}) const;

 private:
  struct Element {
    std::string name;
    Eigen::MatrixXd measures;
    std::shared_ptr<const ElasticLaw> law;
    Eigen::VectorXd offset;
  };
  class Solver;
  [[nodiscard]] Eigen::Index size() const { return 6 * std::ssize(bodies_); }

  double length_;
  std::vector<RigidBody> bodies_;
  std::vector<Element> elements_;
  std::vector<std::string> hold_names_;
  std::vector<Measure> holds_;
  Eigen::VectorXd load_;
};

}  // namespace annulus::dynamics
