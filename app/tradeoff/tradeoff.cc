#include "app/tradeoff/tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/model/gear_system.h"
#include "app/model/trade_subject.h"
#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"
#include "core/log.h"
#include "core/result_store.h"
#include "fem/problem/plane_strain_error.h"

namespace annulus {

ANNULUS_MEMBERS(app::Cost, wall, processor, peak_memory_MB);
ANNULUS_MEMBERS(app::MeasuredWork, cost, answer, failure);

}  // namespace annulus

namespace annulus::app {

namespace {

std::string mean_key(const std::string& mesh) { return mesh + "_mean_stiffness_N_per_m"; }
std::string entries_key(const std::string& mesh) { return mesh + "_stiffness_entries_N_per_m"; }
std::string lte_key(const std::string& mesh) { return mesh + "_lte_peak_to_peak_m"; }

/// All settings of a ring in the plane share plane strain, also the one they are compared with.
double common_error(const MeshResult& mesh) {
  return fem::is_solid(mesh.model.settings.fidelity) ? 0 : fem::plane_strain_error(*mesh.model.problem);
}

Figure absolute(double value, double relative) { return {value, std::abs(value) * relative}; }

/// Results of one mesh: the mean, with its own error; the mean again with the largest error of any position, which the
/// wanted accuracy is about; the transmission error. What all settings leave out is not counted.
FigureSet figures_of_mesh(const MeshResult& mesh) {
  const auto mean = mesh.mean_stiffness(), lte = mesh.lte_peak_to_peak();
  const double common = common_error(mesh);
  FigureSet set;
  set.set(mean_key(mesh.model.mesh), absolute(mean.value, mean.error_relative - common));
  set.set(entries_key(mesh.model.mesh), absolute(mean.value, mesh.worst_stiffness_error() - common));
  set.set(lte_key(mesh.model.mesh), absolute(lte.value, lte.error_relative));
  return set;
}

StiffnessCycle stiffness_cycle(const MeshResult& mesh) {
  const auto& table = mesh.table;
  StiffnessCycle cycle{.entries = {},
                       .curve = curves_at_load(table, table.loads()[mesh.nominal]).stiffness_secant,
                       .phases = table.phases()};
  for (int position = 0; position < table.positions(); ++position) {
    for (int phase = 0; phase < table.phases(); ++phase)
      cycle.entries.push_back(table.at(position, phase, static_cast<int>(mesh.nominal)).stiffness_secant);
  }
  return cycle;
}

/// Of any entry to the reference curve.
double largest_difference(const StiffnessCycle& cycle, const StiffnessCycle& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < cycle.entries.size(); ++i)
    largest = std::max(largest, std::abs(cycle.entries[i] / truth.curve(static_cast<double>(i) / cycle.phases) - 1));
  return largest;
}

constexpr const char *measured_meshes = "measured_meshes", *measured_responses = "measured_responses";

/// The results of a motion and what they cost: from the cache, else measured.
MeasuredWork measured_figures(const TradeMotion& motion, const ResultStore* store) {
  return cached_value(store, measured_responses, motion.id,
                      [&] { return measured([&] { return to_json(motion.figures()).dump(); }); })
      .value;
}

class Measurement {
 public:
  Measurement(const TradeSubject& subject, const std::vector<FigureSpec>& model, const RunOptions& options,
              const TradeLists& lists)
      : subject_(subject), options_(options), lists_(lists), meshes_(subject.meshes()) {
    std::vector<MeshModel> models;
    for (const auto& mesh : meshes_) models.push_back(mesh.planned);
    figures_ = trade_figures(models, model);
  }

  VariantTrade run() {
    VariantTrade trade{.name = subject_.name(), .figures = figures_, .points = {}};
    const auto tell = [&](const std::string& what) {
      log::info(fmt::format("tradeoff of '{}': {}", trade.name, what));
    };
    if (meshes_.empty()) {
      finest_ = subject_.tables_as_they_are(options_in(root() / trade.name / "tables"));
    } else {
      const bool solid = std::any_of(meshes_.begin(), meshes_.end(), [](const auto& m) { return m.needs_solid; });
      for (const auto& setting : lists_.mesh(meshes_.back().planned, solid)) {
        tell(fmt::format("{}, {}", fidelity_name(setting.fidelity), setting.text()));
        trade.points.push_back(mesh_point(setting));
      }
      for (const double accuracy : lists_.accuracies) {
        tell(fmt::format("as planned for {:g} %", 100 * accuracy));
        trade.points.push_back(planned_point(accuracy));
      }
      compare(trade.points, TradePart::mesh);
    }
    if (!lists_.motions || !subject_.has_motion() || !finest_) return trade;
    for (const auto& motion : subject_.motions(*finest_, options_, root() / trade.name)) {
      tell(motion.fidelity + ", " + motion.settings);
      trade.points.push_back(motion_point(motion));
    }
    compare(trade.points, TradePart::dynamics);
    return trade;
  }

