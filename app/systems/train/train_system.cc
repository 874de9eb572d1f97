#include "app/systems/train/train_system.h"
#include "app/model/scene_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>

#include "app/plan/plan.h"
#include "app/systems/shared/faces.h"
#include "app/systems/train/train_motion.h"
#include "core/errors.h"
#include "core/not_known.h"
#include "core/units.h"
#include "dynamics/figures/common_figures.h"

namespace annulus::app {

namespace {

class TrainSystem final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    std::vector<std::string> names;
    for (const auto& part : scene().own<TrainInput>().parts) names.push_back(part.name);
    return fmt::format("train of {}", fmt::join(names, ", "));
  }

  void check() const override {
    for (const auto& part : parts()) try {
        part.system->check();
      } catch (const Error& error) {
        throw InputError(fault_of_part(part.name, error));
      }
    const auto train = rough_train(scene(), parts());
    try {
      (void)dynamics::lumped_case(train);
    } catch (const InputError& error) {
      const std::string message = error.what();
      throw InputError((message.starts_with("rotor") ? "rotor.on: " : "shaft.name: ") + message);
    }
  }

  [[nodiscard]] std::vector<MeshModel> meshes() const override {
    std::vector<MeshModel> list;
    for (const auto& part : parts())
      for (auto& mesh : part.system->model_meshes()) list.push_back(of_train(part, std::move(mesh)));
    return list;
  }

  /// Every mesh has its own: those of the parts are compared with the tables by their loads.
  [[nodiscard]] double mean_mesh_force() const override { return not_known; }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    for (const auto& part : parts())
      for (const auto& own : part.system->model_meshes()) {
        if (of_train(part, own).title != mesh.title) continue;
        auto original = mesh;
        original.title = own.title;
        original.variant = own.variant;
        auto inside = options;
        inside.out /= part.name;
        auto result = part.system->stiffness(original, inside);
        result.model = mesh;
        return result;
      }
    throw InternalError("internal error: no part has the mesh '" + mesh.title + "'");
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t /*variant*/,
                                                   const std::vector<const MeshResult*>& tables) const override {
    return train_model(scene(), parts(), tables);
  }

  [[nodiscard]] std::vector<PlannedResponse> responses() const override { return train_responses(scene(), parts()); }

  [[nodiscard]] std::string coordinates() const override {
    std::string text;
    for (const auto& part : parts()) text += (text.empty() ? "" : "; ") + part.name + ": " + part.system->coordinates();
    return text;
  }

  [[nodiscard]] std::optional<dynamics::LumpedCase> rough_lumped() const override {
    return dynamics::lumped_case(rough_train(scene(), parts()));
  }

  [[nodiscard]] bool offers(SweepDirection direction) const override {
    return std::all_of(parts().begin(), parts().end(),
                       [&](const auto& part) { return part.system->offers(direction); });
  }

  /// Its own shafts are results too.
  [[nodiscard]] std::string table_for(const std::string& /*result*/) const override { return {}; }

  [[nodiscard]] FigureSet table_figures(std::size_t /*variant*/,
                                        const std::vector<const MeshResult*>& /*tables*/) const override {
    return {};
  }

  [[nodiscard]] std::vector<Warning> scene_warnings() const override {
    std::vector<Warning> list;
    for (const auto& part : parts()) {
      auto warnings = part.system->plan(1).warnings;
      // What the train says of all inputs and meshes of its parts, and the samples that each of them would draw alone.
      std::erase_if(warnings, [](const Warning& warning) {
        return warning.key == "assumed_inputs" || warning.key == "accuracy_not_expected" ||
               warning.key == "unstated_phases";
      });
      warn_of_arbitrary_phases(warnings, part.system->scene(), "state the phases: a train draws no samples of them");
      for (auto& warning : warnings) {
        warning.where = part.name + (warning.where.empty() ? "" : ", " + warning.where);
        list.push_back(std::move(warning));
      }
    }
    return list;
  }

  [[nodiscard]] std::unique_ptr<RunResponse> respond(const SystemRun& run, std::size_t variant,
                                                     const RunOptions& options) const override {
    return train_response(scene(), parts(), run.tables_of(variant), options);
  }

  [[nodiscard]] std::vector<Warning> response_warnings(const SystemRun& run, std::size_t variant) const override {
    std::vector<Warning> list;
    const auto add = [&](std::vector<Warning> more) { std::move(more.begin(), more.end(), std::back_inserter(list)); };
    const auto tables = tables_of_parts(parts(), run.tables_of(variant));
    const auto& space = static_cast<const TrainRunResponse&>(*run.responses.at(variant)).motion.space;
    for (std::size_t i = 0; i < parts().size(); ++i) {
      if (space[i].bearings.empty()) continue;
      const auto& name = parts()[i].name;
      add(space_result_warnings(space[i], scene().accuracy, name, ""));
      std::vector<std::pair<std::string, const MeshResult*>> meshes;
      for (const auto* table : tables[i]) meshes.emplace_back(table->model.label(), table);
      add(face_warnings(meshes, name));
    }
    return list;
  }

  [[nodiscard]] Json summary(const SystemRun& run) const override { return train_summary(run, parts()); }
  [[nodiscard]] Page report(const SystemRun& run) const override { return train_report(run, parts()); }

 protected:
  void describe(Plan& plan) const override {
    plan.inputs = resolved_inputs(scene(), {});
    for (const auto& part : parts()) {
      auto of_part = part.system->plan(1);
      for (auto& input : of_part.inputs) {
        input.key = part.name + ": " + input.key;
        plan.inputs.push_back(std::move(input));
      }
      for (const auto& body : part.system->turning_bodies()) {
        const auto name = part.name + "_" + body.name;
        const auto words = fmt::format("{} of part '{}'", body.name, part.name);
        plan.quantities.push_back(quantity(name + "_speed_rpm", std::abs(body.speed), "speed, " + words));
        plan.quantities.push_back(quantity(name + "_torque_Nm", std::abs(body.torque), "torque, " + words));
      }
      for (auto& dof : of_part.dofs) {
        dof.name = part.name + ": " + dof.name;
        plan.dofs.push_back(std::move(dof));
      }
    }
    plan.remarks.emplace_back(
        "The parts act on each other through the rotations of their bodies alone. Each keeps its own supports.");
  }

 private:
  [[nodiscard]] const std::vector<WorkingPart>& parts() const {
    std::call_once(made_, [this] { parts_ = working_parts(scene()); });
    return parts_;
  }

  static MeshModel of_train(const WorkingPart& part, MeshModel mesh) {
    mesh.title = part.name + ": " + mesh.label();
    mesh.variant.clear();
    return mesh;
  }

  mutable std::once_flag made_;
  mutable std::vector<WorkingPart> parts_;
};

const std::vector<FigureSpec>& all_train_figures() {
  static const auto list = joined_figures({dynamics::train_figures(), dynamics::transient_figures()});
  return list;
}

}  // namespace

SystemKind train_kind() {
  return {{.name = "train",
           .tables = train_tables,
           .check = check_train_scene,
           .results = [] { return figure_keys(dynamics::train_figures()); },
           .example = "",
           .gears = false},
          all_train_figures,
          dynamics::train_figures,
          [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<TrainSystem>(scene); }};
}

}  // namespace annulus::app
