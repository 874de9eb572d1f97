#include "fem/contact/contact_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

double hertz_half_width(double line_load, double relative_curvature, const Material& material) {
  const double modulus = material.youngs_modulus / (2 * (1 - material.poisson_ratio * material.poisson_ratio));
  return std::sqrt(4 * line_load / (M_PI * modulus * relative_curvature));
}

/// One tooth pair that may touch: its window, cut into pressure elements, on both flanks.
struct ContactSystem::Pair {
  int index = 0;    ///< number of the pair, and of the planet's tooth in cycle 0
  double roll = 0;  ///< theoretical contact on the planet
  double smallest_gap = 0;
  bool low_is_edge = false, high_is_edge = false;  ///< the window ends at the end of a flank
  Eigen::VectorXd gap, length;                     ///< per element: mean gap (m), arc length (m)
  ContactBody::Weights planet, wheel;
  std::vector<std::vector<double>> planet_rolls, wheel_rolls, weights;  ///< quadrature points behind the elements
};

/// All pairs of one phase and load, and what they have in common in every mesh cycle.
struct ContactSystem::Pairs {
  double phase = 0, load = 0, window = 0;
  std::vector<Pair> pairs;
  std::vector<Eigen::Index> start;  ///< first unknown of every pair
  Eigen::Index contacts = 0;        ///< number of unknown contact forces, [pair][element][slice]
  Eigen::MatrixXd compliance;       ///< contacts x contacts
  double asymmetry = 0;             ///< of the compliance, formed in both directions
};

ContactSystem::ContactSystem(const FlankContact& flanks, const ContactBody& planet, const ContactBody& wheel,
                             const SupportRow* supports, const Material& material, std::vector<double> slice_edges,
                             ContactOptions options)
    : flanks_(flanks),
      planet_(planet),
      wheel_(wheel),
      supports_(supports),
      material_(material),
      slice_edges_(std::move(slice_edges)),
      options_(options) {}

std::vector<ContactSystem::Pair> ContactSystem::find_pairs(double phase, double load, double window) const {
  const auto& pair = flanks_.pair();
  const double pitch = pair.planet().base_pitch();
  const double width = slice_edges_.back() - slice_edges_.front();
  // Along the path the contact of a tooth moves from the planet's root to its tip in the ring mesh (planet drives) and
  // from tip to root in the sun mesh (sun drives).
  const double direction = pair.internal() ? 1 : -1;
  const double reference = pair.roll_length_pitch() + direction * phase * pitch;
  // Under load teeth meet before and after the theoretical path: look one base pitch beyond both its ends.
  const int first = static_cast<int>(std::ceil((pair.roll_length_low() - reference) / pitch - 1));
  const int last = static_cast<int>(std::floor((pair.roll_length_high() - reference) / pitch + 1));
  std::vector<Pair> pairs;
  for (int k = first; k <= last; ++k) {
    Pair p;
    p.roll = reference + k * pitch;
    if (p.roll <= 0) continue;
    const auto domain = flanks_.domain(p.roll);
    if (domain.empty()) continue;
    p.index = k;
    const double centre = flanks_.nearest_roll(p.roll);
    p.smallest_gap = flanks_.match(centre, p.roll).gap;
    const double base = pair.planet().base_radius();
    const double half_width = hertz_half_width(
        load / width, flanks_.relative_curvature(std::clamp(p.roll, pair.roll_length_low(), pair.roll_length_high())),
        material_);
    const double half = window * half_width * base / centre;  // arc length s = rho^2 / (2 r_b)
    const double low = std::max(centre - half, domain.low), high = std::min(centre + half, domain.high);
    p.low_is_edge = low == domain.low;
    p.high_is_edge = high == domain.high;
    const double wanted = (high * high - low * low) / (2 * base) / options_.element;
    const int elements = std::max(1, static_cast<int>(std::lround(wanted)));

    p.gap.resize(elements);
    p.length.resize(elements);
    p.planet = ContactBody::Weights::Zero(planet_.body().flank.size(), elements);
    p.wheel = ContactBody::Weights::Zero(wheel_.body().flank.size(), elements);
    p.planet_rolls.resize(elements);
    p.wheel_rolls.resize(elements);
    p.weights.resize(elements);
    const auto add = [](ContactBody::Weights& weights, int e, const TraceBasis& basis, double roll, double weight) {
      const auto values = basis(std::clamp(roll, basis.low(), basis.high()));
      for (std::size_t i = 0; i < values.weights.size(); ++i)
        weights(values.first + static_cast<int>(i), e) += weight * values.weights[i];
    };
    for (int e = 0; e < elements; ++e) {
      const double a = low + (high - low) * e / elements, b = low + (high - low) * (e + 1) / elements;
      p.length[e] = (b * b - a * a) / (2 * base);
      p.gap[e] = 0;
      using Rule = boost::math::quadrature::gauss<double, 4>;
      for (std::size_t q = 0; q < Rule::abscissa().size(); ++q)
        for (const double side : {-1.0, 1.0}) {
          const double roll = (a + b) / 2 + side * Rule::abscissa()[q] * (b - a) / 2;
          const double weight = Rule::weights()[q] * (b - a) / 2 * roll / base / p.length[e];
          const auto match = flanks_.match(roll, p.roll);
          p.gap[e] += weight * match.gap;
          add(p.planet, e, planet_.body().flank, roll, weight);
          add(p.wheel, e, wheel_.body().flank, match.wheel_roll, weight);
          p.planet_rolls[e].push_back(roll);
          p.wheel_rolls[e].push_back(match.wheel_roll);
          p.weights[e].push_back(weight);
        }
    }
    pairs.push_back(std::move(p));
  }
  require(!pairs.empty(), "no tooth pair faces another");
  return pairs;
}

