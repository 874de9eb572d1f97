#include "dynamics/systems/planetary/planetary_figures.h"

#include <fmt/format.h>

#include "dynamics/figures/common_figures.h"

namespace annulus::dynamics {

namespace {

void declare_meshes(std::vector<FigureSpec>& list, const StageMeshKind& kind, const std::string& meshes) {
  const bool sun = kind.results == &DynamicResponse::sun_planet;
  const std::string prefix = std::string(kind.name) + "_";
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
  for (auto& factor : factors) factor.ordering = sun && factor.key == prefix + "peak_factor";
  list.insert(list.end(), factors.begin(), factors.end());
  list.push_back(contact_loss_figure(prefix + "contact_loss", "Time without contact, " + meshes, "worst planet, %",
                                     "largest over the planets of the fraction of the time in which no tooth touches"));
}

std::vector<FigureSpec> planetary_specs() {
  std::vector<FigureSpec> list;
  declare_meshes(list, stage_mesh_kinds[0], "sun meshes");
  declare_meshes(list, stage_mesh_kinds[1], "ring meshes");
  list.push_back(shaft_figure());
  list.push_back(steady_figure());
  list.push_back(motions_figure());
  const auto bodies = body_figures();
  list.insert(list.end(), bodies.begin(), bodies.end());
  const auto frequencies = frequency_specs(
      planetary_frequencies,
      "distinct undamped natural frequencies above zero, rising, at rest and with the mean mesh stiffness");
  list.insert(list.end(), frequencies.begin(), frequencies.end());
  return list;
}

}  // namespace

const std::vector<FigureSpec>& planetary_figures() {
  static const auto list = planetary_specs();
  return list;
}

std::string sharing_key(const std::string& kind, const SharingQuantity& quantity) {
  return fmt::format("{}_load_sharing_{}", kind, quantity.name);
}

std::string branch_key(const std::string& kind, std::size_t planet, const BranchQuantity& quantity) {
  return fmt::format("{}{}_{}", kind, planet + 1, quantity.name);
}

FigureSet figures(const DynamicResponse& response) {
  FigureSet set;
  for (const auto& kind : stage_mesh_kinds) {
    const auto& [sharing, branches] = response.*kind.results;
    for (const auto& quantity : sharing_quantities) set.set(sharing_key(kind.name, quantity), sharing.*quantity.value);
    for (const auto& quantity : branch_quantities)
      set.set(fmt::format("{}_{}", kind.name, quantity.name), largest(branches, quantity.value));
  }
  for (const auto& spec : body_figures())
    if (const auto* entry = response.bodies.find(spec.key)) set.set(entry->key, entry->figure, entry->parts);
  add_shafts(set, response.shafts);
  set.set("steady", response.steady ? 1 : 0);
  set.set(motions_key, number_of(response.motions));
  return set;
}

}  // namespace annulus::dynamics
