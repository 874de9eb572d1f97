#include "dynamics/systems/two_k_v/two_k_v_sensitivity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"

namespace annulus::dynamics {

namespace {

/// How an input enters the eigenvalue problem.
enum class Enters {
  stiffness,  ///< linearly in K, through the elements of `part` (a group, see element_group)
  inertia,    ///< linearly in M, through the DOFs `part` + number + `suffix`
  otherwise
};

struct RealInput {
  std::string_view name;
  double TwoKVStage::*value;  ///< null: a mesh
  MeshExcitation TwoKVStage::*mesh;
  Enters enters;
  std::string_view part, suffix;
};

using Stage = TwoKVStage;

constexpr std::array real_inputs = {
    RealInput{"input_inertia", &Stage::input_inertia, nullptr, Enters::inertia, "input", "_u"},
    RealInput{"sun_inertia", &Stage::sun_inertia, nullptr, Enters::inertia, "sun", "_u"},
    RealInput{"planet_inertia", &Stage::planet_inertia, nullptr, Enters::inertia, "planet", "_u"},
    RealInput{"planet_mass", &Stage::planet_mass, nullptr, Enters::inertia, "planet", "_x"},
    RealInput{"crank_inertia", &Stage::crank_inertia, nullptr, Enters::inertia, "crank", "_u"},
    RealInput{"arc_inertia", &Stage::arc_inertia, nullptr, Enters::inertia, "arc", "_u"},
    RealInput{"arc_mass", &Stage::arc_mass, nullptr, Enters::inertia, "arc", "_x"},
    RealInput{"output_inertia", &Stage::output_inertia, nullptr, Enters::inertia, "output", "_u"},
    RealInput{"input_shaft", &Stage::input_shaft, nullptr, Enters::stiffness, "input_shaft", ""},
    RealInput{"crank_shaft", &Stage::crank_shaft, nullptr, Enters::stiffness, "planet_shaft", ""},
    RealInput{"crank_bearing", &Stage::crank_bearing, nullptr, Enters::stiffness, "crank_bearing", ""},
    RealInput{"arc_bearing", &Stage::arc_bearing, nullptr, Enters::stiffness, "crank_arc", ""},
    RealInput{"sun_mesh", nullptr, &Stage::sun_mesh, Enters::stiffness, "sun_planet", ""},
    RealInput{"arc_mesh", nullptr, &Stage::arc_mesh, Enters::stiffness, "arc_pins", ""},
    RealInput{"input_support", &Stage::input_support, nullptr, Enters::stiffness, "input_support", ""},
    RealInput{"output_support", &Stage::output_support, nullptr, Enters::stiffness, "output_support", ""},
    RealInput{"module", &Stage::module, nullptr, Enters::otherwise, "", ""},
    RealInput{"pressure_angle", &Stage::pressure_angle, nullptr, Enters::otherwise, "", ""},
    RealInput{"eccentricity", &Stage::eccentricity, nullptr, Enters::otherwise, "", ""},
};

/// A support that holds or is not there has no stiffness to change, a held body no inertia that moves.
bool counts(const TwoKVStage& stage, const RealInput& input) {
  const auto elastic = [](double support) { return support != 0 && support != rigid; };
  if (input.name == "input_support") return elastic(stage.input_support);
  if (input.name == "output_support") return elastic(stage.output_support);
  if (input.name == "input_inertia") return stage.input_support != rigid;
  if (input.name == "output_inertia") return stage.output_support != rigid;
  return true;
}

PeriodicCurve times(double factor, const PeriodicCurve& curve) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(curve.pieces()));
  for (int i = 0; i < curve.pieces(); ++i) values.push_back(factor * curve.coefficients(i)[0]);
  return {values, curve.pieces_per_unit()};
}

void scale_mesh(MeshExcitation& excitation, double factor, std::string_view name) {
  if (auto* table = std::get_if<TableStiffness>(&excitation)) {
    if (table->surface)
      throw InputError(
          fmt::format("{}: a law of force over deflection cannot be scaled; take the stiffness at its "
                      "nominal load instead",
                      name));
    table->secant = times(factor, table->secant);
    table->tangent = times(factor, table->tangent);
  } else if (auto* constant = std::get_if<ConstantStiffness>(&excitation)) {
    constant->mean *= factor;
  } else if (auto* harmonic = std::get_if<HarmonicStiffness>(&excitation)) {
    harmonic->mean *= factor;
  } else {
    std::get<RectangularStiffness>(excitation).mean *= factor;
  }
}

const Mode& first_mode(const Modes& found) {
  for (const auto& mode : found.modes)
    if (mode.frequency > 0) return mode;
  throw SolverError(
      fmt::format("none of the {} natural frequencies of the 2K-V stage is above zero", found.modes.size()));
}

const RealInput& real_input(const TwoKVStage& stage, const std::string& name) {
  for (const auto& known : real_inputs)
    if (known.name == name && counts(stage, known)) return known;
  throw InputError(fmt::format("a 2K-V stage has no input '{}' to vary; there are: {}", name,
                               fmt::join(frequency_inputs(stage), ", ")));
}

/// d ln f/d ln p of `mode`: the share of the strain energy of the elements the input acts through, halved, or
/// minus that of the kinetic energy.
double exact_sensitivity(const RealInput& input, const ModalEnergy& energy, const Modes& found, Eigen::Index mode,
                         const LumpedSystem& system) {
  double share = 0;
  if (input.enters == Enters::stiffness) {
    for (std::size_t e = 0; e < energy.elements.size(); ++e)
      if (element_group(energy.elements[e]) == input.part) share += energy.strain(static_cast<Eigen::Index>(e), mode);
    return share / 2;
  }
  const auto& shape = found.modes[mode].shape;  // phi^T M phi = 1, M is diagonal
  for (int i = 0; i < system.dofs(); ++i) {
    const auto& name = system.names()[i];
    if (element_group(name) == input.part && name.ends_with(input.suffix))
      share += system.mass()(i, i) * shape[i] * shape[i];
  }
  return -share / 2;
}

