#include "fem/contact/contact_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/errors.h"
#include "fem/problem/solved_face.h"

namespace annulus::fem {

double hertz_half_width(double line_load, double relative_curvature, const Material& material) {
  const double modulus = material.youngs_modulus / (2 * (1 - material.poisson_ratio * material.poisson_ratio));
  return std::sqrt(4 * line_load / (M_PI * modulus * relative_curvature));
}

/// One tooth pair that may touch: its window, cut into pressure elements, on both flanks.
struct ContactSystem::Pair {
  int index = 0;    ///< number of the pair, and of the planet's tooth in cycle 0
  double roll = 0;  ///< theoretical contact on the planet
  double smallest_gap = std::numeric_limits<double>::infinity();
  FlankPatch planet, wheel;  ///< the same elements on both
  struct Element {
    double gap = 0;                      ///< mean, m
    double roll_low = 0, roll_high = 0;  ///< on the planet, m
    double area = 0;                     ///< m^2
    double distance = 0;                 ///< from the centre of the window, m
    bool tip_edge = false;               ///< ends at the end of a flank
    bool outermost = false;              ///< ends where the window does: has to stay free
  };
  std::vector<Element> elements;
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(elements.size()); }
};

/// Two flanks facing each other over some slices, in which the theoretical contact stands at the same place.
struct ContactSystem::Facing {
  int pair = 0;
  double pair_roll = 0, roll = 0;  ///< theoretical contact on the planet: of the pair, and in these slices
  FlankContact::Interval domain;
  double centre_roll = 0;   ///< where the flanks are nearest
  double gap = 0;           ///< m, there, along the normal; without the lead's
  std::vector<int> slices;  ///< all of a spur gear, one of a helical one
};

