#include "tests/random/random_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "tests/random/gear_sets.h"

namespace annulus::random {

namespace {

using app::Parameter;
using app::Table;

constexpr double usual_chance = 0.25;

bool ends_with(const Parameter& p, const char* ending) { return p.name.ends_with(ending); }

/// A usual size of a number, by its unit and its default.
double usual_number(Draw& draw, const Parameter& p, const Scales& scales) {
  if (ends_with(p, "_um")) {
    const double sign = p.low < 0 && draw.chance(0.3) ? -1 : 1;
    return sign * scales.deflection_um * draw.log_uniform(0.05, 2);
  }
  if (p.name == "protuberance_angle_deg") return draw.uniform(5, 13);
  if (ends_with(p, "_phase_deg") || ends_with(p, "angle_deg")) return draw.uniform(0, 360);
  if (ends_with(p, "_N_per_m")) return scales.stiffness_N_per_m * draw.log_uniform(0.03, 30);
  if (ends_with(p, "_Nm_per_rad")) return scales.torsional_Nm_per_rad * draw.log_uniform(0.3, 300);
  if (p.name == "protuberance_um") return 1e3 * scales.module_mm * draw.uniform(0.005, 0.03);
  if (ends_with(p, "chamfer_mm")) return scales.module_mm * draw.uniform(0.03, 0.12);
  if (p.name == "planet_pin_diameter_mm") return scales.module_mm * draw.uniform(6, 12);
  if (p.name == "planet_pin_length_mm") return scales.module_mm * draw.uniform(8, 25);
  if (ends_with(p, "length_mm")) return scales.module_mm * draw.uniform(0.1, 0.6);
  if (ends_with(p, "damping_ratio")) return draw.log_uniform(0.01, 0.15);
  if (p.name == "rayleigh_mass_per_s") return draw.log_uniform(1, 50);
  if (p.name == "rayleigh_stiffness_s") return draw.log_uniform(1e-8, 1e-6);
  if (p.name == "ripple") return draw.log_uniform(0.01, 0.3);
  if (p.name == "phase") return draw.uniform(-0.5, 0.5);
  if (p.name == "relative_tolerance") return draw.log_uniform(1e-9, 1e-6);
  if (p.name == "single_stiffness_GPa") return draw.uniform(10, 18);
  if (const auto* usual = std::get_if<double>(&p.default_value); usual && *usual > 0 && std::isfinite(*usual))
    return *usual * draw.log_uniform(0.9, 1.1);
  return draw.uniform(std::max(p.low, 0.0), std::min(p.high, 1.0));
}

double in_range(const Parameter& p, double value) { return rounded(std::clamp(value, p.low, p.high)); }

bool is_undrawn(const Parameter& p) {
  return std::any_of(undrawn_keys().begin(), undrawn_keys().end(), [key = p.key()](const auto& undrawn) {
    const auto& name = undrawn.first;
    return key == name || (name.starts_with("*.") && key.ends_with(name.substr(1))) ||
           (name.ends_with(".*") && key.starts_with(name.substr(0, name.size() - 1)));
  });
}

/// Walks the tables of a kind; a key is written when its conditions let it be and chance or a rule wants it.
class Walk {
 public:
  Walk(Draw& draw, GearSet& set, const std::vector<Table>& tables) : draw_(draw), set_(set), tables_(tables) {}

  void run() {
    for (const auto& t : tables_) {
      if (t.path.empty() || t.role == Table::Role::study) continue;
      if (std::all_of(t.parameters.begin(), t.parameters.end(), is_undrawn)) continue;
      const auto found = set_.chances.find(t.path);
      if (t.required || draw_.chance(found != set_.chances.end() ? found->second : t.path == "dynamics" ? 0.95 : 0.15))
        set_.draft.open_table(t.path);
    }
    drop_tables_out_of_place();
    // Conditions name keys of later tables too; a second pass sees them all, a third what follows from those.
    for (int pass = 0; pass < 3; ++pass) {
      for (const auto& t : tables_) {
        if (!t.path.empty() && !set_.draft.has_table(t.path)) continue;
        for (const auto& p : t.parameters) draw_key(p);
      }
    }
    alternatives();
  }

