#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/model/run_options.h"
#include "app/process/measured_work.h"
#include "app/tradeoff/trade_settings.h"
#include "core/figure.h"
#include "core/stiffness_table.h"

/// Every model and setting measured: what it costs and how wrong it is (`annulus tradeoff`).
namespace annulus::app {

struct MeshResult;

/// A result that the cost study measures.
struct TradeFigure {
  std::string key, title;
  Guarantee guarantee = Guarantee::none;
  std::optional<std::size_t> entries_of{};  ///< it stands for every entry of the table of that mesh
};
/// Mean, entries and transmission error of these meshes; then the results of the lumped model.
[[nodiscard]] std::vector<TradeFigure> trade_figures(const std::vector<MeshModel>& meshes,
                                                     const std::vector<FigureSpec>& model);

/// Results of one mesh: the mean, with its own error; the mean again with the largest error of any position, which the
/// wanted accuracy is about; the transmission error. What all settings leave out is not counted.
[[nodiscard]] FigureSet trade_figures(const MeshResult& mesh);

/// A figure as one setting gives it.
struct TradeValue {
  std::string key;
  double value = 0;           ///< NaN: the setting does not give it
  double error = 0;           ///< true relative error: against the finest setting of its part
  double error_estimate = 0;  ///< what the program says of itself, relative; NaN: nothing
};

/// Secant stiffness along all mesh cycles.
struct StiffnessCycle {
  std::vector<double> entries;  ///< N/m, as tabulated
  PeriodicCurve curve;          ///< through them
  int phases = 0;               ///< entries per mesh cycle
};

[[nodiscard]] StiffnessCycle stiffness_cycle(const MeshResult& mesh);

/// One setting of a ring, a pair or a reducer.
struct TradePoint {
  TradePart part = TradePart::mesh;
  std::string fidelity;  ///< "plane"; of the dynamics: how the motion is found, "time integration"
  std::string settings;  ///< "degree 2, level 1, 32 phases, 5 loads"
  bool finest = false;   ///< the others are compared with it
  bool changes_model = false;
  std::optional<MeshSetting> mesh{};    ///< of a fixed setting of the meshes
  std::optional<double> planned_for{};  ///< the wanted accuracy for which the planner chose it; absent: a fixed setting
  Cost cost{};            ///< meshes: of all tables, the memory of the largest one; dynamics: of the response
  std::string failure{};  ///< why there are no figures
  std::vector<TradeValue> values{};  ///< those that it gives
  double contact_loss = 0;           ///< largest fraction of the time that a mesh spends without contact
  /// Secant stiffness at the nominal load of every mesh; empty for the dynamics.
  std::vector<StiffnessCycle> cycles{};

  /// nullptr: it does not give it.
  [[nodiscard]] const TradeValue* find(const std::string& key) const;
  /// The error of one result; without a key, the largest over all that both settings give. NaN for a failure.
  [[nodiscard]] double error(const std::string& key = {}) const;
  [[nodiscard]] const TradeValue* worst() const;  ///< nullptr: no error is known
};

/// A ring, a pair or a reducer.
struct VariantTrade {
  std::string name;
  std::vector<TradeFigure> figures;
  std::vector<TradePoint> points;  ///< those of the meshes, then those of the dynamics

  /// Sets the errors of a part.
  void compare_with_finest(TradePart part);

  [[nodiscard]] const TradeFigure& figure(const std::string& key) const;
  [[nodiscard]] const std::string& title(const std::string& key) const { return figure(key).title; }
  [[nodiscard]] std::vector<const TradePoint*> of(TradePart part) const;
  /// The largest error of the results that the wanted accuracy covers, and which one it is. NaN for a failure.
  [[nodiscard]] double guaranteed_error(const TradePoint& point) const;
  [[nodiscard]] const TradeValue* worst_guaranteed(const TradePoint& point) const;
  /// The results with a known error that the wanted accuracy does not cover.
  [[nodiscard]] std::vector<const TradeValue*> not_guaranteed(const TradePoint& point) const;
  /// What the program states of the stiffness: the largest estimate of the tables' entries. NaN for a failure.
  [[nodiscard]] double stiffness_estimate(const TradePoint& point) const;
  /// The cheapest fixed setting of a part by wall time whose error (of one result, or the largest) is within the
  /// accuracy; the finest itself does not count. nullptr: none.
  [[nodiscard]] const TradePoint* cheapest(TradePart part, double accuracy, const std::string& key = {}) const;
  /// What the planner chose for an accuracy. nullptr: it was not asked.
  [[nodiscard]] const TradePoint* planned(double accuracy) const;
  /// Fixed settings of the part no other beats in both wall time and that error, by rising time.
  [[nodiscard]] std::vector<const TradePoint*> front(TradePart part, const std::string& key = {}) const;
};

struct TradeOff {
  Scene scene;
  std::vector<VariantTrade> variants;
  double total_seconds = 0;  ///< wall time of all settings
};

/// What is tried.
struct TradeLists {
  std::vector<double> accuracies = {0.1, 0.03, 0.01, 0.003};  ///< for which the planner is asked
  std::function<std::vector<MeshSetting>(const MeshModel& planned, AlongFace face)> mesh = mesh_settings;
  bool motions = true;  ///< the ways to find the motion, too
};

/// Runs everything, each setting in a process of its own, one after the other with options.threads threads, below
/// OUT/tradeoff; what an earlier run measured there is taken over; what the planner chooses for several accuracies is
/// measured beside them. Where a stiffness is prescribed, the motion alone is traded. Throws InputError where there
/// is nothing to trade, and what making the geometry throws.
[[nodiscard]] TradeOff measure_tradeoff(const Scene& scene, const RunOptions& options, const TradeLists& lists = {});

}  // namespace annulus::app
