#include "app/tradeoff/tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/content_id.h"
#include "app/tradeoff/trade_subject.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "fem/problem/plane_strain_error.h"

namespace annulus::app {

namespace {

using Json = nlohmann::json;
Json to_json(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
double number(const Json& json) { return json.is_null() ? not_known : json.get<double>(); }

std::string figures_text(const Figures& figures) {
  Json json = Json::array();
  for (const auto& f : figures) json.push_back({to_json(f.value), to_json(f.error_relative)});
  return json.dump();
}

Figures parse_figures(const std::string& text) {
  Figures figures;
  for (const auto& f : Json::parse(text)) figures.push_back({number(f[0]), number(f[1])});
  return figures;
}

/// All settings of a ring in the plane share plane strain, also the one they are held against.
double common_error(const MeshResult& mesh) {
  const auto fidelity = mesh.model.settings.fidelity;
  return fidelity == fem::Fidelity::solid || fidelity == fem::Fidelity::resolved_solid
             ? 0
             : fem::plane_strain_error(*mesh.model.problem);
}

Estimate mean_stiffness(const MeshResult& mesh) {
  const auto mean = mesh.mean_stiffness();
  return {mean.value, mean.error_relative - common_error(mesh)};
}

/// The mean, with the largest error of any position: what the wanted accuracy is about.
Estimate stiffness_anywhere(const MeshResult& mesh) {
  return {mesh.mean_stiffness().value, mesh.worst_stiffness_error() - common_error(mesh)};
}

/// Figures of the meshes: means, entries, ranges of the transmission error, each for all meshes.
Figures mesh_figures(const std::vector<MeshResult>& tables) {
  Figures figures;
  for (const auto& mesh : tables) figures.push_back(mean_stiffness(mesh));
  for (const auto& mesh : tables) figures.push_back(stiffness_anywhere(mesh));
  for (const auto& mesh : tables) figures.push_back(mesh.lte_peak_to_peak());
  return figures;
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

/// Of any entry to the curve held against.
double largest_difference(const StiffnessCycle& cycle, const StiffnessCycle& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < cycle.entries.size(); ++i)
    largest = std::max(largest, std::abs(cycle.entries[i] / truth.curve(static_cast<double>(i) / cycle.phases) - 1));
  return largest;
}

/// Measured work whose answer is kept in a file, with the identity of what it depends on.
MeasuredWork kept_work(const std::filesystem::path& file, const std::string& id,
                       const std::function<std::string()>& work) {
  if (std::ifstream in(file); in) {
    try {
      const Json json = Json::parse(in);
      if (json.at("inputs_id") == id)
        return {{json.at("wall_s"), json.at("processor_s"), json.at("peak_MB")}, json.at("answer"), json.at("failure")};
    } catch (const std::exception&) {
      // Damaged: measured again.
    }
  }
  auto done = measured(work);
  std::filesystem::create_directories(file.parent_path());
  write_file(file, Json{{"inputs_id", id},
                        {"wall_s", done.cost.wall},
                        {"processor_s", done.cost.processor},
                        {"peak_MB", done.cost.peak_memory_MB},
                        {"answer", done.answer},
                        {"failure", done.failure}}
                       .dump(1));
  return done;
}

/// "marching BDF, relative tolerance 1e-04" as the name of a file.
std::string plain_name(std::string name) {
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

class Measurement {
 public:
  Measurement(const TradeSubject& subject, StageKind kind, const RunOptions& options, const TradeLists& lists)
      : subject_(subject), kind_(kind), options_(options), lists_(lists), meshes_(subject.meshes()) {}

  VariantTrade run() {
    VariantTrade trade{.name = subject_.name(), .points = {}};
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
    inside.tables.reset();
    return inside;
  }

  /// Solved in a process of its own, read back here.
  std::optional<MeshResult> table(const MeshModel& model, const std::filesystem::path& folder,
                                  TradePoint& point) const {
    const auto done = kept_work(folder / "cost.json", model.id(), [&] {
      (void)computed_stiffness(model, {""}, options_in(folder));
      return std::string("solved");
    });
    point.cost.wall += done.cost.wall;
    point.cost.processor += done.cost.processor;
    point.cost.peak_memory_MB = std::max(point.cost.peak_memory_MB, done.cost.peak_memory_MB);
    if (!done.failure.empty()) {
      point.failure = model.label() + ": " + done.failure;
      return std::nullopt;
    }
    auto result = load(model, folder);
    if (!result) point.failure = model.label() + ": its table was taken away";
    return result;
  }

  TradePoint mesh_point(const MeshSetting& setting) {
    TradePoint point{.kind = kind_,
                     .fidelity = fidelity_name(setting.fidelity),
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
    TradePoint point{.kind = kind_,
                     .fidelity = "planned",
                     .settings = fmt::format("for {:g} %", 100 * accuracy),
                     .planned_for = accuracy};
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
    Figures figures = mesh_figures(tables);
    if (subject_.has_motion()) {
      try {
        const auto motion = subject_.motion_on(tables);
        const auto done = kept_figures(root() / subject_.name() / name / "figures.json", motion);
        point.response = done.cost;
        if (!done.failure.empty()) throw SolverError(done.failure);
        const auto found = parse_figures(done.answer);
        figures.insert(figures.end(), found.begin(), found.end());
      } catch (const Error& error) {
        point.failure = error.what();
      }
    }
    figures.resize(trade_figures(kind_).size() + 1, {not_known, not_known});
    set_values(point, figures);
    for (const auto& mesh : tables) point.cycles.push_back(stiffness_cycle(mesh));
    if (point.finest) finest_ = std::move(tables);
  }

  [[nodiscard]] static MeasuredWork kept_figures(const std::filesystem::path& file, const TradeMotion& motion) {
    return kept_work(file, motion.id, [&] { return figures_text(motion.figures()); });
  }

  [[nodiscard]] TradePoint motion_point(TradeMotion motion) const {
    TradePoint point{.kind = kind_,
                     .part = TradePart::dynamics,
                     .fidelity = motion.fidelity,
                     .settings = motion.settings,
                     .finest = motion.finest,
                     .changes_model = motion.changes_model};
    motion.id = ContentId().add("response", motion.id).add("how", motion.fidelity + motion.settings).id();
    const auto name = plain_name(motion.fidelity + " " + motion.settings);
    const auto done = kept_figures(root() / subject_.name() / "dynamics" / (name + ".json"), motion);
    point.cost = done.cost;
    point.failure = done.failure;
    if (!done.failure.empty()) return point;
    const auto found = parse_figures(done.answer);
    Figures figures(trade_figures(kind_).size() + 1 - found.size(), {not_known, not_known});  // those of the meshes
    figures.insert(figures.end(), found.begin(), found.end());
    set_values(point, figures);
    return point;
  }

  static void set_values(TradePoint& point, const Figures& figures) {
    const std::size_t count = trade_figures(point.kind).size();
    for (std::size_t i = 0; i < count; ++i)
      point.values.push_back({figures[i].value, not_known, figures[i].error_relative});
    if (std::isfinite(figures[count].value)) point.contact_loss = figures[count].value;
  }

  static void compare(std::vector<TradePoint>& points, TradePart part) {
    const auto finest =
        std::find_if(points.begin(), points.end(), [part](const TradePoint& p) { return p.part == part && p.finest; });
    if (finest == points.end() || finest->values.empty()) return;
    for (auto& point : points) {
      if (point.part != part) continue;
      for (std::size_t i = 0; i < point.values.size(); ++i) {
        auto& value = point.values[i];
        value.error = std::abs(value.value / finest->values[i].value - 1);
        const auto mesh = trade_figures(point.kind)[i].entries_of;
        if (part == TradePart::mesh && mesh)
          value.error = largest_difference(point.cycles.at(*mesh), finest->cycles.at(*mesh));
      }
    }
  }

  const TradeSubject& subject_;
  StageKind kind_;
  const RunOptions& options_;
  const TradeLists& lists_;
  std::vector<TradeMesh> meshes_;
  std::optional<std::vector<MeshResult>> finest_;
};

}  // namespace

std::optional<std::size_t> TradePoint::worst_figure() const {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i].error) && (!worst || values[i].error > values[*worst].error)) worst = i;
  }
  return worst;
}

