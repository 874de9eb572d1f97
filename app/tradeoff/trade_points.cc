#include <algorithm>
#include <cmath>
#include <limits>

#include "app/model/mesh_result.h"
#include "app/tradeoff/tradeoff.h"
#include "core/errors.h"
#include "fem/problem/loaded_mesh_problem.h"

namespace annulus::app {

namespace {

std::string mean_key(const std::string& mesh) { return mesh + "_mean_stiffness_N_per_m"; }
std::string entries_key(const std::string& mesh) { return mesh + "_stiffness_entries_N_per_m"; }
std::string lte_key(const std::string& mesh) { return mesh + "_lte_peak_to_peak_m"; }

/// All settings of a ring share what its model leaves out, also the one they are compared with.
double common_error(const MeshResult& mesh) {
  return fem::model_error(*mesh.model.problem, mesh.model.settings.fidelity);
}

Figure absolute(double value, double relative) { return {value, std::abs(value) * relative}; }

/// Relative, of any entry from the reference curve.
double largest_difference(const StiffnessCycle& cycle, const StiffnessCycle& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < cycle.entries.size(); ++i)
    largest = std::max(largest, std::abs(cycle.entries[i] / truth.curve(static_cast<double>(i) / cycle.phases) - 1));
  return largest;
}

/// Whether the wanted accuracy covers the error of a result at this point.
bool is_covered(const TradeFigure& figure, const TradePoint& point) {
  return figure.guarantee == Guarantee::always ||
         (figure.guarantee == Guarantee::while_in_contact && !(point.contact_loss > 0));
}

}  // namespace

FigureSet trade_figures(const MeshResult& mesh) {
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

std::vector<TradeFigure> trade_figures(const std::vector<MeshModel>& meshes, const std::vector<FigureSpec>& model) {
  std::vector<TradeFigure> list;
  list.reserve(2 * meshes.size() + model.size());
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

void VariantTrade::compare_with_finest(TradePart part) {
  const auto is_finest = [&](const TradePoint& p) { return p.part == part && p.finest; };
  const auto finest = std::find_if(points.begin(), points.end(), is_finest);
  if (finest == points.end() || finest->values.empty()) return;
  for (auto& point : points) {
    if (point.part != part) continue;
    for (auto& value : point.values) {
      const auto entries_of = figure(value.key).entries_of;
      if (part == TradePart::mesh && entries_of)
        value.error = largest_difference(point.cycles.at(*entries_of), finest->cycles.at(*entries_of));
      else if (const auto* truth = finest->find(value.key))
        value.error = std::abs(value.value / truth->value - 1);
    }
  }
}

const TradeFigure& VariantTrade::figure(const std::string& key) const {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const TradeFigure& f) { return f.key == key; });
  require(found != figures.end(), "a result of the cost study that is not declared");
  return *found;
}

std::vector<const TradePoint*> VariantTrade::of(TradePart part) const {
  std::vector<const TradePoint*> list;
  for (const auto& p : points)
    if (p.part == part) list.push_back(&p);
  return list;
}

const TradeValue* VariantTrade::worst_guaranteed(const TradePoint& point) const {
  const TradeValue* worst = nullptr;
  for (const auto& figure : figures) {
    const auto* value = point.find(figure.key);
    if (is_covered(figure, point) && value && std::isfinite(value->error) && (!worst || value->error > worst->error))
      worst = value;
  }
  return worst;
}

std::vector<const TradeValue*> VariantTrade::not_guaranteed(const TradePoint& point) const {
  std::vector<const TradeValue*> list;
  for (const auto& figure : figures) {
    const auto* value = point.find(figure.key);
    if (!is_covered(figure, point) && value && std::isfinite(value->error)) list.push_back(value);
  }
  return list;
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
  for (const auto* p : front(part, key))
    if (p->error(key) <= accuracy) return p;
  return nullptr;
}

std::vector<const TradePoint*> VariantTrade::front(TradePart part, const std::string& key) const {
  auto list = of(part);
  std::erase_if(list, [&](const auto* p) { return p->finest || p->planned_for || !std::isfinite(p->error(key)); });
  std::stable_sort(list.begin(), list.end(), [](const auto* a, const auto* b) { return a->cost.wall < b->cost.wall; });
  double best = std::numeric_limits<double>::infinity();
  std::erase_if(list, [&](const TradePoint* p) {
    if (p->error(key) >= best) return true;
    best = p->error(key);
    return false;
  });
  return list;
}

}  // namespace annulus::app
