#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/scene/key_checks.h"
#include "app/scene/overrides.h"
#include "app/scene/scene_kind.h"

namespace annulus::app {

std::vector<double> SweepInput::points() const {
  if (!values.empty() || !from || !to || !count) return values;
  std::vector<double> list;
  const bool logarithmic = scale == SweepScale::logarithmic;
  const double a = logarithmic ? std::log(*from) : *from, b = logarithmic ? std::log(*to) : *to;
  for (int i = 0; i < *count; ++i) {
    const double x = a + (b - a) * i / (*count - 1);
    list.push_back(i == 0 ? *from : i + 1 == *count ? *to : logarithmic ? std::exp(x) : x);
  }
  return list;
}

namespace {

class StudyChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    for (std::size_t i = 0; i < scene_.sweeps.size(); ++i) row("sweep.", scene_.sweeps[i], i);
    for (std::size_t i = 0; i < scene_.grids.size(); ++i) grid(scene_.grids[i], i);
    for (std::size_t i = 0; i < scene_.random_inputs.size(); ++i) random(scene_.random_inputs[i], i);
    load_spectrum();
    for (std::size_t i = 0; i < scene_.transients.size(); ++i) transient(scene_.transients[i], i);
    optimise();
    if (scene_.monte_carlo && scene_.monte_carlo->samples == 1)
      problem("monte_carlo.samples", "one sample has no spread; give 0 for none, or 2 or more");
    if (scene_.sensitivity) {
      for (const auto& path : scene_.sensitivity->inputs) input("sensitivity.inputs", 0, path);
    }
  }

 private:
  bool input(const std::string& key, std::size_t entry, const std::string& path) {
    try {
      (void)find_input(scene_, path);
      return true;
    } catch (const InputError& error) {
      std::string what = error.what();
      const Input* named = find(key, entry);
      // "sweep.input = PATH: PATH: ..." would say it twice.
      if (named && to_text(named->value) == path && what.starts_with(path + ": ")) what.erase(0, path.size() + 2);
      problem(key, entry, what);
      return false;
    }
  }

  /// `table` with the prefix of its keys: "sweep.", "grid.x_".
  void row(const std::string& table, const SweepInput& s, std::size_t i) {
    if (!input(table + "input", i, s.input)) return;
    if (s.values.empty() && *s.from == *s.to) return problem(table + "to", i, "must differ from `from`");
    const auto points = s.points();
    const auto& parameter = *find_input(scene_, s.input).parameter;
    for (const double x : points) {
      if (parameter.in_range(x)) continue;
      const bool listed = given(table + "values", i);
      return problem(table + (listed         ? "values"
                              : x == *s.from ? "from"
                                             : "to"),
                     i, fmt::format("{} = {} must be in range: {}", s.input, to_text(x), parameter.range_text()));
    }
    if (s.scale == SweepScale::logarithmic && *std::min_element(points.begin(), points.end()) <= 0)
      problem(table + "scale", i, "needs values above 0; use \"linear\"");
  }

  void grid(const GridInput& g, std::size_t i) {
    row("grid.x_", g.x, i);
    row("grid.y_", g.y, i);
    if (g.x.input == g.y.input) problem("grid.y_input", i, "must differ from x_input");
    constexpr std::size_t most_points = 100'000;
    const auto count = [](const SweepInput& s) {
      return s.values.empty() ? static_cast<std::size_t>(s.count.value_or(0)) : s.values.size();
    };
    if (count(g.x) * count(g.y) > most_points)
      problem("grid.x_input", i,
              fmt::format("has {} x {} points, at most {} are possible; take fewer values", count(g.x), count(g.y),
                          most_points));
  }

  void load_spectrum() {
    if (!scene_.load_spectrum || !usable("load_spectrum.inputs")) return;
    const auto& inputs = scene_.load_spectrum->inputs;
    const auto& classes = scene_.load_classes;
    for (auto path = inputs.begin(); path != inputs.end(); ++path) {
      if (!input("load_spectrum.inputs", 0, *path)) return;
      if (std::find(inputs.begin(), path, *path) != path)
        return problem("load_spectrum.inputs", *path + " is named twice; leave one out");
    }
    if (classes.empty()) problem("load_spectrum.inputs", "needs a [[load_spectrum.class]] at least");
    for (std::size_t i = 0; i < classes.size(); ++i) load_class(inputs, classes[i], i);
  }

