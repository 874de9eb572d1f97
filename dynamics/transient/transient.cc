#include "dynamics/transient/transient.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/figures/spectrum.h"
#include "dynamics/statics/static_solver.h"

namespace annulus::dynamics {

namespace {

/// Meshes at equidistant nominal times.
struct Followed {
  Eigen::MatrixXf force;       ///< N, meshes x samples: long courses have millions
  Eigen::VectorXd open;        ///< s without contact, per mesh of gears
  Eigen::VectorXd at_changes;  ///< s between samples of which one alone has contact
  double duration = 0;         ///< s
};

class CourseRun {
 public:
  CourseRun(const LumpedCase& of, const TransientOptions& options)
      : system_(of.system),
        frequency_(of.problem.mesh_frequency),
        of_period_(of.problem.period_in_cycles),
        options_(options),
        pacing_(of.system, options.course, of.turning.dof, of.turning.velocity, options.accelerated_by),
        cycles_(options.course, TransientOptions::slowest, frequency_),
        workspace_(of.system.workspace()) {
    auto& integrator = options_.integrator;
    if (!integrator.absolute_tolerance)
      integrator.absolute_tolerance =
          0.1 * integrator.relative_tolerance * of.problem.force_scale / of.problem.stiffness;
    for (int m = 0; m < static_cast<int>(system_.meshes().size()); ++m)
      if (system_.is_gear_mesh(m) && system_.meshes()[static_cast<std::size_t>(m)].frequency != 0) meshes_.push_back(m);
    gears_ = static_cast<int>(meshes_.size());
    for (int m = 0; m < static_cast<int>(system_.meshes().size()); ++m)
      if (system_.meshes()[static_cast<std::size_t>(m)].shaft) meshes_.push_back(m);
  }

  TransientResponse run(double force_scale) && {
    TransientResponse result;
    const double in_course = cycles_.last();
    if (in_course > TransientOptions::most_cycles)
      throw InputError(fmt::format("the course has {:.3g} mesh cycles; {:g} are possible", in_course,
                                   TransientOptions::most_cycles));
    for (const int m : meshes_) result.meshes.push_back(system_.meshes()[static_cast<std::size_t>(m)].name);
    result.gears = gears_;
    result.other_loads = system_.load(LoadCause::none).any() || !system_.harmonic_loads().empty();
    result.without_sticking =
        system_.has_friction() && pacing_.least_speed(0, options_.course.points.back().time) < Pacing::slipping;
    settle(result, force_scale);
    result.nominal = nominal();
    const int cycles = std::max(1, static_cast<int>(std::ceil(in_course - 1e-9)));
    const auto followed = advance(0, cycles);
    result.statistics = statistics_;
    tabulate(result, followed, cycles);
    add_spectra(result, followed.force, cycles);
    return result;
  }

 private:
  /// Windows at the first speed and torque until their forces repeat, which only whole periods can show.
  void settle(TransientResponse& result, double force_scale) {
    // Whole periods, where windows can show that the motion repeats.
    constexpr int shortest = 20, longest = 100;
    const double speed = std::abs(options_.course.points.front().speed);
    const bool rests = speed == 0, periods = speed >= TransientOptions::slowest && of_period_ <= longest;
    const int period = periods ? of_period_ : 1, window = (shortest + period - 1) / period * period;
    const int windows = std::max(2, options_.most_settling_cycles / window);
    state_.time = cycles_.time(-windows * window);
    state_.q = static_path(system_, Eigen::VectorXd::Constant(1, pacing_.at(state_.time).nominal)).displacement.col(0);
    state_.v = Eigen::VectorXd::Zero(system_.dofs());
    Eigen::VectorXd before;
    for (int i = 0; i < windows; ++i) {
      const auto followed = advance((i - windows) * window, window);
      const Eigen::VectorXd peaks = followed.force.rowwise().maxCoeff().cast<double>();
      result.settling_cycles += window;
      const double wanted = options_.steady_tolerance * force_scale;
      if (periods || rests) result.settled = before.size() > 0 && (peaks - before).cwiseAbs().maxCoeff() <= wanted;
      if (result.settled.value_or(false)) break;
      before = peaks;
    }
    state_.time = 0;  // everything repeats after whole windows
    statistics_ = {};
  }

