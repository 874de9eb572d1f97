#include "dynamics/lumped_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/lumped_system_compiled.h"

namespace annulus::dynamics {

namespace {

double dot(const FlatRows& rows, std::size_t row, const double* x) {
  double sum = 0;
  for (int i = rows.start[row]; i < rows.start[row + 1]; ++i) sum += rows.factor[i] * x[rows.index[i]];
  return sum;
}

/// Is the rectangular wave high at this phase (mesh cycles)?
bool wave_is_high(const CompiledMesh& mesh, double t) {
  const double phase = mesh.frequency * t + mesh.phase_offset;
  return phase - std::floor(phase) < mesh.duty;
}

/// g(delta) in a held contact state.
double penetration(const CompiledMesh& mesh, LumpedSystem::Contact contact, double delta) {
  if (mesh.linear) return delta;
  return contact == LumpedSystem::Contact::open ? 0.0 : delta - static_cast<int>(contact) * mesh.half_backlash;
}

LumpedSystem::Contact contact_of(const CompiledMesh& mesh, double delta) {
  if (mesh.linear || delta > mesh.half_backlash) return LumpedSystem::Contact::drive;
  return delta < -mesh.half_backlash ? LumpedSystem::Contact::back : LumpedSystem::Contact::open;
}

double acting_damping(const CompiledMesh& mesh, LumpedSystem::Contact contact) {
  return contact != LumpedSystem::Contact::open || mesh.damping_without_contact ? mesh.damping : 0.0;
}

/// Force and tangent from the deflection, its rate and the contact state in the workspace.
void apply_force(const CompiledMesh& mesh, std::size_t m, LumpedSystem::Workspace& w) {
  w.force[m] = w.stiffness[m] * penetration(mesh, w.contact[m], w.delta[m]) +
               acting_damping(mesh, w.contact[m]) * w.delta_rate[m];
  w.tangent[m] = mesh.linear || w.contact[m] != LumpedSystem::Contact::open ? w.stiffness[m] : 0.0;
}

double stiffness_rate(const CompiledMesh& mesh, double t, const std::vector<double>& rates,
                      const LumpedSystem::Workspace& w) {
  if (mesh.kind == CompiledMesh::Kind::harmonic)
    return rates[mesh.ripple.slot] *
           (mesh.ripple.sine * w.cosine[mesh.ripple.slot] - mesh.ripple.cosine * w.sine[mesh.ripple.slot]);
  if (mesh.kind == CompiledMesh::Kind::table)
    return mesh.frequency * mesh.secant.derivative(mesh.frequency * t + mesh.phase_offset);
  return 0;  // the jumps of a wave are booked where they happen
}

}  // namespace

int LumpedSystem::find(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

Eigen::VectorXd LumpedSystem::mesh_vector(int mesh) const {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(freedoms());
  for (const auto& [index, factor] : meshes_[mesh].b) b[index] += factor;
  return b;
}

LumpedSystem::Workspace LumpedSystem::workspace() const {
  Workspace w;
  for (auto* list : {&w.stiffness, &w.error, &w.error_rate, &w.delta, &w.delta_rate, &w.force, &w.tangent})
    list->assign(meshes_.size(), 0.0);
  w.contact.assign(meshes_.size(), Contact::drive);
  w.wave.assign(meshes_.size(), -1);
  w.sine.assign(compiled_->rates.size(), 0.0);
  w.cosine = w.sine;
  return w;
}

void LumpedSystem::evaluate_excitation(double t, Workspace& w) const {
  // Newton iterations and last stages ask for the same time again.
  if (w.excitation_valid && w.time == t) return;
  const Compiled& c = *compiled_;
  for (std::size_t i = 0; i < c.rates.size(); ++i) {
    w.sine[i] = std::sin(c.rates[i] * t);
    w.cosine[i] = std::cos(c.rates[i] * t);
  }
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    const CompiledMesh& mesh = c.meshes[m];
    double e = mesh.constant_error, rate = 0;
    for (const auto& term : mesh.errors) {
      e += term.sine * w.sine[term.slot] + term.cosine * w.cosine[term.slot];
      rate += c.rates[term.slot] * (term.sine * w.cosine[term.slot] - term.cosine * w.sine[term.slot]);
    }
    switch (mesh.kind) {
      case CompiledMesh::Kind::constant:
        w.stiffness[m] = mesh.mean;
        break;
      case CompiledMesh::Kind::harmonic:
        w.stiffness[m] =
            mesh.mean + mesh.ripple.sine * w.sine[mesh.ripple.slot] + mesh.ripple.cosine * w.cosine[mesh.ripple.slot];
        break;
      case CompiledMesh::Kind::wave: {
        const bool high = w.wave[m] < 0 ? wave_is_high(mesh, t) : w.wave[m] == 1;
        w.stiffness[m] = high ? mesh.high : mesh.low;
        break;
      }
      case CompiledMesh::Kind::table: {
        const double cycles = mesh.frequency * t + mesh.phase_offset;
        w.stiffness[m] = mesh.secant(cycles);
        e += mesh.unloaded_te(cycles);
        rate += mesh.frequency * mesh.unloaded_te.derivative(cycles);
        break;
      }
    }
    w.error[m] = e;
    w.error_rate[m] = rate;
  }
  w.time = t;
  w.excitation_valid = true;
}

void LumpedSystem::detect_contact(double t, const double* q, Workspace& w) const {
  evaluate_excitation(t, w);
  for (std::size_t m = 0; m < compiled_->meshes.size(); ++m) {
    const CompiledMesh& mesh = compiled_->meshes[m];
    w.delta[m] = dot(compiled_->b, m, q) - w.error[m];
    w.contact[m] = contact_of(mesh, w.delta[m]);
  }
}

void LumpedSystem::evaluate_meshes(double t, const double* q, const double* v, Workspace& w) const {
  evaluate_excitation(t, w);
  const Compiled& c = *compiled_;
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    double delta = -w.error[m], rate = -w.error_rate[m];
    for (int i = c.b.start[m]; i < c.b.start[m + 1]; ++i) {
      delta += c.b.factor[i] * q[c.b.index[i]];
      rate += c.b.factor[i] * v[c.b.index[i]];
    }
    w.delta[m] = delta;
    w.delta_rate[m] = rate;
    apply_force(c.meshes[m], m, w);
  }
}

