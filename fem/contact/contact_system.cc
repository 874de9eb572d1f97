#include "fem/contact/contact_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/contact/contact_evaluation.h"
#include "fem/contact/omission_proof.h"
#include "fem/problem/solved_face.h"

namespace annulus::fem {

ContactSystem::ContactSystem(const FlankContact& flanks, const ContactBody& pinion, const ContactBody& wheel,
                             const SupportRow* supports, const MeshMaterials& materials,
                             std::vector<double> slice_edges, const ContactOptions& options,
                             const PlanetOnRollers* rollers)
    : face_(flanks, std::move(slice_edges), options.gaps),
      bodies_{face_, pinion, wheel, supports, rollers},
      range_(options.pairs ? *options.pairs : possible_contacts(flanks)),
      materials_(materials),
      window_(options.window),
      half_face_(options.half_face),
      elements_(bodies_, materials_, options) {}

std::shared_ptr<const ToothPairs> ContactSystem::prepare(double phase, double load, double window,
                                                         const PairSlices& added) const {
  // Softer than most meshes (steel: 4 N/(mm um), a third of what [ISO6336-1] gives teeth); where one gives way more
  // still, pairs are added.
  const double soft_mesh = 0.02 * materials_.youngs_modulus();  // N/m per m of face width
  auto result = std::make_shared<ToothPairs>();
  result->phase = phase;
  result->load = load;
  result->window = window;
  result->reach = load / face_.width() / soft_mesh;
  result->added = added;
  find_pairs(bodies_, elements_, range_, *result);
  const auto& pairs = result->pairs;
  auto& start = result->start;
  for (const auto& p : pairs) {
    start.push_back(result->contacts);
    result->contacts += p.size();
  }
  auto& compliance = result->compliance;
  compliance = Eigen::MatrixXd::Zero(result->contacts, result->contacts);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    const Eigen::Index size = p.size();
    const int tooth = wheel_tooth(face_.flanks(), p.index, 0);
    for (std::size_t j = 0; j <= i; ++j) {
      const auto& o = pairs[j];
      const int other = wheel_tooth(face_.flanks(), o.index, 0);
      const Eigen::MatrixXd block = bodies_.pinion.compliance(p.pinion, p.index, o.pinion, o.index) +
                                    bodies_.wheel.compliance(p.wheel, tooth, o.wheel, other);
      // Where a body has a compliance for either direction, both are formed: what they differ by measures reciprocity
      // (Betti). Of a pair with itself they are the same.
      Eigen::MatrixXd opposite = block;
      if (i != j && bodies_.pinion.same_both_ways() && bodies_.wheel.same_both_ways())
        opposite = block.transpose();
      else if (i != j)
        opposite = bodies_.pinion.compliance(o.pinion, o.index, p.pinion, p.index) +
                   bodies_.wheel.compliance(o.wheel, other, p.wheel, tooth);
      result->asymmetry = std::max(result->asymmetry,
                                   (block - opposite.transpose()).cwiseAbs().maxCoeff() / block.cwiseAbs().maxCoeff());
      const Eigen::MatrixXd mean = (block + opposite.transpose()) / 2;
      compliance.block(start[i], start[j], size, block.cols()) = mean;
      compliance.block(start[j], start[i], block.cols(), size) = mean.transpose();
    }
    compliance.block(start[i], start[i], size, size) +=
        bodies_.pinion.near_field(p.pinion) + bodies_.wheel.near_field(p.wheel);
  }
  return result;
}

std::shared_ptr<const ToothPairs> ContactSystem::setup_for(double window, const PairSlices& added,
                                                           PairsCache& cache) const {
  auto& setups = cache.setups;
  for (const auto& setup : setups)
    if (setup->window == window && setup->added == added) return setup;
  // The first one is that of all positions; of the others the latest serve the next cycles best.
  constexpr std::size_t most = 4;
  if (setups.size() == most) setups.erase(setups.begin() + 1);
  setups.push_back(prepare(cache.phase, cache.load, window, added));
  return setups.back();
}

