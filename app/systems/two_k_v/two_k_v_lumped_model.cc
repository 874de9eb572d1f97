#include "app/systems/two_k_v/two_k_v_lumped_model.h"

#include <utility>

#include "app/results/content_id.h"
#include "app/systems/two_k_v/two_k_v_motion.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"

namespace annulus::app {

namespace {

class TwoKVLumpedModel final : public LumpedModel {
 public:
  TwoKVLumpedModel(TwoKVModels models, dynamics::SimulationOptions simulation, TwoKVTables tables)
      : models_(std::move(models)), simulation_(std::move(simulation)), tables_(std::move(tables)) {}

  [[nodiscard]] std::string id() const override {
    return ContentId().add("two_k_v", two_k_v_id(models_, simulation_, tables_)).id();
  }

  [[nodiscard]] StudyPoint answer(Answer wanted) const override {
    auto figures = dynamics::static_figures(models_.at_nominal, models_.arc_clearance);
    if (wanted == Answer::without_motion)
      figures.set("steady", 1);  // nothing was integrated
    else
      figures.add(dynamics::figures(models_.moving, dynamics::simulate(models_.moving, simulation_)));
    return {.figures = {dynamics::two_k_v_figures(), figures}};
  }

 private:
  TwoKVModels models_;
  dynamics::SimulationOptions simulation_;
  TwoKVTables tables_;
};

}  // namespace

std::unique_ptr<LumpedModel> two_k_v_lumped_model(const Scene& scene, TwoKVTables tables) {
  auto models = two_k_v_models(scene, tables);
  models.moving.check();
  auto simulation = two_k_v_simulation(scene, models.moving);
  simulation.keep_series = false;
  return std::make_unique<TwoKVLumpedModel>(std::move(models), std::move(simulation), std::move(tables));
}

}  // namespace annulus::app
