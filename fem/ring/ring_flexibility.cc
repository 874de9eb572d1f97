#include "fem/ring/ring_flexibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "fem/body/gear_body.h"
#include "fem/body/sector_bytes.h"
#include "fem/condensation/lapack.h"

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
  if (axial.size() > 1) over_width = TraceBasis(axial, model.flank.degree).mean_over(0, options.face_width);
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
double known_width(const RingFlexibilityOptions& options) {
  return options.solid ? 1 : options.face_width + options.overhang;
}

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

namespace {

FlexibleSector condense_flexible(const SectorModel& model, const SectorLoads& loads, SectorSupport support) {
  FlexibleSector result;
  result.unknowns = model.stiffness.rows();
  result.resultants.resize(3, static_cast<Eigen::Index>(loads.acting.size()));
  for (std::size_t i = 0; i < loads.acting.size(); ++i) {
    const Wrench wrench = resultant(loads.acting[i], model.nodes);
    result.resultants.col(static_cast<Eigen::Index>(i)) << wrench[0], wrench[1], wrench[5];
  }
  result.sector = condense(model, loads, support);
  return result;
}

/// A sector condensed for the unit loads of its outside instead of arcs: what the store keeps.
struct UnitFlexibleSector {
  FlexibleSector sector;
  OutsideLoads outside;
};

template <class Stream>
void members(Stream& stream, UnitFlexibleSector& unit) {
  stream(unit.sector.resultants, unit.sector.unknowns, unit.outside, unit.sector.sector);
}

UnitFlexibleSector condense_unit_flexible(const BodyPlan& plan, const geometry::Mesh& mesh,
                                          const SectorModelOptions& wanted, const Material& material,
                                          const RingFlexibilityOptions& options) {
  const auto& profile = plan.profile();
  const SectorModel model = make_sector_model(mesh, profile, plan.support_radius(), material, wanted);
  RingFlexibilityOptions without_arcs = options;
  without_arcs.arcs.clear();
  SectorLoads loads = ring_loads(model, profile, wanted.flank, without_arcs);
  UnitFlexibleSector unit;
  if (!options.arcs.empty()) {
    unit.outside = OutsideLoads::of(options.arcs, model.outside);
    for (auto& load : unit.outside.unit_loads(model.outside)) loads.acting.push_back(std::move(load));
  }
  unit.sector = condense_flexible(model, loads, support_of(wanted.held));
  return unit;
}

FlexibleSector with_arcs(UnitFlexibleSector unit, const std::vector<ArcLoad>& arcs) {
  FlexibleSector result = std::move(unit.sector);
  if (arcs.empty()) return result;
  const Eigen::MatrixXd weights = unit.outside.weights(arcs);
  const Eigen::Index others = result.resultants.cols() - weights.rows();
  Eigen::Matrix3Xd resultants(3, others + weights.cols());
  resultants << result.resultants.leftCols(others), result.resultants.rightCols(weights.rows()) * weights;
  result.resultants = resultants;
  result.sector = combine_loads(std::move(result.sector), static_cast<int>(others), weights);
  return result;
}

}  // namespace

RingFlexibility compose_flexibility(const FlexibleSector& sector, const geometry::Gear& gear, SectorSupport support,
                                    const RingFlexibilityOptions& options) {
  RingFlexibility ring;
  ring.teeth = gear.teeth();
  ring.pitch_angle = gear.pitch_angle();
  ring.base_radius = gear.base_radius();
  ring.arcs = static_cast<int>(options.arcs.size());
  ring.motions = static_cast<int>(sector.resultants.cols()) - 1 - ring.arcs;
  ring.unknowns = sector.unknowns;
  ring.resultants = sector.resultants;
  ring.compliance = compose_loads(sector.sector, ring.teeth, support, 1 / known_width(options), options.threads);
  return ring;
}

RingFlexibility compose_flexibility(const SectorModel& model, const SectorLoads& loads, const geometry::Gear& gear,
                                    SectorSupport support, const RingFlexibilityOptions& options) {
  return compose_flexibility(condense_flexible(model, loads, support), gear, support, options);
}

RingFlexibility make_ring_flexibility(const BodyPlan& plan, const BodyResolution& resolution, const Material& material,
                                      const RingFlexibilityOptions& options) {
  lapack::use_one_thread();
  SectorModelOptions wanted = plan.model();
  wanted.outputs.insert(SectorOutput::mass);
  const geometry::Mesh mesh = plan.sector(resolution);
  UnitFlexibleSector unit;
  const auto make = [&] { unit = condense_unit_flexible(plan, mesh, wanted, material, options); };
  ByteWriter inputs;
  inputs(std::string("flexibility"));
  add_sector_inputs(inputs, mesh, plan.profile(), plan.support_radius(), material, wanted);
  add_slices(inputs, options.arcs);
  inputs(options.roll, options.face_width, options.overhang, options.solid, options.motions.section,
         options.motions.axial);
  const bool reused = read_or_make(options.store, inputs, unit, make);
  RingFlexibility ring = compose_flexibility(with_arcs(std::move(unit), options.arcs), plan.profile().gear(),
                                             support_of(wanted.held), options);
  ring.reused = reused;
  return ring;
}

}  // namespace annulus::fem
