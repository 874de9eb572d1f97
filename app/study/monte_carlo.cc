#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

#include "app/model/run_options.h"
#include "app/process/progress.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "core/log.h"
#include "core/parallel.h"

namespace annulus::app {

namespace {

std::vector<std::string> quick_keys(const std::vector<FigureSpec>& figures) {
  std::vector<std::string> names;
  for (const auto& figure : figures)
    if (figure.effort != FigureEffort::motion) names.push_back(figure.key);
  return names;
}

/// Everything a sample depends on: the scene, the tables, the distributions and the seed; not their number.
std::string samples_id(const StudySubject& subject, std::size_t variant, const Sampling& sampling) {
  const auto& scene = subject.scene();
  ContentId id;
  id.add("response", subject.model({.where = "[monte_carlo]"}, variant)->id());
  id.add("seed", sampling.seed);
  for (const auto& input : scene.inputs) {
    if (input.key == "title" || input.key == "reference" || input.key.starts_with("report.") ||
        is_study_table(input.key.substr(0, input.key.rfind('.'))))
      continue;
    const auto* number = std::get_if<double>(&input.value);
    const auto* list = std::get_if<std::vector<double>>(&input.value);
    const std::string name = input.key + "." + input.variant;
    if (number) {
      id.add(name, *number);
    } else if (list) {
      for (const double x : *list) id.add(name, x);
    } else {
      id.add(name, to_text(input.value));
    }
  }
  for (const auto& v : sampling.variables) {
    const auto& d = v.distribution;
    id.add("draw", v.input).add("kind", static_cast<int>(d.kind)).add("mean", d.mean).add("deviation", d.deviation);
    id.add("low", d.low).add("high", d.high);
  }
  return id.id();
}

/// Sample, failed, inputs drawn, results.
Csv samples_table(const PointTable& points) {
  auto csv = points.table();
  const auto failed = static_cast<std::ptrdiff_t>(csv.column("failed"));
  const auto second = [&](auto& list) {
    std::rotate(list.begin() + 1, list.begin() + failed, list.begin() + failed + 1);
  };
  second(csv.columns);
  for (auto& row : csv.rows) second(row);
  return csv;
}

std::vector<FigureStatistics> statistics_of(const Csv& samples, const std::vector<std::string>& figures) {
  std::vector<FigureStatistics> list;
  const auto failed = samples.column("failed");
  for (const auto& figure : figures) {
    if (figure == "steady") continue;
    const auto column = samples.column(figure);
    std::vector<double> values;
    for (const auto& row : samples.rows) {
      if (row[failed] == 0) values.push_back(row[column]);
    }
    if (values.empty()) continue;
    list.push_back({figure, dynamics::mean_interval(values), dynamics::standard_deviation(values),
                    dynamics::quantile_interval(values, 0.05), dynamics::quantile_interval(values, 0.5),
                    dynamics::quantile_interval(values, 0.95)});
  }
  return list;
}

PairedOrder paired_order(const std::vector<VariantSamples>& variants, std::size_t a, std::size_t b,
                         const std::string& figure) {
  PairedOrder order{.a = a, .b = b, .figure = figure};
  std::vector<double> differences;
  const auto& first = variants[a].samples;
  const auto& second = variants[b].samples;
  const auto column = first.column(figure), failed = first.column("failed");
  for (std::size_t i = 0; i < first.rows.size(); ++i) {
    if (first.rows[i][failed] != 0 || second.rows[i][failed] != 0) continue;
    ++order.samples;
    differences.push_back(first.rows[i][column] - second.rows[i][column]);
    if (first.rows[i][column] > second.rows[i][column]) ++order.above;
    if (first.rows[i][column] == second.rows[i][column]) ++order.equal;
  }
  if (order.samples == 0) return order;
  order.share = dynamics::share_interval(order.above, order.samples);
  order.difference = dynamics::mean_interval(differences);
  return order;
}

/// The samples of all variants as they become known.
class Samples {
 public:
  Samples(const StudySubject& subject, const Sampling& settings) : subject_(subject), settings_(settings) {
    PointColumns columns{.inputs = {"sample"}, .results = quick_keys(subject.figures())};
    for (const auto& variable : settings.variables) columns.inputs.push_back(file_name(variable.input));
    for (std::size_t i = 0; i < subject.variants().size(); ++i) {
      const auto id = samples_id(subject, i, settings);
      columns.header = {{"inputs_id", id}};
      tables_.emplace_back(subject.options().store.get(), "samples", id, columns, subject.figures());
    }
  }

