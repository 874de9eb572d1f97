#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/lumped_system_compiled.h"

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

void LumpedSystemBuilder::add_housing_damper_rotation(const LinearForm& x, const LinearForm& y, double damping,
                                                      double speed) {
  rotating_stiffness_.push_back({x, y, -damping * speed});
  rotating_stiffness_.push_back({y, x, damping * speed});
}

void LumpedSystemBuilder::add_load(const LinearForm& coordinate, double force) {
  load_.emplace_back(coordinate, force);
}

void LumpedSystemBuilder::add_mesh(MeshElement mesh) { meshes_.push_back(std::move(mesh)); }

void LumpedSystemBuilder::add_mass_coupling(const LinearForm& a, const LinearForm& b, double value) {
  mass_.push_back({a, b, value});
  mass_.push_back({b, a, value});
}

void LumpedSystemBuilder::add_mesh_coupling(MeshCoupling coupling) { couplings_.push_back(std::move(coupling)); }

namespace {

template <class Terms>
Eigen::MatrixXd assembled(const Terms& terms, int n) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (const auto& term : terms)
    for (const auto& [i, a] : term.row)
      for (const auto& [j, b] : term.column) matrix(i, j) += term.value * (a * b);  // so that symmetry is exact
  return matrix;
}

/// Index of `rate` in the list, appended when new.
std::size_t slot_of(std::vector<double>& rates, double rate) {
  const auto found = std::find(rates.begin(), rates.end(), rate);
  if (found != rates.end()) return static_cast<std::size_t>(found - rates.begin());
  rates.push_back(rate);
  return rates.size() - 1;
}

/// What a solve with a non-diagonal mass matrix leaves of a zero that cancelled: less than this share of its terms.
constexpr double cancelled = 1e-15;

/// `terms`: bounds of the entries' terms.
void append_sparse(const Eigen::VectorXd& dense, const Eigen::VectorXd& terms, FlatRows& rows) {
  for (int i = 0; i < dense.size(); ++i)
    if (std::abs(dense[i]) > cancelled * terms[i]) {
      rows.index.push_back(i);
      rows.factor.push_back(dense[i]);
    }
  rows.start.push_back(static_cast<int>(rows.index.size()));
}

const CurveBundle* shared_bundle(std::vector<std::unique_ptr<const CurveBundle>>& bundles, CurveBundle bundle) {
  for (const auto& known : bundles)
    if (known->same_as(bundle)) return known.get();
  return bundles.emplace_back(std::make_unique<const CurveBundle>(std::move(bundle))).get();
}

/// Joins M^-1 (K, C) and M^-1 b to the rows of pairs.
template <class Compiled>
void compile_rows(Compiled& c, int n) {
  const int meshes = static_cast<int>(c.meshes.size());
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(n, meshes + meshes % 2);
  for (int m = 0; m < meshes; ++m)
    for (int i = c.inverse_b.start[m]; i < c.inverse_b.start[m + 1]; ++i)
      forces(c.inverse_b.index[i], m) = c.inverse_b.factor[i];
  const int moving = static_cast<int>(c.moving_dofs.size());
  const auto add = [&](int column, double first, double second) {
    if (first == 0 && second == 0) return;
    c.pair_column.push_back(column);
    c.pair_factor.push_back(first);
    c.pair_factor.push_back(second);
  };
  c.pair_start.push_back(0);
  for (int i = 0; i < n; ++i) {
    for (int j = c.row_start[i]; j < c.row_start[i + 1]; ++j) add(c.column[j], c.stiffness[j], c.damping[j]);
    for (int m = 0; m < meshes; m += 2) add(n + m / 2, forces(i, m), forces(i, m + 1));
    for (int k = 0; k < moving; k += 2)
      add(n + static_cast<int>(forces.cols() / 2) + k / 2, c.inverse_moving(i, k),
          k + 1 < moving ? c.inverse_moving(i, k + 1) : 0.0);
    c.pair_start.push_back(static_cast<int>(c.pair_column.size()));
  }
}

