#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>

#include <Eigen/Geometry>

#include <deal.II/base/multithread_info.h>

#include "core/errors.h"
#include "fem/dealii/elastic_problem.h"
#include "fem/elasticity/elements.h"

namespace annulus::fem {
namespace {

/// Ascending values that differ by more than `tolerance`; close ones are one station of the grid.
std::vector<double> distinct(std::vector<double> values, double tolerance) {
  std::sort(values.begin(), values.end());
  std::vector<double> result;
  for (const double v : values)
    if (result.empty() || v - result.back() > tolerance) result.push_back(v);
  return result;
}

/// Below this, differences of z are round-off: whatever the unit of length, and far below the thinnest layer of cells.
double axial_round_off(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const auto& p : points) largest = std::max(largest, std::abs(p.z()));
  return 1e-12 * largest;
}

int station(const std::vector<double>& stations, double value) {
  const auto above = std::lower_bound(stations.begin(), stations.end(), value);
  if (above == stations.end()) return static_cast<int>(stations.size()) - 1;
  if (above == stations.begin()) return 0;
  return static_cast<int>(above - stations.begin()) - (value - *(above - 1) < *above - value ? 1 : 0);
}

TraceGrid make_trace(const std::vector<int>& nodes, const std::vector<Eigen::Vector3d>& points, int degree,
                     const std::function<double(const Eigen::Vector3d&)>& profile_coordinate) {
  TraceGrid trace;
  trace.degree = degree;
  std::vector<double> z;
  z.reserve(nodes.size());
  for (const int n : nodes) z.push_back(points[n].z());
  trace.axial = distinct(z, axial_round_off(points));
  std::vector<std::vector<std::pair<double, int>>> rows(trace.axial.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    rows[station(trace.axial, z[i])].emplace_back(profile_coordinate(points[nodes[i]]), nodes[i]);
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    require(row.size() == rows.front().size(), "rows of ", row.size(), " and ", rows.front().size(),
            " nodes of a boundary do not form a tensor grid");
  }
  // On a helical flank the nodes between the vertices of an edge along z lie off the profile coordinate of the vertices
  // by a small part of a cell: one common coordinate serves the row.
  trace.profile.assign(rows.front().size(), 0.0);
  trace.nodes.assign(nodes.size(), -1);
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < rows[k].size(); ++i) {
      trace.profile[i] += rows[k][i].first / static_cast<double>(rows.size());
      trace.nodes[i * rows.size() + k] = rows[k][i].second;
    }
  return trace;
}

/// Polar angle of a point in the section of the body, rad.
using PolarAngle = std::function<double(const Eigen::Vector3d&)>;

/// In a section that a helical gear turns by `twist` z.
PolarAngle twisted_angle(double twist) {
  return
      [twist](const Eigen::Vector3d& p) { return std::remainder(std::atan2(p.y(), p.x()) - twist * p.z(), 2 * M_PI); };
}

/// On the outside, which may keep the section at one z.
PolarAngle outside_angle(double twist, const std::optional<double>& straight_z) {
  if (!straight_z) return twisted_angle(twist);
  return [turn = twist * *straight_z](const Eigen::Vector3d& p) {
    return std::remainder(std::atan2(p.y(), p.x()) - turn, 2 * M_PI);
  };
}

/// Those of the surface's nodes that lie in a range of polar angles.
StressSurface make_stress_surface(const std::vector<SurfaceStress>& surface, const std::vector<Eigen::Vector3d>& points,
                                  int degree, const PolarAngle& polar_angle, double low, double high) {
  std::vector<int> nodes;
  std::map<int, const SurfaceStress*> stress_of;
  for (const auto& stress : surface) {
    const double angle = polar_angle(points[stress.node]);
    if (angle < low || angle > high) continue;
    nodes.push_back(stress.node);
    stress_of[stress.node] = &stress;
  }
  StressSurface result{make_trace(nodes, points, degree, polar_angle), {}};
  for (const int node : result.trace.nodes) result.stress.push_back(*stress_of.at(node));
  return result;
}

