#include "dynamics/systems/planetary/body_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/not_known.h"
#include "core/radial_bearing.h"
#include "dynamics/figures/motion.h"
#include "dynamics/figures/window_evidence.h"
#include "dynamics/systems/planetary/bearing_forces.h"

namespace annulus::dynamics {

namespace {

Peak same(double value) { return {value, value}; }
WindowValue average(double value, double per_force) { return {same(value), per_force, ValueOf::all_times}; }

/// How much a difference of 1 N of mesh forces may change forces and deflections.
struct PerForce {
  double of_planet = 2;  ///< its two meshes
  double of_planets = 0, deflection = 0;
  explicit PerForce(const PlanetaryStage& stage)
      : of_planets(2.0 * stage.planets()), deflection(1 / mean_stiffness(stage.sun_mesh)) {}
};

/// The smallest load zone of the planets with play.
Peak load_zone(const PlanetaryStage& stage, const Eigen::MatrixXd& resultant) {
  double smallest = not_known;
  for (Eigen::Index n = 0; n < resultant.rows(); ++n) {
    const auto bearing = stage.planet_bearing(static_cast<int>(n));
    if (!(bearing.play > 0)) continue;
    const RadialBearing law(bearing.radial, bearing.play, bearing.pin);
    smallest = std::fmin(smallest, law.load_zone(resultant.row(n).minCoeff()));  // a NaN does not count
  }
  return same(smallest);
}

/// A load zone over the force, rad/N, at the smallest force.
double zone_per_force(const PlanetaryStage& stage, const Eigen::MatrixXd& resultant) {
  const double force = resultant.minCoeff();
  const auto bearing = stage.planet_bearing(0);
  if (!(bearing.play > 0) || !(force > 0)) return 0;
  constexpr double small = 1e-3;
  const RadialBearing law(bearing.radial, bearing.play, bearing.pin);
  return std::abs(law.load_zone(force * (1 + small)) - law.load_zone(force)) / (small * force);
}

Peak largest_swing(const Eigen::MatrixXd& rows) {
  Peak largest = swing_of(rows.row(0));
  for (Eigen::Index i = 1; i < rows.rows(); ++i) largest = higher(largest, swing_of(rows.row(i)));
  return largest;
}

class BodyMotion {
 public:
  BodyMotion(const PlanetaryStage& stage, const LumpedSystem& system, const ResponseWindow& window)
      : stage_(stage),
        system_(system),
        series_(series_of(system, samples_of(window))),
        forces_(stage_forces(stage, system, series_)),
        per_(stage) {}

  [[nodiscard]] WindowValues values() {
    add_pins();
    add_supports();
    add_sun();
    const auto n = stage_.planets();
    const Eigen::MatrixXd approach = deflections(system_, series_.time, series_.displacement);
    add_motion("sun_planet_deflection", approach.topRows(n));
    add_motion("ring_planet_deflection", approach.middleRows(n, n));
    return std::move(values_);
  }

 private:
  void add(const std::string& key, const WindowValue& value) { values_.emplace_back(key, value); }

  void add_pins() {
    const Eigen::MatrixXd resultant = forces_.pins.resultant();
    for (Eigen::Index n = 0; n < resultant.rows(); ++n) {
      const auto key = [n](const char* quantity) { return pin_key(static_cast<std::size_t>(n), quantity); };
      add(key(force_of_pin), {peak_of(resultant.row(n)), per_.of_planet});
      add(key(tangential_force_of_pin), average(forces_.pins.tangential.row(n).mean(), per_.of_planet));
    }
    add("planet_bearing_force_N", {peak_of_rows(resultant), per_.of_planet});
    if (const auto zone = load_zone(stage_, resultant); !std::isnan(zone.refined))
      add("planet_bearing_load_zone_rad", {zone, per_.of_planet * zone_per_force(stage_, resultant)});
  }

  void add_supports() {
    const auto largest = [&](const SupportReaction& reaction) -> WindowValue {
      return {peak_of(reaction.magnitude().transpose()), per_.of_planets};
    };
    add("sun_support_force_N", largest(forces_.sun));
    add("ring_support_force_N", largest(forces_.ring));
    add("carrier_support_force_N", largest(forces_.carrier));
    using geometry::StageMember;
    if (!stage_.held) return;
    const auto& held = *stage_.held == StageMember::sun    ? forces_.sun
                       : *stage_.held == StageMember::ring ? forces_.ring
                                                           : forces_.carrier;
    add("held_torque_Nm", average(held.torque.mean(), per_.of_planets * stage_.body(*stage_.held).radius));
  }

