#pragma once

#include <set>
#include <utility>
#include <vector>

#include "fem/condensation/condensed_sector.h"
#include "fem/elasticity/arc_load.h"
#include "fem/elasticity/sector_model.h"
#include "fem/problem/byte_stream.h"

/// Condensed sectors as bytes, and all they depend on, for the cache.
namespace annulus::fem {

template <class Stream>
void members(Stream& stream, CondensedSector& s) {
  stream(s.dimension, s.pitch_angle, s.ports, s.interface_points, s.interface_dofs, s.interface_stiffness,
         s.interface_load, s.compliance);
}

template <class Stream>
void members(Stream& stream, OutsideLoads& outside) {
  stream(outside.degree, outside.stations, outside.z_low, outside.z_high);
}

/// What the model of a sector depends on.
inline void add_sector_inputs(ByteWriter& inputs, const geometry::Mesh& mesh, const geometry::ToothProfile& profile,
                              double support_radius, const Material& material, const SectorModelOptions& options) {
  inputs(mesh.dimension, mesh.vertices);
  // The unused corners of plane cells mean nothing.
  const std::size_t corners = mesh.dimension == 2 ? 4 : 8;
  for (const auto& cell : mesh.cells)
    for (std::size_t i = 0; i < corners; ++i) inputs(cell[i]);
  for (const auto& face : mesh.faces) {
    for (std::size_t i = 0; i < corners / 2; ++i) inputs(face.vertices[i]);
    inputs(face.boundary);
  }
  const auto& gear = profile.gear();
  const auto& p = gear.parameters();
  // Modifications of the flanks are gaps of the contact, the mesh knows none.
  inputs(p.kind, p.teeth, p.module, p.pressure_angle, p.profile_shift, gear.tip_form_radius(), gear.root_radius(),
         gear.form_radius(), p.root_fillet_factor, p.helix_angle, p.protuberance, p.protuberance_angle);
  inputs(support_radius, material.youngs_modulus, material.poisson_ratio);
  if (options.outputs.count(SectorOutput::mass) > 0) inputs(material.density);
  inputs(options.degree, options.refinements, options.held, options.flank, options.symmetric_end,
         options.outside_radius, options.straight_z.has_value(),
         options.axial_support.value_or(geometry::Boundary::none));
  for (const auto output : options.outputs) inputs(output);
}

/// What the unit loads of its outside depend on: the slices of the arcs, not their places.
inline void add_slices(ByteWriter& inputs, const std::vector<ArcLoad>& arcs) {
  std::set<std::pair<double, double>> slices;
  for (const auto& arc : arcs) slices.emplace(arc.z_low, arc.z_high);
  for (const auto& [low, high] : slices) inputs(low, high);
}

}  // namespace annulus::fem
