#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/model/gear_system.h"
#include "core/files.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_edit.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

// Motions at and beyond the ends of what a scene can say, through the whole program: each ends with results whose
// balances hold and whose errors are told, or is refused with its reason.

namespace annulus {

namespace {

using Changes = std::vector<std::pair<std::string, std::string>>;
using nlohmann::json;

/// `text` with keys ("stage.sun_speed_rpm") set to values.
std::string changed(const std::string& text, const Changes& changes) {
  test::SceneEdit scene(text);
  for (const auto& [key, value] : changes) {
    const auto dot = key.rfind('.');
    const std::string path = key.substr(0, dot), name = key.substr(dot + 1);
    const app::Table* found = nullptr;
    for (const auto& table : app::schema())
      if (table.path == path) found = &table;
    if (!found) throw std::logic_error("no table " + path);
    scene.set(*found, name, value);
  }
  return scene.text();
}

/// Given stiffness, in its steady state.
std::string quick() { return test::replaced(test::quick_scene(), "mesh_cycles = 110\n", ""); }

/// Rectangular stiffness, sun floating, no errors (the reducer of the backlash paper).
std::string jumping() {
  return changed(quick(), {{"mesh.sun_planet.stiffness", "\"rectangular\""},
                           {"mesh.sun_planet.duty", "0.54"},
                           {"mesh.ring_planet.stiffness", "\"rectangular\""},
                           {"mesh.ring_planet.duty", "0.58"},
                           {"errors.planet_eccentricity_um", "[0, 0, 0, 0, 0]"}});
}

/// A speed under the same torque, or another torque.
Changes at(double rpm, double torque_factor = 1) {
  return {{"stage.sun_speed_rpm", fmt::format("{:.17g}", rpm)},
          {"stage.power_kW", fmt::format("{:.17g}", 2958.8 * rpm / 1128 * torque_factor)}};
}

/// `planets` small ones around a large sun.
std::string many_planets(int planets, double backlash_um = 50) {
  std::string errors = "[10", phases = "[0";
  for (int n = 1; n < planets; ++n) errors += ", 0", phases += ", 0";
  return changed(quick(), {{"stage.planets", std::to_string(planets)},
                           {"stage.module_mm", "2"},
                           {"stage.pressure_angle_deg", "20"},
                           {"stage.face_width_mm", "30"},
                           {"stage.centre_distance_mm", "220"},
                           {"stage.power_kW", "1500"},
                           {"sun.teeth", "200"},
                           {"sun.profile_shift", "0"},
                           {"planet.teeth", "20"},
                           {"planet.profile_shift", "0"},
                           {"ring.teeth", "240"},
                           {"ring.profile_shift", "0"},
                           {"ring.outside_diameter_mm", "510"},
                           {"ring.tip_diameter_mm", "477"},
                           {"dynamics.half_backlash_um", fmt::format("{}", backlash_um)},
                           {"errors.planet_eccentricity_um", errors + "]"},
                           {"errors.planet_eccentricity_phase_deg", phases + "]"}});
}

/// Every number is finite; a null is one only where no such value exists, and then has no error.
void check_numbers(const json& value, const std::string& place, std::vector<std::string>& problems) {
  if (value.is_object()) {
    if (value.contains("value") && value.contains("error") && value["value"].is_null() && !value["error"].is_null())
      problems.push_back(place + ": an error without a value");
    if (value.contains("error") && value["error"].is_number() && value["error"] < 0)
      problems.push_back(place + ": a negative error");
    for (const auto& [key, part] : value.items()) check_numbers(part, place + "/" + key, problems);
  } else if (value.is_array()) {
    for (const auto& part : value) check_numbers(part, place, problems);
  } else if (value.is_number() && !std::isfinite(value.get<double>())) {
    problems.push_back(place + ": not finite");
  }
}

double largest_number(const json& list) {
  double largest = 0;
  for (const auto& x : list) largest = std::max(largest, std::abs((x.is_object() ? x.at("value") : x).get<double>()));
  return largest;
}

/// The balances of the motion of one stage.
void check_balances(const json& dynamics, double largest_factor, std::vector<std::string>& problems) {
  const auto check = [&](const char* name, double limit) {
    if (!dynamics.contains(name) || dynamics[name].is_null()) return;
    const double value = dynamics[name];
    if (!(value <= limit)) problems.push_back(fmt::format("{} = {:.3g}", name, value));
  };
  check("energy_balance_relative", 0.02);
  // Of the samples, which see impacts less well than the integration does: in units of the largest force.
  check("force_balance_relative", 1e-3 * std::max(1.0, largest_factor));
  check("torque_balance_relative", 1e-3);
}

struct Tally {
  int tried = 0, survived = 0, refused = 0, failed = 0;
  double seconds = 0;
  void count(const Tally& other) {
    tried += other.tried, survived += other.survived, refused += other.refused, failed += other.failed;
    seconds += other.seconds;
  }
};

class Matrix {
 public:
  explicit Matrix(const std::string& name) : name_(name), folder_("extreme_" + name) {
    ::setenv("ANNULUS_CACHE", "", 1);
  }
  Matrix(const Matrix&) = delete;
  Matrix& operator=(const Matrix&) = delete;
  ~Matrix() {
    BOOST_TEST_MESSAGE(fmt::format("{}: {} tried, {} survived, {} refused, {} failed; {:.0f} s", name_, tally_.tried,
                                   tally_.survived, tally_.refused, tally_.failed, tally_.seconds));
  }