/// All pairs of one phase and load, and what they have in common in every mesh cycle.
struct ContactSystem::Pairs {
  double phase = 0, load = 0, window = 0;
  double reach = 0;  ///< m, transmission error: flanks further apart than the nearest ones by more are left out
  double nearest_left_out = std::numeric_limits<double>::infinity();  ///< m, further apart than the nearest ones
  std::vector<Pair> pairs;
  std::vector<Eigen::Index> start;  ///< first unknown of every pair
  Eigen::Index contacts = 0;        ///< number of unknown contact forces
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
      options_(options),
      normal_factor_(std::cos(flanks.pair().planet().base_helix_angle())),
      roll_per_z_(roll_per_z(flanks)) {
  const double width = slice_edges_.back() - slice_edges_.front();
  for (std::size_t s = 0; s + 1 < slice_edges_.size(); ++s) {
    const auto gap = [&](double z) {
      return flanks_.planet().lead_modification(z) + flanks_.wheel().lead_modification(z) +
             options_.misalignment * (z / width - 0.5);
    };
    // Without load the flanks touch where the gap is smallest, not where its mean is: a convex curve has one such
    // place.
    const double low = slice_edges_[s], high = slice_edges_[s + 1];
    const double inside = boost::math::tools::brent_find_minima(gap, low, high, 30).second;
    smallest_lead_gap_.push_back(std::min({gap(low), gap(high), inside}));
    lead_gap_.push_back(boost::math::quadrature::gauss<double, 7>::integrate(gap, low, high) / (high - low));
  }
}

double ContactSystem::half_width(const FlankContact& flanks, double roll, double line_load, const Material& material) {
  const double within = std::clamp(roll, flanks.pair().roll_length_low(), flanks.pair().roll_length_high());
  const double normal_factor = std::cos(flanks.pair().planet().base_helix_angle());
  return hertz_half_width(line_load, normal_factor * flanks.relative_curvature(within), material);
}

double ContactSystem::shortest_element(const Pair& pair, double arc) const {
  const double planet = planet_.shortest_element(pair.index, arc);
  if (planet == 0) return 0;
  const double roll = std::sqrt(2 * flanks_.pair().planet().base_radius() * std::max(arc, 0.0));
  const double opposite = flanks_.match(roll, pair.roll).wheel_roll;
  const double wheel_arc = opposite * opposite / (2 * flanks_.pair().wheel().base_radius());
  return std::max(planet, wheel_.shortest_element(wheel_tooth(pair.index, 0), wheel_arc));
}

std::vector<double> ContactSystem::element_edges(const Pair& pair, double centre, double direction, double half,
                                                 int per_side) const {
  std::vector<double> edges = {0};
  if (shortest_element(pair, centre) == 0) {
    // Shortest at the centre, where pairs that carry little have all their contact.
    for (int i = 1; i <= per_side; ++i) {
      const double t = static_cast<double>(i) / per_side;
      edges.push_back(half * t * (options_.first + (1 - options_.first) * t));
    }
    return edges;
  }
  // Elements shorter than cells would make the compliance singular: a window that a tip edge cuts short has fewer of
  // them, and beyond the finely meshed part they grow with the cells.
  while (edges.back() < half) {
    const double first_guess = shortest_element(pair, centre + direction * edges.back());
    const double middle = std::min(half, edges.back() + first_guess / 2);
    edges.push_back(edges.back() + shortest_element(pair, centre + direction * middle));
  }
  // The last one ends at the end: by stretching or by squeezing all a little.
  if (edges.size() > 2 && edges.back() - half > half - edges[edges.size() - 2]) edges.pop_back();
  const double stretch = half / edges.back();
  for (double& edge : edges) edge *= stretch;
  return edges;
}

void ContactSystem::add_elements(Pair& pair, const Facing& facing, double load, double window) const {
  const auto& domain = facing.domain;
  const double roll = facing.roll, centre_roll = facing.centre_roll;
  const double width = slice_edges_.back() - slice_edges_.front();
  const double base = flanks_.pair().planet().base_radius(), wheel_base = flanks_.pair().wheel().base_radius();
  const double half_width = ContactSystem::half_width(flanks_, roll, load / width, material_);
  const auto arc_of = [&](double planet_roll) { return planet_roll * planet_roll / (2 * base); };
  const auto roll_of = [&](double arc) {
    return std::clamp(std::sqrt(2 * base * std::max(arc, 0.0)), domain.low, domain.high);
  };
  const double centre = arc_of(centre_roll), half = window * half_width;
  // As many elements in a window that a tip edge cuts short as in a whole one: as the teeth move on, the elements
  // change their lengths continuously, and so does the result.
  const int per_side = static_cast<int>(std::ceil(options_.elements * std::max(1.0, window / options_.window)));
  const double low_room = centre - arc_of(domain.low), high_room = arc_of(domain.high) - centre;
  // Of a half-width, and of an element: no place for elements.
  const double negligible = std::max(0.02 * half_width, 0.5 * shortest_element(pair, centre));
  const double low_half = low_room < negligible ? 0 : std::min(half, low_room);
  const double high_half = high_room < negligible ? 0 : std::min(half, high_room);
  if (low_half == 0 && high_half == 0) return;  // two tips that barely reach each other
  std::vector<double> edges;
  if (low_half > 0) {
    const auto down = element_edges(pair, centre, -1, low_half, per_side);
    for (auto edge = down.rbegin(); edge + 1 != down.rend(); ++edge) edges.push_back(centre - *edge);
  }
  edges.push_back(low_half > 0 ? (high_half > 0 ? centre : arc_of(domain.high)) : arc_of(domain.low));
  if (high_half > 0) {
    const auto up = element_edges(pair, centre, 1, high_half, per_side);
    for (auto edge = up.begin() + 1; edge != up.end(); ++edge) edges.push_back(centre + *edge);
  }

  const int first_load = static_cast<int>(pair.planet.loads.size());
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const double low = edges[e], high = edges[e + 1];
    Pair::Element element;
    element.roll_low = roll_of(low);
    element.roll_high = roll_of(high);
    element.distance = (low + high) / 2 - centre;
    const bool first = e == 0, last = e + 2 == edges.size();
    const bool low_cut = low_half < half, high_cut = high_half < half;
    element.tip_edge = (first && low_cut) || (last && high_cut);
    element.outermost = (first && !low_cut) || (last && !high_cut);
    double gap = 0, wheel_arc = 0, wheel_low = 0, wheel_high = 0;
    using Rule = boost::math::quadrature::gauss<double, 2>;  // of a parabola the very mean
    for (std::size_t q = 0; q < Rule::abscissa().size(); ++q)
      for (const double side : {-1.0, 1.0}) {
        const double weight = Rule::weights()[q] / 2;
        const auto match =
            flanks_.match(roll_of((low + high) / 2 + side * Rule::abscissa()[q] * (high - low) / 2), roll);
        gap += weight * match.gap;
        const double arc = match.wheel_roll * match.wheel_roll / (2 * wheel_base);
        wheel_arc += weight * arc;
        if (q + 1 == Rule::abscissa().size()) (side < 0 ? wheel_low : wheel_high) = arc;
      }
    pair.planet.loads.push_back(planet_.make_load(pair.index, (low + high) / 2, (high - low) / 2));
    pair.wheel.loads.push_back(wheel_.make_load(wheel_tooth(pair.index, 0), wheel_arc,
                                                std::abs(wheel_high - wheel_low) / 2 / Rule::abscissa().back()));
    for (const int s : facing.slices) {
      element.gap = normal_factor_ * gap + lead_gap_[s];
      element.area = (high - low) * (slice_edges_[s + 1] - slice_edges_[s]) / normal_factor_;
      pair.elements.push_back(element);
      const FlankPatch::Element of_patch{first_load + static_cast<int>(e), s};
      pair.planet.elements.push_back(of_patch);
      pair.wheel.elements.push_back(of_patch);
    }
  }
  for (const int s : facing.slices) pair.smallest_gap = std::min(pair.smallest_gap, gap_without_load(facing, s));
}

