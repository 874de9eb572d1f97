#include "app/tradeoff/tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/content_id.h"
#include "app/scene/overrides.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "fem/error_estimate.h"

namespace annulus::app {

namespace {

using Json = nlohmann::json;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Value and relative estimate of every figure, in the order of trade_figures().
using Figures = std::vector<Estimate>;

Json to_json(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
double number(const Json& json) { return json.is_null() ? unknown : json.get<double>(); }

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

Estimate relative(const dynamics::Figure& f) { return {f.value, f.error / std::abs(f.value)}; }

dynamics::Figure largest_factor(const dynamics::MeshKindResult& kind) {
  dynamics::Figure largest{-1, 0};
  for (const auto& branch : kind.branches) {
    if (branch.dynamic_factor_max.value > largest.value) largest = branch.dynamic_factor_max;
  }
  return largest;
}

/// The figures of the motion, and after them the contact loss. `errors` of the tables, where frequencies are to carry
/// them.
void add_response(Figures& figures, const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response,
                  const std::optional<MeshStiffnessErrors>& errors) {
  figures.push_back(relative(response.sun_planet.load_sharing.averaged));
  figures.push_back(relative(response.sun_planet.load_sharing.instantaneous));
  figures.push_back(relative(largest_factor(response.sun_planet)));
  figures.push_back(relative(largest_factor(response.ring_planet)));
  constexpr double same = 1e-6;
  constexpr std::size_t wanted = 3;
  Figures frequencies;
  for (const auto& mode : stage_modes(stage, errors.value_or(MeshStiffnessErrors{})).list) {
    if (mode.frequency > 0 && (frequencies.empty() || mode.frequency > frequencies.back().value * (1 + same)))
      frequencies.push_back({mode.frequency, errors ? mode.frequency_error / mode.frequency : unknown});
  }
  frequencies.resize(wanted, {unknown, unknown});
  figures.insert(figures.end(), frequencies.begin(), frequencies.end());
  double loss = 0;
  for (const auto* kind : {&response.sun_planet, &response.ring_planet})
    for (const auto& branch : kind->branches) loss = std::max(loss, branch.contact_loss);
  figures.push_back({loss, unknown});
}

// Places in trade_figures().
constexpr std::size_t sun_entries = 2, ring_entries = 3;

/// All settings of a ring in the plane share plane strain, also the one they are held against.
double common_error(const MeshResult& mesh) {
  const auto rung = mesh.model.settings.rung;
  return rung == fem::Rung::solid || rung == fem::Rung::resolved_solid ? 0
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

class RingMeasurement {
 public:
  RingMeasurement(const Scene& scene, const GearGeometry& geometry, std::size_t ring, const RunOptions& options,
                  const Plan& plan, const TradeLists& lists)
      : scene_(scene),
        lists_(lists),
        geometry_(geometry),
        ring_(ring),
        options_(options),
        sun_(plan.meshes.front()),
        wheel_(plan.meshes.at(ring + 1)),
        sun_needs_solid_(!solid_reason(scene).empty()),
        wheel_needs_solid_(!solid_reason(scene, scene.rings.at(ring)).empty()) {}

  RingTrade run() {
    RingTrade trade{.ring = scene_.rings.at(ring_).name, .points = {}};
    for (const auto& setting : lists_.mesh(wheel_, sun_needs_solid_ || wheel_needs_solid_)) {
      log::info(fmt::format("tradeoff of '{}': {}, {}", trade.ring, rung_name(setting.rung), setting.text()));
      trade.points.push_back(mesh_point(setting));
    }
    for (const double accuracy : lists_.accuracies) {
      log::info(fmt::format("tradeoff of '{}': as planned for {:g} %", trade.ring, 100 * accuracy));
      trade.points.push_back(planned_point(accuracy));
    }
    compare(trade.points, TradePart::mesh);
    if (!scene_.dynamics || !finest_sun_ || !finest_wheel_) return trade;
    prepare_coupling();
    auto stage = make_stage(scene_, geometry_, ring_, *finest_sun_, *finest_wheel_);
    stage.ring_coupling = static_coupling_;
    for (const auto& setting : lists_.dynamics(stage, elastic_coupling_)) {
      log::info(fmt::format("tradeoff of '{}': {}, {}", trade.ring, setting.rung, setting.settings));
      trade.points.push_back(dynamics_point(stage, setting));
    }
    compare(trade.points, TradePart::dynamics);
    return trade;
  }

 private:
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
    TradePoint point{
        .rung = rung_name(setting.rung), .settings = setting.text(), .finest = setting.finest, .mesh = setting};
    measure(setting.applied(sun_, sun_needs_solid_), setting.applied(wheel_, wheel_needs_solid_), setting.folder(),
            point);
    return point;
  }

  /// As a run with this wanted accuracy solves it.
  TradePoint planned_point(double accuracy) {
    TradePoint point{.rung = "planned", .settings = fmt::format("for {:g} %", 100 * accuracy), .planned_for = accuracy};
    try {
      const Scene scene = with_accuracy(scene_, accuracy, "asked of the planner");
      measure(sun_mesh_model(scene, geometry_), ring_mesh_model(scene, geometry_, ring_),
              fmt::format("planned_{:g}", accuracy), point);
    } catch (const InputError& error) {
      point.failure = error.what();
    }
    return point;
  }

  /// Solves both meshes and fills the point.
  void measure(const MeshModel& sun_model, const MeshModel& wheel_model, const std::string& name, TradePoint& point) {
    const auto root = options_.out / "tradeoff";
    auto sun = table(sun_model, root / "sun_planet" / name, point);
    auto wheel = table(wheel_model, root / scene_.rings[ring_].name / name, point);
    if (!sun || !wheel) return;
    Figures figures = {mean_stiffness(*sun),       mean_stiffness(*wheel),  stiffness_anywhere(*sun),
                       stiffness_anywhere(*wheel), sun->lte_peak_to_peak(), wheel->lte_peak_to_peak()};
    if (scene_.dynamics) {
      try {
        add_stage_figures(figures, *sun, *wheel, name, point);
      } catch (const Error& error) {
        point.failure = error.what();
      }
    }
    figures.resize(trade_figures().size() + 1, {unknown, unknown});
    set_values(point, figures);
    point.sun_cycle = stiffness_cycle(*sun);
    point.ring_cycle = stiffness_cycle(*wheel);
    if (point.finest) {
      finest_sun_ = std::move(sun);
      finest_wheel_ = std::move(wheel);
    }
  }

  /// What these tables make of the stage, with the errors of the tables carried through.
  void add_stage_figures(Figures& figures, const MeshResult& sun, const MeshResult& wheel, const std::string& name,
                         TradePoint& point) const {
    const auto stage = make_stage(scene_, geometry_, ring_, sun, wheel);
    auto simulation = simulation_options(scene_, stage);
    simulation.keep_series = false;
    simulation.confirm = false;
    const auto file = options_.out / "tradeoff" / scene_.rings[ring_].name / name / "figures.json";
    const auto done = kept_work(file, response_id(stage, simulation, sun, wheel), [&] {
      auto response = dynamics::simulate(stage, simulation);
      const auto make = [&](const MeshResult& s, const MeshResult& w) {
        return make_stage(scene_, geometry_, ring_, s, w);
      };
      const auto errors = carried_errors(response, simulation, {make, sun, wheel});
      set_errors(errors, response);
      Figures found;
      add_response(found, stage, response, stiffness_errors(sun, wheel));
      return figures_text(found);
    });
    point.response = done.cost;
    if (!done.failure.empty()) throw SolverError(done.failure);
    const auto found = parse_figures(done.answer);
    figures.insert(figures.end(), found.begin(), found.end());
  }

  /// Static coupling, and with the ring's modes, of the finest ring mesh; left out where it is of no concern.
  void prepare_coupling() {
    if (!may_be_coupled(scene_, finest_wheel_->model)) return;
    const auto folder = options_.out / "tradeoff" / scene_.rings[ring_].name / "coupling";
    const double compliance = 1 / finest_wheel_->mean_stiffness().value;
    const auto done = measured([&] {
      (void)solve_coupling(scene_, geometry_, finest_wheel_->model, compliance, options_, folder);
      return std::string("solved");
    });
    if (!done.failure.empty()) return log::warn("the coupling of the planets is left out: " + done.failure);
    const auto solved = load_coupling(scene_, geometry_, finest_wheel_->model, compliance, folder);
    if (!solved) return;
    static_coupling_ = taken_coupling(*solved, RimCoupling::statical);
    if (!solved->coupling.modes.empty()) elastic_coupling_ = taken_coupling(*solved, RimCoupling::elastic);
  }

  TradePoint dynamics_point(dynamics::PlanetaryStage stage, const DynamicsSetting& setting) const {
    TradePoint point{.part = TradePart::dynamics,
                     .rung = setting.rung,
                     .settings = setting.settings,
                     .finest = setting.finest,
                     .changes_model = setting.changes_model};
    auto simulation = simulation_options(scene_, stage);
    simulation.keep_series = false;
    simulation.integrator.method = dynamics::Integrator::automatic;
    simulation.integrator.fixed_step = 0;
    setting.apply(stage, simulation);
    const auto id = ContentId()
                        .add("response", response_id(stage, simulation, *finest_sun_, *finest_wheel_))
                        .add("how", setting.rung + setting.settings)
                        .id();
    std::string name = setting.rung + " " + setting.settings;
    for (char& c : name) {
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    }
    const auto file = options_.out / "tradeoff" / scene_.rings[ring_].name / "dynamics" / (name + ".json");
    const auto done = kept_work(file, id, [&] {
      const auto response = dynamics::simulate(stage, simulation);
      if (!response.steady) throw SolverError("the motion does not become periodic");
      Figures figures(6, {unknown, unknown});
      add_response(figures, stage, response, std::nullopt);
      return figures_text(figures);
    });
    point.cost = done.cost;
    point.failure = done.failure;
    if (done.failure.empty()) set_values(point, parse_figures(done.answer));
    return point;
  }

  static void set_values(TradePoint& point, const Figures& figures) {
    const std::size_t count = trade_figures().size();
    for (std::size_t i = 0; i < count; ++i)
      point.values.push_back({figures[i].value, unknown, figures[i].error_relative});
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
      }
      if (part == TradePart::mesh && !point.values.empty()) {
        point.values[sun_entries].error = largest_difference(point.sun_cycle, finest->sun_cycle);
        point.values[ring_entries].error = largest_difference(point.ring_cycle, finest->ring_cycle);
      }
    }
  }