int ContactSystem::wheel_tooth(int index, int cycle) const {
  return flanks_.pair().internal() ? index - cycle : -(index + cycle);
}

ContactSystem::PairsCache ContactSystem::prepare(double phase, double load, double window) const {
  const int slices = planet_.slices();
  auto result = std::make_shared<Pairs>();
  result->phase = phase;
  result->load = load;
  result->window = window;
  result->pairs = find_pairs(phase, load, window);
  const auto& pairs = result->pairs;
  auto& start = result->start;
  for (const auto& p : pairs) {
    start.push_back(result->contacts);
    result->contacts += p.gap.size() * slices;
  }
  auto& compliance = result->compliance;
  compliance = Eigen::MatrixXd::Zero(result->contacts, result->contacts);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    const Eigen::Index size = p.gap.size() * slices;
    const int tooth = wheel_tooth(p.index, 0);
    for (std::size_t j = 0; j <= i; ++j) {
      const auto& o = pairs[j];
      const int other = wheel_tooth(o.index, 0);
      // Both directions are formed on their own: what they differ by measures reciprocity (Betti).
      const Eigen::MatrixXd block =
          planet_.compliance(p.planet, p.index, o.planet, o.index) + wheel_.compliance(p.wheel, tooth, o.wheel, other);
      const Eigen::MatrixXd opposite =
          planet_.compliance(o.planet, o.index, p.planet, p.index) + wheel_.compliance(o.wheel, other, p.wheel, tooth);
      result->asymmetry = std::max(result->asymmetry,
                                   (block - opposite.transpose()).cwiseAbs().maxCoeff() / block.cwiseAbs().maxCoeff());
      compliance.block(start[i], start[j], size, block.cols()) = (block + opposite.transpose()) / 2;
      compliance.block(start[j], start[i], block.cols(), size) =
          compliance.block(start[i], start[j], size, block.cols()).transpose();
    }
    compliance.block(start[i], start[i], size, size) +=
        planet_.near_field(p.planet_rolls, p.weights) + wheel_.near_field(p.wheel_rolls, p.weights);
  }
  return result;
}

