#include "dynamics/systems/planetary/planetary_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "dynamics/figures/steady_figure.h"

namespace annulus::dynamics {

namespace {

constexpr const char* sun_meshes = "sun_planet_";
constexpr const char* ring_meshes = "ring_planet_";

void declare_meshes(std::vector<FigureSpec>& list, const std::string& prefix, const std::string& meshes, bool sun) {
  constexpr const char* share = "N F / ΣF";
  list.push_back({.key = prefix + "load_sharing_averaged",
                  .title = "Load sharing of the " + meshes + ", averaged over a mesh cycle",
                  .symbol = "K_γ",
                  .axis = share,
                  .definition = "largest over the planets and mesh cycles of N F_n / ΣF, the forces averaged over the "
                                "mesh cycle first",
                  .better = Better::smaller,
                  .guarantee = sun ? Guarantee::always : Guarantee::none,
                  .quantity = "load_sharing",
                  .digits = 5,
                  .compared = true,
                  .cost_study = sun,
                  .plotted = true,
                  .spread = true,
                  .ordering = true,
                  .beside = prefix + "load_sharing_quasi_static"});
  list.push_back({.key = prefix + "load_sharing_instantaneous",
                  .title = "Load sharing of the " + meshes + ", instantaneous",
                  .axis = share,
                  .definition = "largest over the planets and instants of N F_n / ΣF",
                  .better = Better::smaller,
                  .guarantee = sun ? Guarantee::while_in_contact : Guarantee::none,
                  .quantity = "load_sharing",
                  .digits = 5,
                  .compared = true,
                  .cost_study = sun,
                  .spread = true});
  list.push_back({.key = prefix + "load_sharing_quasi_static",
                  .title = "Load sharing of the " + meshes + ", quasi-static",
                  .axis = share,
                  .definition = "largest over the planets and positions of N F_n / ΣF, without inertia and damping",
                  .better = Better::smaller,
                  .quantity = "load_sharing",
                  .digits = 5,
                  .compared = true,
                  .spread = true});
  list.push_back({.key = prefix + "dynamic_factor",
                  .title = "Dynamic factor of the " + meshes,
                  .axis = "largest F / mean mesh force",
                  .definition =
                      "largest over the planets and instants of F_n over the nominal mesh force, T_s / (N r_bs); "
                      "it contains the load sharing",
                  .better = Better::smaller,
                  .guarantee = Guarantee::while_in_contact,
                  .quantity = "dynamic_factor",
                  .compared = true,
                  .cost_study = true,
                  .plotted = true,
                  .spread = true,
                  .ordering = sun});
  list.push_back({.key = prefix + "contact_loss",
                  .title = "Time without contact, " + meshes,
                  .unit = "%",
                  .scale = 100,
                  .axis = "worst planet, %",
                  .definition = "largest over the planets of the fraction of the time in which no tooth touches",
                  .better = Better::smaller,
                  .plotted = true});
}

void declare_motion(std::vector<FigureSpec>& list, const std::string& prefix, const std::string& title,
                    const std::string& definition) {
  list.push_back({.key = prefix + "_rms_m",
                  .title = title,
                  .unit = "µm",
                  .scale = 1e6,
                  .axis = "rms, µm",
                  .definition = "root mean square of " + definition,
                  .effort = FigureEffort::motion});
  list.push_back({.key = prefix + "_peak_to_peak_m",
                  .title = title,
                  .unit = "µm",
                  .scale = 1e6,
                  .axis = "peak to peak, µm",
                  .definition = "range of " + definition,
                  .effort = FigureEffort::motion});
}

std::vector<FigureSpec> declared() {
  std::vector<FigureSpec> list;
  declare_meshes(list, sun_meshes, "sun meshes", true);
  declare_meshes(list, ring_meshes, "ring meshes", false);
  list.push_back(steady_figure());
  declare_motion(list, "sun", "Motion of the sun", "the distance of the sun's centre from its mean position");
  list[list.size() - 2].plotted = true;
  declare_motion(list, "sun_planet_deflection", "Deflection of the sun mesh",
                 "the deflection of the sun mesh that moves most");
  declare_motion(list, "ring_planet_deflection", "Deflection of the ring mesh",
                 "the deflection of the ring mesh that moves most");
  list.back().plotted = true;
  for (int i = 1; i <= planetary_frequencies; ++i)
    list.push_back({.key = fmt::format("frequency_{}_Hz", i),
                    .title = fmt::format("Natural frequency {}", i),
                    .unit = "Hz",
                    .definition = "distinct undamped natural frequencies above zero, rising, at rest and with the mean "
                                  "mesh stiffness",
                    .effort = FigureEffort::motion,
                    .guarantee = Guarantee::always,
                    .digits = 5,
                    .compared = i <= 5,
                    .cost_study = i <= 3});
  return list;
}

struct MeshValues {
  Figure averaged, instantaneous, quasi_static, dynamic_factor;
  double contact_loss = 0;
};

void add(FigureSet& set, const std::string& prefix, const MeshValues& v) {
  set.set(prefix + "load_sharing_averaged", v.averaged);
  set.set(prefix + "load_sharing_instantaneous", v.instantaneous);
  set.set(prefix + "load_sharing_quasi_static", v.quasi_static);
  set.set(prefix + "dynamic_factor", v.dynamic_factor);
  set.set(prefix + "contact_loss", v.contact_loss);
}

MeshValues values_of(const MeshKindResult& kind) {
  const auto& s = kind.load_sharing;
  MeshValues v{s.averaged, s.instantaneous, s.quasi_static, {-1, not_known}, 0};
  for (const auto& b : kind.branches) {
    if (b.dynamic_factor_max.value > v.dynamic_factor.value) v.dynamic_factor = b.dynamic_factor_max;
    v.contact_loss = std::max(v.contact_loss, b.contact_loss);
  }
  return v;
}

MeshValues values_of(const KindFigures& f) {
  return {{f.averaged, not_known},
          {f.instantaneous, not_known},
          {f.quasi_static, not_known},
          {f.dynamic_factor, not_known},
          f.contact_loss};
}

}  // namespace

const std::vector<FigureSpec>& planetary_figures() {
  static const auto list = declared();
  return list;
}

FigureSet figures(const DynamicResponse& response) {
  FigureSet set;
  add(set, sun_meshes, values_of(response.sun_planet));
  add(set, ring_meshes, values_of(response.ring_planet));
  set.set("steady", response.steady ? 1 : 0);
  return set;
}

FigureSet figures(const PointFigures& point) {
  FigureSet set;
  add(set, sun_meshes, values_of(point.sun_planet));
  add(set, ring_meshes, values_of(point.ring_planet));
  set.set("steady", point.steady ? 1 : 0);
  return set;
}

FigureSet motion_figures(const PointFigures& point) {
  FigureSet set;
  for (const auto& [prefix, range] : {std::pair{"sun", &point.sun},
                                      {"sun_planet_deflection", &point.sun_mesh},
                                      {"ring_planet_deflection", &point.ring_mesh}}) {
    set.set(std::string(prefix) + "_rms_m", range->rms);
    set.set(std::string(prefix) + "_peak_to_peak_m", range->peak_to_peak);
  }
  for (std::size_t i = 0; i < point.frequencies.size(); ++i)
    set.set(fmt::format("frequency_{}_Hz", i + 1), point.frequencies[i]);
  return set;
}

}  // namespace annulus::dynamics
