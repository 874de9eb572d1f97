#include "app/systems/planetary/stage_motion.h"

#include "dynamics/systems/planetary/bearing_forces.h"
#include "dynamics/systems/planetary/orbit.h"
#include "dynamics/systems/planetary/poincare.h"

namespace annulus::app {

namespace {

/// Columns of one quantity, reduced to each mesh cycle.
enum class Reduction { mean, smallest, largest };

void add_column(Csv& csv, const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
                Reduction reduction) {
  csv.columns.push_back(name);
  const auto samples = values.size() / static_cast<Eigen::Index>(csv.rows.size());
  for (std::size_t c = 0; c < csv.rows.size(); ++c) {
    const auto cycle = values.segment(static_cast<Eigen::Index>(c) * samples, samples);
    csv.rows[c].push_back(reduction == Reduction::mean       ? cycle.mean()
                          : reduction == Reduction::smallest ? cycle.minCoeff()
                                                             : cycle.maxCoeff());
  }
}

void add_bearings(StageMotion& motion, const dynamics::PlanetaryStage& stage,
                  const dynamics::DynamicResponse& response) {
  auto& csv = motion.bearing_forces;
  csv.columns = {"mesh_cycle"};
  for (int c = 0; c < response.window_cycles; ++c) csv.rows.emplace_back(1, c);
  const auto pins = dynamics::bearing_forces(stage, response.series);
  const Eigen::MatrixXd resultant = pins.resultant();
  for (int n = 0; n < stage.planets(); ++n) {
    const auto name = "planet" + std::to_string(n + 1);
    add_column(csv, name + "_radial_mean_N", pins.radial.row(n).transpose(), Reduction::mean);
    add_column(csv, name + "_tangential_mean_N", pins.tangential.row(n).transpose(), Reduction::mean);
    add_column(csv, name + "_resultant_min_N", resultant.row(n).transpose(), Reduction::smallest);
    add_column(csv, name + "_resultant_max_N", resultant.row(n).transpose(), Reduction::largest);
    motion.pin_force_max.push_back(resultant.row(n).maxCoeff());
    motion.pin_force_mean_tangential.push_back(pins.tangential.row(n).mean());
  }
  const auto support = [&](const char* name, dynamics::CentralMember member) {
    const auto reaction = dynamics::support_reaction(stage, response.series, member);
    const Eigen::VectorXd magnitude = reaction.magnitude();
    add_column(csv, std::string(name) + "_support_max_N", magnitude, Reduction::largest);
    if (member == dynamics::CentralMember::ring) {
      add_column(csv, "ring_torque_mean_N_m", reaction.torque, Reduction::mean);
      motion.ring_torque_mean = reaction.torque.mean();
    }
    return magnitude.maxCoeff();
  };
  motion.sun_support_max = support("sun", dynamics::CentralMember::sun);
  motion.ring_support_max = support("ring", dynamics::CentralMember::ring);
  motion.carrier_support_max = support("carrier", dynamics::CentralMember::carrier);
}

void add_orbit(StageMotion& motion, const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response,
               Eigen::Index samples_per_cycle) {
  const auto path = dynamics::orbit(stage, response.series);
  motion.sun_orbit_extent = path.extent;
  motion.sun_orbit_largest = path.largest;
  motion.sun_orbit.columns = {"mesh_cycle", "x_m", "y_m", "housing_x_m", "housing_y_m"};
  const int stride = written_stride(response.window_cycles);
  for (Eigen::Index i = 0; i < path.x.size(); i += stride) {
    motion.sun_orbit.rows.push_back({static_cast<double>(i) / static_cast<double>(samples_per_cycle), path.x[i],
                                     path.y[i], path.housing_x[i], path.housing_y[i]});
  }
}

void add_section(StageMotion& motion, const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response,
                 Eigen::Index samples_per_cycle) {
  const auto section = dynamics::poincare_section(stage, response.series, static_cast<int>(samples_per_cycle));
  auto pattern = dynamics::section_pattern(section, stage.error_period());
  // One error period alone does not show whether it repeats; the comparison with the window before does.
  if (pattern.kind == dynamics::SectionKind::undecided && response.steady && response.whole_period) {
    pattern.kind = dynamics::SectionKind::period_1;
    pattern.period = response.window_cycles;
  }
  motion.section = dynamics::to_string(pattern.kind);
  motion.section_period = pattern.period;
  motion.section_clusters = pattern.clusters;
  motion.poincare.columns = {"mesh_cycle"};
  motion.poincare.columns.insert(motion.poincare.columns.end(), section.quantities.begin(), section.quantities.end());
  for (Eigen::Index c = 0; c < section.points.cols(); ++c) {
    auto& row = motion.poincare.rows.emplace_back(1, static_cast<double>(c));
    row.insert(row.end(), section.points.col(c).begin(), section.points.col(c).end());
  }
}

}  // namespace

int written_stride(int window_cycles) { return window_cycles > dynamics::long_window ? 3 : 1; }

StageMotion stage_motion(const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response) {
  StageMotion motion;
  const Eigen::Index samples_per_cycle = response.series.time.size() / response.window_cycles;
  add_bearings(motion, stage, response);
  add_orbit(motion, stage, response, samples_per_cycle);
  add_section(motion, stage, response, samples_per_cycle);
  return motion;
}

}  // namespace annulus::app
