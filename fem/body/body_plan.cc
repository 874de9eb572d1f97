#include "fem/body/body_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "fem/body/gear_body.h"

namespace annulus::fem {

namespace {

/// With the sign of the axial force on a flank.
double axial_force(const geometry::ToothProfile& profile, geometry::Boundary flank) {
  const double roll = (profile.roll_length_form() + profile.roll_length_tip()) / 2;
  const double side = flank == geometry::Boundary::trailing_flank ? -1 : 1;
  return -flank_normal(profile, roll, side, 0).z();
}

}  // namespace

BodyPlan::BodyPlan(const LoadedMeshProblem& problem, const geometry::ToothProfile& profile, geometry::GearRole role,
                   geometry::Boundary flank, int degree, Dimension dimension, const SolvedFace& face)
    : profile_(profile),
      face_(face),
      overhang_(role == geometry::GearRole::wheel ? problem.wheel_overhang : problem.pinion_overhang),
      solid_(dimension == Dimension::solid) {
  const bool wheel = role == geometry::GearRole::wheel;
  const RingStructure structure = wheel ? problem.structure : RingStructure{};
  const double outside = problem.wheel_support_radius;
  rim_.support_radius = wheel ? outside : problem.pinion_bore_radius;
  model_.degree = degree;
  model_.flank = flank;
  model_.symmetric_end = face.half;
  const bool helical = profile.gear().helix_angle() != 0;
  const auto words = structure.words();
  if (!solid_ && needs_solid(structure))
    throw InputError(
        fmt::format("a plane model cannot represent a ring {}: {}", words.description, words.solid_reason));
  ring_ = structure.body(outside);
  const bool on_rollers = !wheel && problem.planet_rollers.has_value();
  if (on_rollers) ring_.held = HeldSurface::none;
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
      if (solid_ && helical) {
        // What stands on the outside is parallel to the axis, and the end towards which the teeth press is supported.
        model_.straight_z = problem.face_width / 2;
        model_.axial_support =
            axial_force(profile, flank) > 0 ? geometry::Boundary::end_high : geometry::Boundary::end_low;
      }
      model_.held = HeldBoundary::none;
      model_.outputs = {SectorOutput::outside};
      if (on_rollers) model_.outputs.insert(SectorOutput::other_flank);
      break;
  }
}

SectorModelOptions BodyPlan::near_field_model() const {
  SectorModelOptions model = model_;
  model.held = HeldBoundary::support;
  model.outputs.clear();
  model.symmetric_end = false;
  model.straight_z.reset();
  model.axial_support.reset();
  return model;
}

std::vector<double> BodyPlan::support_edges(int pieces) const {
  auto edges = face_.edges(pieces);
  if (!solid_) return edges;
  if (overhang_.below > 0) edges.insert(edges.begin(), -overhang_.below);
  if (overhang_.above > 0 && !face_.half) edges.push_back(edges.back() + overhang_.above);
  return edges;
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
  if (model_.straight_z) options.straight = {profile_.gear().root_radius(), rim_.support_radius, *model_.straight_z};
  const double face_width = face.width, low = -overhang_.below, high = face_width + overhang_.above;
  const auto cells = [&](double length) {
    constexpr double half_up = 1e-9;  // else the rounding of lengths, and with it their unit, decides on halves
    return std::max(1, static_cast<int>(std::lround(resolution.face_cells * length / face_width + half_up)));
  };
  if (ring_.hoop || ring_.flange) options.outside_radius = rim_.circles.back();
  if (ring_.held == HeldSurface::both_end_faces) {
    options.end_low_radius = ring_.held_inner_radius;
    if (!face.half) options.end_high_radius = ring_.held_inner_radius;
  }
  if (model_.axial_support) options.end_low_radius = options.end_high_radius = profile_.gear().root_radius();
  if (ring_.sleeve) {
    geometry::Layers sleeve{low - ring_.sleeve->length, low, resolution.sleeve_cells};
    sleeve.region = geometry::Mesh::Region::sleeve;
    sleeve.toothed = false;
    sleeve.radius_low = ring_.held_inner_radius;
    if (ring_.hoop) sleeve.radius_high = options.outside_radius;
    if (ring_.sleeve->length > 0)
      stacks.push_back(sleeve);
    else
      options.end_low_radius = ring_.held_inner_radius;
  }
  // A hoop stands at the upper end of the teeth, a flange at their lower end. A flange as wide as they is all of them.
  const double hoop_from = ring_.hoop ? std::max(low, high - ring_.hoop->width) : low;
  const double flange_to = ring_.flange ? std::min(low + ring_.flange->width, high) : high;
  const auto add_teeth = [&](double from, double to, int count) {
    geometry::Layers teeth{from, to, count};
    const double middle = (from + to) / 2;
    if (middle < hoop_from || middle > flange_to) teeth.radius_high = options.outside_radius;
    if (ring_.flange && middle < flange_to) teeth.band = geometry::Mesh::Region::flange;
    stacks.push_back(teeth);
  };
  if (face.half) {
    require(stacks.empty() && hoop_from == low && flange_to == high, "half of a face that is not symmetric, from ", low,
            " to ", high, " m");
    if (low < 0) add_teeth(low, 0, cells(-low));
    const auto edges = face.edges(resolution.face_cells);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) add_teeth(edges[i], edges[i + 1], 1);
  } else {
    std::vector<double> borders = {low, 0, face_width, high, hoop_from, flange_to};
    std::sort(borders.begin(), borders.end());
    const auto same = [&](double a, double b) { return std::abs(a - b) <= 1e-9 * face_width; };
    borders.erase(std::unique(borders.begin(), borders.end(), same), borders.end());
    for (std::size_t i = 0; i + 1 < borders.size(); ++i)
      add_teeth(borders[i], borders[i + 1], cells(borders[i + 1] - borders[i]));
  }
  return geometry::extrude(plane, stacks, options);
}

}  // namespace annulus::fem
