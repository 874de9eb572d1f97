// The inner part of every right-hand side: no allocation, no library call besides sine and cosine.
#include <algorithm>
#include <cmath>

#include "dynamics/system/lumped_system.h"
#include "dynamics/system/lumped_system_compiled.h"
#include "dynamics/system/two_doubles.h"

namespace annulus::dynamics {

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
    for (int i = mesh.first_tooth; i < mesh.last_tooth; ++i) {
      double value = 0, slope = 0;
      c.tooth_errors[i].curve->evaluate(mesh.frequency * t + c.tooth_errors[i].phase_offset, &value, &slope);
      e += value;
      rate += mesh.frequency * slope;
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
        const auto location = grid.locate(cycles);
        const double x = location.local;
        const double* p = mesh.table->piece(location.piece);  // (secant, unloaded transmission error) by power
        const TwoDoubles value =
            two_doubles_at(p) + x * (two_doubles_at(p + 2) + x * (two_doubles_at(p + 4) + x * two_doubles_at(p + 6)));
        w.stiffness[m] = value[0];
        e += value[1];
        rate += mesh.frequency * grid.rate() * (p[3] + x * (2 * p[5] + 3 * x * p[7]));
        if (mesh.surface) w.location[m] = mesh.surface->grid().locate(cycles);
        break;
      }
    }
    w.error[m] = e;
    w.error_rate[m] = rate;
    if (mesh.face_course) {
      auto& shape = w.face_shape[mesh.face];
      mesh.face_course->evaluate(mesh.frequency * t + mesh.face_phase, shape.data(), shape.data() + 3);
      for (std::size_t i = 3; i < shape.size(); ++i) shape[i] *= mesh.frequency;
    }
  }
  for (std::size_t i = 0; i < c.moving.size(); ++i) {
    const CompiledShare& share = c.moving[i];
    double factor = share.constant, rate = 0;
    if (share.waves) {
      const std::size_t slot = share.wave.slot;
      factor += share.wave.sine * w.sine[slot] + share.wave.cosine * w.cosine[slot];
      rate += c.rates[slot] * (share.wave.sine * w.cosine[slot] - share.wave.cosine * w.sine[slot]);
    }
    if (share.curve) {
      double value = 0, slope = 0;
      share.curve->evaluate(share.frequency * t + share.phase_offset, &value, &slope);
      factor += value;
      rate += share.frequency * slope;
    }
    w.factor[i] = factor;
    w.factor_rate[i] = rate;
  }
  for (std::size_t i = 0; i < c.friction.size(); ++i) {
    const CompiledFriction& share = c.friction[i];
    double slope = 0;
    share.curve->evaluate(share.frequency * t + share.phase_offset, &w.friction[i], &slope);
  }
  for (const auto& coupling : c.couplings) evaluate_compliance(coupling, t, w);
  w.time = t;
  w.excitation_valid = true;
}

void apply_face(const FaceElement& face, const CompiledMesh& mesh, LumpedSystem::Workspace& w, double& across) {
  using Contact = LumpedSystem::Contact;
  // Left of the tangents where nothing touches, so that an unloaded body has a place.
  constexpr double without_contact = 1e-9;
  const auto i = static_cast<std::size_t>(face.approach), j = static_cast<std::size_t>(face.tilt);
  w.elastic[i] = w.elastic[j] = across = 0;
  w.tangent[i] = without_contact * w.stiffness[i];
  w.tangent[j] = without_contact * w.stiffness[j];
  w.contact[i] = Contact::open;
  for (const auto& place : face.places) {
    const auto [contact, g, weight] = place_state(face, place, w.face_shape[mesh.face], w.delta[i], w.delta[j]);
    if (contact == Contact::open) continue;
    if (w.contact[i] != Contact::drive) w.contact[i] = contact;
    const auto value = law_in_contact(mesh, i, contact, g, w);
    const double force = weight * value.force, tangent = weight * value.tangent;
    w.elastic[i] += force;
    w.elastic[j] += place.z * force;
    w.tangent[i] += tangent;
    w.tangent[j] += place.z * place.z * tangent;
    across += place.z * tangent;
  }
  w.contact[j] = w.contact[i];
}

namespace {

/// Writes the tangent, and returns where that of the next law stands.
double* apply_law_element(const LawElement& element, LumpedSystem::Workspace& w, double* tangent) {
  const std::size_t size = element.meshes.size();
  double *deflection = w.law.data(), *force = deflection + size;
  for (std::size_t i = 0; i < size; ++i) {
    const int m = element.meshes[i];
    deflection[i] = w.delta[m] = w.approach[m];
  }
  element.law->evaluate(deflection, force, tangent);
  for (std::size_t i = 0; i < size; ++i) {
    w.elastic[element.meshes[i]] = force[i];
    w.tangent[element.meshes[i]] = tangent[i * (size + 1)];
  }
  return tangent + size * size;
}

}  // namespace

