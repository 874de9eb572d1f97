#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "app/model/run_options.h"
#include "app/process/progress.h"
#include "app/results/content_id.h"
#include "app/scene/scene_files.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/not_known.h"
#include "core/parallel.h"

namespace annulus::app {

namespace {

/// The objective of one scene: figures of one variant over changed inputs.
class DesignObjective {
 public:
  explicit DesignObjective(const StudySubject& subject)
      : subject_(subject),
        scene_(subject.scene()),
        settings_(*scene_.optimise),
        figures_(subject.figures()),
        variant_(variant_of(subject)) {
    quick_ = !asks_for_motion(settings_, figures_);
    weights_ = settings_.weights;
    const auto n = static_cast<double>(settings_.objective.size());
    if (weights_.empty()) weights_.assign(settings_.objective.size(), 1 / n);
  }

  [[nodiscard]] std::size_t variant() const { return variant_; }
  [[nodiscard]] bool quick() const { return quick_; }
  /// What the search asks of the model.
  [[nodiscard]] Answer searched() const { return quick_ ? Answer::without_motion : Answer::all; }
  /// What is made small is this times the objective.
  [[nodiscard]] double sign() const { return settings_.goal == Goal::smallest ? 1 : -1; }

  [[nodiscard]] double value(const StudyPoint& point) const {
    double sum = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) sum += weights_[i] * point.value(settings_.objective[i]);
    return sum;
  }

  /// Why the point has no value; empty when it has. Figures of a motion that does not repeat depend on where the
  /// integration happened to end: noise, among which a search finds its luck.
  [[nodiscard]] std::string trouble(const StudyPoint& point) const {
    if (!point.failure.empty()) return point.failure;
    return point.value("steady") == 0 ? "the motion does not become periodic" : "";
  }

  /// The error of the objective at the scene as given, as far as its results have errors.
  [[nodiscard]] double numerical_error() const {
    const auto nominal = subject_.nominal(variant_);
    double error = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const double known = nominal.figure(settings_.objective[i]).error;
      if (std::isfinite(known)) error += std::abs(weights_[i]) * known;
    }
    return error;
  }

  [[nodiscard]] std::vector<Override> overrides(const std::vector<double>& x) const {
    std::vector<Override> list;
    for (std::size_t i = 0; i < x.size(); ++i) list.push_back({scene_.variables[i].input, x[i]});
    return list;
  }

  [[nodiscard]] StudyCase study_case(const std::vector<double>& x) const {
    std::string text, folder = "optimise";
    for (std::size_t i = 0; i < x.size(); ++i) {
      text += fmt::format("{}{} = {}", i ? ", " : "", scene_.variables[i].input, to_text(x[i], 6));
      folder += fmt::format("/{}_{}", file_name(scene_.variables[i].input), to_text(x[i], 17));
    }
    return {overrides(x), "[optimise] (" + text + ")", folder};
  }

  /// Whatever is wrong at x fails the point alone. Any number of threads at once.
  [[nodiscard]] StudyPoint evaluate(const std::vector<double>& x, Answer wanted) const {
    return attempted([&] { return model(study_case(x))->answer(wanted); });
  }

  /// Cached, or found and cached.
  [[nodiscard]] Design design(const std::vector<double>& x) const {
    ContentId id;
    try {
      id.add("design", model(study_case(x))->id());
    } catch (const Error&) {
      return found_design(x);  // fails the same way, and states why
    }
    id.add("quick", quick_ ? 1 : 0).add("starts", settings_.starts).add("seed", settings_.seed);
    auto design = design_of(
        cached_response(subject_.options(), "designs", id.id(), [&] { return to_json(found_design(x), figures_); }), x,
        figures_);
    design.objective = value(design.point);
    return design;
  }

  [[nodiscard]] std::vector<double> given() const {
    std::vector<double> x;
    for (const auto& v : scene_.variables)
      x.push_back(value_in_variant(scene_, find_input(scene_, v.input), variant_).value_or(not_known));
    return x;
  }

 private:
  /// Tables that it needs are solved first: elements with all threads, one table after another.
  [[nodiscard]] std::unique_ptr<LumpedModel> model(const StudyCase& changed) const {
    {
      std::unique_lock lock(solving_, std::defer_lock);
      if (subject_.solves_elements()) lock.lock();
      subject_.prepare(changed);
    }
    return subject_.model(changed, variant_);
  }

  [[nodiscard]] Design found_design(const std::vector<double>& x) const {
    Design d{.x = x, .objective = 0, .point = evaluate(x, Answer::all), .starts = std::nullopt};
    if (quick_ && d.point.failure.empty()) {
      // The same numbers as the search saw: the motion is sampled otherwise.
      const auto as_searched = evaluate(x, Answer::without_motion);
      for (const auto& figure : figures_)
        if (figure.effort != FigureEffort::motion) d.point.figures.set(figure.key, as_searched.value(figure.key));
    }
    d.objective = value(d.point);
    if (d.point.failure.empty() && settings_.starts != 0)
      d.starts = model(study_case(x))->starts(settings_.starts, settings_.seed);
    return d;
  }

