#include "dynamics/system/lumped_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/system/lumped_system_compiled.h"

namespace annulus::dynamics {

namespace {

/// dU/dt at constant deflection of a mesh.
double energy_rate(const CompiledMesh& mesh, LumpedSystem::Contact contact, double t, double g,
                   const std::vector<double>& rates, const LumpedSystem::Workspace& w) {
  double stiffness_rate = 0;  // the jumps of a wave are booked where they happen
  if (mesh.kind == CompiledMesh::Kind::harmonic) {
    stiffness_rate = rates[mesh.ripple.slot] *
                     (mesh.ripple.sine * w.cosine[mesh.ripple.slot] - mesh.ripple.cosine * w.sine[mesh.ripple.slot]);
  } else if (mesh.kind == CompiledMesh::Kind::table) {
    const auto [cycles, direction] = table_place(mesh, contact, t);
    const double rate = direction * mesh.frequency;
    if (mesh.surface) return rate * mesh.surface->energy_rate(cycles, g);
    double values[2], derivatives[2];
    mesh.table->evaluate(cycles, values, derivatives);
    stiffness_rate = rate * derivatives[0];
  }
  return 0.5 * stiffness_rate * g * g;
}

/// Of the law of a whole mesh at a deflection beyond the backlash, J.
double place_energy(const CompiledMesh& mesh, std::size_t m, LumpedSystem::Contact contact, double t, double g,
                    const LumpedSystem::Workspace& w) {
  if (contact == LumpedSystem::Contact::open) return 0;
  return mesh.surface ? mesh.surface->energy(table_place(mesh, contact, t).cycles, g)
                      : 0.5 * law_in_contact(mesh, m, contact, g, w).force * g;
}

/// The meshes' part of the Jacobian with vectors that move and forces that depend on each other.
template <class Compiled>
void subtract_coupled(const LumpedSystem& system, const Compiled& c, double t, Eigen::Ref<Eigen::MatrixXd> result,
                      const LumpedSystem::Workspace& w) {
  const int n = system.dofs(), meshes = static_cast<int>(c.meshes.size());
  const Eigen::MatrixXd b = system.mesh_vectors(t);
  Eigen::MatrixXd rate(n, meshes), inverse = Eigen::MatrixXd::Zero(n, meshes), tangent(meshes, meshes);
  Eigen::VectorXd damping(meshes);
  for (int m = 0; m < meshes; ++m) {
    rate.col(m) = w.pace * system.mesh_vector_rate(m, t);
    for (int i = c.inverse_b.start[m]; i < c.inverse_b.start[m + 1]; ++i)
      inverse(c.inverse_b.index[i], m) = c.inverse_b.factor[i];
    for (int i = c.meshes[m].first_moving; i < c.meshes[m].last_moving; ++i)
      inverse.col(m) += w.factor[i] * c.inverse_moving.col(c.moving[i].slot);
    for (int i = c.meshes[m].first_friction; i < c.meshes[m].last_friction; ++i)
      inverse.col(m) += std::copysign(w.sliding, w.force[m]) * w.friction[i] * c.friction[i].acceleration;
    damping[m] = w.damping[m];
  }
  system.tangent_matrix(w, tangent);
  for (int m = 0; m < meshes; ++m)
    tangent(m, m) += damping_tangent(c.meshes[m], w.contact[m], w.delta[m], w.delta_rate[m]);
  const Eigen::MatrixXd damped = inverse * damping.asDiagonal();
  result.bottomLeftCorner(n, n) -= inverse * tangent * b.transpose() + damped * rate.transpose();
  result.bottomRightCorner(n, n) -= damped * b.transpose();
}

}  // namespace

int LumpedSystem::find(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

Eigen::VectorXd LumpedSystem::load_at(double t) const {
  Eigen::VectorXd load = load_;
  for (const auto& part : harmonic_loads_)
    load += std::cos(part.rate * t) * part.cosine + std::sin(part.rate * t) * part.sine;
  return load;
}

bool LumpedSystem::is_whole_mesh(int mesh) const {
  return std::none_of(laws_.begin(), laws_.end(),
                      [mesh](const auto& law) { return std::count(law.meshes.begin(), law.meshes.end(), mesh) > 0; }) &&
         std::none_of(faces_.begin(), faces_.end(), [mesh](const auto& face) { return face.tilt == mesh; });
}

bool LumpedSystem::is_gear_mesh(int mesh) const { return is_whole_mesh(mesh) && !meshes_[mesh].shaft; }

Eigen::VectorXd LumpedSystem::mesh_vector(int mesh, double t) const {
  const MeshElement& element = meshes_[mesh];
  Eigen::VectorXd b = Eigen::VectorXd::Zero(dofs());
  for (const auto& [index, factor] : element.b) b[index] += factor;
  for (const auto& share : element.moving)
    b[share.dof] += share.curve(element.frequency * t + element.phase_offset) +
                    share.wave.amount * std::sin(share.wave.rate * t + share.wave.phase);
  return b;
}

Eigen::VectorXd LumpedSystem::mesh_vector_rate(int mesh, double t) const {
  const MeshElement& element = meshes_[mesh];
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(dofs());
  for (const auto& share : element.moving)
    rate[share.dof] += element.frequency * share.curve.derivative(element.frequency * t + element.phase_offset) +
                       share.wave.amount * share.wave.rate * std::cos(share.wave.rate * t + share.wave.phase);
  return rate;
}

Eigen::MatrixXd LumpedSystem::mesh_vectors(double t) const {
  Eigen::MatrixXd b(dofs(), static_cast<Eigen::Index>(meshes_.size()));
  for (Eigen::Index m = 0; m < b.cols(); ++m) b.col(m) = mesh_vector(static_cast<int>(m), t);
  return b;
}

Eigen::MatrixXd LumpedSystem::damping_with_meshes() const {
  Eigen::MatrixXd sum = damping_;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const Eigen::VectorXd b = mesh_vector(static_cast<int>(m));
    sum += meshes_[m].damping * b * b.transpose();
  }
  return sum;
}

bool LumpedSystem::has_moving_vectors() const { return !compiled_->moving.empty(); }

bool LumpedSystem::has_friction() const { return !compiled_->friction.empty(); }

Eigen::VectorXd LumpedSystem::friction_force(const Workspace& w) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(dofs());
  for (std::size_t m = 0; m < meshes_.size(); ++m)
    for (int i = compiled_->meshes[m].first_friction; i < compiled_->meshes[m].last_friction; ++i)
      force -= w.sliding * w.friction[i] * std::abs(w.force[m]) * compiled_->friction[i].along;
  return force;
}

