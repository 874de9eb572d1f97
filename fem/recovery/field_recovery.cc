#include "fem/recovery/field_recovery.h"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {

struct FieldRecovery::Interior {
  std::vector<int> low, high;  // rows of the stiffness on the interfaces, in the order of the condensed sector
  std::vector<int> place;      // row of the stiffness -> row of the interior, or -1 on a interface
  int size = 0;
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> factor;
};

namespace {

int number(int sector, int teeth) { return ((sector % teeth) + teeth) % teeth; }

SectorModel field_model(const BodySource& source, const Material& material) {
  auto options = source.options;
  options.outputs.erase(SectorOutput::stress);
  options.outputs.insert(SectorOutput::field);
  return make_sector_model(source.mesh, *source.profile, source.support_radius, material, options);
}

}  // namespace

FieldRecovery::FieldRecovery(const GearBody& body, const BodySource& source, const Material& material,
                             double face_width, const SupportRow* supports)
    : body_(body),
      supports_(supports),
      per_width_(body.axial_stations() > 1 ? 1 : 1 / face_width),
      model_(field_model(source, material)),
      interior_(std::make_unique<Interior>()) {
  if (supports != nullptr) {
    require(!model_.outside.nodes.empty(), "supports on a body without an outside");
    for (const auto& arc : supports->plan().arcs()) acting_.push_back(on_outside(arc, model_.outside));
    for (auto& load : other_flank_loads(model_, *source.profile, source.options.flank, source.other_flank))
      acting_.push_back(std::move(load));
  }
  auto& in = *interior_;
  const auto rows_of = [&](const std::vector<int>& nodes) {
    std::vector<int> rows;
    for (const int node : nodes)
      for (int c = 0; c < model_.dimension; ++c)
        if (const int row = model_.dof[node * model_.dimension + c]; row >= 0) rows.push_back(row);
    return rows;
  };
  in.low = rows_of(model_.low_nodes);
  in.high = rows_of(model_.high_nodes);
  require(static_cast<int>(in.low.size()) == body.compliance.interface_size(),
          "a sector unlike the one that was condensed");
  in.place.assign(static_cast<std::size_t>(model_.stiffness.rows()), 0);
  for (const auto* side : {&in.low, &in.high})
    for (const int row : *side) in.place[row] = -1;
  for (auto& p : in.place)
    if (p == 0) p = in.size++;
  // Rows keep their order: every column is copied without those on the interfaces.
  Eigen::SparseMatrix<double> inner(in.size, in.size);
  inner.reserve(model_.stiffness.nonZeros());
  for (int column = 0; column < model_.stiffness.outerSize(); ++column) {
    if (in.place[column] < 0) continue;
    inner.startVec(in.place[column]);
    for (Eigen::SparseMatrix<double>::InnerIterator it(model_.stiffness, column); it; ++it)
      if (in.place[it.row()] >= 0) inner.insertBack(in.place[it.row()], in.place[column]) = it.value();
  }
  inner.finalize();
  lapack::use_one_thread();
  in.factor.compute(inner);
  if (in.factor.info() != Eigen::Success)
    throw SolverError(
        fmt::format("the stiffness of a tooth ({} DOFs, E = {:g} Pa, Poisson's ratio {:g}) is not positive definite: a "
                    "cell of its mesh is inverted",
                    in.size, material.youngs_modulus, material.poisson_ratio));
}

FieldRecovery::~FieldRecovery() = default;

Eigen::MatrixXd FieldRecovery::interface_displacement(int interface, const std::vector<ToothForces>& teeth,
                                                      const Eigen::VectorXd& supports) const {
  const auto& c = body_.compliance;
  const int ports = body_.flank_ports();
  Eigen::MatrixXd v = Eigen::MatrixXd::Zero(c.interface_size(), 1);
  for (const auto& t : teeth) {
    c.add_interface_displacement(interface - t.tooth, per_width_ * c.low().leftCols(ports) * t.ports, v);
    c.add_interface_displacement(interface - t.tooth - 1, per_width_ * c.high().leftCols(ports) * t.ports, v);
  }
  if (supports_ != nullptr) v += supports_->interface_displacement(interface, supports);
  return v;
}