template <class Compiled>
void compile_moving(Compiled& c, const std::vector<MeshElement>& meshes, int n) {
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const MeshElement& mesh = meshes[m];
    c.meshes[m].first_moving = static_cast<int>(c.moving.size());
    for (const auto& share : mesh.moving) {
      if (share.dof < 0 || share.dof >= n)
        throw InputError(fmt::format("mesh {}: a moving share of a degree of freedom that does not exist", mesh.name));
      auto& compiled = c.moving.emplace_back();
      compiled.dof = share.dof;
      const auto known = std::find(c.moving_dofs.begin(), c.moving_dofs.end(), share.dof);
      compiled.slot = static_cast<int>(known - c.moving_dofs.begin());
      if (known == c.moving_dofs.end()) c.moving_dofs.push_back(share.dof);
      compiled.frequency = mesh.frequency;
      compiled.phase_offset = mesh.phase_offset;
      const auto& wave = share.wave;
      compiled.waves = wave.amount != 0 && wave.rate != 0;
      if (compiled.waves)
        compiled.wave = {slot_of(c.rates, wave.rate), wave.amount * std::cos(wave.phase),
                         wave.amount * std::sin(wave.phase)};
      else
        compiled.constant = wave.amount * std::sin(wave.phase);
      if (!(share.curve == PeriodicCurve())) compiled.curve = shared_bundle(c.bundles, CurveBundle({&share.curve}));
    }
    c.meshes[m].last_moving = static_cast<int>(c.moving.size());
  }
}

template <class Compiled>
void compile_coupling(Compiled& c, const std::vector<MeshElement>& meshes, const MeshCoupling& coupling, int n) {
  const auto size = static_cast<int>(coupling.meshes.size());
  if (size < 1 || size > largest_coupling)
    throw InputError(fmt::format("a mesh coupling joins 1 to {} meshes, not {}", largest_coupling, size));
  if (static_cast<int>(coupling.compliance.size()) != size * (size + 1) / 2)
    throw InputError(fmt::format("a coupling of {} meshes needs {} compliances, not {}", size, size * (size + 1) / 2,
                                 coupling.compliance.size()));
  CompiledCoupling compiled;
  for (const int m : coupling.meshes) {
    if (m < 0 || m >= static_cast<int>(meshes.size()) || c.meshes[m].coupled)
      throw InputError(fmt::format("a mesh coupling names mesh {}, which does not exist or is coupled already", m));
    c.meshes[m].coupled = true;
  }
  compiled.meshes = coupling.meshes;
  compiled.frequency = meshes[coupling.meshes.front()].frequency;
  compiled.phase_offset = meshes[coupling.meshes.front()].phase_offset;
  std::vector<const PeriodicCurve*> curves;
  for (const auto& curve : coupling.compliance) curves.push_back(&curve);
  compiled.compliance = CurveBundle(curves);
  for (const auto& other : c.couplings) compiled.offset += static_cast<int>(other.meshes.size() * other.meshes.size());
  for (const auto& kept : coupling.kept) {
    if (kept.dof < 0 || kept.dof >= n || !(kept.stiffness > 0))
      throw InputError("a mode kept in a mesh coupling needs a degree of freedom and a positive stiffness");
    auto& mode = compiled.kept.emplace_back();
    mode.compliance = 1 / kept.stiffness;
    for (const int m : coupling.meshes) {
      int found = -1;
      for (int i = c.meshes[m].first_moving; i < c.meshes[m].last_moving; ++i)
        if (c.moving[i].dof == kept.dof) found = i;
      mode.shares.push_back(found);
    }
  }
  c.couplings.push_back(std::move(compiled));
}

}  // namespace