ComplementarityProblem ContactSystem::assemble(const Pairs& setup, int cycle) const {
  const int slices = planet_.slices();
  const Eigen::Index contacts = setup.contacts, support_forces = supports_ != nullptr ? supports_->size() : 0;
  const Eigen::Index n = contacts + support_forces, motions = supports_ != nullptr ? supports_->rigid_motions() : 0;
  ComplementarityProblem problem;
  problem.compliance = Eigen::MatrixXd::Zero(n, n);
  problem.compliance.topLeftCorner(contacts, contacts) = setup.compliance;
  problem.gap = Eigen::VectorXd::Zero(n);
  problem.rigid = Eigen::MatrixXd::Zero(n, 1 + motions);
  problem.rigid.col(0).head(contacts).setOnes();
  problem.load = Eigen::VectorXd::Zero(problem.rigid.cols());
  problem.load[0] = setup.load;
  problem.unilateral.assign(n, true);
  for (std::size_t i = 0; i < setup.pairs.size(); ++i)
    for (Eigen::Index e = 0; e < setup.pairs[i].gap.size(); ++e)
      problem.gap.segment(setup.start[i] + e * slices, slices).setConstant(setup.pairs[i].gap[e]);
  if (supports_ == nullptr) return problem;

  problem.compliance.bottomRightCorner(support_forces, support_forces) = supports_->compliance();
  for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
    const auto& p = setup.pairs[i];
    const int tooth = wheel_tooth(p.index, cycle);
    const Eigen::MatrixXd coupling = supports_->at_ports(tooth, wheel_.port_weights(p.wheel));
    problem.compliance.block(setup.start[i], contacts, coupling.rows(), support_forces) = coupling;
    problem.compliance.block(contacts, setup.start[i], support_forces, coupling.rows()) = coupling.transpose();
    problem.rigid.block(setup.start[i], 1, coupling.rows(), motions) = -wheel_resultants(p, tooth).leftCols(motions);
  }
  problem.rigid.block(contacts, 1, support_forces, motions) = -supports_->resultants();
  // Makes rotations displacements.
  problem.rigid.rightCols(motions - 2) /= flanks_.pair().wheel().reference_radius();
  problem.gap.tail(support_forces) = supports_->gap();
  std::copy(supports_->unilateral().begin(), supports_->unilateral().end(), problem.unilateral.begin() + contacts);
  return problem;
}

Eigen::MatrixXd ContactSystem::wheel_resultants(const Pair& pair, int tooth) const {
  const Eigen::MatrixXd plane = wheel_.resultants(pair.wheel, tooth);
  Eigen::MatrixXd all(plane.rows(), 5);
  all.leftCols(3) = plane;
  for (Eigen::Index i = 0; i < plane.rows(); ++i) {
    const auto slice = i % planet_.slices();
    const double z = (slice_edges_[slice] + slice_edges_[slice + 1]) / 2;
    all.row(i).tail<2>() << -z * plane(i, 1), z * plane(i, 0);
  }
  return all;
}

LoadedPosition ContactSystem::solve(int cycle, double phase, double load, PairsCache& cache, WarmStart& warm,
                                    ContactForces* forces) const {
  const int slices = planet_.slices();
  if (!cache || cache->phase != phase || cache->load != load) cache = prepare(phase, load, options_.window);
  constexpr double largest_window = 12;  // in Hertz half-widths: longer than any flank at a sensible load
  for (;;) {
    const Pairs& setup = *cache;
    const ComplementarityProblem problem = assemble(setup, cycle);
    std::vector<bool> guess(problem.gap.size(), true);
    for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
      const auto& p = setup.pairs[i];
      const Eigen::Index size = p.gap.size() * slices;
      const auto known = warm.find(p.index);
      const bool reuse = known != warm.end() && static_cast<Eigen::Index>(known->second.size()) == size;
      for (Eigen::Index e = 0; e < size; ++e)
        guess[setup.start[i] + e] =
            reuse ? known->second[e] : p.smallest_gap < 1e-9 && std::abs(e - size / 2) < size / 4;
    }
    const auto solution = solve_complementarity(problem, std::move(guess));
    warm.clear();
    bool window_too_small = false;
    for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
      const auto& p = setup.pairs[i];
      const Eigen::Index size = p.gap.size() * slices;
      const auto first = solution.active.begin() + setup.start[i];
      warm[p.index] = std::vector<bool>(first, first + size);
      for (int s = 0; s < slices; ++s)
        window_too_small |= (!p.low_is_edge && first[s]) || (!p.high_is_edge && first[size - slices + s]);
    }
    if (window_too_small) {
      if (setup.window > largest_window)
        throw SolverError(
            fmt::format("mesh phase {:.4f}: the contact at {:.4g} N does not fit its window", phase, load));
      cache = prepare(phase, load, 1.5 * setup.window);
      continue;
    }
    LoadedPosition position = evaluate(setup, problem, solution);
    if (forces != nullptr) *forces = port_forces(setup, cycle, solution);
    position.mesh_phase = phase;
    position.ring_tooth = cycle;
    position.reciprocity_relative = setup.asymmetry;
    const auto& reference = setup.pairs.front();
    // Angle of the pitch point in the wheel's own frame; the ring mesh is solved in a mirror image of the real one.
    const double tooth = wheel_tooth(reference.index, cycle) * flanks_.pair().wheel().pitch_angle();
    const double angle = flanks_.wheel_tooth_angle(reference.roll) - tooth;
    position.ring_angle = flanks_.pair().internal() ? angle : -angle;
    return position;
  }
}