  void transient(const TransientInput& t, std::size_t i) {
    const auto before = scene_.transients.begin() + static_cast<std::ptrdiff_t>(i);
    if (usable("transient.name", i) &&
        std::any_of(scene_.transients.begin(), before, [&](const auto& other) { return other.name == t.name; }))
      problem("transient.name", i, "is the name of another course");
    if (!usable("transient.time_s", i)) return;
    if (t.time.size() < 2) return problem("transient.time_s", i, "needs two times at least");
    if (t.time.front() != 0 || std::adjacent_find(t.time.begin(), t.time.end(), std::greater_equal<>()) != t.time.end())
      return problem("transient.time_s", i, "has to rise from 0");
    for (const auto& [key, list] :
         {std::pair{"transient.speed_factor", &t.speed}, {"transient.torque_factor", &t.torque}})
      if (!list->empty() && usable(key, i) && list->size() != t.time.size())
        problem(key, i, fmt::format("needs one value per time: {} values for {} times", list->size(), t.time.size()));
    if (t.speed.empty() && t.torque.empty())
      problem("transient.time_s", i, "is a course in which nothing changes; give speed_factor or torque_factor");
  }

  void load_class(const std::vector<std::string>& inputs, const LoadClassInput& load, std::size_t i) {
    const std::string table = "load_spectrum.class.";
    if (!usable(table + "values", i) || !usable(table + "name", i)) return;
    const auto end = scene_.load_classes.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(scene_.load_classes.begin(), end, [&](const auto& other) { return other.name == load.name; }))
      problem(table + "name", i, "is the name of another class");
    if (load.values.size() != inputs.size())
      return problem(table + "values", i,
                     fmt::format("has {} values for {} inputs; give one for each", load.values.size(), inputs.size()));
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      const auto& parameter = *find_input(scene_, inputs[k]).parameter;
      if (!parameter.in_range(load.values[k]))
        problem(
            table + "values", i,
            fmt::format("{} = {} must be in range: {}", inputs[k], to_text(load.values[k]), parameter.range_text()));
    }
  }

  /// Whether a table before the `i`-th names the same input.
  template <class List>
  static bool repeated(const List& list, std::size_t i) {
    const auto end = list.begin() + static_cast<std::ptrdiff_t>(i);
    return std::any_of(list.begin(), end, [&](const auto& other) { return other.input == list[i].input; });
  }

  void random(const RandomInput& r, std::size_t i) {
    const std::string table = "monte_carlo.input.";
    for (const auto& path : expand_planets(scene_, r.input)) {
      if (!input(table + "input", i, path)) return;
    }
    if (repeated(scene_.random_inputs, i))
      problem(table + "input", i, "is declared twice: each input has one distribution; leave one out");
  }

  void optimise() {
    if (!scene_.optimise) return;
    const auto& o = *scene_.optimise;
    const auto known = scene_kind(scene_.stage.kind).results();
    for (const auto& figure : o.objective) {
      if (std::find(known.begin(), known.end(), figure) != known.end()) continue;
      problem("optimise.objective", fmt::format("there is no result \"{}\"{}", figure,
                                                did_you_mean(figure, known, "; annulus explain lists the results")));
    }
    if (!o.weights.empty() && o.weights.size() != o.objective.size())
      problem("optimise.weights", fmt::format("needs one weight per result: {} weights for {} results",
                                              o.weights.size(), o.objective.size()));
    if (o.population % 2) problem("optimise.population", "must be even: parents are crossed in pairs");
    const auto variants = variant_names(scene_);
    if (o.variant && std::find(variants.begin(), variants.end(), *o.variant) == variants.end()) {
      const auto word = variant_word(scene_.stage.kind);
      problem("optimise." + word, fmt::format("there is no {} of this name in the scene", word));
    }
    if (scene_.variables.empty()) problem("optimise.objective", "needs an [[optimise.variable]] at least");
    for (std::size_t i = 0; i < scene_.variables.size(); ++i) variable(scene_.variables[i], i);
  }

  void variable(const VariableInput& v, std::size_t i) {
    const std::string table = "optimise.variable.";
    if (!input(table + "input", i, v.input)) return;
    if (repeated(scene_.variables, i)) return problem(table + "input", i, "is declared twice; leave one out");
    const auto& parameter = *find_input(scene_, v.input).parameter;
    for (const auto& [key, value] : {std::pair{"low", v.low}, {"high", v.high}}) {
      if (!parameter.in_range(value))
        problem(table + key, i,
                fmt::format("{} = {} must be in range: {}", v.input, to_text(value), parameter.range_text()));
    }
    if (!(v.low < v.high))
      problem(table + "high", i, fmt::format("{} must be larger than low = {}", to_text(v.high), to_text(v.low)));
    if (v.scale == SweepScale::logarithmic && v.low <= 0)
      problem(table + "scale", i, "needs values above 0; use \"linear\"");
    const bool whole = parameter.kind == Parameter::Kind::integer;
    if (whole && (v.low != std::floor(v.low) || v.high != std::floor(v.high)))
      problem(table + "low", i, v.input + " is a whole number; its limits must be whole numbers");
  }
};

}  // namespace

void check_study_keys(Scene& scene, std::vector<Problem>& problems) { StudyChecker(scene, problems).run(); }

}  // namespace annulus::app
