#include "dynamics/time_integration/stepper.h"

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <sundials/sundials_context.hpp>

#include "core/errors.h"
#include "dynamics/time_integration/vector_kernels.h"

namespace annulus::dynamics {

namespace {

extern "C" {

static int annulus_rhs(realtype t, N_Vector y, N_Vector dy, void* data) {
  auto& p = *static_cast<StepperProblem*>(data);
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(dy);
  ++p.statistics.rhs_evaluations;
  p.system.rhs(p.system_time(t), state, rate, p.workspace);
  if (p.pacing) p.pacing->correct(p.place, state, rate);
  const int n = 2 * p.system.dofs();
  if (p.track_energy) {
    const auto power = p.system.power(t, state, p.workspace);
    rate[n] = power.supplied;
    rate[n + 1] = power.dissipated;
  }
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += rate[i];
  return std::isfinite(sum) ? 0 : 1;  // 1: recoverable, a smaller step may avoid the overflow
}

static int annulus_jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix matrix, void* data, N_Vector, N_Vector,
                            N_Vector) {
  auto& p = *static_cast<StepperProblem*>(data);
  ++p.statistics.jacobian_evaluations;
  const int n = 2 * p.system.dofs(), size = p.size();
  Eigen::Map<Eigen::MatrixXd> jacobian(SUNDenseMatrix_Data(matrix), size, size);
  // The energies are integrals beside the system: nothing depends on them. Their own dependence on the state is omitted
  // from the Newton matrix; they are then corrected, not predicted.
  jacobian.setZero();
  p.system.jacobian(p.system_time(t), N_VGetArrayPointer(y), jacobian.topLeftCorner(n, n), p.workspace);
  if (p.pacing) p.pacing->correct(p.place, jacobian.topLeftCorner(n, n));
  return 0;
}

static int annulus_roots(realtype t, N_Vector y, realtype* values, void* data) {
  auto& p = *static_cast<StepperProblem*>(data);
  const double* state = N_VGetArrayPointer(y);
  p.system.evaluate_meshes(p.system_time(t), state, state + p.system.dofs(), p.workspace);
  for (std::size_t i = 0; i < p.rooted.size(); ++i) {
    const int m = p.rooted[i];
    const double half = *p.system.meshes()[m].half_backlash;
    realtype* of_mesh = values + StepperProblem::roots_per_mesh * i;
    of_mesh[0] = p.workspace.delta[m] - half;
    of_mesh[1] = p.workspace.delta[m] + half;
    of_mesh[2] = p.workspace.contact[m] == LumpedSystem::Contact::open ? p.workspace.delta_rate[m] : 1;
  }
  return 0;
}

static int annulus_weights(N_Vector y, N_Vector weights, void* data) {
  const auto& tolerance = static_cast<StepperProblem*>(data)->tolerance;
  const Eigen::Map<const Eigen::ArrayXd> state(N_VGetArrayPointer(y), tolerance.absolute.size());
  Eigen::Map<Eigen::ArrayXd>(N_VGetArrayPointer(weights), tolerance.absolute.size()) =
      1 /
      (tolerance.relative * state.abs().min((state - tolerance.origin).abs() + tolerance.extent) + tolerance.absolute);
  return 0;
}

/// SUNDIALS prints its messages; here they go to the exception.
static void annulus_sundials_message(int, const char*, const char*, char* message, void* data) {
  *static_cast<std::string*>(data) = message;
}

}  // extern "C"

/// The calls that CVODE, ERKStep and ARKStep share but for their names.
struct Package {
  int (*set_message_handler)(void*, void (*)(int, const char*, const char*, char*, void*), void*);
  int (*set_user_data)(void*, void*);
  int (*set_weights)(void*, int (*)(N_Vector, N_Vector, void*));
  int (*set_max_steps)(void*, long);
  int (*set_roots)(void*, int, int (*)(realtype, N_Vector, realtype*, void*));
  int (*set_stop_time)(void*, realtype);
  int (*evolve)(void*, realtype, N_Vector, realtype*, int);
  int (*root_info)(void*, int*);
  int (*steps)(void*, long*);
  void (*free)(void**);
};

constexpr Package erkstep{ERKStepSetErrHandlerFn, ERKStepSetUserData, ERKStepWFtolerances, ERKStepSetMaxNumSteps,
                          ERKStepRootInit,        ERKStepSetStopTime, ERKStepEvolve,       ERKStepGetRootInfo,
                          ERKStepGetNumSteps,     ERKStepFree};
constexpr Package arkstep{ARKStepSetErrHandlerFn, ARKStepSetUserData, ARKStepWFtolerances, ARKStepSetMaxNumSteps,
                          ARKStepRootInit,        ARKStepSetStopTime, ARKStepEvolve,       ARKStepGetRootInfo,
                          ARKStepGetNumSteps,     ARKStepFree};
constexpr Package cvode{CVodeSetErrHandlerFn,
                        CVodeSetUserData,
                        CVodeWFtolerances,
                        CVodeSetMaxNumSteps,
                        CVodeRootInit,
                        CVodeSetStopTime,
                        CVode,
                        CVodeGetRootInfo,
                        CVodeGetNumSteps,
                        CVodeFree};

constexpr int root_return = 2, normal = 1;  // the same numbers in CVODE and ARKODE

class SundialsStepper : public Stepper {
 public:
  ~SundialsStepper() override {
    if (memory_) package_.free(&memory_);
    N_VDestroy(y_);
  }
  SundialsStepper(const SundialsStepper&) = delete;
  SundialsStepper& operator=(const SundialsStepper&) = delete;

