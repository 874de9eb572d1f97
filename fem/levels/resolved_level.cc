#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/stopwatch.h"
#include "fem/body/body_plan.h"
#include "fem/condensation/altered_ring.h"
#include "fem/condensation/lapack.h"
#include "fem/contact/contact_system.h"
#include "fem/contact/hertz.h"
#include "fem/contact/pair_search.h"
#include "fem/levels/level.h"

namespace annulus::fem {
namespace {

constexpr int most_pairs = 6;         // that may touch at once
constexpr double patch_reach = 1.6;   // in Hertz half-widths of the whole load
constexpr double patch_window = 1.4;  // half-length of the pressure elements' window, likewise

/// Numbers of a level: nested by the ratio of all levels.
struct PatchResolution {
  double cells = 0;    ///< in a half-width
  double growth = 0;   ///< of the cells beyond the patch
  double at_edge = 0;  ///< length of the cells under a tip edge relative to those of the patch
  BodyResolution regular;
};

PatchResolution patch_resolution(const geometry::Gear& gear, BodyPlan::Dimension dimension, int level) {
  const double refine = std::pow(level_ratio, level - 1);
  PatchResolution r;
  if (dimension == BodyPlan::Dimension::solid) {
    r.cells = 3 * refine;
    r.growth = 1 + 0.7 / refine;
    r.at_edge = 1 / 3.0;
    r.regular = resolved_solid_resolution(level);
  } else {
    r.cells = 6 * refine;
    r.growth = 1 + 0.3 / refine;
    r.at_edge = 1 / 8.0;
    r.regular = plane_resolution(gear, level);
  }
  return r;
}

/// Where a flank is to be resolved.
struct PlaceOfContact {
  double arc = 0;               ///< m, along the flank
  double half_width = 0;        ///< m, if this contact took the whole load
  std::vector<double> edges{};  ///< m, likewise, of tip edges within reach
  double gap = 0;               ///< m, smallest before loading
  double roll = 0;              ///< m, theoretical contact on the pinion
  bool resolved = true;         ///< else the tooth keeps its regular mesh
};

/// A gear whose teeth can be exchanged.
struct Exchangeable {
  BodyPlan plan;
  PatchResolution resolution;
  geometry::Mesh regular_mesh;
  CondensedTooth regular;
  AlteredRing ring;

  static CondensedTooth condense(const BodyPlan& plan, const Material& material, const geometry::Mesh& mesh) {
    GearBodyOptions options;
    options.sector = plan.model();
    return condense_tooth(mesh, plan.profile(), plan.support_radius(), material, options);
  }
  Exchangeable(BodyPlan body_plan, const Material& material, BodyPlan::Dimension dimension, int level, int threads)
      : plan(std::move(body_plan)),
        resolution(patch_resolution(plan.profile().gear(), dimension, level)),
        regular_mesh(plan.sector(resolution.regular)),
        regular(condense(plan, material, regular_mesh)),
        ring(regular.sector, plan.profile().gear().teeth(), most_pairs, threads) {}

