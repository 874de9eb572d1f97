#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/model/drawing_data.h"
#include "app/model/lumped_model.h"
#include "app/model/mesh_result.h"
#include "app/model/moving_faces.h"
#include "app/plan/cost_plan.h"
#include "app/plan/mesh_model.h"
#include "app/plan/warning.h"
#include "app/report/section.h"
#include "app/scene/new_scene.h"
#include "app/scene/scene.h"
#include "app/scene/scene_kind.h"
#include "core/figure.h"
#include "core/json.h"

namespace annulus::app {

class RexsFile;
struct Plan;
struct RunOptions;
struct RunResponse;
struct SystemRun;
struct SolvedCoupling;

/// A lumped model that a run answers.
struct RunVariant {
  std::string name;                 ///< in results
  std::string folder;               ///< below OUT
  std::vector<std::size_t> tables;  ///< those it stands on, by their places in GearSystem::run_meshes
};

/// A body that turns about its axis, to which a shaft can lead; speed and torque in the sense of its coordinate: their
/// product is the power that it takes up.
struct TurningBody {
  std::string name;
  double radius = 0;             ///< m, of its coordinate
  double speed = 0, torque = 0;  ///< rad/s, N m
};

/// A gear system of a scene: what one kind of them answers to the commands, which know no kind. A new kind is a class
/// of this sort in a folder of its own and a line in systems/registry.cc.
class GearSystem {
 public:
  explicit GearSystem(const Scene& scene) : scene_(scene) {}
  GearSystem(const GearSystem&) = delete;
  GearSystem& operator=(const GearSystem&) = delete;
  virtual ~GearSystem() = default;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// One line for people: "3 rings, 5 planets".
  [[nodiscard]] virtual std::string describe() const = 0;
  /// The lumped models that are compared: the variants of the scene (variant_names), else a single one without a name.
  [[nodiscard]] std::vector<std::string> variants() const;

  /// Geometry and whatever else needs no solving. Throws InputError and GeometryError without a place in the scene.
  virtual void check() const = 0;
  /// Its involute gears and their pairs, for a drawing.
  [[nodiscard]] virtual DrawingData drawing() const { return {}; }
  /// The meshes that are solved, and those whose stiffness is prescribed; the same number for every changed scene.
  [[nodiscard]] virtual std::vector<MeshModel> meshes() const = 0;
  /// N, of every mesh: the load at which the lumped model reads the tables.
  [[nodiscard]] virtual double mean_mesh_force() const = 0;

  /// The meshes on whose stiffness the lumped models stand; `meshes` may contain others to compare with.
  [[nodiscard]] virtual std::vector<MeshModel> model_meshes() const { return meshes(); }
  /// Those of one lumped model, by their places in model_meshes().
  [[nodiscard]] virtual std::vector<std::size_t> meshes_of(std::size_t variant) const;
  /// Stiffness of one of these meshes: solved into OUT/<variant> or cached, prescribed, or by a formula. Throws what
  /// solving throws, with its place in the scene.
  [[nodiscard]] virtual MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const = 0;
  /// The lumped model of a variant on the stiffness of its meshes, which are referred to. Values of prescribed
  /// stiffnesses are those of the scene, as studies change them. Needs [dynamics].
  [[nodiscard]] virtual std::unique_ptr<LumpedModel> model(std::size_t variant,
                                                           const std::vector<const MeshResult*>& tables) const = 0;
  /// The responses of a run, one step each; empty without [dynamics], and where they take no time.
  [[nodiscard]] virtual std::vector<PlannedResponse> responses() const { return {}; }
  /// Whether a computed mesh is coupled with the others through its ring, which is solved as a step of its own.
  [[nodiscard]] virtual bool coupled(const MeshModel& /*mesh*/) const { return false; }
  /// Predicted time and memory of a run by the cost laws.
  [[nodiscard]] PlanCost cost(int threads) const;
  /// What will be modelled and why; computes nothing elastic. Its times are scaled to this machine.
  [[nodiscard]] Plan plan(int threads) const;

  /// The meshes of a run: model_meshes, and behind them others that it answers beside the scene's own.
  [[nodiscard]] virtual std::vector<MeshModel> run_meshes() const { return model_meshes(); }
  /// What a run answers: the variants, and behind them others.
  [[nodiscard]] virtual std::vector<RunVariant> run_variants() const;
  /// Writes files of the kind's own into OUT that need nothing but the tables.
  virtual void save_inputs(const SystemRun& /*run*/, const RunOptions& /*options*/) const {}
  /// The results of the stiffness tables of a variant of run_variants alone.
  [[nodiscard]] virtual FigureSet table_figures(std::size_t variant,
                                                const std::vector<const MeshResult*>& tables) const;
  /// The table without which the lumped model of this scene does not have a result; empty: it has it.
  [[nodiscard]] virtual std::string table_for(const std::string& result) const;
  /// What the coupling of a computed mesh cost; nothing where it was reused.
  [[nodiscard]] virtual std::optional<CostRun> actual_coupling(CostRun /*size*/, const MeshResult& /*mesh*/) const {
    return std::nullopt;
  }

