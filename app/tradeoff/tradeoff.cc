#include "app/tradeoff/tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "app/model/gear_system.h"
#include "app/model/table_errors.h"
#include "app/plan/cost_plan.h"
#include "app/process/progress.h"
#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/scene/overrides.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"
#include "core/log.h"
#include "core/result_store.h"
#include "core/stopwatch.h"

namespace annulus {

ANNULUS_MEMBERS(app::Cost, wall, processor, peak_memory_MB);
ANNULUS_MEMBERS(app::MeasuredWork, cost, answer, failure);

}  // namespace annulus

namespace annulus::app {

namespace {

constexpr const char *measured_meshes = "measured_meshes", *measured_responses = "measured_responses";

/// Results and what they cost: from the cache, else measured.
MeasuredWork measured_figures(const ModelWay& way, const ResultStore* store) {
  return cached_value(store, measured_responses, way.id,
                      [&] { return measured([&] { return to_json(way.figures()).dump(); }); })
      .value;
}

/// Made in a process of its own, so that this one starts no threads, then read back from the cache.
template <class Make>
auto made_apart(Make make) {
  const auto done = measured([&] {
    (void)make();
    return std::string("solved");
  });
  if (!done.failure.empty()) throw SolverError(done.failure);
  return make();
}

std::vector<MeshModel> meshes_of(const GearSystem& system, std::size_t variant) {
  const auto all = system.model_meshes();
  std::vector<MeshModel> list;
  for (const std::size_t i : system.meshes_of(variant)) list.push_back(all.at(i));
  return list;
}

/// Folder of the measurements of a mesh.
std::string folder_of(const MeshModel& mesh) { return mesh.variant.empty() ? mesh.mesh : mesh.variant; }

bool all_computed(const std::vector<MeshModel>& meshes) {
  return std::all_of(meshes.begin(), meshes.end(), [](const MeshModel& mesh) { return mesh.computed(); });
}

std::vector<const MeshResult*> pointers(const std::vector<MeshResult>& tables) {
  std::vector<const MeshResult*> list;
  list.reserve(tables.size());
  for (const auto& table : tables) list.push_back(&table);
  return list;
}

/// One setting to be measured.
struct TradeStep {
  std::string what;
  double predicted = 0;  ///< s; all zero where the cost is not known
  std::function<TradePoint()> measure;
};

/// Measures them one after the other. Before each it states the number of the step and, from what the steps before took
/// of their predictions, the time left.
std::vector<TradePoint> measured_one_by_one(const std::string& name, const std::vector<TradeStep>& steps) {
  std::vector<TradePoint> points;
  double total = 0, done = 0;
  for (const auto& step : steps) total += step.predicted;
  const auto share = [&](const TradeStep& step) {
    return total > 0 ? step.predicted / total : 1.0 / static_cast<double>(steps.size());
  };
  const Stopwatch stopwatch;
  for (const auto& step : steps) {
    const double left = time_left(done, stopwatch.seconds(), total);
    log::info(fmt::format("tradeoff of '{}': {} ({} of {}{})", name, step.what, points.size() + 1, steps.size(),
                          std::isfinite(left) ? ", about " + duration_text(left) + " left" : ""));
    points.push_back(step.measure());
    done += share(step);
  }
  return points;
}

/// Everything that is tried on one variant. Where a stiffness is prescribed, the motion alone.
class Measurement {
 public:
  Measurement(const GearSystem& system, std::size_t variant, const RunOptions& options, const TradeLists& lists)
      : system_(system),
        scene_(system.scene()),
        variant_(variant),
        options_(options),
        lists_(lists),
        meshes_(meshes_of(system, variant)) {
    const bool traded = all_computed(meshes_);
    figures_ =
        trade_figures(traded ? meshes_ : std::vector<MeshModel>{}, system_kind(scene_.stage.kind).model_figures());
  }

  VariantTrade run() {
    VariantTrade trade{.name = system_.title(variant_), .figures = figures_, .points = {}};
    if (!all_computed(meshes_)) {
      finest_ = tables_as_they_are(root() / trade.name / "tables");
    } else {
      trade.points = measured_one_by_one(trade.name, mesh_steps());
      trade.compare_with_finest(TradePart::mesh);
    }
    if (!lists_.motions || !scene_.dynamics || !finest_) return trade;
    couple(*finest_, root() / trade.name / "coupling");
    std::vector<TradeStep> steps;
    for (auto& way : system_.ways(variant_, pointers(*finest_)).others) {
      const auto what = way.fidelity + ", " + way.settings;
      steps.push_back({what, 0, [this, way = std::move(way)] { return motion_point(way); }});
    }
    auto motions = measured_one_by_one(trade.name, steps);
    std::move(motions.begin(), motions.end(), std::back_inserter(trade.points));
    trade.compare_with_finest(TradePart::dynamics);
    return trade;
  }

