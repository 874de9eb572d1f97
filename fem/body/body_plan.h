#pragma once

#include "fem/body/resolution.h"
#include "fem/elasticity/sector_model.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/solved_face.h"
#include "geometry/mesh.h"

namespace annulus::fem {

/// How one gear of a loaded mesh becomes a body: what is meshed and what holds it. The common face lies between z = 0
/// and its width; the teeth may reach beyond it.
class BodyPlan {
 public:
  enum class Dimension { plane, solid };
  /// A wheel has the structure of the problem. The profile is referred to. Throws InputError when the structure needs a
  /// solid body and this one is plane.
  BodyPlan(const LoadedMeshProblem& problem, const geometry::ToothProfile& profile, geometry::GearRole role,
           geometry::Boundary flank, int degree, Dimension dimension, const SolvedFace& face);

  /// Plane section alone, whatever the body.
  [[nodiscard]] geometry::Mesh section(const geometry::SectorResolution& resolution) const;
  /// Sector of the body as it is solved: the section, or solid.
  [[nodiscard]] geometry::Mesh sector(const BodyResolution& resolution) const { return sector(resolution, face_); }
  /// The same over the whole face width.
  [[nodiscard]] geometry::Mesh whole_sector(const BodyResolution& resolution) const {
    return sector(resolution, {face_.width, false});
  }

  [[nodiscard]] const geometry::ToothProfile& profile() const { return profile_; }
  /// Borders along the axis of what carries on the outside: `pieces` of the common face, and the overhangs, m.
  [[nodiscard]] std::vector<double> support_edges(int pieces) const;
  [[nodiscard]] double support_radius() const { return rim_.support_radius; }
  [[nodiscard]] const SectorModelOptions& model() const { return model_; }
  /// The section held at its support circle: near fields are compared on it.
  [[nodiscard]] SectorModelOptions near_field_model() const;
  [[nodiscard]] bool floating() const { return model_.held == HeldBoundary::none; }
  /// Of the straight outside of a helical ring against the section at z = 0, rad; 0: none.
  [[nodiscard]] double turn() const { return profile_.twist() * model_.straight_z.value_or(0); }

 private:
  [[nodiscard]] geometry::Mesh sector(const BodyResolution& resolution, const SolvedFace& face) const;

  const geometry::ToothProfile& profile_;
  SolvedFace face_;
  geometry::Overhang overhang_;
  bool solid_;
  RingBody ring_;
  geometry::Rim rim_;
  SectorModelOptions model_;
};

}  // namespace annulus::fem