  static std::size_t variant_of(const StudySubject& subject) {
    const auto& variant = subject.scene().optimise->variant;
    if (!variant) return 0;
    const auto& names = subject.variants();
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), *variant) - names.begin());
  }
  const StudySubject& subject_;
  const Scene& scene_;
  const OptimiseInput& settings_;
  const std::vector<FigureSpec>& figures_;
  std::size_t variant_ = 0;
  std::vector<double> weights_;
  bool quick_ = true;
  mutable std::mutex solving_;
};

std::vector<dynamics::OptimiseVariable> search_variables(const Scene& scene) {
  std::vector<dynamics::OptimiseVariable> list;
  for (const auto& v : scene.variables)
    list.push_back({.name = v.input,
                    .low = v.low,
                    .high = v.high,
                    .logarithmic = v.scale == SweepScale::logarithmic,
                    .whole = find_input(scene, v.input).parameter->kind == Parameter::Kind::integer});
  return list;
}

dynamics::OptimiseOptions search_options(const OptimiseInput& s, const std::string& optimiser, int repeat) {
  const auto& names = optimiser_names();
  constexpr dynamics::Optimiser kinds[] = {dynamics::Optimiser::genetic, dynamics::Optimiser::cma_es,
                                           dynamics::Optimiser::differential_evolution};
  // The scene has been checked: it is one of these.
  return {.optimiser = kinds[std::find(names.begin(), names.end(), optimiser) - names.begin()],
          .generations = s.generations,
          .population = s.population,
          .seed = static_cast<std::uint64_t>(s.seed) + static_cast<std::uint64_t>(repeat),
          .elite = s.elite,
          .crossover = s.crossover,
          .mutation = s.mutation};
}

struct FoundSearch {
  OptimiseRun run;
  Csv answers;  ///< of the model
};

std::size_t number_of_searches(const OptimiseInput& settings) {
  return settings.optimisers.size() * static_cast<std::size_t>(settings.repeats);
}

/// The place in a list at which a worker begins: those of all workers are spread over it.
std::size_t first_place(std::size_t size, const Worker& worker) {
  return size * static_cast<std::size_t>(worker.number - 1) / static_cast<std::size_t>(worker.count);
}

/// Calls `task` for a list of points on some threads. Of several workers each begins at its own place of the list: none
/// waits for another, and they meet only where one of them is slower.
void for_each_point(const std::vector<std::vector<double>>& points, const Worker& worker, int threads,
                    const std::function<void(const std::vector<double>&)>& task) {
  const auto first = first_place(points.size(), worker);
  for_each_task(points.size(), threads, [&](std::size_t i) { task(points[(first + i) % points.size()]); });
}

FoundSearch search(const StudySubject& subject, const DesignObjective& objective, const std::string& optimiser,
                   int repeat, int threads, TaskProgress& progress) {
  const auto& scene = subject.scene();
  // The answers depend on the scene, not on how the search goes on; what is cached together is one search's.
  const auto id = ContentId()
                      .add("model", subject.model({.where = "[optimise]"}, objective.variant())->id())
                      .add("optimiser", optimiser)
                      .add("repeat", repeat)
                      .id();
  PointColumns columns{.header = {{"inputs_id", id}}};
  for (const auto& v : scene.variables) columns.inputs.push_back(file_name(v.input));
  for (const auto& f : subject.figures())
    if (f.effort != FigureEffort::motion || !objective.quick()) columns.results.push_back(f.key);
  const auto& worker = subject.options().worker;
  PointTable points(subject.options().store.get(), "searches", id, columns, subject.figures(),
                    worker.count > 1 ? PointTable::Work::together : PointTable::Work::alone);
  const auto point_at = [&](const std::vector<double>& x) -> const StudyPoint& {
    return points.point(x, [&] { return objective.evaluate(x, objective.searched()); });
  };
  const auto ahead = [&](const std::vector<std::vector<double>>& list) {
    for_each_point(list, worker, threads, [&](const std::vector<double>& x) { (void)point_at(x); });
  };
  const auto answer = [&](const std::vector<double>& x) {
    const auto& point = point_at(x);
    if (const auto trouble = objective.trouble(point); !trouble.empty()) throw SolverError(trouble);
    return objective.sign() * objective.value(point);
  };
  const auto options = search_options(*scene.optimise, optimiser, repeat);
  OptimiseRun run{.optimiser = optimiser, .repeat = repeat + 1, .search = {}};
  run.search = dynamics::optimise(
      search_variables(scene), answer, options, [&](const auto&) { progress.done(); }, ahead);
  run.reused = points.reused();
  points.save();
  count_reuse(subject.options(), search_evaluations, run.reused,
              static_cast<long>(run.search.evaluations.size()) - run.reused);
  // Not in the order in which threads and workers found them, and without those of an earlier, longer search.
  std::vector<std::vector<double>> asked;
  for (const auto& evaluation : run.search.evaluations) asked.push_back(evaluation.x);
  points.restrict_to(asked);
  return {std::move(run), points.table()};
}

