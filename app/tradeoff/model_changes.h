#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/model/lumped_model.h"
#include "app/tradeoff/trade_settings.h"

namespace annulus::app {

/// Degrees of freedom left out: stiffnesses of supports and bearings that become rigid. Offered where one is not.
template <class Model>
struct RigidChange {
  const char* settings;  ///< "sun held in place"
  std::vector<double*> (*stiffnesses)(Model& model);
};

/// The ways to one lumped model: its motion found otherwise, or itself changed.
template <class Model>
class WaysOf {
 public:
  using Options = dynamics::SimulationOptions;
  using Id = std::function<std::string(const Model&, const Options&)>;
  /// Throws SolverError where there is no periodic motion.
  using Figures = std::function<FigureSet(const Model&, const Options&)>;

  WaysOf(Model model, Options options, Id id, Figures figures)
      : model_(std::move(model)), options_(std::move(options)), id_(std::move(id)), figures_(std::move(figures)) {
    options_.integrator.method = dynamics::Integrator::automatic;
    options_.integrator.fixed_step = 0;
  }

  void add(const std::vector<MotionSetting>& settings) {
    for (const auto& setting : settings) {
      auto options = options_;
      setting.apply(options);
      add(setting.fidelity, setting.settings, model_, options).finest = setting.finest;
    }
  }

  void add(const std::vector<RigidChange<Model>>& changes) {
    for (const auto& change : changes) {
      auto changed = model_;
      const auto stiffnesses = change.stiffnesses(changed);
      if (std::none_of(stiffnesses.begin(), stiffnesses.end(), [](const double* k) { return std::isfinite(*k); }))
        continue;
      for (double* stiffness : stiffnesses) *stiffness = dynamics::rigid;
      add_changed("fewer degrees of freedom", change.settings, changed);
    }
  }

  /// By harmonic balance with so many samples per mesh cycle.
  void add_changed(const std::string& fidelity, const std::string& settings, const Model& changed,
                   int samples = finest_samples) {
    auto options = options_;
    options.confirmation = dynamics::Confirmation::never;
    options.sampling = dynamics::Sampling::prescribed;
    options.samples_per_cycle = samples;
    add(fidelity, settings, changed, options).changes_model = true;
  }

  [[nodiscard]] std::vector<ModelWay> list() const { return list_; }

 private:
  ModelWay& add(const std::string& fidelity, const std::string& settings, const Model& model, const Options& options) {
    list_.push_back({.fidelity = fidelity,
                     .settings = settings,
                     .id = id_(model, options),
                     .figures = [figures = figures_, model, options] { return figures(model, options); }});
    return list_.back();
  }

  Model model_;
  Options options_;
  Id id_;
  Figures figures_;
  std::vector<ModelWay> list_;
};

}  // namespace annulus::app
