#include "app/systems/helical_pair/pair_lumped_model.h"

#include <utility>

#include "app/results/content_id.h"
#include "app/systems/helical_pair/pair_errors.h"
#include "dynamics/systems/helical_pair/pair_figures.h"

namespace annulus::app {

namespace {

/// How responses of studies are found; enters the identity of cached results.
constexpr const char* pair_point_method = "harmonic balance, time integration where contact is lost; 1";

class PairLumpedModel final : public LumpedModel {
 public:
  PairLumpedModel(dynamics::HelicalPair pair, dynamics::SimulationOptions simulation,
                  std::optional<StiffnessTable> table)
      : pair_(std::move(pair)), simulation_(std::move(simulation)), table_(std::move(table)) {}

  [[nodiscard]] std::string id() const override {
    return ContentId()
        .add("response", pair_id(pair_, simulation_, table_ ? &*table_ : nullptr))
        .add("method", pair_point_method)
        .id();
  }

  [[nodiscard]] StudyPoint answer(Answer wanted) const override {
    auto figures = dynamics::figures(dynamics::evaluate_pair(pair_, simulation_));
    if (wanted == Answer::all) figures.add(dynamics::frequency_figures(pair_));
    return {.figures = {dynamics::pair_figures(), figures}};
  }

 private:
  dynamics::HelicalPair pair_;
  dynamics::SimulationOptions simulation_;
  std::optional<StiffnessTable> table_;
};

}  // namespace

std::unique_ptr<LumpedModel> pair_lumped_model(const Scene& scene, const PairGeometry& geometry, const PairMesh& mesh) {
  auto pair = make_pair(scene, geometry, pair_excitation(scene, geometry, mesh), pair_errors(scene).amplitude);
  auto simulation = pair_simulation(scene);
  simulation.confirm = false;
  simulation.keep_series = false;
  return std::make_unique<PairLumpedModel>(std::move(pair), std::move(simulation), mesh.table);
}

}  // namespace annulus::app