  /// Of gears the mean of meshes with the same name but for a number at its end.
  [[nodiscard]] Eigen::VectorXd mean_of_kinds(const Eigen::VectorXd& forces) const {
    std::map<std::string, std::pair<double, int>> kinds;
    std::vector<std::string> names;
    for (int row = 0; row < gears_; ++row) {
      auto name = system_.meshes()[static_cast<std::size_t>(meshes_[static_cast<std::size_t>(row)])].name;
      while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back())) != 0) name.pop_back();
      auto& [sum, count] = kinds[name];
      sum += forces[std::ssize(names)];
      ++count;
      names.push_back(std::move(name));
    }
    Eigen::VectorXd means = forces;
    for (Eigen::Index i = 0; i < gears_; ++i) {
      const auto& [sum, count] = kinds[names[static_cast<std::size_t>(i)]];
      means[i] = sum / count;
    }
    return means;
  }

  /// N, of the meshes in equilibrium under the nominal torque: the mean over a period.
  [[nodiscard]] Eigen::VectorXd nominal() const {
    constexpr int places = 128, longest = 20000;
    const double golden = (std::sqrt(5) - 1) / 2;  // so that all phases of the mesh cycle come
    std::vector<double> cycles;
    for (int k = 0; k < places; ++k)
      cycles.push_back(std::floor(static_cast<double>(k) * std::min(of_period_, longest) / places) + k * golden -
                       std::floor(k * golden));
    std::sort(cycles.begin(), cycles.end());
    const Eigen::VectorXd times = Eigen::Map<const Eigen::VectorXd>(cycles.data(), places) / frequency_;
    return mean_of_kinds(static_path(system_, times).force(meshes_, Eigen::all).rowwise().mean());
  }

  /// From a cycle on, at which the state stands.
  Followed advance(int first, int cycles) {
    const int per_cycle = options_.samples_per_cycle, samples = cycles * per_cycle;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(gears_);
    Followed followed{Eigen::MatrixXf(std::ssize(meshes_), samples), none, none};
    IntegrationObserver observer;
    observer.samples = samples;
    observer.time_of = [&](int index) { return cycles_.time(first + static_cast<double>(index) / per_cycle); };
    std::vector<bool> was_open(workspace_.elastic.size());
    observer.sample = [&](int index, const SystemState& state) {
      const double pace = std::max(std::abs(pacing_.at(state.time).speed), TransientOptions::slowest);
      const double lasts = 1 / (pace * per_cycle * frequency_);
      followed.duration += lasts;
      for (Eigen::Index row = 0; row < std::ssize(meshes_); ++row) {
        const auto m = static_cast<std::size_t>(meshes_[static_cast<std::size_t>(row)]);
        followed.force(row, index) = static_cast<float>(workspace_.force[m]);
        if (row >= gears_) continue;
        const bool open = workspace_.elastic[m] == 0;
        if (open) followed.open[row] += lasts;
        if (index > 0 && open != was_open[m]) followed.at_changes[row] += lasts;
        was_open[m] = open;
      }
    };
    const auto statistics =
        integrate(system_, state_, cycles_.time(first + cycles), options_.integrator, workspace_, observer, &pacing_);
    statistics_.steps += statistics.steps;
    statistics_.rhs_evaluations += statistics.rhs_evaluations;
    statistics_.contact_events += statistics.contact_events;
    return followed;
  }

  void tabulate(TransientResponse& result, const Followed& followed, int cycles) const {
    const int samples = options_.samples_per_cycle;
    const Eigen::Index rows = followed.force.rows();
    result.time.resize(cycles);
    result.speed = result.torque = result.time;
    result.largest.resize(rows, cycles);
    result.smallest = result.mean = result.largest;
    result.open = followed.open / followed.duration;
    result.open_error = followed.at_changes / (2 * followed.duration);
    result.between_samples.resize(rows);
    for (Eigen::Index m = 0; m < rows; ++m) {
      const auto all = followed.force.row(m).cwiseAbs();
      std::array<float, 2> largest{};  // a largest value shows in one half alone
      for (Eigen::Index i = 0; i < all.size(); ++i) {
        auto& of_half = largest.at(static_cast<std::size_t>(i % 2));
        of_half = std::max(of_half, all[i]);
      }
      const auto [less, most] = std::minmax(largest[0], largest[1]);
      result.between_samples[m] = most > 0 ? 1 - less / most : 0;
    }
    for (int c = 0; c < cycles; ++c) {
      result.time[c] = cycles_.time(c + 0.5);
      const auto now = pacing_.at(result.time[c]);
      result.speed[c] = now.speed;
      result.torque[c] = now.torque;
      const Eigen::MatrixXd force = followed.force.middleCols(c * samples, samples).cast<double>();
      result.largest.col(c) = force.rowwise().maxCoeff();
      result.smallest.col(c) = force.rowwise().minCoeff();
      result.mean.col(c) = force.rowwise().mean();
    }
  }

  /// With a Hann window, which keeps its neighbours apart while the speed changes.
  void add_spectra(TransientResponse& result, const Eigen::MatrixXf& force, int cycles) const {
    result.spectrum_of = result.peak().mesh;
    constexpr int window = TransientResponse::window_cycles;
    const int samples = options_.samples_per_cycle, length = window * samples;
    const int windows = cycles < window ? 0 : 1 + (cycles - window) / (window / 2);
    Eigen::ArrayXd hann(length);
    for (int i = 0; i < length; ++i) hann[i] = 1 - std::cos(2 * std::numbers::pi * i / length);
    const auto orders = static_cast<Eigen::Index>(options_.highest_order * window) + 1;
    result.amplitude.resize(orders, windows);
    result.window_time.resize(windows);
    result.window_speed.resize(windows);
    for (int w = 0; w < windows; ++w) {
      const int first = w * window / 2;
      result.window_time[w] = cycles_.time(first + window / 2.0);
      result.window_speed[w] = pacing_.at(result.window_time[w]).speed;
      Eigen::VectorXd part = force.row(result.spectrum_of).segment(first * samples, length).cast<double>().transpose();
      part = (part.array() - part.mean()) * hann;
      const auto lines = spectrum(part, window);
      result.order = lines.order.head(orders);
      if (pacing_.least_speed(cycles_.time(first), cycles_.time(first + window)) >= TransientOptions::slowest)
        result.amplitude.col(w) = lines.amplitude.head(orders);
      else
        result.amplitude.col(w).setConstant(not_known);
    }
  }

  const LumpedSystem& system_;
  double frequency_;
  int of_period_;
  TransientOptions options_;
  Pacing pacing_;
  CourseCycles cycles_;
  LumpedSystem::Workspace workspace_;
  std::vector<int> meshes_;
  int gears_ = 0;
  SystemState state_;
  IntegratorStatistics statistics_;
};

}  // namespace

TransientResponse::Peak TransientResponse::peak() const {
  Peak peak;
  for (int m = 0; m < gears; ++m)
    for (Eigen::Index c = 0; c < time.size(); ++c)
      for (const double force : {largest(m, c), smallest(m, c)})
        if (std::abs(force) > std::abs(peak.force)) peak = {m, force, time[c], speed[c]};
  return peak;
}

double TransientResponse::largest_of(int mesh) const {
  return std::max(largest.row(mesh).maxCoeff(), -smallest.row(mesh).minCoeff());
}

TransientResponse follow_course(const LumpedCase& of, const TransientOptions& options) {
  require(
      options.samples_per_cycle >= 2 * options.highest_order,
      fmt::format("{} samples per mesh cycle for orders up to {}", options.samples_per_cycle, options.highest_order));
  return CourseRun(of, options).run(of.problem.force_scale);
}

}  // namespace annulus::dynamics
