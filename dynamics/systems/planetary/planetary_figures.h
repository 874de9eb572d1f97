#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// Natural frequencies among the results of a planetary stage.
inline constexpr int planetary_frequencies = 6;

/// The results of the lumped model of a planetary stage, each declared once. Those of both kinds of meshes have keys
/// that begin with sun_planet_ and ring_planet_.
[[nodiscard]] const std::vector<FigureSpec>& planetary_figures();

/// The kinds of meshes of a stage; keys of their results begin with the name and "_".
struct StageMeshKind {
  const char* name;
  MeshKindResult DynamicResponse::*results;
};
inline constexpr std::array stage_mesh_kinds{StageMeshKind{"sun_planet", &DynamicResponse::sun_planet},
                                             StageMeshKind{"ring_planet", &DynamicResponse::ring_planet}};

/// Results of all meshes of a kind together, and of each of them, by the ends of their keys.
struct SharingQuantity {
  const char* name;
  Figure LoadSharing::*value;
};
inline constexpr std::array sharing_quantities{SharingQuantity{"averaged", &LoadSharing::averaged},
                                               SharingQuantity{"instantaneous", &LoadSharing::instantaneous},
                                               SharingQuantity{"quasi_static", &LoadSharing::quasi_static}};
struct BranchQuantity {
  const char* name;
  Figure BranchResult::*value;
};
inline constexpr std::array branch_quantities{BranchQuantity{"dynamic_factor", &BranchResult::dynamic_factor},
                                              BranchQuantity{"peak_factor", &BranchResult::peak_factor},
                                              BranchQuantity{"contact_loss", &BranchResult::contact_loss}};

/// "sun_planet_load_sharing_averaged".
[[nodiscard]] std::string sharing_key(const std::string& kind, const SharingQuantity& quantity);
/// "sun_planet2_peak_factor": of the mesh of one planet, counted from 0.
[[nodiscard]] std::string branch_key(const std::string& kind, std::size_t planet, const BranchQuantity& quantity);

/// Calls visit(key, result) for every result that carries the errors of tables, those of every planet by itself, and
/// the largest torque of every shaft; but for those in DynamicResponse::bodies.
template <class Response, class Visit>
void for_each_figure(Response& response, Visit visit) {
  for (const auto& kind : stage_mesh_kinds) {
    auto& [sharing, branches] = response.*kind.results;
    for (const auto& quantity : sharing_quantities) visit(sharing_key(kind.name, quantity), sharing.*quantity.value);
    for (std::size_t n = 0; n < branches.size(); ++n)
      for (const auto& quantity : branch_quantities)
        visit(branch_key(kind.name, n, quantity), branches[n].*quantity.value);
  }
  for (auto& shaft : response.shafts) visit(torque_key(shaft), shaft.largest_torque);
}

/// Results of a response with their errors, by the keys above; of the factors and the loss of contact the
/// largest over the planets.
[[nodiscard]] FigureSet figures(const DynamicResponse& response);

}  // namespace annulus::dynamics