LumpedSystem::Workspace LumpedSystem::workspace() const {
  Workspace w;
  for (auto* list : {&w.stiffness, &w.error, &w.error_rate, &w.delta, &w.delta_rate, &w.force, &w.elastic, &w.damping,
                     &w.tangent, &w.approach})
    list->assign(meshes_.size(), 0.0);
  std::size_t largest = 0, tangents = 0;
  for (const auto& element : laws_) {
    largest = std::max(largest, element.meshes.size());
    tangents += element.meshes.size() * element.meshes.size();
  }
  w.law.assign(2 * largest, 0.0);
  w.law_tangent.assign(tangents, 0.0);
  w.across_face.assign(faces_.size(), 0.0);
  w.face_shape.assign(faces_.size(), {});
  w.location.resize(meshes_.size());
  const auto even = [](std::size_t size) { return size + size % 2; };
  w.pairs.assign(2 * names_.size() + even(meshes_.size()) + even(compiled_->moving_dofs.size()), 0.0);
  w.factor.assign(compiled_->moving.size(), 0.0);
  w.factor_rate = w.factor;
  w.friction.assign(compiled_->friction.size(), 0.0);
  std::size_t entries = 0;
  for (const auto& coupling : compiled_->couplings) entries += coupling.meshes.size() * coupling.meshes.size();
  w.compliance.assign(entries, 0.0);
  w.contact.assign(meshes_.size(), Contact::drive);
  w.wave.assign(meshes_.size(), -1);
  w.sine.assign(compiled_->rates.size(), 0.0);
  w.cosine = w.sine;
  return w;
}

int LumpedSystem::outside_table(int mesh, const Workspace& w) const {
  const auto* surface = compiled_->meshes[mesh].surface;
  const double load = std::abs(w.elastic[mesh]);
  if (!surface || load == 0) return 0;
  // The tabulated loads themselves are inside, met to the resampling error.
  if (load > surface->largest_load() * (1 + 1e-6)) return 1;
  return load < surface->smallest_load() * (1 - 1e-6) ? -1 : 0;
}

