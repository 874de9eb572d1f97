#include "dynamics/system/lumped_system_compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Index of `rate` in the list, appended when new.
std::size_t slot_of(std::vector<double>& rates, double rate) {
  const auto found = std::find(rates.begin(), rates.end(), rate);
  if (found != rates.end()) return static_cast<std::size_t>(found - rates.begin());
  rates.push_back(rate);
  return rates.size() - 1;
}

/// amount x sin(rate t + phase) by its rate.
SlotTerm slot_term(std::vector<double>& rates, const HarmonicError& wave) {
  return {slot_of(rates, wave.rate), wave.amount * std::cos(wave.phase), wave.amount * std::sin(wave.phase)};
}

/// A zero that cancelled keeps less than this share of its terms when a non-diagonal mass matrix is solved with.
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

}  // namespace

LumpedSystemCompiler::LumpedSystemCompiler(const LumpedSystem& system)
    : system_(system), dofs_(system.dofs()), mass_(system.mass()) {
  if (mass_.info() != Eigen::Success)
    throw InputError(fmt::format("the mass matrix of {} degrees of freedom is not positive definite", dofs_));
  inverse_ = mass_.solve(Eigen::MatrixXd::Identity(dofs_, dofs_)).cwiseAbs();
}

std::shared_ptr<const LumpedSystem::Compiled> LumpedSystemCompiler::compile() {
  compiled_ = std::make_shared<LumpedSystem::Compiled>();
  compile_matrices();
  compile_power();
  compiled_->b.start = compiled_->inverse_b.start = {0};
  for (const auto& mesh : system_.meshes()) compile_mesh(mesh);
  compile_moving_shares();
  compile_friction();
  for (const auto& coupling : system_.couplings()) compile_coupling(coupling);
  for (const auto& element : system_.laws()) compile_law(element);
  for (std::size_t i = 0; i < system_.faces().size(); ++i) compile_face(system_.faces()[i], static_cast<int>(i));
  compile_rows();
  return std::move(compiled_);
}

/// M^-1 f and the common sparse pattern of M^-1 (K + K_Omega) and M^-1 (C + G).
void LumpedSystemCompiler::compile_matrices() {
  auto& c = *compiled_;
  c.acceleration = mass_.solve(system_.load());
  for (const auto& load : system_.harmonic_loads())
    c.harmonic.push_back({slot_of(c.rates, load.rate), mass_.solve(load.sine), mass_.solve(load.cosine)});
  const Eigen::MatrixXd stiffness = mass_.solve(system_.stiffness() + system_.rotating_stiffness());
  const Eigen::MatrixXd damping = mass_.solve(system_.damping() + system_.gyroscopic());
  // Entry by entry: a soft support beside a stiff one, or a light body beside a heavy one, is not rounding.
  const Eigen::MatrixXd stiffness_terms = inverse_ * (system_.stiffness() + system_.rotating_stiffness()).cwiseAbs();
  const Eigen::MatrixXd damping_terms = inverse_ * (system_.damping() + system_.gyroscopic()).cwiseAbs();
  c.row_start.push_back(0);
  for (int i = 0; i < dofs_; ++i) {
    for (int j = 0; j < dofs_; ++j)
      if (std::abs(stiffness(i, j)) > cancelled * stiffness_terms(i, j) ||
          std::abs(damping(i, j)) > cancelled * damping_terms(i, j)) {
        c.column.push_back(j);
        c.stiffness.push_back(stiffness(i, j));
        c.damping.push_back(damping(i, j));
      }
    c.row_start.push_back(static_cast<int>(c.column.size()));
  }
}

void LumpedSystemCompiler::compile_power() {
  const auto &rotating = system_.rotating_stiffness(), &damping = system_.damping();
  for (int i = 0; i < dofs_; ++i)
    for (int j = 0; j < dofs_; ++j) {
      const double skew = 0.5 * (rotating(i, j) - rotating(j, i));
      if (damping(i, j) != 0 || skew != 0) compiled_->power.push_back({i, j, damping(i, j), skew});
    }
}

