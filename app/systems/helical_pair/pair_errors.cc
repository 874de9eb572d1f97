#include "app/systems/helical_pair/pair_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "app/results/content_id.h"
#include "app/systems/helical_pair/pair_input.h"
#include "core/bytes.h"
#include "core/csv.h"
#include "core/files.h"

namespace annulus {

ANNULUS_MEMBERS(dynamics::CompositeDeviations, teeth, total, tooth_to_tooth);
ANNULUS_MEMBERS(dynamics::ErrorProblem, gears, divisor, samples, seed, probability, confidence, bins);

}  // namespace annulus

namespace annulus::app {

namespace {

dynamics::ErrorResult law_of(const dynamics::ErrorProblem& problem) {
  static std::mutex lock;
  static std::pair<std::string, dynamics::ErrorResult> last;
  const std::lock_guard guard(lock);
  if (auto id = to_bytes(problem); last.first != id) last = {std::move(id), dynamics::manufacturing_error(problem)};
  return last.second;
}

using LinesOfCauses = std::vector<std::pair<std::string, std::string>>;

LinesOfCauses provenance(const dynamics::ErrorProblem& p) {
  return {{"annulus_version", version()},
          {"samples", fmt::format("{}", p.samples)},
          {"seed", fmt::format("{}", p.seed)},
          {"divisor", fmt::format("{:.17g}", p.divisor)},
          {"probability", fmt::format("{:.17g}", p.probability)},
          {"confidence", fmt::format("{:.17g}", p.confidence)}};
}

}  // namespace

dynamics::ErrorProblem error_problem(const Scene& scene) {
  const auto& m = *helical_pair(scene).manufacturing_error;
  dynamics::ErrorProblem problem;
  problem.gears[0] = {helical_pair(scene).pinion.teeth, m.pinion_total, m.pinion_tooth_to_tooth};
  problem.gears[1] = {helical_pair(scene).wheel.teeth, m.wheel_total, m.wheel_tooth_to_tooth};
  problem.divisor = m.divisor == ErrorDivisor::printed ? dynamics::printed_divisor : dynamics::exact_divisor();
  problem.samples = m.samples;
  problem.seed = static_cast<std::uint64_t>(m.seed);
  problem.probability = m.probability;
  problem.confidence = m.confidence;
  return problem;
}

const dynamics::ErrorReading* PairErrors::taken(const Scene& scene) const {
  if (!law || helical_pair(scene).manufacturing_error->reading == "none") return nullptr;
  return &law->at(helical_pair(scene).manufacturing_error->reading);
}

PairErrors pair_errors(const Scene& scene) {
  PairErrors errors;
  errors.amplitude = helical_pair(scene).errors.mesh_error.value_or(0);
  if (!helical_pair(scene).manufacturing_error) return errors;
  errors.problem = error_problem(scene);
  errors.law = law_of(*errors.problem);
  if (const auto* reading = errors.taken(scene))
    errors.amplitude =
        helical_pair(scene).manufacturing_error->amount == ErrorAmount::sample ? reading->sample.value : reading->exact;
  return errors;
}

void save_pair_errors(const PairErrors& errors, const std::filesystem::path& folder) {
  if (!errors.law) return;
  std::filesystem::create_directories(folder);
  const auto& problem = *errors.problem;
  const int stored = std::min(problem.samples, stored_samples);
  Csv samples{.header = provenance(problem),
              .columns = {"sample", "pinion_x1_m", "pinion_x2_m", "pinion_angle_rad", "pinion_error_m", "wheel_x1_m",
                          "wheel_x2_m", "wheel_angle_rad", "wheel_error_m"},
              .rows = {}};
  samples.header.emplace_back("samples_in_this_file", fmt::format("{}", stored));
  auto first = problem;
  first.samples = stored;  // a draw depends on seed, gear and number alone
  const auto pinion = dynamics::draw_errors(first, 0), wheel = dynamics::draw_errors(first, 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(stored); ++i) {
    samples.rows.push_back({static_cast<double>(i + 1), pinion.x_1[i], pinion.x_2[i], pinion.angle[i], pinion.error[i],
                            wheel.x_1[i], wheel.x_2[i], wheel.angle[i], wheel.error[i]});
  }
  samples.write(folder / "samples.csv");

  const auto& h = errors.law->histogram;
  Csv histogram{.header = provenance(problem), .columns = {"low_m", "high_m", "draws", "expected_draws"}, .rows = {}};
  histogram.header.emplace_back("quantity", "pinion_envelope");
  for (std::size_t i = 0; i < h.count.size(); ++i)
    histogram.rows.push_back({static_cast<double>(i) * h.width, static_cast<double>(i + 1) * h.width,
                              static_cast<double>(h.count[i]), h.expected[i]});
  histogram.write(folder / "histogram.csv");

  // With a column of names, so not one of the tables of numbers.
  std::string readings;
  for (const auto& [key, value] : provenance(problem)) readings += fmt::format("# {}: {}\n", key, value);
  readings += "reading,sample_quantile_m,sample_low_m,sample_high_m,exact_quantile_m\n";
  for (const auto& r : errors.law->readings)
    readings += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g}\n", r.name, r.sample.value, r.sample.low, r.sample.high,
                            r.exact);
  write_file(folder / "readings.csv", readings);
}

}  // namespace annulus::app