std::vector<std::pair<int, double>> ContactSystem::candidate_pairs(const FlankContact& flanks, double phase) {
  const auto& pair = flanks.pair();
  const double pitch = pair.planet().base_pitch();
  // Along the path the contact of a tooth moves from the planet's root to its tip in the ring mesh (planet drives) and
  // from tip to root in the sun mesh (sun drives).
  const double direction = pair.internal() ? 1 : -1;
  const double reference = pair.roll_length_pitch() + direction * phase * pitch;
  // Under load teeth meet before and after the theoretical path: look one base pitch beyond both its ends. The ends of
  // helical teeth are ahead of their middle, and behind it.
  const double ahead = std::abs(roll_per_z(flanks)) * pair.planet().parameters().face_width / 2;
  const int first = static_cast<int>(std::ceil((pair.roll_length_low() - ahead - reference) / pitch - 1));
  const int last = static_cast<int>(std::floor((pair.roll_length_high() + ahead - reference) / pitch + 1));
  std::vector<std::pair<int, double>> pairs;
  for (int k = first; k <= last; ++k) {
    const double roll = reference + k * pitch;
    if (ahead > 0 || roll > 0) pairs.emplace_back(k, roll);
  }
  return pairs;
}

std::vector<std::pair<int, double>> ContactSystem::possible_pairs(const FlankContact& flanks, double phase) {
  auto pairs = candidate_pairs(flanks, phase);
  const auto apart = [&](const auto& pair) { return roll_per_z(flanks) == 0 && flanks.domain(pair.second).empty(); };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), apart), pairs.end());
  require(!pairs.empty(), "no tooth pair faces another");
  return pairs;
}

double ContactSystem::roll_per_z(const FlankContact& flanks) {
  return flanks.planet().twist() * flanks.pair().planet().base_radius();
}

double ContactSystem::slice_roll(int slice) const {
  const double middle = (slice_edges_.front() + slice_edges_.back()) / 2;
  return roll_per_z_ * ((slice_edges_[slice] + slice_edges_[slice + 1]) / 2 - middle);
}

double ContactSystem::gap_without_load(const Facing& facing, int slice) const {
  return (facing.gap + smallest_lead_gap_[slice]) / normal_factor_;
}