  /// The summary; empty where the scene was refused. `refusal`: what its message says (a key); empty: may not happen.
  json run(const std::string& what, const std::string& scene, const std::string& refusal = "") {
    ++tally_.tried;
    const auto start = std::chrono::steady_clock::now();
    const auto folder = folder_.path() / fmt::format("case{}", tally_.tried);
    std::filesystem::create_directories(folder);
    write_file(folder / "scene.toml", scene);
    const auto outcome = test::run_program(folder, "run scene.toml -o out --quiet --threads 1 --max-time 100s");
    std::vector<std::string> problems;
    json summary;
    if (outcome.status == 0) {
      summary = json::parse(read_file(folder / "out" / "summary.json"));
      check_numbers(summary, "", problems);
      if (!refusal.empty()) problems.push_back("should have been refused");
      if (summary.contains("rings"))
        for (const auto& ring : summary["rings"]) {
          double largest = 0;
          for (const auto& factors : ring["peak_factor"]) largest = std::max(largest, largest_number(factors));
          check_balances(ring["dynamics"], largest, problems);
          for (const auto& mesh : ring["load_sharing"]) {
            const auto& still = mesh["quasi_static"]["value"];
            // Where no flank bears backwards, no planet carries more than all.
            const bool bound = !backward_flanks_;
            const auto planets = static_cast<double>(ring["dynamic_factor"]["sun_planet"].size());
            if (!still.is_number() || still < 1 - 1e-9 || (bound && still > planets * (1 + 1e-9)))
              problems.push_back("quasi-static load sharing " + still.dump());
          }
        }
      for (const char* part : {"dynamics", "motion"})
        if (summary.contains(part)) check_balances(summary[part], 1, problems);
    } else {
      const bool status = outcome.status == 2 || outcome.status == 3;
      if (!status) problems.push_back(fmt::format("status {}", outcome.status));
      if (refusal.empty() || outcome.err.find(refusal) == std::string::npos)
        problems.push_back("refused: " + outcome.err);
      if (std::filesystem::exists(folder / "out" / "summary.json")) problems.push_back("results of a refused scene");
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    tally_.seconds += seconds;
    if (seconds > 60) problems.push_back(fmt::format("took {:.0f} s", seconds));
    ++(!problems.empty() ? tally_.failed : outcome.status == 0 ? tally_.survived : tally_.refused);
    for (const auto& problem : problems) BOOST_ERROR(name_ << ", " << what << ": " << problem);
    std::filesystem::remove_all(folder);
    return problems.empty() ? summary : json{};
  }

  /// From here on backlash is narrower than the errors: planets may push against each other.
  void let_flanks_bear_backwards(bool let) { backward_flanks_ = let; }

  /// A figure of two scenes that has to agree: within `tolerance` and both errors.
  void same(const std::string& what, const std::string& a, const std::string& b, double tolerance) {
    const auto first = run(what, a), second = run(what + " (the other)", b);
    if (first.is_null() || second.is_null()) return;
    for (const char* mesh : {"sun_planet", "ring_planet"})
      for (const char* kind : {"instantaneous", "averaged", "quasi_static"}) {
        const auto& one = first["rings"].front()["load_sharing"][mesh][kind];
        const auto& other = second["rings"].front()["load_sharing"][mesh][kind];
        const double x = one["value"], y = other["value"];
        BOOST_TEST(std::abs(x - y) <= tolerance + one["error"].get<double>() + other["error"].get<double>(),
                   what << ", " << mesh << ", " << kind << ": " << x << " and " << y);
      }
  }

 private:
  std::string name_;
  test::TemporaryFolder folder_;
  Tally tally_;
  bool backward_flanks_ = false;
};

Changes both(Changes a, const Changes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(extreme_motions)

BOOST_AUTO_TEST_CASE(speed) {
  Matrix matrix("speed");
  for (const double rpm : {0.01, 1.0, 30.0, 300.0, 5000.0, 3e4, 1e5})
    matrix.run(fmt::format("{} r/min", rpm), changed(quick(), at(rpm)));
  matrix.run("1e6 r/min", changed(quick(), at(1e6, 0.1)));
  matrix.run("jumps at 1 r/min", changed(jumping(), at(1)));
  matrix.run("jumps at 1e5 r/min", changed(jumping(), at(1e5)));
  matrix.run("no speed", changed(quick(), {{"stage.sun_speed_rpm", "0"}}), "sun_speed_rpm");
  matrix.run("jumps undamped at 0.01 r/min",
             changed(jumping(),
                     both(at(0.01), {{"dynamics.mesh_damping_ratio", "0"}, {"dynamics.support_damping_ratio", "0"}})),
             "--max-time");
}

BOOST_AUTO_TEST_CASE(damping) {
  Matrix matrix("damping");
  for (const char* ratio : {"0", "1e-6", "1", "2"}) {
    const Changes all = {{"dynamics.mesh_damping_ratio", ratio}, {"dynamics.support_damping_ratio", ratio}};
    matrix.run(std::string("all ") + ratio, changed(quick(), all));
    matrix.run(std::string("jumps, all ") + ratio, changed(jumping(), all));
  }
  matrix.run("mesh 2", changed(quick(), {{"dynamics.mesh_damping_ratio", "2"}}));
  matrix.run("support 0", changed(quick(), {{"dynamics.support_damping_ratio", "0"}}));
  matrix.run("beyond", changed(quick(), {{"dynamics.mesh_damping_ratio", "2.1"}}), "mesh_damping_ratio");
}

BOOST_AUTO_TEST_CASE(supports) {
  Matrix matrix("supports");
  // Planets bear their load alone, the others are held in the middle by them.
  for (const std::string key : {"sun", "ring", "carrier", "planet"})
    for (const char* stiffness : {"1e-3", "1e3", "1e8", "1e12", "1e14"})
      matrix.run(fmt::format("{} {}", key, stiffness),
                 changed(quick(), {{fmt::format("supports.{}_N_per_m", key), stiffness}}),
                 key == "planet" && std::atof(stiffness) < 1e7 ? "planet_N_per_m" : "");
  for (const char* stiffness : {"1", "1e6"})
    matrix.run(std::string("ring turning on ") + stiffness,
               changed(quick(), {{"supports.ring_torsional_N_per_m", stiffness}}), "ring_torsional_N_per_m");
  matrix.run("ring turning on 1e9", changed(quick(), {{"supports.ring_torsional_N_per_m", "1e9"}}));
  for (const char* key : {"sun", "ring", "carrier", "planet"})
    matrix.same(std::string("rigid ") + key, changed(quick(), {{fmt::format("supports.{}_N_per_m", key), "1e15"}}),
                changed(quick(), {{fmt::format("supports.{}_N_per_m", key), "inf"}}), 1e-5);
  matrix.same("free sun", changed(quick(), {{"supports.sun_N_per_m", "0"}}),
              changed(quick(), {{"supports.sun_N_per_m", "1e-3"}}), 1e-6);
  matrix.run("free ring", changed(quick(), {{"supports.ring_N_per_m", "0"}}));
  matrix.run("free carrier", changed(quick(), {{"supports.carrier_N_per_m", "0"}}));
  matrix.run("free planets", changed(quick(), {{"supports.planet_N_per_m", "0"}}), "planet_N_per_m");
  matrix.run("ring free to turn", changed(quick(), {{"supports.ring_torsional_N_per_m", "0"}}), "leaves the ring free");
  matrix.run("soft and stiff at once", changed(quick(), {{"supports.sun_N_per_m", "1e-3"},
                                                         {"supports.planet_N_per_m", "1e14"},
                                                         {"supports.ring_N_per_m", "1e14"},
                                                         {"supports.carrier_N_per_m", "1e3"}}));
}

BOOST_AUTO_TEST_CASE(planets) {
  Matrix matrix("planets");
  matrix.run("1", many_planets(1), "sun_N_per_m");
  matrix.run("1, its sun held", changed(many_planets(1), {{"supports.sun_N_per_m", "1e9"}}));
  for (const int n : {2, 4, 5, 8, 10, 11, 20}) matrix.run(fmt::format("{}", n), many_planets(n));
  matrix.run("three do not fit in equal places", many_planets(3), "assembly condition");
  matrix.run("too many", many_planets(40), "collide");
}

// With 200 + 240 teeth planets fit every 9/11 degrees.
BOOST_AUTO_TEST_CASE(unequal_places) {
  Matrix matrix("unequal places");
  const auto placed = [](const std::vector<double>& degrees, const Changes& more = {}) {
    const auto places = fmt::format("[{}]", fmt::join(degrees, ", "));
    return changed(many_planets(static_cast<int>(degrees.size())), both({{"stage.planet_angles_deg", places}}, more));
  };
  const auto quasi_static = [](const json& summary) {
    return summary.is_null()
               ? 0.0
               : summary["rings"].front()["load_sharing"]["sun_planet"]["quasi_static"]["value"].get<double>();
  };
  // Equal places, told one by one, change nothing.
  matrix.same("four", many_planets(4), placed({0, 90, 180, 270}), 1e-12);
  // A sun without bearing shares by equilibrium alone: by the sines of the angles between the two others.
  const auto sine = [](double degrees) { return std::sin(degrees * std::numbers::pi / 180); };
  const double sum = sine(135) + sine(135) + sine(90);
  const auto three = matrix.run("three, no bearing", placed({0, 90, 225}, {{"supports.sun_N_per_m", "0"}}));
  BOOST_TEST(quasi_static(three) == 3 * std::max(sine(135), sine(90)) / sum, boost::test_tools::tolerance(1e-9));
  matrix.run("three", placed({0, 90, 225}));
  matrix.run("a pair beside one", placed({0, 16.36, 180}));
  matrix.run("five", placed({0, 45, 117, 180, 288}));
  matrix.run("nineteen and a gap",
             placed({0, 18, 36, 54, 72, 90, 108, 126, 144, 162, 180, 198, 216, 234, 252, 270, 288, 306, 324}));
  matrix.run("on one side", placed({0, 18, 36}), "supports.sun_N_per_m");
  matrix.run("on one side, all held", placed({0, 18, 36}, {{"supports.sun_N_per_m", "1e10"}}));
  matrix.run("two, not opposite", placed({0, 90}), "supports.sun_N_per_m");
  matrix.run("between two places", placed({0, 90.4, 225}), "planet 2 at 90.4 degrees");
  matrix.run("falling", placed({0, 225, 90}), "stage.planet_angles_deg");
  matrix.run("too near", placed({0, 9, 225}), "collide");
}

BOOST_AUTO_TEST_CASE(torque_errors_and_backlash) {
  Matrix matrix("torque");
  for (const double factor : {1e-9, 1e-6, 1e-3, 1e-2, 0.1, 10.0})
    matrix.run(fmt::format("times {}", factor), changed(quick(), at(1128, factor)));
  const auto stiff = changed(quick(), {{"supports.planet_N_per_m", "inf"}});
  matrix.run("times 100", changed(quick(), at(1128, 100)), "planet_N_per_m");
  matrix.run("times 300, planets held", changed(stiff, at(1128, 300)), "power_kW");
  // Of meshes a thousand times as stiff.
  matrix.run("times 1000", changed(stiff, both(at(112.8, 1000), {{"mesh.sun_planet.mean_N_per_m", "1e12"},
                                                                 {"mesh.ring_planet.mean_N_per_m", "1e12"}})));
  matrix.run("none", changed(quick(), {{"stage.power_kW", "0"}}), "power_kW");
  matrix.run("reversed", changed(quick(), {{"stage.power_kW", "-2958.8"}}), "power_kW");
  // Without errors nothing but the load deflects: it divides out.
  const auto even = changed(quick(), {{"errors.planet_eccentricity_um", "[0, 0, 0, 0, 0]"}});
  for (const double factor : {1e-9, 10.0})
    matrix.same(fmt::format("even, times {}", factor), changed(even, at(1128, factor)), even, 1e-6);
  const auto with_error = [](const char* error) {
    return changed(quick(), {{"errors.planet_eccentricity_um", fmt::format("[{}, 0, 0, 0, 0]", error)}});
  };
  for (const char* error : {"1e-3", "100", "1000"}) matrix.run(std::string("error ") + error, with_error(error));
  matrix.run("error 10000", with_error("10000"), "planet_eccentricity_um");
  for (const char* backlash : {"0", "1e-3", "1", "10", "1e4"}) {
    matrix.let_flanks_bear_backwards(std::atof(backlash) < 10);
    for (const double factor : {0.01, 1.0})
      matrix.run(fmt::format("backlash {}, load times {}", backlash, factor),
                 changed(quick(), both(at(1128, factor), {{"dynamics.half_backlash_um", backlash}})));
  }
  matrix.run("errors on light loads without damping",
             changed(quick(), both(at(1128, 0.01), {{"dynamics.mesh_damping_ratio", "0"}})));
}

BOOST_AUTO_TEST_CASE(cycles_and_integrators) {
  Matrix matrix("integration");
  for (const char* cycles : {"1", "2", "54", "56", "20000"})
    matrix.run(std::string(cycles) + " cycles", changed(quick(), {{"dynamics.mesh_cycles", cycles}}));
  for (const char* method : {"\"explicit\"", "\"adams\"", "\"bdf\"", "\"implicit\""}) {
    const Changes few = {{"dynamics.integrator", method}, {"dynamics.mesh_cycles", "20"}};
    matrix.run(method, changed(quick(), few));
    matrix.run(std::string(method) + " stiff", changed(quick(), both(few, {{"supports.sun_N_per_m", "1e13"}})));
    matrix.run(std::string(method) + " light", changed(quick(), both(few, at(1128, 0.01))));
  }
  const Changes fixed = {{"dynamics.integrator", "\"runge_kutta_4\""}, {"dynamics.mesh_cycles", "60"}};
  const auto with_steps = [&](const char* steps) {
    return changed(quick(), both(fixed, {{"dynamics.steps_per_cycle", steps}}));
  };
  matrix.run("fixed 10", with_steps("10"), "steps_per_cycle");
  for (const char* steps : {"20", "200"}) matrix.run(std::string("fixed ") + steps, with_steps(steps));
  matrix.run("fixed, stiff",
             changed(quick(), both(fixed, {{"dynamics.steps_per_cycle", "50"}, {"supports.sun_N_per_m", "1e13"}})),
             "steps_per_cycle");
  for (const char* tolerance : {"1e-12", "1e-2"})
    matrix.run(std::string("tolerance ") + tolerance,
               changed(quick(), {{"dynamics.mesh_cycles", "110"}, {"dynamics.relative_tolerance", tolerance}}));
  matrix.run("a heavy, a light planet",
             changed(quick(), {{"planet.inertia_kg_m2", "1e-9"}, {"planet.mass_kg", "1e-6"}}));
  matrix.run("a heavy planet", changed(quick(), {{"planet.inertia_kg_m2", "1e4"}, {"planet.mass_kg", "1e5"}}));
}

// Frequencies a million times lower or higher, by the masses: nothing else changes.
BOOST_AUTO_TEST_CASE(units_of_time) {
  Matrix matrix("time");
  const auto scaled = [](const std::string& text, double unit) {
    const auto times = [&](double x) { return fmt::format("{:.17g}", x * unit * unit); };
    return changed(text, {{"stage.sun_speed_rpm", fmt::format("{:.17g}", 1128 / unit)},
                          {"stage.power_kW", fmt::format("{:.17g}", 2958.8 / unit)},
                          {"sun.mass_kg", times(66)},
                          {"sun.inertia_kg_m2", times(0.54895)},
                          {"planet.mass_kg", times(8.51)},
                          {"planet.inertia_kg_m2", times(0.09282)},
                          {"carrier.inertia_kg_m2", times(15.3193)}});
  };
  // The bounds of masses (1e6 kg) and speeds (1e6 r/min) end the range of whole scenes; tests of the stage go on to
  // 1e6.
  for (const double unit : {5e-3, 1e2}) {
    matrix.same(fmt::format("unit {}", unit), scaled(quick(), unit), quick(), 1e-6);
    matrix.same(fmt::format("jumps, unit {}", unit), scaled(jumping(), unit), jumping(), 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(pairs) {
  Matrix matrix("pairs");
  const auto pair = test::quick_pair();
  for (const char* rpm : {"0.01", "1", "1e4", "1e6"}) matrix.run(rpm, changed(pair, {{"stage.pinion_speed_rpm", rpm}}));
  for (const char* torque : {"0", "1e-9", "1", "-20000", "-1e-3", "1e5"})
    matrix.run(std::string("torque ") + torque, changed(pair, {{"stage.pinion_torque_Nm", torque}}));
  for (const char* ratio : {"0", "2"})
    matrix.run(std::string("damping ") + ratio,
               changed(pair, {{"dynamics.mesh_damping_ratio", ratio}, {"dynamics.support_damping_ratio", ratio}}));
  for (const char* stiffness : {"1e-3", "1", "1e8", "1e14", "1e15"}) {
    Changes all;
    for (const char* gear : {"pinion", "wheel"})
      for (const char* bearing : {"transverse", "axial"})
        all.emplace_back(fmt::format("{}.bearing_{}_N_per_m", gear, bearing), stiffness);
    matrix.run(std::string("bearings ") + stiffness, changed(pair, all),
               std::atof(stiffness) < 1e7 ? "pinion.bearing_transverse_N_per_m" : "");
  }
  matrix.run("no bearing", changed(pair, {{"pinion.bearing_transverse_N_per_m", "0"}}), "bearing_transverse_N_per_m");
  for (const char* backlash : {"0", "1", "1e4"})
    matrix.run(std::string("light, backlash ") + backlash,
               changed(pair, {{"dynamics.half_backlash_um", backlash}, {"stage.pinion_torque_Nm", "100"}}));
  matrix.run("a pinion of a gram", changed(pair, {{"pinion.mass_kg", "1e-3"}, {"pinion.inertia_kg_m2", "1e-6"}}));
}

BOOST_AUTO_TEST_CASE(reducers) {
  Matrix matrix("reducers");
  const auto reducer = test::reducer_scene();
  for (const char* rpm : {"1e-2", "3000", "1e6"}) matrix.run(rpm, changed(reducer, {{"output.speed_rpm", rpm}}));
  for (const char* torque : {"1e-9", "1e3"})
    matrix.run(std::string("torque ") + torque, changed(reducer, {{"output.torque_Nm", torque}}));
  for (const char* ratio : {"0", "2"})
    matrix.run(std::string("damping ") + ratio,
               changed(reducer, {{"dynamics.mesh_damping_ratio", ratio}, {"dynamics.support_damping_ratio", ratio}}));
  matrix.run("crank bearings 1", changed(reducer, {{"crank.bearing_N_per_m", "1"}}), "crank.bearing_N_per_m");
  for (const char* stiffness : {"1e7", "1e12", "9e13"})
    matrix.run(std::string("crank bearings ") + stiffness, changed(reducer, {{"crank.bearing_N_per_m", stiffness}}));
  for (const char* stiffness : {"1", "1e12"})
    matrix.run(std::string("shaft ") + stiffness, changed(reducer, {{"input.shaft_Nm_per_rad", stiffness}}));
  matrix.run("free output", changed(reducer, {{"output.support_Nm_per_rad", "0"}}));
  matrix.run("one crank", changed(reducer, {{"stage.planets", "1"}}), "planets");
  matrix.run("twenty cranks", changed(reducer, {{"stage.planets", "20"}}), "planets");
  for (const char* torque : {"0.01", "58"})
    matrix.run(std::string("backlash under ") + torque,
               changed(reducer, {{"dynamics.half_backlash_um", "10"}, {"output.torque_Nm", torque}}));
}

// Time of a run in proportion to its mesh cycles, of studies as well; memory by the window that is kept.
BOOST_AUTO_TEST_CASE(the_cost_of_a_million_mesh_cycles_is_foreseen) {
  const auto cost = [](const std::string& text) {
    const auto scene = app::parse_scene(text, "scene.toml");
    return app::make_system(scene)->cost(1);
  };
  const std::string sweep = "[[sweep]]\ninput = \"stage.power_kW\"\nfrom = 1000\nto = 2000\ncount = 50\n";
  const auto some = changed(quick(), {{"dynamics.mesh_cycles", "100000"}}),
             million = changed(quick(), {{"dynamics.mesh_cycles", "1000000"}});
  BOOST_TEST(cost(million).seconds() > 8 * cost(some).seconds());
  BOOST_TEST(cost(million).seconds() > 30);
  BOOST_TEST(cost(million + sweep).seconds() > 45 * cost(million).seconds());
  BOOST_TEST(cost(million).peak_MB() < 1000);
  const auto accurate = changed(jumping(), {{"dynamics.relative_tolerance", "1e-6"}});
  const auto motion = [&](double speed) {
    double seconds = 0;
    for (const auto& step : cost(changed(accurate, at(speed))).steps)
      if (step.kind == app::CostKind::response) seconds += step.predicted.seconds;
    return seconds;
  };
  BOOST_TEST(motion(0.01) > 5 * motion(1));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
