#include "app/study/directed_sweeps.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "app/model/dynamics_members.h"
#include "app/model/run_options.h"
#include "app/process/progress.h"
#include "app/results/cached_value.h"
#include "app/results/content_id.h"
#include "app/study/study_points.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/parallel.h"

namespace annulus::app {

namespace {

Json to_json(const dynamics::SystemState& state) {
  return {{"q", std::vector<double>(state.q.begin(), state.q.end())},
          {"v", std::vector<double>(state.v.begin(), state.v.end())}};
}

dynamics::SystemState state_of(const Json& json) {
  const auto vector = [&](const char* key) -> Eigen::VectorXd {
    const auto list = json.at(key).get<std::vector<double>>();
    return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
  };
  dynamics::SystemState state;
  state.q = vector("q");
  state.v = vector("v");
  return state;
}

std::vector<std::size_t> in_order(const std::vector<StudyCase>& cases, SweepOrder order) {
  std::vector<std::size_t> list(cases.size());
  std::iota(list.begin(), list.end(), std::size_t{0});
  std::stable_sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) {
    const double x = cases[a].overrides.front().value, y = cases[b].overrides.front().value;
    return order == SweepOrder::rising ? x < y : y < x;
  });
  return list;
}

}  // namespace

CasePoints run_in_order(const StudySubject& subject, const std::vector<StudyCase>& cases, SweepOrder order,
                        const std::string& label) {
  const auto& figures = subject.figures();
  const std::size_t variants = subject.variants().size();
  std::vector<std::string> failures(cases.size());
  CasePoints points;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    try {
      points.tables += subject.prepare(cases[i]) ? 1 : 0;
    } catch (const SolverError& error) {
      failures[i] = error.what();
    }
  }
  auto& result = points.variants;
  result.assign(variants, std::vector<StudyPoint>(cases.size()));
  TaskProgress progress(label, cases.size() * variants);
  for_each_task(variants, subject.options().threads, [&](std::size_t variant) {
    std::optional<dynamics::SystemState> state;
    // With the version of the method.
    std::string history = order == SweepOrder::rising ? "up 1" : "down 1";
    for (const std::size_t i : in_order(cases, order)) {
      auto& point = result[variant][i];
      point.failure = failures[i];
      if (!failures[i].empty()) {
        state.reset();
        history = identity_of(history, std::string("from equilibrium"));
      } else {
        const auto model = subject.model(cases[i], variant);
        history = identity_of(history, model->id());
        const auto json = cached_response(subject.options(), "followed_points", history, [&] {
          LumpedModel::FollowedPoint followed;
          followed.point = attempted([&] {
            followed = model->followed(state ? &*state : nullptr);
            return followed.point;
          });
          Json made = {{"point", to_json(followed.point, figures)}};
          if (followed.point.failure.empty()) made["end"] = to_json(followed.end);
          return made;
        });
        point = study_point_of(json.at("point"), figures);
        state.reset();
        if (point.failure.empty()) state = state_of(json.at("end"));
      }
      progress.done();
    }
  });
  warn_of_failures(subject, cases, points);
  progress.finish(fmt::format("{} responses", cases.size() * variants));
  return points;
}

std::vector<SweepBranches> find_branches(const StudySubject& subject, std::size_t sweep) {
  const auto& input = subject.scene().sweeps.at(sweep);
  const auto values = input.points();
  const double low = *std::min_element(values.begin(), values.end());
  const double high = *std::max_element(values.begin(), values.end());
  const std::size_t variants = subject.variants().size();
  std::vector<SweepBranches> result(variants);
  for_each_task(variants, subject.options().threads, [&](std::size_t variant) {
    const auto model_at = [&](double value) {
      const auto where = fmt::format("[[sweep]] {}, branch at {} = {:.15g}", sweep + 1, input.input, value);
      // Between the values tables of their own are not solved.
      return subject.model({{{input.input, value}}, where, ""}, variant);
    };
    constexpr int samples = 64;
    auto& found = result[variant];
    try {
      const auto identity = identity_of(std::string("branches 1"), model_at(low)->id(), model_at(high)->id(),
                                        input.input, low, high, samples);
      const auto [branches, reused] = cached_value(subject.options().store.get(), "branches", identity, [&] {
        return dynamics::branches_between([&](double value) { return model_at(value)->lumped(); },
                                          {.from = low, .to = high, .samples_per_cycle = samples});
      });
      found.branches = branches;
      count_reuse(subject.options(), study_responses, reused ? 1 : 0, reused ? 0 : 1);
    } catch (const Error& error) {
      found.failure = error.what();
    }
  });
  for (std::size_t variant = 0; variant < variants; ++variant)
    if (!result[variant].failure.empty())
      log::warn(fmt::format("[[sweep]] {}, branches{}: {}", sweep + 1, variant_words(subject, variant),
                            result[variant].failure));
  return result;
}

}  // namespace annulus::app
