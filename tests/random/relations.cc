#include "tests/random/relations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace annulus::random {

namespace {

std::string with_accuracy(SceneDraft draft, const RandomScene& scene, double accuracy) {
  draft.set("accuracy", accuracy);
  RandomScene changed = scene;
  changed.draft = std::move(draft);
  return changed.toml();
}
std::string cheap(const SceneDraft& draft, const RandomScene& scene) { return with_accuracy(draft, scene, 0.1); }

std::optional<double> same(const std::string&) { return 1.0; }

/// Multiplies every written number by the factor of the ending of its key; the longest ending decides.
void scale_keys(SceneDraft& draft, const std::vector<app::Table>& tables,
                const std::vector<std::pair<const char*, double>>& factors) {
  for (const auto& t : tables)
    for (const auto& p : t.parameters)
      for (const auto& [ending, factor] : factors)
        if (p.name.ends_with(ending)) {
          draft.scale(p.key(), factor);
          break;
        }
}

/// Factor of a result by the unit at the end of its key; dimensionless results are those without one.
std::optional<double> by_unit(const std::string& key, const std::vector<std::pair<const char*, double>>& factors) {
  for (const auto& [ending, factor] : factors)
    if (key.ends_with(ending)) return factor;
  return 1.0;
}

/// Whether a law has sizes of its own, so that sets of another size or material are not similar.
bool has_fixed_sizes(const SceneDraft& draft) {
  return draft.text_of("mesh.pinion_wheel.stiffness") == "iso_6336";  // 14 N/(mm µm), and draws in micrometres
}

/// A set of twice the size under four times the forces: stresses stay, lengths double, speeds halve.
Relation size() {
  static const std::vector<std::pair<const char*, double>> inputs = {
      {"_Nm_per_rad", 8}, {"_kg_m2", 32}, {"_N_per_m", 2}, {"_kg", 8}, {"_mm", 2},
      {"_um", 2},         {"_rpm", 0.5},  {"_kW", 4},      {"_Nm", 8}};
  static const std::vector<std::pair<const char*, double>> results = {
      {"_Nm_per_rad", 8}, {"_N_per_m", 2}, {"_m_per_s2", 0.5}, {"_Hz", 0.5},
      {"_N_per_rad", 4},  {"_m", 2},       {"_N", 4},          {"_Nm", 8}};
  return {"twice the size", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (has_fixed_sizes(scene.draft)) return std::nullopt;
            auto larger = scene.draft;
            scale_keys(larger, app::schema(scene.kind), inputs);
            return RunPair{cheap(scene.draft, scene), cheap(larger, scene)};
          },
          [](const std::string& key) -> std::optional<double> {
            if (key.starts_with("natural_frequency")) return 0.5;
            return by_unit(key, results);
          }};
}

/// Four times as stiff and heavy under four times the load: the same motion.
Relation material() {
  static const std::vector<std::pair<const char*, double>> inputs = {
      {"_Nm_per_rad", 4}, {"_kg_m2", 4}, {"_N_per_m", 4}, {"_kg", 4},
      {"_kg_per_m3", 4},  {"_GPa", 4},   {"_kW", 4},      {"_Nm", 4}};
  static const std::vector<std::pair<const char*, double>> results = {
      {"_Nm_per_rad", 4}, {"_N_per_m", 4}, {"_N_per_rad", 4}, {"_N", 4}, {"_Nm", 4}, {"_Pa", 4}};
  return {"material four times as stiff", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (has_fixed_sizes(scene.draft) || scene.draft.number("material.youngs_modulus_GPa") * 4 > 1e3)
              return std::nullopt;
            auto stiffer = scene.draft;
            scale_keys(stiffer, app::schema(scene.kind), inputs);
            return RunPair{cheap(scene.draft, scene), cheap(stiffer, scene)};
          },
          [](const std::string& key) { return by_unit(key, results); }};
}

/// Whether a result follows from a stiffness table alone, whatever moves on it.
std::optional<double> of_tables(const std::string& key) {
  for (const auto* what : {"mean_stiffness", "stiffness_ripple", "lte_mean", "lte_peak_to_peak"})
    if (key.find(what) != std::string::npos) return 1.0;
  return std::nullopt;
}

bool on_equal_pins(const SceneDraft& draft) {
  return draft.find("ring.pins") != nullptr && !draft.has_table("mesh.ring_planet");
}

std::optional<RunPair> turned_pins(const RandomScene& scene, double turn_deg) {
  auto turned = scene.draft;
  const double first =
      turned.find("ring.first_pin_angle_deg") != nullptr ? turned.number("ring.first_pin_angle_deg") : 0;
  turned.set("ring.first_pin_angle_deg", first + turn_deg > 360 ? first + turn_deg - 360 : first + turn_deg);
  return RunPair{cheap(scene.draft, scene), cheap(turned, scene)};
}

