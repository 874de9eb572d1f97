#include "app/systems/planetary/pitch_deviations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/scene/scene_declare.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/units.h"
#include "dynamics/statistics/pitch_draws.h"
#include "geometry/flank_tolerances.h"

namespace annulus::app {

namespace {

constexpr const char *sun_class = "errors.sun_pitch_class", *planet_class = "errors.planet_pitch_class",
                     *ring_class = "errors.ring_pitch_class";
constexpr const char *sun_key = "errors.sun_pitch_deviations_um", *planet_key = "errors.planet_pitch_deviations_um",
                     *ring_key = "errors.ring_pitch_deviations_um";

std::size_t number(std::ptrdiff_t tooth, std::size_t teeth) {
  const auto n = static_cast<std::ptrdiff_t>(teeth);
  return static_cast<std::size_t>(((tooth % n) + n) % n);
}

/// Places of the teeth, m, counter-clockwise of equal ones on the average; from the distances to the teeth before. What
/// rounding leaves of their sum is spread over all teeth.
std::vector<double> places(std::vector<double> pitch) {
  const double left = std::accumulate(pitch.begin(), pitch.end(), 0.0) / static_cast<double>(pitch.size());
  for (double& p : pitch) p -= left;
  std::vector<double> list(pitch.size());
  std::partial_sum(pitch.begin(), pitch.end(), list.begin());
  const double mean = std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size());
  for (double& place : list) place -= mean;
  return list;
}

/// Along the base circle.
double on_base(const geometry::Gear& gear) { return gear.base_radius() / gear.reference_radius(); }

class PitchChecks : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    auto& e = planetary(scene_).errors;
    draw(sun_class, e.sun_pitch_class, sun_key, e.sun_pitch, "sun", sun_and_planets(scene_).sun.teeth, 1);
    draw(planet_class, e.planet_pitch_class, planet_key, e.planet_pitch, "planet", sun_and_planets(scene_).planet.teeth,
         scene_.stage.planets);
    // A list is that of all rings.
    const auto other_teeth = [&](const auto& ring) { return ring.teeth != planetary(scene_).rings.front().teeth; };
    if (e.ring_pitch_class && std::any_of(planetary(scene_).rings.begin(), planetary(scene_).rings.end(), other_teeth))
      problem(ring_class, "needs rings with the same number of teeth: they have the same deviations");
    else if (!planetary(scene_).rings.empty())
      draw(ring_class, e.ring_pitch_class, ring_key, e.ring_pitch, "ring", planetary(scene_).rings.front().teeth, 1);
    if (usable("sun.teeth")) list(sun_key, e.sun_pitch, sun_and_planets(scene_).sun.teeth, 1);
    if (usable("planet.teeth") && usable("stage.planets"))
      list(planet_key, e.planet_pitch, sun_and_planets(scene_).planet.teeth, scene_.stage.planets);
    for (const auto& ring : planetary(scene_).rings)
      if (usable("ring.teeth", ring.name)) list(ring_key, e.ring_pitch, ring.teeth, 1);
  }

 private:
  /// Deviations that just keep a flank tolerance class, of as many gears.
  void draw(const char* key, const std::optional<int>& flank_class, const char* list_key, std::vector<double>& list,
            const std::string& gear, int teeth, int gears) {
    if (!flank_class || !usable(key) || given(list_key) || teeth < 3 || !usable("stage.module_mm")) return;
    const auto& stage = scene_.stage;
    const geometry::ToleranceGear toleranced{teeth, stage.module, teeth * stage.module / std::cos(stage.helix_angle),
                                             stage.helix_angle};
    try {
      const dynamics::PitchTolerances tolerances{teeth, geometry::single_pitch_tolerance(toleranced, *flank_class),
                                                 geometry::cumulative_pitch_tolerance(toleranced, *flank_class)};
      list.clear();
      for (int n = 1; n <= gears; ++n) {
        const auto one = dynamics::drawn_pitch_deviations(
            tolerances, static_cast<std::uint64_t>(planetary(scene_).errors.pitch_seed),
            gears > 1 ? fmt::format("{} {}", gear, n) : gear);
        list.insert(list.end(), one.begin(), one.end());
      }
      std::vector<double> shown;
      shown.reserve(list.size());
      for (const double value : list) shown.push_back(value / units::um);
      set(list_key, shown, Origin::derived,
          fmt::format("drawn: f_pT = {} µm and F_pT = {} µm of class {} [ISO1328-1]",
                      to_text(tolerances.single / units::um, 3), to_text(tolerances.cumulative / units::um, 3),
                      *flank_class));
    } catch (const GeometryError& error) {
      problem(key, error.what());
    }
  }

  void list(const char* key, const std::vector<double>& values, int teeth, int gears) {
    if (!given(key) || !usable(key) || values.empty()) return;
    const auto one = static_cast<std::size_t>(teeth), all = one * static_cast<std::size_t>(gears);
    if (values.size() != one && values.size() != all)
      return problem(key, gears > 1
                              ? fmt::format("needs one value per tooth, for one planet that stands for all ({}) or "
                                            "for each of them ({}), not {}",
                                            one, all, values.size())
                              : fmt::format("needs one value per tooth: {} values for {} teeth", values.size(), one));
    // Of values in tenths of a micrometre.
    constexpr double rounding = 0.05 * units::um;
    for (std::size_t first = 0; first < values.size(); first += one) {
      const double sum = std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                                         values.begin() + static_cast<std::ptrdiff_t>(first + one), 0.0);
      if (std::abs(sum) > rounding * static_cast<double>(one))
        return problem(key,
                       fmt::format("the deviations of a gear add up to {:.4g} µm; around the circle they must add up "
                                   "to 0",
                                   sum / units::um));
    }
  }
};

