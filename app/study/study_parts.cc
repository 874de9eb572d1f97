#include "app/study/study_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/model/plan_studies.h"
#include "app/model/run_options.h"
#include "app/study/directed_sweeps.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// A study as a list of parts, and how some of them are computed.
struct DividedStudy {
  std::string name;
  std::vector<std::string> parts;
  std::function<void(const StudySubject&, const std::vector<std::size_t>&)> compute;
  int workers = 1;  ///< on one part
};

/// A part per case.
DividedStudy divided_cases(const std::string& name, const std::vector<StudyCase>& cases) {
  DividedStudy study{.name = name, .parts = {}, .compute = [name, cases](const auto& subject, const auto& parts) {
                       std::vector<StudyCase> mine;
                       for (const std::size_t i : parts) mine.push_back(cases[i]);
                       (void)run_cases(subject, mine, name);
                     }};
  // Most cases name their study first: "[[sweep]] 1, value 7 of 20 (stage.power_kW = 900)".
  for (const auto& study_case : cases) {
    const auto& where = study_case.where;
    const auto begin = where.starts_with(name) ? where.find_first_not_of(", ", name.size()) : 0;
    study.parts.push_back(begin < where.size() ? where.substr(begin) : where);
  }
  return study;
}

/// Points that follow from each other are one part.
DividedStudy divided_sweep(const std::string& name, const Scene& scene, std::size_t number) {
  const auto& sweep = scene.sweeps[number];
  const auto cases = sweep_cases(scene, number);
  if (sweep.direction == SweepDirection::each) return divided_cases(name, cases);
  std::vector<std::pair<std::string, std::function<void(const StudySubject&)>>> list;
  const auto in_order = [&](SweepOrder order, const std::string& way) {
    list.emplace_back(way, [=](const StudySubject& s) { (void)run_in_order(s, cases, order, name + ", " + way); });
  };
  if (sweep.goes_up()) in_order(SweepOrder::rising, "up");
  if (sweep.goes_down()) in_order(SweepOrder::falling, "down");
  if (sweep.direction == SweepDirection::branches)
    list.emplace_back("branches", [=](const StudySubject& subject) { (void)find_branches(subject, number); });
  DividedStudy study{.name = name, .parts = {}, .compute = [list](const auto& subject, const auto& parts) {
                       for (const std::size_t i : parts) list[i].second(subject);
                     }};
  for (const auto& part : list) study.parts.push_back(part.first);
  return study;
}

/// Samples in blocks: at most a thousand of them, however many samples there are.
DividedStudy divided_samples(const Sampling& sampling) {
  constexpr int most_blocks = 1000, least = 10;
  const int size = std::max(least, (sampling.samples + most_blocks - 1) / most_blocks);
  const auto end_of = [=](int first) { return std::min(first + size, sampling.samples); };
  DividedStudy study{.name = "[monte_carlo]", .parts = {}, .compute = [=](const auto& subject, const auto& parts) {
                       std::vector<int> mine;
                       for (const std::size_t i : parts)
                         for (int first = static_cast<int>(i) * size, n = first; n < end_of(first); ++n)
                           mine.push_back(n);
                       compute_samples(subject, sampling, mine);
                     }};
  for (int first = 0; first < sampling.samples; first += size)
    study.parts.push_back(fmt::format("samples {} to {}", first + 1, end_of(first)));
  return study;
}

/// Workers compute the points of a generation together.
DividedStudy divided_searches(const OptimiseInput& settings) {
  DividedStudy study{.name = "[optimise]", .parts = {}, .compute = compute_searches, .workers = settings.population};
  for (const auto& optimiser : settings.optimisers)
    for (int repeat = 0; repeat < settings.repeats; ++repeat)
      study.parts.push_back(fmt::format("{}, search {}", optimiser, repeat + 1));
  return study;
}