void LumpedSystemCompiler::compile_mesh(const MeshElement& mesh) {
  auto& c = *compiled_;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(dofs_);  // the constant part
  for (const auto& [i, factor] : mesh.b) b[i] += factor;
  append_sparse(b, b.cwiseAbs(), c.b);
  append_sparse(mass_.solve(b), inverse_ * b.cwiseAbs(), c.inverse_b);
  auto& m = c.meshes.emplace_back();
  m.damping = mesh.damping;
  m.damping_without_contact = mesh.damping_without_contact;
  m.half_backlash = mesh.half_backlash.value_or(0.0);
  m.linear = m.half_backlash == 0;  // g(delta) = delta
  m.film = mesh.film.value_or(SqueezeFilm{});
  m.film_backlash = m.half_backlash;
  if (mesh.film && !(mesh.film->coefficient >= 0 && mesh.film->least_gap > 0))
    throw InputError(
        fmt::format("mesh {}: an oil film with the coefficient {} N s m^(1/2) and a least gap of {} m; "
                    "they must be positive",
                    mesh.name, mesh.film->coefficient, mesh.film->least_gap));
  m.frequency = mesh.frequency;
  m.phase_offset = mesh.phase_offset;
  compile_errors(mesh, m);
  compile_excitation(mesh, m);
}

/// Terms constant in time get no slot; all others share one sine and cosine per distinct rate.
void LumpedSystemCompiler::compile_errors(const MeshElement& mesh, CompiledMesh& m) {
  auto& c = *compiled_;
  m.first_error = static_cast<int>(c.errors.size());
  for (const auto& error : mesh.errors) {
    if (error.rate == 0)
      m.constant_error += error.amount * std::sin(error.phase);
    else
      c.errors.push_back(slot_term(c.rates, error));
  }
  m.last_error = static_cast<int>(c.errors.size());
  m.first_tooth = static_cast<int>(c.tooth_errors.size());
  for (const auto& error : mesh.tooth_errors)
    c.tooth_errors.push_back({shared_bundle(c.bundles, CurveBundle({&error.curve})), error.phase_offset});
  m.last_tooth = static_cast<int>(c.tooth_errors.size());
}

void LumpedSystemCompiler::compile_excitation(const MeshElement& mesh, CompiledMesh& m) {
  auto& c = *compiled_;
  m.mean = mean_stiffness(mesh.excitation);
  if (const auto* harmonic = std::get_if<HarmonicStiffness>(&mesh.excitation)) {
    const double angle = 2 * std::numbers::pi * (mesh.phase_offset - harmonic->phase_shift);
    m.kind = CompiledMesh::Kind::harmonic;
    m.ripple = {slot_of(c.rates, 2 * std::numbers::pi * mesh.frequency),
                -harmonic->mean * harmonic->ripple * std::sin(angle),
                harmonic->mean * harmonic->ripple * std::cos(angle)};
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
    // Without backlash it changes from one flank to the other where its force changes sign.
    m.mirrored = table->back_flank_phase.has_value();
    m.linear = m.linear && !m.mirrored;
    m.back_flank_phase = table->back_flank_phase.value_or(0.0);
    if (table->surface) {
      c.surfaces.push_back(table->surface);
      m.surface = table->surface.get();
    }
  }
}

void LumpedSystemCompiler::compile_moving_shares() {
  auto& c = *compiled_;
  for (std::size_t m = 0; m < system_.meshes().size(); ++m) {
    const MeshElement& mesh = system_.meshes()[m];
    c.meshes[m].first_moving = static_cast<int>(c.moving.size());
    for (const auto& share : mesh.moving) {
      if (share.dof < 0 || share.dof >= dofs_)
        throw InputError(fmt::format("mesh {}: a moving share of degree of freedom {}; there are 0 to {}", mesh.name,
                                     share.dof, dofs_ - 1));
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
        compiled.wave = slot_term(c.rates, wave);
      else
        compiled.constant = wave.amount * std::sin(wave.phase);
      if (!(share.curve == PeriodicCurve())) compiled.curve = shared_bundle(c.bundles, CurveBundle({&share.curve}));
    }
    c.meshes[m].last_moving = static_cast<int>(c.moving.size());
  }
  c.inverse_moving.resize(dofs_, static_cast<Eigen::Index>(c.moving_dofs.size()));
  for (int k = 0; k < c.inverse_moving.cols(); ++k)
    c.inverse_moving.col(k) = mass_.solve(Eigen::VectorXd::Unit(dofs_, c.moving_dofs[k]));
}