double ContactSystem::beyond_path(double roll) const {
  const auto& pair = flanks_.pair();
  return roll < pair.roll_length_low() ? roll - pair.roll_length_low() : std::max(0.0, roll - pair.roll_length_high());
}

std::vector<ContactSystem::Facing> ContactSystem::find_facing(double phase) const {
  std::vector<Facing> result;
  for (const auto& [index, roll] : candidate_pairs(flanks_, phase)) {
    Facing facing;
    facing.pair = index;
    facing.pair_roll = facing.roll = roll;
    // The section of a helical gear turns along the face width, and the contact moves with it.
    if (roll_per_z_ == 0) {
      facing.slices.resize(planet_.slices());
      std::iota(facing.slices.begin(), facing.slices.end(), 0);
      result.push_back(std::move(facing));
    } else {
      for (int s = 0; s < planet_.slices(); ++s) {
        facing.roll = roll + slice_roll(s);
        facing.slices = {s};
        result.push_back(facing);
      }
    }
  }
  return result;
}

void ContactSystem::find_pairs(Pairs& setup) const {
  auto all = find_facing(setup.phase);
  std::vector<std::size_t> outwards(all.size());
  std::iota(outwards.begin(), outwards.end(), std::size_t{0});
  std::stable_sort(outwards.begin(), outwards.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(beyond_path(all[a].roll)) < std::abs(beyond_path(all[b].roll));
  });
  const double least_lead_gap = *std::min_element(smallest_lead_gap_.begin(), smallest_lead_gap_.end());
  double least = std::numeric_limits<double>::infinity();
  bool apart_before = false, apart_behind = false;
  for (const std::size_t i : outwards) {
    auto& f = all[i];
    // Beyond either end of the path flanks get further apart all the way.
    const double beyond = beyond_path(f.roll);
    if (beyond < 0 ? apart_before : beyond > 0 && apart_behind) continue;
    f.domain = flanks_.domain(f.roll);
    if (f.domain.empty()) continue;
    f.centre_roll = flanks_.nearest_roll(f.roll, f.domain);
    f.gap = normal_factor_ * flanks_.match(f.centre_roll, f.roll).gap;
    for (const int s : f.slices) least = std::min(least, gap_without_load(f, s));
    const double further = (f.gap + least_lead_gap) / normal_factor_ - least;
    if (beyond == 0 || further <= setup.reach) continue;
    (beyond < 0 ? apart_before : apart_behind) = true;
    setup.nearest_left_out = std::min(setup.nearest_left_out, further);
  }
  require(std::isfinite(least), "no tooth pair faces another");
  for (auto& f : all) {
    if (f.domain.empty()) continue;
    std::vector<int> near;
    for (const int s : f.slices) {
      const double further = gap_without_load(f, s) - least;
      if (further <= setup.reach)
        near.push_back(s);
      else
        setup.nearest_left_out = std::min(setup.nearest_left_out, further);
    }
    if (near.empty()) continue;
    f.slices = std::move(near);
    if (setup.pairs.empty() || setup.pairs.back().index != f.pair) {
      setup.pairs.emplace_back();
      setup.pairs.back().index = f.pair;
      setup.pairs.back().roll = f.pair_roll;
    }
    add_elements(setup.pairs.back(), f, setup.load, setup.window);
  }
  const auto empty = [](const Pair& p) { return p.elements.empty(); };
  setup.pairs.erase(std::remove_if(setup.pairs.begin(), setup.pairs.end(), empty), setup.pairs.end());
  for (auto& p : setup.pairs) {
    planet_.find_weights(p.planet, p.index);
    wheel_.find_weights(p.wheel, wheel_tooth(p.index, 0));
  }
}

int ContactSystem::wheel_tooth(const FlankContact& flanks, int index, int cycle) {
  return flanks.pair().internal() ? index - cycle : -(index + cycle);
}

int ContactSystem::wheel_tooth(int index, int cycle) const { return wheel_tooth(flanks_, index, cycle); }