LumpedSystem LumpedSystemBuilder::build() const {
  const int n = static_cast<int>(names_.size());
  LumpedSystem system;
  system.names_ = names_;
  system.meshes_ = meshes_;
  system.springs_ = springs_;
  system.couplings_ = couplings_;
  system.mass_ = assembled(mass_, n);
  system.stiffness_ = assembled(stiffness_, n);
  system.rotating_stiffness_ = assembled(rotating_stiffness_, n);
  system.damping_ = assembled(damping_, n);
  system.gyroscopic_ = assembled(gyroscopic_, n);
  system.load_ = Eigen::VectorXd::Zero(n);
  for (const auto& [form, force] : load_)
    for (const auto& [i, a] : form) system.load_[i] += a * force;
  for (int i = 0; i < n; ++i)
    if (!(system.mass_(i, i) > 0)) throw InputError(fmt::format("degree of freedom {} has no mass", names_[i]));
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass_);
  if (mass.info() != Eigen::Success) throw InputError("the mass matrix is not positive definite");

  auto compiled = std::make_shared<LumpedSystem::Compiled>();
  auto& c = *compiled;
  c.acceleration = mass.solve(system.load_);
  const Eigen::MatrixXd stiffness = mass.solve(system.stiffness_ + system.rotating_stiffness_);
  const Eigen::MatrixXd damping = mass.solve(system.damping_ + system.gyroscopic_);
  // Entry by entry: a soft support beside a stiff one, a light body beside a heavy one are no rounding.
  const Eigen::MatrixXd inverse = mass.solve(Eigen::MatrixXd::Identity(n, n)).cwiseAbs();
  const Eigen::MatrixXd stiffness_terms = inverse * (system.stiffness_ + system.rotating_stiffness_).cwiseAbs();
  const Eigen::MatrixXd damping_terms = inverse * (system.damping_ + system.gyroscopic_).cwiseAbs();
  c.row_start.push_back(0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      if (std::abs(stiffness(i, j)) > cancelled * stiffness_terms(i, j) ||
          std::abs(damping(i, j)) > cancelled * damping_terms(i, j)) {
        c.column.push_back(j);
        c.stiffness.push_back(stiffness(i, j));
        c.damping.push_back(damping(i, j));
      }
    c.row_start.push_back(static_cast<int>(c.column.size()));
  }

  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double skew = 0.5 * (system.rotating_stiffness_(i, j) - system.rotating_stiffness_(j, i));
      if (system.damping_(i, j) != 0 || skew != 0) c.power.push_back({i, j, system.damping_(i, j), skew});
    }

  // Terms constant in time get no slot; all others share one sine and cosine per distinct rate.
  c.b.start = c.inverse_b.start = {0};
  for (const auto& mesh : meshes_) {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);  // the constant part
    for (const auto& [i, factor] : mesh.b) b[i] += factor;
    append_sparse(b, b.cwiseAbs(), c.b);
    append_sparse(mass.solve(b), inverse * b.cwiseAbs(), c.inverse_b);
    auto& m = c.meshes.emplace_back();
    m.damping = mesh.damping;
    m.damping_without_contact = mesh.damping_without_contact;
    m.half_backlash = mesh.half_backlash.value_or(0.0);
    m.linear = m.half_backlash == 0;  // g(delta) = delta
    m.frequency = mesh.frequency;
    m.phase_offset = mesh.phase_offset;
    m.mean = mean_stiffness(mesh.excitation);
    m.first_error = static_cast<int>(c.errors.size());
    for (const auto& error : mesh.errors) {
      if (error.rate == 0)
        m.constant_error += error.amount * std::sin(error.phase);
      else
        c.errors.push_back(
            {slot_of(c.rates, error.rate), error.amount * std::cos(error.phase), error.amount * std::sin(error.phase)});
    }
    m.last_error = static_cast<int>(c.errors.size());
    if (const auto* harmonic = std::get_if<HarmonicStiffness>(&mesh.excitation)) {
      const double angle = 2 * std::numbers::pi * (mesh.phase_offset - harmonic->phase_shift);
      m.ripple = {slot_of(c.rates, 2 * std::numbers::pi * mesh.frequency),
                  -harmonic->mean * harmonic->ripple * std::sin(angle),
                  harmonic->mean * harmonic->ripple * std::cos(angle)};
      m.kind = CompiledMesh::Kind::harmonic;
    } else if (const auto* wave = std::get_if<RectangularStiffness>(&mesh.excitation)) {
      m.kind = CompiledMesh::Kind::wave;
      m.low = wave->mean * (1 - wave->ripple * wave->duty);
      m.high = m.low + wave->mean * wave->ripple;
      m.duty = wave->duty;
      m.phase_offset -= wave->phase_shift;
    } else if (const auto* table = std::get_if<TableStiffness>(&mesh.excitation)) {
      m.kind = CompiledMesh::Kind::table;
      m.table = shared_bundle(c.bundles, CurveBundle({&table->secant, &table->unloaded_te}));
      m.phase_offset -= table->phase_shift;
      if (table->surface) {
        c.surfaces.push_back(table->surface);
        m.surface = table->surface.get();
      }
    }
  }
  compile_moving(c, meshes_, n);
  c.inverse_moving.resize(n, static_cast<Eigen::Index>(c.moving_dofs.size()));
  for (int k = 0; k < c.inverse_moving.cols(); ++k)
    c.inverse_moving.col(k) = mass.solve(Eigen::VectorXd::Unit(n, c.moving_dofs[k]));
  for (const auto& coupling : couplings_) compile_coupling(c, meshes_, coupling, n);
  compile_rows(c, n);
  system.compiled_ = std::move(compiled);
  return system;
}

}  // namespace annulus::dynamics