  /// Samples numbered from 0. Saved now and then, and at the end.
  void compute(const std::vector<int>& numbers, TaskProgress& progress) {
    const std::size_t variants = tables_.size();
    for_each_task(numbers.size() * variants, subject_.options().threads, [&](std::size_t task) {
      // All variants of a sample first: an interrupted run has paired samples.
      const std::size_t variant = task % variants;
      const int sample = numbers[task / variants];
      // A combination of draws that makes no stage is a failure too.
      const auto respond = [&] {
        const auto drawn = sample_case(settings_.variables, settings_.seed, sample);
        return subject_.model(drawn, variant)->answer(Answer::without_motion);
      };
      (void)tables_[variant].point(drawn(sample), [&] { return attempted(respond); });
      progress.done();
    });
    for (auto& table : tables_) table.save();
  }

  /// The samples of a variant, when all are computed.
  PointTable& of(std::size_t variant) {
    std::vector<std::vector<double>> inputs;
    for (int sample = 0; sample < settings_.samples; ++sample) inputs.push_back(drawn(sample));
    tables_[variant].restrict_to(inputs);
    return tables_[variant];
  }

 private:
  /// Number of the sample from 1, and what is drawn for it.
  [[nodiscard]] std::vector<double> drawn(int sample) const {
    std::vector<double> list(1, sample + 1);
    for (const auto& variable : settings_.variables) list.push_back(draw(variable, settings_.seed, sample));
    return list;
  }

  const StudySubject& subject_;
  const Sampling& settings_;
  std::deque<PointTable> tables_;
};

}  // namespace

void compute_samples(const StudySubject& subject, const Sampling& settings, const std::vector<int>& numbers) {
  TaskProgress progress("Monte Carlo", numbers.size() * subject.variants().size());
  Samples(subject, settings).compute(numbers, progress);
  progress.finish(fmt::format("{} samples", numbers.size()));
}

MonteCarloResult run_monte_carlo(const StudySubject& subject, const Sampling& settings) {
  const auto& variables = settings.variables;
  const auto& figures = subject.figures();
  const auto names = subject.variants();
  const auto& options = subject.options();
  Samples samples(subject, settings);
  TaskProgress progress("Monte Carlo", static_cast<std::size_t>(settings.samples) * names.size());
  std::vector<int> all(static_cast<std::size_t>(settings.samples));
  std::iota(all.begin(), all.end(), 0);
  samples.compute(all, progress);

  MonteCarloResult result{.samples = settings.samples, .seed = settings.seed, .by_default = settings.by_default};
  for (const auto& variable : variables) result.inputs.push_back(variable.input);
  int failures = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    VariantSamples variant;
    const auto& table = samples.of(i);
    count_reuse(options, study_responses, table.reused(), settings.samples - table.reused());
    variant.samples = samples_table(table);
    const auto failed = variant.samples.column("failed"), steady = variant.samples.column("steady");
    for (const auto& row : variant.samples.rows) {
      variant.failed += row[failed] != 0 ? 1 : 0;
      variant.not_steady += row[failed] == 0 && row[steady] == 0 ? 1 : 0;
    }
    failures += variant.failed;
    variant.statistics = statistics_of(variant.samples, quick_keys(figures));
    variant.samples.write(subject.folder(i) / "monte_carlo.csv");
    if (variant.failed)
      log::warn(fmt::format("Monte Carlo{}: {} of {} samples failed; monte_carlo.csv states why",
                            variant_words(subject, i), variant.failed, settings.samples));
    result.variants.push_back(std::move(variant));
  }
  for (const auto& figure : figures) {
    if (!figure.ordering) continue;
    for (std::size_t a = 0; a < names.size(); ++a) {
      for (std::size_t b = a + 1; b < names.size(); ++b)
        result.orders.push_back(paired_order(result.variants, a, b, figure.key));
    }
  }
  progress.finish(fmt::format(
      "{} samples{}{}", settings.samples,
      names.size() > 1 ? fmt::format(" × {} {}s", names.size(), variant_word(subject.scene().stage.kind)) : "",
      failures ? fmt::format(", {} failed", failures) : ""));
  return result;
}

}  // namespace annulus::app