  const Scene& scene_;
  const TradeLists& lists_;
  const GearGeometry& geometry_;
  std::size_t ring_;
  const RunOptions& options_;
  MeshModel sun_, wheel_;
  bool sun_needs_solid_, wheel_needs_solid_;
  std::optional<MeshResult> finest_sun_, finest_wheel_;
  std::shared_ptr<const RingCoupling> static_coupling_, elastic_coupling_;
};

}  // namespace

const std::vector<TradeFigure>& trade_figures() {
  static const std::vector<TradeFigure> figures = {
      {"sun_planet_mean_stiffness_N_per_m", "mean stiffness of the sun mesh"},
      {"ring_planet_mean_stiffness_N_per_m", "mean stiffness of the ring mesh"},
      {"sun_planet_stiffness_entries_N_per_m", "stiffness of the sun mesh, every entry of its table"},
      {"ring_planet_stiffness_entries_N_per_m", "stiffness of the ring mesh, every entry of its table"},
      {"sun_planet_lte_peak_to_peak_m", "transmission error of the sun mesh, peak to peak", false},
      {"ring_planet_lte_peak_to_peak_m", "transmission error of the ring mesh, peak to peak", false},
      {"sun_planet_load_sharing_averaged", "load sharing, averaged over a mesh cycle"},
      {"sun_planet_load_sharing_instantaneous", "load sharing, instantaneous", true, true},
      {"sun_planet_dynamic_factor", "dynamic factor of the sun meshes", true, true},
      {"ring_planet_dynamic_factor", "dynamic factor of the ring meshes", true, true},
      {"frequency_1_Hz", "first natural frequency"},
      {"frequency_2_Hz", "second natural frequency"},
      {"frequency_3_Hz", "third natural frequency"}};
  return figures;
}

