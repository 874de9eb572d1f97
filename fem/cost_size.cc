#include "fem/cost_size.h"

#include <algorithm>
#include <cmath>

#include "fem/body/resolution.h"
#include "fem/contact/planet_on_rollers.h"
#include "fem/problem/solved_face.h"

namespace annulus::fem {
namespace {

/// Cells of a section: along a flank, across the rim.
double flank_cells(const geometry::SectorResolution& r) {
  return r.flank_fractions.empty() ? r.flank_cells : static_cast<double>(r.flank_fractions.size() - 1);
}
double across(const geometry::SectorResolution& r) { return r.thickness_cells + r.fillet_cells + 2 * r.root_cells; }

/// Nodes of the whole section: tooth down to the middle of the fillets, and rim. By Euler's formula of a structured
/// section, V = 1 + E - F, E = (4 F + boundary edges) / 2.
double nodes_of_section(const geometry::SectorResolution& r, int degree) {
  const double flank = flank_cells(r), thickness = r.thickness_cells, fillet = r.fillet_cells;
  const double cells = thickness * (flank + fillet / 2) + r.rim_cells * across(r);
  const double boundary = thickness + 2 * (flank + fillet + r.root_cells + r.rim_cells) + across(r);
  const double edges = (4 * cells + boundary) / 2, vertices = 1 + edges - cells;
  return vertices + edges * (degree - 1) + cells * (degree - 1) * (degree - 1);
}

/// Nodes of a rectangle of the rim.
double nodes_of_rim(const geometry::SectorResolution& r, double rows, int degree) {
  return (degree * rows + 1) * (degree * across(r) + 1);
}

double solid_unknowns(const LoadedMeshProblem& problem, const BodyResolution& r, const geometry::Gear& gear, bool wheel,
                      int degree, const SolvedFace& face) {
  const auto& section = r.section;
  const double overhang = (wheel ? problem.wheel_overhang : problem.pinion_overhang).total() / (face.half ? 2 : 1);
  const double cells = face.solved(r.face_cells) + std::ceil(r.face_cells * overhang / problem.face_width);
  double nodes = nodes_of_section(section, degree) * (degree * cells + 1);
  // The nodes of a plane of symmetry stay in it.
  if (face.half) return 3 * nodes - nodes_of_section(section, degree);
  if (!wheel) return 3 * nodes;
  const double rim = std::abs(problem.wheel_support_radius - gear.root_radius());
  const RingBody body = problem.structure.body(problem.wheel_support_radius);
  if (body.sleeve) {
    const double rows = std::max(1.0, std::round(section.rim_cells * std::min(1.0, body.sleeve->thickness / rim)));
    nodes += nodes_of_rim(section, rows, degree) * degree * r.sleeve_cells;
  }
  const auto add_band = [&](double width) {
    nodes += nodes_of_rim(section, 1, degree) * (degree * std::max(1.0, r.face_cells * width / problem.face_width) + 1);
  };
  if (body.hoop) add_band(body.hoop->width);
  if (body.flange) add_band(body.flange->width);
  return 3 * nodes;
}

/// Forces of the bed under a planet on rollers.
double roller_patches(const LoadedMeshProblem& problem, int slices) {
  if (!problem.planet_rollers) return 0;
  const int teeth = problem.pair.pinion().teeth();
  return static_cast<double>(teeth) * PlanetOnRollers::patches_per_tooth(teeth, slices) * slices;
}

}  // namespace

int last_level(Fidelity fidelity) {
  if (fidelity == Fidelity::closed_form) return 0;
  return is_solid(fidelity) ? last_solid_level : last_plane_level;
}

int last_linear_level(const LoadedMeshProblem& problem) { return problem.pair.pinion().helix_angle() != 0 ? 2 : 1; }

double estimated_unknowns(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
  if (settings.fidelity == Fidelity::closed_form) return 0;
  const int degree = settings.degree;
  double unknowns = 0;
  for (const bool wheel : {false, true}) {
    const auto& gear = wheel ? problem.pair.wheel() : problem.pair.pinion();
    if (!is_solid(settings.fidelity)) {
      unknowns += 2 * nodes_of_section(plane_resolution(gear, level, degree).section, degree);
      continue;
    }
    const auto resolution = settings.fidelity == Fidelity::resolved_solid
                                ? resolved_solid_resolution(level)
                                : solid_resolution(level, degree, problem.pair.overlap_ratio());
    unknowns += solid_unknowns(problem, resolution, gear, wheel, degree, solved_face(problem, settings));
  }
  return unknowns;
}

double support_forces(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
  if (settings.fidelity == Fidelity::closed_form || settings.fidelity == Fidelity::plane)
    return problem.structure.single_supports() + roller_patches(problem, 1);
  if (settings.fidelity != Fidelity::solid) return 0;
  const SupportSites sites = support_sites(problem);
  const int cells = solid_resolution(level, settings.degree, problem.pair.overlap_ratio()).face_cells;
  const bool helical = problem.pair.pinion().helix_angle() != 0;
  const auto of_face =
      solved_face(problem, settings).edges(helical ? support_slices(problem, cells) : 2 * cells).size() - 1;
  const auto& [below, above] = problem.wheel_overhang;
  const auto slices = of_face + (below > 0 ? 1 : 0) + (above > 0 && !solved_face(problem, settings).half ? 1 : 0);
  double forces = roller_patches(problem, static_cast<int>(of_face));
  for (const auto& site : sites.sites) forces += static_cast<double>(site.directions.size() * slices);
  return forces;
}

}  // namespace annulus::fem