  void add_sun() {
    const int x = system_.find("sun_x"), y = system_.find("sun_y");
    const double per = stage_.planets() * per_.deflection;
    if (x < 0 || y < 0) return;
    Eigen::MatrixXd place(2, series_.time.size());
    place << series_.displacement.row(x), series_.displacement.row(y);
    add("sun_distance_m", {peak_of(place.colwise().norm()), per});
    place.colwise() -= place.rowwise().mean().eval();
    add("sun_orbit_m", {peak_of(place.colwise().norm()), per});
    add("sun_rms_m", average(std::sqrt(place.colwise().squaredNorm().mean()), per));
    add("sun_peak_to_peak_m", {largest_swing(place), 2 * per});
  }

  /// The largest ones of the rows.
  void add_motion(const std::string& what, const Eigen::MatrixXd& rows) {
    add(what + "_rms_m", average(largest_range(rows).rms, per_.deflection));
    add(what + "_peak_to_peak_m", {largest_swing(rows), 2 * per_.deflection});
  }

  const PlanetaryStage& stage_;
  const LumpedSystem& system_;
  TimeSeries series_;
  StageForces forces_;
  PerForce per_;
  WindowValues values_{};
};

}  // namespace

FigureSet body_results(const PlanetaryStage& stage, const LumpedSystem& system, const SteadyResponse& found) {
  return window_figures(system, found,
                        [&](const ResponseWindow& window) { return BodyMotion(stage, system, window).values(); });
}

std::string pin_key(std::size_t planet, const std::string& quantity) {
  return fmt::format("planet{}_{}", planet + 1, quantity);
}

std::vector<FigureSpec> body_figures() {
  std::vector<FigureSpec> list;
  const auto add = [&](const std::string& key, const std::string& title, const char* unit, double scale,
                       const std::string& definition) -> FigureSpec& {
    list.push_back({.key = key, .title = title, .unit = unit, .scale = scale, .definition = definition});
    return list.back();
  };
  auto& pin =
      add("planet_bearing_force_N", "Largest force of a planet bearing", "N", 1,
          "largest over the planets and instants of the resultant force on the pin, with the centrifugal force");
  pin.better = Better::smaller;
  pin.compared = pin.plotted = pin.spread = true;
  add("planet_bearing_load_zone_rad", "Smallest load zone of a planet bearing", "°", 180 / std::numbers::pi,
      "smallest over the planets and instants of the angle over which the rollers of a bearing with play carry")
      .better = Better::larger;
  for (const std::string body : {"sun", "ring", "carrier"})
    add(body + "_support_force_N", fmt::format("Largest force on the {}'s support", body), "N", 1,
        "largest over the instants of the resultant force on the housing")
        .better = Better::smaller;
  add("held_torque_Nm", "Torque of the held member on the housing", "N m", 1, "mean over the evaluated window");
  add("sun_orbit_m", "Orbit of the sun", "µm", 1e6,
      "largest distance of the sun's centre from its mean position, in the frame of the carrier")
      .compared = true;
  add("sun_distance_m", "Distance of the sun from the axis", "µm", 1e6,
      "largest distance of the sun's centre from the axis of the housing");
  const auto motion = [&](const std::string& prefix, const char* title, const std::string& of, bool rms, bool swing) {
    auto& root = add(prefix + "_rms_m", title, "µm", 1e6, "root mean square of " + of);
    root.axis = "rms, µm";
    root.plotted = rms;
    auto& range = add(prefix + "_peak_to_peak_m", title, "µm", 1e6, "peak-to-peak value of " + of);
    range.axis = "peak to peak, µm";
    range.plotted = swing;
  };
  motion("sun", "Motion of the sun", "the distance of the sun's centre from its mean position", true, false);
  motion("sun_planet_deflection", "Deflection of the sun mesh",
         "the deflection of the sun mesh with the largest motion", false, false);
  motion("ring_planet_deflection", "Deflection of the ring mesh",
         "the deflection of the ring mesh with the largest motion", false, true);
  return list;
}

}  // namespace annulus::dynamics
