#pragma once

#include "fem/contact/contact_system.h"
#include "fem/levels/mesh_bodies.h"

namespace annulus::tests {

/// As LoadedMeshSettings::symmetry. Off, bodies serve misalignments too.
enum class Symmetry { off, used };

/// A gear mesh solved position by position at one level of resolution, without the coarser level that estimates errors.
class ContactBench {
 public:
  ContactBench(const fem::LoadedMeshProblem& problem, int level, fem::Fidelity fidelity = fem::Fidelity::plane,
               Symmetry symmetry = Symmetry::off, int degree = 2);
  ContactBench(const ContactBench&) = delete;
  ContactBench& operator=(const ContactBench&) = delete;

  /// Another misalignment of the same bodies, m.
  void misalign(double misalignment);
  /// Another number of pressure elements to either side of the centre of a pair.
  void set_elements(int elements);
  /// Position in mesh cycles; started from the position solved before.
  fem::LoadedPosition solve(double phase, double load);
  /// All forces of a position.
  fem::ContactForces forces(double phase, double load);
  /// `steps` equal steps from phase 0 to 1, both included.
  std::vector<fem::LoadedPosition> sweep(int steps, double load);

  [[nodiscard]] const fem::FlankContact& flanks() const { return flanks_; }
  [[nodiscard]] const fem::MeshBodies& bodies() const { return bodies_; }
  [[nodiscard]] double face_width() const { return problem_.face_width; }

 private:
  void rebuild();

  fem::LoadedMeshProblem problem_;
  fem::FlankContact flanks_;
  fem::MeshBodies bodies_;
  fem::ContactOptions options_;
  std::unique_ptr<fem::ContactSystem> system_;
  fem::ContactSystem::PairsCache pairs_;
  fem::ContactSystem::WarmStart warm_;
};

}  // namespace annulus::tests
