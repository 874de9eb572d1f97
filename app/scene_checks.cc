#include "app/scene_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace annulus::app {

namespace {

class Checker {
 public:
  Checker(Scene& scene, std::vector<Problem>& problems) : scene_(scene), problems_(problems) {}

  void run() {
    if (!stage()) return;
    errors();
    ring_names();
    // Rings of the same name cannot be told apart by the rules between keys, so only the first one is checked.
    std::set<std::string> seen;
    for (const auto& ring : scene_.rings) {
      if (seen.insert(ring.name).second) check_ring(ring);
    }
    mesh(scene_.sun_planet, "mesh.sun_planet");
    mesh(scene_.ring_planet, "mesh.ring_planet");
    computed_meshes();
    dynamics();
  }

 private:
  [[nodiscard]] const Input* find(const std::string& key, const std::string& ring = "") const {
    for (const auto& input : scene_.inputs) {
      if (input.key == key && input.ring == ring) return &input;
    }
    return nullptr;
  }

  /// Written in the scene, with whatever value.
  [[nodiscard]] bool given(const std::string& key, const std::string& ring = "") const {
    const Input* input = find(key, ring);
    return input && input->origin == Origin::scene;
  }

  /// Written in the scene with a value of the right type and range, or left to its default.
  [[nodiscard]] bool usable(const std::string& key, const std::string& ring = "") const {
    const Input* input = find(key, ring);
    return input && !std::holds_alternative<std::monostate>(input->value);
  }

  void problem(const std::string& key, const std::string& ring, const std::string& rule) {
    const Input* input = find(key, ring);
    std::string head = key;
    if (input && input->origin == Origin::scene) head += " = " + to_text(input->value);
    if (!ring.empty()) head += " (ring '" + ring + "')";
    problems_.push_back({input ? input->line : 0, input ? input->column : 0, head + ": " + rule});
  }

  bool stage() {
    const auto& s = scene_.stage;
    if (s.kind != StageKind::planetary) {
      problem("stage.kind", "", "is not yet available in this version; only \"planetary\" is");
      return false;
    }
    const bool sun = given("stage.sun_speed_rpm"), carrier = given("stage.carrier_speed_rpm");
    if (sun && carrier) {
      problem("stage.carrier_speed_rpm", "",
              "give either sun_speed_rpm or carrier_speed_rpm, one follows from the other");
    } else if (!sun && !carrier && usable("stage.kind")) {
      problem("stage.sun_speed_rpm", "",
              "give the speed of the sun (sun_speed_rpm) or of the carrier (carrier_speed_rpm)");
    }
    if (scene_.rung == Rung::closed_form || scene_.rung == Rung::resolved) {
      problem("rung", "", "is not yet available in this version; \"automatic\", \"plane\" and \"solid\" are");
    }
    return true;
  }

  void errors() {
    auto& e = scene_.errors;
    list("errors.planet_eccentricity_um", e.planet_eccentricity);
    list("errors.planet_eccentricity_phase_deg", e.planet_eccentricity_phase);
    list("errors.planet_installation_um", e.planet_installation);
    list("errors.planet_installation_phase_deg", e.planet_installation_phase);
  }

  void list(const std::string& key, std::vector<double>& values) {
    if (!usable("stage.planets") || (given(key) && !usable(key))) return;
    const auto planets = static_cast<std::size_t>(scene_.stage.planets);
    if (values.empty() && !given(key)) values.assign(planets, 0);
    if (values.size() != planets) {
      problem(key, "", fmt::format("needs one value per planet: {} values for {} planets", values.size(), planets));
    }
  }

  void check_ring(const RingInput& ring) {
    const auto& name = ring.name;
    const auto either = [&](const char* key) { return given(key, name); };
    if (either("ring.outside_diameter_mm") && either("ring.rim_thickness_mm")) {
      problem("ring.rim_thickness_mm", name,
              "give either outside_diameter_mm or rim_thickness_mm, one follows from the other");
    } else if (!either("ring.outside_diameter_mm") && !either("ring.rim_thickness_mm")) {
      problem("ring.outside_diameter_mm", name, "give outside_diameter_mm or rim_thickness_mm");
    }
    if (!usable("ring.structure", name)) return;
    const bool sleeve = ring.structure == Structure::thin_walled;
    const bool pins = ring.structure == Structure::pinned || ring.structure == Structure::bolted;
    required_if(sleeve, {"ring.free_length_mm", "ring.sleeve_thickness_mm"}, name, "structure = \"thin_walled\"");
    forbidden_unless(
        sleeve, {"ring.free_length_mm", "ring.sleeve_thickness_mm", "ring.hoop_width_mm", "ring.hoop_thickness_mm"},
        name, "structure = \"thin_walled\"");
    required_if(pins, {"ring.pins", "ring.pin_diameter_mm"}, name, "structure = \"pinned\" or \"bolted\"");
    forbidden_unless(pins,
                     {"ring.pins", "ring.pin_diameter_mm", "ring.pin_clearance_um", "ring.pin_radial_stiffness_N_per_m",
                      "ring.first_pin_angle_deg"},
                     name, "structure = \"pinned\" or \"bolted\"");
    forbidden_unless(ring.structure != Structure::bolted, {"ring.pin_clearance_um"}, name, "structure = \"pinned\"");
    if (sleeve && scene_.rung == Rung::plane) {
      problem("rung", "", fmt::format("a plane model cannot represent the sleeve of thin_walled ring '{}'", name));
    }
  }

