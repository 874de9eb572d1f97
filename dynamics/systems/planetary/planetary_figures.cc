#include "dynamics/systems/planetary/planetary_figures.h"

#include <string>

#include "dynamics/figures/common_figures.h"

namespace annulus::dynamics {

namespace {

constexpr const char* sun_meshes = "sun_planet_";
constexpr const char* ring_meshes = "ring_planet_";

enum class MeshKind { sun, ring };

void declare_meshes(std::vector<FigureSpec>& list, const std::string& prefix, const std::string& meshes,
                    MeshKind kind) {
  const bool sun = kind == MeshKind::sun;
  const auto share = [&](const char* name, const std::string& title, const std::string& definition) {
    return FigureSpec{.key = prefix + "load_sharing_" + name,
                      .title = "Load sharing of the " + meshes + ", " + title,
                      .axis = "N |F| / Σ|F|",
                      .definition = "largest over the planets and " + definition,
                      .term = "load_sharing",
                      .better = Better::smaller,
                      .quantity = "load_sharing",
                      .digits = 5,
                      .compared = true,
                      .spread = true};
  };
  auto averaged = share("averaged", "averaged over a mesh cycle",
                        "mesh cycles of N |F_n| / Σ|F|, with forces averaged over the mesh cycle");
  averaged.symbol = "K_γ";
  averaged.plotted = averaged.ordering = averaged.headline = true;
  averaged.beside = prefix + "load_sharing_quasi_static";
  auto instantaneous = share("instantaneous", "instantaneous", "instants of N |F_n| / Σ|F|");
  averaged.cost_study = instantaneous.cost_study = sun;
  if (sun) {
    averaged.guarantee = Guarantee::always;
    instantaneous.guarantee = Guarantee::while_in_contact;
  }
  list.insert(list.end(),
              {averaged, instantaneous,
               share("quasi_static", "quasi-static", "positions of N |F_n| / Σ|F|, without inertia and damping")});
  auto factors = force_factor_figures(prefix, "the " + meshes, "T_s / (N r_bs)");
  factors.back().ordering = sun;
  list.insert(list.end(), factors.begin(), factors.end());
  list.push_back(contact_loss_figure(prefix + "contact_loss", "Time without contact, " + meshes, "worst planet, %",
                                     "largest over the planets of the fraction of the time in which no tooth touches"));
}

void declare_motion(std::vector<FigureSpec>& list, const std::string& prefix, const std::string& title,
                    const std::string& definition) {
  const auto add = [&](const char* key, const char* axis, const char* reduced) {
    list.push_back({.key = prefix + key,
                    .title = title,
                    .unit = "µm",
                    .scale = 1e6,
                    .axis = axis,
                    .definition = reduced + definition,
                    .effort = FigureEffort::motion});
  };
  add("_rms_m", "rms, µm", "root mean square of ");
  add("_peak_to_peak_m", "peak to peak, µm", "peak-to-peak value of ");
}

std::vector<FigureSpec> planetary_specs() {
  std::vector<FigureSpec> list;
  declare_meshes(list, sun_meshes, "sun meshes", MeshKind::sun);
  declare_meshes(list, ring_meshes, "ring meshes", MeshKind::ring);
  list.push_back(shaft_figure());
  list.push_back(steady_figure());
  list.push_back(motions_figure());
  declare_motion(list, "sun", "Motion of the sun", "the distance of the sun's centre from its mean position");
  list[list.size() - 2].plotted = true;
  declare_motion(list, "sun_planet_deflection", "Deflection of the sun mesh",
                 "the deflection of the sun mesh with the largest motion");
  declare_motion(list, "ring_planet_deflection", "Deflection of the ring mesh",
                 "the deflection of the ring mesh with the largest motion");
  list.back().plotted = true;
  const auto frequencies = frequency_specs(
      planetary_frequencies,
      "distinct undamped natural frequencies above zero, rising, at rest and with the mean mesh stiffness");
  list.insert(list.end(), frequencies.begin(), frequencies.end());
  return list;
}

void add(FigureSet& set, const std::string& prefix, const MeshKindResult& kind) {
  set.set(prefix + "load_sharing_averaged", kind.load_sharing.averaged);
  set.set(prefix + "load_sharing_instantaneous", kind.load_sharing.instantaneous);
  set.set(prefix + "load_sharing_quasi_static", kind.load_sharing.quasi_static);
  set.set(prefix + "dynamic_factor", largest(kind.branches, &BranchResult::dynamic_factor));
  set.set(prefix + "peak_factor", largest(kind.branches, &BranchResult::peak_factor));
  set.set(prefix + "contact_loss", largest(kind.branches, &BranchResult::contact_loss));
}

}  // namespace

const std::vector<FigureSpec>& planetary_figures() {
  static const auto list = planetary_specs();
  return list;
}

FigureSet figures(const DynamicResponse& response) {
  FigureSet set;
  add(set, sun_meshes, response.sun_planet);
  add(set, ring_meshes, response.ring_planet);
  add_shafts(set, response.shafts);
  set.set("steady", response.steady ? 1 : 0);
  set.set(motions_key, number_of(response.motions));
  return set;
}

}  // namespace annulus::dynamics
