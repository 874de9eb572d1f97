#include "dynamics/systems/planetary/sharing_tolerances.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "core/errors.h"
#include "core/parallel.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/statistics/sampling.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

namespace {

/// A zone and what the report calls it.
struct Zone {
  const char* name;
  double StageTolerances::*radius;
};
constexpr std::array<Zone, 4> zones = {{{"planet_pin_position", &StageTolerances::planet_pin_position},
                                        {"sun_eccentricity", &StageTolerances::sun_eccentricity},
                                        {"planet_eccentricity", &StageTolerances::planet_eccentricity},
                                        {"ring_eccentricity", &StageTolerances::ring_eccentricity}}};

/// Distance from the centre of a zone of radius 1, below which a deviation lies with this probability.
double distance(WithinZone within, double probability) {
  if (within == WithinZone::uniform) return std::sqrt(probability);
  static const Distribution law{.kind = Distribution::Kind::rayleigh, .low = 0, .high = 1, .scale = 1.0 / 3};
  return law.quantile(probability);
}

Deviation drawn(WithinZone within, double radius, std::uint64_t seed, int assembly, const std::string& name) {
  const auto sample = static_cast<std::uint64_t>(assembly);
  return {radius * distance(within, uniform_draw(seed, sample, name + " distance")),
          2 * std::numbers::pi * uniform_draw(seed, sample, name + " direction")};
}

constexpr int positions = 16;  ///< per mesh cycle

/// Without a drive-line: its shafts change no force of the meshes, and its ripples are no tolerances.
PlanetaryStage at_share(PlanetaryStage stage, double share) {
  stage.rotors.clear();
  stage.sun_torque *= share;
  return stage;
}

PlanetaryStage without_errors(PlanetaryStage stage) {
  stage.sun.errors = stage.ring.errors = stage.carrier.errors = {};
  stage.planet_errors.clear();
  stage.sun_tooth_errors.clear();
  stage.ring_tooth_errors.clear();
  return stage;
}

/// A stage without errors at one torque, mesh cycle by mesh cycle until they repeat: a ring on pins is stiffer at some
/// teeth than at others.
struct PerfectStage {
  explicit PerfectStage(const PlanetaryStage& stage) {
    const auto perfect = without_errors(stage);
    const auto system = assemble(perfect);
    StaticSolver solver(system);
    auto workspace = system.workspace();
    const Eigen::Index planets = perfect.planets();
    for (int cycle = 0; cycle < perfect.error_period(); ++cycle) {
      auto& mean = force.emplace_back(Eigen::VectorXd::Zero(planets));
      auto& response = per_error.emplace_back(Eigen::MatrixXd::Zero(planets, 2 * planets));
      for (int p = 0; p < positions; ++p) {
        (void)solver.solve((cycle + static_cast<double>(p) / positions) / perfect.mesh_frequency(), workspace);
        mean += Eigen::Map<const Eigen::VectorXd>(workspace.force.data(), planets) / positions;
        response += solver.force_per_error(workspace).topLeftCorner(planets, 2 * planets) / positions;
      }
    }
  }
  std::vector<Eigen::VectorXd> force;      ///< N, of the sun meshes, averaged over each mesh cycle
  std::vector<Eigen::MatrixXd> per_error;  ///< N/m, d of it / d errors of all meshes
};

/// The force of every sun mesh over the mesh cycles of the error period, linear in the errors: a sum of terms that
/// repeat after as many cycles as a gear has teeth, or a few times as many.
class LinearForces {
 public:
  LinearForces(const PerfectStage& perfect, const PlanetaryStage& stage)
      : cycles_(std::min(stage.error_period(), most_cycles)) {
    const auto planets = static_cast<std::size_t>(stage.planets());
    const double frequency = stage.mesh_frequency();
    std::map<double, Eigen::VectorXcd> by_rate;
    by_rate.try_emplace(0, Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(2 * planets)));
    for (std::size_t m = 0; m < 2 * planets; ++m) {
      const auto errors = m < planets ? sun_mesh_errors(stage, static_cast<int>(m))
                                      : ring_mesh_errors(stage, static_cast<int>(m - planets));
      for (const auto& error : errors)
        by_rate.try_emplace(error.rate, Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(2 * planets)))
            .first->second[static_cast<Eigen::Index>(m)] += error.amount * std::polar(1.0, error.phase);
    }
    const auto repeat = static_cast<long>(perfect.force.size());
    for (const auto& [rate, amplitudes] : by_rate) {
      const double turn_cycles = rate == 0 ? 1 : 2 * std::numbers::pi * frequency / std::abs(rate);
      const long own = std::max(1L, std::lround(turn_cycles));
      // The housing turns past the carrier of a differential in no whole number of cycles.
      const bool repeats = std::abs(turn_cycles - static_cast<double>(own)) < 1e-6 * turn_cycles;
      auto& term = terms_.emplace_back(stage.planets(), repeats ? std::lcm(repeat, own) : cycles_);
      for (long c = 0; c < term.cols(); ++c) {
        const auto turn = std::polar(1.0, rate * (static_cast<double>(c) + 0.5) / frequency);
        term.col(c) = perfect.per_error[static_cast<std::size_t>(c % repeat)] * (amplitudes * turn).imag();
        if (rate == 0) term.col(c) += perfect.force[static_cast<std::size_t>(c % repeat)];
      }
    }
  }

  /// For each planet the mesh cycle in which it carries most, and that in which it carries the largest part of what
  /// pushing meshes carry together, without repetitions.
  [[nodiscard]] std::set<int> worst_cycles() const {
    const auto planets = static_cast<std::size_t>(terms_.front().rows());
    struct Worst {
      double value = -std::numeric_limits<double>::infinity();
      int cycle = 0;
    };
    std::vector<Worst> largest(planets), largest_part(planets);
    std::vector<Eigen::Index> at(terms_.size(), 0);
    Eigen::VectorXd force;
    for (int c = 0; c < cycles_; ++c) {
      force.setZero(terms_.front().rows());
      for (std::size_t k = 0; k < terms_.size(); ++k) {
        force += terms_[k].col(at[k]);
        if (++at[k] == terms_[k].cols()) at[k] = 0;
      }
      const double pushing = force.cwiseMax(0).sum();
      for (std::size_t n = 0; n < planets; ++n) {
        const double own = force[static_cast<Eigen::Index>(n)];
        if (own > largest[n].value) largest[n] = {own, c};
        if (own > largest_part[n].value * pushing) largest_part[n] = {own / pushing, c};
      }
    }
    std::set<int> worst;
    for (const auto* list : {&largest, &largest_part})
      for (const auto& w : *list) worst.insert(w.cycle);
    return worst;
  }

 private:
  /// Of a longer error period the first part. Three directions that turn then meet within 1/58 of a circle, where a
  /// cosine is 0.15 % below its largest value.
  static constexpr int most_cycles = 200000;
  int cycles_;
  std::vector<Eigen::MatrixXd> terms_;
};

