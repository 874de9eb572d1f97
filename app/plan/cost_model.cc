#include "app/plan/cost_model.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "core/errors.h"

namespace annulus::app {

namespace {

/// What a parameter of a law usually is, and how far it may be from that (of a factor: in its logarithm).
struct Usual {
  double value = 0, spread = 1;
};

/// What is known about such solves before any is measured. Factors are free (a spread of e^3), exponents are not.
struct UsualLaw {
  Usual body_exponent, contact_exponent;
  double body, first_ms, each_ms;
};

bool is_solid(const std::string& kind) {
  return kind == "solid" || kind == "solid_half" || kind == "solid_helical" || kind == "resolved_solid";
}
bool is_plane(const std::string& kind) { return kind == "plane" || kind == "resolved_plane"; }
/// Every position has a mesh of its own.
bool is_resolved(const std::string& kind) { return kind == "resolved_plane" || kind == "resolved_solid"; }

UsualLaw usual_law(const std::string& kind) {
  // Nested dissection condenses a section in N^1 to N^1.5, a solid in N^1.5 to N^2; the contact reads dense
  // compliances of some sqrt(N) flank points.
  // Resolved contacts condense their teeth at every position.
  if (kind == "resolved_solid") return {{1.5, 0.1}, {1.5, 0.1}, 1, 1000, 1000};
  if (kind == "resolved_plane") return {{1.15, 0.15}, {1.15, 0.15}, 0.1, 100, 100};
  if (is_solid(kind)) return {{1.5, 0.1}, {0.5, 0.1}, 1, 10, 10};
  if (is_plane(kind)) return {{1.15, 0.15}, {0.5, 0.1}, 0.1, 1, 0.3};
  // The comparison of couplings takes as many cycles for any period.
  if (kind == "response_elastic") return {{0.5, 0.3}, {0.5, 0.1}, 1, 0.1, 0.1};
  return {{0.9, 0.2}, {0.5, 0.1}, 1, 0.1, 0.1};
}

/// Cells get 1.5 times smaller from level to level in the plane, and a little less than that in a solid.
double unknowns_per_level(const std::string& kind) { return is_solid(kind) ? 3.0 : 2.05; }

/// sum over the levels of N^exponent.
double sum_of_levels(const CostRun& run, double exponent) {
  constexpr double unit = 1e4;
  double unknowns = run.unknowns > 0 ? run.unknowns / unit : 1, sum = 0;
  for (int l = 0; l < run.levels; ++l) {
    sum += std::pow(unknowns, exponent);
    unknowns /= unknowns_per_level(run.kind);
  }
  return sum;
}

double speed_up(double efficiency, double threads, double tasks) {
  return 1 + efficiency * (std::max(1.0, std::min(threads, tasks)) - 1);
}

/// In the plane one body each, a solid is condensed by all threads; a response is one task, those of a pair are many.
double body_tasks(const CostRun& run) {
  if (is_resolved(run.kind)) return 1;  // the harmonics of the regular ring
  if (is_solid(run.kind) || run.kind == "coupling_solid" || run.kind == "response_pair") return 1e9;
  return is_plane(run.kind) ? 2 : 1;
}
/// A table of one mesh cycle is solved load by load, a longer one and a resolved one position by position.
double contact_tasks(const CostRun& run) {
  return run.cycles <= 1 && !is_resolved(run.kind) ? run.loads : run.first_problems();
}

double body_seconds(const CostLaw& law, const CostRun& run) {
  return law.body * sum_of_levels(run, law.body_exponent) / speed_up(law.body_efficiency, run.threads, body_tasks(run));
}

double contact_seconds(const CostLaw& law, const CostRun& run) {
  if (run.loads == 0) return 0;
  // Between reading a dense matrix and factoring it.
  const double supports = law.support_ms * std::pow(run.supports / 100, 2) * run.problems();
  const double elements =
      sum_of_levels(run, law.contact_exponent) * (law.first_ms * run.first_problems() + law.each_ms * run.problems());
  return 1e-3 * (elements + supports) / speed_up(law.contact_efficiency, run.threads, contact_tasks(run));
}

double peak_memory(const CostLaw& law, const CostRun& run) {
  constexpr double bodies = 2;
  return law.base_MB + law.per_unknown_MB * run.unknowns / 1e4 * speed_up(law.memory_overlap, run.threads, bodies);
}

/// Least squares of the logarithms of predictions to measurements, and of parameters to what they usually are.
struct LogFit {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  std::vector<Usual> usual;
  std::vector<double> measured;
  std::function<double(const Eigen::VectorXd& parameters, std::size_t run)> predicted;

