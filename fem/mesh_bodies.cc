#include "fem/mesh_bodies.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <thread>

#include "core/errors.h"
#include "fem/condensation/lapack.h"
#include "fem/contact/contact_system.h"

namespace annulus::fem {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What is to be condensed: kept as data so that meshing (gmsh, serial) and condensing (parallel) can be apart.
struct Task {
  geometry::Mesh mesh;
  const geometry::ToothProfile* profile;
  double support_radius;
  GearBodyOptions options;
  GearBody body;
};

void condense_all(std::vector<Task>& tasks, const Material& material, int threads) {
  std::vector<std::exception_ptr> failures(tasks.size());
  const auto condense_one = [&](std::size_t i) {
    try {
      auto& t = tasks[i];
      t.body = make_gear_body(t.mesh, *t.profile, t.support_radius, material, t.options);
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

/// Arc length of the flank cells, s = rho^2 / (2 r_b); they are uniform.
double flank_cell(const Task& task) {
  const auto& flank = task.body.flank;
  const double low = flank.low(), high = flank.high();
  return (high * high - low * low) / (2 * task.profile->gear().base_radius()) / flank.elements();
}

std::vector<double> uniform_edges(double width, int cells) {
  std::vector<double> edges;
  for (int i = 0; i <= cells; ++i) edges.push_back(width * i / cells);
  return edges;
}

/// The supports of a floating ring; none when the structure holds the ring.
std::optional<SupportSites> support_sites(const LoadedMeshProblem& problem) {
  const SupportedRing ring{problem.pair.wheel().teeth(), problem.wheel_support_radius, problem.face_width,
                           problem.material};
  if (const auto* pinned = std::get_if<PinHeld>(&problem.structure)) return pin_sites(*pinned, ring);
  if (const auto* splined = std::get_if<SplineHeld>(&problem.structure)) return spline_sites(*splined, ring);
  return std::nullopt;
}

}  // namespace

double nominal_half_width(const LoadedMeshProblem& problem, const FlankContact& flanks) {
  const double nominal = problem.loads[problem.loads.size() / 2];
  return hertz_half_width(nominal / problem.face_width, flanks.relative_curvature(problem.pair.roll_length_pitch()),
                          problem.material);
}

MeshBodies build_bodies(const LoadedMeshProblem& problem, const FlankContact& flanks,
                        const LoadedMeshSettings& settings, int level) {
  const auto start = std::chrono::steady_clock::now();
  const auto& pair = problem.pair;
  const bool solid = settings.rung == Rung::solid;
  const auto sites = support_sites(problem);
  const auto* cantilever = std::get_if<EndFaceHeld>(&problem.structure);
  if (cantilever != nullptr && !solid)
    throw InputError("a ring held at its end face is a solid problem: the plane rung cannot model it");

  if (std::holds_alternative<FlangeHeld>(problem.structure) || (cantilever != nullptr && cantilever->hoop))
    throw InputError("rings with a flange or a hoop cannot be meshed yet");

  const double half_width = nominal_half_width(problem, flanks);
  const BodyResolution solid_counts = solid ? solid_resolution(level) : BodyResolution{};

  geometry::Rim planet_rim{problem.planet_bore_radius, {}}, wheel_rim{problem.wheel_support_radius, {}};
  if (cantilever != nullptr) wheel_rim.circles = {problem.wheel_support_radius - cantilever->sleeve_thickness};

  SectorModelOptions planet_model, wheel_model;
  planet_model.degree = wheel_model.degree = settings.degree;
  wheel_model.flank = flanks.wheel_flank();
  planet_model.want_stress = wheel_model.want_stress = true;
  std::optional<SupportPlan> plan;
  if (sites) {
    wheel_model.held = HeldBoundary::none;
    wheel_model.want_outside = true;
    // A slice per layer of elements: unilateral on its own.
    plan.emplace(*sites, pair.wheel().teeth(), uniform_edges(problem.face_width, std::max(1, solid_counts.face_cells)));
  }

  std::vector<Task> tasks;
  const auto plane_task = [&](bool wheel, const BodyResolution& counts, SectorModelOptions model) {
    const auto& profile = wheel ? flanks.wheel() : flanks.planet();
    const auto& rim = wheel ? wheel_rim : planet_rim;
    Task task{geometry::make_sector_mesh(profile.gear(), rim, counts.section), &profile, rim.support_radius, {}, {}};
    task.options.sector = model;
    task.options.threads = 1;
    if (wheel && model.want_outside) task.options.arcs = plan->arcs();
    // In the plane the coupling all around costs little, and stresses are wanted there.
    task.options.extent.whole_ring = model.want_outside || (!solid && model.want_stress);
    tasks.push_back(std::move(task));
  };
  const auto solid_task = [&](bool wheel) {
    plane_task(wheel, solid_counts, wheel ? wheel_model : planet_model);
    Task& task = tasks.back();
    std::vector<geometry::Layers> stacks;
    if (wheel && cantilever != nullptr) {
      geometry::Layers sleeve{-cantilever->free_length, 0, solid_counts.sleeve_cells};
      sleeve.region = geometry::Mesh::Region::sleeve;
      sleeve.toothed = false;
      sleeve.radius_low = wheel_rim.circles.front();
      stacks.push_back(sleeve);
      task.options.sector.held = HeldBoundary::end_low;
    }
    stacks.push_back({0, problem.face_width, solid_counts.face_cells});
    task.mesh = geometry::extrude(task.mesh, stacks);
    task.options.threads = settings.threads;
  };

  const auto plane_counts = [&](bool wheel) {
    return contact_resolution(wheel ? pair.wheel() : pair.planet(), half_width, level);
  };
  // The near field of a solid body comes from plane bodies held at the support circle: the far field cancels.
  SectorModelOptions planet_near = planet_model, wheel_near = wheel_model;
  if (solid) {
    solid_task(false);
    solid_task(true);
    for (const bool wheel : {false, true}) {
      auto& model = wheel ? wheel_near : planet_near;
      model.held = HeldBoundary::support;
      model.want_outside = model.want_stress = false;
      plane_task(wheel, plane_counts(wheel), model);
      plane_task(wheel, solid_counts, model);
    }
  } else {
    plane_task(false, plane_counts(false), planet_model);
    plane_task(true, plane_counts(true), wheel_model);
  }

  MeshBodies bodies;
  bodies.mesh_seconds = seconds_since(start);
  const auto condense_start = std::chrono::steady_clock::now();
  lapack::use_one_thread();
  condense_all(tasks, problem.material, settings.threads);
  bodies.slice_edges =
      solid ? uniform_edges(problem.face_width, 2 * solid_counts.face_cells) : uniform_edges(problem.face_width, 1);
  const auto near_field = [&](std::size_t fine, std::size_t coarse) {
    std::vector<NearFieldTerm> terms;
    for (const auto& [index, sign] : {std::pair{fine, 1.0}, std::pair{coarse, -1.0}}) {
      const GearBody& body = tasks[index].body;
      const int ports = body.flank_ports();
      terms.push_back({body.flank, body.compliance.block(0).topLeftCorner(ports, ports), sign});
    }
    return terms;
  };
  bodies.flank_cell = std::max(flank_cell(tasks[solid ? 2 : 0]), flank_cell(tasks[solid ? 4 : 1]));
  bodies.unknowns = tasks[0].body.unknowns + tasks[1].body.unknowns;
  bodies.planet_sector = std::move(tasks[0].mesh);
  bodies.wheel_sector = std::move(tasks[1].mesh);
  auto planet_terms = solid ? near_field(2, 3) : std::vector<NearFieldTerm>{};
  auto wheel_terms = solid ? near_field(4, 5) : std::vector<NearFieldTerm>{};
  bodies.planet = std::make_unique<ContactBody>(std::move(tasks[0].body), bodies.slice_edges, std::move(planet_terms));
  bodies.wheel = std::make_unique<ContactBody>(std::move(tasks[1].body), bodies.slice_edges, std::move(wheel_terms));
  if (plan) bodies.supports = std::make_unique<SupportRow>(std::move(*plan), bodies.wheel->body());
  const double nu = problem.material.poisson_ratio;
  bodies.planet_stress = std::make_unique<StressRecovery>(bodies.planet->body(), problem.face_width, nu, nullptr);
  bodies.wheel_stress =
      std::make_unique<StressRecovery>(bodies.wheel->body(), problem.face_width, nu, bodies.supports.get());
  bodies.condense_seconds = seconds_since(condense_start);
  return bodies;
}

}  // namespace annulus::fem