ComplementarityProblem ContactSystem::assemble(const ToothPairs& setup, int cycle) const {
  const Eigen::Index contacts = setup.contacts;
  const auto floating = floating_unknowns(bodies_, contacts);
  Eigen::Index n = contacts, motions = 0;
  for (const auto& body : floating) {
    n += body.row->unknowns();
    motions += body.row->rigid_motions();
  }
  ComplementarityProblem problem;
  problem.compliance = Eigen::MatrixXd::Zero(n, n);
  problem.compliance.topLeftCorner(contacts, contacts) = setup.compliance;
  problem.gap = Eigen::VectorXd::Zero(n);
  problem.rigid = Eigen::MatrixXd::Zero(n, 1 + motions);
  problem.rigid.col(0).head(contacts).setConstant(face_.normal_factor());
  problem.load = Eigen::VectorXd::Zero(problem.rigid.cols());
  problem.load[0] = setup.load;
  problem.unilateral.assign(n, true);
  for (std::size_t i = 0; i < setup.pairs.size(); ++i)
    for (Eigen::Index e = 0; e < setup.pairs[i].size(); ++e)
      problem.gap[setup.start[i] + e] = setup.pairs[i].elements[e].gap;
  for (const auto& body : floating) add_floating(setup, cycle, body, problem);
  return problem;
}

void ContactSystem::add_floating(const ToothPairs& setup, int cycle, const FloatingUnknowns& body,
                                 ComplementarityProblem& problem) const {
  const SupportRow& row = *body.row;
  const bool of_wheel = body.row == bodies_.supports;
  const ContactBody& gear = of_wheel ? bodies_.wheel : bodies_.pinion;
  const Eigen::Index forces = row.unknowns(), motions = row.rigid_motions(), applied = row.size() - forces;
  const Eigen::VectorXd given = applied > 0 ? applied_forces(bodies_, setup) : Eigen::VectorXd();
  if (applied > 0) problem.applied_gap = Eigen::VectorXd::Zero(problem.gap.size());
  problem.compliance.block(body.force, body.force, forces, forces) = row.compliance();
  for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
    const auto& p = setup.pairs[i];
    const FlankPatch& patch = of_wheel ? p.wheel : p.pinion;
    const int tooth = of_wheel ? wheel_tooth(face_.flanks(), p.index, cycle) : p.index;
    const Eigen::MatrixXd weights = gear.port_weights(patch), coupling = row.at_ports(tooth, weights);
    const Eigen::Index at = setup.start[i], size = coupling.rows();
    problem.compliance.block(at, body.force, size, forces) = coupling;
    problem.compliance.block(body.force, at, forces, size) = coupling.transpose();
    problem.rigid.block(at, body.motion, size, motions) = -resultants(gear, patch, tooth).leftCols(motions);
    if (applied > 0) problem.applied_gap.segment(at, size) = weights.transpose() * row.applied_at_flank(tooth, given);
  }
  problem.rigid.block(body.force, body.motion, forces, motions) = -row.resultants().topRows(forces);
  problem.gap.segment(body.force, forces) = row.gap().head(forces);
  std::copy(row.unilateral().begin(), row.unilateral().begin() + forces, problem.unilateral.begin() + body.force);
  if (applied > 0) {
    problem.applied_gap.segment(body.force, forces) = row.applied_at_supports(given);
    problem.gap += problem.applied_gap;
    problem.load.segment(body.motion, motions) = row.resultants().bottomRows(applied).transpose() * given;
  }
  // Makes rotations displacements.
  problem.rigid.middleCols(body.motion + 2, motions - 2) /= body.radius;
  problem.load.segment(body.motion + 2, motions - 2) /= body.radius;
}

Eigen::MatrixXd ContactSystem::resultants(const ContactBody& body, const FlankPatch& patch, int tooth) const {
  const Eigen::MatrixXd plane = body.resultants(patch, tooth);
  Eigen::MatrixXd all(plane.rows(), 5);
  all.leftCols(3) = plane;
  for (Eigen::Index i = 0; i < plane.rows(); ++i) {
    const int slice = patch.elements[i].slice;
    const double z = (face_.slice_edges()[slice] + face_.slice_edges()[slice + 1]) / 2;
    all.row(i).tail<2>() << -z * plane(i, 1), z * plane(i, 0);
  }
  return all;
}

