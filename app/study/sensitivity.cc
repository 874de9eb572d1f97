#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/model/run_options.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "core/files.h"

namespace annulus::app {

namespace {

/// Variants by falling value of the ordering figure; empty when one failed.
std::vector<std::size_t> order_of(const std::vector<StudyPoint>& variants, const std::string& figure) {
  std::vector<std::size_t> order(variants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (std::any_of(variants.begin(), variants.end(), [](const auto& point) { return !point.failure.empty(); }))
    return {};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return variants[a].value(figure) > variants[b].value(figure); });
  return order;
}

/// Input and ring are words, so the file is no table of numbers alone.
std::string sensitivity_csv(const StudySubject& subject, const SensitivityResult& result) {
  std::string text =
      fmt::format("# annulus_version: {}\n# factor: {:.17g}\ninput,ring,value", version(), result.factor);
  const auto& figures = subject.figures();
  const auto names = subject.variants();
  for (const auto* which : {"divided_", "nominal_", "multiplied_"}) {
    for (const auto& figure : figures) text += std::string(",") + which + figure.key;
  }
  text += ",order_of_rings_stays\n";
  for (const auto& row : result.rows) {
    for (std::size_t variant = 0; variant < names.size(); ++variant) {
      text += fmt::format("{},{},{:.17g}", row.input, names[variant], row.values[variant]);
      for (const auto* point : {&row.divided[variant], &result.nominal[variant], &row.multiplied[variant]}) {
        for (const auto& figure : figures) text += fmt::format(",{:.17g}", point->value(figure.key));
      }
      text += row.order_stays ? ",1\n" : ",0\n";
    }
  }
  return text;
}

}  // namespace

SensitivityResult run_sensitivity(const StudySubject& subject) {
  const auto& scene = subject.scene();
  const auto inputs = sensitivity_inputs(scene);
  auto cases = sensitivity_cases(scene);
  cases.push_back({{}, "[sensitivity] nominal", ""});
  const auto points = run_cases(subject, cases, "sensitivity");
  const auto column = [&](std::size_t i) {
    std::vector<StudyPoint> list;
    for (const auto& variant : points.variants) list.push_back(variant[i]);
    return list;
  };
  const auto* ordering = ordering_figure(subject.figures());
  const std::string figure = ordering ? ordering->key : "";
  SensitivityResult result{scene.sensitivity->factor, column(cases.size() - 1), {}};
  const auto order = order_of(result.nominal, figure);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto target = find_input(scene, inputs[i]);
    SensitivityRow row{inputs[i], target.parameter->unit, {}, column(2 * i), column(2 * i + 1), false};
    for (std::size_t variant = 0; variant < points.variants.size(); ++variant) {
      const bool has =
          target.rings.empty() || std::find(target.rings.begin(), target.rings.end(), variant) != target.rings.end();
      row.values.push_back(has ? input_value(scene, target, variant).value_or(0) : not_known);
    }
    row.order_stays =
        !order.empty() && order_of(row.divided, figure) == order && order_of(row.multiplied, figure) == order;
    result.rows.push_back(std::move(row));
  }
  const auto& out = subject.options().out;
  std::filesystem::create_directories(out);
  write_file(out / "sensitivity.csv", sensitivity_csv(subject, result));
  return result;
}

}  // namespace annulus::app
