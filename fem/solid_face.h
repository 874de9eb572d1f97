#pragma once

#include <memory>
#include <vector>

#include "core/elastic_law.h"
#include "fem/problem/loaded_mesh_problem.h"

namespace annulus::fem {

/// Two solid gears in contact along their face under any approach of their rigid bodies: what a stage in space needs of
/// a mesh. Slices of the face act on each other through the teeth and rims of both gears.
class SolidFace {
 public:
  /// Bodies of a level of resolution, as in a solved table (LoadedMeshResult::level, degree), on the whole face.
  /// Superelements come from the store of the settings where they are there. Throws InputError for what it does not
  /// model: a model that is not solid, rings on single supports, planets on rollers.
  SolidFace(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level);
  ~SolidFace();
  SolidFace(const SolidFace&) = delete;
  SolidFace& operator=(const SolidFace&) = delete;

  /// Middles of the slices, m, from the middle of the face.
  [[nodiscard]] const std::vector<double>& stations() const;
  /// The mesh at mesh cycles (StiffnessTable), whole ones included. Its coordinates are the approaches at the stations
  /// and, as the last one, the lean (FaceLaw). `load`: N, normal to the flanks, that it is expected to carry: it sizes
  /// the pressure elements. Any number of threads.
  [[nodiscard]] std::shared_ptr<const FaceLaw> at(double mesh_cycles, double load) const;

 private:
  class Bodies;
  std::unique_ptr<Bodies> bodies_;
};

/// Why a mesh has no SolidFace; empty where it has one.
[[nodiscard]] std::string why_no_solid_face(const LoadedMeshProblem& problem, Fidelity fidelity);

}  // namespace annulus::fem
