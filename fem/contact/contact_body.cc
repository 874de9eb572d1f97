#include "fem/contact/contact_body.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/not_known.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// Stations of a flank that a patch loads.
struct StationRange {
  Eigen::Index first = 0, count = 0;
};

StationRange loaded_stations(const FlankPatch& patch) {
  const Eigen::Index stations = patch.weights.rows();
  Eigen::Index first = 0, end = stations;
  while (first < end && (patch.weights.row(first).array() == 0).all()) ++first;
  while (end > first && (patch.weights.row(end - 1).array() == 0).all()) --end;
  return {first, end - first};
}

/// Columns (station, slice) of `matrix` summed with the weights of every element of a patch; the first of them is that
/// of the first station of `loaded`.
Eigen::MatrixXd gather_columns(const Eigen::Ref<const Eigen::MatrixXd>& matrix, const FlankPatch& patch,
                               StationRange loaded, int slices) {
  // The elements of one slice are one product: most of what it multiplies is zero, and it is faster than the rest
  // alone.
  std::vector<std::vector<Eigen::Index>> by_slice(static_cast<std::size_t>(slices));
  for (std::size_t e = 0; e < patch.elements.size(); ++e)
    by_slice[static_cast<std::size_t>(patch.elements[e].slice)].push_back(static_cast<Eigen::Index>(e));
  Eigen::MatrixXd result(matrix.rows(), static_cast<Eigen::Index>(patch.elements.size()));
  for (int slice = 0; slice < slices; ++slice) {
    const auto& elements = by_slice[static_cast<std::size_t>(slice)];
    if (elements.empty()) continue;
    Eigen::MatrixXd weights(loaded.count, static_cast<Eigen::Index>(elements.size()));
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const int load = patch.elements[static_cast<std::size_t>(elements[i])].load;
      weights.col(static_cast<Eigen::Index>(i)) = patch.weights.col(load).segment(loaded.first, loaded.count);
    }
    using Columns = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
    const Columns columns(matrix.data() + slice * matrix.outerStride(), matrix.rows(), loaded.count,
                          Eigen::OuterStride<>(slices * matrix.outerStride()));
    const Eigen::MatrixXd gathered = lapack::product(columns, weights);
    for (std::size_t i = 0; i < elements.size(); ++i)
      result.col(elements[i]) = gathered.col(static_cast<Eigen::Index>(i));
  }
  return result;
}

/// A semi-ellipse 2 / sqrt(3) as long as an element has its second moment.
double own_spread(double half_length) { return 2 / std::sqrt(3.0) * half_length; }

}  // namespace

ContactBody::ContactBody(double base_radius, const TraceBasis& axial, const std::vector<double>& slice_edges)
    : base_radius_(base_radius), slices_(static_cast<int>(slice_edges.size()) - 1) {
  require(slices_ >= 1, "a contact needs at least one slice, not ", slices_);
  const int stations = std::max(1, axial.size());
  axial_ = Eigen::MatrixXd::Ones(stations, slices_);
  if (stations > 1) {
    for (int s = 0; s < slices_; ++s) {
      const auto mean = axial.mean_over(slice_edges[s], slice_edges[s + 1]);
      for (int i = 0; i < stations; ++i) axial_(i, s) = mean[i];
    }
  } else {
    require(slices_ == 1, "a plane body has one slice, not ", slices_);
    per_width_ = 1 / (slice_edges.back() - slice_edges.front());
  }
}

Eigen::MatrixXd ContactBody::compress(const Eigen::MatrixXd& ports) const {
  const Eigen::Index stations = axial_.rows(), rows = ports.rows() / stations, columns = ports.cols() / stations;
  if (stations == 1) return per_width_ * ports;
  Eigen::MatrixXd half(ports.rows(), columns * slices_);
  for (Eigen::Index u = 0; u < columns; ++u)
    half.middleCols(u * slices_, slices_) = lapack::product(ports.middleCols(u * stations, stations), axial_);
  Eigen::MatrixXd both(rows * slices_, columns * slices_);
  for (Eigen::Index u = 0; u < rows; ++u)
    both.middleRows(u * slices_, slices_) =
        lapack::transpose_product(axial_, Eigen::MatrixXd(half.middleRows(u * stations, stations)));
  return both;
}

