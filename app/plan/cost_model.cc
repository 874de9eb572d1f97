#include "app/plan/cost_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/results/user_cache.h"
#include "core/files.h"
#include "core/json.h"
#include "core/log.h"
#include "core/not_known.h"

namespace annulus::app {

namespace {

/// In the order of Work.
constexpr CostLaw laws[] = {
    // name, body, exponent, contact, exponent, MB, MB per 10^4 unknowns
    {"closed_form", 0.00135, 0.9, 1.786e-05, 0, 50.84, 50},
    {"plane", 0.08767, 0.89, 0.0001134, 0.687, 227.6, 23.76},
    {"solid", 0.6175, 1.71, 0.002989, 0.823, 166.5, 121.4},
    {"solid_half", 0.6233, 1.05, 0.001, 0.509, 195.8, 70.15},
    {"solid_helical", 0.4861, 1.6, 0.005056, 0.639, 221.1, 99.61},
    {"resolved_plane", 0.09567, 1.12, 0.1032, 1.24, 176.4, 13.38},
    {"resolved_solid", 0.2453, 1.5, 0.6964, 1.51, 201.2, 168.2},
    {"coupling_plane", 0.06267, 1.06, 0, 0, not_known, 0},
    {"coupling_pins", 0.131, 0.432, 0, 0, not_known, 0},
    {"coupling_solid", 0.3249, 1.27, 0, 0, 199.2, 97.96},
    {"response", 0, 1, 0, 0, 61.89, 23.74},
    {"response_elastic", 0, 1, 0, 0, 75.01, 74.5},
    {"response_pins", 0, 1, 0, 0, 50.5, 383.1},
    {"response_prescribed", 0, 1, 0, 0, 46.47, 56.36},
    {"response_balanced", 0, 1, 0, 0, 61.4, 227.6},
};

/// Estimated relative error of a table: first ratio^(level - 1). Fitted to the same runs; levels are chosen by it.
struct ErrorLaw {
  Work work;
  int degree;
  double first, ratio;
};
constexpr ErrorLaw error_laws[] = {
    {Work::plane, 1, 0.0084321331848821266, 0.6},
    {Work::plane, 2, 0.0016211009934046553, 0.71988829165599777},
    {Work::solid, 1, 0.013224763047209454, 0.6},
    {Work::solid, 2, 0.0024946589928879302, 0.6},
    {Work::solid_half, 1, 0.01261611640530301, 0.6},
    {Work::solid_half, 2, 0.0012742951788386331, 0.61694271550702451},
    {Work::solid_helical, 1, 0.025365346737671973, 0.6},
    {Work::solid_helical, 2, 0.006821726421255031, 0.6},
    {Work::resolved_plane, 2, 0.00090647378457146084, 0.62124408130060227},
    {Work::resolved_solid, 2, 0.011891689058876838, 0.6},
};

bool is_solid(Work work) {
  return work == Work::solid || work == Work::solid_half || work == Work::solid_helical || work == Work::resolved_solid;
}

/// A second thread helps by half of itself.
double useful_threads(int threads, int tasks) {
  constexpr double efficiency = 0.5;
  return 1 + efficiency * (std::max(1, std::min(threads, tasks)) - 1);
}

std::filesystem::path pace_file() {
  const auto folder = user_cache();
  return folder.empty() ? folder : folder / "pace.json";
}

/// Measured to predicted processor times, oldest first; none where there is no such file or it is damaged.
std::vector<double> measured_paces() {
  try {
    std::vector<double> paces = Json::parse(read_file(pace_file()));
    const auto possible = [](double pace) { return pace > 0; };
    if (std::all_of(paces.begin(), paces.end(), possible)) return paces;
  } catch (const std::exception&) {  // it begins anew
  }
  return {};
}

}  // namespace

const CostLaw& cost_law(Work work) { return laws[static_cast<std::size_t>(work)]; }

double processor_seconds(const CostRun& size) {
  const auto& law = cost_law(size.work);
  // Cells get 1.5 times smaller from level to level in the plane, and a little less than that in a solid.
  const double coarsening = is_solid(size.work) ? 3.0 : 2.05;
  double unknowns = size.unknowns > 0 ? size.unknowns / 1e4 : 1, seconds = size.motion_s + size.before_s;
  for (int l = 0; l < size.levels; ++l) {
    seconds += law.body * std::pow(unknowns, law.body_exponent) +
               law.contact * std::pow(unknowns, law.contact_exponent) * size.contacts;
    unknowns /= coarsening;
  }
  // Formulas: measured on five rings of 39 to 116 supports, within a factor of 1.8.
  constexpr double per_support = 1.1e-5;
  if (size.work == Work::closed_form) return seconds + per_support * size.supports * size.contacts;
  // Between reading a dense matrix and factoring it.
  constexpr double per_hundred_supports = 2e-4;
  return seconds + per_hundred_supports * std::pow(size.supports / 100, 2) * size.contacts;
}

double peak_memory(const CostRun& size, int threads) {
  const auto& law = cost_law(size.work);
  // Two bodies are condensed at once.
  constexpr double overlap = 0.65;
  // States of pins, bolts or spline teeth at every position; six rings of 38 to 101 took 0.99 to 1.42 times the sum.
  constexpr double per_support = 1.8e-4;
  const bool states = size.work == Work::closed_form || size.work == Work::plane;
  return law.base_MB + size.held_MB + law.per_unknown_MB * size.unknowns / 1e4 * (threads > 1 ? 1 + overlap : 1) +
         (states ? per_support * size.supports * size.contacts : 0);
}

PredictedCost predicted_cost(const CostRun& size, int threads) {
  return {processor_seconds(size) / useful_threads(threads, size.tasks), peak_memory(size, threads)};
}

double expected_error(Work work, int degree, int level) {
  const ErrorLaw* law = nullptr;
  for (const auto& candidate : error_laws)
    if (candidate.work == work && (candidate.degree == degree || (!law && candidate.degree == 2))) law = &candidate;
  return law ? law->first * std::pow(law->ratio, level - 1) : not_known;
}

int expected_level(Work work, int degree, double accuracy, int last_level) {
  int level = std::min(1, last_level);
  while (level < last_level && expected_error(work, degree, level) > accuracy) ++level;
  return level;
}

double machine_pace() {
  auto paces = measured_paces();
  constexpr std::size_t enough = 3;  // of which one may be anything
  if (paces.size() < enough) return 1;
  const auto middle = paces.begin() + static_cast<std::ptrdiff_t>(paces.size() / 2);
  std::nth_element(paces.begin(), middle, paces.end());
  return *middle;
}

void learn_pace(const std::vector<CostRun>& done) {
  constexpr double shortest = 0.2;  // s
  constexpr std::size_t most = 50;
  auto paces = measured_paces();
  const auto before = paces.size();
  for (const auto& run : done)
    if (run.processor_s > shortest) paces.push_back(run.processor_s / processor_seconds(run));
  if (paces.size() == before || pace_file().empty()) return;
  if (paces.size() > most) paces.erase(paces.begin(), paces.end() - static_cast<std::ptrdiff_t>(most));
  try {
    std::filesystem::create_directories(pace_file().parent_path());
    write_file(pace_file(), Json(paces).dump() + "\n");
  } catch (const std::exception& error) {
    log::debug(fmt::format("the speed of this machine cannot be stored: {}", error.what()));
  }
}

}  // namespace annulus::app
