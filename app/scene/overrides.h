#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

/// A changed input of a scene, named by its key path:
///
///     stage.power_kW                             table and key
///     mesh.sun_planet.mean_N_per_m
///     ring.pins                                  of every ring that gives it
///     ring.pinned.pins                           of the ring 'pinned'
///     bearing.spline.tilt_Nm_per_rad             of the table 'spline'; so for every array of tables with names
///     errors.planet_eccentricity_phase_deg[2]    of planet 2, counted from 1
struct Override {
  std::string input;
  double value = 0;     ///< in the unit of the key
  bool factor = false;  ///< the present value is multiplied by `value` instead
};

/// What a key path means in one scene.
struct InputTarget {
  const Parameter* parameter = nullptr;
  std::vector<std::size_t> tables;   ///< which tables of an array; empty for single tables
  bool by_variant = false;           ///< these are variants (Table::variants)
  std::optional<std::size_t> index;  ///< within a list, from 0
  std::vector<double> list{};        ///< the present one, of several tables the shortest

  /// Which tables of an array have the input.
  [[nodiscard]] std::vector<std::size_t> entries() const {
    return tables.empty() ? std::vector<std::size_t>{0} : tables;
  }
};

/// Throws InputError, with the nearest valid path, when the scene has no such numeric input.
[[nodiscard]] InputTarget find_input(const Scene& scene, const std::string& path);

/// Names of the variants that a scene compares, in their order; empty of kinds without.
[[nodiscard]] std::vector<std::string> variant_names(const Scene& scene);
/// What a variant of the kind is, by the table that makes one: "ring"; otherwise "variant".
[[nodiscard]] std::string variant_word(const std::string& kind);

/// The present value in the unit of the key, of one table of an array or of the first that has it; nothing when there
/// is none.
[[nodiscard]] std::optional<double> input_value(const Scene& scene, const InputTarget& target,
                                                std::optional<std::size_t> entry = {});

/// The same of one variant, for an input of variants; else of all.
[[nodiscard]] std::optional<double> value_in_variant(const Scene& scene, const InputTarget& target,
                                                     std::size_t variant);

/// "errors.planet_pin_position_error_um[*]" as one path per planet, other lists as one per value, any other path as
/// itself.
[[nodiscard]] std::vector<std::string> expand_planets(const Scene& scene, const std::string& path);

/// The path as part of a file name: "supports.planet_N_per_m" -> "supports_planet_N_per_m".
[[nodiscard]] std::string file_name(const std::string& path);

/// The scene with other values, put in before anything is checked: ranges, rules and derived values are those of a
/// file that says so. Without studies. Throws InputError for an unknown input, a number that is not whole where one has
/// to be, and SceneError for what the checks find.
[[nodiscard]] Scene with_overrides(const Scene& scene, const std::vector<Override>& overrides);

/// The scene with another wanted accuracy, studies and assumptions included; `note` says where it comes from.
[[nodiscard]] Scene with_accuracy(const Scene& scene, double accuracy, const std::string& note);

/// The scene of a file with other values, each "key = value" as `--set` takes it: a key path as above (an
/// index: in a list that the scene has) and a value as in a scene file; a word that is none is a text. Throws
/// InputError for a setting that names no key, and what reading a scene throws.
[[nodiscard]] Scene read_scene_with(const std::filesystem::path& file, const std::vector<std::string>& settings);

/// The same scene as the text of a file. Comments are lost.
[[nodiscard]] std::string scene_text(const Scene& scene, const std::vector<Override>& overrides);

}  // namespace annulus::app
