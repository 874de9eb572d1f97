#include "fem/body/body_plan.h"

#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

BodyPlan::BodyPlan(const LoadedMeshProblem& problem, const geometry::ToothProfile& profile, bool wheel,
                   geometry::Boundary flank, int degree, bool solid, const SolvedFace& face)
    : profile_(profile), face_(face), solid_(solid) {
  if (wheel) structure_ = problem.structure;
  const double outside = problem.wheel_support_radius;
  rim_.support_radius = wheel ? outside : problem.planet_bore_radius;
  model_.degree = degree;
  model_.flank = flank;
  model_.symmetric_end = face.half;
  const bool helical = profile.gear().helix_angle() != 0;
  if (const auto* cantilever = std::get_if<EndFaceHeld>(&structure_)) {
    if (!solid) throw InputError("a ring held at its end face is a solid problem: the plane model cannot model it");
    model_.held = HeldBoundary::end_low;
    rim_.circles = {outside - cantilever->sleeve_thickness};
    if (cantilever->hoop) {
      rim_.circles.push_back(outside);
      rim_.support_radius = outside + cantilever->hoop->thickness;
      model_.outside_radius = outside;
    }
  } else if (const auto* flange = std::get_if<FlangeHeld>(&structure_)) {
    if (!solid) throw InputError("a ring on a flange is a solid problem: the plane model cannot model it");
    model_.held = HeldBoundary::flange_face;
    rim_.circles = {outside};
    rim_.support_radius = flange->outside_radius;
    model_.outside_radius = outside;
  } else if (!std::holds_alternative<OutsideHeld>(structure_)) {
    if (helical)
      throw InputError("helical rings on pins or splines are not modelled: hold the outside or the end face");
    model_.held = HeldBoundary::none;
    model_.want_outside = true;
  }
}

SectorModelOptions BodyPlan::near_field_model() const {
  SectorModelOptions model = model_;
  model.held = HeldBoundary::support;
  model.want_outside = false;
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
  if (const auto* cantilever = std::get_if<EndFaceHeld>(&structure_)) {
    geometry::Layers sleeve{-cantilever->free_length, 0, resolution.sleeve_cells};
    sleeve.region = geometry::Mesh::Region::sleeve;
    sleeve.toothed = false;
    sleeve.radius_low = rim_.circles.front();
    if (cantilever->hoop) {
      options.outside_radius = rim_.circles.back();
      teeth.radius_high = sleeve.radius_high = options.outside_radius;
    }
    if (cantilever->free_length > 0)
      stacks.push_back(sleeve);
    else
      options.end_low_radius = rim_.circles.front();
    if (cantilever->hoop && cantilever->hoop->width < face_width) {
      teeth.z_high = face_width - cantilever->hoop->width;
      teeth.cells = cells(teeth.z_high);
      stacks.push_back(teeth);
      teeth = {teeth.z_high, face_width, cells(cantilever->hoop->width)};
    } else if (cantilever->hoop) {
      teeth.radius_high = geometry::Layers{}.radius_high;
    }
  } else if (const auto* flange = std::get_if<FlangeHeld>(&structure_)) {
    options.outside_radius = rim_.circles.front();
    geometry::Layers low{0, std::min(flange->width, face_width), cells(flange->width)};
    low.band = geometry::Mesh::Region::flange;
    if (flange->width < face_width) {
      stacks.push_back(low);
      teeth = {flange->width, face_width, cells(face_width - flange->width)};
      teeth.radius_high = options.outside_radius;
    } else {
      teeth.band = geometry::Mesh::Region::flange;
    }
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
