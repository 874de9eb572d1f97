#pragma once

#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/modes/modal_energy.h"
#include "dynamics/steady_state/other_motions.h"

/// Results that lumped models of all kinds have.
namespace annulus::dynamics {

/// "steady": whether a periodic steady state was found.
[[nodiscard]] FigureSpec steady_figure();
/// The number of stable motions that were found; 1 where backlash is out of reach, not known where others were not
/// looked for.
inline constexpr const char* motions_key = "stable_motions";
[[nodiscard]] FigureSpec motions_figure();
[[nodiscard]] double number_of(const FoundMotions& motions);
/// K_V and K_γ K_V of meshes such as "the sun meshes", with keys `prefix`dynamic_factor and `prefix`peak_factor.
/// `nominal_force` names what the latter refers to.
[[nodiscard]] std::vector<FigureSpec> force_factor_figures(const std::string& prefix, const std::string& meshes,
                                                           const std::string& nominal_force);
[[nodiscard]] FigureSpec contact_loss_figure(const std::string& key, const std::string& title, const std::string& axis,
                                             const std::string& definition);

/// frequency_1_Hz ... frequency_`count`_Hz.
[[nodiscard]] std::vector<FigureSpec> frequency_specs(int count, const std::string& definition);

enum class Multiples {
  listed,  ///< a multiple frequency as often as it occurs
  once
};
/// The lowest `count` frequencies above zero, by the keys of `frequency_specs`. `frequencies` rise.
[[nodiscard]] FigureSet frequency_figures(const std::vector<Frequency>& frequencies, int count, Multiples multiples);
/// The same for modes that are exact for the model they belong to.
[[nodiscard]] FigureSet frequency_figures(const Modes& modes, int count, Multiples multiples);
/// Errors of the frequencies among `figures`, widened to neighbours that may change places with them.
void widen_frequencies(FigureSet& figures);

}  // namespace annulus::dynamics