std::optional<std::size_t> TradePoint::worst_figure() const {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i].error) && (!worst || values[i].error > values[*worst].error)) worst = i;
  }
  return worst;
}

double TradePoint::error(std::optional<std::size_t> figure) const {
  if (!figure) figure = worst_figure();
  return failure.empty() && figure && *figure < values.size() ? values[*figure].error : unknown;
}

double TradePoint::stiffness_estimate() const {
  return failure.empty() && values.size() > ring_entries
             ? std::max(values[sun_entries].error_estimate, values[ring_entries].error_estimate)
             : unknown;
}

double TradePoint::promised_error() const {
  double largest = failure.empty() && !values.empty() ? 0 : unknown;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& figure = trade_figures()[i];
    if (!figure.promised || (figure.while_teeth_touch && contact_loss > 0)) continue;
    if (std::isfinite(values[i].error)) largest = std::max(largest, values[i].error);
  }
  return largest;
}

const TradePoint* RingTrade::planned(double accuracy) const {
  for (const auto& p : points)
    if (p.planned_for == accuracy) return &p;
  return nullptr;
}

const TradePoint* RingTrade::cheapest(TradePart part, double accuracy, std::optional<std::size_t> figure) const {
  const TradePoint* best = nullptr;
  for (const auto& p : points) {
    if (p.part != part || p.finest || p.planned_for || !(p.error(figure) <= accuracy)) continue;
    if (!best || p.cost.wall < best->cost.wall) best = &p;
  }
  return best;
}

std::vector<const TradePoint*> RingTrade::front(TradePart part, std::optional<std::size_t> figure) const {
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
  if (scene.stage.kind != StageKind::planetary)
    throw InputError(scene.file.string() + ": a tradeoff is measured for planetary stages only so far");
  const auto geometry = make_geometry(scene);
  const Plan plan = make_plan(scene, geometry);
  for (const auto& mesh : plan.meshes) {
    if (!mesh.computed())
      throw InputError(fmt::format("{}: the {} has a given stiffness: there is nothing to trade", scene.file.string(),
                                   mesh.label()));
  }
  TradeOff trade{.scene = scene, .rings = {}, .total_seconds = 0};
  for (std::size_t i = 0; i < scene.rings.size(); ++i)
    trade.rings.push_back(RingMeasurement(scene, geometry, i, options, plan, lists).run());
  for (const auto& ring : trade.rings) {
    for (const auto& p : ring.points) trade.total_seconds += p.cost.wall;
  }
  return trade;
}

}  // namespace annulus::app