ContactSystem::PairsCache ContactSystem::prepare(double phase, double load, double window, double reach) const {
  auto result = std::make_shared<Pairs>();
  result->phase = phase;
  result->load = load;
  result->window = window;
  result->reach = reach;
  find_pairs(*result);
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
    const int tooth = wheel_tooth(p.index, 0);
    for (std::size_t j = 0; j <= i; ++j) {
      const auto& o = pairs[j];
      const int other = wheel_tooth(o.index, 0);
      // Both directions are formed on their own: what they differ by measures reciprocity (Betti). Of a pair with
      // itself they are the same.
      const Eigen::MatrixXd block =
          planet_.compliance(p.planet, p.index, o.planet, o.index) + wheel_.compliance(p.wheel, tooth, o.wheel, other);
      const Eigen::MatrixXd opposite = i == j ? block
                                              : planet_.compliance(o.planet, o.index, p.planet, p.index) +
                                                    wheel_.compliance(o.wheel, other, p.wheel, tooth);
      result->asymmetry = std::max(result->asymmetry,
                                   (block - opposite.transpose()).cwiseAbs().maxCoeff() / block.cwiseAbs().maxCoeff());
      const Eigen::MatrixXd mean = (block + opposite.transpose()) / 2;
      compliance.block(start[i], start[j], size, block.cols()) = mean;
      compliance.block(start[j], start[i], block.cols(), size) = mean.transpose();
    }
    compliance.block(start[i], start[i], size, size) += planet_.near_field(p.planet) + wheel_.near_field(p.wheel);
  }
  return result;
}

ComplementarityProblem ContactSystem::assemble(const Pairs& setup, int cycle) const {
  const Eigen::Index contacts = setup.contacts, support_forces = supports_ != nullptr ? supports_->size() : 0;
  const Eigen::Index n = contacts + support_forces, motions = supports_ != nullptr ? supports_->rigid_motions() : 0;
  ComplementarityProblem problem;
  problem.compliance = Eigen::MatrixXd::Zero(n, n);
  problem.compliance.topLeftCorner(contacts, contacts) = setup.compliance;
  problem.gap = Eigen::VectorXd::Zero(n);
  problem.rigid = Eigen::MatrixXd::Zero(n, 1 + motions);
  problem.rigid.col(0).head(contacts).setConstant(normal_factor_);
  problem.load = Eigen::VectorXd::Zero(problem.rigid.cols());
  problem.load[0] = setup.load;
  problem.unilateral.assign(n, true);
  for (std::size_t i = 0; i < setup.pairs.size(); ++i)
    for (Eigen::Index e = 0; e < setup.pairs[i].size(); ++e)
      problem.gap[setup.start[i] + e] = setup.pairs[i].elements[e].gap;
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
    const int slice = pair.wheel.elements[i].slice;
    const double z = (slice_edges_[slice] + slice_edges_[slice + 1]) / 2;
    all.row(i).tail<2>() << -z * plane(i, 1), z * plane(i, 0);
  }
  return all;
}