  /// `contacts`: on neighbouring teeth from `first_tooth` counter-clockwise.
  [[nodiscard]] ResolvedBody body(const std::vector<PlaceOfContact>& contacts, int first_tooth,
                                  const Material& material, const std::vector<double>& slice_edges) const {
    const auto& gear = plan.profile().gear();
    std::vector<CondensedTooth> teeth;
    for (const auto& contact : contacts) {
      if (!contact.resolved) {
        teeth.push_back(regular);
        continue;
      }
      const double cell = contact.half_width / resolution.cells;
      BodyResolution patch = resolution.regular;
      patch.section = resolving_section(gear, resolution.regular.section,
                                        {contact.arc, patch_reach * contact.half_width, cell, resolution.growth,
                                         contact.edges, resolution.at_edge * cell});
      teeth.push_back(condense(plan, material, plan.sector(patch)));
    }
    std::vector<const CondensedSector*> sectors;
    std::vector<GearBody> bodies;
    for (auto& tooth : teeth) {
      sectors.push_back(&tooth.sector);
      bodies.push_back(std::move(tooth.body));
    }
    return {std::move(bodies), first_tooth, ring.compliance(sectors), gear.base_radius(), slice_edges};
  }
};

void refuse_what_is_not_resolved(const LoadedMeshProblem& problem) {
  if (on_single_supports(problem.structure))
    throw InputError(
        fmt::format("the resolved model does not cover rings on pins or splines, and the ring has {}: use "
                    "the plane or solid model",
                    problem.structure.words().description));
  if (problem.pair.pinion().helix_angle() != 0)
    throw InputError(
        fmt::format("the resolved model does not cover helical gears, here of {:.4g} degrees: use the solid "
                    "model",
                    problem.pair.pinion().helix_angle() * 180 / M_PI));
}

/// The gears of a resolved mesh.
struct ResolvedMesh {
  const LoadedMeshProblem& problem;
  const FlankContact& flanks;
  BodyPlan::Dimension dimension;
  SolvedFace face;
  Exchangeable pinion, wheel;
  std::vector<double> slice_edges;

  ResolvedMesh(const LoadedMeshProblem& p, const LoadedMeshSettings& settings, const FlankContact& f, int level)
      : problem(p),
        flanks(f),
        dimension(settings.fidelity == Fidelity::resolved_solid ? BodyPlan::Dimension::solid
                                                                : BodyPlan::Dimension::plane),
        face(solved_face(p, settings)),
        pinion({p, f.pinion(), geometry::GearRole::pinion, geometry::Boundary::leading_flank, settings.degree,
                dimension, face},
               p.materials.pinion, dimension, level, settings.threads),
        wheel({p, f.wheel(), geometry::GearRole::wheel, f.wheel_flank(), settings.degree, dimension, face},
              p.materials.wheel, dimension, level, settings.threads),
        slice_edges(face.edges(dimension == BodyPlan::Dimension::solid
                                   ? slices_per_cell(p, settings.degree) * pinion.resolution.regular.face_cells
                                   : 1)) {}

  [[nodiscard]] LoadedPosition solve(double phase, double load) const;

