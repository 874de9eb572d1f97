#include "dynamics/system/mesh_excitation.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"

namespace annulus::dynamics {

TableStiffness table_stiffness(const StiffnessTable& table, double load, double phase_shift,
                               LoadDependence dependence) {
  auto curves = curves_at_load(table, load);
  return {std::move(curves.stiffness_secant),
          std::move(curves.stiffness_tangent),
          std::move(curves.unloaded_te),
          phase_shift,
          dependence == LoadDependence::table ? std::make_shared<const ForceSurface>(table) : nullptr,
          std::nullopt};
}

double mean_stiffness(const MeshExcitation& excitation) {
  if (const auto* table = std::get_if<TableStiffness>(&excitation)) return table->secant.mean();
  if (const auto* constant = std::get_if<ConstantStiffness>(&excitation)) return constant->mean;
  if (const auto* harmonic = std::get_if<HarmonicStiffness>(&excitation)) return harmonic->mean;
  return std::get<RectangularStiffness>(excitation).mean;
}

double mean_tangent_stiffness(const MeshExcitation& excitation) {
  if (const auto* table = std::get_if<TableStiffness>(&excitation)) return table->tangent.mean();
  return mean_stiffness(excitation);
}

int period_in_cycles(const MeshExcitation& excitation) {
  const auto* table = std::get_if<TableStiffness>(&excitation);
  // A table spans whole mesh cycles by construction (positions x phases); rounding only removes the division's error.
  return table ? static_cast<int>(std::lround(table->secant.period())) : 1;
}

void check(const MeshExcitation& excitation, const std::string& name) {
  const auto refuse = [&](const std::string& what) { throw InputError(name + ": " + what); };
  const auto check_mean = [&](double mean) {
    if (!std::isfinite(mean) || !(mean > 0)) refuse(fmt::format("mean stiffness {} N/m must be positive", mean));
  };
  const auto check_phase = [&](double phase) {
    if (!std::isfinite(phase)) refuse(fmt::format("phase shift {} must be finite", phase));
  };
  if (const auto* constant = std::get_if<ConstantStiffness>(&excitation)) {
    check_mean(constant->mean);
  } else if (const auto* harmonic = std::get_if<HarmonicStiffness>(&excitation)) {
    check_mean(harmonic->mean);
    if (!(std::abs(harmonic->ripple) < 1))
      refuse(fmt::format("ripple {} must lie within -1 and 1, else the stiffness vanishes", harmonic->ripple));
    check_phase(harmonic->phase_shift);
  } else if (const auto* wave = std::get_if<RectangularStiffness>(&excitation)) {
    check_mean(wave->mean);
    if (!(wave->duty > 0 && wave->duty < 1)) refuse(fmt::format("duty {} must lie between 0 and 1", wave->duty));
    if (!(1 + wave->ripple * (1 - wave->duty) > 0 && 1 - wave->ripple * wave->duty > 0))
      refuse(fmt::format("ripple {} with duty {} makes the stiffness vanish", wave->ripple, wave->duty));
    check_phase(wave->phase_shift);
  } else {
    const auto& table = std::get<TableStiffness>(excitation);
    check_mean(table.secant.mean());
    check_mean(table.tangent.mean());
    // The curve may pass its values slightly: 64 points per mesh cycle see any dip that matters.
    for (double x = 0; x < table.secant.period(); x += 1.0 / 64)
      if (!(table.secant(x) > 0))
        refuse(fmt::format("the tabulated stiffness is {} N/m at phase {}; it must be positive", table.secant(x), x));
    if (table.surface && table.surface->grid().period() != std::round(table.secant.period()))
      refuse(
          fmt::format("the period of the law of force over deflection, {:g} mesh cycles, differs from that of the "
                      "stiffness, {:g}",
                      table.surface->grid().period(), table.secant.period()));
    check_phase(table.phase_shift);
  }
}

}  // namespace annulus::dynamics
