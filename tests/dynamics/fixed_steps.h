#pragma once

#include <cmath>

namespace annulus::test {

/// Takes a model from time `t` to `end` (s) in equal steps of at most `longest`, by its step(t, h, state).
template <class Model, class State>
void step_to(double& t, double end, double longest, const Model& model, State& state) {
  const auto steps = static_cast<long>(std::ceil((end - t) / longest));
  const double h = steps > 0 ? (end - t) / static_cast<double>(steps) : 0;
  for (long k = 0; k < steps; ++k) model.step(t + static_cast<double>(k) * h, h, state);
  t = end;
}

}  // namespace annulus::test
