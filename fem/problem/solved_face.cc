#include "fem/problem/solved_face.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/profile.h"

namespace annulus::fem {
namespace {

bool centred(const geometry::Overhang& overhang) {
  return std::abs(overhang.below - overhang.above) <= 1e-9 * overhang.total();
}

/// Whether the same is taken off a gear's flanks at both sides of the middle of its face (of `width`).
bool symmetric_lead(const geometry::Gear& gear, double width) {
  const geometry::ToothProfile profile(gear);
  constexpr int places = 16;
  double largest = 0, difference = 0;
  for (int i = 0; i <= places; ++i) {
    const double z = width / 2 * i / places, low = profile.lead_modification(z);
    largest = std::max(largest, std::abs(low));
    difference = std::max(difference, std::abs(low - profile.lead_modification(width - z)));
  }
  return difference <= 1e-9 * largest;  // round-off of both places, with a wide margin
}

/// Whether measured flanks of a gear change along its face.
bool varies(const geometry::Gear& gear) {
  auto measured = gear.parameters();
  measured.lead_crowning = measured.lead_slope = 0;
  return geometry::modified_along_face(measured);
}

}  // namespace

std::string asymmetry_of_face(const LoadedMeshProblem& problem) {
  const auto& pair = problem.pair;
  if (pair.pinion().helix_angle() != 0) return "helical teeth";
  if (problem.misalignment != 0) return "misaligned flanks";
  if (varies(pair.pinion()) || varies(pair.wheel())) return "measured flanks";
  if (!centred(problem.pinion_overhang) || !centred(problem.wheel_overhang)) return "faces beside each other";
  if (!symmetric_lead(pair.pinion(), problem.face_width + problem.pinion_overhang.total()) ||
      !symmetric_lead(pair.wheel(), problem.face_width + problem.wheel_overhang.total()))
    return "a lead modification that differs on both sides of the middle";
  return problem.structure.words().asymmetry;
}

SolvedFace solved_face(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings) {
  const bool solid = is_solid(settings.fidelity);
  return {problem.face_width, solid && settings.symmetry && asymmetry_of_face(problem).empty()};
}

std::vector<double> SolvedFace::edges(int pieces) const {
  std::vector<double> result;
  if (!half) {
    for (int i = 0; i <= pieces; ++i) result.push_back(width * i / pieces);
    return result;
  }
  for (int i = 0; 2 * i < pieces; ++i) result.push_back(width * i / pieces);
  result.push_back(width / 2);
  return result;
}

std::vector<double> mirrored_values(const std::vector<double>& half) {
  std::vector<double> whole = half;
  whole.insert(whole.end(), half.rbegin(), half.rend());
  return whole;
}

std::vector<double> mirrored_edges(const std::vector<double>& half) {
  std::vector<double> whole = half;
  for (auto edge = half.rbegin() + 1; edge != half.rend(); ++edge) whole.push_back(2 * half.back() - *edge);
  return whole;
}

void unfold(LoadedPosition& position, double width) {
  position.load *= 2;
  position.entry.stiffness_secant *= 2;
  position.entry.stiffness_tangent *= 2;
  for (auto* supports : {&position.pins, &position.housing})
    for (auto& support : *supports) {
      support.radial_force *= 2;
      support.tangential_force *= 2;
    }
  for (double& force : position.rollers) force *= 2;
  position.partner_compliance /= 2;
  position.line_load = mirrored_values(position.line_load);
  // Patches of one strip across the face stand together, by rising z.
  std::vector<PressurePatch> whole;
  for (auto first = position.pressure.begin(); first != position.pressure.end();) {
    const auto end = std::find_if(first, position.pressure.end(), [&](const PressurePatch& patch) {
      return patch.pair != first->pair || patch.roll_low != first->roll_low;
    });
    whole.insert(whole.end(), first, end);
    for (auto patch = end; patch != first;) {
      PressurePatch image = *--patch;
      std::tie(image.z_low, image.z_high) = std::pair(width - image.z_high, width - image.z_low);
      whole.push_back(image);
    }
    first = end;
  }
  position.pressure = std::move(whole);
}

}  // namespace annulus::fem
