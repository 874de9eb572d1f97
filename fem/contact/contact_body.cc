#include "fem/contact/contact_body.h"

#include <Eigen/Geometry>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// (A kron I)^T M for A with few entries per column: rows of M are grouped in blocks of `group`.
Eigen::MatrixXd gather_rows(const Eigen::MatrixXd& weights, const Eigen::MatrixXd& matrix, int group) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(weights.cols() * group, matrix.cols());
  for (Eigen::Index e = 0; e < weights.cols(); ++e)
    for (Eigen::Index u = 0; u < weights.rows(); ++u)
      if (weights(u, e) != 0)
        result.middleRows(e * group, group) += weights(u, e) * matrix.middleRows(u * group, group);
  return result;
}

}  // namespace

ContactBody::ContactBody(GearBody body, const std::vector<double>& slice_edges, std::vector<NearFieldTerm> near_field)
    : body_(std::move(body)), slices_(static_cast<int>(slice_edges.size()) - 1), near_field_(std::move(near_field)) {
  require(slices_ >= 1, "a contact needs at least one slice");
  for (int s = 0; s < slices_; ++s) slice_width_.push_back(slice_edges[s + 1] - slice_edges[s]);
  const double width = slice_edges.back() - slice_edges.front();
  const int stations = body_.axial_stations();
  axial_ = Eigen::MatrixXd::Ones(stations, slices_);
  double per_width = 1;
  if (stations > 1) {
    for (int s = 0; s < slices_; ++s) {
      const auto mean = body_.axial.mean_over(slice_edges[s], slice_edges[s + 1]);
      for (int i = 0; i < stations; ++i) axial_(i, s) = mean[i];
    }
  } else {
    require(slices_ == 1, "a plane body has one slice");
    per_width = 1 / width;  // plane compliances are per unit of width
  }

  // Condense the axial direction once: compliance between profile stations and slices.
  const int profile = body_.flank.size(), ports = body_.flank_ports();
  for (int d = 0; d <= body_.compliance.max_offset(); ++d) {
    const Eigen::MatrixXd full = body_.compliance.block(d).topLeftCorner(ports, ports);
    Eigen::MatrixXd columns(ports, profile * slices_);
    for (int u = 0; u < profile; ++u)
      columns.middleCols(u * slices_, slices_) = lapack::product(full.middleCols(u * stations, stations), axial_);
    Eigen::MatrixXd both(profile * slices_, profile * slices_);
    for (int u = 0; u < profile; ++u)
      both.middleRows(u * slices_, slices_) =
          lapack::transpose_product(axial_, Eigen::MatrixXd(columns.middleRows(u * stations, stations)));
    compressed_.push_back(per_width * both);
  }
}

Eigen::MatrixXd ContactBody::compliance(const Weights& a, int tooth_a, const Weights& b, int tooth_b) const {
  const int n = body_.teeth;
  int d = ((tooth_a - tooth_b) % n + n) % n;
  const bool mirrored = d > n - d;
  if (mirrored) d = n - d;
  require(d < static_cast<int>(compressed_.size()), "teeth too far apart for the formed compliance");
  const auto& block = compressed_[d];
  const Eigen::MatrixXd rows = gather_rows(a, mirrored ? Eigen::MatrixXd(block.transpose()) : block, slices_);
  return gather_rows(b, rows.transpose(), slices_).transpose();
}

Eigen::MatrixXd ContactBody::near_field(const std::vector<std::vector<double>>& rolls,
                                        const std::vector<std::vector<double>>& weights) const {
  const auto elements = static_cast<Eigen::Index>(rolls.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(elements * slices_, elements * slices_);
  if (near_field_.empty()) return result;
  Eigen::MatrixXd plane = Eigen::MatrixXd::Zero(elements, elements);
  for (const auto& term : near_field_) {
    Weights w = Weights::Zero(term.flank.size(), elements);
    for (Eigen::Index e = 0; e < elements; ++e)
      for (std::size_t q = 0; q < rolls[e].size(); ++q) {
        const auto values = term.flank(rolls[e][q]);
        for (std::size_t i = 0; i < values.weights.size(); ++i)
          w(values.first + static_cast<int>(i), e) += weights[e][q] * values.weights[i];
      }
    plane += term.sign * gather_rows(w, gather_rows(w, term.compliance, 1).transpose(), 1);
  }
  for (Eigen::Index i = 0; i < elements; ++i)
    for (Eigen::Index j = 0; j < elements; ++j)
      for (int s = 0; s < slices_; ++s) result(i * slices_ + s, j * slices_ + s) = plane(i, j) / slice_width_[s];
  return result;
}

Eigen::MatrixXd ContactBody::port_weights(const Weights& a) const {
  const Eigen::Index stations = axial_.rows();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.rows() * stations, a.cols() * slices_);
  for (Eigen::Index e = 0; e < a.cols(); ++e)
    for (Eigen::Index u = 0; u < a.rows(); ++u)
      if (a(u, e) != 0) result.block(u * stations, e * slices_, stations, slices_) = a(u, e) * axial_;
  return result;
}

Eigen::MatrixXd ContactBody::resultants(const Weights& a, int tooth) const {
  const int stations = body_.axial_stations();
  Eigen::MatrixXd of_station(body_.flank.size() * slices_, 3);
  for (int u = 0; u < body_.flank.size(); ++u)
    for (int s = 0; s < slices_; ++s) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (int z = 0; z < stations; ++z) sum += axial_(z, s) * body_.rigid_motion(u * stations + z, tooth);
      of_station.row(u * slices_ + s) = sum;
    }
  return gather_rows(a, of_station, slices_);
}

}  // namespace annulus::fem
