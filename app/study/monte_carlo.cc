#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/run_options.h"
#include "app/model/study_cases.h"
#include "app/process/progress.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {

const std::string failure_of = "failure_";
constexpr const char* sample_chunks = "samples";
constexpr int chunk_size = 20;  // samples cached together: the most that an interruption costs, per thread

std::vector<std::string> quick_keys(const std::vector<FigureSpec>& figures) {
  std::vector<std::string> names;
  for (const auto& figure : figures) {
    if (figure.effort != FigureEffort::motion) names.push_back(figure.key);
  }
  return names;
}

/// All samples of one variant, cached in chunks.
class SampleStore {
 public:
  SampleStore(const StudySubject& subject, std::size_t variant, const std::vector<RandomVariable>& variables)
      : subject_(subject),
        variant_(variant),
        variables_(variables),
        figures_(quick_keys(subject.figures())),
        id_(identity()) {}

  /// Samples first ... last - 1, within one chunk: those cached, and the others found and cached with them.
  [[nodiscard]] Csv chunk(int first, int last) const {
    const auto id = fmt::format("{} from {}", id_, first);
    Csv csv = cached(id);
    const auto before = csv.rows.size(), wanted = static_cast<std::size_t>(last - first);
    const auto reused = std::min(before, wanted);
    count_reuse(subject_.options(), study_responses, static_cast<long>(reused), static_cast<long>(wanted - reused));
    for (int sample = first + static_cast<int>(before); sample < last; ++sample) add(csv, sample);
    const auto& store = subject_.options().store;
    if (store && csv.rows.size() > before) store->keep(sample_chunks, id, csv.text());
    csv.rows.resize(wanted);  // an earlier run may have kept more
    std::erase_if(csv.header, [&](const auto& line) {
      return line.first.starts_with(failure_of) && std::stoi(line.first.substr(failure_of.size())) > last;
    });
    return csv;
  }

  [[nodiscard]] std::vector<std::string> columns() const {
    std::vector<std::string> names = {"sample", "failed"};
    for (const auto& variable : variables_) names.push_back(file_name(variable.input));
    names.insert(names.end(), figures_.begin(), figures_.end());
    return names;
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> header() const {
    return {{"annulus_version", version()}, {"inputs_id", id_}};
  }

 private:
  /// Of everything a sample depends on: the scene, the tables, the distributions and the seed; not of their number.
  [[nodiscard]] std::string identity() const {
    const auto& scene = subject_.scene();
    ContentId id;
    id.add("response", subject_.model({}, "[monte_carlo]", variant_, "")->id());
    id.add("seed", scene.monte_carlo->seed);
    for (const auto& input : scene.inputs) {
      if (input.key == "title" || input.key == "reference" || is_study_table(input.key.substr(0, input.key.rfind('.'))))
        continue;
      const auto* number = std::get_if<double>(&input.value);
      const auto* list = std::get_if<std::vector<double>>(&input.value);
      const std::string name = input.key + "." + input.ring;
      if (number) {
        id.add(name, *number);
      } else if (list) {
        for (const double x : *list) id.add(name, x);
      } else {
        id.add(name, to_text(input.value));
      }
    }
    for (const auto& v : variables_) {
      const auto& d = v.distribution;
      id.add("draw", v.input).add("kind", static_cast<int>(d.kind)).add("mean", d.mean).add("deviation", d.deviation);
      id.add("low", d.low).add("high", d.high);
    }
    return id.id();
  }

  /// The rows cached under this identity, else none.
  [[nodiscard]] Csv cached(const std::string& id) const {
    const auto& store = subject_.options().store;
    if (const auto found = store ? store->find(sample_chunks, id) : std::nullopt)
      return Csv::parse(*found, sample_chunks);
    return {.header = header(), .columns = columns(), .rows = {}};
  }

  void add(Csv& csv, int sample) const {
    const auto drawn = sample_case(variables_, subject_.scene().monte_carlo->seed, sample);
    StudyPoint point;
    try {
      point = evaluate(*subject_.model(drawn.overrides, drawn.where, variant_, ""), Answer::without_motion);
    } catch (const InputError& error) {
      point.failure = error.what();  // a combination of draws that makes no stage
    }
    auto& row = csv.rows.emplace_back();
    row = {static_cast<double>(sample + 1), point.failure.empty() ? 0.0 : 1.0};
    for (const auto& change : drawn.overrides) row.push_back(change.value);
    for (const auto& key : figures_) row.push_back(point.value(key));
    if (point.failure.empty()) return;
    std::replace(point.failure.begin(), point.failure.end(), '\n', ' ');
    csv.header.emplace_back(failure_of + std::to_string(sample + 1), point.failure);
  }

  const StudySubject& subject_;
  std::size_t variant_;
  const std::vector<RandomVariable>& variables_;
  std::vector<std::string> figures_;  ///< keys
  std::string id_;
};

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

}  // namespace