/// By its number among all searches.
FoundSearch numbered_search(const StudySubject& subject, const DesignObjective& objective, std::size_t number,
                            int threads, TaskProgress& progress) {
  const auto& settings = *subject.scene().optimise;
  const auto repeats = static_cast<std::size_t>(settings.repeats);
  return search(subject, objective, settings.optimisers[number / repeats], static_cast<int>(number % repeats), threads,
                progress);
}

/// Searches at once, as far as threads reach; threads that are left compute points of one search at once.
void for_each_search(const StudySubject& subject, std::size_t count,
                     const std::function<void(std::size_t search, int threads)>& task) {
  const int threads = subject.options().threads;
  const int at_once = std::min(threads, static_cast<int>(count));
  for_each_task(count, at_once, [&](std::size_t i) { task(i, threads / at_once); });
}

/// The answers and the course of every search, and the best design as a scene.
void write_searches(const StudySubject& subject, const OptimiseResults& result, const std::vector<Csv>& answers,
                    const DesignObjective& objective) {
  const double sign = objective.sign();
  const auto folder = subject.folder(result.variant) / "optimise";
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const auto& run = result.runs[i];
    answers[i].write(folder / fmt::format("{}_{}.csv", run.optimiser, run.repeat));
    Csv csv;
    csv.header = {{"annulus_version", version()}, {"optimiser", run.optimiser}, {"stopped", run.search.stopped}};
    csv.columns = {"generation", "evaluations", "best", "mean", "worst", "failed"};
    for (const auto& g : run.search.history)
      csv.rows.push_back({static_cast<double>(g.generation), static_cast<double>(g.evaluations), sign * g.best,
                          sign * g.mean, sign * g.worst, static_cast<double>(g.failed)});
    csv.write(folder / fmt::format("{}_{}_history.csv", run.optimiser, run.repeat));
  }
  write_file(folder / "best.toml", scene_text(subject.scene(), objective.overrides(result.best.x)));
  // Its paths are relative to it.
  for (const auto& name : input_files(subject.scene())) {
    std::filesystem::create_directories((folder / name).parent_path());
    write_file(folder / name, read_file(subject.scene().file.parent_path() / name));
  }
}

}  // namespace

const std::vector<std::string>& optimiser_names() {
  static const std::vector<std::string> names = {"genetic", "cma_es", "differential_evolution"};
  return names;
}

void compute_searches(const StudySubject& subject, const std::vector<std::size_t>& numbers) {
  const auto& settings = *subject.scene().optimise;
  const DesignObjective objective(subject);
  TaskProgress progress("optimisation", numbers.size() * static_cast<std::size_t>(settings.generations + 1));
  // All workers take part in every search, and each begins with another one.
  const auto first = first_place(numbers.size(), subject.options().worker);
  for_each_search(subject, numbers.size(), [&](std::size_t i, int threads) {
    const auto number = numbers[(first + i) % numbers.size()];
    (void)numbered_search(subject, objective, number, threads, progress);
  });
  progress.finish(fmt::format("{} searches", numbers.size()));
}

OptimiseResults run_optimise(const StudySubject& subject) {
  const auto& scene = subject.scene();
  const auto& settings = *scene.optimise;
  const DesignObjective objective(subject);
  OptimiseResults result{
      .settings = settings, .variables = scene.variables, .units = {}, .variant = objective.variant()};
  for (const auto& v : scene.variables) result.units.push_back(unit_of_input(scene, v.input));

  const std::size_t tasks = number_of_searches(settings);
  result.runs.resize(tasks);
  std::vector<Csv> answers(tasks);
  TaskProgress progress("optimisation", tasks * static_cast<std::size_t>(settings.generations + 1));
  for_each_search(subject, tasks, [&](std::size_t task, int threads) {
    auto found = numbered_search(subject, objective, task, threads, progress);
    result.runs[task] = std::move(found.run);
    answers[task] = std::move(found.answers);
  });
  std::vector<dynamics::OptimiseEvaluation> all;
  for (std::size_t i = 0; i < tasks; ++i) {
    const auto& search = result.runs[i].search;
    if (search.value < result.runs[result.best_run].search.value) result.best_run = i;
    all.insert(all.end(), search.evaluations.begin(), search.evaluations.end());
  }
  result.given = objective.design(objective.given());
  result.best = objective.design(result.runs[result.best_run].search.x);
  result.numerical_error = objective.numerical_error();
  result.range = dynamics::objective_range(all, result.numerical_error);
  const double best = result.runs[result.best_run].search.value;
  const double gain = std::isfinite(result.given.objective) ? std::abs(result.given.objective - result.best.objective)
                                                            : result.range.high - result.range.low;
  for (const auto& run : result.runs)
    result.evaluations_to_best.push_back(dynamics::evaluations_to_reach(
        run.search.evaluations, best, std::max(result.range.least_meaning, 0.01 * gain)));
  write_searches(subject, result, answers, objective);
  progress.finish(fmt::format("{} evaluations, best {}", all.size(), to_text(result.best.objective, 6)));
  return result;
}

}  // namespace annulus::app