 private:
  [[nodiscard]] std::filesystem::path root() const { return options_.out / "tradeoff"; }

  [[nodiscard]] RunOptions options_in(const std::filesystem::path& folder) const {
    RunOptions inside = options_;
    inside.out = folder;
    return inside;
  }

  /// Of each mesh: where something changes, a scene without a model of its own takes a solid one.
  [[nodiscard]] std::vector<AlongFace> along_faces() const {
    Scene free = scene_;
    free.fidelity = Fidelity::automatic;
    std::vector<AlongFace> list;
    for (const auto& mesh : meshes_of(*make_system(free), variant_))
      list.push_back(fem::is_solid(mesh.settings.fidelity) ? AlongFace::varying : AlongFace::uniform);
    return list;
  }

  /// Prescribed, or solved as planned.
  [[nodiscard]] std::vector<MeshResult> tables_as_they_are(const std::filesystem::path& folder) const {
    std::vector<MeshResult> tables;
    for (const auto& mesh : meshes_) {
      const auto make = [&] { return system_.stiffness(mesh, options_in(folder)); };
      tables.push_back(mesh.computed() ? made_apart(make) : make());
    }
    return tables;
  }

  /// Adds how the meshes are coupled, as far as that is of concern.
  void couple(std::vector<MeshResult>& tables, const std::filesystem::path& folder) const {
    for (auto& table : tables) {
      table.coupling = nullptr;
      if (!system_.coupled(table.model)) continue;
      try {
        table.coupling = made_apart([&] { return system_.coupling(table, options_, folder); });
      } catch (const SolverError& error) {
        log::warn(std::string("the coupling of the planets is left out: ") + error.what());
      }
    }
  }

  /// The results of the lumped model on these tables as a run finds them.
  [[nodiscard]] ModelWay as_run(const std::vector<MeshResult>& tables) const {
    auto way = system_.ways(variant_, pointers(tables)).as_run;
    if (way.figures) return way;
    return {.id = system_.model(variant_, pointers(tables))->id(),
            .figures = [&] { return model_results(system_, variant_, pointers(tables)); }};
  }

  /// Solved in a process of its own without anything cached, or with its cost from the cache; read back here.
  std::optional<MeshResult> table(const MeshModel& model, const std::filesystem::path& folder,
                                  TradePoint& point) const {
    const auto [done, reused] =
        cached_value(options_.store.get(), measured_meshes, identity_of(model.id(), model.mesh, model.variant), [&] {
          auto afresh = options_;
          afresh.store = nullptr;
          return measured([&] { return to_bytes(solved_stiffness(model, folder, afresh)); });
        });
    point.cost.wall += done.cost.wall;
    point.cost.processor += done.cost.processor;
    point.cost.peak_memory_MB = std::max(point.cost.peak_memory_MB, done.cost.peak_memory_MB);
    if (!done.failure.empty()) {
      point.failure = model.label() + ": " + done.failure;
      return std::nullopt;
    }
    auto result = from_bytes<MeshResult>(done.answer);
    if (reused) save(result, folder);
    result.model = model;
    result.bodies.clear();
    return result;
  }

  /// s, of solving these meshes.
  [[nodiscard]] double predicted(const std::vector<MeshModel>& models) const {
    double seconds = 0;
    for (const auto& model : models)
      if (model.computed()) seconds += predicted_cost(mesh_size(model), options_.threads).seconds;
    return seconds;
  }

  [[nodiscard]] std::vector<MeshModel> applied(const MeshSetting& setting, const std::vector<AlongFace>& faces) const {
    std::vector<MeshModel> models;
    for (std::size_t i = 0; i < meshes_.size(); ++i) models.push_back(setting.applied(meshes_[i], faces[i]));
    return models;
  }

  [[nodiscard]] std::vector<TradeStep> mesh_steps() {
    const auto faces = along_faces();
    std::vector<TradeStep> steps;
    const bool varies = std::find(faces.begin(), faces.end(), AlongFace::varying) != faces.end();
    for (const auto& setting : lists_.mesh(meshes_.back(), varies ? AlongFace::varying : AlongFace::uniform))
      steps.push_back({fmt::format("{}, {}", fidelity_name(setting.fidelity), setting.text()),
                       predicted(applied(setting, faces)),
                       [this, setting, faces] { return mesh_point(setting, faces); }});
    for (const double accuracy : lists_.accuracies)
      steps.push_back({fmt::format("as planned for {:g} %", 100 * accuracy), predicted(meshes_),
                       [this, accuracy] { return planned_point(accuracy); }});
    return steps;
  }