Eigen::MatrixXd ContactBody::weights_on(const TraceBasis& flank, const std::vector<FlankLoad>& loads) const {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(flank.size(), static_cast<Eigen::Index>(loads.size()));
  static const auto rule = semi_ellipse_points<16>();
  for (std::size_t l = 0; l < loads.size(); ++l)
    for (const auto& [place, weight] : rule) {
      const double arc = loads[l].arc + loads[l].spread * place;
      const double roll = std::clamp(std::sqrt(2 * base_radius_ * std::max(arc, 0.0)), flank.low(), flank.high());
      const auto values = flank(roll);
      for (std::size_t k = 0; k < values.weights.size(); ++k)
        weights(values.first + static_cast<int>(k), static_cast<Eigen::Index>(l)) += weight * values.weights[k];
    }
  return weights;
}

double ContactBody::distance_to_end(const TraceBasis& flank, double arc) const {
  const double low = flank.low(), high = flank.high();
  const double distance = std::min(arc - low * low / (2 * base_radius_), high * high / (2 * base_radius_) - arc);
  require(distance > 0, "a pressure element lies ", -distance, " m beyond the end of the flank");
  return distance;
}

void ContactBody::find_weights(FlankPatch& patch, int tooth) const {
  patch.weights = weights_on(flank_of(tooth).body.flank, patch.loads);
}

Eigen::MatrixXd ContactBody::compliance(const FlankPatch& a, int tooth_a, const FlankPatch& b, int tooth_b) const {
  const auto [matrix, transposed] = block(tooth_a, tooth_b);
  const auto& first = transposed ? a : b;
  const auto& second = transposed ? b : a;
  const auto of_first = loaded_stations(first), of_second = loaded_stations(second);
  const auto part = matrix.block(of_second.first * slices_, of_first.first * slices_, of_second.count * slices_,
                                 of_first.count * slices_);
  const Eigen::MatrixXd columns = gather_columns(part, first, of_first, slices_).transpose();
  const Eigen::MatrixXd both = gather_columns(columns, second, of_second, slices_);
  return transposed ? both : Eigen::MatrixXd(both.transpose());
}

Eigen::VectorXd ContactBody::loads_of(const FlankPatch& patch, const Eigen::VectorXd& forces) const {
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(patch.weights.rows() * slices_);
  for (std::size_t e = 0; e < patch.elements.size(); ++e) {
    const auto [load, slice] = patch.elements[e];
    if (const double force = forces[static_cast<Eigen::Index>(e)]; force != 0)
      for (Eigen::Index u = 0; u < patch.weights.rows(); ++u)
        loads[u * slices_ + slice] += force * patch.weights(u, load);
  }
  return loads;
}

Eigen::VectorXd ContactBody::least_by_slice(const Eigen::VectorXd& displacement) const {
  return displacement.reshaped(slices_, displacement.size() / slices_).rowwise().minCoeff();
}

Eigen::VectorXd ContactBody::least_displacement(int at, const FlankPatch& patch, int tooth,
                                                const Eigen::VectorXd& forces) const {
  return least_by_slice(displacement(at, patch, tooth, forces));
}

Eigen::VectorXd ContactBody::displacement(int at, const FlankPatch& patch, int tooth,
                                          const Eigen::VectorXd& forces) const {
  const auto [matrix, transposed] = block(at, tooth);
  const Eigen::VectorXd loads = loads_of(patch, forces);
  const auto range = loaded_stations(patch);
  const Eigen::Index first = range.first * slices_, count = range.count * slices_;
  if (transposed) return matrix.middleRows(first, count).transpose() * loads.segment(first, count);
  return matrix.middleCols(first, count) * loads.segment(first, count);
}

Eigen::VectorXd ContactBody::slice_means(const Eigen::VectorXd& at_ports) const {
  const Eigen::Index stations = axial_.rows(), profile = at_ports.size() / stations;
  Eigen::VectorXd result(profile * slices_);
  for (Eigen::Index u = 0; u < profile; ++u)
    result.segment(u * slices_, slices_) = axial_.transpose() * at_ports.segment(u * stations, stations);
  return result;
}

Eigen::MatrixXd ContactBody::own_motions(const GearBody& body) const {
  const int stations = body.axial_stations();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(body.flank.size() * slices_, 3);
  for (int u = 0; u < body.flank.size(); ++u)
    for (int z = 0; z < stations; ++z) {
      const Eigen::RowVector3d motion = body.rigid_motion(u * stations + z, 0);
      for (int s = 0; s < slices_; ++s) result.row(u * slices_ + s) += axial_(z, s) * motion;
    }
  return result;
}

Eigen::MatrixXd ContactBody::motions(int tooth) const {
  const auto flank = flank_of(tooth);
  // The forces turn with the tooth; their moments stay.
  const double angle = flank.number * flank.body.pitch_angle, c = std::cos(angle), s = std::sin(angle);
  Eigen::MatrixXd result = flank.motions;
  result.col(0) = c * flank.motions.col(0) - s * flank.motions.col(1);
  result.col(1) = s * flank.motions.col(0) + c * flank.motions.col(1);
  return result;
}