Relation pins_by_a_gap() {
  return {"pins turned by a gap", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (!on_equal_pins(scene.draft)) return std::nullopt;
            return turned_pins(scene, 360 / scene.draft.number("ring.pins"));
          },
          same};
}

Relation pins_by_teeth() {
  return {"pins turned by three teeth", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (!on_equal_pins(scene.draft)) return std::nullopt;
            return turned_pins(scene, 3 * 360 / scene.draft.number("ring.teeth"));
          },
          of_tables};
}

Relation listed_pins() {
  return {"pins listed", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (!on_equal_pins(scene.draft)) return std::nullopt;
            auto listed = scene.draft;
            const double first =
                listed.find("ring.first_pin_angle_deg") != nullptr ? listed.number("ring.first_pin_angle_deg") : 0;
            const auto pins = static_cast<int>(listed.number("ring.pins"));
            std::vector<double> angles;
            for (int n = 0; n < pins; ++n) {
              const double angle = first + 360.0 * n / pins;
              angles.push_back(angle > 360 ? angle - 360 : angle);
            }
            listed.remove("ring.pins");
            listed.remove("ring.first_pin_angle_deg");
            listed.set("ring.pin_angles_deg", angles);
            return RunPair{cheap(scene.draft, scene), cheap(listed, scene)};
          },
          same};
}

/// Twice the planets under twice the power: the same force on each.
Relation more_planets() {
  return {"twice the planets", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            auto tables = scene.draft;
            if (tables.text_of("stage.kind") != "planetary" || tables.find("stage.planet_angles_deg") != nullptr)
              return std::nullopt;
            for (const auto* table : {"errors", "supports", "dynamics"}) tables.remove_table(table);
            auto more = tables;
            more.set("stage.planets", 2 * static_cast<long>(tables.number("stage.planets")));
            more.scale("stage.power_kW", 2);
            return RunPair{cheap(tables, scene), cheap(more, scene)};
          },
          of_tables};
}

/// The other hand, with what changes along the face width turned round as well. Rings that are held at one end are not
/// symmetric.
Relation mirror() {
  return {"mirrored along the axis", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            const auto& draft = scene.draft;
            if (draft.text_of("ring.structure") == "thin_walled" || draft.find("ring.flange_width_mm") != nullptr)
              return std::nullopt;
            auto mirrored = draft;
            bool changed = false;
            for (const auto& t : app::schema(scene.kind))
              for (const auto& p : t.parameters)
                if (p.name == "helix_angle_deg" || p.name == "lead_slope_um" || p.name == "axial_offset_mm" ||
                    p.name.ends_with("misalignment_um")) {
                  changed = changed || draft.find(p.key()) != nullptr;
                  mirrored.scale(p.key(), -1);
                }
            if (!changed) return std::nullopt;
            return RunPair{cheap(draft, scene), cheap(mirrored, scene)};
          },
          same};
}

/// The mirror image of a scene: every direction reversed, planets counted the other way round.
SceneDraft in_a_mirror(const RandomScene& scene) {
  auto mirrored = scene.draft;
  for (const auto& t : app::schema(scene.kind))
    for (const auto& p : t.parameters)
      if (p.name.ends_with("_phase_deg") || p.name == "helix_angle_deg" || p.name == "pin_angles_deg" ||
          (p.name.starts_with("first_") && p.name.ends_with("_angle_deg")) ||
          (t.path == "stage" && p.name.ends_with("_speed_rpm")))
        mirrored.scale(p.key(), -1);
  const auto planets = static_cast<std::size_t>(mirrored.number("stage.planets"));
  for (const auto* list :
       {"errors.planet_eccentricity_um", "errors.planet_eccentricity_phase_deg", "errors.planet_pin_position_error_um",
        "errors.planet_pin_position_error_phase_deg", "supports.planet_radial_N_per_m",
        "supports.planet_tangential_N_per_m", "stage.planet_angles_deg"})
    if (const auto* value = mirrored.find(list)) {
      auto values = std::get<std::vector<double>>(*value);
      if (values.size() == planets) std::reverse(values.begin() + 1, values.end());
      if (std::string(list) == "stage.planet_angles_deg")
        for (std::size_t n = 1; n < values.size(); ++n) values[n] = 360 - values[n];
      mirrored.set(list, values);
    }
  return mirrored;
}

