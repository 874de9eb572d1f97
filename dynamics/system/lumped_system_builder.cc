#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/errors.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/lumped_system_compiler.h"

namespace annulus::dynamics {

LinearForm operator+(const LinearForm& a, const LinearForm& b) {
  LinearForm sum = a;
  for (const auto& [index, factor] : b) {
    const auto same = std::find_if(sum.begin(), sum.end(), [i = index](const auto& term) { return term.first == i; });
    if (same == sum.end())
      sum.emplace_back(index, factor);
    else
      same->second += factor;
  }
  return sum;
}

LinearForm operator*(double factor, const LinearForm& a) {
  LinearForm scaled = a;
  for (auto& term : scaled) term.second *= factor;
  return scaled;
}

void LumpedSystemBuilder::add(const LumpedSystem& system, const std::string& prefix) {
  const int dofs = static_cast<int>(names_.size()), meshes = static_cast<int>(meshes_.size());
  const auto moved = [dofs](LinearForm form) {
    for (auto& term : form) term.first += dofs;
    return form;
  };
  for (const auto& name : system.names_) names_.push_back(prefix + name);
  for (auto mesh : system.meshes_) {
    mesh.name = prefix + mesh.name;
    mesh.b = moved(std::move(mesh.b));
    for (auto& share : mesh.moving) share.dof += dofs;
    for (auto& share : mesh.friction) share.along = moved(std::move(share.along));
    meshes_.push_back(std::move(mesh));
  }
  for (auto coupling : system.couplings_) {
    for (int& mesh : coupling.meshes) mesh += meshes;
    for (auto& mode : coupling.retained) mode.dof += dofs;
    coupling.body = prefix + coupling.body;
    couplings_.push_back(std::move(coupling));
  }
  for (auto element : system.laws_) {
    for (int& mesh : element.meshes) mesh += meshes;
    laws_.push_back(std::move(element));
  }
  for (auto face : system.faces_) {
    face.approach += meshes;
    face.tilt += meshes;
    faces_.push_back(std::move(face));
  }
  for (auto spring : system.springs_) {
    spring.name = prefix + spring.name;
    spring.a = moved(std::move(spring.a));
    springs_.push_back(std::move(spring));
  }
  for (const auto& [matrix, terms] : {std::pair{&system.mass_, &mass_},
                                      {&system.stiffness_, &stiffness_},
                                      {&system.rotating_stiffness_, &rotating_stiffness_},
                                      {&system.damping_, &damping_},
                                      {&system.gyroscopic_, &gyroscopic_}})
    for (Eigen::Index i = 0; i < matrix->rows(); ++i)
      for (Eigen::Index j = 0; j < matrix->cols(); ++j)
        if (const double value = (*matrix)(i, j); value != 0)
          terms->push_back({moved({{static_cast<int>(i), 1.0}}), moved({{static_cast<int>(j), 1.0}}), value});
  for (int i = 0; i < system.dofs(); ++i) {
    for (const auto cause : {LoadCause::none, LoadCause::torque, LoadCause::rotation})
      if (const double force = system.load(cause)[i]; force != 0) add_load(moved({{i, 1.0}}), force, cause);
    for (const auto& load : system.harmonic_loads_)
      add_harmonic_load(moved({{i, 1.0}}), load.rate, load.cosine[i], load.sine[i]);
  }
}

LinearForm LumpedSystemBuilder::add_dof(const std::string& name) {
  names_.push_back(name);
  return {{static_cast<int>(names_.size()) - 1, 1.0}};
}

void LumpedSystemBuilder::add_mass(const LinearForm& coordinate, double mass) {
  mass_.push_back({coordinate, coordinate, mass});
}

void LumpedSystemBuilder::add_rotating_mass(const LinearForm& x, const LinearForm& y, double mass, double speed) {
  add_mass(x, mass);
  add_mass(y, mass);
  gyroscopic_.push_back({x, y, -2 * mass * speed});
  gyroscopic_.push_back({y, x, 2 * mass * speed});
  add_rotating_stiffness(x, x, -mass * speed * speed);
  add_rotating_stiffness(y, y, -mass * speed * speed);
}

void LumpedSystemBuilder::add_tilting_mass(const LinearForm& about_x, const LinearForm& about_y, double across,
                                           double about_axis, double spin, double speed) {
  add_mass(about_x, across);
  add_mass(about_y, across);
  const double momentum = about_axis * spin - 2 * across * speed;
  gyroscopic_.push_back({about_x, about_y, momentum});
  gyroscopic_.push_back({about_y, about_x, -momentum});
  const double centrifugal = speed * (about_axis * spin - across * speed);
  add_rotating_stiffness(about_x, about_x, centrifugal);
  add_rotating_stiffness(about_y, about_y, centrifugal);
}

void LumpedSystemBuilder::add_circulatory(const LinearForm& row, const LinearForm& column, double value) {
  rotating_stiffness_.push_back({row, column, value});
}

void LumpedSystemBuilder::add_rotating_stiffness(const LinearForm& a, const LinearForm& b, double value) {
  rotating_stiffness_.push_back({a, b, value / 2});
  rotating_stiffness_.push_back({b, a, value / 2});
}

void LumpedSystemBuilder::add_spring(const LinearForm& coordinate, double stiffness, double damping,
                                     const std::string& name) {
  if (stiffness != 0 || damping != 0) springs_.push_back({name, coordinate, stiffness, damping});
  stiffness_.push_back({coordinate, coordinate, stiffness});
  damping_.push_back({coordinate, coordinate, damping});
}

void LumpedSystemBuilder::add_damping(const LinearForm& row, const LinearForm& column, double value) {
  damping_.push_back({row, column, value});
}

void LumpedSystemBuilder::set_errors(int mesh, std::vector<HarmonicError> errors) {
  meshes_.at(static_cast<std::size_t>(mesh)).errors = std::move(errors);
}

void LumpedSystemBuilder::add_mesh_damping(int mesh, double damping) {
  meshes_.at(static_cast<std::size_t>(mesh)).damping += damping;
}

void LumpedSystemBuilder::add_housing_damper_rotation(const LinearForm& x, const LinearForm& y, double damping,
                                                      double speed) {
  add_circulatory(x, y, -damping * speed);
  add_circulatory(y, x, damping * speed);
}

void LumpedSystemBuilder::add_load(const LinearForm& coordinate, double force, LoadCause cause) {
  load_.push_back({coordinate, force, cause});
}

void LumpedSystemBuilder::add_harmonic_load(const LinearForm& coordinate, double rate, double cosine, double sine) {
  if (cosine == 0 && sine == 0) return;
  if (rate == 0)
    add_load(coordinate, cosine);
  else
    harmonic_load_.push_back({coordinate, rate, cosine, sine});
}

int LumpedSystemBuilder::add_mesh(MeshElement mesh) {
  meshes_.push_back(std::move(mesh));
  return static_cast<int>(meshes_.size()) - 1;
}

void LumpedSystemBuilder::add_mass_coupling(const LinearForm& a, const LinearForm& b, double value) {
  mass_.push_back({a, b, value});
  mass_.push_back({b, a, value});
}

void LumpedSystemBuilder::add_mesh_coupling(MeshCoupling coupling) { couplings_.push_back(std::move(coupling)); }

void LumpedSystemBuilder::add_law(LawElement law) { laws_.push_back(std::move(law)); }

void LumpedSystemBuilder::add_face(FaceElement face) { faces_.push_back(std::move(face)); }

void LumpedSystemBuilder::keep_friction_from(Eigen::MatrixXd motions) { neutral_ = std::move(motions); }

namespace {

template <class Terms>
Eigen::MatrixXd assembled(const Terms& terms, int n) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (const auto& term : terms)
    for (const auto& [i, a] : term.row)
      for (const auto& [j, b] : term.column) matrix(i, j) += term.value * (a * b);  // so that symmetry is exact
  return matrix;
}

}  // namespace