Eigen::MatrixXd ContactBody::resultants(const FlankPatch& patch, int tooth) const {
  const Eigen::MatrixXd of_station = motions(tooth).transpose();
  return gather_columns(of_station, patch, {0, patch.weights.rows()}, slices_).transpose();
}

Eigen::MatrixXd ContactBody::port_weights(const FlankPatch& patch) const {
  const Eigen::Index stations = axial_.rows();
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(patch.weights.rows() * stations, static_cast<Eigen::Index>(patch.elements.size()));
  for (std::size_t e = 0; e < patch.elements.size(); ++e)
    for (Eigen::Index u = 0; u < patch.weights.rows(); ++u)
      if (const double w = patch.weights(u, patch.elements[e].load); w != 0)
        result.col(static_cast<Eigen::Index>(e)).segment(u * stations, stations) =
            w * axial_.col(patch.elements[e].slice);
  return result;
}

FlankCells::FlankCells(const TraceBasis& flank, double base_radius) {
  const auto& rolls = flank.stations();
  for (int e = 0; e < flank.elements(); ++e) {
    const double low = rolls[e * flank.degree()], high = rolls[(e + 1) * flank.degree()];
    centres_.push_back((low * low + high * high) / (4 * base_radius));
    lengths_.push_back((high * high - low * low) / (2 * base_radius));
  }
}

double FlankCells::length(double arc) const {
  const auto above = std::upper_bound(centres_.begin(), centres_.end(), arc);
  if (above == centres_.begin()) return lengths_.front();
  if (above == centres_.end()) return lengths_.back();
  const auto i = above - centres_.begin();
  const double t = (arc - centres_[i - 1]) / (centres_[i] - centres_[i - 1]);
  return (1 - t) * lengths_[i - 1] + t * lengths_[i];
}

CondensedBody::CondensedBody(GearBody body, double base_radius, const Material& material,
                             const std::vector<double>& slice_edges, std::optional<NearField> near_field,
                             double contact_slant)
    : ContactBody(base_radius, body.axial, slice_edges),
      body_(std::move(body)),
      half_plane_(material),
      near_field_(std::move(near_field)),
      cells_(near_field_ ? near_field_->fine : body_.flank, base_radius) {
  motions_ = own_motions(body_);
  for (int s = 0; s < slices(); ++s) slice_length_.push_back((slice_edges[s + 1] - slice_edges[s]) * contact_slant);
  for (int d = 0; d <= body_.compliance.max_offset(); ++d) compressed_.push_back(compress(body_.compliance.block(d)));
  for (const auto& compliance : compressed_) {
    bounds_.push_back(bounds_of(compliance));
    transposed_bounds_.push_back(bounds_of(compliance.transpose()));
  }
}

CondensedBody::Bounds CondensedBody::bounds_of(const Eigen::MatrixXd& compliance) const {
  Bounds bounds{Eigen::MatrixXd(slices(), compliance.cols()), Eigen::MatrixXd(slices(), compliance.cols())};
  for (Eigen::Index j = 0; j < compliance.cols(); ++j) {
    bounds.least.col(j) = least_by_slice(compliance.col(j));
    bounds.greatest.col(j) = -least_by_slice(-compliance.col(j));
  }
  return bounds;
}

Eigen::VectorXd CondensedBody::least_displacement(int at, const FlankPatch& patch, int tooth,
                                                  const Eigen::VectorXd& forces) const {
  const auto [number, transposed] = offset(at, tooth);
  const auto& bounds = (transposed ? transposed_bounds_ : bounds_)[static_cast<std::size_t>(number)];
  // The weights of a load on the stations of the mesh have both signs.
  const Eigen::VectorXd loads = loads_of(patch, forces);
  return bounds.least * loads.cwiseMax(0) + bounds.greatest * loads.cwiseMin(0);
}

FlankLoad CondensedBody::make_load(int, double arc, double half_length) const {
  // Cells to either side of the centre: quadratic cells then resolve the load to some tenths of a per cent of the near
  // field.
  constexpr double cells_in_half_width = 2.5;
  const double resolved = std::max(own_spread(half_length), cells_in_half_width * cells_.length(arc));
  return {arc, half_length, std::min(resolved, distance_to_end(body_.flank, arc))};
}

