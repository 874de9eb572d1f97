#include "fem/contact/contact_face.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

namespace annulus::fem {

namespace {

/// The measured side of a gear between two positions on the common face, which begins `below` the gear's own.
geometry::FlankTopography::Slice measured_slice(const std::shared_ptr<const geometry::FlankTopography>& side,
                                                const geometry::Gear& gear, double below, double low, double high) {
  if (!side) return {};
  const double middle = gear.parameters().face_width / 2 - below;
  return side->slice(low - middle, high - middle);
}

}  // namespace

ContactFace::ContactFace(const FlankContact& flanks, std::vector<double> slice_edges, const FaceGaps& gaps)
    : flanks_(flanks),
      slice_edges_(std::move(slice_edges)),
      normal_factor_(std::cos(flanks.pair().pinion().base_helix_angle())),
      roll_per_z_(fem::roll_per_z(flanks)) {
  const double width = this->width();
  for (std::size_t s = 0; s + 1 < slice_edges_.size(); ++s) {
    const auto gap = [&](double z) {
      return flanks_.pinion().lead_modification(z + gaps.pinion_below) +
             flanks_.wheel().lead_modification(z + gaps.wheel_below) + gaps.misalignment * (z / width - 0.5);
    };
    // Without load the flanks touch where the gap is smallest, not where its mean is: a convex curve has one such
    // place.
    const double low = slice_edges_[s], high = slice_edges_[s + 1];
    const double inside = boost::math::tools::brent_find_minima(gap, low, high, 30).second;
    smallest_lead_gap_.push_back(std::min({gap(low), gap(high), inside}));
    lead_gap_.push_back(boost::math::quadrature::gauss<double, 7>::integrate(gap, low, high) / (high - low));
    const auto &pinion = flanks_.pair().pinion(), &wheel = flanks_.pair().wheel();
    const auto &pinion_side = pinion.parameters().leading_topography,
               &wheel_side = flanks_.wheel_flank() == geometry::Boundary::leading_flank
                                 ? wheel.parameters().leading_topography
                                 : wheel.parameters().trailing_topography;
    if (!pinion_side && !wheel_side) continue;
    measured_.push_back({measured_slice(pinion_side, pinion, gaps.pinion_below, low, high),
                         measured_slice(wheel_side, wheel, gaps.wheel_below, low, high)});
    auto& across = lead_across_.emplace_back();
    for (int k = 0; k < geometry::FlankTopography::slice_places; ++k)
      across.push_back(gap(low + (high - low) * k / (geometry::FlankTopography::slice_places - 1)));
  }
}

double ContactFace::smallest_lead_gap() const {
  return *std::min_element(smallest_lead_gap_.begin(), smallest_lead_gap_.end());
}

double ContactFace::measured_dip(int slice, double pinion_roll, double wheel_roll) const {
  if (measured_.empty()) return 0;
  const auto &pinion = measured_[slice].pinion, &wheel = measured_[slice].wheel;
  if (pinion.across.empty() && wheel.across.empty()) return 0;
  const auto& pair = flanks_.pair();
  const double pinion_radius = std::hypot(pair.pinion().base_radius(), pinion_roll),
               wheel_radius = std::hypot(pair.wheel().base_radius(), wheel_roll);
  const auto beyond_mean = [](const geometry::FlankTopography::Slice& side, std::size_t place, double radius) {
    return side.across.empty() ? 0 : side.across[place](radius) - side.mean(radius);
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < lead_across_[slice].size(); ++k)
    least = std::min(
        least, lead_across_[slice][k] + beyond_mean(pinion, k, pinion_radius) + beyond_mean(wheel, k, wheel_radius));
  return smallest_lead_gap_[slice] - least;
}

double ContactFace::slice_roll(int slice) const {
  const double middle = (slice_edges_.front() + slice_edges_.back()) / 2;
  return roll_per_z_ * ((slice_edges_[slice] + slice_edges_[slice + 1]) / 2 - middle);
}

double roll_per_z(const FlankContact& flanks) { return flanks.pinion().twist() * flanks.pair().pinion().base_radius(); }

}  // namespace annulus::fem