  Eigen::Map<Eigen::VectorXd> state() final { return {N_VGetArrayPointer(y_), problem_.size()}; }
  const std::vector<int>& roots() final { return roots_; }

  void restart(double t, double stop) final {
    close();
    begin(t, stop);
    counting_ = true;
  }

  Reached advance(double out) override {
    double t = out;
    const int flag = package_.evolve(memory_, out, y_, &t, normal);
    check(flag, t);
    if (flag == root_return) check(package_.root_info(memory_, roots_.data()), t);
    return {t, flag == root_return};
  }

  void close() final {
    if (!counting_) return;
    long steps = 0;
    check(package_.steps(memory_, &steps), 0);
    if (steps > 0) remember();
    problem_.statistics.steps += steps;
    counting_ = false;
  }

 protected:
  SundialsStepper(StepperProblem& problem, const Package& package)
      : package_(package), problem_(problem), roots_(StepperProblem::roots_per_mesh * problem.rooted.size(), 0) {
    y_ = N_VNew_Serial(problem.size(), context_);
    // One pass per Runge-Kutta stage instead of one per term; every vector cloned from this one inherits it.
    N_VEnableFusedOps_Serial(y_, SUNTRUE);
    use_fast_kernels(y_);
  }

  /// Takes the object made by the package and sets the options common to all.
  void own(void* memory, const IntegratorOptions& options) {
    memory_ = memory;
    if (!memory_)
      throw SolverError(
          fmt::format("a time integrator of {} state variables could not be set up: out of memory", problem_.size()));
    check(package_.set_message_handler(memory_, annulus_sundials_message, &message_), 0);
    check(package_.set_user_data(memory_, &problem_), 0);
    check(package_.set_weights(memory_, annulus_weights), 0);
    check(package_.set_max_steps(memory_, options.max_steps), 0);
    if (!problem_.rooted.empty()) check(package_.set_roots(memory_, static_cast<int>(roots_.size()), annulus_roots), 0);
  }

  virtual void begin(double t, double stop) = 0;
  /// Called after the last step before a restart.
  virtual void remember() {}

  void check(int flag, double t) const {
    constexpr int too_much_accuracy = -2;  // in CVODE and ARKODE
    if (flag == too_much_accuracy)
      throw SolverError(fmt::format(
          "time integration failed at t = {:.9g} s: rounding of the state exceeds its tolerance. The motion "
          "grows without bound, or the tolerance is too tight",
          t));
    if (flag < 0)
      throw SolverError(
          fmt::format("time integration failed at t = {:.9g} s: {} (status {}); loosen or tighten the "
                      "tolerance or choose another integrator",
                      t, message_.empty() ? "no reason given" : message_, flag));
  }

  sundials::Context context_;
  const Package& package_;
  StepperProblem& problem_;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;

 private:
  std::vector<int> roots_;
  std::string message_;
  bool counting_ = false;
};

/// Newton's matrix and its factorisation.
class NewtonMatrix {
 public:
  NewtonMatrix(N_Vector y, int size, SUNContext context)
      : matrix(SUNDenseMatrix(size, size, context)), solver(SUNLinSol_Dense(y, matrix, context)) {}
  ~NewtonMatrix() {
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
  }
  NewtonMatrix(const NewtonMatrix&) = delete;
  NewtonMatrix& operator=(const NewtonMatrix&) = delete;

  SUNMatrix matrix;
  SUNLinearSolver solver;
};

class ExplicitStepper final : public SundialsStepper {
 public:
  ExplicitStepper(StepperProblem& problem, const IntegratorOptions& options)
      : SundialsStepper(problem, erkstep), fixed_step_(options.fixed_step) {
    own(ERKStepCreate(annulus_rhs, 0.0, y_, context_), options);
    if (options.method == Integrator::runge_kutta_4) {
      // Zonneveld's pair is the classical method with an embedded error estimate that a fixed step ignores. The bare
      // four-stage table would lose an order: ERKStep up to 6.6 takes any table whose last node is 1 for
      // first-same-as-last.
      check(ERKStepSetTableNum(memory_, ARKODE_ZONNEVELD_5_3_4), 0);
      check(ERKStepSetFixedStep(memory_, fixed_step_), 0);
    } else {
      check(ERKStepSetTableNum(memory_, ARKODE_CASH_KARP_6_4_5), 0);
      // Cubic: from what the steps know anyway. The higher degrees cost two evaluations per sample; samples stay within
      // the tolerance either way, but the state after a contact event is an interpolated one and goes on.
      if (problem_.rooted.empty()) check(ERKStepSetInterpolantDegree(memory_, 3), 0);
    }
  }