LoadedPosition ContactSystem::solve(int cycle, double phase, double whole_load, PairsCache& cache, WarmStart& warm,
                                    ContactForces* forces) const {
  const double load = options_.half_face ? whole_load / 2 : whole_load;
  if (!cache || cache->phase != phase || cache->load != load) {
    // Softer than most meshes (steel: 4 N/(mm um), a third of what ISO 6336-1 gives teeth); where one gives way more
    // still, pairs are looked for again.
    const double width = slice_edges_.back() - slice_edges_.front();
    const double soft_mesh = 0.02 * material_.youngs_modulus;  // N/m per m of face width
    const bool same_load = cache && cache->load == load;
    cache = prepare(phase, load, options_.window, same_load ? cache->reach : load / width / soft_mesh);
  }
  // Pairs whose flanks all but touch without load: the first guess of what carries, no more.
  const double touching = 2.5e-7 * flanks_.pair().planet().parameters().module;
  constexpr double largest_window = 12;  // in Hertz half-widths: longer than any flank at a sensible load
  for (;;) {
    const Pairs& setup = *cache;
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
      if (setup.window > largest_window)
        throw InputError(fmt::format(
            "mesh phase {:.4f}: under {:.4g} N the flanks touch over more than {} Hertz half-widths to either side: "
            "they give way by more than small displacements; reduce the load, or make teeth, rim, supports or "
            "material stiffer",
            phase, whole_load, largest_window));
      cache = prepare(phase, load, 1.5 * setup.window, setup.reach);
      continue;
    }
    // What is further apart than the nearest flanks give way stays so; the tenth is for forces that pull it nearer.
    double least_gap = std::numeric_limits<double>::infinity();
    for (const auto& p : setup.pairs) least_gap = std::min(least_gap, p.smallest_gap);
    const double given_way = solution.rigid[0] - least_gap;
    if (1.1 * given_way > setup.nearest_left_out) {
      cache = prepare(phase, load, setup.window, 1.5 * given_way);
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
    if (options_.half_face) unfold(position, 2 * slice_edges_.back());
    return position;
  }
}

ContactForces ContactSystem::port_forces(const Pairs& setup, int cycle, const ComplementaritySolution& solution) const {
  ContactForces result;
  for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
    const auto& p = setup.pairs[i];
    const Eigen::VectorXd force = solution.force.segment(setup.start[i], p.size());
    if ((force.array() == 0).all()) continue;
    result.planet.push_back({p.index, planet_.port_weights(p.planet) * force});
    result.wheel.push_back({wheel_tooth(p.index, cycle), wheel_.port_weights(p.wheel) * force});
  }
  if (supports_ != nullptr) {
    result.supports = solution.force.tail(supports_->size());
    result.rigid = solution.rigid.tail(supports_->rigid_motions());
    result.rigid.tail(result.rigid.size() - 2) /= flanks_.pair().wheel().reference_radius();
  }
  return result;
}

LoadedPosition ContactSystem::evaluate(const Pairs& setup, const ComplementarityProblem& problem,
                                       const ComplementaritySolution& solution) const {
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
  const double width = slice_edges_.back() - slice_edges_.front();
  result.line_load.assign(planet_.slices(), 0.0);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    const Eigen::VectorXd force = solution.force.segment(at, p.size());
    moment -= (planet_.resultants(p.planet, p.index).col(2)).dot(force);
    result.pair_share.push_back(normal_factor_ * force.sum() / load);
    result.pair_roll.push_back(p.roll);
    for (Eigen::Index e = 0; e < p.size(); ++e) {
      if (force[e] <= 0) continue;
      const auto& element = p.elements[e];
      const int s = p.planet.elements[e].slice;
      const double length = slice_edges_[s + 1] - slice_edges_[s], pressure = force[e] / element.area;
      result.line_load[s] += normal_factor_ * force[e] / length;
      result.pressure.push_back(
          {static_cast<int>(i), slice_edges_[s], slice_edges_[s + 1], element.roll_low, element.roll_high, pressure});
      if (pressure <= result.max_pressure) continue;
      result.max_pressure = pressure;
      result.tip_edge_contact = element.tip_edge;
    }
    at += p.size();
  }
  result.face_load_factor = *std::max_element(result.line_load.begin(), result.line_load.end()) / (load / width);
  const double torque = load * flanks_.pair().planet().base_radius();
  result.force_balance_relative = std::abs(moment - torque) / torque;
  const double stored = solution.force.dot(problem.compliance * solution.force);
  const double against_gaps = solution.force.dot(problem.gap), work = load * result.entry.lte;
  // A crooked lead can make the transmission error, and with it the work, nothing or negative; the energy is neither.
  result.energy_balance_relative = std::abs(work - stored - against_gaps) / std::max(std::abs(work), stored);
  result.max_penetration = std::max(0.0, -solution.gap.minCoeff());
  if (supports_ != nullptr) supports_->fill_states(solution.force.tail(supports_->size()), result);
  return result;
}

}  // namespace annulus::fem
