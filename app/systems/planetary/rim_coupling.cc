#include "app/systems/planetary/rim_coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/shared/mesh_names.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "fem/ring/ring_coupling.h"

namespace annulus {

ANNULUS_MEMBERS(app::SolvedCoupling, coupling, mesh_compliance, path_compliance, compliance_error, frequency_error,
                highest_frequency, seconds, reused, reused_teeth, teeth);

}  // namespace annulus

namespace annulus::app {

namespace {

// The coupling is applied beyond this part of the wanted accuracy; what it would change below is in the errors.
constexpr double part_of_accuracy = 0.1;
constexpr int coupling_level = 1;  // the far field converges fast; its error is estimated
/// Modes up to this multiple of the mesh frequency: the mesh excites little beyond.
constexpr double highest_mesh_order = 10;

double highest_frequency(const GearGeometry& geometry) {
  return highest_mesh_order * geometry.operating_point.mesh_frequency;
}

/// Mesh and planet bearing in series; 1/K_path of the stage without its sun mesh, hence rather too small.
double path_compliance(const Scene& scene, const GearGeometry& geometry, double mesh_compliance) {
  return mesh_compliance +
         bearing_compliance(scene, geometry.rings.front().set, geometry.operating_point.mean_mesh_force);
}

/// Ring teeth by which each planet stands ahead of the first.
std::vector<double> places_on_ring(const GearGeometry& geometry, const RingInput& ring) {
  const auto found = std::find_if(geometry.rings.begin(), geometry.rings.end(),
                                  [&](const auto& candidate) { return candidate.name == ring.name; });
  std::vector<double> places;
  places.reserve(static_cast<std::size_t>(found->set.planets()));
  for (int n = 0; n < found->set.planets(); ++n) places.push_back(found->set.ring_teeth_ahead(n));
  return places;
}

std::string coupling_id(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                        const RingInput& ring) {
  return identity_of(model.id(), coupling_level, model.coupling_degree, places_on_ring(geometry, ring),
                     geometry.operating_point.mean_mesh_force, highest_frequency(geometry),
                     material_of(scene, ring).density);
}

RimCoupling asked_coupling(const Scene& scene) {
  return scene.dynamics ? planetary(scene).rim_coupling : RimCoupling::automatic;
}

const RingInput& ring_of(const Scene& scene, const MeshModel& model) {
  return *std::find_if(planetary(scene).rings.begin(), planetary(scene).rings.end(),
                       [&](const auto& r) { return r.name == model.variant; });
}

/// A ring on a single pin leans on its housing, now here, now there: no fixed supports hold it.
bool rests_in_bore(const fem::RingStructure& structure) { return structure.single_supports() == 1; }

constexpr const char* cached_couplings = "couplings";

/// The ring reduced to its teeth, a row and a column each.
Csv teeth_table(const fem::SolvedRingCoupling& solved) {
  const auto& compliance = solved.teeth_compliance;
  Csv csv;
  csv.header = {{"content",
                 "deflection at the flank of a tooth along the line of action per newton on the flank of another; the "
                 "supports hold the ring in both directions; the inverse is the stiffness matrix"},
                {"error_m_per_N", fmt::format("{:.3g}", solved.teeth_compliance_error)}};
  csv.columns = {"tooth"};
  for (Eigen::Index j = 0; j < compliance.cols(); ++j)
    csv.columns.push_back(fmt::format("compliance_tooth_{}_m_per_N", j));
  for (Eigen::Index i = 0; i < compliance.rows(); ++i) {
    auto& row = csv.rows.emplace_back();
    row.push_back(static_cast<double>(i));
    for (Eigen::Index j = 0; j < compliance.cols(); ++j) row.push_back(compliance(i, j));
  }
  return csv;
}

/// ring_coupling.csv, ring_modes.csv and ring_compliance.csv.
void save(const SolvedCoupling& solved, const std::string& id, const std::filesystem::path& folder, Times times) {
  const std::vector<std::pair<std::string, std::string>> stamp = {{"annulus_version", version()}, {"inputs_id", id}};
  std::filesystem::create_directories(folder);
  auto teeth = solved.teeth;
  teeth.header.insert(teeth.header.begin(), stamp.begin(), stamp.end());
  teeth.write(folder / "ring_compliance.csv");
  auto coupling = solved.coupling;
  coupling.provenance = stamp;
  coupling.provenance.insert(
      coupling.provenance.end(),
      {{"coupling_error_m_per_N", fmt::format("{:.17g}", solved.compliance_error)},
       {"mode_frequency_error_relative", fmt::format("{:.17g}", solved.frequency_error_relative)}});
  if (times == Times::stated)
    coupling.provenance.emplace_back("coupling_seconds", fmt::format("{:.3f}", solved.seconds));
  coupling.write_csv(folder / "ring_coupling.csv", folder / "ring_modes.csv");
}

}  // namespace

CouplingChoice coupling_choice(const Scene& scene, const SolvedCoupling& solved) {
  constexpr const char* asked = "the scene asks for it (rim_coupling)";
  const double share = solved.largest() / solved.path_compliance;
  const auto percent = [](double x) { return fmt::format("{:.2g} %", 100 * x); };
  switch (asked_coupling(scene)) {
    case RimCoupling::none:
      return {RimCoupling::none, asked};
    case RimCoupling::statical:
      return {RimCoupling::statical, asked};
    case RimCoupling::elastic:
      return {RimCoupling::elastic, asked};
    case RimCoupling::automatic:
      break;
  }
  const double limit = part_of_accuracy * scene.accuracy;
  const bool small = share <= limit;
  return {small ? RimCoupling::none : RimCoupling::statical,
          fmt::format("under the load of another planet a mesh deflects by at most {} of the deflection of the "
                      "planet's path (mesh and bearing) under its own load: {} than {}, a tenth of the wanted accuracy",
                      percent(share), small ? "less" : "more", percent(limit))};
}

bool is_negligible(const Scene& scene, const SolvedCoupling& solved) {
  return asked_coupling(scene) == RimCoupling::automatic && solved.coupling.modes.empty() &&
         coupling_choice(scene, solved).taken == RimCoupling::none;
}

std::shared_ptr<const RingCoupling> taken_coupling(const SolvedCoupling& solved, RimCoupling taken) {
  if (taken == RimCoupling::none) return nullptr;
  auto coupling = std::make_shared<RingCoupling>(solved.coupling);
  if (taken != RimCoupling::elastic) coupling->modes.clear();
  return coupling;
}

std::optional<dynamics::PlanetaryStage> with_omitted_coupling(const dynamics::PlanetaryStage& stage,
                                                              const MeshResult& ring_mesh) {
  if (!ring_mesh.coupling || stage.ring_coupling) return std::nullopt;
  auto coupled = stage;
  coupled.ring_coupling = taken_coupling(*ring_mesh.coupling, RimCoupling::statical);
  return coupled;
}

bool may_be_coupled(const Scene& scene, const MeshModel& model) {
  return scene.dynamics && may_be_coupled_at_rest(scene, model);
}

bool may_be_coupled_at_rest(const Scene& scene, const MeshModel& model) {
  if (asked_coupling(scene) == RimCoupling::none || scene.stage.planets == 1) return false;
  if (model.mesh != ring_planet || !model.computed() || rests_in_bore(model.problem->structure)) return false;
  if (model.has_elements()) return true;
  return scene.fidelity == Fidelity::automatic && scene.accuracy < fem::very_rough_accuracy &&
         fem::on_single_supports(model.problem->structure);
}

SolvedCoupling solve_coupling(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                              double mesh_compliance, const RunOptions& options, const std::filesystem::path& folder) {
  const auto& ring = ring_of(scene, model);
  const auto solve = [&] {
    const Stopwatch watch;
    fem::RingCouplingSettings settings;
    settings.level = coupling_level;
    settings.degree = model.coupling_degree;
    settings.threads = options.threads;
    settings.store = options.store;
    settings.modes.highest_frequency = highest_frequency(geometry);
    auto solved = fem::solve_ring_coupling(*model.problem, places_on_ring(geometry, ring),
                                           geometry.operating_point.mean_mesh_force, settings);
    SolvedCoupling result;
    result.teeth = teeth_table(solved);
    result.coupling = std::move(solved.coupling);
    result.compliance_error = solved.compliance_error;
    result.frequency_error_relative = solved.frequency_error_relative;
    result.highest_frequency = settings.modes.highest_frequency;
    result.seconds = watch.seconds();
    result.reused_teeth = solved.reused_teeth;
    count_reuse(options, condensed_teeth, solved.reused_teeth, solved.condensed_teeth);
    return result;
  };
  const auto id = coupling_id(scene, geometry, model, ring);
  auto [result, reused] = cached_value(options.store.get(), cached_couplings, id, solve);
  save(result, id, folder, options.times);
  result.teeth = {};
  result.mesh_compliance = mesh_compliance;
  result.path_compliance = path_compliance(scene, geometry, mesh_compliance);
  result.reused = reused;
  if (!reused)
    log::info(fmt::format(
        "coupling of the meshes through ring '{}': {} ring positions, {} modes below {:.0f} Hz; {:.2f} s", ring.name,
        result.coupling.compliance.size(), result.coupling.modes.size(), result.highest_frequency, result.seconds));
  return std::move(result);
}

}  // namespace annulus::app