LoadedPosition ContactSystem::solve(int cycle, double phase, double whole_load, PairsCache& cache, WarmStart& warm,
                                    ContactForces* forces) const {
  const double load = half_face_ ? whole_load / 2 : whole_load;
  if (cache.setups.empty() || cache.phase != phase || cache.load != load) cache = {phase, load};
  // Pairs whose flanks all but touch without load: the first guess of what carries, no more.
  const double touching = 2.5e-7 * face_.flanks().pair().pinion().parameters().module;
  constexpr const char* remedy = "reduce the load, or make teeth, rim, supports or material stiffer";
  constexpr double largest_window = 12;  // in Hertz half-widths: longer than any flank at a sensible load
  // From the same window and pairs at every position: what others needed does not count.
  double window = window_;
  PairSlices added;
  for (;;) {
    const auto kept = setup_for(window, added, cache);
    const ToothPairs& setup = *kept;
    const ComplementarityProblem problem = assemble(setup, cycle);
    std::vector<bool> guess(problem.gap.size(), true);
    for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
      const auto& p = setup.pairs[i];
      const auto known = warm.pairs.find(p.index);
      const bool reuse = known != warm.pairs.end() && static_cast<Eigen::Index>(known->second.size()) == p.size();
      const double reach = 0.6 * p.elements.back().distance;
      for (Eigen::Index e = 0; e < p.size(); ++e)
        guess[setup.start[i] + e] =
            reuse ? known->second[e] : p.smallest_gap < touching && std::abs(p.elements[e].distance) < reach;
    }
    if (static_cast<Eigen::Index>(warm.supports.size()) == problem.gap.size() - setup.contacts)
      std::copy(warm.supports.begin(), warm.supports.end(), guess.begin() + setup.contacts);
    const auto solution = [&] {
      try {
        return solve_complementarity(problem, std::move(guess));
      } catch (const SolverError& error) {
        throw SolverError(fmt::format("mesh phase {:.4f}, {:.4g} N: {}", phase, whole_load, error.what()));
      }
    }();
    warm.pairs.clear();
    warm.supports.assign(solution.active.begin() + setup.contacts, solution.active.end());
    bool window_too_small = false;
    for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
      const auto& p = setup.pairs[i];
      const auto first = solution.active.begin() + setup.start[i];
      warm.pairs[p.index] = std::vector<bool>(first, first + p.size());
      for (Eigen::Index e = 0; e < p.size(); ++e) window_too_small |= p.elements[e].outermost && first[e];
    }
    if (window_too_small) {
      if (window > largest_window)
        throw InputError(
            fmt::format("mesh phase {:.4f}: under {:.4g} N the flanks touch over more than {} Hertz half-widths to "
                        "either side: the displacements are not small; {}",
                        phase, whole_load, largest_window, remedy));
      window *= 1.5;
      continue;
    }
    const auto proof = prove_omissions(bodies_, setup, cycle, solution, range_.gap_beyond);
    if (!proof.not_apart.empty()) {
      const auto before = added.size();
      added.insert(proof.not_apart.begin(), proof.not_apart.end());
      if (added.size() > before) continue;
      throw InputError(fmt::format(
          "mesh phase {:.4f}: under {:.4g} N two tips touch that overlap by less than a pressure element; {}", phase,
          whole_load, remedy));
    }
    if (proof.closest_approach >= range_.gap_beyond)
      throw InputError(
          fmt::format("mesh phase {:.4f}: under {:.4g} N flanks approach each other by {:.4g} mm; contacts are "
                      "searched up to a gap of {:.4g} mm without load; {}",
                      phase, whole_load, 1e3 * proof.closest_approach, 1e3 * range_.gap_beyond, remedy));
    LoadedPosition position = evaluate(bodies_, setup, problem, solution);
    if (forces != nullptr) *forces = port_forces(bodies_, setup, cycle, solution);
    position.mesh_phase = phase;
    position.ring_tooth = cycle;
    position.reciprocity_relative = setup.asymmetry;
    position.pinion_angle = pinion_angle(bodies_, setup);
    position.ring_angle = pitch_point_angle(face_.flanks(), setup.pairs.front().index, setup.pairs.front().roll, cycle);
    if (half_face_) unfold(position, 2 * face_.slice_edges().back());
    return position;
  }
}

}  // namespace annulus::fem
