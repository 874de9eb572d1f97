#include "app/model/definitions.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/replace.hpp>

#include "app/model/gear_system.h"

namespace annulus::app {

const std::vector<Definition>& definitions() {
  static const std::vector<Definition> list = {
      {"nominal_force", "", "Nominal mesh force", "F = T_s / (N r_bs)",
       "The force of one mesh along the line of action when N equal planets share the load evenly and nothing "
       "vibrates. "
       "T_s is the torque of the sun, r_bs its base radius. A gear pair has F = T_1 / (r_b1 cos β_b).",
       ""},
      {"load_sharing", "K_γ", "Load-sharing factor", "K_γ = max over planets n and instants of N |F_n| / Σ|F_m|",
       "F_n is the force of the mesh of planet n, averaged over the mesh cycle that begins at the instant. The "
       "instants "
       "cover one error period. A mesh that presses on its back flanks counts with its absolute force. ISO 6336-1 "
       "calls K_γ the mesh load factor. The instantaneous factor takes the forces without the average, and contains "
       "their vibration. The quasi-static factor takes the forces without inertia and damping.",
       "[ISO6336-1]"},
      {"load_sharing_of_assemblies", "K_γ P50, P95, P99", "Load sharing of assemblies",
       "P95: 95 % of the assemblies have a K_γ of at most this",
       "The deviations of each assembly are drawn within the tolerances of the scene. Its K_γ is the quasi-static one, "
       "the largest over its error period. Every such factor holds for a gearbox; the quantiles hold for a series of "
       "them. Eccentricities and pin positions are drawn. Pitch, profile and helix deviations are not.",
       "[ISO1328-1]"},
      {"dynamic_factor", "K_V", "Dynamic factor", "K_V = max over meshes n and instants of |F_n| / |mean of F_n|",
       "The mean is that of the same mesh over the mesh cycle around the instant. K_V therefore contains no load "
       "sharing: the base load of ISO 6336-1 is F_t K_A K_γ. The factor of a stage is the largest of its meshes. A "
       "planet that carries little load has a small mean. Its K_V may be large while its forces are small. The peak "
       "factor shows whether this matters.",
       "[ISO6336-1]"},
      {"peak_factor", "K_γ K_V", "Peak factor", "peak factor = max over meshes n and instants of |F_n| / F",
       "The largest mesh force over the nominal mesh force F. It contains load sharing and dynamics together. It is "
       "about the product of K_γ and K_V, and less if the planet with the largest share does not vibrate most. Do not "
       "multiply it by K_γ again.",
       "[ISO6336-1]"},
      {"stable_motions", "", "Stable motions",
       "number of different steady motions to which initial conditions lead at one speed and load",
       "With backlash several motions may exist. The history of the machine decides which one runs. Results are those "
       "of the motion with the largest mesh force.",
       ""},
      {"contact_loss", "", "Time without contact", "largest over the meshes of (time in which no tooth touches) / time",
       "Teeth separate where the vibration exceeds the mean deflection. Several motions may then exist.", ""},
      {"face_load_factor", "K_Hβ", "Face load factor", "K_Hβ = max over mesh cycles of w_max / w_mean",
       "w is the load of the mesh per face width, of all tooth pairs in contact together, at the nominal load. Only "
       "solid "
       "models have it; plane models carry the same load at every point of the face.",
       "[ISO6336-1]"},
      {"transverse_load_factor", "K_Hα", "Transverse load factor",
       "K_Hα = largest load of a tooth pair / that without deviations",
       "annulus does not compute it: gears without pitch deviations have K_Hα = 1. The load shares of the tooth pairs "
       "are in the tables of the transmission error.",
       "[ISO6336-1]"},
      {"transmission_error", "TE, LTE", "Transmission error", "TE = r_b1 θ_1 − r_b2 θ_2 along the line of action",
       "The lag of the driven gear behind the position of conjugate rigid gears; θ_1 is the angle of the driving gear. "
       "LTE is the transmission error under "
       "load. The unloaded one follows from tip relief, crowning and slope alone. Peak to peak means largest less "
       "smallest over the mesh cycles at the nominal load.",
       ""},
      {"mesh_stiffness", "k", "Mesh stiffness", "secant F / (LTE − unloaded TE), tangent dF / dLTE",
       "The tables hold both at every phase, ring position and load. The mean stiffness is the mean of the secant over "
       "the mesh cycles at the nominal load.",
       ""},
      {"stiffness_ripple", "", "Ripple of the stiffness", "(k_max − k_min) / k_mean over the mesh cycles",
       "The ripple is that of the secant stiffness at the nominal load.", ""},
      {"contact_ratio", "ε_α", "Transverse contact ratio", "ε_α = length of the path of contact / base pitch",
       "The contact ratio is that of the gears without load.", "[ISO21771]"},
      {"root_stress", "", "Root stress", "largest over the fillet and the mesh cycles",
       "The stress is that of the finite-element solution at the nominal load: first principal stress (tension) and "
       "von Mises stress. It has no error estimate yet.",
       ""},
      {"rim_stress", "", "Rim stress", "largest over the free outside of the rim and the mesh cycles",
       "The stress is the von Mises stress of the finite-element solution at the nominal load. It has no error "
       "estimate yet.",
       ""},
      {"natural_frequency", "f", "Natural frequency", "K φ = (2π f)² M φ",
       "The system is undamped and at rest, with the mean tangent stiffness of the meshes at the nominal load.", ""},
      {"error_period", "", "Error period", "least common multiple of the periods of all meshes and errors",
       "The time after which the excitation of a stage repeats, in mesh cycles. A periodic steady state repeats after "
       "this period. If a motion does not repeat, its results are those of its last mesh cycles.",
       ""},
      {"torsional_stiffness", "", "Torsional stiffness", "output torque / twist of the output, with the input fixed",
       "The stiffness is the mean over a crank turn.", ""},
      {"error_bar", "±", "Numerical error",
       "sum of the parts: discretisation, contact, condensation, interpolation, "
       "integration, model",
       "How far the number may lie from the exact solution of the model with the inputs of the scene. It does not "
       "contain "
       "the uncertainty of the inputs.",
       ""},
      {"spread", "", "Spread", "median, and 5 % to 95 % of the samples",
       "If inputs are not known, such as the phases of errors, the result is a distribution. The nominal value is one "
       "of its samples and need not be a likely one.",
       ""}};
  return list;
}

const Definition* find_definition(const std::string& word) {
  const auto plain = [](const std::string& text) {
    auto same = boost::algorithm::to_lower_copy(text);
    for (const auto& [letter, name] : {std::pair{"γ", "gamma"}, {"β", "beta"}, {"α", "alpha"}, {"ε", "epsilon"}})
      boost::algorithm::replace_all(same, letter, name);
    return same;
  };
  const auto wanted = plain(word);
  const auto found = std::find_if(definitions().begin(), definitions().end(), [&](const Definition& d) {
    return wanted == d.key || wanted == plain(d.title) || (!d.symbol.empty() && wanted == plain(d.symbol));
  });
  return found == definitions().end() ? nullptr : &*found;
}

std::string explain(const Definition& d) {
  return fmt::format("{}{}\n  {}\n  {}{}\n", d.title, d.symbol.empty() ? "" : ", " + d.symbol, d.formula, d.text,
                     d.sources.empty() ? "" : " " + d.sources);
}

std::string definitions_markdown() {
  std::string text =
      "# Definitions\n\nWritten by `annulus explain --definitions`; `annulus explain K_V` prints one of them. Names in "
      "brackets are keys of\n[references.bib](references.bib).\n";
  for (const auto& d : definitions()) {
    text += fmt::format("\n<a id=\"{}\"></a>\n\n## {}{}\n\n    {}\n\n{}{}\n", d.key, d.title,
                        d.symbol.empty() ? "" : ", " + d.symbol, d.formula, d.text,
                        d.sources.empty() ? "" : " " + d.sources);
    std::vector<std::string> keys;
    for (const auto& kind : system_kinds())
      for (const auto& spec : kind.figures())
        if (spec.term == d.key && std::find(keys.begin(), keys.end(), spec.key) == keys.end()) keys.push_back(spec.key);
    if (!keys.empty()) text += fmt::format("\nResults: `{}`.\n", fmt::join(keys, "`, `"));
  }
  return text;
}

}  // namespace annulus::app
