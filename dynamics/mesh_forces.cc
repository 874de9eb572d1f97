// What every evaluation of the right-hand side runs through: no allocation, no library call besides sine and cosine.
#include <cmath>

#include "dynamics/lumped_system.h"
#include "dynamics/lumped_system_compiled.h"
#include "dynamics/pair.h"

namespace annulus::dynamics {

namespace {

LumpedSystem::Contact contact_of(const CompiledMesh& mesh, double delta) {
  if (mesh.linear || delta > mesh.half_backlash) return LumpedSystem::Contact::drive;
  return delta < -mesh.half_backlash ? LumpedSystem::Contact::back : LumpedSystem::Contact::open;
}

/// Force and tangent from the deflection, its rate and the contact state in the workspace.
void apply_force(const CompiledMesh& mesh, std::size_t m, LumpedSystem::Workspace& w) {
  const auto contact = w.contact[m];
  if (!mesh.linear && contact == LumpedSystem::Contact::open) {
    w.elastic[m] = w.tangent[m] = 0;
  } else {
    const double g = penetration(mesh, contact, w.delta[m]);
    const auto value =
        mesh.surface ? mesh.surface->at(w.place[m], g) : ForceSurface::Value{w.stiffness[m] * g, w.stiffness[m]};
    w.elastic[m] = value.force;
    w.tangent[m] = value.tangent;
  }
  w.force[m] = w.elastic[m] + acting_damping(mesh, contact) * w.delta_rate[m];
}

}  // namespace

bool wave_is_high(const CompiledMesh& mesh, double t) {
  const double phase = mesh.frequency * t + mesh.phase_offset;
  return phase - std::floor(phase) < mesh.duty;
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
    for (int i = mesh.first_error; i < mesh.last_error; ++i) {
      const SlotTerm& term = c.errors[i];
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
        const auto& grid = mesh.table->grid();
        const auto place = grid.locate(cycles);
        const double x = place.local;
        const double* p = mesh.table->piece(place.piece);  // (secant, unloaded transmission error) by power
        const Pair value = pair_at(p) + x * (pair_at(p + 2) + x * (pair_at(p + 4) + x * pair_at(p + 6)));
        w.stiffness[m] = value[0];
        e += value[1];
        rate += mesh.frequency * grid.rate() * (p[3] + x * (2 * p[5] + 3 * x * p[7]));
        if (mesh.surface) w.place[m] = mesh.surface->grid().locate(cycles);
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
  const Compiled& c = *compiled_;
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    double delta = -w.error[m];
    for (int i = c.b.start[m]; i < c.b.start[m + 1]; ++i) delta += c.b.factor[i] * q[c.b.index[i]];
    w.delta[m] = delta;
    w.contact[m] = contact_of(c.meshes[m], delta);
  }
}

void LumpedSystem::evaluate_meshes(double t, const double* q, const double* v, Workspace& w) const {
  evaluate_excitation(t, w);
  const Compiled& c = *compiled_;
  double* pairs = w.pairs.data();
  for (int i = 0; i < freedoms(); ++i) store(Pair{q[i], v[i]}, pairs + 2 * i);
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    Pair delta{-w.error[m], -w.error_rate[m]};
    for (int i = c.b.start[m]; i < c.b.start[m + 1]; ++i) delta += c.b.factor[i] * pair_at(pairs + 2 * c.b.index[i]);
    w.delta[m] = delta[0];
    w.delta_rate[m] = delta[1];
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
  evaluate_meshes(t, y, y + n, w);
  double* pairs = w.pairs.data();
  const std::size_t meshes = c.meshes.size();
  for (std::size_t m = 0; m < meshes; m += 2)
    store(Pair{w.force[m], m + 1 < meshes ? w.force[m + 1] : 0.0}, pairs + 2 * n + m);
  for (int i = 0; i < n; ++i) {
    Pair a{c.acceleration[i], 0.0};
    for (int j = c.pair_start[i]; j < c.pair_start[i + 1]; ++j)
      a -= pair_at(&c.pair_factor[2 * j]) * pair_at(pairs + 2 * c.pair_column[j]);
    dy[i] = y[n + i];
    dy[n + i] = a[0] + a[1];
  }
}

}  // namespace annulus::dynamics
