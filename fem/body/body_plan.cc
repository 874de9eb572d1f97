#include "fem/body/body_plan.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

BodyPlan::BodyPlan(const LoadedMeshProblem& problem, const geometry::ToothProfile& profile, bool wheel,
                   geometry::Boundary flank, int degree, bool solid, const SolvedFace& face)
    : profile_(profile), face_(face), solid_(solid) {
  const RingStructure structure = wheel ? problem.structure : RingStructure{};
  const double outside = problem.wheel_support_radius;
  rim_.support_radius = wheel ? outside : problem.planet_bore_radius;
  model_.degree = degree;
  model_.flank = flank;
  model_.symmetric_end = face.half;
  const bool helical = profile.gear().helix_angle() != 0;
  const auto words = structure.words();
  if (!solid && needs_solid(structure))
    throw InputError(
        fmt::format("a plane model cannot represent a ring {}: {}", words.description, words.solid_reason));
  ring_ = structure.body(outside);
  const bool face_held = ring_.held == HeldSurface::low_end_face || ring_.held == HeldSurface::both_end_faces;
  if (face_held && !(ring_.held_inner_radius > 0 && ring_.held_inner_radius < outside))
    throw InputError(
        fmt::format("a ring {} is fixed from an inner radius of {:.7g} mm to its outside radius of {:.7g} mm: the "
                    "inner radius has to be positive and smaller",
                    words.description, 1e3 * ring_.held_inner_radius, 1e3 * outside));
  if (ring_.held_inner_radius > 0) rim_.circles = {ring_.held_inner_radius};
  if (ring_.hoop || ring_.flange) {
    rim_.circles.push_back(outside);
    rim_.support_radius = ring_.hoop ? outside + ring_.hoop->thickness : ring_.flange->outside_radius;
    model_.outside_radius = outside;
  }
  switch (ring_.held) {
    case HeldSurface::outside:
      break;
    case HeldSurface::low_end_face:
      model_.held = HeldBoundary::end_low;
      break;
    case HeldSurface::both_end_faces:
      // The upper end of a half is its plane of symmetry.
      model_.held = face.half ? HeldBoundary::end_low : HeldBoundary::both_ends;
      break;
    case HeldSurface::flange_face:
      model_.held = HeldBoundary::flange_face;
      break;
    case HeldSurface::none:
      if (helical)
        throw InputError(fmt::format(
            "helical rings on pins or splines are not modelled, and this one has {}: fix the outside or the end face",
            words.description));
      model_.held = HeldBoundary::none;
      model_.outputs = {SectorOutput::outside};
      break;
  }
}

SectorModelOptions BodyPlan::near_field_model() const {
  SectorModelOptions model = model_;
  model.held = HeldBoundary::support;
  model.outputs.clear();
  model.symmetric_end = false;
  return model;
}

geometry::Mesh BodyPlan::section(const geometry::SectorResolution& resolution) const {
  return geometry::make_sector_mesh(profile_.gear(), rim_, resolution);
}

geometry::Mesh BodyPlan::sector(const BodyResolution& resolution, const SolvedFace& face) const {
  geometry::Mesh plane = section(resolution.section);
  if (!solid_) return plane;
  std::vector<geometry::Layers> stacks;
  geometry::ExtrudeOptions options;
  options.twist = profile_.twist();
  const double face_width = face.width;
  const auto cells = [&](double length) {
    constexpr double half_up = 1e-9;  // else the rounding of lengths, and with it their unit, decides on halves
    return std::max(1, static_cast<int>(std::lround(resolution.face_cells * length / face_width + half_up)));
  };
  geometry::Layers teeth{0, face_width, resolution.face_cells};
  if (ring_.hoop || ring_.flange) options.outside_radius = rim_.circles.back();
  if (ring_.held == HeldSurface::both_end_faces) {
    options.end_low_radius = ring_.held_inner_radius;
    if (!face.half) options.end_high_radius = ring_.held_inner_radius;
  }
  if (ring_.sleeve) {
    geometry::Layers sleeve{-ring_.sleeve->length, 0, resolution.sleeve_cells};
    sleeve.region = geometry::Mesh::Region::sleeve;
    sleeve.toothed = false;
    sleeve.radius_low = ring_.held_inner_radius;
    if (ring_.hoop) sleeve.radius_high = options.outside_radius;
    if (ring_.sleeve->length > 0)
      stacks.push_back(sleeve);
    else
      options.end_low_radius = ring_.held_inner_radius;
  }
  if (ring_.hoop && ring_.hoop->width < face_width) {
    const double below = face_width - ring_.hoop->width;
    stacks.push_back({0, below, cells(below)});
    stacks.back().radius_high = options.outside_radius;
    teeth = {below, face_width, cells(ring_.hoop->width)};
  }
  if (ring_.flange && ring_.flange->width < face_width) {
    stacks.push_back({0, ring_.flange->width, cells(ring_.flange->width)});
    stacks.back().band = geometry::Mesh::Region::flange;
    teeth = {ring_.flange->width, face_width, cells(face_width - ring_.flange->width)};
    teeth.radius_high = options.outside_radius;
  } else if (ring_.flange) {
    teeth.band = geometry::Mesh::Region::flange;
  }
  if (face.half) {
    require(stacks.empty() && teeth.z_high == face_width, "half of a face that is not symmetric");
    const auto edges = face.edges(resolution.face_cells);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) stacks.push_back({edges[i], edges[i + 1], 1});
  } else {
    stacks.push_back(teeth);
  }
  return geometry::extrude(plane, stacks, options);
}

}  // namespace annulus::fem