 private:
  /// Contacts of all pairs in their order, on the pinion and on the wheel.
  struct Places {
    std::vector<PlaceOfContact> pinion, wheel;
  };
  [[nodiscard]] Places places(const std::vector<std::pair<int, double>>& pairs, double load) const;
};

ResolvedMesh::Places ResolvedMesh::places(const std::vector<std::pair<int, double>>& pairs, double load) const {
  const auto pinion_arc = [&](double roll) { return roll * roll / (2 * problem.pair.pinion().base_radius()); };
  const auto wheel_arc = [&](double roll) { return roll * roll / (2 * problem.pair.wheel().base_radius()); };
  Places result;
  for (const auto& [index, roll] : pairs) {
    PlaceOfContact pinion_place;
    pinion_place.half_width = hertz_half_width(flanks, roll, load / problem.face_width, problem.materials);
    pinion_place.roll = roll;
    const double centre = flanks.nearest_roll(roll, flanks.domain(roll));
    const auto opposite = flanks.match(centre, roll);
    pinion_place.gap = opposite.gap;
    pinion_place.arc = pinion_arc(centre);
    auto wheel_place = pinion_place;
    wheel_place.arc = wheel_arc(opposite.wheel_roll);
    const auto domain = flanks.domain(roll);
    for (const double end : {domain.low, domain.high}) {
      if (std::abs(pinion_arc(end) - pinion_place.arc) > patch_reach * pinion_place.half_width) continue;
      pinion_place.edges.push_back(pinion_arc(end));
      wheel_place.edges.push_back(wheel_arc(flanks.match(end, roll).wheel_roll));
    }
    result.pinion.push_back(std::move(pinion_place));
    result.wheel.push_back(std::move(wheel_place));
  }
  return result;
}

LoadedPosition ResolvedMesh::solve(double phase, double load) const {
  const auto pairs = possible_pairs(flanks, phase);
  require(static_cast<int>(pairs.size()) <= most_pairs,
          fmt::format("{} tooth pairs; the resolved model has at most {}", pairs.size(), most_pairs));
  const int first = wheel_tooth(flanks, pairs.front().first, 0);
  const int last = wheel_tooth(flanks, pairs.back().first, 0);
  ContactOptions options;
  options.gaps = {problem.misalignment, problem.pinion_overhang.below, problem.wheel_overhang.below};
  options.half_face = face.half;
  options.window = patch_window;
  options.pairs = pitch_beyond_path(flanks);  // further teeth have no meshes
  Places contacts = places(pairs, load);
  double least_gap = contacts.pinion.front().gap;
  for (const auto& place : contacts.pinion) least_gap = std::min(least_gap, place.gap);
  // A pair further apart than such a softly estimated mesh gives way will not touch: no mesh of its own, which is most
  // of the work. Where it touches nevertheless, all pairs get theirs.
  constexpr double soft_mesh = 8e9;  // N/m per m of face width
  const double reach = load / (soft_mesh * problem.face_width);
  for (auto* list : {&contacts.pinion, &contacts.wheel})
    for (auto& place : *list) place.resolved = place.gap - least_gap < reach;
  for (;;) {
    auto on_wheel = contacts.wheel;
    if (last < first) std::reverse(on_wheel.begin(), on_wheel.end());
    const ResolvedBody pinion_body =
        pinion.body(contacts.pinion, pairs.front().first, problem.materials.pinion, slice_edges);
    const ResolvedBody wheel_body = wheel.body(on_wheel, std::min(first, last), problem.materials.wheel, slice_edges);
    const ContactSystem system(flanks, pinion_body, wheel_body, nullptr, problem.materials, slice_edges, options);
    ContactSystem::PairsCache cache;
    ContactSystem::WarmStart warm;
    auto position = system.solve(0, phase, load, cache, warm, nullptr);
    bool all_resolved = true;
    for (std::size_t i = 0; i < position.pair_share.size(); ++i)
      for (const auto& place : contacts.pinion)
        if (place.roll == position.pair_roll[i] && position.pair_share[i] > 0) all_resolved &= place.resolved;
    if (all_resolved) return position;
    for (auto* list : {&contacts.pinion, &contacts.wheel})
      for (auto& place : *list) place.resolved = true;
  }
}

}  // namespace

SolvedLevel solve_resolved_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                 const FlankContact& flanks, int level, const AcceptLevel& accept,
                                 const ProgressFunction& progress) {
  refuse_what_is_not_resolved(problem);
  lapack::use_one_thread();
  SolvedLevel result;
  const Stopwatch condensing;
  const ResolvedMesh mesh(problem, settings, flanks, level);
  result.condense_seconds = condensing.seconds();
  const Stopwatch solving;
  const PositionSolver solver{.solve = [&](int, int phase, int load, PositionTask&, LoadedPosition& position) {
    position = mesh.solve(static_cast<double>(phase) / problem.phases, problem.loads[load]);
  }};
  const double compared = accept ? compared_share(problem) : 1;
  solve_positions(problem, settings, PositionsOf::comparison, PositionTasks::by_phase, solver,
                  part_of(progress, 0, compared), result.positions);
  if (accept && accept(result))
    solve_positions(problem, settings, PositionsOf::table, PositionTasks::by_phase, solver,
                    part_of(progress, compared, 1), result.positions);
  result.contact_seconds = solving.seconds();
  result.unknowns = mesh.pinion.regular.body.unknowns + mesh.wheel.regular.body.unknowns;
  result.half_face = mesh.face.half;
  result.slice_edges = result.half_face ? mirrored_edges(mesh.slice_edges) : mesh.slice_edges;
  const auto whole = [&](const Exchangeable& gear) {
    return result.half_face ? gear.plan.whole_sector(gear.resolution.regular) : gear.regular_mesh;
  };
  result.pinion_sector = whole(mesh.pinion);
  result.wheel_sector = whole(mesh.wheel);
  return result;
}

}  // namespace annulus::fem
