#include "fem/levels/mesh_bodies.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "fem/body/body_plan.h"
#include "fem/condensation/lapack.h"
#include "fem/contact/pair_search.h"

namespace annulus::fem {
namespace {

/// A body to be condensed, as data, so that meshing (gmsh, serial) and condensing (parallel) can be apart.
struct Task {
  geometry::Mesh mesh;
  const geometry::ToothProfile* profile;
  double support_radius;
  GearBodyOptions options;
  Material material{};
  GearBody body{};
  bool reused = false;
};

/// The tasks of one gear.
struct GearTasks {
  Task body;
  std::optional<Task> fine, coarse;  // plane sections, from which the near field of a solid body comes
};

void set_material(GearTasks& gear, const Material& material) {
  gear.body.material = material;
  for (auto* section : {&gear.fine, &gear.coarse})
    if (*section) (*section)->material = material;
}

/// In the order in which they are started.
std::vector<Task*> all_tasks(GearTasks& pinion, GearTasks& wheel) {
  std::vector<Task*> tasks = {&pinion.body, &wheel.body};
  for (auto* gear : {&pinion, &wheel})
    for (auto* section : {&gear->fine, &gear->coarse})
      if (*section) tasks.push_back(&**section);
  return tasks;
}

void condense_all(const std::vector<Task*>& tasks, int threads) {
  // The first two take nearly all of the time: all at once, so that neither waits for a small one.
  for_each_task(tasks.size(), threads > 1 ? static_cast<int>(tasks.size()) : 1, [&](std::size_t i) {
    auto& t = *tasks[i];
    CondensedTooth tooth = condense_tooth(t.mesh, *t.profile, t.support_radius, t.material, t.options);
    t.reused = tooth.reused;
    t.body = compose_body(std::move(tooth), t.options);
  });
}

/// Meshes the bodies of a level.
class TaskMaker {
 public:
  /// `neighbours`: farthest teeth of a gear that may be in contact at once.
  TaskMaker(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level, int neighbours)
      : settings_(settings),
        neighbours_(neighbours),
        level_(level),
        solid_(settings.fidelity == Fidelity::solid),
        solid_counts_(solid_ ? solid_resolution(level, settings.degree, problem.pair.overlap_ratio())
                             : BodyResolution{}) {}

  [[nodiscard]] const BodyResolution& solid_counts() const { return solid_counts_; }

  /// `supports`: of a floating gear.
  [[nodiscard]] GearTasks make(const BodyPlan& plan, const std::optional<SupportPlan>& supports) const {
    GearTasks tasks{body(plan, supports), {}, {}};
    if (solid_) {
      // The far fields of both sections are equal: their difference is the near field.
      tasks.fine = section(plan, plane_resolution(plan.profile().gear(), level_).section);
      tasks.coarse = section(plan, solid_counts_.section);
    }
    return tasks;
  }

 private:
  [[nodiscard]] Task body(const BodyPlan& plan, const std::optional<SupportPlan>& supports) const {
    const BodyResolution counts =
        solid_ ? solid_counts_ : plane_resolution(plan.profile().gear(), level_, settings_.degree);
    Task task{plan.sector(counts), &plan.profile(), plan.support_radius(), {}};
    task.options.sector = plan.model();
    task.options.store = settings_.store.get();
    task.options.sector.outputs.insert(SectorOutput::stress);
    task.options.threads = solid_ ? settings_.threads : 1;
    if (plan.floating()) task.options.arcs = supports->arcs();
    // In the plane the coupling all around costs little, and stresses are wanted there.
    task.options.extent.whole_ring = plan.floating() || !solid_;
    task.options.extent.max_offset = neighbours_;
    return task;
  }

  [[nodiscard]] Task section(const BodyPlan& plan, const geometry::SectorResolution& resolution) const {
    Task task{plan.section(resolution), &plan.profile(), plan.support_radius(), {}};
    task.options.sector = plan.near_field_model();
    task.options.sector.outputs.insert(SectorOutput::stress);
    task.options.store = settings_.store.get();
    return task;
  }

