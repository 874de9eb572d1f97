#include "fem/contact/flank_contact.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Half the tooth angle at the base circle, extrapolated along the involute for internal gears.
double base_half_angle(const geometry::Gear& gear) {
  const double inv = geometry::involute(gear.transverse_pressure_angle());
  const double reference = gear.tooth_half_angle(gear.reference_radius());
  return gear.kind() == geometry::GearKind::internal ? reference - inv : reference + inv;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

namespace {

/// What is removed along the face alone leaves two involutes in every section.
bool profile_modified(const geometry::Gear& gear) {
  const auto& p = gear.parameters();
  return p.tip_relief != 0 || p.profile_crowning != 0 || p.profile_slope != 0;
}

}  // namespace

FlankContact::FlankContact(const geometry::GearPair& pair)
    : pair_(pair),
      pinion_(pair.pinion()),
      wheel_(pair.wheel()),
      pinion_base_half_angle_(base_half_angle(pair.pinion())),
      wheel_base_half_angle_(base_half_angle(pair.wheel())),
      normal_factor_(std::cos(pair.pinion().base_helix_angle())),
      modified_(profile_modified(pair.pinion()) || profile_modified(pair.wheel())) {}

double FlankContact::pinion_tooth_angle(double contact_roll) const {
  const double alpha = pair_.working_pressure_angle(), turned = contact_roll / pair_.pinion().base_radius();
  return (pair_.internal() ? 0.0 : M_PI) + turned - pinion_base_half_angle_ - alpha;
}

double FlankContact::wheel_tooth_angle(double contact_roll) const {
  const double alpha = pair_.working_pressure_angle();
  const double turned = pair_.wheel_roll_length(contact_roll) / pair_.wheel().base_radius();
  return turned - alpha + (pair_.internal() ? wheel_base_half_angle_ : -wheel_base_half_angle_);
}

double FlankContact::guessed_opposite(double pinion_roll, double contact_roll) const {
  // As far from the contact along the flank as on the pinion; arcs of involutes are roll^2 / (2 base radius).
  const double wheel_contact = pair_.wheel_roll_length(contact_roll), sense = pair_.internal() ? 1 : -1;
  const double squared = wheel_contact * wheel_contact + sense * pair_.wheel().base_radius() /
                                                             pair_.pinion().base_radius() *
                                                             (pinion_roll * pinion_roll - contact_roll * contact_roll);
  if (contact_roll <= 0 || wheel_contact <= 0 || squared <= 0) return pair_.wheel_roll_length(pinion_roll);
  return std::sqrt(squared);
}

std::pair<double, double> FlankContact::opposite(double pinion_roll, double contact_roll) const {
  const double pinion_angle = pinion_tooth_angle(contact_roll);
  const Eigen::Rotation2Dd turn(wheel_tooth_angle(contact_roll) - pinion_angle);
  const Eigen::Vector2d wheel_axis = -(Eigen::Rotation2Dd(-pinion_angle) * Eigen::Vector2d(pair_.centre_distance(), 0));
  const double side = pair_.internal() ? -1 : 1;  // trailing flank: the mirror image of the leading one
  const double base = pair_.wheel().base_radius();
  const auto [point, normal] = pinion_.flank_place(pinion_roll);

  /// A point of the wheel's flank, seen from the pinion's: distance, and the slope of its part across the normal.
  struct Seen {
    Eigen::Vector2d distance;
    double across, slope;
  };
  const auto seen = [&, &origin = point, &along = normal](double roll) -> Seen {
    const auto place = wheel_.flank_place(roll);
    const Eigen::Vector2d on_wheel(place.point.x(), side * place.point.y());
    const Eigen::Vector2d distance = turn * on_wheel + wheel_axis - origin;
    const Eigen::Vector2d tangent = turn * Eigen::Vector2d(place.normal.y(), -side * place.normal.x());
    return {distance, cross(distance, along), cross(tangent, along)};
  };
  const auto newton = [&](double roll) {
    const auto here = seen(roll);
    return std::pair(roll - here.across / (here.slope * roll / base), here.across);
  };
  constexpr double same = 1e-15;  // of the base radius
  // Both normals turn by roll / base radius. While they are less than a right angle from being opposed, the distance
  // from the pinion's normal grows (or falls) with the wheel's roll: that brackets the opposite point, and there is
  // one.
  const double opposed =
      pair_.wheel_roll_length(contact_roll) + (pinion_roll - contact_roll) * base / pair_.pinion().base_radius();
  double low = std::max(0.0, opposed - 1.5 * base), high = opposed + 1.5 * base;
  if (high <= low) return {0, 0};
  double roll = std::clamp(guessed_opposite(pinion_roll, contact_roll), low, high);
  // Mostly the first steps find it, without looking at the ends.
  constexpr int quick_steps = 8;
  for (int step = 0; step < quick_steps && roll > low && roll < high; ++step) {
    const double next = newton(roll).first, change = std::abs(next - roll);
    roll = next;
    if (change < same * base && roll > low && roll < high) return {roll, seen(roll).distance.dot(normal)};
  }
  const auto at_high = seen(high);
  const double sense = at_high.slope > 0 ? 1 : -1;
  if (sense * seen(low).across >= 0) return {0, 0};
  if (sense * at_high.across <= 0) return {std::numeric_limits<double>::infinity(), 0};
  if (!(roll > low && roll < high)) roll = (low + high) / 2;
  for (int step = 0; step < 200; ++step) {
    auto [next, across] = newton(roll);
    (sense * across > 0 ? high : low) = roll;
    if (!(next > low && next < high)) next = (low + high) / 2;
    const double change = std::abs(next - roll);
    roll = next;
    if (change < same * base) break;
  }
  return {roll, seen(roll).distance.dot(normal)};
}

FlankContact::Match FlankContact::match(double pinion_roll, double contact_roll,
                                        const FlankDeviations* measured) const {
  const auto [roll, gap] = opposite(pinion_roll, contact_roll);
  if (!(roll > 0 && std::isfinite(roll)))
    throw SolverError(
        fmt::format("no point of the wheel flank lies opposite to the pinion flank at the roll length "
                    "{:.6g} mm, the theoretical contact at {:.6g} mm",
                    1e3 * pinion_roll, 1e3 * contact_roll));
  double removed = pinion_.modification(pinion_roll) + wheel_.modification(roll);
  if (measured != nullptr)
    removed += measured->pinion.mean(std::hypot(pair_.pinion().base_radius(), pinion_roll)) +
               measured->wheel.mean(std::hypot(pair_.wheel().base_radius(), roll));
  // What is removed normal to a helical flank is longer in its transverse section.
  return {roll, gap + removed / normal_factor_};
}

bool FlankContact::face_each_other(double contact_roll) const {
  const double wheel_low = std::min(wheel_.roll_length_form(), wheel_.roll_length_tip());
  const double wheel_high = std::max(wheel_.roll_length_form(), wheel_.roll_length_tip());
  const double at_low = opposite(pinion_.roll_length_form(), contact_roll).first;
  const double at_high = opposite(pinion_.roll_length_tip(), contact_roll).first;
  return std::max(at_low, at_high) > wheel_low && std::min(at_low, at_high) < wheel_high;
}

FlankContact::Interval FlankContact::domain(double contact_roll) const {
  const double low = pinion_.roll_length_form(), high = pinion_.roll_length_tip();
  const double wheel_low = std::min(wheel_.roll_length_form(), wheel_.roll_length_tip());
  const double wheel_high = std::max(wheel_.roll_length_form(), wheel_.roll_length_tip());
  // The opposite point moves monotonously along the wheel flank.
  const auto wheel_roll = [&](double roll) { return std::min(opposite(roll, contact_roll).first, 2 * wheel_high); };
  const auto crossing = [&](double bound) {
    boost::math::tools::eps_tolerance<double> tolerance(50);
    std::uintmax_t iterations = 100;
    return boost::math::tools::toms748_solve([&](double r) { return wheel_roll(r) - bound; }, low, high, tolerance,
                                             iterations);
  };
  const double at_low = wheel_roll(low), at_high = wheel_roll(high);
  const double least = std::min(at_low, at_high), most = std::max(at_low, at_high);
  if (most <= wheel_low || least >= wheel_high) return {};
  Interval interval{low, high};
  const bool rising = at_high > at_low;
  // Of each bracket the end inside the domain: a point of the wheel lies opposite to it.
  for (const double bound : {wheel_low, wheel_high}) {
    if (bound <= least || bound >= most) continue;
    const auto [below, above] = crossing(bound);
    if (rising == (bound == wheel_low))
      interval.low = above;
    else
      interval.high = below;
  }
  return interval;
}

double FlankContact::nearest_roll(double contact_roll, const Interval& domain, const FlankDeviations* measured) const {
  require(!domain.empty(), "flanks that do not face each other have no smallest gap");
  // Two involutes open to both sides of their contact as long as both have one.
  if (!modified_ && measured == nullptr && contact_roll > 0 && pair_.wheel_roll_length(contact_roll) > 0)
    return std::clamp(contact_roll, domain.low, domain.high);
  const auto gap = [&](double roll) { return match(roll, contact_roll, measured).gap; };
  // Modifications can make several dents; look at a raster first.
  constexpr int raster = 64;
  int best = 0;
  double least = gap(domain.low);
  for (int i = 1; i <= raster; ++i) {
    const double g = gap(domain.low + (domain.high - domain.low) * i / raster);
    if (g < least) least = g, best = i;
  }
  const double step = (domain.high - domain.low) / raster;
  const double a = std::max(domain.low, domain.low + (best - 1) * step),
               b = std::min(domain.high, domain.low + (best + 1) * step);
  // In parts of the interval: the tolerance has an absolute share.
  const auto [part, value] =
      boost::math::tools::brent_find_minima([&](double t) { return gap(a + t * (b - a)); }, 0.0, 1.0, 40);
  const double clamped = std::clamp(contact_roll, domain.low, domain.high);
  // Gaps are differences of places and know no less than their round-off, which must not choose the point: over so
  // flat a minimum it would move it far.
  const double round_off = 16 * std::numeric_limits<double>::epsilon() * pair_.centre_distance();
  return gap(clamped) <= value + round_off ? clamped : a + part * (b - a);
}

double FlankContact::smallest_gap(double contact_roll) const {
  return match(nearest_roll(contact_roll, domain(contact_roll)), contact_roll).gap;
}

int wheel_tooth(const FlankContact& flanks, int index, int cycle) {
  const auto& pair = flanks.pair();
  const int passed = pair.driver() == geometry::GearRole::pinion ? index - cycle : index + cycle;
  return pair.internal() ? passed : -passed;
}

double pitch_point_angle(const FlankContact& flanks, int index, double roll, int cycle) {
  const double tooth = wheel_tooth(flanks, index, cycle) * flanks.pair().wheel().pitch_angle();
  const double angle = flanks.wheel_tooth_angle(roll) - tooth;
  return flanks.pair().internal() ? angle : -angle;  // the ring mesh is solved in a mirror image of the real one
}

}  // namespace annulus::fem
