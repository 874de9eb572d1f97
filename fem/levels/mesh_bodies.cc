#include "fem/levels/mesh_bodies.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <thread>

#include "core/errors.h"
#include "core/stopwatch.h"
#include "fem/body/body_plan.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// What is to be condensed: kept as data so that meshing (gmsh, serial) and condensing (parallel) can be apart.
struct Task {
  geometry::Mesh mesh;
  const geometry::ToothProfile* profile;
  double support_radius;
  GearBodyOptions options;
  GearBody body{};
  double seconds = 0, saved_seconds = 0;  // taken, and spared by a tooth from the store
  bool reused = false;
};

void condense_all(std::vector<Task>& tasks, const Material& material, int threads) {
  std::vector<std::exception_ptr> failures(tasks.size());
  const auto condense_one = [&](std::size_t i) {
    try {
      auto& t = tasks[i];
      const Stopwatch watch;
      CondensedTooth tooth = condense_tooth(t.mesh, *t.profile, t.support_radius, material, t.options);
      t.reused = tooth.reused;
      if (t.reused) t.saved_seconds = std::max(0.0, tooth.seconds - watch.seconds());
      t.body = compose_body(std::move(tooth), t.options);
      t.seconds = watch.seconds();
    } catch (...) {
      failures[i] = std::current_exception();
    }
  };
  if (threads > 1) {
    std::vector<std::thread> pool;
    for (std::size_t i = 0; i < tasks.size(); ++i) pool.emplace_back(condense_one, i);
    for (auto& t : pool) t.join();
  } else {
    for (std::size_t i = 0; i < tasks.size(); ++i) condense_one(i);
  }
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

/// What the reused teeth saved of the time of condense_all.
double saved_seconds(const std::vector<Task>& tasks, int threads) {
  double with = 0, without = 0;
  for (const auto& t : tasks) {
    const double own = t.seconds, fresh = t.seconds + t.saved_seconds;
    with = threads > 1 ? std::max(with, own) : with + own;
    without = threads > 1 ? std::max(without, fresh) : without + fresh;
  }
  return without - with;
}

}  // namespace

MeshBodies build_bodies(const LoadedMeshProblem& problem, const FlankContact& flanks,
                        const LoadedMeshSettings& settings, int level) {
  const Stopwatch meshing;
  const auto& pair = problem.pair;
  const bool solid = settings.fidelity == Fidelity::solid;
  const SolvedFace face = solved_face(problem, settings);
  const BodyPlan planet(problem, flanks.planet(), false, geometry::Boundary::leading_flank, settings.degree, solid,
                        face);
  const BodyPlan wheel(problem, flanks.wheel(), true, flanks.wheel_flank(), settings.degree, solid, face);
  const BodyResolution solid_counts =
      solid ? solid_resolution(level, settings.degree, pair.overlap_ratio()) : BodyResolution{};
  std::optional<SupportPlan> supports;
  if (wheel.floating())
    // A slice per layer of elements: unilateral on its own.
    supports.emplace(support_sites(problem), pair.wheel().teeth(), face.edges(std::max(1, solid_counts.face_cells)),
                     face.half);

  std::vector<Task> tasks;
  const auto add_body = [&](const BodyPlan& plan) {
    const BodyResolution counts =
        solid ? solid_counts : plane_resolution(plan.profile().gear(), level, settings.degree);
    Task task{plan.sector(counts), &plan.profile(), plan.support_radius(), {}};
    task.options.sector = plan.model();
    task.options.store = settings.store.get();
    task.options.sector.want_stress = true;
    task.options.threads = solid ? settings.threads : 1;
    if (plan.floating()) task.options.arcs = supports->arcs();
    // In the plane the coupling all around costs little, and stresses are wanted there.
    task.options.extent.whole_ring = plan.floating() || !solid;
    tasks.push_back(std::move(task));
  };
  const auto add_section = [&](const BodyPlan& plan, const geometry::SectorResolution& resolution) {
    Task task{plan.section(resolution), &plan.profile(), plan.support_radius(), {}};
    task.options.sector = plan.near_field_model();
    task.options.store = settings.store.get();
    tasks.push_back(std::move(task));
  };
  add_body(planet);
  add_body(wheel);
  if (solid)
    // The near field of a solid body comes from plane bodies: the far field cancels.
    for (const auto* plan : {&planet, &wheel}) {
      add_section(*plan, plane_resolution(plan->profile().gear(), level).section);
      add_section(*plan, solid_counts.section);
    }

  MeshBodies bodies;
  bodies.mesh_seconds = meshing.seconds();
  const Stopwatch condensing;
  lapack::use_one_thread();
  condense_all(tasks, problem.material, settings.threads);
  for (const auto& task : tasks) ++(task.reused ? bodies.reused_teeth : bodies.condensed_teeth);
  bodies.saved_seconds = saved_seconds(tasks, settings.threads);
  bodies.face = face;
  bodies.slice_edges = face.edges(solid ? slices_per_cell(problem, settings.degree) * solid_counts.face_cells : 1);
  const auto near_field = [&](std::size_t fine, std::size_t coarse) {
    const auto compliance = [&](std::size_t index) -> Eigen::MatrixXd {
      const GearBody& body = tasks[index].body;
      return body.compliance.block(0).topLeftCorner(body.flank_ports(), body.flank_ports());
    };
    return NearField{tasks[fine].body.flank, tasks[coarse].body.flank, compliance(fine), compliance(coarse)};
  };
  bodies.unknowns = tasks[0].body.unknowns + tasks[1].body.unknowns;
  const auto source = [&](const Task& task) {
    return BodySource{task.mesh, task.profile, task.support_radius, task.options.sector};
  };
  bodies.planet_source = source(tasks[0]);
  bodies.wheel_source = source(tasks[1]);
  bodies.planet_sector = face.half ? planet.whole_sector(solid_counts) : std::move(tasks[0].mesh);
  bodies.wheel_sector = face.half ? wheel.whole_sector(solid_counts) : std::move(tasks[1].mesh);
  std::optional<NearField> planet_near_field, wheel_near_field;
  if (solid) {
    planet_near_field = near_field(2, 3);
    wheel_near_field = near_field(4, 5);
  }
  const double slant = 1 / std::cos(pair.planet().base_helix_angle());
  bodies.planet =
      std::make_unique<CondensedBody>(std::move(tasks[0].body), pair.planet().base_radius(), problem.material,
                                      bodies.slice_edges, std::move(planet_near_field), slant);
  bodies.wheel = std::make_unique<CondensedBody>(std::move(tasks[1].body), pair.wheel().base_radius(), problem.material,
                                                 bodies.slice_edges, std::move(wheel_near_field), slant);
  if (supports) bodies.supports = std::make_unique<SupportRow>(std::move(*supports), bodies.wheel->body());
  const double nu = problem.material.poisson_ratio;
  bodies.planet_stress = std::make_unique<StressRecovery>(bodies.planet->body(), problem.face_width, nu, nullptr);
  bodies.wheel_stress =
      std::make_unique<StressRecovery>(bodies.wheel->body(), problem.face_width, nu, bodies.supports.get());
  bodies.condense_seconds = condensing.seconds();
  return bodies;
}

}  // namespace annulus::fem
