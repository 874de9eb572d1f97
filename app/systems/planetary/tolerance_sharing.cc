#include "app/systems/planetary/tolerance_sharing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "app/model/excitation.h"
#include "app/model/reuse.h"
#include "app/model/run_options.h"
#include "app/results/cached_value.h"
#include "app/results/program_identity.h"
#include "app/study/summary_studies.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_members.h"
#include "core/csv.h"
#include "core/log.h"
#include "core/units.h"
#include "geometry/flank_tolerances.h"

namespace annulus::app {

namespace {

using dynamics::Interval;
using dynamics::SharingQuantiles;

constexpr const char* cached_sharing = "assemblies";

double runout(const std::string& name, const geometry::Gear& gear, const std::optional<double>& given,
              const std::optional<int>& own_class, const std::optional<int>& common_class) {
  if (given) return *given;
  const auto& flank_class = own_class ? own_class : common_class;
  if (!flank_class) return 0;
  return geometry_of(fmt::format("tolerances.{}accuracy_class = {}: {}; give tolerances.{}_runout_um instead",
                                 own_class ? name + "_" : "", *flank_class, name, name),
                     [&] {
                       return geometry::runout_tolerance(
                           {.teeth = gear.teeth(),
                            .module = gear.transverse_module() * std::cos(gear.helix_angle()),
                            .reference_diameter = 2 * gear.reference_radius(),
                            .helix_angle = gear.helix_angle()},
                           *flank_class);
                     });
}

std::string figure_key(const SharingQuantile& quantile) {
  return fmt::format("load_sharing_of_assemblies_{}", quantile.key);
}

Json quantiles_json(const SharingQuantiles& quantiles) {
  Json json;
  for (const auto& q : sharing_quantiles()) json[q.key] = interval_json(quantiles.*q.interval);
  return json;
}

void add_columns(std::vector<std::string>& columns, const std::string& head) {
  for (const auto& q : sharing_quantiles())
    for (const auto* end : {"", "_low", "_high"}) columns.push_back(head + q.key + end);
}

void add_cells(std::vector<double>& row, const SharingQuantiles& quantiles) {
  for (const auto& q : sharing_quantiles()) {
    const auto& interval = quantiles.*q.interval;
    row.insert(row.end(), {interval.value, interval.low, interval.high});
  }
}

void save(const dynamics::AssemblySharing& sharing, double sun_torque, const std::string& id,
          const std::filesystem::path& folder) {
  const std::vector<std::pair<std::string, std::string>> header = {{"annulus_version", version()}, {"inputs_id", id}};
  Csv by_torque{.header = header, .columns = {"torque_share", "sun_torque_Nm"}, .rows = {}};
  add_columns(by_torque.columns, "load_sharing_");
  for (std::size_t i = 0; i < sharing.torque_shares.size(); ++i) {
    const double share = sharing.torque_shares[i];
    auto& row = by_torque.rows.emplace_back(std::vector{share, share * sun_torque});
    add_cells(row, sharing.quantiles[i]);
  }
  Csv contributions{.header = header, .columns = {"tolerance", "zone_radius_um"}, .rows = {}};
  add_columns(contributions.columns, "alone_");
  add_columns(contributions.columns, "without_");
  std::string names;
  for (std::size_t i = 0; i < sharing.contributions.size(); ++i) {
    const auto& c = sharing.contributions[i];
    names += fmt::format("{}{} {}", i ? ", " : "", i + 1, c.tolerance);
    auto& row = contributions.rows.emplace_back(std::vector{static_cast<double>(i + 1), c.radius / units::um});
    add_cells(row, c.alone);
    add_cells(row, c.without);
  }
  contributions.header.emplace_back("tolerances", names);
  Csv assemblies{.header = header, .columns = {"assembly"}, .rows = {}};
  for (const double share : sharing.torque_shares)
    assemblies.columns.push_back(fmt::format("load_sharing_at_{:g}", share));
  for (std::size_t a = 0; a < sharing.factors.front().size(); ++a) {
    auto& row = assemblies.rows.emplace_back(1, static_cast<double>(a + 1));
    for (const auto& factors : sharing.factors) row.push_back(factors[a]);
  }
  assemblies.round();
  std::filesystem::create_directories(folder);
  by_torque.write(folder / "tolerance_sharing.csv");
  contributions.write(folder / "tolerance_contributions.csv");
  assemblies.write(folder / "assemblies.csv");
}

}  // namespace

const std::vector<SharingQuantile>& sharing_quantiles() {
  static const std::vector<SharingQuantile> list = {{"p50", "P50", "50 %", &SharingQuantiles::p50},
                                                    {"p95", "P95", "95 %", &SharingQuantiles::p95},
                                                    {"p99", "P99", "99 %", &SharingQuantiles::p99}};
  return list;
}

dynamics::StageTolerances stage_tolerances(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& t = planetary(scene).tolerances.value();
  const auto& set = geometry.rings.at(ring).set;
  dynamics::StageTolerances zones;
  zones.planet_pin_position = t.planet_pin_position.value_or(0) / 2;
  zones.sun_eccentricity = runout("sun", set.sun(), t.sun_runout, t.sun_class, t.accuracy_class) / 2;
  zones.planet_eccentricity = runout("planet", set.planet(), t.planet_runout, t.planet_class, t.accuracy_class) / 2;
  zones.ring_eccentricity = runout("ring", set.ring(), t.ring_runout, t.ring_class, t.accuracy_class) / 2;
  zones.within = t.distribution == ToleranceLaw::normal ? dynamics::WithinZone::normal : dynamics::WithinZone::uniform;
  return zones;
}

Figure ToleranceSharing::figure(Interval SharingQuantiles::*quantile, std::size_t torque) const {
  const auto& q = sharing.quantiles.at(torque).*quantile;
  const double drawn = std::max(q.high - q.value, q.value - q.low);
  return {q.value, std::isfinite(drawn) ? drawn + (q.value - 1) * stiffness_error : not_known};
}

std::optional<ToleranceSharing> tolerance_sharing(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                                  const dynamics::PlanetaryStage& stage, const MeshResult& sun_mesh,
                                                  const MeshResult& ring_mesh, const RunOptions& options) {
  if (!planetary(scene).tolerances) return std::nullopt;
  const auto& t = *planetary(scene).tolerances;
  const auto& name = planetary(scene).rings.at(ring).name;
  const auto zones = stage_tolerances(scene, geometry, ring);
  const dynamics::AssemblyOptions settings{.assemblies = t.assemblies,
                                           .seed = static_cast<std::uint64_t>(t.seed),
                                           .torque_shares = t.torque_shares,
                                           .threads = options.threads};
  const auto id =
      identity_of(stage, table_behind(stage.sun_mesh, sun_mesh.table), table_behind(stage.ring_mesh, ring_mesh.table),
                  zones, settings.assemblies, settings.seed, settings.torque_shares);
  auto [sharing, reused] = cached_value(options.store.get(), cached_sharing, id,
                                        [&] { return dynamics::assembly_sharing(stage, zones, settings); });
  note_reuse(options, fmt::format("assemblies of '{}'", name), source_of(reused));
  save(sharing, stage.sun_torque, id, options.out / name / "dynamics");
  log::info(fmt::format("load sharing of '{}' within the tolerances: {}", name,
                        reused ? "unchanged, reused" : fmt::format("{} assemblies", t.assemblies)));
  const double sun = sun_mesh.mean_stiffness().error_relative, wheel = ring_mesh.mean_stiffness().error_relative;
  return ToleranceSharing{std::move(sharing), std::isnan(sun + wheel) ? not_known : std::max(sun, wheel)};
}

double tolerance_seconds(const Scene& scene) {
  if (!planetary(scene).tolerances) return 0;
  const auto& t = *planetary(scene).tolerances;
  // Equilibria: those of every torque, then each tolerance alone and left out at one torque. The time of one is that of
  // the demo with five planets; others by the number of candidates and of unknowns.
  const double planets = scene.stage.planets, torques = static_cast<double>(t.torque_shares.size()) + 1;
  const auto drawn = [&](const std::optional<int>& own_class, const std::optional<double>& runout) {
    return t.accuracy_class || own_class || runout ? 1 : 0;
  };
  const int tolerances = (t.planet_pin_position.value_or(0) > 0 ? 1 : 0) + drawn(t.sun_class, t.sun_runout) +
                         drawn(t.planet_class, t.planet_runout) + drawn(t.ring_class, t.ring_runout);
  constexpr double per_planet_squared = 9e-5;
  return t.assemblies * (torques + 2 * tolerances) * per_planet_squared * planets * planets;
}

const std::vector<FigureSpec>& tolerance_figures() {
  static const auto list = [] {
    std::vector<FigureSpec> specs;
    for (const auto& q : sharing_quantiles())
      specs.push_back({.key = figure_key(q),
                       .title = fmt::format("Load sharing of assemblies within the tolerances, {}", q.symbol),
                       .axis = "N |F| / Σ|F|",
                       .definition = "quantile over assemblies of the quasi-static load-sharing factor, averaged over "
                                     "a mesh cycle, largest over the error period",
                       .term = "load_sharing_of_assemblies",
                       .better = Better::smaller,
                       .quantity = "load_sharing",
                       .digits = 4,
                       .headline = std::string(q.key) != "p99",
                       .compared = true});
    return specs;
  }();
  return list;
}

FigureSet figures(const ToleranceSharing& sharing) {
  FigureSet set;
  for (const auto& q : sharing_quantiles())
    set.set(figure_key(q), sharing.figure(q.interval, sharing.sharing.nominal()));
  return set;
}

Json to_json(const ToleranceSharing& result) {
  const auto& sharing = result.sharing;
  Json json = {{"assemblies", sharing.factors.front().size()},
               {"stiffness_error_relative", json_number(result.stiffness_error)}};
  for (std::size_t i = 0; i < sharing.torque_shares.size(); ++i) {
    auto row = quantiles_json(sharing.quantiles[i]);
    row["torque_share"] = sharing.torque_shares[i];
    json["by_torque"].push_back(std::move(row));
  }
  for (const auto& c : sharing.contributions)
    json["contributions"].push_back({{"tolerance", c.tolerance},
                                     {"zone_radius_m", c.radius},
                                     {"alone", quantiles_json(c.alone)},
                                     {"without", quantiles_json(c.without)}});
  return json;
}

std::vector<Warning> tolerance_warnings(const ToleranceSharing& sharing, const std::vector<const MeshResult*>& tables,
                                        const std::string& ring) {
  std::vector<Warning> list;
  for (const auto* mesh : tables) {
    const auto& loads = mesh->table.loads();
    const double largest = sharing.sharing.largest_force;
    if (!mesh->tabulated || loads.size() < 2 || largest <= loads.back()) continue;
    list.push_back(
        {"force_beyond_table", Severity::note,
         fmt::format("some assemblies within the tolerances have forces up to {:.4g} kN, beyond the tabulated "
                     "{:.4g} kN, where the law continues with its tangent",
                     largest / 1e3, loads.back() / 1e3),
         ring + ", " + mesh->model.label()});
  }
  return list;
}

std::string tolerance_text(const dynamics::AssemblySharing::Contribution& contribution) {
  static const std::map<std::string, const char*> texts = {{"planet_pin_position", "planet pins within ⌀ {:.3g} µm"},
                                                           {"sun_eccentricity", "runout of the sun, {:.3g} µm"},
                                                           {"planet_eccentricity", "runout of the planets, {:.3g} µm"},
                                                           {"ring_eccentricity", "runout of the ring, {:.3g} µm"}};
  return fmt::format(fmt::runtime(texts.at(contribution.tolerance)), 2 * contribution.radius / units::um);
}

std::string text(const TabulatedSharing& tabulated) {
  if (tabulated.low == tabulated.high) return fmt::format("{:g}", tabulated.low);
  return fmt::format("{:g} to {:g}", tabulated.low, tabulated.high);
}

std::optional<TabulatedSharing> tabulated_sharing(int planets) {
  // By the class of tolerance, and by the standard: they disagree.
  static constexpr std::array<TabulatedSharing, 5> tables = {
      {{3, 1.0, 1.1}, {4, 1.2, 1.25}, {5, 1.3, 1.35}, {6, 1.4, 1.44}, {7, 1.47, 1.47}}};
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.planets == planets; });
  return found == tables.end() ? std::nullopt : std::optional(*found);
}

}  // namespace annulus::app
