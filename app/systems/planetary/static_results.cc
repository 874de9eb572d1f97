#include "app/systems/planetary/static_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace annulus::app {

using dynamics::StaticPosition;
using dynamics::StaticTurn;

double largest(const StaticTurn& turn, const std::function<double(const StaticPosition&)>& value) {
  double most = 0;
  for (const auto& p : turn.positions) most = std::max(most, value(p));
  return most;
}

std::string bearing_key(std::size_t bearing, const char* what) { return fmt::format("bearing{}_{}", bearing, what); }
std::string tilt_key(std::size_t body) { return fmt::format("tilt{}", body); }

namespace {

void add_mesh_results(const StaticTurn& turn, StaticResults& list) {
  using dynamics::StaticFigures;
  for (const auto& [name, mesh, stations] : {std::tuple{"sun_planet", &StaticFigures::sun, &turn.sun_stations},
                                             {"ring_planet", &StaticFigures::ring, &turn.ring_stations}}) {
    const auto add = [&, mesh = mesh](const char* key, double StaticFigures::Mesh::*member, Course course) {
      list.push_back({fmt::format("{}_static_{}", name, key),
                      [=](const StaticTurn& t) { return dynamics::figures_of(t).*mesh.*member; }, course});
    };
    add("load_sharing", &StaticFigures::Mesh::sharing, Course::smooth);
    add("load_sharing_instantaneous", &StaticFigures::Mesh::sharing_instantaneous, Course::smooth);
    // A face of two stations is that of a plane stage, along which nothing is modelled.
    if (stations->size() <= 2) continue;
    add("face_load_factor", &StaticFigures::Mesh::line_load_ratio, Course::smooth);
    add("face_load_factor_instantaneous", &StaticFigures::Mesh::line_load_ratio_instantaneous, Course::with_kinks);
  }
}

}  // namespace

StaticResults results_of(const StaticTurn& turn) {
  StaticResults list;
  add_mesh_results(turn, list);
  const auto add = [&](const std::string& key, const std::function<double(const StaticPosition&)>& value) {
    list.push_back({key, [value](const StaticTurn& t) { return largest(t, value); }});
  };
  for (std::size_t b = 0; b < turn.bearing_names.size(); ++b) {
    const auto bearing = [&](const char* what, const std::function<double(const dynamics::StaticBearing&)>& value) {
      add(bearing_key(b, what), [b, value](const StaticPosition& p) { return value(p.bearings.at(b)); });
    };
    bearing("radial", [](const auto& x) { return x.force.template head<2>().norm(); });
    bearing("axial", [](const auto& x) { return std::abs(x.force.z()); });
    bearing("moment", [](const auto& x) { return x.moment.norm(); });
    bearing("element", [](const auto& x) { return x.largest_element; });
  }
  for (std::size_t b = 0; b < turn.body_names.size(); ++b)
    add(tilt_key(b), [b](const StaticPosition& p) { return p.bodies.at(b).rotation.head<2>().norm(); });
  return list;
}

FigureSet values(const StaticResults& results, const StaticTurn& turn) {
  FigureSet set;
  for (const auto& result : results) set.set(result.key, {result.largest(turn), 0});
  return set;
}

const std::vector<FigureSpec>& static_figures() {
  static const auto list = [] {
    std::vector<FigureSpec> specs;
    for (const auto& [mesh, words, gear] :
         {std::tuple{"sun_planet", "sun meshes", "sun"}, {"ring_planet", "ring meshes", "ring"}}) {
      FigureSpec sharing;
      sharing.key = fmt::format("{}_static_load_sharing", mesh);
      sharing.title = fmt::format("Load sharing of the {} in equilibrium over a turn", words);
      sharing.symbol = "K_γ";
      sharing.definition =
          "Mesh force of a planet, averaged over a mesh cycle, over the mean of all planets: the largest over the "
          "planets and over all positions of the carrier, without inertia (annulus statics).";
      sharing.term = "load_sharing";
      sharing.better = Better::smaller;
      sharing.quantity = "load_sharing";
      specs.push_back(sharing);
      sharing.key += "_instantaneous";
      sharing.title = fmt::format("Load sharing of the {} in equilibrium, in any position", words);
      sharing.definition =
          "Mesh force of a planet over the mean of all planets: the largest over the planets and all "
          "positions, without inertia (annulus statics).";
      specs.push_back(sharing);
      FigureSpec face;
      face.key = fmt::format("{}_static_face_load_factor", mesh);
      face.title = fmt::format("Face load factor of the {} in equilibrium over a turn", words);
      face.symbol = "K_Hβ";
      face.definition = fmt::format(
          "Largest force per face width over the mean one of the mesh, both averaged over a mesh cycle, of planets and "
          "{} in an equilibrium without inertia (annulus statics). Meshes that carry less than a twentieth of the mean "
          "do not count.",
          gear);
      face.better = Better::smaller;
      specs.push_back(face);
      face.key += "_instantaneous";
      face.title = fmt::format("Face load factor of the {} in equilibrium, in any position", words);
      face.definition = fmt::format(
          "Largest force per face width over the mean one of the mesh at that moment, of planets and {} in an "
          "equilibrium without inertia (annulus statics). Meshes that carry less than a twentieth of the mean do not "
          "count. It is large where a pair comes into contact or leaves it at one end of the face.",
          gear);
      specs.push_back(face);
    }
    return specs;
  }();
  return list;
}

}  // namespace annulus::app
