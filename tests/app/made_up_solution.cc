#include "tests/app/made_up_solution.h"

#include "app/model/gear_system.h"
#include "app/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace annulus::test {

namespace {

using std::numbers::pi;

bool over_face_width(const app::MeshModel& model) {
  return model.settings.fidelity == fem::Fidelity::solid || model.settings.fidelity == fem::Fidelity::resolved_solid;
}

std::vector<double> angles_of(const fem::RingStructure& structure) {
  if (const auto* pins = structure.as<fem::PinHeld>()) return pins->angles;
  if (const auto* spline = structure.as<fem::SplineHeld>())
    return fem::equal_angles(spline->teeth, spline->first_tooth_angle);
  return {};
}

/// Largest where the force passes through the outside, 0.2 rad from the contact.
fem::PinState pin_state(const fem::RingStructure& structure, double from_contact, double load) {
  const double at = std::remainder(from_contact - 0.2, 2 * pi);
  const double radial = load * std::exp(-at * at / 0.05) * std::cos(6 * at);
  const double tangential = 0.3 * load * std::exp(-at * at / 0.4);
  const auto* pins = structure.as<fem::PinHeld>();
  if (pins && !pins->unilateral) return {true, radial, tangential};
  return {radial > 1, radial > 1 ? radial : 0, tangential};
}

/// Two pairs, one base pitch apart, with elliptic pressure.
void add_contact(fem::LoadedPosition& p, const std::vector<double>& edges, double face_width, double slope, bool mid) {
  p.pair_share = {0.6 - 0.2 * p.mesh_phase, 0.4 + 0.2 * p.mesh_phase};
  p.pair_roll = {18e-3 + 11e-3 * p.mesh_phase, 29e-3 + 11e-3 * p.mesh_phase};
  const auto slices = edges.empty() ? std::vector<double>{0, face_width} : edges;
  p.line_load.clear();
  for (std::size_t s = 0; s + 1 < slices.size(); ++s) {
    const double middle = (slices[s] + slices[s + 1]) / 2 / face_width;
    const double factor = 1 + slope * (2 * middle - 1);
    if (!edges.empty()) p.line_load.push_back(p.load / face_width * factor);
    for (int pair = 0; pair < 2 && mid; ++pair) {
      constexpr int pieces = 12;
      const double half = 0.6e-3 * std::sqrt(factor);
      for (int i = 0; i < pieces; ++i) {
        const double low = -1 + 2.0 * i / pieces, high = low + 2.0 / pieces, x = (low + high) / 2;
        const auto index = static_cast<std::size_t>(pair);
        p.pressure.push_back({pair, slices[s], slices[s + 1], p.pair_roll[index] + half * low,
                              p.pair_roll[index] + half * high,
                              1e9 * std::sqrt(p.pair_share[index] * factor * (1 - x * x))});
      }
    }
  }
}

std::vector<fem::StressCurve> curves(bool internal, double scale) {
  std::vector<fem::StressCurve> list;
  using Along = fem::StressCurve::Along;
  for (const auto& [body, along] : {std::pair{geometry::GearRole::pinion, Along::root},
                                    {geometry::GearRole::wheel, Along::root},
                                    {geometry::GearRole::wheel, Along::rim}}) {
    const bool rim = along == Along::rim;
    if (rim && !internal) continue;
    fem::StressCurve curve{
        .body = body, .along = along, .position = 0, .abscissa = {}, .tangential = {}, .von_mises = {}};
    for (int i = 0; i < 200; ++i) {
      const double x = (i + 0.5) / 200;
      const double value = rim ? 40e6 * std::cos(4 * pi * x) : 250e6 * std::sin(2 * pi * x) * std::exp(-x);
      curve.abscissa.push_back(rim ? 2 * pi * x : 8e-3 * x);
      curve.tangential.push_back(scale * value);
      curve.von_mises.push_back(scale * std::abs(value));
    }
    list.push_back(std::move(curve));
  }
  return list;
}

}  // namespace

fem::LoadedMeshResult made_up_solution(const app::MeshModel& model) {
  const auto& problem = *model.problem;
  const bool solid = over_face_width(model);
  std::vector<double> edges;
  for (int i = 0; solid && i <= 12; ++i) edges.push_back(problem.face_width * i / 12);
  std::vector<double> ring_angles;
  std::vector<StiffnessEntry> entries;
  std::vector<fem::LoadedPosition> positions;
  const auto pins = problem.pair.internal() ? angles_of(problem.structure) : std::vector<double>{};
  const double pitch = problem.pair.wheel().pitch_angle();
  for (int tooth = 0; tooth < model.positions; ++tooth) {
    ring_angles.push_back(tooth * pitch);
    for (int phase = 0; phase < problem.phases; ++phase) {
      for (std::size_t l = 0; l < problem.loads.size(); ++l) {
        fem::LoadedPosition p;
        p.mesh_phase = static_cast<double>(phase) / problem.phases;
        p.ring_tooth = tooth;
        p.ring_angle = (tooth + p.mesh_phase) * pitch;
        p.load = problem.loads[l];
        const double k = (solid ? 1e9 : 2e9) * (1 + 0.05 * std::cos(2 * pi * p.mesh_phase));
        p.entry = {0, p.load / k, k, k, 0.01};
        p.max_pressure = 0.9e9;
        const double slope = solid ? 0.5454545454545454 * (1 - 0.5 * p.mesh_phase) : 0;
        add_contact(p, edges, problem.face_width, slope, l == fem::nominal_load_index);
        if (solid) p.face_load_factor = 1 + slope * 11.0 / 12;  // the outermost of twelve slices
        p.max_pressure -= 1e6 * p.mesh_phase;
        const double fade = 1 - 0.1 * p.mesh_phase - 0.001 * tooth;
        p.pinion_stress = fem::RecoveredStress{{150e6 * fade, -180e6 * fade, 200e6 * fade, 20e6, -25e6, 30e6}, {}, {}};
        p.wheel_stress = fem::RecoveredStress{
            {120e6 * fade, -140e6 * fade, 160e6 * fade, 40e6 * fade, -45e6 * fade, 50e6 * fade}, {}, {}};
        for (const double angle : pins) p.pins.push_back(pin_state(problem.structure, angle - p.ring_angle, p.load));
        entries.push_back(p.entry);
        positions.push_back(std::move(p));
      }
    }
  }
  fem::LoadedMeshResult result(
      StiffnessTable(model.mesh, problem.phases, ring_angles, problem.loads, std::move(entries)), std::move(positions));
  result.pin_angles = pins;
  result.slice_edges = edges;
  result.stress_curves = curves(problem.pair.internal(), solid ? 1.3 : 1);
  return result;
}

app::RunResult made_up_run(const app::Scene& scene, int phases, const std::function<void(app::MeshResult&)>& change) {
  const auto run = std::make_shared<app::SystemRun>(scene);
  run->plan = app::make_plan(scene);
  for (auto& model : run->plan.meshes) {
    model.problem->phases = phases;
    auto& table = run->tables.emplace_back(app::pack(model, made_up_solution(model)));
    if (change) change(table);
  }
  return app::RunResult(*run);
}

}  // namespace annulus::test