void LumpedSystem::evaluate_forces(double t, const double* closing, const double* closing_rate, Workspace& w) const {
  evaluate_excitation(t, w);
  for (std::size_t m = 0; m < compiled_->meshes.size(); ++m) {
    const CompiledMesh& mesh = compiled_->meshes[m];
    w.delta[m] = closing[m] - w.error[m];
    w.delta_rate[m] = closing_rate[m] - w.error_rate[m];
    w.contact[m] = contact_of(mesh, w.delta[m]);
    apply_force(mesh, m, w);
  }
}

void LumpedSystem::rhs(double t, const double* y, double* dy, Workspace& w) const {
  const Compiled& c = *compiled_;
  const int n = freedoms();
  const double* q = y;
  const double* v = y + n;
  evaluate_meshes(t, q, v, w);
  for (int i = 0; i < n; ++i) {
    double a = c.acceleration[i];
    for (int j = c.row_start[i]; j < c.row_start[i + 1]; ++j)
      a -= c.stiffness[j] * q[c.column[j]] + c.damping[j] * v[c.column[j]];
    dy[i] = v[i];
    dy[n + i] = a;
  }
  for (std::size_t m = 0; m < c.meshes.size(); ++m)
    for (int i = c.inverse_b.start[m]; i < c.inverse_b.start[m + 1]; ++i)
      dy[n + c.inverse_b.index[i]] -= c.inverse_b.factor[i] * w.force[m];
}