/// The stage without the deviations that are drawn.
PlanetaryStage without_drawn(PlanetaryStage stage, const StageTolerances& tolerances) {
  if (tolerances.sun_eccentricity > 0) stage.sun.errors.eccentricity = {};
  if (tolerances.ring_eccentricity > 0) stage.ring.errors.eccentricity = {};
  for (auto& errors : stage.planet_errors) {
    if (tolerances.planet_pin_position > 0) errors.position = {};
    if (tolerances.planet_eccentricity > 0) errors.eccentricity = {};
  }
  return stage;
}

SharingQuantiles quantiles_of(const std::vector<double>& factors) {
  return {quantile_interval(factors, 0.5), quantile_interval(factors, 0.95), quantile_interval(factors, 0.99)};
}

/// By torque share.
std::vector<PerfectStage> perfect_stages(const PlanetaryStage& stage, const std::vector<double>& torque_shares) {
  std::vector<PerfectStage> list;
  list.reserve(torque_shares.size());
  for (const double share : torque_shares) list.emplace_back(at_share(stage, share));
  return list;
}

ErrorPeriodSharing sharing_of(const std::vector<PerfectStage>& perfect, const PlanetaryStage& stage,
                              const std::vector<double>& torque_shares) {
  ErrorPeriodSharing result;
  const Eigen::Index planets = stage.planets();
  for (std::size_t s = 0; s < torque_shares.size(); ++s) {
    const auto at_torque = at_share(stage, torque_shares[s]);
    const auto system = assemble(at_torque);
    StaticSolver solver(system);
    auto workspace = system.workspace();
    double largest = 0;
    for (const int cycle : LinearForces(perfect[s], at_torque).worst_cycles()) {
      Eigen::VectorXd mean = Eigen::VectorXd::Zero(planets);
      for (int p = 0; p < positions; ++p) {
        (void)solver.solve((cycle + static_cast<double>(p) / positions) / stage.mesh_frequency(), workspace);
        mean += Eigen::Map<const Eigen::VectorXd>(workspace.force.data(), planets) / positions;
      }
      const Eigen::VectorXd force = mean.cwiseAbs();
      largest = std::max(largest, static_cast<double>(planets) * force.maxCoeff() / force.sum());
      result.largest_force = std::max(result.largest_force, force.maxCoeff());
    }
    result.factors.push_back(largest);
  }
  return result;
}