/// The list of one planet.
std::vector<double> of_planet(const std::vector<double>& all, int teeth, int planet) {
  const auto one = static_cast<std::size_t>(teeth);
  const auto first = all.size() == one ? 0 : one * static_cast<std::size_t>(planet);
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(first + one)};
}

}  // namespace

Table pitch_deviation_keys() {
  Declarations errors("errors", "", &PlanetaryInput::errors);
  const std::string meaning =
      ". The distance of each tooth from the one before, counted counter-clockwise, less the pitch, on the reference "
      "circle. Tooth 1 ";
  const auto only_with = [](Declared& key, const std::vector<const char*>& meshes) {
    key.only_if(given("[dynamics]"), "the lumped model has the errors of single teeth");
    for (const auto* mesh : meshes)
      key.only_if(is(std::string("mesh.") + mesh + ".stiffness", {"computed"}),
                  "a prescribed stiffness has no load shares of tooth pairs");
  };
  const auto declare = [&](const std::string& gear, std::vector<double> PlanetaryErrorInput::*member,
                           const std::string& whose, const std::string& first, const std::vector<const char*>& meshes) {
    auto key =
        errors.key(gear + "_pitch_deviations_um", member, "Single pitch deviations of the " + whose + meaning + first);
    key.absent("equal teeth").from(-1000, 1000).longest(20000).not_empty("deviation");
    only_with(key, meshes);
  };
  const auto declare_class = [&](const std::string& gear, std::optional<int> PlanetaryErrorInput::*member,
                                 const std::vector<const char*>& meshes) {
    auto key = errors.key(gear + "_pitch_class", member,
                          std::string("Flank tolerance class of ISO 1328-1 within which the pitch deviations ") +
                              (gear == "planet" ? "of every planet" : "of the " + gear) +
                              " are drawn: a wave once per turn and independent ones. They are as large as the "
                              "tolerances of single and cumulative pitch permit.");
    key.absent("not drawn").from(geometry::best_flank_class, geometry::worst_flank_class);
    key.refused_if(given("errors." + gear + "_pitch_deviations_um"), "the list states the deviations");
    only_with(key, meshes);
  };
  declare("sun", &PlanetaryErrorInput::sun_pitch, "sun", "meets planet 1 at time 0.", {"sun_planet"});
  declare("planet", &PlanetaryErrorInput::planet_pitch,
          "planets: for one that stands for all, or for each of them in turn", "meets the sun at time 0.",
          {"sun_planet", "ring_planet"});
  declare("ring", &PlanetaryErrorInput::ring_pitch, "ring", "meets planet 1 at time 0.", {"ring_planet"});
  declare_class("sun", &PlanetaryErrorInput::sun_pitch_class, {"sun_planet"});
  declare_class("planet", &PlanetaryErrorInput::planet_pitch_class, {"sun_planet", "ring_planet"});
  declare_class("ring", &PlanetaryErrorInput::ring_pitch_class, {"ring_planet"});
  errors.key("pitch_seed", &PlanetaryErrorInput::pitch_seed, "Other seeds give other draws within the pitch classes.")
      .fallback(1, "any number will do")
      .from(0, 2147483647);
  return errors.done();
}

void check_pitch_deviations(Scene& scene, std::vector<Problem>& problems) { PitchChecks(scene, problems).run(); }

