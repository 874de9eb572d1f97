#include "fem/cost_size.h"

#include <algorithm>
#include <cmath>

#include "fem/body/resolution.h"
#include "fem/problem/solved_face.h"

namespace annulus::fem {
namespace {

/// Nodes of a structured section by Euler's formula: V = 1 + E - F, E = (4 F + boundary edges) / 2.
double section_nodes(double cells, double boundary, int degree) {
  const double edges = (4 * cells + boundary) / 2, vertices = 1 + edges - cells;
  return vertices + edges * (degree - 1) + cells * (degree - 1) * (degree - 1);
}

struct SectionCounts {
  double flank = 0, across = 0, rim_rows = 0, fillet = 0, root = 0, thickness = 0;
};

SectionCounts section_counts(const geometry::SectorResolution& r) {
  SectionCounts c;
  c.flank = r.flank_fractions.empty() ? r.flank_cells : static_cast<double>(r.flank_fractions.size() - 1);
  c.thickness = r.thickness_cells;
  c.fillet = r.fillet_cells;
  c.root = r.root_cells;
  c.rim_rows = r.rim_cells;
  c.across = c.thickness + c.fillet + 2 * c.root;
  return c;
}

/// Nodes of the whole section: tooth down to the middle of the fillets, and rim.
double nodes_of_section(const SectionCounts& c, int degree) {
  const double cells = c.thickness * (c.flank + c.fillet / 2) + c.rim_rows * c.across;
  const double boundary = c.thickness + 2 * (c.flank + c.fillet + c.root + c.rim_rows) + c.across;
  return section_nodes(cells, boundary, degree);
}

/// Nodes of a rectangle of the rim.
double nodes_of_rim(const SectionCounts& c, double rows, int degree) {
  return (degree * rows + 1) * (degree * c.across + 1);
}

double solid_unknowns(const LoadedMeshProblem& problem, const BodyResolution& r, const geometry::Gear& gear, bool wheel,
                      int degree, const SolvedFace& face) {
  const auto c = section_counts(r.section);
  double nodes = nodes_of_section(c, degree) * (degree * face.solved(r.face_cells) + 1);
  // The nodes of a plane of symmetry stay in it.
  if (face.half) return 3 * nodes - nodes_of_section(c, degree);
  if (!wheel) return 3 * nodes;
  const double rim = std::abs(problem.wheel_support_radius - gear.root_radius());
  const RingBody body = problem.structure.body(problem.wheel_support_radius);
  if (body.sleeve) {
    const double rows = std::max(1.0, std::round(c.rim_rows * std::min(1.0, body.sleeve->thickness / rim)));
    nodes += nodes_of_rim(c, rows, degree) * degree * r.sleeve_cells;
  }
  const auto add_band = [&](double width) {
    nodes += nodes_of_rim(c, 1, degree) * (degree * std::max(1.0, r.face_cells * width / problem.face_width) + 1);
  };
  if (body.hoop) add_band(body.hoop->width);
  if (body.flange) add_band(body.flange->width);
  return 3 * nodes;
}

}  // namespace

int last_level(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::closed_form:
      return 0;
    case Fidelity::plane:
    case Fidelity::resolved_plane:
      return last_plane_level;
    case Fidelity::solid:
    case Fidelity::resolved_solid:
      break;
  }
  return last_solid_level;
}

int last_linear_level(const LoadedMeshProblem& problem) { return problem.pair.planet().helix_angle() != 0 ? 2 : 1; }

double estimated_unknowns(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
  if (settings.fidelity == Fidelity::closed_form) return 0;
  const bool solid = is_solid(settings.fidelity);
  const SolvedFace face = solved_face(problem, settings);
  double unknowns = 0;
  for (const bool wheel : {false, true}) {
    const auto& gear = wheel ? problem.pair.wheel() : problem.pair.planet();
    const auto of_solid = [&] {
      return settings.fidelity == Fidelity::resolved_solid
                 ? resolved_solid_resolution(level)
                 : solid_resolution(level, settings.degree, problem.pair.overlap_ratio());
    };
    unknowns += solid ? solid_unknowns(problem, of_solid(), gear, wheel, settings.degree, face)
                      : 2 * nodes_of_section(section_counts(plane_resolution(gear, level, settings.degree).section),
                                             settings.degree);
  }
  return unknowns;
}

double support_forces(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
  if (settings.fidelity != Fidelity::solid) return 0;
  const SupportSites sites = support_sites(problem);
  const int cells = solid_resolution(level, settings.degree, problem.pair.overlap_ratio()).face_cells;
  const auto slices = solved_face(problem, settings).edges(2 * cells).size() - 1;
  double forces = 0;
  for (const auto& site : sites.sites) forces += static_cast<double>(site.directions.size() * slices);
  return forces;
}

}  // namespace annulus::fem