std::vector<geometry::Boundary> boundaries_of(HeldBoundary held) {
  switch (held) {
    case HeldBoundary::support:
      return {geometry::Boundary::support};
    case HeldBoundary::end_low:
      return {geometry::Boundary::end_low};
    case HeldBoundary::both_ends:
      return {geometry::Boundary::end_low, geometry::Boundary::end_high};
    case HeldBoundary::flange_face:
      return {geometry::Boundary::flange_face};
    case HeldBoundary::none:
      break;
  }
  return {};
}

template <int dim>
std::vector<Eigen::Vector3d> nodes_of(const ElasticProblem<dim>& problem) {
  std::vector<Eigen::Vector3d> nodes;
  nodes.reserve(problem.node_points().size());
  for (const auto& p : problem.node_points()) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int c = 0; c < dim; ++c) point[c] = p[c];
    nodes.push_back(point);
  }
  return nodes;
}

/// Which nodes lie on one of the boundaries.
template <int dim>
std::vector<bool> on_boundaries(const ElasticProblem<dim>& problem, const std::vector<geometry::Boundary>& boundaries) {
  std::vector<bool> result(problem.node_points().size(), false);
  for (const auto boundary : boundaries)
    for (const int n : problem.boundary_nodes(boundary)) result[n] = true;
  return result;
}

/// Numbers the DOFs that are not held (of ends that slide in their plane the axial ones are) and takes their stiffness.
template <int dim>
void add_free_stiffness(const ElasticProblem<dim>& problem, const std::vector<bool>& held,
                        const std::vector<bool>& sliding, SectorModel& model) {
  std::vector<int> row_of_dof(problem.dofs(), -1);
  model.dof.assign(model.nodes.size() * dim, -1);
  int rows = 0;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    for (int c = 0; c < dim; ++c)
      if (!held[n] && !(sliding[n] && c == 2)) {
        row_of_dof[problem.node_dofs()[n][c]] = rows;
        model.dof[n * dim + c] = rows++;
      }
  const Eigen::SparseMatrix<double> full = problem.stiffness();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(full.nonZeros()));
  for (int column = 0; column < full.outerSize(); ++column)
    if (row_of_dof[column] >= 0)
      for (Eigen::SparseMatrix<double>::InnerIterator it(full, column); it; ++it)
        if (row_of_dof[it.row()] >= 0) entries.emplace_back(row_of_dof[it.row()], row_of_dof[column], it.value());
  model.stiffness.resize(rows, rows);
  model.stiffness.setFromTriplets(entries.begin(), entries.end());
}

/// Matches the nodes of both cyclic interfaces; wholly held ones are left out. Throws InternalError where a node has no
/// partner within 1e-9 of the support radius (m).
template <int dim>
void add_cyclic_interfaces(const ElasticProblem<dim>& problem, const std::vector<bool>& held, double support_radius,
                           SectorModel& model) {
  const double same_height = axial_round_off(model.nodes);
  const auto radial_axial_order = [&](int a, int b) {
    const auto &p = model.nodes[a], &q = model.nodes[b];
    if (std::abs(p.z() - q.z()) > same_height) return p.z() < q.z();
    return std::hypot(p.x(), p.y()) < std::hypot(q.x(), q.y());
  };
  model.low_nodes = problem.boundary_nodes(geometry::Boundary::side_low);
  model.high_nodes = problem.boundary_nodes(geometry::Boundary::side_high);
  for (auto* side : {&model.low_nodes, &model.high_nodes}) {
    side->erase(std::remove_if(side->begin(), side->end(), [&](int n) { return held[n]; }), side->end());
    std::sort(side->begin(), side->end(), radial_axial_order);
  }
  require(model.low_nodes.size() == model.high_nodes.size(), "the two cyclic interfaces have ", model.low_nodes.size(),
          " and ", model.high_nodes.size(), " nodes");
  const Eigen::AngleAxisd pitch(model.pitch_angle, Eigen::Vector3d::UnitZ());
  for (std::size_t i = 0; i < model.low_nodes.size(); ++i)
    require((pitch * model.nodes[model.low_nodes[i]] - model.nodes[model.high_nodes[i]]).norm() < 1e-9 * support_radius,
            "a node of one cyclic interface has no partner on the other");
}