void mirror_pitch_deviations(Scene& scene) {
  const auto turned = [](const std::vector<double>& pitch) {
    std::vector<double> list(pitch.size());
    for (std::size_t i = 0; i < pitch.size(); ++i)
      list[i] = pitch[number(1 - static_cast<std::ptrdiff_t>(i), pitch.size())];
    return list;
  };
  auto& e = planetary(scene).errors;
  e.sun_pitch = turned(e.sun_pitch);
  e.ring_pitch = turned(e.ring_pitch);
  const auto teeth = static_cast<std::size_t>(sun_and_planets(scene).planet.teeth);
  if (teeth == 0 || e.planet_pitch.size() % teeth != 0) return;  // reported elsewhere
  std::vector<double> planets;
  for (std::size_t first = 0; first < e.planet_pitch.size(); first += teeth) {
    const auto begin = e.planet_pitch.begin() + static_cast<std::ptrdiff_t>(first);
    const auto one = turned({begin, begin + static_cast<std::ptrdiff_t>(teeth)});
    planets.insert(planets.end(), one.begin(), one.end());
  }
  e.planet_pitch = std::move(planets);
}

PeriodicCurve error_of_gaps(const std::vector<double>& gaps, const PairShares& shares) {
  std::vector<double> values;
  for (std::size_t cycle = 0; cycle < gaps.size(); ++cycle)
    for (const auto& share : shares.share) {
      double sum = 0;
      for (std::size_t i = 0; i < share.size(); ++i)
        sum += share[i] * gaps[number(static_cast<std::ptrdiff_t>(cycle + i) + shares.first, gaps.size())];
      values.push_back(sum);
    }
  return {values, shares.phases};
}

void add_pitch_deviations(const Scene& scene, const geometry::PlanetarySet& set, const MeshResult& sun_mesh,
                          const MeshResult& ring_mesh, dynamics::PlanetaryStage& stage) {
  const auto& e = planetary(scene).errors;
  if (e.sun_pitch.empty() && e.planet_pitch.empty() && e.ring_pitch.empty()) return;
  const auto planets = static_cast<std::size_t>(set.planets());
  stage.sun_tooth_errors.resize(planets);
  stage.ring_tooth_errors.resize(planets);
  // Before a mesh is solved, as the plan sees it: one pair after the other.
  const PairShares one_pair{1, 0, {{1}}};
  const auto& of_sun = sun_mesh.shares.phases > 0 ? sun_mesh.shares : one_pair;
  const auto& of_ring = ring_mesh.shares.phases > 0 ? ring_mesh.shares : one_pair;
  // A tooth that is ahead counter-clockwise closes the gap where its leading flank carries, and opens it at the
  // planet's flank on the ring. Towards planets, at the pitch point, teeth of the sun pass clockwise, all others the
  // other way.
  const auto gaps = [&](const std::vector<double>& pitch, const geometry::Gear& gear, double sign, int direction) {
    const auto place = places(pitch);
    std::vector<double> list(place.size());
    for (std::size_t c = 0; c < list.size(); ++c)
      list[c] = sign * on_base(gear) * place[number(direction * static_cast<std::ptrdiff_t>(c), place.size())];
    return list;
  };
  const double half_turn = set.cycles_from_sun_to_ring();
  for (int n = 0; n < set.planets(); ++n) {
    auto &sun = stage.sun_tooth_errors[static_cast<std::size_t>(n)],
         &ring = stage.ring_tooth_errors[static_cast<std::size_t>(n)];
    if (!e.sun_pitch.empty())
      sun.push_back({error_of_gaps(gaps(e.sun_pitch, set.sun(), -1, -1), of_sun),
                     -set.sun().teeth() * set.planet_angle(n) / (2 * std::numbers::pi)});
    if (!e.planet_pitch.empty()) {
      const auto pitch = of_planet(e.planet_pitch, sun_and_planets(scene).planet.teeth, n);
      sun.push_back({error_of_gaps(gaps(pitch, set.planet(), -1, 1), of_sun), -set.sun_phase_lag(n)});
      // The same tooth, as near to this as the phase of the ring mesh lets it be.
      const double lag = set.sun_phase_lag(n) + half_turn, whole = std::round(lag - set.ring_phase_lag(n));
      ring.push_back({error_of_gaps(gaps(pitch, set.planet(), 1, 1), of_ring), -set.ring_phase_lag(n) - whole});
    }
    if (!e.ring_pitch.empty())
      ring.push_back({error_of_gaps(gaps(e.ring_pitch, set.ring(), -1, 1), of_ring),
                      set.ring_tooth_offset(n) - set.ring_phase_lag(n)});
  }
}

}  // namespace annulus::app