 private:
  /// Of the keys as they stand; nothing where a value that a condition needs is still to be drawn.
  [[nodiscard]] std::vector<std::optional<bool>> hold(const std::vector<app::KeyRule>& rules,
                                                      const std::string& table) const {
    if (rules.empty()) return {};
    const auto inputs = set_.draft.inputs(tables_);
    const app::KeyValues keys(inputs, tables_);
    std::vector<std::optional<bool>> answers;
    for (const auto& rule : rules) answers.push_back(rule.when.holds(keys, table, 0));
    return answers;
  }
  [[nodiscard]] bool all_hold(const std::vector<app::KeyRule>& rules, const Parameter& p) const {
    const auto answers = hold(rules, p.table);
    return std::all_of(answers.begin(), answers.end(), [](const auto& answer) { return answer == true; });
  }
  [[nodiscard]] bool any_holds(const std::vector<app::KeyRule>& rules, const Parameter& p) const {
    const auto answers = hold(rules, p.table);
    return std::any_of(answers.begin(), answers.end(), [](const auto& answer) { return answer == true; });
  }

  void drop_tables_out_of_place() {
    for (const auto& t : tables_)
      for (const auto& rule : t.only_if)
        if (rule.when.kind == app::Condition::Kind::table && !set_.draft.has_table(rule.when.key))
          set_.draft.remove_table(t.path);
  }

  void draw_key(const Parameter& p) {
    const std::string key = p.key();
    if (set_.draft.find(key) != nullptr || !all_hold(p.only_if, p) || any_holds(p.refused_if, p)) return;
    const bool needed = p.required(set_.draft.text_of("stage.kind")) || any_holds(p.required_if, p);
    if (!needed) {
      if (!decided_.insert(key).second) return;  // by an earlier pass
      const auto own = set_.chances.find(key);
      if (!draw_.chance(own != set_.chances.end() ? own->second : usual_chance)) return;
    }
    write(p);
    for (const auto& partner : partners(p))
      if (set_.draft.find(partner) == nullptr) write(*app::find_parameter(partner, tables_));
  }

  [[nodiscard]] std::vector<std::string> partners(const Parameter& p) const {
    std::vector<std::string> keys;
    for (const auto& other : p.together_with) keys.push_back(p.table + "." + other);
    for (const auto& other : app::find_table(p.table, tables_)->parameters)
      if (std::find(other.together_with.begin(), other.together_with.end(), p.name) != other.together_with.end())
        keys.push_back(other.key());
    for (const auto& [first, second] : set_.together)
      if (p.key() == first || p.key() == second) keys.push_back(p.key() == first ? second : first);
    return keys;
  }

  /// Either a key or all of its alternatives: where none is written, the key is.
  void alternatives() {
    for (const auto& t : tables_) {
      if (!set_.draft.has_table(t.path)) continue;
      for (const auto& p : t.parameters) {
        if (p.instead_of.empty() || !all_hold(p.only_if, p)) continue;
        const bool others = std::all_of(p.instead_of.begin(), p.instead_of.end(), [&](const std::string& name) {
          return set_.draft.find(p.table + "." + name) != nullptr;
        });
        if (others)
          set_.draft.remove(p.key());
        else if (set_.draft.find(p.key()) == nullptr)
          write(p);
      }
    }
  }

  void write(const Parameter& p) {
    if (is_undrawn(p)) return;
    if (const auto own = set_.values.find(p.key()); own != set_.values.end()) {
      set_.draft.set(p.key(), own->second);
      return;
    }
    switch (p.kind) {
      case Parameter::Kind::choice: {
        auto choices = p.choices;
        std::erase(choices, "table");  // the file of another program
        set_.draft.set(p.key(), draw_.one_of(choices));
        return;
      }
      case Parameter::Kind::integer: {
        const auto* usual = std::get_if<long>(&p.default_value);
        const double low = std::max(p.low, usual ? 0.5 * static_cast<double>(*usual) : p.low);
        const double high = std::min(p.high, usual && *usual > 0 ? 2 * static_cast<double>(*usual) : 200);
        set_.draft.set(p.key(), draw_.integer(std::lround(low), std::lround(std::max(low, high))));
        return;
      }
      case Parameter::Kind::real:
        set_.draft.set(p.key(), in_range(p, usual_number(draw_, p, set_.scales)));
        return;
      case Parameter::Kind::reals: {
        std::vector<double> list;
        const auto count = p.at_least_one.empty() ? set_.planets : 2;
        for (int i = 0; i < count; ++i) list.push_back(in_range(p, usual_number(draw_, p, set_.scales)));
        set_.draft.set(p.key(), list);
        return;
      }
      case Parameter::Kind::text:
      case Parameter::Kind::texts:
        return;
    }
  }

