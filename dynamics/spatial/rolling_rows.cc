#include "dynamics/spatial/rolling_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"

namespace annulus::dynamics {

namespace {

/// An approach of raceways under a usual load, at which the stiffness of a row "in contact" is taken.
constexpr double usual_approach = 10e-6;  // m

void check(const RollingRow& row) {
  const bool ball = row.element == RollingRow::Element::ball;
  const char* name = ball ? "balls" : "rollers";
  if (row.count < 3 || !(row.diameter > 0) || !(ball || row.length > 0) || !std::isfinite(row.clearance))
    throw InputError(fmt::format("a row of {} needs three or more of them and positive sizes, not {} of {:g} m{}", name,
                                 row.count, row.diameter,
                                 ball ? "" : fmt::format(" and a length of {:g} m", row.length)));
  if ((ball || row.contact_angle != 0) && !(row.pitch_diameter > row.diameter))
    throw InputError(fmt::format("a row of {} of {:g} m has a pitch diameter of {:g} m; it must be larger", name,
                                 row.diameter, row.pitch_diameter));
  const double apart = row.pitch_diameter * std::sin(std::numbers::pi / row.count);
  if (row.pitch_diameter > 0 && !(apart > row.diameter))
    throw InputError(
        fmt::format("{} {} of {:g} m on a diameter of {:g} m overlap: the middles of neighbours are {:.4g} "
                    "m apart",
                    row.count, name, row.diameter, row.pitch_diameter, apart));
  if (!ball && row.contact_angle != 0 && !(row.pitch_diameter > row.length * std::abs(std::sin(row.contact_angle))))
    throw InputError(
        fmt::format("rollers of a length of {:g} m reach the axis at their end: the pitch diameter is {:g} "
                    "m, the contact angle {:g} rad",
                    row.length, row.pitch_diameter, row.contact_angle));
  if (!(std::abs(row.contact_angle) < std::numbers::pi / 2))
    throw InputError(fmt::format("a row of {} has a contact angle of {:g} rad, not between -pi/2 and pi/2", name,
                                 row.contact_angle));
  if (ball && !(row.inner_groove > 0.5 && row.outer_groove > 0.5))
    throw InputError(fmt::format("grooves of {:g} and {:g} of the ball's diameter: their radii must exceed its half",
                                 row.inner_groove, row.outer_groove));
  const double most = 2 * (row.inner_groove + row.outer_groove - 1) * row.diameter * std::cos(row.contact_angle);
  if (ball && !(row.clearance < most))
    throw InputError(
        fmt::format("a clearance of {:g} m takes the balls out of their grooves, whose centres are {:.4g} m "
                    "apart across the axis",
                    row.clearance, most / 2));
}

std::vector<int> coordinates_of(const RollingRow& row, Motions motions) {
  if (motions == Motions::in_plane) return {0, 1};
  if (row.element == RollingRow::Element::roller && row.contact_angle == 0) return {0, 1, 3, 4};
  return {0, 1, 2, 3, 4};
}

/// Motion of the inner ring against the outer one, from that of the body.
double sign_of(const RollingRow& row) { return row.ring == RollingRow::Ring::inner ? 1 : -1; }
/// Contact angle for a displacement of the inner ring along +z.
double inner_angle(const RollingRow& row) { return sign_of(row) * row.contact_angle; }
double place_of(const RollingRow& row, int element) { return 2 * std::numbers::pi * element / row.count; }

/// x, y, z, about x, about y: displacement of the inner ring at an angle around the axis, at `radius` and `z`, along
/// (cos, sin) of `angle` out of the transverse plane.
Eigen::Matrix<double, 5, 1> displacement(double around, double radius, double z, double angle) {
  const double c = std::cos(around), s = std::sin(around), arm = z * std::cos(angle) - radius * std::sin(angle);
  return {c * std::cos(angle), s * std::cos(angle), std::sin(angle), -arm * s, arm * c};
}

template <class Vector>
Eigen::VectorXd taken(const Vector& all, const std::vector<int>& coordinates) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i) result[static_cast<Eigen::Index>(i)] = all[coordinates[i]];
  return result;
}