MonteCarloResult run_monte_carlo(const StudySubject& subject) {
  const auto& settings = *subject.scene().monte_carlo;
  const auto variables = random_variables(subject.scene());
  const auto& figures = subject.figures();
  const auto names = subject.variants();
  std::vector<SampleStore> stores;
  for (std::size_t i = 0; i < names.size(); ++i) stores.emplace_back(subject, i, variables);

  const int chunks = (settings.samples + chunk_size - 1) / chunk_size;
  std::vector<std::vector<Csv>> found(names.size(), std::vector<Csv>(static_cast<std::size_t>(chunks)));
  const auto tasks = static_cast<std::size_t>(chunks) * names.size();
  TaskProgress progress("Monte Carlo", tasks);
  for_each_task(tasks, subject.options().threads, [&](std::size_t task) {
    // All variants of a chunk first: an interrupted run has paired samples.
    const std::size_t variant = task % names.size(), chunk = task / names.size();
    const int first = static_cast<int>(chunk) * chunk_size;
    found[variant][chunk] = stores[variant].chunk(first, std::min(first + chunk_size, settings.samples));
    progress.done();
  });

  MonteCarloResult result{.samples = settings.samples, .seed = settings.seed};
  for (const auto& variable : variables) result.inputs.push_back(variable.input);
  int failures = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    VariantSamples variant;
    variant.samples.header = stores[i].header();
    variant.samples.columns = stores[i].columns();
    for (const auto& chunk : found[i]) {
      variant.samples.rows.insert(variant.samples.rows.end(), chunk.rows.begin(), chunk.rows.end());
      variant.samples.header.insert(variant.samples.header.end(), chunk.header.begin() + 2, chunk.header.end());
    }
    const auto failed = variant.samples.column("failed"), steady = variant.samples.column("steady");
    for (const auto& row : variant.samples.rows) {
      variant.failed += row[failed] != 0 ? 1 : 0;
      variant.not_steady += row[failed] == 0 && row[steady] == 0 ? 1 : 0;
    }
    failures += variant.failed;
    variant.statistics = statistics_of(variant.samples, quick_keys(figures));
    std::filesystem::create_directories(subject.folder(i));
    variant.samples.write(subject.folder(i) / "monte_carlo.csv");
    if (variant.failed)
      log::warn(fmt::format("Monte Carlo{}: {} of {} samples failed; monte_carlo.csv states why",
                            names[i].empty() ? "" : ", ring '" + names[i] + "'", variant.failed, settings.samples));
    result.variants.push_back(std::move(variant));
  }
  for (const auto& figure : figures) {
    if (!figure.ordering) continue;
    for (std::size_t a = 0; a < names.size(); ++a) {
      for (std::size_t b = a + 1; b < names.size(); ++b)
        result.orders.push_back(paired_order(result.variants, a, b, figure.key));
    }
  }
  progress.finish(fmt::format("{} samples{}{}", settings.samples,
                              names.size() > 1 ? fmt::format(" × {} rings", names.size()) : "",
                              failures ? fmt::format(", {} failed", failures) : ""));
  return result;
}

}  // namespace annulus::app