double TradePoint::error(std::optional<std::size_t> figure) const {
  if (!figure) figure = worst_figure();
  return failure.empty() && figure && *figure < values.size() ? values[*figure].error : not_known;
}

double TradePoint::stiffness_estimate() const {
  double largest = not_known;
  for (std::size_t i = 0; failure.empty() && i < values.size(); ++i)
    if (trade_figures(kind)[i].entries_of)
      largest = std::isnan(largest) ? values[i].error_estimate : std::max(largest, values[i].error_estimate);
  return largest;
}

double TradePoint::promised_error() const {
  double largest = failure.empty() && !values.empty() ? 0 : not_known;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& figure = trade_figures(kind)[i];
    if (!figure.promised || (figure.while_teeth_touch && contact_loss > 0)) continue;
    if (std::isfinite(values[i].error)) largest = std::max(largest, values[i].error);
  }
  return largest;
}

const TradePoint* VariantTrade::planned(double accuracy) const {
  for (const auto& p : points)
    if (p.planned_for == accuracy) return &p;
  return nullptr;
}

const TradePoint* VariantTrade::cheapest(TradePart part, double accuracy, std::optional<std::size_t> figure) const {
  const TradePoint* best = nullptr;
  for (const auto& p : points) {
    if (p.part != part || p.finest || p.planned_for || !(p.error(figure) <= accuracy)) continue;
    if (!best || p.cost.wall < best->cost.wall) best = &p;
  }
  return best;
}

std::vector<const TradePoint*> VariantTrade::front(TradePart part, std::optional<std::size_t> figure) const {
  std::vector<const TradePoint*> list;
  for (const auto& p : points) {
    if (p.part == part && !p.finest && !p.planned_for && std::isfinite(p.error(figure))) list.push_back(&p);
  }
  std::stable_sort(list.begin(), list.end(), [](const auto* a, const auto* b) { return a->cost.wall < b->cost.wall; });
  double best = std::numeric_limits<double>::infinity();
  std::erase_if(list, [&](const TradePoint* p) {
    if (p->error(figure) >= best) return true;
    best = p->error(figure);
    return false;
  });
  return list;
}

TradeOff measure_tradeoff(const Scene& scene, const RunOptions& options, const TradeLists& lists) {
  TradeOff trade{.scene = scene, .variants = {}, .total_seconds = 0};
  const auto subjects = trade_subjects(scene);
  for (const auto& subject : subjects)
    if (subject->meshes().empty() && !subject->has_motion())
      throw InputError(fmt::format("{}: '{}' has a given stiffness and no [dynamics]: there is nothing to trade",
                                   scene.file.string(), subject->name()));
  for (const auto& subject : subjects)
    trade.variants.push_back(Measurement(*subject, scene.stage.kind, options, lists).run());
  for (const auto& variant : trade.variants) {
    for (const auto& p : variant.points) trade.total_seconds += p.cost.wall;
  }
  return trade;
}

}  // namespace annulus::app