/// Root on both sides, and the rim where its surface is free.
template <int dim>
void add_stress_surfaces(const ElasticProblem<dim>& problem, double twist, const SectorModelOptions& options,
                         const std::vector<bool>& in_symmetry, SectorModel& model) {
  using geometry::Boundary;
  const auto surface = [&](const std::vector<Boundary>& boundaries, const PolarAngle& angle, double low, double high) {
    auto stress = problem.surface_stress(boundaries);
    // The other half has the opposite shear there: their mean is none.
    for (auto& s : stress)
      if (in_symmetry[s.node]) s.shear.clear();
    return make_stress_surface(stress, model.nodes, options.degree, angle, low, high);
  };
  const std::vector<Boundary> root = {Boundary::trailing_fillet, Boundary::leading_fillet, Boundary::root};
  model.root_low = surface(root, twisted_angle(twist), -M_PI, 0);
  model.root_high = surface(root, twisted_angle(twist), 0, M_PI);
  // A hoop or a flange goes beyond the ring's own outside.
  const bool band = std::isfinite(options.outside_radius);
  if (options.held != HeldBoundary::support)
    model.rim =
        surface({band ? Boundary::outside : Boundary::support}, outside_angle(twist, options.straight_z), -M_PI, M_PI);
}

template <int dim>
SectorModel discretise(const geometry::Mesh& mesh, const geometry::ToothProfile& profile, double support_radius,
                       const Material& material, const SectorModelOptions& options) {
  require(dim == 3 || !options.symmetric_end, "a plane sector has no end");
  const auto project = [&profile, support_radius, &options](geometry::Boundary boundary, const Eigen::Vector3d& point) {
    return profile.project_solid(boundary, point, support_radius, options.outside_radius);
  };
  const ElasticProblem<dim> problem(mesh, project, material, options.degree, options.refinements);

  SectorModel model;
  model.dimension = dim;
  model.pitch_angle = profile.gear().pitch_angle();
  model.nodes = nodes_of(problem);
  const auto held = on_boundaries(problem, boundaries_of(options.held));
  std::vector<geometry::Boundary> symmetric, sliding;
  if (options.symmetric_end) symmetric = sliding = {geometry::Boundary::end_high};
  if (options.axial_support) sliding.push_back(*options.axial_support);
  add_free_stiffness(problem, held, on_boundaries(problem, sliding), model);
  add_cyclic_interfaces(problem, held, support_radius, model);

  const auto trace_of_flank = [&](geometry::Boundary flank) {
    return make_trace(problem.boundary_nodes(flank), model.nodes, options.degree,
                      [&](const Eigen::Vector3d& p) { return profile.roll_length_at(std::hypot(p.x(), p.y())); });
  };
  model.flank = trace_of_flank(options.flank);
  const double twist = dim == 3 ? profile.twist() : 0;
  const auto asked = [&](SectorOutput output) { return options.outputs.count(output) > 0; };
  if (asked(SectorOutput::other_flank)) model.other_flank = trace_of_flank(geometry::opposite_flank(options.flank));
  if (asked(SectorOutput::outside))
    model.outside = make_trace(problem.boundary_nodes(geometry::Boundary::support), model.nodes, options.degree,
                               outside_angle(twist, options.straight_z));
  if (asked(SectorOutput::mass)) model.nodal_mass = problem.nodal_mass();
  if (asked(SectorOutput::field)) model.field = problem.vertex_field();
  if (asked(SectorOutput::stress))
    add_stress_surfaces(problem, twist, options, on_boundaries(problem, symmetric), model);
  return model;
}

SectorModel sector_model(const geometry::Mesh& mesh, const geometry::ToothProfile& profile, double support_radius,
                         const Material& material, const SectorModelOptions& options) {
  // Bodies are built on threads of our own. Tasks of deal.II beside them end the program where memory does (ulimit -v).
  static std::once_flag limited;
  std::call_once(limited, [] { dealii::MultithreadInfo::set_thread_limit(1); });
  return mesh.dimension == 2 ? discretise<2>(mesh, profile, support_radius, material, options)
                             : discretise<3>(mesh, profile, support_radius, material, options);
}

}  // namespace

}  // namespace annulus::fem

/// What core/loaded_library.h looks up.
extern "C" const annulus::fem::Elements annulus_elements_table;
const annulus::fem::Elements annulus_elements_table = {annulus::fem::sector_model};