/// What keeps an unloaded body in its place: along x, y and z.
ElasticLaw::State in_play(const Eigen::VectorXd& deflection, const std::vector<int>& coordinates, double stiffness) {
  const Eigen::Index n = deflection.size();
  ElasticLaw::State state{0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  const double within = stiffness_in_play * stiffness;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (coordinates[static_cast<std::size_t>(i)] > 2) continue;
    state.energy += within * deflection[i] * deflection[i] / 2;
    state.force[i] = within * deflection[i];
    state.tangent(i, i) = within;
  }
  return state;
}

class RollerRowLaw final : public RollingRowLaw {
 public:
  RollerRowLaw(const RollingRow& row, Motions motions) : RollingRowLaw(coordinates_of(row, motions)) {
    constexpr double per_m = 1e3;  // mm
    stiffness_ = 35948 * std::pow(per_m * row.length, 8.0 / 9) * std::pow(per_m, exponent) / slices;
    const double angle = inner_angle(row);
    for (std::size_t i = 0; i < slices; ++i) {
      const double share = (2 * static_cast<double>(i) + 1) / slices - 1;
      along_[i] = share * row.length / 2;
      gaps_[i] = row.clearance / 2 * std::cos(angle) + 2 * -0.00035 * row.diameter * std::log1p(-share * share);
      if (i == 0 || gaps_[i] < least_gap_) least_gap_ = gaps_[i];
    }
    const auto measure = [&](int roller, double along) {
      const double radius = row.pitch_diameter / 2 - along * std::sin(angle), z = along * std::cos(angle);
      return Eigen::VectorXd(sign_of(row) *
                             taken(displacement(place_of(row, roller), radius, z, angle), coordinates()));
    };
    middle_.resize(size(), row.count);
    per_length_.resize(size(), row.count);
    in_contact_ = Eigen::MatrixXd::Zero(size(), size());
    double squares = 0;
    for (const double along : along_) squares += along * along;
    for (int roller = 0; roller < row.count; ++roller) {
      middle_.col(roller) = measure(roller, 0);
      per_length_.col(roller) = (measure(roller, row.length / 2) - middle_.col(roller)) / (row.length / 2);
      in_contact_ += slices * middle_.col(roller) * middle_.col(roller).transpose() +
                     squares * per_length_.col(roller) * per_length_.col(roller).transpose();
    }
    in_contact_ *= exponent * stiffness_ * std::pow(usual_approach, exponent - 1) / 2;  // when half of them carry
  }
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return in_contact_; }

  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override {
    State state = in_play(deflection, coordinates(), in_contact_(0, 0));
    for (Eigen::Index roller = 0; roller < middle_.cols(); ++roller) {
      const auto [energy, force, moment, tangent, between, tilting] = of_roller(roller, deflection);
      if (force == 0) continue;
      const auto a = middle_.col(roller), b = per_length_.col(roller);
      state.energy += energy;
      state.force += force * a + moment * b;
      state.tangent +=
          tangent * a * a.transpose() + tilting * b * b.transpose() + between * (a * b.transpose() + b * a.transpose());
    }
    return state;
  }

  [[nodiscard]] double largest_element_load(const Eigen::VectorXd& deflection) const override {
    double largest = 0;
    for (Eigen::Index roller = 0; roller < middle_.cols(); ++roller)
      largest = std::max(largest, of_roller(roller, deflection).force);
    return largest;
  }

 private:
  static constexpr std::size_t slices = 31;
  static constexpr double exponent = 10.0 / 9;

  /// Sums over the slices of a roller; `moment` and what follows weigh them with their places along it.
  struct OfRoller {
    double energy = 0, force = 0, moment = 0, tangent = 0, between = 0, tilting = 0;
  };
  [[nodiscard]] OfRoller of_roller(Eigen::Index roller, const Eigen::VectorXd& deflection) const {
    OfRoller sum;
    const double middle = middle_.col(roller).dot(deflection), slope = per_length_.col(roller).dot(deflection);
    if (middle + std::abs(slope * along_.front()) <= least_gap_) return sum;
    for (std::size_t i = 0; i < slices; ++i) {
      const double along = along_[i], delta = middle + along * slope - gaps_[i];
      if (delta <= 0) continue;
      const double secant = stiffness_ * std::cbrt(std::cbrt(delta)), force = secant * delta;
      sum.energy += force * delta / (exponent + 1);
      sum.force += force;
      sum.moment += along * force;
      sum.tangent += exponent * secant;
      sum.between += along * exponent * secant;
      sum.tilting += along * along * exponent * secant;
    }
    return sum;
  }

  double stiffness_ = 0;                     ///< c_s, N/m^(10/9)
  std::array<double, slices> along_, gaps_;  ///< m, per slice: place along the roller, gap of the raceways
  double least_gap_ = 0;
  /// Coordinates x rollers: approach of the raceways in the middle of a roller, and its change along it, 1/m.
  Eigen::MatrixXd middle_, per_length_;
  Eigen::MatrixXd in_contact_;
};

