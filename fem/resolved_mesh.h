#pragma once

#include <memory>

#include "fem/contact/flank_contact.h"
#include "fem/loaded_mesh.h"

namespace annulus::fem {

/// The *resolved* rung: at every position and load, each tooth that may touch is meshed anew so that its own cells
/// resolve the contact, and takes the place of its like in the condensed gear. No near-field formula enters: it is what
/// the other rungs are compared with.
class ResolvedMesh {
 public:
  /// References are kept. Rings on pins or splines, and helical gears, are refused with InputError.
  ResolvedMesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, const FlankContact& flanks,
               int level);
  ~ResolvedMesh();

  [[nodiscard]] LoadedPosition solve(double phase, double load) const;
  [[nodiscard]] long unknowns() const;  ///< of the two regular sectors
  [[nodiscard]] const std::vector<double>& slice_edges() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace annulus::fem