void LumpedSystemCompiler::compile_friction() {
  auto& c = *compiled_;
  const Eigen::MatrixXd& neutral = system_.neutral_;
  for (std::size_t m = 0; m < system_.meshes().size(); ++m) {
    const MeshElement& mesh = system_.meshes()[m];
    c.meshes[m].first_friction = static_cast<int>(c.friction.size());
    for (const auto& share : mesh.friction) {
      auto& compiled = c.friction.emplace_back();
      compiled.along = Eigen::VectorXd::Zero(dofs_);
      for (const auto& [i, factor] : share.along) compiled.along[i] += factor;
      if (neutral.size() > 0) compiled.along -= system_.mass() * neutral * (neutral.transpose() * compiled.along);
      compiled.acceleration = mass_.solve(compiled.along);
      compiled.curve = shared_bundle(c.bundles, CurveBundle({&share.curve}));
      compiled.frequency = mesh.frequency;
      compiled.phase_offset = mesh.phase_offset;
    }
    c.meshes[m].last_friction = static_cast<int>(c.friction.size());
  }
}

void LumpedSystemCompiler::check_uncoupled(const std::string& what, int mesh) const {
  const auto meshes = static_cast<int>(system_.meshes().size());
  if (mesh < 0 || mesh >= meshes)
    throw InputError(fmt::format("{} names mesh {}; there are 0 to {}", what, mesh, meshes - 1));
  if (compiled_->meshes[mesh].coupled)
    throw InputError(
        fmt::format("{} names mesh {} ({}), which is coupled already", what, mesh, system_.meshes()[mesh].name));
}

void LumpedSystemCompiler::compile_law(const LawElement& element) {
  if (element.law->size() != std::ssize(element.meshes))
    throw InputError(fmt::format("a law of {} deflections has {} meshes", element.law->size(), element.meshes.size()));
  for (const int m : element.meshes) {
    check_uncoupled("a law", m);
    check_without_backlash("a law", m);
    compiled_->meshes[m].coupled = true;
  }
}

/// After the couplings, which may have its approach.
void LumpedSystemCompiler::compile_face(const FaceElement& face, int number) {
  check_uncoupled("the tilt of a face", face.tilt);
  const auto& couplings = system_.couplings();
  const bool in_coupling = std::any_of(couplings.begin(), couplings.end(), [&](const auto& coupling) {
    return std::count(coupling.meshes.begin(), coupling.meshes.end(), face.approach) > 0;
  });
  if (!in_coupling) check_uncoupled("a face", face.approach);
  for (const int m : {face.approach, face.tilt}) {
    check_without_backlash("a face", m);
    compiled_->meshes[m].coupled = true;
  }
  auto& mesh = compiled_->meshes[face.approach];
  mesh.face = number;
  mesh.film_backlash = face.half_backlash.value_or(0.0);
  if (face.course) {
    const auto& [slope, curvature, gap_slope] = *face.course;
    mesh.face_course = shared_bundle(compiled_->bundles, CurveBundle({&slope, &curvature, &gap_slope}));
    mesh.face_phase = system_.meshes()[face.approach].phase_offset;
  }
  double sum = 0;
  for (const auto& place : face.places) sum += place.weight;
  constexpr double rounding = 1e-9;
  if (!(std::abs(sum - 1) < rounding))
    throw InputError(fmt::format("the weights of the {} places on the face of mesh {} ({}) add up to {}, not to 1",
                                 face.places.size(), face.approach, system_.meshes()[face.approach].name, sum));
}