/// Counted from the next planet on, in a set whose planets are all in phase.
Relation relabelled() {
  return {
      "planets counted from the next one", Agreement::rounding,
      [](const RandomScene& scene) -> std::optional<RunPair> {
        auto draft = scene.draft;
        if (draft.text_of("stage.kind") != "planetary" || draft.find("stage.planet_angles_deg") != nullptr)
          return std::nullopt;
        const auto planets = static_cast<long>(draft.number("stage.planets"));
        const auto fits = [&](const char* key) {
          return draft.find(key) == nullptr || static_cast<long>(draft.number(key)) % planets == 0;
        };
        if (planets < 2 || draft.find("ring.pin_angles_deg") != nullptr) return std::nullopt;
        for (const auto* key : {"sun.teeth", "ring.teeth", "ring.pins", "ring.splines", "ring.bolts", "ring.dowels"})
          if (!fits(key)) return std::nullopt;
        bool changed = false;
        const double turn = -360.0 / static_cast<double>(planets);
        for (const auto& t : app::schema(scene.kind))
          for (const auto& p : t.parameters) {
            const auto* value = draft.find(p.key());
            if (value == nullptr) continue;
            if (const auto* list = std::get_if<std::vector<double>>(value);
                list && p.name.starts_with("planet_") && static_cast<long>(list->size()) == planets) {
              auto values = *list;
              std::rotate(values.begin(), values.begin() + 1, values.end());
              draft.set(p.key(), values);
              changed = true;
            } else if (t.path == "errors" && p.name.ends_with("_phase_deg")) {
              // Those of the other bodies are measured from the first planet.
              draft.set(p.key(), std::remainder(draft.number(p.key()) + turn, 360.0));
            }
          }
        if (!changed) return std::nullopt;
        return RunPair{cheap(scene.draft, scene), cheap(draft, scene)};
      },
      same};
}

/// Whether a ring stands on pins that touch as soon as they are pressed.
bool on_pins_without_play(const SceneDraft& draft) {
  if (draft.text_of("ring.structure") != "pinned" || draft.has_table("mesh.ring_planet")) return false;
  for (const auto* key : {"ring.pin_clearance_um", "ring.housing_clearance_um"})
    if (draft.find(key) != nullptr && draft.number(key) > 0) return false;
  return true;
}

std::optional<double> of_ring_stiffness(const std::string& key) {
  if (key != "ring_planet_mean_stiffness_N_per_m") return std::nullopt;
  return 1.0;
}

/// At one load the work of the load falls when supports get stiffer.
Relation stiffer_pins() {
  return {"pins four times as stiff", Agreement::not_less,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            auto stiffer = scene.draft;
            if (!on_pins_without_play(stiffer) || stiffer.find("ring.pin_radial_stiffness_N_per_m") == nullptr)
              return std::nullopt;
            stiffer.scale("ring.pin_radial_stiffness_N_per_m", 4);
            stiffer.scale("ring.pin_tangential_stiffness_N_per_m", 4);
            return RunPair{cheap(scene.draft, scene), cheap(stiffer, scene)};
          },
          of_ring_stiffness};
}

/// Bolts are pins that pull as well.
Relation bolts() {
  return {"bolts instead of pins", Agreement::not_less,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            auto bolted = scene.draft;
            if (!on_pins_without_play(bolted)) return std::nullopt;
            bolted.remove("ring.pin_clearance_um");
            bolted.remove("ring.housing_clearance_um");
            bolted.set("ring.structure", std::string("bolted"));
            return RunPair{cheap(scene.draft, scene), cheap(bolted, scene)};
          },
          of_ring_stiffness};
}

/// Driven the other way, the mirror image does the same.
Relation turned_round() {
  return {"mirror image driven the other way", Agreement::rounding,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (scene.draft.text_of("stage.kind") != "planetary") return std::nullopt;
            return RunPair{cheap(scene.draft, scene), cheap(in_a_mirror(scene), scene)};
          },
          same};
}

Relation reuse() {
  return {"reused", Agreement::identical,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            const auto text = cheap(scene.draft, scene);
            return RunPair{text, text, "", "", true};
          },
          same};
}

Relation threads() {
  return {"two threads", Agreement::identical,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            const auto text = cheap(scene.draft, scene);
            return RunPair{text, text, "", "--threads 2"};
          },
          same};
}

std::optional<RunPair> two_accuracies(const RandomScene& scene) {
  const double wanted = scene.seed % 2 == 0 ? 0.1 : 0.03;
  return RunPair{with_accuracy(scene.draft, scene, wanted), with_accuracy(scene.draft, scene, 0.01)};
}