Eigen::VectorXd FieldRecovery::sector_displacement(int sector, const std::vector<ToothForces>& teeth,
                                                   const Eigen::VectorXd& supports) const {
  const auto& in = *interior_;
  const int dim = model_.dimension;
  const Eigen::MatrixXd low = interface_displacement(sector, teeth, supports),
                        high = interface_displacement(sector + 1, teeth, supports);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(model_.stiffness.rows()), f = u;
  for (std::size_t i = 0; i < in.low.size(); ++i) u[in.low[i]] = low(static_cast<Eigen::Index>(i), 0);
  // The high interface is seen in the frame of the next sector.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(model_.pitch_angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (std::size_t i = 0, node = 0; i < in.high.size(); ++node) {
    int free = 0;
    while (free < dim && model_.dof[model_.high_nodes[node] * dim + free] >= 0) ++free;
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd turned = turn.topLeftCorner(free, free) * high.col(0).segment(at, free);
    for (int c = 0; c < free; ++c) u[in.high[i + static_cast<std::size_t>(c)]] = turned[c];
    i += static_cast<std::size_t>(free);
  }

  const auto add_force = [&](int node, const Eigen::Vector3d& force) {
    for (int c = 0; c < dim; ++c)
      if (const int row = model_.dof[node * dim + c]; row >= 0) f[row] += per_width_ * force[c];
  };
  for (const auto& t : teeth) {
    if (number(t.tooth, body_.teeth) != number(sector, body_.teeth)) continue;
    for (int p = 0; p < body_.flank_ports(); ++p) add_force(body_.ports[p].node, t.ports[p] * body_.ports[p].direction);
  }
  if (supports_ != nullptr) {
    const auto& all = supports_->plan().forces();
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const auto& [where, arc] : all[i].pieces)
        if (where == number(sector, body_.teeth))
          for (const auto& load : acting_[arc])
            add_force(load.node, all[i].weight * supports[static_cast<Eigen::Index>(i)] * load.force);
  }
  f -= model_.stiffness * u;
  Eigen::VectorXd inner(in.size);
  for (std::size_t row = 0; row < in.place.size(); ++row)
    if (in.place[row] >= 0) inner[in.place[row]] = f[static_cast<Eigen::Index>(row)];
  const Eigen::VectorXd solved = in.factor.solve(inner);
  for (std::size_t row = 0; row < in.place.size(); ++row)
    if (in.place[row] >= 0) u[static_cast<Eigen::Index>(row)] = solved[in.place[row]];

  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model_.dof.size()));
  for (std::size_t k = 0; k < model_.dof.size(); ++k)
    if (model_.dof[k] >= 0) all[static_cast<Eigen::Index>(k)] = u[model_.dof[k]];
  return all;
}

BodyField FieldRecovery::field(const std::vector<ToothForces>& teeth, const Eigen::VectorXd& supports,
                               const Eigen::VectorXd& rigid, bool mirrored) const {
  const int dim = model_.dimension, stresses = dim == 3 ? 6 : 4;
  const auto& grid = model_.field;
  const auto [low, high] =
      std::minmax_element(teeth.begin(), teeth.end(), [](const auto& a, const auto& b) { return a.tooth < b.tooth; });
  constexpr int most_vertices = 20000;
  const int fit = std::max(3, most_vertices / static_cast<int>(grid.nodes.size()));
  // As far as the body was composed.
  const bool whole = body_.compliance.max_interface_offset() == body_.teeth / 2;
  const int farthest = whole ? body_.teeth : body_.compliance.max_interface_offset() - 1;
  const int first = std::max(low->tooth - fit / 2, high->tooth - farthest);
  const int last = std::min({high->tooth + fit / 2, low->tooth + farthest, first + body_.teeth - 1});
  const double side = mirrored ? -1 : 1;
  const Eigen::Vector3d mirror(1, side, 1);
  BodyField result;
  result.mesh.dimension = dim;
  result.sectors = last - first + 1;
  for (int sector = first; sector <= last; ++sector) {
    const Eigen::VectorXd u = sector_displacement(sector, teeth, supports);
    const Eigen::VectorXd stress = grid.stress * u;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(sector * model_.pitch_angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const auto first_vertex = static_cast<std::uint32_t>(result.mesh.vertices.size());
    for (std::size_t v = 0; v < grid.nodes.size(); ++v) {
      const int node = grid.nodes[v];
      const Eigen::Vector3d place = turn * model_.nodes[node];
      Eigen::Vector3d own = Eigen::Vector3d::Zero();
      own.head(dim) = u.segment(node * dim, dim);
      Eigen::Vector3d moved = turn * own;
      if (supports_ != nullptr) {
        Eigen::Vector3d rotation(0, 0, rigid[2]);
        if (rigid.size() == 5) rotation.head<2>() = rigid.tail<2>();
        moved += Eigen::Vector3d(rigid[0], rigid[1], 0) + rotation.cross(place);
      }
      const auto s = stress.segment(static_cast<Eigen::Index>(v) * stresses, stresses);
      Eigen::Matrix3d tensor;
      tensor << s[0], s[3], dim == 3 ? s[5] : 0, s[3], s[1], dim == 3 ? s[4] : 0, dim == 3 ? s[5] : 0,
          dim == 3 ? s[4] : 0, s[2];
      tensor = (mirror.asDiagonal() * turn * tensor * turn.transpose() * mirror.asDiagonal()).eval();
      result.mesh.vertices.push_back(mirror.cwiseProduct(place));
      result.displacement.push_back(mirror.cwiseProduct(moved));
      result.stress.push_back({tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(1, 2), tensor(2, 0)});
    }
    for (auto cell : grid.cells) {
      // Still counter-clockwise in the mirror.
      if (mirrored)
        for (const int base : {0, 4}) std::reverse(cell.begin() + base, cell.begin() + base + 4);
      for (int k = 0; k < (dim == 3 ? 8 : 4); ++k) cell[k] += first_vertex;
      result.mesh.cells.push_back(cell);
      result.mesh.regions.push_back(geometry::Mesh::Region::tooth);
    }
  }
  return result;
}

}  // namespace annulus::fem
