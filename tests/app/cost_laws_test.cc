#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "app/plan/cost_model.h"
#include "core/files.h"

/// Fits the cost laws to data/cost_runs.csv and compares them with the table of the program. Where the runs change, the
/// messages of the test are the new lines of the table.
namespace annulus {

namespace {

constexpr int works = static_cast<int>(app::Work::response_balanced) + 1;

/// A line of data/cost_runs.csv; 0 for what was not measured.
struct MeasuredRun {
  app::CostRun size;
  int threads = 1;
  double error = 0, body_s = 0, contact_s = 0, peak_MB = 0;
};

std::vector<MeasuredRun> measured_runs() {
  std::istringstream in(read_file(std::string(ANNULUS_SOURCE_DIR) + "/data/cost_runs.csv"));
  std::vector<MeasuredRun> runs;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#' || line.starts_with("work,")) continue;
    const auto comma = line.find(',');
    const auto name = line.substr(0, comma);
    MeasuredRun run;
    int work = 0;
    while (work < works && name != app::cost_law(static_cast<app::Work>(work)).name) ++work;
    BOOST_REQUIRE_MESSAGE(work < works, line);
    run.size.work = static_cast<app::Work>(work);
    std::ranges::replace(line, ',', ' ');
    std::istringstream cells(line.substr(comma));
    cells >> run.size.degree >> run.size.level >> run.size.levels >> run.size.unknowns >> run.size.contacts >>
        run.size.supports >> run.threads >> run.error >> run.body_s >> run.contact_s >> run.peak_MB;
    BOOST_REQUIRE_MESSAGE(!cells.fail(), line);
    runs.push_back(run);
  }
  return runs;
}

/// What a parameter of a law usually is, and how far it may be from that. Factors, by their logarithms, are free;
/// exponents are not.
struct Usual {
  double value = 0, spread = 3;
};

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
    for (int i = 0; i < inputs(); ++i) residual[i] = (x[i] - usual[i].value) / usual[i].spread;
    constexpr double scatter = 0.15;  // a measured time scatters by some ten to twenty per cent
    for (std::size_t i = 0; i < measured.size(); ++i)
      residual[inputs() + static_cast<int>(i)] = std::log(predicted(x, i) / measured[i]) / scatter;
    return 0;
  }

  [[nodiscard]] Eigen::VectorXd solve() const {
    Eigen::VectorXd x(inputs());
    for (int i = 0; i < inputs(); ++i) x[i] = usual[i].value;
    Eigen::NumericalDiff<LogFit> differences(*this);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<LogFit>> search(differences);
    search.minimize(x);
    return x;
  }
};

/// Fits to the runs of a kind of work for which `value` is known.
Eigen::VectorXd fitted(const std::vector<MeasuredRun>& runs, double MeasuredRun::*value, std::vector<Usual> usual,
                       const std::function<double(const Eigen::VectorXd&, const MeasuredRun&)>& law) {
  std::vector<const MeasuredRun*> used;
  LogFit fit{.usual = std::move(usual), .measured = {}, .predicted = {}};
  for (const auto& run : runs)
    if (run.*value > 0) used.push_back(&run), fit.measured.push_back(run.*value);
  if (used.empty()) return {};
  fit.predicted = [&](const Eigen::VectorXd& x, std::size_t i) { return law(x, *used[i]); };
  return fit.solve();
}

bool is_solid(const std::string& name) { return name.find("solid") != std::string::npos && !name.starts_with("coup"); }

/// sum_levels N^exponent of a run.
double sum_of_levels(const MeasuredRun& run, double exponent, const std::string& name) {
  double unknowns = run.size.unknowns > 0 ? run.size.unknowns / 1e4 : 1, sum = 0;
  for (int l = 0; l < run.size.levels; ++l, unknowns /= is_solid(name) ? 3.0 : 2.05)
    sum += std::pow(unknowns, exponent);
  return sum;
}

/// Nested dissection condenses a section in N^1 to N^1.5, a solid in N^1.5 to N^2; the contact reads dense compliances
/// of some sqrt(N) flank points. Resolved contacts condense their teeth at every position.
Usual usual_body(const std::string& name) {
  if (is_solid(name)) return {1.5, 0.1};
  if (name == "plane" || name == "resolved_plane") return {1.15, 0.15};
  return {0.9, 0.2};
}
Usual usual_contact(const std::string& name) {
  if (name == "closed_form") return {0, 1e-6};
  return name.starts_with("resolved") ? usual_body(name) : Usual{0.5, 0.1};
}

/// Of the libraries that are loaded.
double usual_base_MB(const std::string& name) {
  return name == "closed_form" || name.starts_with("response") ? 50.0 : 200.0;
}