 private:
  [[nodiscard]] std::filesystem::path root() const { return options_.out / "tradeoff"; }

  [[nodiscard]] RunOptions options_in(const std::filesystem::path& folder) const {
    RunOptions inside = options_;
    inside.out = folder;
    return inside;
  }

  /// Solved in a process of its own without anything cached, or with its cost from the cache; read back here.
  std::optional<MeshResult> table(const MeshModel& model, const std::filesystem::path& folder,
                                  TradePoint& point) const {
    const auto [done, reused] =
        cached_value(options_.store.get(), measured_meshes, identity_of(model.id(), model.mesh, model.ring), [&] {
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

  TradePoint mesh_point(const MeshSetting& setting) {
    TradePoint point{.fidelity = fidelity_name(setting.fidelity),
                     .settings = setting.text(),
                     .finest = setting.finest,
                     .mesh = setting};
    std::vector<MeshModel> models;
    for (const auto& mesh : meshes_) models.push_back(setting.applied(mesh.planned, mesh.needs_solid));
    measure(models, setting.folder(), point);
    return point;
  }

  /// As a run with this wanted accuracy solves it.
  TradePoint planned_point(double accuracy) {
    TradePoint point{
        .fidelity = "planned", .settings = fmt::format("for {:g} %", 100 * accuracy), .planned_for = accuracy};
    try {
      measure(subject_.planned(accuracy), fmt::format("planned_{:g}", accuracy), point);
    } catch (const InputError& error) {
      point.failure = error.what();
    }
    return point;
  }

  /// Solves all meshes and fills the point.
  void measure(const std::vector<MeshModel>& models, const std::string& name, TradePoint& point) {
    std::vector<MeshResult> tables;
    for (std::size_t i = 0; i < models.size(); ++i)
      if (auto solved = table(models[i], root() / meshes_[i].folder / name, point))
        tables.push_back(std::move(*solved));
    if (tables.size() < models.size()) return;
    FigureSet figures;
    for (const auto& mesh : tables) figures.add(figures_of_mesh(mesh));
    if (subject_.has_motion()) {
      try {
        const auto motion = subject_.motion_on(tables);
        const auto done = measured_figures(motion, options_.store.get());
        point.response = done.cost;
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

  [[nodiscard]] TradePoint motion_point(TradeMotion motion) const {
    TradePoint point{.part = TradePart::dynamics,
                     .fidelity = motion.fidelity,
                     .settings = motion.settings,
                     .finest = motion.finest,
                     .changes_model = motion.changes_model};
    motion.id = ContentId().add("response", motion.id).add("how", motion.fidelity + motion.settings).id();
    const auto done = measured_figures(motion, options_.store.get());
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

  void compare(std::vector<TradePoint>& points, TradePart part) const {
    const auto finest =
        std::find_if(points.begin(), points.end(), [part](const TradePoint& p) { return p.part == part && p.finest; });
    if (finest == points.end() || finest->values.empty()) return;
    for (auto& point : points) {
      if (point.part != part) continue;
      for (auto& value : point.values) {
        const auto* truth = finest->find(value.key);
        if (truth) value.error = std::abs(value.value / truth->value - 1);
        const auto figure =
            std::find_if(figures_.begin(), figures_.end(), [&](const TradeFigure& f) { return f.key == value.key; });
        if (part == TradePart::mesh && figure->entries_of)
          value.error =
              largest_difference(point.cycles.at(*figure->entries_of), finest->cycles.at(*figure->entries_of));
      }
    }
  }

  const TradeSubject& subject_;
  const RunOptions& options_;
  const TradeLists& lists_;
  std::vector<TradeMesh> meshes_;
  std::vector<TradeFigure> figures_;
  std::optional<std::vector<MeshResult>> finest_;
};

}  // namespace

std::vector<TradeFigure> trade_figures(const std::vector<MeshModel>& meshes, const std::vector<FigureSpec>& model) {
  std::vector<TradeFigure> list;
  const auto name = [](const MeshModel& mesh) { return "the " + mesh.label(); };
  for (const auto& mesh : meshes)
    list.push_back({mean_key(mesh.mesh), "mean stiffness of " + name(mesh), Guarantee::always});
  for (std::size_t i = 0; i < meshes.size(); ++i)
    list.push_back({entries_key(meshes[i].mesh), "stiffness of " + name(meshes[i]) + ", every entry of its table",
                    Guarantee::always, i});
  // A range of the transmission error is a small difference of large values: it carries an error of its own.
  for (const auto& mesh : meshes)
    list.push_back({lte_key(mesh.mesh), "transmission error of " + name(mesh) + ", peak to peak", Guarantee::none});
  for (const auto& spec : model)
    if (spec.cost_study) list.push_back({spec.key, spec.title, spec.guarantee});
  return list;
}

const TradeValue* TradePoint::find(const std::string& key) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const TradeValue& v) { return v.key == key; });
  return found == values.end() ? nullptr : &*found;
}

const TradeValue* TradePoint::worst() const {
  const TradeValue* worst = nullptr;
  for (const auto& value : values)
    if (std::isfinite(value.error) && (!worst || value.error > worst->error)) worst = &value;
  return worst;
}

double TradePoint::error(const std::string& key) const {
  const auto* value = key.empty() ? worst() : find(key);
  return failure.empty() && value ? value->error : not_known;
}

const std::string& VariantTrade::title(const std::string& key) const {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const TradeFigure& f) { return f.key == key; });
  require(found != figures.end(), "a result of the cost study that is not declared");
  return found->title;
}

const TradeValue* VariantTrade::worst_guaranteed(const TradePoint& point) const {
  const TradeValue* worst = nullptr;
  for (const auto& figure : figures) {
    const bool covered = figure.guarantee == Guarantee::always ||
                         (figure.guarantee == Guarantee::while_in_contact && !(point.contact_loss > 0));
    const auto* value = point.find(figure.key);
    if (covered && value && std::isfinite(value->error) && (!worst || value->error > worst->error)) worst = value;
  }
  return worst;
}

double VariantTrade::guaranteed_error(const TradePoint& point) const {
  if (!point.failure.empty() || point.values.empty()) return not_known;
  const auto* worst = worst_guaranteed(point);
  return worst ? worst->error : 0;
}

double VariantTrade::stiffness_estimate(const TradePoint& point) const {
  double largest = not_known;
  if (!point.failure.empty()) return largest;
  for (const auto& figure : figures) {
    const auto* value = figure.entries_of ? point.find(figure.key) : nullptr;
    if (value) largest = std::isnan(largest) ? value->error_estimate : std::max(largest, value->error_estimate);
  }
  return largest;
}

const TradePoint* VariantTrade::planned(double accuracy) const {
  for (const auto& p : points)
    if (p.planned_for == accuracy) return &p;
  return nullptr;
}

const TradePoint* VariantTrade::cheapest(TradePart part, double accuracy, const std::string& key) const {
  const TradePoint* best = nullptr;
  for (const auto& p : points) {
    if (p.part != part || p.finest || p.planned_for || !(p.error(key) <= accuracy)) continue;
    if (!best || p.cost.wall < best->cost.wall) best = &p;
  }
  return best;
}

std::vector<const TradePoint*> VariantTrade::front(TradePart part, const std::string& key) const {
  std::vector<const TradePoint*> list;
  for (const auto& p : points) {
    if (p.part == part && !p.finest && !p.planned_for && std::isfinite(p.error(key))) list.push_back(&p);
  }
  std::stable_sort(list.begin(), list.end(), [](const auto* a, const auto* b) { return a->cost.wall < b->cost.wall; });
  double best = std::numeric_limits<double>::infinity();
  std::erase_if(list, [&](const TradePoint* p) {
    if (p->error(key) >= best) return true;
    best = p->error(key);
    return false;
  });
  return list;
}

TradeOff measure_tradeoff(const Scene& scene, const RunOptions& given, const TradeLists& lists) {
  const auto options = with_reuse(given);
  TradeOff trade{.scene = scene, .variants = {}, .total_seconds = 0};
  const auto subjects = make_system(scene)->trades();
  if (subjects.empty())
    throw InputError(
        fmt::format("{}: a stage of kind \"{}\" has no cost study", scene.file.string(), scene.stage.kind));
  for (const auto& subject : subjects)
    if (subject->meshes().empty() && !subject->has_motion())
      throw InputError(fmt::format("{}: '{}' has a given stiffness and no [dynamics]: there is nothing to trade",
                                   scene.file.string(), subject->name()));
  for (const auto& subject : subjects)
    trade.variants.push_back(
        Measurement(*subject, system_kind(scene.stage.kind).model_figures(), options, lists).run());
  for (const auto& variant : trade.variants) {
    for (const auto& p : variant.points) trade.total_seconds += p.cost.wall;
  }
  return trade;
}

}  // namespace annulus::app