void LumpedSystem::tangent_matrix(const Workspace& w, Eigen::Ref<Eigen::MatrixXd> result) const {
  result.setZero();
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const auto i = static_cast<Eigen::Index>(m);
    result(i, i) = w.tangent[m];
  }
  for (const auto& coupling : compiled_->couplings) {
    const CouplingMatrix tangent = coupled_tangent(coupling, w);
    for (int i = 0; i < tangent.rows(); ++i)
      for (int j = 0; j < tangent.cols(); ++j) result(coupling.meshes[i], coupling.meshes[j]) = tangent(i, j);
  }
  const double* of_law = w.law_tangent.data();
  for (const auto& element : laws_)
    for (const int i : element.meshes)
      for (const int j : element.meshes) result(i, j) = *of_law++;
  // A tilt changes the force of its own mesh as k_x/k of an approach would, k_x across and k of the mesh alone; what
  // the coupling does to that change comes back to all tilts.
  const auto share = [&](std::size_t i) { return w.across_face[i] / w.tangent[faces_[i].approach]; };
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto tilt = faces_[i].tilt;
    result(tilt, tilt) = w.tangent[tilt] - share(i) * w.across_face[i];
    result.col(tilt) += share(i) * result.col(faces_[i].approach);
  }
  for (std::size_t i = 0; i < faces_.size(); ++i)
    result.row(faces_[i].tilt) += share(i) * result.row(faces_[i].approach);
}

void LumpedSystem::jacobian(double t, const double* y, Eigen::Ref<Eigen::MatrixXd> result, Workspace& w) const {
  const Compiled& c = *compiled_;
  const int n = dofs();
  evaluate_meshes(t, y, y + n, w);
  result.setZero();
  for (int i = 0; i < n; ++i) {
    result(i, n + i) = 1;
    for (int j = c.row_start[i]; j < c.row_start[i + 1]; ++j) {
      result(n + i, c.column[j]) = -c.stiffness[j];
      result(n + i, n + c.column[j]) = -c.damping[j];
    }
  }
  if (has_coupled_meshes() || !has_fixed_directions()) {
    subtract_coupled(*this, c, t, result, w);
    return;
  }
  for (std::size_t m = 0; m < c.meshes.size(); ++m) {
    const CompiledMesh& mesh = c.meshes[m];
    const double k = w.tangent[m] + damping_tangent(mesh, w.contact[m], w.delta[m], w.delta_rate[m]);
    const double d = w.damping[m];
    for (int i = c.inverse_b.start[m]; i < c.inverse_b.start[m + 1]; ++i)
      for (int j = c.b.start[m]; j < c.b.start[m + 1]; ++j) {
        const double product = c.inverse_b.factor[i] * c.b.factor[j];
        result(n + c.inverse_b.index[i], c.b.index[j]) -= k * product;
        result(n + c.inverse_b.index[i], n + c.b.index[j]) -= d * product;
      }
  }
}

double LumpedSystem::energy(double t, const double* y, Workspace& w) const {
  const int n = dofs();
  evaluate_meshes(t, y, y + n, w);
  const Eigen::Map<const Eigen::VectorXd> q(y, n), v(y + n, n);
  double energy = 0.5 * (v.dot(mass_ * v) + q.dot((stiffness_ + rotating_stiffness_) * q));  // skew part drops out
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const CompiledMesh& mesh = compiled_->meshes[m];
    if (mesh.face >= 0 || !is_whole_mesh(static_cast<int>(m))) continue;
    const double g = penetration(mesh, w.contact[m], w.delta[m]);
    energy +=
        mesh.surface ? mesh.surface->energy(table_place(mesh, w.contact[m], t).cycles, g) : 0.5 * w.elastic[m] * g;
  }
  for (const auto& element : laws_) {
    std::transform(element.meshes.begin(), element.meshes.end(), w.law.begin(), [&](int m) { return w.delta[m]; });
    energy += element.law->energy(w.law.data());
  }
  for (const auto& face : faces_)
    for (const auto& place : face.places) {
      const auto m = static_cast<std::size_t>(face.approach);
      const CompiledMesh& mesh = compiled_->meshes[m];
      const auto [contact, g, weight] =
          place_state(face, place, w.face_shape[mesh.face], w.delta[m], w.delta[face.tilt]);
      energy += weight * place_energy(mesh, m, contact, t, g, w);
    }
  for (const auto& coupling : compiled_->couplings) {
    auto k = static_cast<std::size_t>(coupling.offset);
    for (const int i : coupling.meshes)
      for (const int j : coupling.meshes) energy += 0.5 * w.elastic[i] * w.compliance[k++] * w.elastic[j];
  }
  return energy;
}