CondensedBody::Offset CondensedBody::offset(int tooth_a, int tooth_b) const {
  const int n = body_.teeth;
  int d = ((tooth_a - tooth_b) % n + n) % n;
  const bool mirrored = d > n - d;  // block(-d) is the transpose of block(d)
  if (mirrored) d = n - d;
  require(d < static_cast<int>(compressed_.size()), "teeth ", d, " apart, the compliance is formed for fewer than ",
          compressed_.size());
  return {d, mirrored};
}

ContactBody::Block CondensedBody::block(int tooth_a, int tooth_b) const {
  const auto [number, mirrored] = offset(tooth_a, tooth_b);
  return {compressed_[static_cast<std::size_t>(number)], mirrored};
}

Eigen::MatrixXd CondensedBody::near_field(const FlankPatch& patch) const {
  const auto loads = static_cast<Eigen::Index>(patch.loads.size());
  Eigen::MatrixXd correction = Eigen::MatrixXd::Zero(loads, loads);
  if (near_field_) {
    const Eigen::MatrixXd fine = weights_on(near_field_->fine, patch.loads);
    const Eigen::MatrixXd coarse = weights_on(near_field_->coarse, patch.loads);
    correction += fine.transpose() * near_field_->fine_compliance * fine;
    correction -= coarse.transpose() * near_field_->coarse_compliance * coarse;
  }
  // Loads that share no slice never meet.
  std::vector<std::vector<std::size_t>> in_slice(slices());
  for (std::size_t e = 0; e < patch.elements.size(); ++e) in_slice[patch.elements[e].slice].push_back(e);
  Eigen::MatrixXd half_plane = Eigen::MatrixXd::Constant(loads, loads, not_known);
  const auto elements = static_cast<Eigen::Index>(patch.elements.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(elements, elements);
  for (int s = 0; s < slices(); ++s)
    for (const std::size_t i : in_slice[s])
      for (const std::size_t j : in_slice[s]) {
        const int l = std::min(patch.elements[i].load, patch.elements[j].load);
        const int m = std::max(patch.elements[i].load, patch.elements[j].load);
        double& value = half_plane(l, m);
        if (std::isnan(value)) {
          const FlankLoad &p = patch.loads[l], &q = patch.loads[m];
          value = half_plane_.strips(p.arc - q.arc, p.half_length, q.half_length) -
                  half_plane_.semi_ellipses(p.arc - q.arc, p.spread, q.spread);
        }
        result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            (value + (correction(l, m) + correction(m, l)) / 2) / slice_length_[s];
      }
  return result;
}

ResolvedBody::ResolvedBody(std::vector<GearBody> teeth, int first_tooth, const Eigen::MatrixXd& compliance,
                           double base_radius, const std::vector<double>& slice_edges)
    : ContactBody(base_radius, teeth.front().axial, slice_edges), teeth_(std::move(teeth)), first_tooth_(first_tooth) {
  Eigen::Index row = 0;
  for (const auto& a : teeth_) {
    cells_.emplace_back(a.flank, base_radius);
    motions_.push_back(own_motions(a));
    compressed_.emplace_back();
    Eigen::Index column = 0;
    for (const auto& b : teeth_) {
      compressed_.back().push_back(compress(compliance.block(row, column, a.flank_ports(), b.flank_ports())));
      column += b.flank_ports();
    }
    row += a.flank_ports();
  }
}

FlankLoad ResolvedBody::make_load(int tooth, double arc, double half_length) const {
  return {arc, half_length, std::min(own_spread(half_length), distance_to_end(flank_of(tooth).body.flank, arc))};
}

double ResolvedBody::shortest_element(int tooth, double arc) const {
  (void)flank_of(tooth);
  return 1.1 * cells_[tooth - first_tooth_].length(arc);
}

Eigen::MatrixXd ResolvedBody::near_field(const FlankPatch& patch) const {
  const auto n = static_cast<Eigen::Index>(patch.elements.size());
  return Eigen::MatrixXd::Zero(n, n);
}

ContactBody::Block ResolvedBody::block(int tooth_a, int tooth_b) const {
  (void)flank_of(tooth_a);
  (void)flank_of(tooth_b);
  return {compressed_[tooth_a - first_tooth_][tooth_b - first_tooth_], false};
}

ContactBody::Flank ResolvedBody::flank_of(int tooth) const {
  require(tooth >= first_tooth_ && tooth < first_tooth_ + static_cast<int>(teeth_.size()), "tooth ", tooth,
          " has no mesh; the first of ", teeth_.size(), " that have one is ", first_tooth_);
  return {teeth_[tooth - first_tooth_], motions_[tooth - first_tooth_], tooth};
}

}  // namespace annulus::fem