std::vector<DividedStudy> divided_studies(const Scene& scene) {
  std::vector<DividedStudy> list;
  if (!scene.dynamics) return list;
  for (std::size_t i = 0; i < scene.sweeps.size(); ++i)
    list.push_back(divided_sweep(fmt::format("[[sweep]] {}", i + 1), scene, i));
  for (std::size_t i = 0; i < scene.grids.size(); ++i)
    list.push_back(divided_cases(fmt::format("[[grid]] {}", i + 1), grid_cases(scene, i)));
  if (scene.load_spectrum) list.push_back(divided_cases("[load_spectrum]", load_cases(scene)));
  for (std::size_t i = 0; i < scene.transients.size(); ++i)
    list.push_back({fmt::format("[[transient]] {}", i + 1),
                    {scene.transients[i].name},
                    [i](const auto& subject, const auto&) { (void)followed_transient(subject, i); }});
  if (const auto sampling = sampling_of(scene)) list.push_back(divided_samples(*sampling));
  if (scene.optimise) list.push_back(divided_searches(*scene.optimise));
  if (scene.sensitivity) {
    auto cases = sensitivity_cases(scene);
    cases.push_back(nominal_case_of_sensitivity());
    list.push_back(divided_cases("[sensitivity]", cases));
  }
  return list;
}

}  // namespace

std::vector<StudyPart> study_parts(const Scene& scene) {
  const auto plans = plan_studies(scene);
  std::vector<StudyPart> list;
  for (const auto& study : divided_studies(scene)) {
    const auto plan =
        std::find_if(plans.begin(), plans.end(), [&](const StudyPlan& p) { return p.name == study.name; });
    require(plan != plans.end(), study.name + " has no plan");
    const double seconds = plan->seconds + (plan->tables > 0 ? plan->tables * processor_seconds(plan->table) : 0.0);
    for (const auto& part : study.parts)
      list.push_back({study.name, part, seconds / static_cast<double>(study.parts.size()), study.workers});
  }
  return list;
}

void compute_parts(const StudySubject& subject, const std::vector<std::size_t>& places,
                   const std::function<void(const std::vector<std::size_t>&)>& done) {
  std::size_t first = 0;
  for (const auto& study : divided_studies(subject.scene())) {
    const std::size_t end = first + study.parts.size();
    std::vector<std::size_t> mine, parts;
    for (const std::size_t place : places)
      if (place >= first && place < end) {
        mine.push_back(place);
        parts.push_back(place - first);
      }
    if (!mine.empty()) {
      study.compute(subject, parts);
      done(mine);
    }
    first = end;
  }
}

namespace {

double known_seconds(const StudyPart& part) { return std::isfinite(part.seconds) ? part.seconds : 0.0; }

}  // namespace

std::vector<std::vector<std::size_t>> shares(const std::vector<StudyPart>& parts, int workers) {
  // The longest part goes to the worker with the least to do.
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return known_seconds(parts[a]) > known_seconds(parts[b]); });
  std::vector<std::vector<std::size_t>> list(static_cast<std::size_t>(workers));
  std::vector<double> load(list.size(), 0.0);
  for (const std::size_t place : order) {
    if (parts[place].workers > 1) {
      for (auto& share : list) share.push_back(place);
      continue;
    }
    const auto least = static_cast<std::size_t>(std::min_element(load.begin(), load.end()) - load.begin());
    constexpr double of_any_part = 1e-6;  // parts without a predicted time are shared evenly too
    load[least] += known_seconds(parts[place]) + of_any_part;
    list[least].push_back(place);
  }
  for (auto& share : list) std::sort(share.begin(), share.end());
  return list;
}

double longest_share(const std::vector<StudyPart>& parts, int workers) {
  double longest = 0;
  for (const auto& share : shares(parts, workers)) {
    double sum = 0;
    for (const std::size_t place : share) sum += known_seconds(parts[place]) / std::min(workers, parts[place].workers);
    longest = std::max(longest, sum);
  }
  return longest;
}

}  // namespace annulus::app