  [[nodiscard]] int inputs() const { return static_cast<int>(usual.size()); }
  [[nodiscard]] int values() const { return static_cast<int>(usual.size() + measured.size()); }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
    for (std::size_t i = 0; i < usual.size(); ++i)
      residual[static_cast<Eigen::Index>(i)] = (x[static_cast<Eigen::Index>(i)] - usual[i].value) / usual[i].spread;
    // A measured time scatters by some ten to twenty per cent.
    constexpr double scatter = 0.15;
    for (std::size_t i = 0; i < measured.size(); ++i)
      residual[static_cast<Eigen::Index>(usual.size() + i)] = std::log(predicted(x, i) / measured[i]) / scatter;
    return 0;
  }

  [[nodiscard]] Eigen::VectorXd solve() const {
    Eigen::VectorXd x(inputs());
    for (int i = 0; i < inputs(); ++i) x[i] = usual[static_cast<std::size_t>(i)].value;
    if (measured.empty()) return x;
    Eigen::NumericalDiff<LogFit> differences(*this);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<LogFit>> search(differences);
    search.minimize(x);
    require(x.allFinite(), "the laws of the costs cannot be fitted");
    return x;
  }
};

constexpr double free_factor = 3;  // in the logarithm
constexpr double usual_support_ms = 0.2;

using Runs = std::vector<const CostRun*>;

void fit_body(CostLaw& law, const UsualLaw& usual, const Runs& runs) {
  const auto with = [&](const Eigen::VectorXd& x) {
    CostLaw l;
    l.body = std::exp(x[0]), l.body_exponent = x[1], l.body_efficiency = x[2];
    return l;
  };
  LogFit fit{
      .usual = {{std::log(usual.body), free_factor}, usual.body_exponent, {0.6, 0.2}}, .measured = {}, .predicted = {}};
  Runs used;
  for (const auto* run : runs)
    if (run->body_s > 0) used.push_back(run), fit.measured.push_back(run->body_s);
  fit.predicted = [&](const Eigen::VectorXd& x, std::size_t i) { return body_seconds(with(x), *used[i]); };
  const auto l = with(fit.solve());
  law.body = used.empty() ? 0 : l.body;
  law.body_exponent = l.body_exponent;
  law.body_efficiency = std::clamp(l.body_efficiency, 0.0, 1.0);
}

void fit_contact(CostLaw& law, const UsualLaw& usual, const Runs& runs) {
  const auto with = [&](const Eigen::VectorXd& x) {
    CostLaw l;
    l.first_ms = std::exp(x[0]), l.each_ms = std::exp(x[1]), l.contact_exponent = x[2], l.contact_efficiency = x[3];
    l.support_ms = std::exp(x[4]);
    return l;
  };
  LogFit fit{.usual = {{std::log(usual.first_ms), free_factor},
                       {std::log(usual.each_ms), free_factor},
                       usual.contact_exponent,
                       {0.8, 0.2},
                       {std::log(usual_support_ms), free_factor}},
             .measured = {},
             .predicted = {}};
  Runs used;
  for (const auto* run : runs)
    if (run->contact_s > 0 && run->loads > 0) used.push_back(run), fit.measured.push_back(run->contact_s);
  if (used.empty()) return;
  fit.predicted = [&](const Eigen::VectorXd& x, std::size_t i) { return contact_seconds(with(x), *used[i]); };
  const auto l = with(fit.solve());
  law.first_ms = l.first_ms;
  law.each_ms = l.each_ms;
  law.contact_exponent = l.contact_exponent;
  law.contact_efficiency = std::clamp(l.contact_efficiency, 0.0, 1.0);
  law.support_ms = l.support_ms;
}

void fit_memory(CostLaw& law, const Runs& runs) {
  const auto with = [&](const Eigen::VectorXd& x) {
    CostLaw l;
    l.base_MB = std::exp(x[0]), l.per_unknown_MB = std::exp(x[1]), l.memory_overlap = x[2];
    return l;
  };
  LogFit fit{
      .usual = {{std::log(200.0), 0.5}, {std::log(50.0), free_factor}, {0.6, 0.2}}, .measured = {}, .predicted = {}};
  Runs used;
  for (const auto* run : runs)
    if (run->peak_MB > 0) used.push_back(run), fit.measured.push_back(run->peak_MB);
  law.base_MB = std::numeric_limits<double>::quiet_NaN();
  if (used.empty()) return;
  fit.predicted = [&](const Eigen::VectorXd& x, std::size_t i) { return peak_memory(with(x), *used[i]); };
  const auto l = with(fit.solve());
  law.base_MB = l.base_MB;
  law.per_unknown_MB = l.per_unknown_MB;
  law.memory_overlap = std::clamp(l.memory_overlap, 0.0, 1.0);
}

void fit_error(CostLaw& law, const Runs& runs, int degree) {
  // The estimate is the difference of two levels, and falls with the cell size or a little faster.
  LogFit fit{.usual = {{std::log(0.003), free_factor}, {std::log(0.6), 0.1}}, .measured = {}, .predicted = {}};
  Runs used;
  for (const auto* run : runs)
    if (run->error > 0 && run->degree == degree && run->level > 0)
      used.push_back(run), fit.measured.push_back(run->error);
  if (used.empty()) return;
  fit.predicted = [&](const Eigen::VectorXd& x, std::size_t i) { return std::exp(x[0] + x[1] * (used[i]->level - 1)); };
  const auto x = fit.solve();
  law.error[degree] = {std::exp(x[0]), std::exp(x[1])};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

CostModel::CostModel(const std::vector<CostRun>& kept, const std::vector<CostRun>& own) {
  std::map<std::string, Runs> by_kind;
  for (const auto& run : kept) by_kind[run.kind].push_back(&run);
  for (const auto& [kind, runs] : by_kind) {
    CostLaw& law = laws_[kind];
    const auto usual = usual_law(kind);
    fit_body(law, usual, runs);
    fit_contact(law, usual, runs);
    fit_memory(law, runs);
    for (const int degree : {1, 2, 3}) fit_error(law, runs, degree);
  }
  // Logarithms: half the time and twice the time are equally wrong.
  std::map<std::string, std::vector<double>> ratios;
  for (const auto& run : own) {
    const double expected = predict(run).seconds;
    if (run.seconds() > 0 && expected > 0) ratios[run.kind].push_back(std::log(run.seconds() / expected));
  }
  constexpr std::size_t enough = 3;  // of which one may be anything
  for (const auto& [kind, list] : ratios)
    if (list.size() >= enough) scales_[kind] = std::exp(median(list));
}

CostModel CostModel::of_this_machine() {
  static const CostModel kept(kept_cost_runs());
  const auto own = read_user_costs(user_costs_file());
  return own.empty() ? kept : CostModel(kept_cost_runs(), own);
}

PredictedCost CostModel::predict(const CostRun& size) const {
  const auto found = laws_.find(size.kind);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (found == laws_.end()) return {unknown, unknown};
  const auto& l = found->second;
  return {scale(size.kind) * (body_seconds(l, size) + contact_seconds(l, size)), peak_memory(l, size)};
}

double CostModel::expected_error(const std::string& kind, int degree, int level) const {
  const auto law = laws_.find(kind);
  if (law == laws_.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto& errors = law->second.error;
  auto error = errors.find(degree);
  if (error == errors.end()) error = errors.find(2);
  if (error == errors.end()) return std::numeric_limits<double>::quiet_NaN();
  return error->second.first * std::pow(error->second.ratio, level - 1);
}

int CostModel::expected_level(const std::string& kind, int degree, double accuracy, int last_level) const {
  int level = std::min(1, last_level);
  while (level < last_level && expected_error(kind, degree, level) > accuracy) ++level;
  return level;
}

double CostModel::scale(const std::string& kind) const {
  const auto found = scales_.find(kind);
  return found == scales_.end() ? 1.0 : found->second;
}

const CostLaw& CostModel::law(const std::string& kind) const {
  const auto found = laws_.find(kind);
  require(found != laws_.end(), "no cost law of " + kind);
  return found->second;
}

}  // namespace annulus::app