  TradePoint mesh_point(const MeshSetting& setting, const std::vector<AlongFace>& faces) {
    TradePoint point{.fidelity = fidelity_name(setting.fidelity),
                     .settings = setting.text(),
                     .finest = setting.finest,
                     .mesh = setting};
    measure(applied(setting, faces), setting.folder(), point);
    return point;
  }

  /// As a run with this wanted accuracy solves it.
  TradePoint planned_point(double accuracy) {
    TradePoint point{
        .fidelity = "planned", .settings = fmt::format("for {:g} %", 100 * accuracy), .planned_for = accuracy};
    try {
      const Scene scene = with_accuracy(scene_, accuracy, "asked of the planner");
      measure(meshes_of(*make_system(scene), variant_), fmt::format("planned_{:g}", accuracy), point);
    } catch (const InputError& error) {
      point.failure = error.what();
    }
    return point;
  }

  /// Solves all meshes and fills the point.
  void measure(const std::vector<MeshModel>& models, const std::string& name, TradePoint& point) {
    std::vector<MeshResult> tables;
    for (std::size_t i = 0; i < models.size(); ++i)
      if (auto solved = table(models[i], root() / folder_of(models[i]) / name, point))
        tables.push_back(std::move(*solved));
    if (tables.size() < models.size()) return;
    FigureSet figures;
    for (const auto& mesh : tables) figures.add(trade_figures(mesh));
    if (scene_.dynamics) {
      try {
        const auto done = measured_figures(as_run(tables), options_.store.get());
        if (!done.failure.empty()) throw SolverError(done.failure);
        figures.add(figure_set_of(Json::parse(done.answer)));
      } catch (const Error& error) {
        point.failure = error.what();
      }
    }
    set_values(point, figures);
    for (const auto& mesh : tables) point.cycles.push_back(stiffness_cycle(mesh));
    if (point.finest) finest_ = std::move(tables);
  }

  [[nodiscard]] TradePoint motion_point(ModelWay way) const {
    TradePoint point{.part = TradePart::dynamics,
                     .fidelity = way.fidelity,
                     .settings = way.settings,
                     .finest = way.finest,
                     .changes_model = way.changes_model};
    way.id = ContentId().add("response", way.id).add("how", way.fidelity + way.settings).id();
    const auto done = measured_figures(way, options_.store.get());
    point.cost = done.cost;
    point.failure = done.failure;
    if (!done.failure.empty()) return point;
    set_values(point, figure_set_of(Json::parse(done.answer)));
    return point;
  }

  void set_values(TradePoint& point, const FigureSet& figures) const {
    for (const auto& figure : figures_) {
      const auto f = figures.figure(figure.key);
      if (std::isfinite(f.value)) point.values.push_back({figure.key, f.value, not_known, f.error / std::abs(f.value)});
    }
    // Of one kind of mesh or of several; the largest.
    for (const auto& entry : figures.entries())
      if (entry.key.ends_with("contact_loss")) point.contact_loss = std::max(point.contact_loss, entry.figure.value);
  }

  const GearSystem& system_;
  const Scene& scene_;
  std::size_t variant_;
  const RunOptions& options_;
  const TradeLists& lists_;
  std::vector<MeshModel> meshes_;
  std::vector<TradeFigure> figures_;
  std::optional<std::vector<MeshResult>> finest_;
};

}  // namespace

TradeOff measure_tradeoff(const Scene& scene, const RunOptions& given, const TradeLists& lists) {
  const auto options = with_reuse(given);
  TradeOff trade{.scene = scene, .variants = {}, .total_seconds = 0};
  const auto system = make_system(scene);
  const auto variants = system->variants().size();
  for (std::size_t variant = 0; variant < variants; ++variant)
    if (!scene.dynamics && !all_computed(meshes_of(*system, variant)))
      throw InputError(
          fmt::format("{}: '{}' has a prescribed stiffness and no [dynamics]: there are no settings to compare",
                      scene.file.string(), system->title(variant)));
  for (std::size_t variant = 0; variant < variants; ++variant) {
    trade.variants.push_back(Measurement(*system, variant, options, lists).run());
    if (trade.variants.back().points.empty())
      throw InputError(
          fmt::format("{}: '{}' has only one way to compute its results: there are no "
                      "settings to compare",
                      scene.file.string(), system->title(variant)));
  }
  for (const auto& variant : trade.variants) {
    for (const auto& p : variant.points) trade.total_seconds += p.cost.wall;
  }
  return trade;
}

}  // namespace annulus::app
