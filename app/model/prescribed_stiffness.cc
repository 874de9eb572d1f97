#include <cmath>
#include <numbers>

#include "app/model/mesh_result.h"
#include "app/scene/scene_files.h"

namespace annulus::app {

namespace {

std::size_t nearest_load(const StiffnessTable& table, double load) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < table.loads().size(); ++i) {
    if (std::abs(table.loads()[i] - load) < std::abs(table.loads()[best] - load)) best = i;
  }
  return best;
}

/// So many that the jumps of a rectangular wave fall between samples in step with its duty: its mean is met.
int samples_of(const MeshInput& input) {
  constexpr int fewest = 64, most = 256;
  if (input.stiffness != StiffnessShape::rectangular) return fewest;
  const auto missed = [&](int n) { return std::abs(n * *input.duty - std::round(n * *input.duty)) / n; };
  int best = fewest;
  for (int n = fewest; n <= most; ++n) {
    if (missed(n) < missed(best) - 1e-12) best = n;
  }
  return best;
}

/// One cycle of a prescribed wave, as the dynamics sees it; for figures and plots only.
StiffnessTable sampled(const std::string& mesh, const MeshInput& input, double load) {
  constexpr double rounding = 1e-12;
  const int samples = samples_of(input);
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < samples; ++i) {
    const double phase = static_cast<double>(i) / samples - input.phase.value_or(0);
    double wave = 0;
    if (input.stiffness == StiffnessShape::harmonic) wave = std::cos(2 * std::numbers::pi * phase);
    if (input.stiffness == StiffnessShape::rectangular) {
      const double late = phase + rounding;
      wave = (late - std::floor(late) < *input.duty ? 1 : 0) - *input.duty;
    }
    const double k = *input.mean * (1 + input.ripple.value_or(0) * wave);
    entries.push_back(
        {.unloaded_te = 0, .lte = load / k, .stiffness_secant = k, .stiffness_tangent = k, .error_relative = 0});
  }
  return {mesh, samples, {0}, {load}, std::move(entries)};
}

}  // namespace

MeshResult prescribed_stiffness(const MeshModel& model, const MeshInput& input, const Scene& scene,
                                double contact_ratio, double nominal_load) {
  if (input.stiffness == StiffnessShape::table) {
    auto table = prescribed_table(scene, model.mesh, *input.file);
    const auto nominal = nearest_load(table, nominal_load);
    return {.model = model, .contact_ratio = contact_ratio, .table = std::move(table), .nominal = nominal};
  }
  return {.model = model,
          .contact_ratio = contact_ratio,
          .table = sampled(model.mesh, input, nominal_load),
          .tabulated = false};
}

}  // namespace annulus::app
