#include <cmath>
#include <utility>

#include "app/model/run_options.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "core/units.h"

namespace annulus::app {

double LoadSpectrumResult::duration() const {
  double sum = 0;
  for (const auto& load : classes) sum += load.duration;
  return sum;
}

LoadSpectrumResult::Overall LoadSpectrumResult::overall(std::size_t variant, const std::string& figure) const {
  Overall all{.of_class = 0, .largest = -HUGE_VAL, .mean = 0};
  for (std::size_t n = 0; n < classes.size(); ++n) {
    const double value = variants.at(variant)[n].value(figure);
    if (!std::isfinite(value)) return {};
    all.mean += value * classes[n].duration / duration();
    if (value > all.largest) all.largest = value, all.of_class = n;
  }
  return all;
}

LoadSpectrumResult run_load_spectrum(const StudySubject& subject) {
  const auto& scene = subject.scene();
  auto points = run_cases(subject, load_cases(scene), "load spectrum");
  LoadSpectrumResult result{.inputs = scene.load_spectrum->inputs,
                            .units = {},
                            .classes = scene.load_classes,
                            .tables = points.tables,
                            .variants = std::move(points.variants)};
  PointColumns columns{.header = {}, .inputs = {"duration_h"}, .results = figure_keys(subject.figures())};
  for (const auto& input : result.inputs) {
    result.units.push_back(unit_of_input(scene, input));
    columns.inputs.push_back(file_name(input));
  }
  std::string names;
  for (const auto& load : result.classes) names += (names.empty() ? "" : "; ") + load.name;
  columns.header.emplace_back("classes", names);
  for (std::size_t variant = 0; variant < result.variants.size(); ++variant) {
    auto csv = columns.empty_table();
    for (std::size_t n = 0; n < result.classes.size(); ++n) {
      const auto& load = result.classes[n];
      std::vector<double> inputs{load.duration / units::hour};
      inputs.insert(inputs.end(), load.values.begin(), load.values.end());
      columns.add(csv, n + 1, inputs, result.variants[variant][n]);
    }
    csv.write(subject.folder(variant) / "load_spectrum.csv");
  }
  return result;
}

}  // namespace annulus::app