  Draw& draw_;
  GearSet& set_;
  const std::vector<Table>& tables_;
  std::set<std::string> decided_;
};

}  // namespace

const std::vector<std::pair<std::string, std::string>>& undrawn_keys() {
  static const std::vector<std::pair<std::string, std::string>> keys = {
      {"title", "a text"},
      {"report.project", "a text"},
      {"report.author", "a text"},
      {"reference", "a file"},
      {"*.file", "a file"},
      {"*.left_topography", "a file"},
      {"*.right_topography", "a file"},
      {"accuracy", "what two runs of a scene differ in"},
      {"stage.centre_distance_mm", "follows from the profile shifts"},
      {"stage.sun_torque_Nm", "the power is drawn"},
      {"stage.carrier_torque_Nm", "the power is drawn"},
      {"stage.ring_torque_Nm", "the power is drawn"},
      {"*.profile_shift_from", "the profile shift is drawn itself"},
      {"*.normal_backlash_um", "of profile_shift_from"},
      {"*.span_mm", "of profile_shift_from"},
      {"*.span_teeth", "of profile_shift_from"},
      {"*.over_pins_mm", "of profile_shift_from"},
      {"*.measuring_pin_mm", "of profile_shift_from"},
      {"*.root_diameter_mm", "those of the basic rack"},
      {"sun.tip_diameter_mm", "that of the basic rack"},
      {"planet.tip_diameter_mm", "that of the basic rack"},
      {"pinion.tip_diameter_mm", "that of the basic rack"},
      {"wheel.tip_diameter_mm", "that of the basic rack"},
      {"stage.helix_angle_deg", "of the rack, and none of a 2K-V stage"},
      {"errors.sun_pitch_deviations_um", "as many as teeth"},
      {"errors.planet_pitch_deviations_um", "as many as teeth"},
      {"errors.ring_pitch_deviations_um", "as many as teeth"},
      {"errors.sun_pitch_class", "the motion repeats after all teeth"},
      {"errors.planet_pitch_class", "the motion repeats after all teeth"},
      {"errors.ring_pitch_class", "the motion repeats after all teeth"},
      {"errors.pitch_seed", "of the pitch classes"},
      {"strain_gauge.*", "gauges change nothing"},
      {"bearing.*", "of stages in space, which have suites of their own"},
      {"load.*", "of stages in space"},
      {"gravity.*", "of annulus statics alone"},
      {"carrier_structure.*", "of stages in space"},
      {"housing.*", "of stages in space"},
      {"tilt_inertia.*", "of stages in space"},
      {"statics.*", "of annulus statics alone"},
      {"dynamics.mesh_cycles", "a length of motion, without a steady state"},
      {"rotor.*", "put on a body that turns"},
      {"friction.*", "by a coefficient or by the oil"},
      {"squeeze_film.*", "beside friction"},
  };
  return keys;
}

namespace {

/// Planets of some spur stages stand on rollers, for which their bearing has a stiffness.
void put_planets_on_rollers(Draw& draw, const std::string& model, GearSet& set) {
  const bool modelled = set.draft.text_of("stage.kind") == "planetary" &&
                        set.draft.find("stage.helix_angle_deg") == nullptr && model != "closed_form" &&
                        model != "resolved";
  if (!modelled || !draw.chance(0.12)) return;
  set.draft.set("planet.bore", std::string("rollers"));
  set.draft.set("supports.planet_N_per_m", rounded(set.scales.stiffness_N_per_m * draw.log_uniform(0.3, 10)));
  set.chances["supports.planet_radial_N_per_m"] = set.chances["supports.planet_tangential_N_per_m"] = 0;
}

/// Some scenes have a motor, a generator or a machine on a body that turns. Drawn apart, so that all else stays.
void put_a_rotor(Draw draw, GearSet& set) {
  if (!set.draft.has_table("dynamics") || !draw.chance(0.2)) return;
  const auto kind = set.draft.text_of("stage.kind");
  const auto held = set.draft.text_of("stage.held");
  const std::string body = kind == "helical_pair" ? draw.one_of<std::string>({"pinion", "wheel"})
                           : kind == "two_k_v"    ? "input"
                           : held == "sun"        ? "carrier"
                                                  : "sun";
  const auto* own = set.draft.find(body + ".inertia_kg_m2");
  const auto usual = set.values.find(body + ".inertia_kg_m2");
  const double inertia = own != nullptr              ? std::get<double>(*own)
                         : usual != set.values.end() ? std::get<double>(usual->second)
                                                     : 0;
  if (inertia == 0 || set.draft.find("supports." + body + "_torsional_N_per_m") != nullptr) return;
  set.draft.set("rotor.name", std::string("machine"));
  set.draft.set("rotor.on", body);
  set.draft.set("rotor.inertia_kg_m2", rounded(inertia * draw.log_uniform(0.3, 100)));
  set.draft.set("rotor.shaft_Nm_per_rad", rounded(set.scales.torsional_Nm_per_rad * draw.log_uniform(0.01, 1)));
  if (draw.chance(0.5)) set.draft.set("rotor.shaft_damping_ratio", rounded(draw.log_uniform(0.01, 0.1)));
  if (draw.chance(0.3)) set.draft.set("rotor.shaft_backlash_deg", rounded(draw.log_uniform(0.001, 0.1)));
}

/// Flanks of some scenes have friction. Drawn apart, as well.
void put_friction(Draw draw, GearSet& set) {
  if (set.draft.text_of("stage.kind") == "two_k_v" || !draw.chance(0.15)) return;
  if (set.draft.has_table("dynamics") && draw.chance(0.3)) {
    set.draft.set("squeeze_film.viscosity_mPas", rounded(draw.log_uniform(5, 300)));
    set.draft.set("squeeze_film.least_gap_um", rounded(draw.log_uniform(0.1, 3)));
  }
  if (draw.chance(0.5)) return set.draft.set("friction.coefficient", rounded(draw.log_uniform(0.01, 0.15)));
  set.draft.set("friction.oil_viscosity_mPas", rounded(draw.log_uniform(5, 300)));
  set.draft.set("friction.roughness_um", rounded(draw.log_uniform(0.1, 3)));
  set.draft.set("friction.lubricant_factor", rounded(draw.uniform(0.6, 1.2)));
}

}  // namespace

RandomScene random_scene(std::uint64_t seed) {
  Draw draw(seed);
  const double share = draw.uniform(0, 1);
  const auto section = share < 0.82 ? Section::plane : share < 0.96 ? Section::solid : Section::resolved;
  const auto make = draw.one_of<GearSet (*)(Draw&, Section)>(
      {planetary_set, planetary_set, planetary_set, helical_pair_set, two_k_v_set});
  GearSet set = make(draw, section);
  RandomScene scene{.seed = seed, .kind = set.draft.text_of("stage.kind"), .model = "resolved", .draft = {}};
  if (section == Section::plane) scene.model = draw.one_of<std::string>({"automatic", "plane", "plane", "closed_form"});
  if (section == Section::solid) scene.model = draw.one_of<std::string>({"automatic", "solid"});
  set.draft.set("model", scene.model);
  put_planets_on_rollers(draw, scene.model, set);
  Walk(draw, set, app::schema(scene.kind)).run();
  put_a_rotor(Draw(seed + 1000000), set);
  put_friction(Draw(seed + 2000000), set);
  scene.draft = std::move(set.draft);
  return scene;
}

RandomScene random_train(std::uint64_t seed) {
  Draw draw(seed);
  RandomScene scene{.seed = seed, .kind = "train", .model = "closed_form", .draft = {}};
  double torsional = 0;
  for (const std::string part : {"first", "second"}) {
    GearSet set = helical_pair_set(draw, Section::plane);
    set.draft.set("model", scene.model);
    set.chances["dynamics"] = set.chances["mesh.pinion_wheel"] = 1;
    Walk(draw, set, app::schema("helical_pair")).run();
    scene.files.emplace_back(part + ".toml", set.draft.toml(app::schema("helical_pair")));
    scene.more += fmt::format("[[part]]\nname = \"{0}\"\nfile = \"{0}.toml\"\n", part);
    torsional = std::max(torsional, set.scales.torsional_Nm_per_rad);
  }
  scene.more += fmt::format("[[shaft]]\nname = \"between\"\nfrom = \"first.wheel\"\nto = \"second.pinion\"\n");
  scene.more += fmt::format("stiffness_Nm_per_rad = {:.4g}\n", torsional * draw.log_uniform(0.01, 10));
  scene.draft.set("stage.kind", scene.kind);
  scene.draft.set("dynamics.support_damping_ratio", rounded(draw.log_uniform(0.01, 0.1)));
  return scene;
}

RandomScene scene_of_campaign(std::uint64_t seed) { return seed % 16 == 5 ? random_train(seed) : random_scene(seed); }

std::string RandomScene::toml() const { return draft.toml(app::schema(kind)) + more; }

}  // namespace annulus::random
