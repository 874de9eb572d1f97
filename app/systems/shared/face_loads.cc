#include "app/systems/shared/face_loads.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/errors.h"
#include "core/loaded_face.h"
#include "core/log.h"
#include "core/parallel.h"

namespace annulus::app {

namespace {

/// One moment of a face; in the normal direction.
struct LoadedMoment {
  Eigen::VectorXd line_load;
  double wrong_moment = 0;  ///< N, over half the face width: of the motion's reduced face
};

LoadedMoment loaded(const FaceLaw& law, const SpaceResults::FaceMoment& moment, double to_normal) {
  const auto flanks = flanks_under(law, moment.force / to_normal, moment.place);
  return {flanks.load.line_load, flanks.tilt_stiffness() * (flanks.tilt - to_normal * moment.tilt)};
}

SpaceResults::Face face_of(const SpaceResults::Mesh& mesh, const std::vector<double>& stations,
                           const std::vector<LoadedMoment>& moments, double mean_force) {
  SpaceResults::Face face{.mesh = mesh.name, .at = stations};
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(std::ssize(stations));
  double wrong = 0, largest = 0;
  for (const auto& m : moments) {
    sum += m.line_load;
    wrong += m.wrong_moment;
    largest = std::max(largest, std::abs(m.wrong_moment));
  }
  const auto count = static_cast<double>(moments.size());
  sum /= count;
  face.line_load.assign(sum.begin(), sum.end());
  face.factor = sum.maxCoeff() * mesh.face_width / mean_force;
  face.deviation = mesh.solid_face ? largest / mean_force : not_known;
  face.error = mesh.solid_face ? 3 * std::abs(wrong) / (count * mean_force) : not_known;
  return face;
}

}  // namespace

void add_face_loads(SpaceResults& results, const MovingFaces& faces, int threads) {
  for (std::size_t m = 0; m < results.meshes.size(); ++m) {
    const auto& mesh = results.meshes[m];
    if (mesh.moments.empty()) continue;
    std::vector<LoadedMoment> moments(mesh.moments.size());
    std::vector<double> stations;
    double mean_force = 0;
    for (const auto& moment : mesh.moments)
      mean_force += moment.force / faces.to_normal / static_cast<double>(mesh.moments.size());
    try {
      stations = faces.law(m, 0)->stations();
      for_each_task(moments.size(), threads, [&](std::size_t i) {
        const auto& moment = mesh.moments[i];
        moments[i] = loaded(*faces.law(m, moment.cycles), moment, faces.to_normal);
      });
    } catch (const SolverError& error) {
      log::info(fmt::format("load along the face of mesh '{}': {}", mesh.name, error.what()));
      continue;
    }
    results.faces.push_back(face_of(mesh, stations, moments, mean_force));
  }
}

Csv face_loads_table(const SpaceResults& results) {
  Csv csv;
  std::size_t rows = 0;
  for (const auto& face : results.faces) {
    csv.columns.insert(csv.columns.end(), {face.mesh + "_at_m", face.mesh + "_mean_N_per_m"});
    rows = std::max(rows, face.at.size());
  }
  for (std::size_t i = 0; i < rows; ++i) {
    auto& row = csv.rows.emplace_back();
    for (const auto& face : results.faces) {
      const bool there = i < face.at.size();
      row.insert(row.end(), {there ? face.at[i] : not_known, there ? face.line_load[i] : not_known});
    }
  }
  return csv;
}

}  // namespace annulus::app