/// E / (1 - nu^2) of steel in [ISO16281], Pa.
constexpr double steel_modulus = 207e9 / (1 - 0.3 * 0.3);

/// c, N/m^(3/2), of a ball between its two grooves.
double ball_stiffness(const RollingRow& row) {
  const double d = row.diameter, ratio = d * std::cos(row.contact_angle) / row.pitch_diameter;
  double compliance = 0;  // m/N^(2/3)
  for (const auto& [path, groove] :
       {std::pair{ratio / (1 - ratio), row.inner_groove}, {-ratio / (1 + ratio), row.outer_groove}}) {
    const double sum = 2 + path - 1 / (2 * groove), difference = path + 1 / (2 * groove);
    // Where the difference is negative the ellipse lies across the path.
    compliance += point_contact(1, 2 / d * sum, std::abs(difference) / sum, steel_modulus).approach;
  }
  return std::pow(compliance, -1.5);
}

class BallRowLaw final : public RollingRowLaw {
 public:
  BallRowLaw(const RollingRow& row, Motions motions)
      : RollingRowLaw(coordinates_of(row, motions)),
        stiffness_(ball_stiffness(row)),
        distance_((row.inner_groove + row.outer_groove - 1) * row.diameter) {
    const double angle = inner_angle(row);
    const double from_ball = (row.inner_groove - 0.5) * row.diameter;
    const double radius = row.pitch_diameter / 2 + from_ball * std::cos(angle), place = from_ball * std::sin(angle);
    apart_ = {distance_ * std::cos(angle) - row.clearance / 2, distance_ * std::sin(angle)};
    in_contact_ = Eigen::MatrixXd::Zero(size(), size());
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    const double slope = stiffness_ * std::sqrt(usual_approach);
    for (int ball = 0; ball < row.count; ++ball) {
      // The centre of the inner groove moves in the plane of the ball and the axis.
      auto& measure = measures_.emplace_back(2, size());
      const double around = place_of(row, ball);
      measure.row(0) = sign_of(row) * taken(displacement(around, radius, place, 0), coordinates());
      measure.row(1) = sign_of(row) * taken(displacement(around, radius, place, std::numbers::pi / 2), coordinates());
      // When half of the balls carry.
      in_contact_ += slope / 2 * measure.transpose() *
                     (exponent * along * along.transpose() + usual_approach / distance_ * across * across.transpose()) *
                     measure;
    }
  }
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return in_contact_; }

  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override {
    State state = in_play(deflection, coordinates(), in_contact_(0, 0));
    for (const auto& measure : measures_) {
      const Eigen::Vector2d apart = apart_ + measure * deflection;
      const double length = apart.norm(), delta = length - distance_;
      if (delta <= 0) continue;
      const Eigen::Vector2d along = apart / length, across(-along.y(), along.x());
      const double slope = stiffness_ * std::sqrt(delta), force = slope * delta;
      state.energy += force * delta / (exponent + 1);
      state.force += force * measure.transpose() * along;
      state.tangent += measure.transpose() *
                       (exponent * slope * along * along.transpose() + force / length * across * across.transpose()) *
                       measure;
    }
    return state;
  }

  [[nodiscard]] double largest_element_load(const Eigen::VectorXd& deflection) const override {
    double most = 0;
    for (const auto& measure : measures_) most = std::max(most, (apart_ + measure * deflection).norm() - distance_);
    return stiffness_ * std::pow(most, exponent);
  }

 private:
  static constexpr double exponent = 1.5;
  double stiffness_;       ///< c, N/m^(3/2)
  double distance_;        ///< m, of the centres of the grooves in touch
  Eigen::Vector2d apart_;  ///< m, the centre of the inner groove from that of the outer one: outwards, along z
  /// Displacement of the centre of the inner groove, of every ball: 2 x coordinates.
  std::vector<Eigen::Matrix<double, 2, Eigen::Dynamic>> measures_;
  Eigen::MatrixXd in_contact_;
};

}  // namespace

