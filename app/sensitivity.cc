#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "app/content_id.h"
#include "app/studies.h"
#include "app/study_runner.h"

namespace annulus::app {

namespace {

/// Rings by falling load sharing; empty when one failed.
std::vector<std::size_t> order_of(const std::vector<StudyPoint>& rings) {
  std::vector<std::size_t> order(rings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const auto& point : rings) {
    if (!point.failure.empty()) return {};
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return rings[a].figures.sun_planet.averaged > rings[b].figures.sun_planet.averaged;
  });
  return order;
}

/// Input and ring are words, so the file is no table of numbers alone.
std::string sensitivity_csv(const RunResult& nominal, const SensitivityResult& result) {
  std::string text =
      fmt::format("# annulus_version: {}\n# factor: {:.17g}\ninput,ring,value", version(), result.factor);
  const auto columns = figure_columns(true);
  for (const auto* which : {"divided_", "nominal_", "multiplied_"}) {
    for (const auto& column : columns) text += std::string(",") + which + column;
  }
  text += ",order_of_rings_stays\n";
  for (const auto& row : result.rows) {
    for (std::size_t ring = 0; ring < nominal.rings.size(); ++ring) {
      text += fmt::format("{},{},{:.17g}", row.input, nominal.rings[ring].name, row.values[ring]);
      for (const auto* point : {&row.divided[ring], &result.nominal[ring], &row.multiplied[ring]}) {
        for (const double value : figure_row(*point, true)) text += fmt::format(",{:.17g}", value);
      }
      text += row.order_stays ? ",1\n" : ",0\n";
    }
  }
  return text;
}

}  // namespace

SensitivityResult run_sensitivity(const RunResult& nominal, const RunOptions& options) {
  const auto inputs = sensitivity_inputs(nominal.scene);
  auto cases = sensitivity_cases(nominal.scene);
  cases.push_back({{}, "[sensitivity] nominal", ""});
  const ChangedStages stages(nominal, options);
  const auto points = run_cases(stages, cases, "sensitivity");
  const auto column = [&](std::size_t i) {
    std::vector<StudyPoint> list;
    for (const auto& ring : points.rings) list.push_back(ring[i]);
    return list;
  };
  SensitivityResult result{nominal.scene.sensitivity->factor, column(cases.size() - 1), {}};
  const auto order = order_of(result.nominal);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto target = find_input(nominal.scene, inputs[i]);
    SensitivityRow row{inputs[i], target.parameter->unit, {}, column(2 * i), column(2 * i + 1), false};
    for (std::size_t ring = 0; ring < nominal.rings.size(); ++ring) {
      const bool has =
          target.rings.empty() || std::find(target.rings.begin(), target.rings.end(), ring) != target.rings.end();
      row.values.push_back(has ? input_value(nominal.scene, target, ring).value_or(0)
                               : std::numeric_limits<double>::quiet_NaN());
    }
    row.order_stays = !order.empty() && order_of(row.divided) == order && order_of(row.multiplied) == order;
    result.rows.push_back(std::move(row));
  }
  std::filesystem::create_directories(options.out);
  write_file(options.out / "sensitivity.csv", sensitivity_csv(nominal, result));
  return result;
}

}  // namespace annulus::app