LumpedSystem::Power LumpedSystem::power(double t, const double* y, const Workspace& w) const {
  const int n = dofs();
  const double* q = y;
  const double* v = y + n;
  // dE/dt = v.f - v.(C v) - v.(K_skew q) - sum c delta'^2 - sum v.g |F| + sum (b'.q - e') F
  //         + sum dU/dt at constant g - sum F.(D' F)/2
  Power p;
  p.supplied = load_at(t).dot(Eigen::Map<const Eigen::VectorXd>(v, n));
  if (has_friction()) p.dissipated -= friction_force(w).dot(Eigen::Map<const Eigen::VectorXd>(v, n));
  for (const auto& term : compiled_->power) {
    p.dissipated += v[term.i] * term.damping * v[term.j];
    p.supplied -= v[term.i] * term.circulatory * q[term.j];
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const CompiledMesh& mesh = compiled_->meshes[m];
    p.dissipated += w.damping[m] * w.delta_rate[m] * w.delta_rate[m];
    p.supplied -= w.error_rate[m] * w.force[m];
    if (mesh.face < 0)
      p.supplied +=
          energy_rate(mesh, w.contact[m], t, penetration(mesh, w.contact[m], w.delta[m]), compiled_->rates, w);
    for (int i = mesh.first_moving; i < mesh.last_moving; ++i)
      p.supplied += w.factor_rate[i] * q[compiled_->moving[i].dof] * w.force[m];
  }
  for (const auto& face : faces_)
    for (const auto& place : face.places) {
      const auto m = static_cast<std::size_t>(face.approach);
      const CompiledMesh& mesh = compiled_->meshes[m];
      const auto& shape = w.face_shape[mesh.face];
      const auto [contact, g, weight] = place_state(face, place, shape, w.delta[m], w.delta[face.tilt]);
      if (contact == Contact::open) continue;
      const auto rates = place_rates(place, shape);
      p.supplied += weight * energy_rate(mesh, contact, t, g, compiled_->rates, w) +
                    rates.weight * place_energy(mesh, m, contact, t, g, w);
      if (contact == Contact::drive) p.supplied -= weight * rates.gap * law_in_contact(mesh, m, contact, g, w).force;
    }
  for (const auto& coupling : compiled_->couplings) {
    const CouplingMatrix rate = compliance_rate(coupling, t, w);
    CouplingVector force(rate.rows());
    for (int i = 0; i < force.size(); ++i) force[i] = w.elastic[coupling.meshes[i]];
    p.supplied -= 0.5 * force.dot(rate * force);
  }
  return p;
}

double LumpedSystem::next_jump(double t, int direction) const {
  double next = direction * std::numeric_limits<double>::infinity();
  for (const auto& mesh : compiled_->meshes) {
    if (mesh.kind != CompiledMesh::Kind::wave || mesh.frequency == 0) continue;
    // A billionth of a cycle ahead: the jump just reached is not found again, and jumps of several meshes that differ
    // by rounding only are one.
    const bool backwards = (mesh.frequency < 0) != (direction < 0);
    const double phase = mesh.frequency * t + mesh.phase_offset + (backwards ? -1e-9 : 1e-9);
    const double start = std::floor(phase);
    const bool high = phase < start + mesh.duty;
    const double jump = backwards ? (high ? start : start + mesh.duty) : (high ? start + mesh.duty : start + 1);
    const double time = (jump - mesh.phase_offset) / mesh.frequency;
    next = direction < 0 ? std::max(next, time) : std::min(next, time);
  }
  return next;
}

void LumpedSystem::hold_waves(double t, Workspace& w) const {
  for (std::size_t m = 0; m < compiled_->meshes.size(); ++m)
    if (compiled_->meshes[m].kind == CompiledMesh::Kind::wave) w.wave[m] = wave_is_high(compiled_->meshes[m], t);
  w.excitation_valid = false;
}

}  // namespace annulus::dynamics