  void required_if(bool condition, const std::vector<std::string>& keys, const std::string& ring, const char* why) {
    if (!condition) return;
    for (const auto& key : keys) {
      if (!given(key, ring)) problem(key, ring, fmt::format("is required by {}", why));
    }
  }

  void forbidden_unless(bool condition, const std::vector<std::string>& keys, const std::string& ring,
                        const char* why) {
    if (condition) return;
    for (const auto& key : keys) {
      if (given(key, ring)) problem(key, ring, fmt::format("has a meaning only with {}", why));
    }
  }

  void ring_names() {
    constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.";
    std::set<std::string> seen;
    for (const auto& ring : scene_.rings) {
      if (seen.contains(ring.name)) continue;
      seen.insert(ring.name);
      const bool good = !ring.name.empty() && ring.name.front() != '.' &&
                        ring.name.find_first_not_of(allowed) == std::string::npos && ring.name.size() <= 64;
      if (!good) {
        problem("ring.name", ring.name,
                "names a folder: letters, digits, '-', '_', '+' and '.' only, not starting with '.'");
      }
    }
    seen.clear();
    for (const auto& input : scene_.inputs) {
      if (input.key != "ring.name" || seen.insert(input.ring).second) continue;
      problems_.push_back(
          {input.line, input.column,
           fmt::format("ring.name = {}: is the name of more than one ring; each needs its own", input.ring)});
    }
  }

  void mesh(const MeshInput& m, const std::string& path) {
    if (given(path + ".stiffness") && !usable(path + ".stiffness")) return;
    const auto needs = [&](bool condition, const char* key, const char* shapes) {
      if (condition && !given(path + key)) problem(path + key, "", std::string("is required by stiffness = ") + shapes);
      if (!condition && given(path + key))
        problem(path + key, "", std::string("has a meaning only with stiffness = ") + shapes);
    };
    const bool wave = m.stiffness == StiffnessShape::harmonic || m.stiffness == StiffnessShape::rectangular;
    needs(wave || m.stiffness == StiffnessShape::constant, ".mean_N_per_m",
          "\"constant\", \"harmonic\" or \"rectangular\"");
    needs(wave, ".ripple", "\"harmonic\" or \"rectangular\"");
    needs(m.stiffness == StiffnessShape::rectangular, ".duty", "\"rectangular\"");
    needs(m.stiffness == StiffnessShape::table, ".file", "\"table\"");
    if (!wave && given(path + ".phase")) problem(path + ".phase", "", "has a meaning only with a wave");
    if (m.stiffness == StiffnessShape::harmonic && m.ripple && *m.ripple >= 1) {
      problem(path + ".ripple", "", "must stay below 1: the stiffness would become negative");
    }
    if (m.stiffness == StiffnessShape::rectangular && m.ripple && m.duty && *m.ripple * *m.duty >= 1) {
      problem(path + ".ripple", "", "times duty must stay below 1: the stiffness would become negative");
    }
  }

  void computed_meshes() {
    const auto bore = [&](const char* key, bool computed, const char* which) {
      if (computed && !given(key)) problem(key, "", fmt::format("is required because the {} mesh is computed", which));
    };
    const bool sun = scene_.sun_planet.stiffness == StiffnessShape::computed;
    const bool ring = scene_.ring_planet.stiffness == StiffnessShape::computed;
    bore("sun.bore_diameter_mm", sun, "sun-planet");
    bore("planet.bore_diameter_mm", sun || ring, sun ? "sun-planet" : "ring-planet");
  }

  void dynamics() {
    if (!scene_.dynamics) return;
    const auto need = [&](const std::string& key, const std::string& ring = "") {
      if (!given(key, ring)) problem(key, ring, "is required by [dynamics]");
    };
    need("sun.mass_kg");
    need("sun.inertia_kg_m2");
    need("planet.mass_kg");
    need("planet.inertia_kg_m2");
    need("carrier.mass_kg");
    need("carrier.inertia_kg_m2");
    for (const auto& ring : scene_.rings) {
      need("ring.mass_kg", ring.name);
      need("ring.inertia_kg_m2", ring.name);
    }
  }

  Scene& scene_;
  std::vector<Problem>& problems_;
};

}  // namespace

void complete_and_check(Scene& scene, std::vector<Problem>& problems) { Checker(scene, problems).run(); }

}  // namespace annulus::app