void LumpedSystem::jacobian(double t, const double* y, Eigen::Ref<Eigen::MatrixXd> result, Workspace& w) const {
  const Compiled& c = *compiled_;
  const int n = freedoms();
  evaluate_meshes(t, y, y + n, w);
  result.setZero();
  for (int i = 0; i < n; ++i) {
    result(i, n + i) = 1;
    for (int j = c.row_start[i]; j < c.row_start[i + 1]; ++j) {
      result(n + i, c.column[j]) = -c.stiffness[j];
      result(n + i, n + c.column[j]) = -c.damping[j];
    }
  }
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    const CompiledMesh& mesh = c.meshes[m];
    const double k = mesh.linear || w.contact[m] != Contact::open ? w.stiffness[m] : 0.0;
    const double d = acting_damping(mesh, w.contact[m]);
    for (int i = c.inverse_b.start[m]; i < c.inverse_b.start[m + 1]; ++i)
      for (int j = c.b.start[m]; j < c.b.start[m + 1]; ++j) {
        const double product = c.inverse_b.factor[i] * c.b.factor[j];
        result(n + c.inverse_b.index[i], c.b.index[j]) -= k * product;
        result(n + c.inverse_b.index[i], n + c.b.index[j]) -= d * product;
      }
  }
}

double LumpedSystem::energy(double t, const double* y, Workspace& w) const {
  const int n = freedoms();
  evaluate_meshes(t, y, y + n, w);
  const Eigen::Map<const Eigen::VectorXd> q(y, n), v(y + n, n);
  double energy = 0.5 * (v.dot(mass_ * v) + q.dot((stiffness_ + rotating_stiffness_) * q));  // skew part drops out
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const double g = penetration(compiled_->meshes[m], w.contact[m], w.delta[m]);
    energy += 0.5 * w.stiffness[m] * g * g;
  }
  return energy;
}

LumpedSystem::Power LumpedSystem::power(double t, const double* y, const Workspace& w) const {
  const int n = freedoms();
  const double* q = y;
  const double* v = y + n;
  // dE/dt = v.f - v.(C v) - v.(K_skew q) - sum c delta'^2 - sum e' F + sum k'/2 g^2
  Power p;
  for (int i = 0; i < n; ++i) p.supplied += load_[i] * v[i];
  for (const auto& term : compiled_->power) {
    p.dissipated += v[term.i] * term.damping * v[term.j];
    p.supplied -= v[term.i] * term.circulatory * q[term.j];
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const CompiledMesh& mesh = compiled_->meshes[m];
    const double g = penetration(mesh, w.contact[m], w.delta[m]);
    p.dissipated += acting_damping(mesh, w.contact[m]) * w.delta_rate[m] * w.delta_rate[m];
    p.supplied += 0.5 * stiffness_rate(mesh, t, compiled_->rates, w) * g * g - w.error_rate[m] * w.force[m];
  }
  return p;
}

double LumpedSystem::next_jump(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& mesh : compiled_->meshes) {
    if (mesh.kind != CompiledMesh::Kind::wave || mesh.frequency == 0) continue;
    // A billionth of a cycle ahead: the jump just reached is not found again, and jumps of several meshes that differ
    // by rounding only are one.
    const double phase = mesh.frequency * t + mesh.phase_offset + 1e-9;
    const double start = std::floor(phase);
    const double jump = phase < start + mesh.duty ? start + mesh.duty : start + 1;
    next = std::min(next, (jump - mesh.phase_offset) / mesh.frequency);
  }
  return next;
}

void LumpedSystem::hold_waves(double t, Workspace& w) const {
  for (std::size_t m = 0; m < compiled_->meshes.size(); ++m)
    if (compiled_->meshes[m].kind == CompiledMesh::Kind::wave) w.wave[m] = wave_is_high(compiled_->meshes[m], t);
  w.excitation_valid = false;
}

}  // namespace annulus::dynamics
