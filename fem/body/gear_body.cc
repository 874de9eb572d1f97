#include "fem/body/gear_body.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "core/errors.h"
#include "core/stopwatch.h"
#include "fem/body/sector_bytes.h"

namespace annulus::fem {
namespace {

/// Appends the stresses of a surface to what is observed, at no more than about `most` points along the line: every so
/// many nodes, and the last one.
StressLine observe(const StressSurface& surface, const SectorModel& model, int most, SectorLoads& loads) {
  StressLine line;
  const auto& trace = surface.trace;
  if (trace.nodes.empty()) return line;
  line.first_load = loads.columns();
  line.axial = trace.axial;
  line.components = model.dimension == 3 ? 3 : 1;
  const int nodes = static_cast<int>(trace.profile.size()), step = (nodes - 1 + most - 1) / most;
  double arc = 0;
  for (int u = 0; u < nodes; ++u) {
    const auto at = [&](int station) { return model.nodes[trace.nodes[station * line.axial_stations()]]; };
    if (u > 0) arc += (at(u) - at(u - 1)).norm();
    if (u % step != 0 && u != nodes - 1) continue;
    line.angle.push_back(trace.profile[u]);
    line.arc.push_back(arc);
    for (int z = 0; z < line.axial_stations(); ++z) {
      const auto& stress = surface.stress[u * line.axial_stations() + z];
      loads.observed.push_back(stress.tangential);
      if (line.components == 1) continue;
      loads.observed.push_back(stress.axial);
      loads.observed.push_back(stress.shear);
    }
  }
  return line;
}

}  // namespace

Eigen::Vector3d flank_normal(const geometry::ToothProfile& profile, double roll, double side, double z) {
  const Eigen::Vector2d normal = profile.flank_normal(roll), point = profile.flank_point(roll);
  // The normal stands on the tangent (twist e_z x p) + e_z of the helix through the point.
  const double moment = side * (point.x() * normal.y() - point.y() * normal.x());
  const Eigen::Vector3d all(normal.x(), side * normal.y(), -profile.twist() * moment);
  return Eigen::AngleAxisd(profile.twist() * z, Eigen::Vector3d::UnitZ()) * all.normalized();
}

Eigen::RowVector3d GearBody::rigid_motion(int port, int sector) const {
  const Eigen::AngleAxisd turn(sector * pitch_angle, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d d = turn * ports[port].direction, p = turn * port_points[port];
  return {d.x(), d.y(), p.x() * d.y() - p.y() * d.x()};
}

Wrench GearBody::acting_wrench(int load, int sector) const {
  const Eigen::AngleAxisd turn(sector * pitch_angle, Eigen::Vector3d::UnitZ());
  Wrench turned;
  turned << turn * acting_wrenches[load].head<3>(), turn * acting_wrenches[load].tail<3>();
  return turned;
}

Wrench resultant(const NodalLoad& load, const std::vector<Eigen::Vector3d>& nodes) {
  Wrench wrench = Wrench::Zero();
  for (const auto& f : load) {
    wrench.head<3>() += f.force;
    wrench.tail<3>() += nodes[f.node].cross(f.force);
  }
  return wrench;
}

std::vector<Port> flank_forces(const SectorModel& model, const geometry::ToothProfile& profile,
                               geometry::Boundary flank) {
  std::vector<Port> ports;
  const double side = flank == geometry::Boundary::trailing_flank ? -1 : 1;
  for (const int node : model.flank.nodes) {
    // At the node's own place, not at the coordinates of its row: only there has the normal the base circle's lever
    // arm.
    const auto& point = model.nodes[node];
    const double roll = profile.roll_length_at(std::hypot(point.x(), point.y()));
    ports.push_back({node, -flank_normal(profile, roll, side, point.z())});
  }
  return ports;
}

namespace {

/// m, roll lengths of places on a flank between the first and the last of its nodes.
std::vector<double> rolls_of(const TraceGrid& flank, int places) {
  std::vector<double> rolls;
  rolls.reserve(static_cast<std::size_t>(places));
  const double low = flank.profile.front(), high = flank.profile.back();
  for (int i = 0; i < places; ++i) rolls.push_back(low + (high - low) * i / (places - 1));
  return rolls;
}

}  // namespace

std::vector<NodalLoad> other_flank_loads(const SectorModel& model, const geometry::ToothProfile& profile,
                                         geometry::Boundary contact_flank, const OtherFlankLoads& loads) {
  std::vector<NodalLoad> result;
  if (loads.places == 0) return result;
  const auto& flank = model.other_flank;
  require(!flank.nodes.empty() && loads.places > 1, "loads at ", loads.places, " places of a flank of ",
          flank.nodes.size(), " nodes");
  const TraceBasis basis(flank.profile, flank.degree);
  const auto over_width = flank.axial.size() == 1
                              ? std::vector<double>{1.0}
                              : TraceBasis(flank.axial, flank.degree).mean_over(loads.z_low, loads.z_high);
  const double side = contact_flank == geometry::Boundary::leading_flank ? -1 : 1;
  for (const double roll : rolls_of(flank, loads.places)) {
    auto& load = result.emplace_back();
    const auto at = basis(roll);
    for (std::size_t i = 0; i < at.weights.size(); ++i)
      for (std::size_t z = 0; z < over_width.size(); ++z) {
        const double weight = at.weights[i] * over_width[z];
        const int node = flank.nodes[(static_cast<std::size_t>(at.first) + i) * over_width.size() + z];
        const auto& point = model.nodes[node];
        const Eigen::Vector3d into =
            -flank_normal(profile, profile.roll_length_at(std::hypot(point.x(), point.y())), side, point.z());
        if (weight != 0) load.push_back({node, weight / into.head<2>().norm() * into});
      }
  }
  return result;
}

template <class Stream>
void members(Stream& stream, Port& port) {
  stream(port.node, port.direction);
}

template <class Stream>
void members(Stream& stream, StressLine& line) {
  stream(line.first_load, line.components, line.axial, line.angle, line.arc);
}

template <class Stream>
void members(Stream& stream, TraceBasis& basis) {
  int degree = basis.degree();
  auto stations = basis.stations();
  stream(degree, stations);
  if (!stations.empty()) basis = TraceBasis(stations, degree);
}

namespace {

/// A tooth condensed for the unit loads of its outside, before arcs are put together: what the store keeps. The body's
/// arc loads are these unit loads.
struct UnitTooth {
  CondensedTooth tooth;
  OutsideLoads outside;
};

template <class Stream>
void members(Stream& stream, UnitTooth& unit) {
  GearBody& body = unit.tooth.body;
  stream(unit.tooth.seconds, body.teeth, body.pitch_angle, body.unknowns, body.flank, body.axial, body.ports,
         body.port_points, body.acting_wrenches, body.other_rolls, body.root_low, body.root_high, body.rim,
         unit.outside, unit.tooth.sector);
}

UnitTooth condense_unit_tooth(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile,
                              double support_radius, const Material& material, const GearBodyOptions& options) {
  const SectorModel model = make_sector_model(sector_mesh, profile, support_radius, material, options.sector);

  UnitTooth unit;
  CondensedTooth& tooth = unit.tooth;
  GearBody& body = tooth.body;
  body.teeth = profile.gear().teeth();
  body.pitch_angle = profile.gear().pitch_angle();
  body.flank = TraceBasis(model.flank.profile, model.flank.degree);
  if (model.flank.axial.size() > 1) body.axial = TraceBasis(model.flank.axial, model.flank.degree);
  body.unknowns = model.stiffness.rows();

  SectorLoads loads;
  loads.ports = flank_forces(model, profile, options.sector.flank);
  for (const auto& port : loads.ports) body.port_points.push_back(model.nodes[port.node]);
  if (!options.arcs.empty()) {
    unit.outside = OutsideLoads::of(options.arcs, model.outside);
    loads.acting = unit.outside.unit_loads(model.outside);
  }
  if (options.other_flank.places > 0) {
    body.other_rolls = rolls_of(model.other_flank, options.other_flank.places);
    for (auto& load : other_flank_loads(model, profile, options.sector.flank, options.other_flank))
      loads.acting.push_back(std::move(load));
  }
  for (const auto& load : loads.acting) body.acting_wrenches.push_back(resultant(load, model.nodes));

  constexpr int root_points = 60, rim_points = 24;
  body.root_low = observe(model.root_low, model, root_points, loads);
  body.root_high = observe(model.root_high, model, root_points, loads);
  body.rim = observe(model.rim, model, rim_points, loads);

  tooth.sector = condense(model, loads, support_of(options.sector.held));
  body.ports = std::move(loads.ports);
  return unit;
}

/// The arcs put together from the unit loads of the outside.
CondensedTooth with_arcs(UnitTooth unit, const std::vector<ArcLoad>& arcs) {
  CondensedTooth tooth = std::move(unit.tooth);
  if (arcs.empty()) return tooth;
  GearBody& body = tooth.body;
  const Eigen::MatrixXd weights = unit.outside.weights(arcs);
  tooth.sector = combine_loads(std::move(tooth.sector), body.first_acting(), weights);
  Eigen::Matrix<double, 6, Eigen::Dynamic> units(6, weights.rows());
  for (Eigen::Index i = 0; i < weights.rows(); ++i) units.col(i) = body.acting_wrenches[i];
  const Eigen::Matrix<double, 6, Eigen::Dynamic> wrenches = units * weights;
  const std::vector<Wrench> others(body.acting_wrenches.begin() + weights.rows(), body.acting_wrenches.end());
  body.acting_wrenches.clear();
  for (Eigen::Index i = 0; i < wrenches.cols(); ++i) body.acting_wrenches.emplace_back(wrenches.col(i));
  body.acting_wrenches.insert(body.acting_wrenches.end(), others.begin(), others.end());
  for (auto* line : {&body.root_low, &body.root_high, &body.rim})
    if (line->points() > 0) line->first_load += static_cast<int>(weights.cols() - weights.rows());
  return tooth;
}

}  // namespace

CondensedTooth condense_tooth(const geometry::Mesh& sector_mesh, const geometry::ToothProfile& profile,
                              double support_radius, const Material& material, const GearBodyOptions& options) {
  UnitTooth unit;
  const auto make = [&] {
    const Stopwatch watch;
    unit = condense_unit_tooth(sector_mesh, profile, support_radius, material, options);
    unit.tooth.seconds = watch.seconds();
  };
  ByteWriter inputs;
  inputs(std::string("tooth"));
  add_sector_inputs(inputs, sector_mesh, profile, support_radius, material, options.sector);
  add_slices(inputs, options.arcs);
  const auto& other = options.other_flank;
  if (other.places > 0) inputs(other.places, other.z_low, other.z_high);
  const bool reused = read_or_make(options.store, inputs, unit, make);
  CondensedTooth tooth = with_arcs(std::move(unit), options.arcs);
  tooth.reused = reused;
  return tooth;
}

GearBody compose_body(CondensedTooth tooth, const GearBodyOptions& options) {
  GearBody& body = tooth.body;
  Eigen::Index count = 0;
  for (const auto& wanted : options.gauges) {
    body.gauges.push_back({gauge_parts(wanted, body), {}});
    count += static_cast<Eigen::Index>(body.gauges.back().parts.size());
  }
  // Loads of one sector, a column for each part of a gauge.
  Eigen::MatrixXd probes = Eigen::MatrixXd::Zero(tooth.sector.interface_load.cols(), count);
  Eigen::Index column = 0;
  for (const auto& gauge : body.gauges)
    for (const auto& part : gauge.parts)
      probes.col(column++).segment(body.root_low.first_load, part.weights.size()) = part.weights;
  std::vector<Eigen::MatrixXd> carried;
  body.compliance = compose_ring(tooth.sector, body.teeth, options.extent, support_of(options.sector.held),
                                 options.threads, probes, &carried);
  column = 0;
  for (auto& gauge : body.gauges) {
    gauge.at_interfaces = Eigen::MatrixXd::Zero(body.compliance.interface_size(), body.teeth);
    for (const auto& part : gauge.parts) {
      const Eigen::MatrixXd& one = carried[static_cast<std::size_t>(column++)];
      for (int d = 0; d < body.teeth; ++d)
        gauge.at_interfaces.col((((d + part.sector) % body.teeth) + body.teeth) % body.teeth) += one.col(d);
    }
  }
  return std::move(body);
}

}  // namespace annulus::fem
