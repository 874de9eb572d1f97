#include "app/tradeoff/trade_settings.h"

#include <fmt/format.h>

#include <map>

#include "fem/choice/table_choice.h"

namespace annulus::app {

namespace {

/// Multiples of the nominal load by their number; the middle one is 1.
const std::map<int, std::vector<double>> load_factors = {
    {1, {1}},
    {3, {0.5, 1, 1.5}},
    {5, {std::begin(fem::table_load_factors), std::end(fem::table_load_factors)}},
    {9, {0.125, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2}}};

MotionSetting with_tolerance(const char* fidelity, const char* name, dynamics::Integrator method, double tolerance) {
  return {fidelity, fmt::format("{}, relative tolerance {:.0e}", name, tolerance),
          [method, tolerance](dynamics::SimulationOptions& o) {
            o.integrator.method = method;
            o.integrate_within(tolerance);
          }};
}

/// With a step of their own choice. `few`: where each is expensive.
std::vector<MotionSetting> integrators(const char* fidelity, bool few) {
  using dynamics::Integrator;
  std::vector<MotionSetting> list;
  for (const double tolerance : few ? std::vector{1e-4, 1e-6} : std::vector{1e-3, 1e-4, 1e-5, 1e-6, 1e-8})
    list.push_back(with_tolerance(fidelity, "Cash-Karp 5(4)", Integrator::arkode_explicit, tolerance));
  if (few) return list;
  for (const double tolerance : {1e-4, 1e-6})
    list.push_back(with_tolerance(fidelity, "BDF", Integrator::cvode_bdf, tolerance));
  list.push_back(with_tolerance(fidelity, "Adams", Integrator::cvode_adams, 1e-6));
  return list;
}

}  // namespace

std::string MeshSetting::text() const {
  std::string text;
  if (fidelity != fem::Fidelity::closed_form) text = fmt::format("degree {}, level {}, ", degree, level);
  return text + fmt::format("{} phases, {} load{}", phases, loads, loads == 1 ? "" : "s");
}

std::string MeshSetting::folder() const {
  return fmt::format("{}_d{}_l{}_p{}_n{}", fidelity_name(fidelity), degree, level, phases, loads);
}

MeshModel MeshSetting::applied(const MeshModel& planned, AlongFace face) const {
  MeshModel model = planned;
  const auto used = fidelity == fem::Fidelity::solid && face == AlongFace::uniform ? fem::Fidelity::plane : fidelity;
  const double nominal = planned.problem->loads[planned.nominal_load()];
  model.fidelity = fidelity_name(used);
  model.settings.fidelity = used;
  model.settings.degree = degree;
  model.settings.level = level;
  model.problem->phases = phases;
  model.problem->loads.clear();
  for (const double factor : load_factors.at(loads)) model.problem->loads.push_back(factor * nominal);
  return model;
}

std::vector<MeshSetting> mesh_settings(const MeshModel& planned, AlongFace face) {
  using fem::Fidelity;
  std::vector<MeshSetting> list;
  const auto add = [&](Fidelity fidelity, int degree, const std::vector<int>& levels) {
    for (const int level : levels) list.push_back({.fidelity = fidelity, .degree = degree, .level = level});
  };
  if (face == AlongFace::varying) {
    add(Fidelity::solid, 1, {1});
    add(Fidelity::solid, 2, {1});
    add(Fidelity::solid, 1, {2});
    for (const int phases : {8, 16}) list.push_back({.fidelity = Fidelity::solid, .phases = phases});
    for (const int loads : {1, 3}) list.push_back({.fidelity = Fidelity::solid, .loads = loads});
    list.push_back({.fidelity = Fidelity::solid, .degree = 2, .level = 2, .finest = true});
    return list;
  }
  const bool rollers = planned.problem->planet_rollers.has_value();  // of which plane and solid models alone know
  if (!rollers) add(Fidelity::closed_form, 2, {1});
  add(Fidelity::plane, 1, {1, 2, 3, 4});
  add(Fidelity::plane, 2, {1, 2, 3, 4});
  add(Fidelity::plane, 3, {1, 2});
  for (const int phases : {8, 16, 64}) list.push_back({.fidelity = Fidelity::plane, .level = 2, .phases = phases});
  for (const int loads : {1, 3, 9}) list.push_back({.fidelity = Fidelity::plane, .level = 2, .loads = loads});
  // The resolved model knows no pins, and every position of it has a mesh of its own.
  if (!rollers && !fem::on_single_supports(planned.problem->structure))
    list.push_back({.fidelity = Fidelity::resolved_plane, .degree = 2, .level = 1, .phases = 16, .loads = 1});
  list.push_back({.fidelity = Fidelity::plane, .degree = 3, .level = 3, .phases = 64, .loads = 9, .finest = true});
  return list;
}

std::vector<MotionSetting> motion_settings(double mesh_frequency, int period) {
  using Options = dynamics::SimulationOptions;
  std::vector<MotionSetting> list;
  const auto directly = [&](int samples, bool finest = false) {
    list.push_back({"harmonic balance", fmt::format("{} samples per mesh cycle", samples),
                    [samples](Options& o) {
                      o.confirmation = dynamics::Confirmation::never;
                      o.sampling = dynamics::Sampling::prescribed;
                      o.samples_per_cycle = samples;
                    },
                    finest});
  };
  for (const int samples : {8, 16, 32, 64}) directly(samples);
  list.push_back({"harmonic balance", "64 samples, confirmed by time integration", [](Options&) {}});

  // A long period (pins, hunting teeth) is integrated many times: two tolerances show the cost.
  const bool long_period = period > dynamics::long_window;
  auto integrated = integrators("time integration", long_period);
  for (const int steps : long_period ? std::vector{64} : std::vector{32, 64, 128, 256})
    integrated.push_back({"time integration", fmt::format("Runge-Kutta 4, {} steps per mesh cycle", steps),
                          [steps, mesh_frequency](Options& o) {
                            o.integrator.method = dynamics::Integrator::runge_kutta_4;
                            o.integrator.fixed_step = 1 / (mesh_frequency * steps);
                          }});
  for (auto& setting : integrated) {
    setting.apply = [how = std::move(setting.apply)](Options& o) {
      o.steady_state = dynamics::SteadyState::time_integration;
      how(o);
    };
    list.push_back(std::move(setting));
  }
  directly(finest_samples, true);
  return list;
}

std::vector<MotionSetting> shooting_settings() {
  auto list = integrators("shooting", false);
  list.push_back(with_tolerance("shooting", "Cash-Karp 5(4)", dynamics::Integrator::arkode_explicit, 1e-9));
  list.back().finest = true;
  return list;
}

}  // namespace annulus::app