LumpedSystem LumpedSystemBuilder::build() const {
  LumpedSystem system;
  system.names_ = names_;
  system.meshes_ = meshes_;
  system.springs_ = springs_;
  system.couplings_ = couplings_;
  system.laws_ = laws_;
  system.faces_ = faces_;
  system.neutral_ = neutral_;
  assemble_matrices(system);
  check_mass(system);
  system.compiled_ = LumpedSystemCompiler(system).compile();
  return system;
}

void LumpedSystemBuilder::assemble_matrices(LumpedSystem& system) const {
  const int n = static_cast<int>(names_.size());
  system.mass_ = assembled(mass_, n);
  system.stiffness_ = assembled(stiffness_, n);
  system.rotating_stiffness_ = assembled(rotating_stiffness_, n);
  system.damping_ = assembled(damping_, n);
  system.gyroscopic_ = assembled(gyroscopic_, n);
  system.load_ = Eigen::VectorXd::Zero(n);
  system.load_by_cause_.fill(system.load_);
  for (const auto& load : load_)
    for (const auto& [i, a] : load.coordinate) {
      system.load_[i] += a * load.force;
      system.load_by_cause_[static_cast<std::size_t>(load.cause)][i] += a * load.force;
    }
  for (const auto& term : harmonic_load_) {
    auto& all = system.harmonic_loads_;
    auto of_rate = std::find_if(all.begin(), all.end(), [&](const auto& load) { return load.rate == term.rate; });
    if (of_rate == all.end())
      of_rate = all.insert(all.end(), {term.rate, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)});
    for (const auto& [i, a] : term.coordinate) {
      of_rate->cosine[i] += a * term.cosine;
      of_rate->sine[i] += a * term.sine;
    }
  }
}

void LumpedSystemBuilder::check_mass(const LumpedSystem& system) {
  for (int i = 0; i < system.dofs(); ++i)
    if (!(system.mass_(i, i) > 0))
      throw InputError(fmt::format("degree of freedom {} has a mass of {} kg; it must be positive", system.names_[i],
                                   system.mass_(i, i)));
}

}  // namespace annulus::dynamics