app::CostLaw fitted_law(app::Work work, const std::vector<MeasuredRun>& runs) {
  const std::string name = app::cost_law(work).name;
  app::CostLaw law{app::cost_law(work).name, 0, 1, 0, 0, std::nan(""), 0};
  const auto body = fitted(runs, &MeasuredRun::body_s, {{0}, usual_body(name)}, [&](const auto& x, const auto& run) {
    return std::exp(x[0]) * sum_of_levels(run, x[1], name);
  });
  if (body.size() > 0) law.body = std::exp(body[0]), law.body_exponent = body[1];
  const auto contact = fitted(
      runs, &MeasuredRun::contact_s, {{std::log(1e-3)}, usual_contact(name)}, [&](const auto& x, const auto& run) {
        return (std::exp(x[0]) * sum_of_levels(run, x[1], name) + 2e-4 * std::pow(run.size.supports / 100, 2)) *
               run.size.contacts;
      });
  if (contact.size() > 0) law.contact = std::exp(contact[0]), law.contact_exponent = contact[1];
  const auto memory =
      fitted(runs, &MeasuredRun::peak_MB, {{std::log(usual_base_MB(name)), 0.5}, {std::log(50.0)}},
             [](const auto& x, const auto& run) {
               return std::exp(x[0]) + std::exp(x[1]) * run.size.unknowns / 1e4 * (run.threads > 1 ? 1.65 : 1);
             });
  if (memory.size() > 0) law.base_MB = std::exp(memory[0]), law.per_unknown_MB = std::exp(memory[1]);
  return law;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cost_laws)

BOOST_AUTO_TEST_CASE(the_table_is_fitted_to_the_measured_runs) {
  std::map<app::Work, std::vector<MeasuredRun>> runs;
  for (const auto& run : measured_runs()) runs[run.size.work].push_back(run);
  for (int i = 0; i < works; ++i) {
    const auto work = static_cast<app::Work>(i);
    const auto& table = app::cost_law(work);
    const auto fit = fitted_law(work, runs[work]);
    BOOST_TEST_INFO(fmt::format("{{\"{}\", {:.4g}, {:.3g}, {:.4g}, {:.3g}, {:.4g}, {:.4g}}},", fit.name, fit.body,
                                fit.body_exponent, fit.contact, fit.contact_exponent, fit.base_MB, fit.per_unknown_MB));
    const auto equal = [](double a, double b) {
      return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 0.01 * std::abs(b) + 1e-6;
    };
    BOOST_TEST((equal(table.body, fit.body) && equal(table.body_exponent, fit.body_exponent) &&
                equal(table.contact, fit.contact) && equal(table.contact_exponent, fit.contact_exponent) &&
                equal(table.base_MB, fit.base_MB) && equal(table.per_unknown_MB, fit.per_unknown_MB)));
  }
}

BOOST_AUTO_TEST_CASE(expected_errors_are_fitted_to_the_measured_runs) {
  // The estimate is the difference of two levels, and falls with the cell size or a little faster.
  std::map<std::pair<app::Work, int>, std::vector<MeasuredRun>> runs;
  for (const auto& run : measured_runs())
    if (run.size.level > 0 && run.error > 0) runs[{run.size.work, run.size.degree}].push_back(run);
  BOOST_TEST(runs.size() == 10U);
  for (const auto& [key, list] : runs) {
    const auto& [work, degree] = key;
    const auto x = fitted(list, &MeasuredRun::error, {{std::log(0.003)}, {std::log(0.6), 0.1}},
                          [](const auto& p, const auto& run) { return std::exp(p[0] + p[1] * (run.size.level - 1)); });
    BOOST_TEST_INFO(app::cost_law(work).name << " of degree " << degree);
    BOOST_TEST(app::expected_error(work, degree, 1) == std::exp(x[0]), boost::test_tools::tolerance(1e-6));
    BOOST_TEST(app::expected_error(work, degree, 2) == std::exp(x[0] + x[1]), boost::test_tools::tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(the_laws_reproduce_the_measured_runs) {
  std::vector<double> misses;
  std::map<std::string, double> worst;
  double worst_memory = 1;
  for (const auto& run : measured_runs()) {
    const std::string name = app::cost_law(run.size.work).name;
    if (run.peak_MB > 0) {
      const double memory = std::abs(std::log(app::peak_memory(run.size, run.threads) / run.peak_MB));
      BOOST_TEST(memory < std::log(1.6), name << " " << run.size.unknowns);
      worst_memory = std::max(worst_memory, std::exp(memory));
    }
    const bool whole = run.body_s > 0 && (run.contact_s > 0 || run.size.contacts == 0);
    if (!whole) continue;  // only its memory was measured
    const double predicted = app::processor_seconds(run.size), measured = run.body_s + run.contact_s;
    const double miss = std::abs(std::log(predicted / measured));
    BOOST_TEST(miss < std::log(2.2), name << " level " << run.size.level << " of " << run.size.unknowns << " unknowns: "
                                          << predicted << " s predicted, " << measured << " s measured");
    misses.push_back(miss);
    worst[name] = std::max(worst[name], std::exp(miss));
  }
  BOOST_REQUIRE(misses.size() > 50);
  std::ranges::sort(misses);
  BOOST_TEST(misses[misses.size() / 2] < std::log(1.3));
  BOOST_TEST_MESSAGE("predicted against measured time: factor " << std::exp(misses[misses.size() / 2])
                                                                << " in the middle, " << std::exp(misses.back())
                                                                << " at worst; memory " << worst_memory);
  for (const auto& [name, factor] : worst) BOOST_TEST_MESSAGE("  " << name << " " << factor << " at worst");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