  /// Its gear data as REXS, of the variant of that name (export/rexs.h). Throws InputError where REXS cannot describe
  /// it.
  [[nodiscard]] virtual std::string rexs(const std::string& variant) const;
  /// Frame and meaning of the coordinates of its lumped systems, for files of their matrices.
  [[nodiscard]] virtual std::string coordinates() const { return "lengths, m"; }
  /// Bodies at which it can be part of a train; the lumped models then have LumpedModel::Abilities::lumped. Empty: it
  /// cannot.
  [[nodiscard]] virtual std::vector<TurningBody> turning_bodies() const { return {}; }
  /// The lumped model with rough stiffnesses, before anything is solved, of a system with such bodies and of trains:
  /// for the cost of motions.
  [[nodiscard]] virtual std::optional<dynamics::LumpedCase> rough_lumped() const { return std::nullopt; }
  /// The faces of a lumped model in which LumpedModel::in_space() finds something. Tables are referred to.
  [[nodiscard]] virtual MovingFaces moving_faces(std::size_t /*variant*/,
                                                 const std::vector<const MeshResult*>& /*tables*/,
                                                 const RunOptions& /*options*/) const {
    return {};
  }

  /// Whether the motions of a sweep can be found in this way.
  [[nodiscard]] virtual bool offers(SweepDirection direction) const { return direction == SweepDirection::each; }

  /// What the scene says of itself beyond what those of every kind do (scene_warnings.h).
  [[nodiscard]] virtual std::vector<Warning> scene_warnings() const { return {}; }
  /// The same of the response of a variant of run_variants (run_warnings.h).
  [[nodiscard]] virtual std::vector<Warning> response_warnings(const SystemRun& /*run*/,
                                                               std::size_t /*variant*/) const {
    return {};
  }

  // The defaults of the following know a lumped model by its results alone (run/plain_run.cc).
  /// The answer of a variant of run_variants on the tables of the run.
  [[nodiscard]] virtual std::unique_ptr<RunResponse> respond(const SystemRun& run, std::size_t variant,
                                                             const RunOptions& options) const;
  /// Members of summary.json beyond those of every kind.
  [[nodiscard]] virtual Json summary(const SystemRun& run) const;
  /// The results in a few lines for the standard output.
  [[nodiscard]] virtual std::string text(const SystemRun& run) const;
  /// The page of report.html.
  [[nodiscard]] virtual Page report(const SystemRun& run) const;

  /// The name of a variant in the cost study: the kind of one without a name.
  [[nodiscard]] virtual std::string title(std::size_t variant) const;
  /// How a coupled mesh is coupled with the others, cached or solved, with its files in `folder`; null without.
  [[nodiscard]] virtual std::shared_ptr<const SolvedCoupling> coupling(const MeshResult& mesh,
                                                                       const RunOptions& options,
                                                                       const std::filesystem::path& folder) const;
  /// Equilibrium over a turn, without inertia: writes OUT/statics.* and what belongs to it. Kinds that do not have it
  /// throw InputError.
  struct Statics {
    std::string text;  ///< for the standard output
    Json json;
    std::vector<Warning> warnings;
  };
  [[nodiscard]] virtual Statics statics(const RunOptions& options) const;
  /// The ways that the cost study compares to make and solve the model of a variant; system and tables are referred
  /// to. Needs [dynamics].
  [[nodiscard]] virtual ModelWays ways(std::size_t variant, const std::vector<const MeshResult*>& tables) const;

 protected:
  /// Fills what a kind has of its own: inputs, quantities, degrees of freedom, decisions about the motion, remarks.
  virtual void describe(Plan& plan) const = 0;

 private:
  const Scene& scene_;
};

/// A kind of gear system, as it is registered.
struct SystemKind {
  SceneKind scene;                                    ///< its tables, checks and example
  const std::vector<FigureSpec>& (*figures)();        ///< all results, those of its meshes first
  const std::vector<FigureSpec>& (*model_figures)();  ///< those of its lumped model, which studies vary
  std::unique_ptr<GearSystem> (*make)(const Scene& scene);
  /// What a REXS file says about a stage of this kind; nothing where it has none. Absent: REXS cannot describe it.
  std::optional<NewValues> (*from_rexs)(const RexsFile& file) = nullptr;
};
/// systems/registry.cc
[[nodiscard]] const std::vector<SystemKind>& system_kinds();
/// Adds a kind of one's own, before the first scene is read.
void register_system(SystemKind kind);
[[nodiscard]] const SystemKind& system_kind(const std::string& name);

/// The scene is referred to. Makes nothing but the object.
[[nodiscard]] std::unique_ptr<GearSystem> make_system(const Scene& scene);

/// What will be modelled and why; the cost is predicted for a run on `threads`.
[[nodiscard]] Plan make_plan(const Scene& scene, int threads = 1);

/// Makes the geometry and whatever else needs no solving. Throws InputError or GeometryError, with the place in the
/// scene, where the scene is not a good one.
void check_stage(const Scene& scene);

/// Whether a table solved for `nominal` answers for `changed` as well: the same bodies, and a mean mesh force within
/// the tabulated loads, between which tables are interpolated.
[[nodiscard]] bool table_serves(const MeshModel& nominal, const MeshModel& changed, double mean_mesh_force);
/// Stiffness tables (labels for people) that a changed scene needs and the nominal one does not have.
[[nodiscard]] std::vector<MeshModel> tables_to_solve(const Scene& nominal, const Scene& changed);

}  // namespace annulus::app