ContactForces ContactSystem::port_forces(const Pairs& setup, int cycle, const ComplementaritySolution& solution) const {
  ContactForces result;
  for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
    const auto& p = setup.pairs[i];
    const Eigen::VectorXd force = solution.force.segment(setup.start[i], p.gap.size() * planet_.slices());
    if ((force.array() == 0).all()) continue;
    result.planet.push_back({p.index, planet_.port_weights(p.planet) * force});
    result.wheel.push_back({wheel_tooth(p.index, cycle), wheel_.port_weights(p.wheel) * force});
  }
  if (supports_ != nullptr) result.supports = solution.force.tail(supports_->size());
  return result;
}

LoadedPosition ContactSystem::evaluate(const Pairs& setup, const ComplementarityProblem& problem,
                                       const ComplementaritySolution& solution) const {
  const int slices = planet_.slices();
  const auto& pairs = setup.pairs;
  const double load = setup.load;
  LoadedPosition result;
  result.load = load;
  result.entry.lte = solution.rigid[0];
  double unloaded = pairs.front().smallest_gap;
  for (const auto& p : pairs) unloaded = std::min(unloaded, p.smallest_gap);
  result.entry.unloaded_te = unloaded;
  if (!(result.entry.lte > unloaded)) throw SolverError("the loaded transmission error is not positive");
  result.entry.stiffness_secant = load / (result.entry.lte - unloaded);
  result.entry.stiffness_tangent = 1 / solution.tangent(0, 0);

  double moment = 0;
  Eigen::Index at = 0;
  for (const auto& p : pairs) {
    const Eigen::Index size = p.gap.size() * slices;
    const Eigen::VectorXd force = solution.force.segment(at, size);
    moment -= (planet_.resultants(p.planet, p.index).col(2)).dot(force);
    result.pair_share.push_back(force.sum() / load);
    result.pair_roll.push_back(p.roll);
    for (Eigen::Index e = 0; e < p.gap.size(); ++e)
      for (int s = 0; s < slices; ++s) {
        const double pressure = force[e * slices + s] / (p.length[e] * (slice_edges_[s + 1] - slice_edges_[s]));
        if (pressure <= result.max_pressure) continue;
        result.max_pressure = pressure;
        result.tip_edge_contact = (e == 0 && p.low_is_edge) || (e == p.gap.size() - 1 && p.high_is_edge);
      }
    at += size;
  }
  const double torque = load * flanks_.pair().planet().base_radius();
  result.force_balance_relative = std::abs(moment - torque) / torque;
  const double stored = solution.force.dot(problem.compliance * solution.force);
  const double against_gaps = solution.force.dot(problem.gap), work = load * result.entry.lte;
  result.energy_balance_relative = std::abs(work - stored - against_gaps) / work;
  result.max_penetration = std::max(0.0, -solution.gap.minCoeff());
  if (supports_ != nullptr) supports_->fill_states(solution.force.tail(supports_->size()), result);
  return result;
}

}  // namespace annulus::fem