 private:
  void begin(double t, double stop) override {
    check(ERKStepReInit(memory_, annulus_rhs, t, y_), t);
    // After the event the integration goes on with the step size from before it.
    if (fixed_step_ == 0 && last_step_ > 0) check(ERKStepSetInitStep(memory_, std::min(last_step_, stop - t)), t);
    check(ERKStepSetStopTime(memory_, stop), t);
  }
  void remember() override { check(ERKStepGetCurrentStep(memory_, &last_step_), 0); }

  double fixed_step_ = 0, last_step_ = 0;
};

class MultistepStepper final : public SundialsStepper {
 public:
  MultistepStepper(StepperProblem& problem, const IntegratorOptions& options) : SundialsStepper(problem, cvode) {
    const bool adams = options.method == Integrator::cvode_adams;
    void* memory = CVodeCreate(adams ? CV_ADAMS : CV_BDF, context_);
    // Settings are taken after the first initialisation only.
    if (memory) check(CVodeInit(memory, annulus_rhs, 0.0, y_), 0);
    own(memory, options);
    if (adams) {
      // Where Adams methods are useful, steps are short enough for fixed-point iteration, at a third of Newton's time.
      iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      check(CVodeSetNonlinearSolver(memory_, iteration_), 0);
    } else {
      newton_.emplace(y_, problem.size(), context_);
      check(CVodeSetLinearSolver(memory_, newton_->solver, newton_->matrix), 0);
      check(CVodeSetJacFn(memory_, annulus_jacobian), 0);
    }
  }
  ~MultistepStepper() override {
    if (iteration_) SUNNonlinSolFree(iteration_);
  }
  MultistepStepper(const MultistepStepper&) = delete;
  MultistepStepper& operator=(const MultistepStepper&) = delete;

 private:
  void begin(double t, double stop) override {
    check(CVodeReInit(memory_, t, y_), t);
    check(CVodeSetStopTime(memory_, stop), t);
  }

  std::optional<NewtonMatrix> newton_;
  SUNNonlinearSolver iteration_ = nullptr;
};

/// Diagonally implicit Runge-Kutta method of order 5, L-stable. Its steps follow the actual motion and not a possible
/// fast one, even where that is lightly damped (BDF is unstable there).
class DiagonallyImplicitStepper final : public SundialsStepper {
 public:
  DiagonallyImplicitStepper(StepperProblem& problem, const IntegratorOptions& options)
      : SundialsStepper(problem, arkstep), newton_(y_, problem.size(), context_) {
    own(ARKStepCreate(nullptr, annulus_rhs, 0.0, y_, context_), options);
    check(ARKStepSetTableNum(memory_, ARKODE_ESDIRK547L2SA_7_4_5, ARKODE_ERK_NONE), 0);
    // Hermite interpolation multiplies the remains of fast motions by their rates.
    check(ARKStepSetInterpolantType(memory_, ARK_INTERP_LAGRANGE), 0);
    check(ARKStepSetLinearSolver(memory_, newton_.solver, newton_.matrix), 0);
    check(ARKStepSetJacFn(memory_, annulus_jacobian), 0);
    // Stiffness and step multiply the remaining residual of Newton's method into velocities. With the usual tenth of
    // the tolerance the step control would react to that. The problem is nearly linear: one more iteration suffices.
    check(ARKStepSetNonlinConvCoef(memory_, 1e-5), 0);
    // Steps a million times longer than the fast motion need more than the usual seven rejections to become short.
    check(ARKStepSetMaxErrTestFails(memory_, 20), 0);
  }

  /// Steps end at `out`, so that the state is one of the method and not an interpolated one.
  Reached advance(double out) override {
    check(ARKStepSetStopTime(memory_, out), out);
    return SundialsStepper::advance(out);
  }

 private:
  void begin(double t, double) override { check(ARKStepReInit(memory_, nullptr, annulus_rhs, t, y_), t); }

  NewtonMatrix newton_;
};

}  // namespace

std::unique_ptr<Stepper> make_stepper(StepperProblem& problem, const IntegratorOptions& options) {
  require(options.method != Integrator::automatic,
          fmt::format("an integrator must be chosen for {} degrees of freedom before a stepper is made",
                      problem.system.dofs()));
  if (options.method == Integrator::arkode_implicit)
    return std::make_unique<DiagonallyImplicitStepper>(problem, options);
  if (options.method == Integrator::cvode_adams || options.method == Integrator::cvode_bdf)
    return std::make_unique<MultistepStepper>(problem, options);
  return std::make_unique<ExplicitStepper>(problem, options);
}

}  // namespace annulus::dynamics