/// K_γ of all assemblies, [torque share][assembly].
struct Drawn {
  std::vector<std::vector<double>> factors;
  double largest_force = 0;
};
Drawn draw_all(const PlanetaryStage& stage, const StageTolerances& tolerances, const AssemblyOptions& options,
               const std::vector<double>& shares) {
  const auto count = static_cast<std::size_t>(options.assemblies);
  Drawn result{std::vector(shares.size(), std::vector<double>(count))};
  std::vector<double> forces(count);
  const auto perfect = perfect_stages(stage, shares);
  for_each_task(count, options.threads, [&](std::size_t i) {
    try {
      const auto assembly = drawn_assembly(stage, tolerances, options.seed, static_cast<int>(i));
      const auto sharing = sharing_of(perfect, assembly, shares);
      for (std::size_t s = 0; s < shares.size(); ++s) result.factors[s][i] = sharing.factors[s];
      forces[i] = sharing.largest_force;
    } catch (const SolverError& error) {
      throw SolverError(fmt::format("assembly {} of {} within the tolerances: {}", i + 1, count, error.what()));
    }
  });
  result.largest_force = *std::max_element(forces.begin(), forces.end());
  return result;
}

}  // namespace

PlanetaryStage drawn_assembly(const PlanetaryStage& stage, const StageTolerances& tolerances, std::uint64_t seed,
                              int assembly) {
  auto made = stage;
  const auto draw = [&](Deviation& deviation, double radius, const std::string& name) {
    if (radius > 0) deviation = drawn(tolerances.within, radius, seed, assembly, name);
  };
  draw(made.sun.errors.eccentricity, tolerances.sun_eccentricity, "sun eccentricity");
  draw(made.ring.errors.eccentricity, tolerances.ring_eccentricity, "ring eccentricity");
  made.planet_errors.resize(made.planet_angles.size());
  for (std::size_t n = 0; n < made.planet_errors.size(); ++n) {
    auto& errors = made.planet_errors[n];
    draw(errors.position, tolerances.planet_pin_position, fmt::format("planet {} pin position", n + 1));
    draw(errors.eccentricity, tolerances.planet_eccentricity, fmt::format("planet {} eccentricity", n + 1));
  }
  return made;
}

ErrorPeriodSharing error_period_sharing(const PlanetaryStage& stage, const std::vector<double>& torque_shares) {
  return sharing_of(perfect_stages(stage, torque_shares), stage, torque_shares);
}

std::size_t AssemblySharing::nominal() const {
  return static_cast<std::size_t>(std::find(torque_shares.begin(), torque_shares.end(), 1.0) - torque_shares.begin());
}

AssemblySharing assembly_sharing(const PlanetaryStage& stage, const StageTolerances& tolerances,
                                 const AssemblyOptions& options) {
  if (options.assemblies < 2)
    throw InputError(
        fmt::format("load sharing over tolerances needs at least two assemblies, not {}", options.assemblies));
  for (const double share : options.torque_shares)
    if (!(share > 0)) throw InputError(fmt::format("a share of the torque must be positive, not {}", share));
  AssemblySharing result;
  std::set<double> shares(options.torque_shares.begin(), options.torque_shares.end());
  shares.insert(1);
  result.torque_shares = {shares.begin(), shares.end()};
  auto all = draw_all(stage, tolerances, options, result.torque_shares);
  result.factors = std::move(all.factors);
  result.largest_force = all.largest_force;
  for (const auto& factors : result.factors) result.quantiles.push_back(quantiles_of(factors));
  const auto others = without_drawn(stage, tolerances);
  const auto at_nominal = [&](const StageTolerances& changed) {
    return quantiles_of(draw_all(others, changed, options, {1}).factors.front());
  };
  for (const auto& zone : zones) {
    const double radius = tolerances.*zone.radius;
    if (radius == 0) continue;
    StageTolerances alone{.within = tolerances.within}, without = tolerances;
    alone.*zone.radius = radius;
    without.*zone.radius = 0;
    auto& contribution = result.contributions.emplace_back();
    contribution.tolerance = zone.name;
    contribution.radius = radius;
    contribution.alone = at_nominal(alone);
    contribution.without = at_nominal(without);
  }
  if (result.contributions.empty()) {
    std::vector<std::string> names;
    for (const auto& zone : zones) names.emplace_back(zone.name);
    throw InputError(fmt::format("load sharing over tolerances needs a tolerance above zero: {} are all 0 m",
                                 fmt::join(names, ", ")));
  }
  return result;
}

}  // namespace annulus::dynamics
