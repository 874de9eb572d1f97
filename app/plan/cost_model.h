#pragma once

#include <vector>

namespace annulus::app {

/// What a step of a run computes; each has laws of its own.
enum class Work {
  closed_form,
  plane,
  solid,
  solid_half,     ///< on half of a symmetric face
  solid_helical,  ///< whose contact moves along the face width
  resolved_plane,
  resolved_solid,
  coupling_plane,
  coupling_pins,  ///< through a ring on pins or splines
  coupling_solid,
  response,             ///< on solved tables, confirmed by time integration
  response_elastic,     ///< in which elastic modes of a ring may take part
  response_pins,        ///< the same with a ring on pins or splines
  response_prescribed,  ///< without tables whose errors would be propagated
  response_balanced,    ///< by harmonic balance alone
};

/// The size of one step of a run and, after it, what it took.
struct CostRun {
  Work work = Work::plane;
  int degree = 2;       ///< of the elements
  int level = 0;        ///< of resolution reached
  int levels = 1;       ///< solved on the way, the reached one included
  double unknowns = 0;  ///< of the reached level; of a coupling on pins times the ring positions; of a response mesh
                        ///< cycles of the period x planets, of a pair x responses
  /// Contact problems of a level; those of the first mesh cycle twice, because they compute compliances between tooth
  /// pairs that later cycles read.
  double contacts = 0;
  double supports = 0;  ///< in every contact problem (fem::support_forces)
  double before_s = 0;  ///< processor time of linear elements that are solved first and not accurate enough
  double motion_s = 0;  ///< processor time of a response, predicted from its steps and samples and not by a law
  double held_MB = 0;   ///< memory of a response beside its law
  int tasks = 1;        ///< that threads can share
  double wall_s = 0;
  double processor_s = 0;  ///< of all threads; 0: not measured

  [[nodiscard]] double seconds() const { return wall_s; }
};

/// Laws of one kind of work. With N the unknowns in ten thousands:
///
///     processor time   sum_levels (body N^body_exponent + contact N^contact_exponent contacts)      s
///     peak memory      base_MB + per_unknown_MB N, of the last level                                MB
///
/// Supports of solid rings add to every contact problem, and a second thread to the memory. The coefficients are fitted
/// to data/cost_runs.csv, which a test repeats (tests/app/cost_laws_test.cc).
struct CostLaw {
  const char* name;
  double body, body_exponent, contact, contact_exponent;
  double base_MB, per_unknown_MB;  ///< NaN: not measured
};
[[nodiscard]] const CostLaw& cost_law(Work work);

/// What finite elements and gmsh add to a response that follows them in the same run: 142 MB when their libraries are
/// loaded, and what their solves leave behind (136 to 209 MB more than responses on cached meshes). The laws of works
/// that need them contain it.
inline constexpr double loaded_elements_MB = 165;

/// What a step is predicted to cost.
struct PredictedCost {
  double seconds = 0;  ///< wall
  double peak_MB = 0;  ///< of the whole process; NaN: not known
};

/// Processor time of a step, s.
[[nodiscard]] double processor_seconds(const CostRun& size);
[[nodiscard]] double peak_memory(const CostRun& size, int threads);
/// On as many threads as can share its tasks.
[[nodiscard]] PredictedCost predicted_cost(const CostRun& size, int threads);

/// Estimated relative error of a model's table at a level with elements of a degree (that of quadratic ones where
/// nothing is known of the degree); NaN where nothing is known.
[[nodiscard]] double expected_error(Work work, int degree, int level);
/// Level at which refining until `accuracy` is met will end.
[[nodiscard]] int expected_level(Work work, int degree, double accuracy, int last_level);

/// How many times as long as by the laws this machine takes: the median of processor time to law of its last meshes, 1
/// before the third. Only predictions for people are scaled by it; what is chosen or refused never depends on it.
[[nodiscard]] double machine_pace();
/// Adds measured steps to pace.json in the user cache, which has the last 50. Steps without processor time, and those
/// too short to say anything, are left out; what cannot be written is lost.
void learn_pace(const std::vector<CostRun>& done);

}  // namespace annulus::app
