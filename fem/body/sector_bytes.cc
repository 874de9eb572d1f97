#include "fem/body/sector_bytes.h"

#include <set>
#include <utility>

namespace annulus::fem {

void write(ByteWriter& out, const CondensedSector& sector) {
  out.add(sector.dimension).add(sector.pitch_angle).add(sector.ports).add(sector.interface_points);
  out.add(sector.interface_dofs);
  out.add(sector.interface_stiffness).add(sector.interface_load).add(sector.compliance);
}

CondensedSector read_sector(ByteReader& in) {
  CondensedSector sector;
  in.get(sector.dimension);
  in.get(sector.pitch_angle);
  in.get(sector.ports);
  in.get(sector.interface_points);
  in.get(sector.interface_dofs);
  in.get(sector.interface_stiffness);
  in.get(sector.interface_load);
  in.get(sector.compliance);
  return sector;
}

void write(ByteWriter& out, const OutsideLoads& outside) {
  out.add(outside.degree).add(outside.stations).add(outside.z_low).add(outside.z_high);
}

OutsideLoads read_outside(ByteReader& in) {
  OutsideLoads outside;
  in.get(outside.degree);
  in.get(outside.stations);
  in.get(outside.z_low);
  in.get(outside.z_high);
  return outside;
}

void add_sector_inputs(ByteWriter& inputs, const geometry::Mesh& mesh, const geometry::ToothProfile& profile,
                       double support_radius, const Material& material, const SectorModelOptions& options) {
  inputs.add(mesh.dimension).add(mesh.vertices);
  // The unused corners of plane cells mean nothing.
  const std::size_t corners = mesh.dimension == 2 ? 4 : 8, face_corners = corners / 2;
  for (const auto& cell : mesh.cells)
    for (std::size_t i = 0; i < corners; ++i) inputs.add(cell[i]);
  for (const auto& face : mesh.faces) {
    for (std::size_t i = 0; i < face_corners; ++i) inputs.add(face.vertices[i]);
    inputs.add(face.boundary);
  }
  const auto& gear = profile.gear();
  const auto& p = gear.parameters();
  inputs.add(p.kind).add(p.teeth).add(p.module).add(p.pressure_angle).add(p.profile_shift);
  inputs.add(gear.tip_radius()).add(gear.root_radius()).add(gear.form_radius()).add(p.root_fillet_factor);
  inputs.add(p.helix_angle);  // modifications of the flanks are gaps of the contact, the mesh knows none
  inputs.add(support_radius).add(material.youngs_modulus).add(material.poisson_ratio);
  if (options.want_mass) inputs.add(material.density);
  inputs.add(options.degree).add(options.refinements).add(options.held).add(options.flank).add(options.want_outside);
  inputs.add(options.symmetric_end);
  inputs.add(options.outside_radius).add(options.want_stress).add(options.want_mass);
}

void add_slices(ByteWriter& inputs, const std::vector<ArcLoad>& arcs) {
  std::set<std::pair<double, double>> slices;
  for (const auto& arc : arcs) slices.emplace(arc.z_low, arc.z_high);
  for (const auto& [low, high] : slices) inputs.add(low).add(high);
}

}  // namespace annulus::fem
