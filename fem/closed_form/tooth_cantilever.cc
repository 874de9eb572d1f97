#include "fem/closed_form/tooth_cantilever.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace annulus::fem {
namespace {

constexpr int pieces = 48;  // of the flank, and of the fillet: the polygon's error is some 1e-4 of the deflection

}  // namespace

ToothCantilever::ToothCantilever(const geometry::ToothProfile& profile, const PlaneModuli& moduli)
    : profile_(profile), moduli_(moduli), root_radius_(profile.gear().root_radius()) {
  const Eigen::Vector2d end = profile_.fillet_point(1);
  root_half_angle_ = std::atan2(end.y(), end.x());
  const auto add = [&](const Eigen::Vector2d& p) { outline_.emplace_back(p.x(), p.y()); };
  for (int i = pieces; i > 0; --i) add(profile_.fillet_point(static_cast<double>(i) / pieces));
  const double form = profile_.roll_length_form(), tip = profile_.roll_length_tip();
  for (int i = 0; i <= pieces; ++i) add(profile_.flank_point(form + (tip - form) * i / pieces));
}

ToothCantilever::Load ToothCantilever::load(double roll_length) const {
  const Eigen::Vector2d point = profile_.flank_point(roll_length), force = -profile_.flank_normal(roll_length);
  Load result;
  result.depth = -point.y() / force.y();
  const double x_load = point.x() + result.depth * force.x();
  const double centroid = root_radius_ * std::sin(root_half_angle_) / root_half_angle_;
  result.root << force, force.y() * (x_load - centroid);
  result.compliance = cantilever_compliance(outline_, x_load, force, moduli_);
  return result;
}

double cantilever_compliance(const std::vector<std::pair<double, double>>& outline, double x_load,
                             const Eigen::Vector2d& force, const PlaneModuli& moduli) {
  constexpr double shear_factor = 1.2;  // rectangle, parabolic shear stress
  const double sense = outline.back().first > outline.front().first ? 1 : -1;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const auto& [x_low, y_low] = outline[i];
    const auto& [x_high, y_high] = outline[i + 1];
    // The piece up to the load.
    const double length = std::min(sense * (x_high - x_low), sense * (x_load - x_low));
    if (length <= 0) continue;
    const double slope = (y_high - y_low) / (x_high - x_low);
    sum += length *
           boost::math::quadrature::gauss<double, 7>::integrate(
               [&, x0 = x_low, y0 = y_low](double u) {
                 const double from_root = sense * length * (u + 1) / 2;
                 const double thickness = 2 * (y0 + slope * from_root), arm = x_load - x0 - from_root;
                 const double bending = 12 * arm * arm / (thickness * thickness) / moduli.young;
                 return (force.y() * force.y() * (bending + shear_factor / moduli.shear) +
                         force.x() * force.x() / moduli.young) /
                        thickness;
               },
               -1.0, 1.0) /
           2;
  }
  return sum;
}

}  // namespace annulus::fem
