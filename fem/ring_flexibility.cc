#include "fem/ring_flexibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem/condensation/lapack.h"
#include "fem/gear_body.h"

namespace annulus::fem {
namespace {

/// Even over a half of the flank about the pitch point, or over less where that is near an end. Even in the roll angle,
/// in which the normal turns at a constant rate, so that the resultant has the direction of the line of action; every
/// normal has the base radius as its lever arm.
NodalLoad mesh_force(const SectorModel& model, const geometry::ToothProfile& profile, geometry::Boundary flank,
                     const RingFlexibilityOptions& options) {
  const TraceBasis along(model.flank.profile, model.flank.degree);
  std::vector<double> over_width = {1.0};
  const auto& axial = model.flank.axial;
  if (axial.size() > 1) over_width = TraceBasis(axial, model.flank.degree).mean_over(axial.front(), axial.back());
  const auto ports = flank_forces(model, profile, flank);
  const double quarter = (along.high() - along.low()) / 4, least = quarter / 5;
  NodalLoad load;
  for (std::size_t z = 0; z < over_width.size(); ++z) {
    // The contact line of helical teeth slants: what leaves the flank at one end is taken by the next tooth.
    const double shift = profile.twist() * profile.gear().base_radius() * (axial[z] - options.face_width / 2);
    const double roll =
        std::clamp(options.roll + (axial.size() > 1 ? shift : 0.0), along.low() + least, along.high() - least);
    const double half = std::min({quarter, roll - along.low(), along.high() - roll});
    const auto weights = along.mean_over(roll - half, roll + half);
    for (std::size_t u = 0; u < weights.size(); ++u) {
      const auto& port = ports[u * over_width.size() + z];
      const double weight = weights[u] * over_width[z];
      if (weight != 0) load.push_back({port.node, weight * port.direction});
    }
  }
  return load;
}

/// What a plane model is known per unit of.
double known_width(const RingFlexibilityOptions& options) { return options.solid ? 1 : options.face_width; }

}  // namespace

Eigen::Matrix3Xd RingFlexibility::resultants_of(int sector, int first, int count) const {
  const Eigen::AngleAxisd turn(sector * pitch_angle, Eigen::Vector3d::UnitZ());
  return turn.toRotationMatrix() * resultants.middleCols(first, count);
}

SectorLoads ring_loads(const SectorModel& model, const geometry::ToothProfile& profile, geometry::Boundary flank,
                       const RingFlexibilityOptions& options) {
  SectorLoads loads;
  loads.acting.push_back(mesh_force(model, profile, flank, options));
  for (auto& load : inertia_loads(model, known_width(options), options.motions))
    loads.acting.push_back(std::move(load));
  for (const auto& arc : options.arcs) loads.acting.push_back(on_outside(arc, model.outside));
  return loads;
}

RingFlexibility compose_flexibility(const SectorModel& model, const SectorLoads& loads, const geometry::Gear& gear,
                                    bool floating, const RingFlexibilityOptions& options) {
  RingFlexibility ring;
  ring.teeth = gear.teeth();
  ring.pitch_angle = gear.pitch_angle();
  ring.base_radius = gear.base_radius();
  ring.arcs = static_cast<int>(options.arcs.size());
  ring.motions = static_cast<int>(loads.acting.size()) - 1 - ring.arcs;
  ring.unknowns = model.stiffness.rows();
  ring.resultants.resize(3, static_cast<Eigen::Index>(loads.acting.size()));
  for (std::size_t i = 0; i < loads.acting.size(); ++i) {
    const Wrench wrench = resultant(loads.acting[i], model.nodes);
    ring.resultants.col(static_cast<Eigen::Index>(i)) << wrench[0], wrench[1], wrench[5];
  }
  ring.compliance =
      compose_loads(condense(model, loads, floating), ring.teeth, floating, 1 / known_width(options), options.threads);
  return ring;
}

RingFlexibility make_ring_flexibility(const BodyPlan& plan, const BodyResolution& resolution, const Material& material,
                                      const RingFlexibilityOptions& options) {
  lapack::use_one_thread();
  const auto& profile = plan.profile();
  SectorModelOptions wanted = plan.model();
  wanted.want_mass = true;
  const SectorModel model =
      make_sector_model(plan.sector(resolution), profile, plan.support_radius(), material, wanted);
  return compose_flexibility(model, ring_loads(model, profile, wanted.flank, options), profile.gear(), plan.floating(),
                             options);
}

}  // namespace annulus::fem