std::shared_ptr<const RollingRowLaw> law_of(const RollingRow& row, Motions motions) {
  check(row);
  if (row.element == RollingRow::Element::ball) return std::make_shared<BallRowLaw>(row, motions);
  return std::make_shared<RollerRowLaw>(row, motions);
}

PointContact point_contact(double load, double curvature_sum, double curvature_difference, double modulus) {
  if (!(load >= 0) || !(curvature_sum > 0) || !(curvature_difference >= 0 && curvature_difference < 1) ||
      !(modulus > 0))
    throw InputError(
        fmt::format("a contact in a point under {:g} N needs a sum of curvatures ({:g} 1/m) and a modulus "
                    "({:g} Pa) that are positive, and their difference ({:g}) from 0 to 1",
                    load, curvature_sum, modulus, curvature_difference));
  using boost::math::ellint_1;
  using boost::math::ellint_2;
  // The ratio of the axes, major over minor, at which both planes have the curvature of the gap.
  const auto modulus_of = [](double ratio) { return std::sqrt(1 - 1 / (ratio * ratio)); };
  const auto excess = [&](double log_ratio) {
    const double ratio = std::exp(log_ratio), k = modulus_of(ratio);
    return 1 - 2 / (ratio * ratio - 1) * (ellint_1(k) / ellint_2(k) - 1) - curvature_difference;
  };
  double ratio = 1;
  constexpr double almost_round = 1e-6, longest = 10;  // ln(axes); the difference is then below 1e-6 and above 1 - 1e-7
  if (excess(almost_round) < 0) {
    if (excess(longest) <= 0)
      throw InputError(
          fmt::format("a contact in a point has curvatures whose difference is {:g} of their sum: it is a "
                      "line",
                      curvature_difference));
    std::uintmax_t iterations = 200;
    const auto [low, high] = boost::math::tools::toms748_solve(
        excess, almost_round, longest, boost::math::tools::eps_tolerance<double>(50), iterations);
    ratio = std::exp((low + high) / 2);
  }
  const double k = modulus_of(ratio), first = ellint_1(k), second = ellint_2(k);
  PointContact contact;
  contact.major = std::cbrt(6 * ratio * ratio * second * load / (std::numbers::pi * curvature_sum * modulus));
  contact.minor = contact.major / ratio;
  contact.approach =
      first * std::cbrt(9 * curvature_sum / (2 * second) * std::pow(load / (std::numbers::pi * ratio * modulus), 2));
  return contact;
}

}  // namespace annulus::dynamics