void LumpedSystem::apply_forces(Workspace& w, ContactStates states) const {
  const Compiled& c = *compiled_;
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    const CompiledMesh& mesh = c.meshes[m];
    if (mesh.coupled) continue;
    w.delta[m] = w.approach[m];
    if (states == ContactStates::following) w.contact[m] = contact_of(mesh, w.delta[m]);
    apply_law(mesh, m, w);
  }
  // Couplings of faces solve for the approaches; the tilts are given.
  for (const auto& face : faces_) {
    w.delta[face.approach] = w.approach[face.approach];
    w.delta[face.tilt] = w.approach[face.tilt];
  }
  for (const auto& coupling : c.couplings) solve_coupling(coupling, c.meshes, faces_, states, w);
  for (std::size_t i = 0; i < faces_.size(); ++i)
    apply_face(faces_[i], c.meshes[faces_[i].approach], w, w.across_face[i]);
  double* tangent = w.law_tangent.data();
  for (const auto& element : laws_) tangent = apply_law_element(element, w, tangent);
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    w.damping[m] = acting_damping(c.meshes[m], w.contact[m], w.delta[m], w.delta_rate[m]);
    w.force[m] = w.elastic[m] + w.damping[m] * w.delta_rate[m];
  }
}

void LumpedSystem::detect_contact(double t, const double* q, Workspace& w) const {
  evaluate_excitation(t, w);
  const Compiled& c = *compiled_;
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    double approach = -w.error[m];
    for (int i = c.b.start[m]; i < c.b.start[m + 1]; ++i) approach += c.b.factor[i] * q[c.b.index[i]];
    for (int i = c.meshes[m].first_moving; i < c.meshes[m].last_moving; ++i)
      approach += w.factor[i] * q[c.moving[i].dof];
    w.approach[m] = approach;
    w.delta_rate[m] = 0;
  }
  apply_forces(w, ContactStates::following);
}

void LumpedSystem::evaluate_meshes(double t, const double* q, const double* v, Workspace& w) const {
  evaluate_excitation(t, w);
  const Compiled& c = *compiled_;
  double* pairs = w.pairs.data();
  for (int i = 0; i < dofs(); ++i) store(TwoDoubles{q[i], v[i]}, pairs + 2 * i);
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    TwoDoubles approach{-w.error[m], -w.pace * w.error_rate[m]};
    for (int i = c.b.start[m]; i < c.b.start[m + 1]; ++i)
      approach += c.b.factor[i] * two_doubles_at(pairs + 2 * c.b.index[i]);
    for (int i = c.meshes[m].first_moving; i < c.meshes[m].last_moving; ++i) {
      const int j = c.moving[i].dof;
      approach += w.factor[i] * two_doubles_at(pairs + 2 * j) + TwoDoubles{0.0, w.pace * w.factor_rate[i] * q[j]};
    }
    w.approach[m] = approach[0];
    w.delta_rate[m] = approach[1];
  }
  apply_forces(w, ContactStates::held);
}

void LumpedSystem::evaluate_forces(double t, const double* approach, const double* approach_rate, Workspace& w) const {
  evaluate_excitation(t, w);
  for (std::size_t m = 0; m < compiled_->meshes.size(); ++m) {
    w.approach[m] = approach[m] - w.error[m];
    w.delta_rate[m] = approach_rate[m] - w.pace * w.error_rate[m];
  }
  apply_forces(w, ContactStates::following);
}

void LumpedSystem::rhs(double t, const double* y, double* dy, Workspace& w) const {
  const Compiled& c = *compiled_;
  const int n = dofs();
  evaluate_meshes(t, y, y + n, w);
  double* pairs = w.pairs.data();
  const std::size_t meshes = c.meshes.size();
  for (std::size_t m = 0; m < meshes; m += 2)
    store(TwoDoubles{w.force[m], m + 1 < meshes ? w.force[m + 1] : 0.0}, pairs + 2 * n + m);
  if (!c.moving.empty()) {
    double* forces = pairs + 2 * n + meshes + meshes % 2;
    std::fill_n(forces, c.moving_dofs.size(), 0.0);
    for (std::size_t m = 0; m < meshes; ++m)
      for (int i = c.meshes[m].first_moving; i < c.meshes[m].last_moving; ++i)
        forces[c.moving[i].slot] += w.factor[i] * w.force[m];
  }
  for (int i = 0; i < n; ++i) {
    TwoDoubles a{c.acceleration[i], 0.0};
    for (const auto& load : c.harmonic)
      a += TwoDoubles{load.sine[i] * w.sine[load.slot], load.cosine[i] * w.cosine[load.slot]};
    for (int j = c.pair_start[i]; j < c.pair_start[i + 1]; ++j)
      a -= two_doubles_at(&c.pair_factor[2 * j]) * two_doubles_at(pairs + 2 * c.pair_column[j]);
    dy[i] = y[n + i];
    dy[n + i] = a[0] + a[1];
  }
  for (std::size_t m = 0; m < meshes; ++m)
    for (int k = c.meshes[m].first_friction; k < c.meshes[m].last_friction; ++k)
      Eigen::Map<Eigen::VectorXd>(dy + n, n) -=
          w.sliding * w.friction[k] * std::abs(w.force[m]) * c.friction[k].acceleration;
}

}  // namespace annulus::dynamics