void LumpedSystemCompiler::check_without_backlash(const std::string& what, int mesh) const {
  const auto& element = system_.meshes()[mesh];
  if (element.half_backlash)
    throw InputError(fmt::format("mesh {} ({}) is a part of {} and has a half backlash of {} m; it must have none",
                                 mesh, element.name, what, *element.half_backlash));
}

void LumpedSystemCompiler::check_coupling(const MeshCoupling& coupling) const {
  const auto size = static_cast<int>(coupling.meshes.size());
  if (size < 1 || size > largest_coupling)
    throw InputError(fmt::format("a mesh coupling joins 1 to {} meshes, not {}", largest_coupling, size));
  if (static_cast<int>(coupling.compliance.size()) != size * (size + 1) / 2)
    throw InputError(fmt::format("a coupling of {} meshes needs {} compliances, not {}", size, size * (size + 1) / 2,
                                 coupling.compliance.size()));
  for (const int m : coupling.meshes) {
    check_uncoupled("a mesh coupling", m);
    if (std::count(coupling.meshes.begin(), coupling.meshes.end(), m) > 1)
      throw InputError(fmt::format("a mesh coupling names mesh {} ({}) twice", m, system_.meshes()[m].name));
  }
  for (const auto& mode : coupling.retained)
    if (mode.dof < 0 || mode.dof >= dofs_ || !(mode.stiffness > 0))
      throw InputError(
          fmt::format("a retained mode of a mesh coupling has degree of freedom {} and stiffness {} N/m; it needs "
                      "one of the degrees of freedom 0 to {} and a positive stiffness",
                      mode.dof, mode.stiffness, dofs_ - 1));
}

void LumpedSystemCompiler::compile_coupling(const MeshCoupling& coupling) {
  auto& c = *compiled_;
  check_coupling(coupling);
  CompiledCoupling compiled;
  for (const int m : coupling.meshes) c.meshes[m].coupled = true;
  compiled.meshes = coupling.meshes;
  const auto& first = system_.meshes()[coupling.meshes.front()];
  compiled.frequency = first.frequency;
  compiled.phase_offset = first.phase_offset;
  std::vector<const PeriodicCurve*> curves;
  for (const auto& curve : coupling.compliance) curves.push_back(&curve);
  compiled.compliance = CurveBundle(curves);
  for (const auto& other : c.couplings) compiled.offset += static_cast<int>(other.meshes.size() * other.meshes.size());
  for (const auto& retained : coupling.retained) {
    auto& mode = compiled.retained.emplace_back();
    mode.compliance = 1 / retained.stiffness;
    for (const int m : coupling.meshes) {
      int found = -1;
      for (int i = c.meshes[m].first_moving; i < c.meshes[m].last_moving; ++i)
        if (c.moving[i].dof == retained.dof) found = i;
      mode.shares.push_back(found);
    }
  }
  c.couplings.push_back(std::move(compiled));
}

/// Joins M^-1 (K, C), M^-1 b and M^-1 of the moving DOFs to one sparse matrix of pairs.
void LumpedSystemCompiler::compile_rows() {
  auto& c = *compiled_;
  const int meshes = static_cast<int>(c.meshes.size());
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(dofs_, meshes + meshes % 2);
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
  for (int i = 0; i < dofs_; ++i) {
    for (int j = c.row_start[i]; j < c.row_start[i + 1]; ++j) add(c.column[j], c.stiffness[j], c.damping[j]);
    for (int m = 0; m < meshes; m += 2) add(dofs_ + m / 2, forces(i, m), forces(i, m + 1));
    for (int k = 0; k < moving; k += 2)
      add(dofs_ + static_cast<int>(forces.cols() / 2) + k / 2, c.inverse_moving(i, k),
          k + 1 < moving ? c.inverse_moving(i, k + 1) : 0.0);
    c.pair_start.push_back(static_cast<int>(c.pair_column.size()));
  }
}

}  // namespace annulus::dynamics