/// The coverage of the stated errors at one model; where the program chooses it, accuracies may differ in that.
Relation accuracy() {
  return {"two accuracies", Agreement::numerical_errors,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (scene.model == "automatic") return std::nullopt;
            // The coupling of the meshes is part of the model. With formulas the accuracy chooses it.
            auto fixed = scene;
            if (scene.model == "closed_form" && scene.draft.has_table("ring") && scene.draft.has_table("dynamics") &&
                scene.draft.find("dynamics.rim_coupling") == nullptr)
              fixed.draft.set("dynamics.rim_coupling", std::string("none"));
            return two_accuracies(fixed);
          },
          same};
}
Relation chosen_model() {
  return {"two accuracies, model chosen", Agreement::errors,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (scene.model != "automatic") return std::nullopt;
            return two_accuracies(scene);
          },
          same};
}

/// Two models of the same bodies.
Relation models() {
  return {"two models", Agreement::errors,
          [](const RandomScene& scene) -> std::optional<RunPair> {
            if (scene.model != "closed_form" && scene.model != "solid") return std::nullopt;
            auto other = scene.draft;
            other.set("model", std::string(scene.model == "solid" ? "resolved" : "plane"));
            return RunPair{cheap(scene.draft, scene), cheap(other, scene)};
          },
          same};
}

/// Relative. Stresses and load factors are the largest values of tables with six digits.
double rounding_of(const std::string& key) {
  constexpr double six_digits = 1e-5;
  return key.ends_with("_Pa") || key.ends_with("_face_load_factor") ? six_digits : relation_rounding;
}

/// What rounding of a result is relative to: a component of the accelerations that is zero (axial, of a spur pair) is
/// known as well as the others.
double scale(const StatedResult& result, const SceneRun& run) {
  double largest = std::abs(result.value);
  if (result.key.starts_with("acceleration_"))
    for (const auto& other : run.results)
      if (other.variant == result.variant && other.key.starts_with("acceleration_"))
        largest = std::max(largest, std::abs(other.value));
  return largest;
}

/// `size`: of both results.
double allowed_difference(Agreement agreement, const StatedResult& first, const StatedResult& second, double factor,
                          double size) {
  // Of sums of hundreds of forces; of gaps between flanks, which are differences of positions some metres off the axis.
  constexpr double rounding = 1e-9, nothing = 1e-15;
  switch (agreement) {
    case Agreement::identical:
      return 0;
    case Agreement::not_less:
      if (second.value >= first.value * factor) return std::numeric_limits<double>::infinity();
      return first.numerical_error() * std::abs(factor) + second.numerical_error() + rounding * size + nothing;
    case Agreement::rounding:
      // A motion that is not periodic is known as well as its length lets it.
      return rounding_of(first.key) * size + nothing + first.motion_error * std::abs(factor) + second.motion_error;
    case Agreement::errors:
      return first.error * std::abs(factor) + second.error + rounding * size + nothing;
    case Agreement::numerical_errors:
      return first.numerical_error() * std::abs(factor) + second.numerical_error() + rounding * size + nothing;
  }
  return 0;
}

}  // namespace

double ComparedResult::effectivity() const {
  const double difference = std::abs(second - first);
  if (difference == 0) return 0;
  return difference > 0 && allowed > 0 ? difference / allowed : std::numeric_limits<double>::infinity();
}

const std::vector<Relation>& relations() {
  static const std::vector<Relation> list = {accuracy(),     chosen_model(),  models(),        size(),
                                             material(),     pins_by_a_gap(), pins_by_teeth(), listed_pins(),
                                             mirror(),       turned_round(),  more_planets(),  relabelled(),
                                             stiffer_pins(), bolts(),         reuse(),         threads()};
  return list;
}

std::vector<ComparedResult> compared(const Relation& relation, const SceneRun& first, const SceneRun& second) {
  std::vector<ComparedResult> list;
  for (const auto& result : first.results) {
    const auto* other = second.find(result);
    const auto factor = relation.factor(result.key);
    if (!factor) continue;
    const bool equal = relation.agreement == Agreement::identical || relation.agreement == Agreement::rounding;
    const double value = other == nullptr ? not_known : other->value;
    if (std::isnan(result.value) && std::isnan(value)) continue;
    if (std::isnan(result.value) != std::isnan(value)) {
      if (equal) list.push_back({result.key, result.value * *factor, value, 0});
      continue;
    }
    const double size = std::max(scale(result, first) * std::abs(*factor), scale(*other, second));
    const double allowed = allowed_difference(relation.agreement, result, *other, *factor, size);
    if (std::isnan(allowed)) continue;  // no error is stated
    list.push_back({result.key, result.value * *factor, other->value, allowed});
  }
  return list;
}

std::optional<RunPair> pair_of(const Relation& relation, const RandomScene& scene) {
  const bool same_keys =
      relation.agreement == Agreement::identical || relation.agreement == Agreement::numerical_errors;
  if (!scene.files.empty() && !same_keys) return std::nullopt;
  return relation.pair(scene);
}

}  // namespace annulus::random