/// Sensitivity of first_frequency with a relative step of 1e-4: the error of second order is some 1e-8, rounding 1e-9.
double difference_sensitivity(const TwoKVStage& stage, const std::string& input) {
  constexpr double step = 1e-4;
  return std::log(first_frequency(stage, input, std::exp(step)) / first_frequency(stage, input, std::exp(-step))) /
         (2 * step);
}

struct SampledFrequency {
  std::vector<double> factor;  ///< its logarithm, even grid
  std::vector<double> value;   ///< Hz, NaN where no stage exists
};

/// Where the sampled curve passes `level`, nearest to factor 1, refined.
std::optional<double> crossing(const TwoKVStage& stage, const std::string& input, const SampledFrequency& sampled,
                               double level) {
  std::optional<double> nearest;
  for (std::size_t i = 0; i + 1 < sampled.factor.size(); ++i) {
    const double before = sampled.value[i] - level, after = sampled.value[i + 1] - level;
    if (!(before * after <= 0)) continue;  // also where one is no number
    std::uintmax_t steps = 100;
    const auto [low, high] = boost::math::tools::toms748_solve(
        [&](double x) { return first_frequency(stage, input, std::exp(x)) - level; }, sampled.factor[i],
        sampled.factor[i + 1], before, after, boost::math::tools::eps_tolerance<double>(40), steps);
    const double found = (low + high) / 2;
    if (!nearest || std::abs(found) < std::abs(*nearest)) nearest = found;
  }
  if (nearest) return std::exp(*nearest);
  return std::nullopt;
}

}  // namespace

std::vector<std::string> frequency_inputs(const TwoKVStage& stage) {
  std::vector<std::string> names;
  for (const auto& input : real_inputs)
    if (counts(stage, input)) names.emplace_back(input.name);
  return names;
}

TwoKVStage scaled(const TwoKVStage& stage, const std::string& input, double factor) {
  if (!std::isfinite(factor) || !(factor > 0))
    throw InputError(fmt::format("{}: factor {:g} must be positive", input, factor));
  const RealInput& known = real_input(stage, input);
  TwoKVStage changed = stage;
  if (known.value)
    changed.*known.value *= factor;
  else
    scale_mesh(changed.*known.mesh, factor, known.name);
  return changed;
}

double input_value(const TwoKVStage& stage, const std::string& input) {
  const RealInput& known = real_input(stage, input);
  return known.value ? stage.*known.value : mean_tangent_stiffness(stage.*known.mesh);
}

double first_frequency(const Modes& found) { return first_mode(found).frequency; }

double first_frequency(const TwoKVStage& stage) { return first_frequency(modes(stage)); }

double first_frequency(const TwoKVStage& stage, const std::string& input, double factor) {
  return first_frequency(scaled(stage, input, factor));
}

std::vector<FrequencySensitivity> first_frequency_sensitivities(const TwoKVStage& stage) {
  const LumpedSystem system = assemble(stage);
  const Modes found = modes(stage);
  const ModalEnergy energy = modal_energy(stage, found);
  const auto mode = static_cast<Eigen::Index>(&first_mode(found) - found.modes.data());
  std::vector<FrequencySensitivity> result;
  for (const auto& input : real_inputs) {
    if (!counts(stage, input)) continue;
    const std::string name(input.name);
    if (input.enters == Enters::otherwise)
      result.push_back({name, difference_sensitivity(stage, name), false});
    else
      result.push_back({name, exact_sensitivity(input, energy, found, mode, system), true});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.value) > std::abs(b.value); });
  return result;
}

InputBand band_of_input(const TwoKVStage& stage, const std::string& input, double target, double relative) {
  if (!(target > 0) || !(relative > 0 && relative < 1))
    throw InputError(
        fmt::format("target {:g} Hz must be positive and its band {:g} between 0 and 1", target, relative));
  (void)scaled(stage, input, 1);  // refuses an unknown name
  stage.check();
  constexpr int points = 49;
  const double reach = std::log(1e4);
  SampledFrequency sampled;
  for (int i = 0; i < points; ++i) {
    const double factor = reach * (2.0 * i / (points - 1) - 1);
    double value = not_known;
    const TwoKVStage changed = scaled(stage, input, std::exp(factor));
    try {
      changed.check();
      value = first_frequency(changed);
    } catch (const InputError&) {  // no such stage: left out
    }
    sampled.factor.push_back(factor);
    sampled.value.push_back(value);
  }
  InputBand band;
  for (const double side : {1 - relative, 1 + relative}) {
    const auto found = crossing(stage, input, sampled, target * side);
    if (!found) continue;
    constexpr double step = 1e-3;  // which way the frequency goes there
    const bool rises = first_frequency(stage, input, *found * (1 + step)) > first_frequency(stage, input, *found);
    (rises == (side < 1) ? band.low : band.high) = found;
  }
  return band;
}

std::optional<double> factor_reaching(const TwoKVStage& stage, const std::string& input, double target) {
  constexpr double close = 1e-6;
  const auto band = band_of_input(stage, input, target, close);
  if (!band.low || !band.high) return std::nullopt;
  return std::sqrt(*band.low * *band.high);
}

}  // namespace annulus::dynamics
