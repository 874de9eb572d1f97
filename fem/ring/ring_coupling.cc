#include "fem/ring/ring_coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/errors.h"
#include "fem/body/body_plan.h"
#include "fem/body/resolution.h"
#include "fem/contact/flank_contact.h"
#include "fem/levels/error_estimate.h"
#include "fem/ring/ring_flexibility.h"
#include "fem/ring/ring_on_supports.h"

namespace annulus::fem {
namespace {

bool solved_as_solid(const LoadedMeshProblem& problem, RingModel model) {
  return model == RingModel::solid || needs_solid(problem.structure) || problem.pair.wheel().helix_angle() != 0;
}

/// The ring as it is solved: the mirror image turns the hand of a helical one.
geometry::Gear mirrored(const geometry::Gear& gear) {
  auto parameters = gear.parameters();
  parameters.helix_angle = -parameters.helix_angle;
  return geometry::Gear(parameters);
}

std::optional<SupportPlan> support_plan(const LoadedMeshProblem& problem, const BodyPlan& body) {
  if (!on_single_supports(problem.structure)) return std::nullopt;
  const auto& [below, above] = problem.wheel_overhang;
  return SupportPlan(support_sites(problem), problem.pair.wheel().teeth(), {-below, problem.face_width + above},
                     FacePart::whole, body.turn());
}

/// Mesh forces of all planets, planet 0 at `position`: teeth x planets.
Eigen::MatrixXd mesh_forces(double position, const std::vector<double>& teeth_ahead, int teeth) {
  Eigen::MatrixXd patterns(teeth, static_cast<Eigen::Index>(teeth_ahead.size()));
  for (std::size_t n = 0; n < teeth_ahead.size(); ++n)
    patterns.col(static_cast<Eigen::Index>(n)) = mesh_force_on_teeth(position + teeth_ahead[n], teeth);
  return patterns;
}

/// Coupling on supports that can lift off; `state` is the one with all meshes loaded.
Eigen::MatrixXd unilateral_coupling(const RingOnSupports& ring, const Eigen::MatrixXd& patterns, double load,
                                    const RingOnSupports::State& state, double& own) {
  Eigen::MatrixXd coupling = state.tangent;
  for (Eigen::Index n = 0; n < patterns.cols(); ++n) {
    const auto alone = ring.solve(patterns.col(n), Eigen::VectorXd::Constant(1, load), state.touching);
    own += alone.displacement[0] / load;
    const double others = coupling.row(n).sum() - coupling(n, n);
    coupling(n, n) = (state.displacement[n] - alone.displacement[0]) / load - others;
  }
  return coupling;
}

/// Compliance of the real ring, whose teeth count the other way round than those of the solve.
Eigen::MatrixXd teeth_compliance(const RingFlexibility& ring, const RingOnSupports* supported) {
  const int teeth = ring.teeth;
  Eigen::MatrixXd solved(teeth, teeth), result(teeth, teeth);
  if (supported) {
    solved = supported->held_teeth_compliance();
  } else {
    for (int a = 0; a < teeth; ++a)
      for (int b = 0; b < teeth; ++b) solved(a, b) = ring.compliance.block(a - b)(0, 0);
  }
  for (int a = 0; a < teeth; ++a)
    for (int b = 0; b < teeth; ++b) result(a, b) = solved((teeth - a) % teeth, (teeth - b) % teeth);
  return 0.5 * (result + result.transpose());
}

/// The coupling at one level of resolution, without its errors.
SolvedRingCoupling solve_level(const LoadedMeshProblem& problem, const std::vector<double>& teeth_ahead, double load,
                               const RingCouplingSettings& settings, int level) {
  const auto planets = static_cast<Eigen::Index>(teeth_ahead.size());
  const bool solid = solved_as_solid(problem, settings.model);
  const geometry::ToothProfile profile(mirrored(problem.pair.wheel()));
  const BodyPlan body(problem, profile, geometry::GearRole::wheel, geometry::Boundary::trailing_flank, settings.degree,
                      solid ? BodyPlan::Dimension::solid : BodyPlan::Dimension::plane, {problem.face_width, false});
  const auto plan = support_plan(problem, body);
  RingFlexibilityOptions options;
  options.roll = problem.pair.wheel_roll_length(problem.pair.roll_length_pitch());
  options.face_width = problem.face_width;
  options.overhang = problem.wheel_overhang.total();
  options.solid = solid;
  options.motions = settings.motions;
  options.threads = settings.threads;
  options.store = settings.store.get();
  if (plan) options.arcs = plan->arcs();
  const RingFlexibility ring = make_ring_flexibility(
      body, solid ? solid_resolution(level, settings.degree) : plane_resolution(profile.gear(), level, settings.degree),
      problem.materials.wheel, options);

  SolvedRingCoupling result;
  result.unknowns = ring.unknowns;
  ++(ring.reused ? result.reused_teeth : result.condensed_teeth);
  auto& of_planets = result.coupling;
  of_planets.planets = static_cast<int>(planets);
  of_planets.ring_teeth = ring.teeth;
  of_planets.load = load;
  of_planets.per_cycle = settings.per_cycle;
  std::optional<RingOnSupports> supported;
  if (plan) supported.emplace(ring, *plan);
  const Eigen::VectorXd loads = Eigen::VectorXd::Constant(planets, load);
  const int positions = problem.structure.repeating_teeth(ring.teeth) * settings.per_cycle;
  std::vector<bool> touching;
  for (int i = 0; i < positions; ++i) {
    const Eigen::MatrixXd patterns = mesh_forces(static_cast<double>(i) / settings.per_cycle, teeth_ahead, ring.teeth);
    Eigen::MatrixXd coupling;
    if (supported) {
      const auto state = supported->solve(patterns, loads, touching);
      touching = state.touching;
      coupling = state.tangent;
      if (supported->unilateral())
        coupling = unilateral_coupling(*supported, patterns, load, state, result.own_compliance);
    } else {
      coupling = Eigen::MatrixXd::Zero(planets, planets);
      for (int a = 0; a < ring.teeth; ++a)
        for (int b = 0; b < ring.teeth; ++b)
          if (!patterns.row(a).isZero(0) && !patterns.row(b).isZero(0))
            coupling += ring.compliance.block(a - b)(0, 0) * patterns.row(a).transpose() * patterns.row(b);
      coupling = (0.5 * (coupling + coupling.transpose())).eval();
    }
    if (!supported || !supported->unilateral()) {
      result.own_compliance += coupling.trace();
      coupling.diagonal().setZero();
    }
    of_planets.compliance.push_back(std::move(coupling));
  }
  result.own_compliance /= static_cast<double>(positions) * static_cast<double>(planets);
  result.teeth_compliance = teeth_compliance(ring, supported ? &*supported : nullptr);
  of_planets.modes =
      supported ? supported_ring_modes(ring, *supported, settings.modes) : held_ring_modes(ring, settings.modes);
  for (int s = 0; s < ring.teeth; ++s) {
    const Eigen::Vector3d squares = ring.resultants_of(s, ring.first_motion(), ring.motions).rowwise().squaredNorm();
    of_planets.mass += squares.x();
    of_planets.rotational_mass += squares.z() / std::pow(ring.base_radius, 2);
  }
  return result;
}

void check_places(std::vector<double> teeth_ahead, int teeth) {
  if (teeth_ahead.empty() || teeth_ahead.front() != 0)
    throw InputError(teeth_ahead.empty() ? "the coupling of ring meshes needs planets, and there are none"
                                         : fmt::format("the first planet has to stand 0 teeth ahead of itself, not {}",
                                                       teeth_ahead.front()));
  // The four teeth that share one mesh force are not those of the next planet.
  constexpr double apart = 4;
  for (const double place : teeth_ahead)
    if (!std::isfinite(place)) throw InputError(fmt::format("a planet stands {} ring teeth ahead of planet 1", place));
  std::sort(teeth_ahead.begin(), teeth_ahead.end());
  teeth_ahead.push_back(teeth);
  for (std::size_t n = 0; n + 1 < teeth_ahead.size(); ++n)
    if (teeth_ahead[n + 1] - teeth_ahead[n] < apart)
      throw InputError(
          fmt::format("a planet stands {} ring teeth ahead of planet 1, the next one {}: at least {} have to lie "
                      "between them",
                      teeth_ahead[n], teeth_ahead[n + 1], apart));
}

void check(const LoadedMeshProblem& problem, const std::vector<double>& teeth_ahead, double load,
           const RingCouplingSettings& settings) {
  if (!problem.pair.internal())
    throw InputError(
        fmt::format("the coupling of ring meshes needs a planet and a ring, not an external pair of {} and {} teeth",
                    problem.pair.pinion().teeth(), problem.pair.wheel().teeth()));
  const int last = solved_as_solid(problem, settings.model) ? last_solid_level : last_plane_level;
  if (settings.level < 1 || settings.level > last)
    throw InputError(fmt::format("level {} is not available: 1 to {} are", settings.level, last));
  check_places(teeth_ahead, problem.pair.wheel().teeth());
  if (!std::isfinite(load) || !(load > 0))
    throw InputError(fmt::format("a mesh load of {} N: it has to be positive", load));
  if (settings.per_cycle < 1)
    throw InputError(fmt::format("{} ring positions per mesh cycle: at least one is needed", settings.per_cycle));
  if (settings.motions.section < 1 || settings.motions.axial < 0 || settings.modes.count < 1)

    throw InputError(
        fmt::format("modes need motions of order 1 or higher in the section (here {}), 0 or higher along the "
                    "axis (here {}), and a count of at least one (here {})",
                    settings.motions.section, settings.motions.axial, settings.modes.count));
}

}  // namespace

Eigen::VectorXd mesh_force_on_teeth(double position, int teeth) {
  const double below = std::floor(position), t = position - below;
  // Lagrange polynomials through -1, 0, 1, 2.
  const double weights[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                             (t + 1) * t * (t - 1) / 6};
  Eigen::VectorXd result = Eigen::VectorXd::Zero(teeth);
  for (int k = 0; k < 4; ++k) {
    const int tooth = (static_cast<int>(below) + k - 1) % teeth;
    result[(2 * teeth - tooth) % teeth] += weights[k];
  }
  return result;
}

PlaneStrainBounds plane_strain_bounds(const LoadedMeshProblem& problem, RingModel model) {
  if (solved_as_solid(problem, model)) return {};
  const double squared = problem.materials.wheel.poisson_ratio * problem.materials.wheel.poisson_ratio;
  return {squared / (1 - squared), 1 - std::sqrt(1 - squared)};
}

SolvedRingCoupling solve_ring_coupling(const LoadedMeshProblem& problem, const std::vector<double>& teeth_ahead,
                                       double load, const RingCouplingSettings& settings) {
  check(problem, teeth_ahead, load, settings);
  RingCouplingSettings before = settings;
  before.motions.section = std::max(1, settings.motions.section - 1);
  before.motions.axial = std::max(0, settings.motions.axial - 1);
  const SolvedRingCoupling coarser = solve_level(problem, teeth_ahead, load, before, settings.level - 1);
  SolvedRingCoupling result = solve_level(problem, teeth_ahead, load, settings, settings.level);
  result.condensed_teeth += coarser.condensed_teeth;
  result.reused_teeth += coarser.reused_teeth;

  auto& coupling = result.coupling;
  const double left = most_left_over(settings.degree);
  double largest = 0;
  for (std::size_t i = 0; i < coupling.compliance.size(); ++i) {
    const auto &own = coupling.compliance[i], &other = coarser.coupling.compliance[i];
    result.compliance_error = std::max(result.compliance_error, left * (own - other).cwiseAbs().maxCoeff());
    largest = std::max(largest, own.cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < std::min(coupling.modes.size(), coarser.coupling.modes.size()); ++k)
    result.frequency_error_relative =
        std::max(result.frequency_error_relative,
                 left * std::abs(coarser.coupling.modes[k].frequency / coupling.modes[k].frequency - 1));
  result.teeth_compliance_error = left * (result.teeth_compliance - coarser.teeth_compliance).cwiseAbs().maxCoeff();
  const auto plane = plane_strain_bounds(problem, settings.model);
  result.compliance_error += plane.compliance * largest;
  result.teeth_compliance_error += plane.compliance * result.teeth_compliance.cwiseAbs().maxCoeff();
  result.frequency_error_relative += plane.frequency;
  coupling.provenance = {{"compliance_error_m_per_N", fmt::format("{:.3g}", result.compliance_error)},
                         {"frequency_error_relative", fmt::format("{:.3g}", result.frequency_error_relative)}};
  return result;
}

}  // namespace annulus::fem