  const LoadedMeshSettings& settings_;
  int neighbours_;
  int level_;
  bool solid_;
  BodyResolution solid_counts_;
};

std::optional<NearField> near_field(const GearTasks& tasks) {
  if (!tasks.fine) return std::nullopt;
  const auto compliance = [](const GearBody& body) -> Eigen::MatrixXd {
    return body.compliance.block(0).topLeftCorner(body.flank_ports(), body.flank_ports());
  };
  const GearBody &fine = tasks.fine->body, &coarse = tasks.coarse->body;
  return NearField{fine.flank, coarse.flank, compliance(fine), compliance(coarse)};
}

/// Of a plane body none: its section is the one that is solved.
NotchFactors notch_of(const GearTasks& tasks, double poisson_ratio, int degree) {
  return tasks.fine ? notch_factors(tasks.fine->body, tasks.coarse->body, poisson_ratio, degree) : NotchFactors{};
}

/// A gauge in the frame of the solve, which is the mirror image of a real ring. Gauges on the outside stand parallel to
/// the axis, as pins do: a straight outside is turned as a whole, a helical one under each of them.
StrainGauge in_solve(StrainGauge gauge, const LoadedMeshProblem& problem, const BodyPlan& plan) {
  if (problem.pair.internal()) {
    gauge.angle = -gauge.angle;
    gauge.offset = -gauge.offset;
  }
  if (gauge.place == StrainGauge::Place::outside)
    gauge.angle += plan.turn() != 0 ? plan.turn() : plan.profile().twist() * (problem.face_width / 2 - gauge.z);
  return gauge;
}

BodySource source_of(const Task& task) {
  return {task.mesh, task.profile, task.support_radius, task.options.sector, task.options.other_flank};
}

}  // namespace

MeshBodies build_bodies(const LoadedMeshProblem& problem, const FlankContact& flanks,
                        const LoadedMeshSettings& settings, int level) {
  const Stopwatch meshing;
  const auto& pair = problem.pair;
  const bool solid = settings.fidelity == Fidelity::solid;
  const auto dimension = solid ? BodyPlan::Dimension::solid : BodyPlan::Dimension::plane;
  const SolvedFace face = solved_face(problem, settings);
  const BodyPlan pinion_plan(problem, flanks.pinion(), geometry::GearRole::pinion, geometry::Boundary::leading_flank,
                             settings.degree, dimension, face);
  const BodyPlan wheel_plan(problem, flanks.wheel(), geometry::GearRole::wheel, flanks.wheel_flank(), settings.degree,
                            dimension, face);
  const int neighbours = most_pairs_in(possible_contacts(flanks), flanks) - 1;
  const TaskMaker maker(problem, settings, level, std::max(1, neighbours));
  const BodyResolution& counts = maker.solid_counts();
  std::optional<SupportPlan> supports;
  if (wheel_plan.floating())
    // A slice per layer of elements: unilateral on its own.
    supports.emplace(support_sites(problem), pair.wheel().teeth(),
                     wheel_plan.support_edges(support_slices(problem, counts.face_cells)), face.part(),
                     wheel_plan.turn());
  std::optional<SupportPlan> bed;
  if (pinion_plan.floating())
    bed = PlanetOnRollers::bed(*problem.planet_rollers, pair.pinion().teeth(),
                               pinion_plan.support_edges(support_slices(problem, counts.face_cells)), face.part());
  GearTasks pinion = maker.make(pinion_plan, bed), wheel = maker.make(wheel_plan, supports);
  if (bed) pinion.body.options.other_flank = {PlanetOnRollers::places, 0, face.half ? face.width / 2 : face.width};
  std::vector<StrainGauge> gauges;
  for (const auto& gauge : problem.gauges) {
    gauges.push_back(in_solve(gauge, problem, wheel_plan));
    wheel.body.options.gauges.push_back({gauges.back(), problem.materials.wheel, face.half ? face.width : 0});
    if (gauge.place != StrainGauge::Place::root) continue;
    StrainGauge hoop = gauges.back();
    hoop.direction = StrainGauge::Direction::hoop;
    for (auto* section : {&wheel.fine, &wheel.coarse})
      if (*section) (*section)->options.gauges.push_back({hoop, problem.materials.wheel, 0});
  }

  MeshBodies bodies;
  bodies.mesh_seconds = meshing.seconds();
  const Stopwatch condensing;
  lapack::use_one_thread();
  const auto tasks = all_tasks(pinion, wheel);
  set_material(pinion, problem.materials.pinion);
  set_material(wheel, problem.materials.wheel);
  condense_all(tasks, settings.threads);
  for (const auto* task : tasks) ++(task->reused ? bodies.reused_teeth : bodies.condensed_teeth);
  bodies.face = face;
  bodies.slice_edges = face.edges(solid ? slices_per_cell(problem, settings.degree) * counts.face_cells : 1);
  bodies.unknowns = pinion.body.body.unknowns + wheel.body.body.unknowns;
  bodies.pinion_source = source_of(pinion.body);
  bodies.wheel_source = source_of(wheel.body);
  bodies.pinion_sector = face.half ? pinion_plan.whole_sector(counts) : std::move(pinion.body.mesh);
  bodies.wheel_sector = face.half ? wheel_plan.whole_sector(counts) : std::move(wheel.body.mesh);
  const double slant = 1 / std::cos(pair.pinion().base_helix_angle());
  const auto condensed = [&](GearTasks& gear, double base_radius, const Material& material) {
    auto near = near_field(gear);
    return std::make_unique<CondensedBody>(std::move(gear.body.body), base_radius, material, bodies.slice_edges,
                                           std::move(near), slant);
  };
  const Material &of_pinion = problem.materials.pinion, &of_wheel = problem.materials.wheel;
  bodies.pinion_notch = notch_of(pinion, of_pinion.poisson_ratio, settings.degree);
  bodies.wheel_notch = notch_of(wheel, of_wheel.poisson_ratio, settings.degree);
  bodies.pinion = condensed(pinion, pair.pinion().base_radius(), of_pinion);
  bodies.wheel = condensed(wheel, pair.wheel().base_radius(), of_wheel);
  if (supports) bodies.supports = std::make_unique<SupportRow>(std::move(*supports), bodies.wheel->body());
  if (bed)
    bodies.rollers = std::make_unique<PlanetOnRollers>(*problem.planet_rollers, std::move(*bed), bodies.pinion->body());
  bodies.pinion_stress =
      std::make_unique<StressRecovery>(bodies.pinion->body(), problem.face_width, of_pinion.poisson_ratio,
                                       bed ? &bodies.rollers->row() : nullptr, bodies.pinion_notch);
  bodies.wheel_stress = std::make_unique<StressRecovery>(
      bodies.wheel->body(), problem.face_width, of_wheel.poisson_ratio, bodies.supports.get(), bodies.wheel_notch);
  std::size_t in_section = 0;
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    double factor = 1;
    if (wheel.fine && gauges[i].place == StrainGauge::Place::root)
      factor = gauge_factor(in_section++, gauges[i].angle, wheel.fine->body, wheel.coarse->body);
    bodies.gauges.emplace_back(i, bodies.wheel->body(), problem.face_width, bodies.supports.get(), factor);
  }
  bodies.condense_seconds = condensing.seconds();
  return bodies;
}

}  // namespace annulus::fem
