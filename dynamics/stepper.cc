#include "dynamics/stepper.h"

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
#include <string>
#include <sundials/sundials_context.hpp>

#include "core/errors.h"
#include "dynamics/vector_kernels.h"

namespace annulus::dynamics {

namespace {

extern "C" {

static int annulus_rhs(realtype t, N_Vector y, N_Vector dy, void* data) {
  auto& p = *static_cast<StepperProblem*>(data);
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(dy);
  ++p.statistics.rhs_evaluations;
  p.system.rhs(t, state, rate, p.workspace);
  const int n = 2 * p.system.freedoms();
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
  const int n = 2 * p.system.freedoms(), size = p.size();
  Eigen::Map<Eigen::MatrixXd> jacobian(SUNDenseMatrix_Data(matrix), size, size);
  // The energies are integrals beside the system: nothing depends on them, and their own dependence on the state may be
  // left out of a Newton matrix (they are then corrected, not predicted).
  jacobian.setZero();
  p.system.jacobian(t, N_VGetArrayPointer(y), jacobian.topLeftCorner(n, n), p.workspace);
  return 0;
}

static int annulus_roots(realtype t, N_Vector y, realtype* values, void* data) {
  auto& p = *static_cast<StepperProblem*>(data);
  const double* state = N_VGetArrayPointer(y);
  p.system.evaluate_meshes(t, state, state + p.system.freedoms(), p.workspace);
  for (std::size_t i = 0; i < p.rooted.size(); ++i) {
    const double half = *p.system.meshes()[p.rooted[i]].half_backlash;
    values[2 * i] = p.workspace.delta[p.rooted[i]] - half;
    values[2 * i + 1] = p.workspace.delta[p.rooted[i]] + half;
  }
  return 0;
}

/// SUNDIALS prints its complaints; here they end in the exception.
static void annulus_complaint(int, const char*, const char*, char* message, void* data) {
  *static_cast<std::string*>(data) = message;
}

}  // extern "C"

constexpr int root_return = 2;  // CV_ROOT_RETURN and ARK_ROOT_RETURN

class SundialsStepper : public Stepper {
 public:
  SundialsStepper(StepperProblem& problem, const Eigen::VectorXd& tolerance)
      : problem_(problem), roots_(2 * problem.rooted.size(), 0) {
    y_ = N_VNew_Serial(problem.size(), context_);
    // One pass per Runge-Kutta stage instead of one per term; every vector cloned from this one inherits it.
    N_VEnableFusedOps_Serial(y_, SUNTRUE);
    use_fast_kernels(y_);
    tolerance_ = N_VNew_Serial(problem.size(), context_);
    for (int i = 0; i < problem.size(); ++i) NV_Ith_S(tolerance_, i) = tolerance[i];
  }
  ~SundialsStepper() override {
    N_VDestroy(y_);
    N_VDestroy(tolerance_);
  }
  SundialsStepper(const SundialsStepper&) = delete;
  SundialsStepper& operator=(const SundialsStepper&) = delete;
  Eigen::Map<Eigen::VectorXd> state() override { return {N_VGetArrayPointer(y_), problem_.size()}; }
  const std::vector<int>& roots() override { return roots_; }

 protected:
  void check(int flag, double t) const {
    if (flag < 0)
      throw SolverError(
          fmt::format("time integration failed at t = {:.9g} s: {} (status {}); loosen or tighten the "
                      "tolerance or choose another integrator",
                      t, complaint_.empty() ? "no reason given" : complaint_, flag));
  }

  sundials::Context context_;
  StepperProblem& problem_;
  N_Vector y_ = nullptr, tolerance_ = nullptr;
  std::vector<int> roots_;
  std::string complaint_;
};

class ExplicitStepper final : public SundialsStepper {
 public:
  ExplicitStepper(StepperProblem& problem, const IntegratorOptions& options, const Eigen::VectorXd& tolerance)
      : SundialsStepper(problem, tolerance), fixed_step_(options.fixed_step) {
    memory_ = ERKStepCreate(annulus_rhs, 0.0, y_, context_);
    if (!memory_) throw SolverError("ARKODE could not be set up");
    check(ERKStepSetErrHandlerFn(memory_, annulus_complaint, &complaint_), 0);
    check(ERKStepSetUserData(memory_, &problem_), 0);
    check(ERKStepSVtolerances(memory_, options.relative_tolerance, tolerance_), 0);
    check(ERKStepSetMaxNumSteps(memory_, options.max_steps), 0);
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
    if (!problem_.rooted.empty())
      check(ERKStepRootInit(memory_, static_cast<int>(2 * problem_.rooted.size()), annulus_roots), 0);
  }
  ~ExplicitStepper() override { ERKStepFree(&memory_); }
  ExplicitStepper(const ExplicitStepper&) = delete;
  ExplicitStepper& operator=(const ExplicitStepper&) = delete;

  void restart(double t, double stop) override {
    close();
    check(ERKStepReInit(memory_, annulus_rhs, t, y_), t);
    // The step that served before the event serves after it.
    if (fixed_step_ == 0 && last_step_ > 0) check(ERKStepSetInitStep(memory_, std::min(last_step_, stop - t)), t);
    check(ERKStepSetStopTime(memory_, stop), t);
    counting_ = true;
  }

  Reached advance(double out) override {
    double t = out;
    const int flag = ERKStepEvolve(memory_, out, y_, &t, ARK_NORMAL);
    check(flag, t);
    if (flag == root_return) check(ERKStepGetRootInfo(memory_, roots_.data()), t);
    return {t, flag == root_return};
  }

  void close() override {
    if (!counting_) return;
    long steps = 0;
    check(ERKStepGetNumSteps(memory_, &steps), 0);
    if (steps > 0) check(ERKStepGetCurrentStep(memory_, &last_step_), 0);
    problem_.statistics.steps += steps;
    counting_ = false;
  }

 private:
  void* memory_ = nullptr;
  double fixed_step_ = 0, last_step_ = 0;
  bool counting_ = false;
};

class ImplicitStepper final : public SundialsStepper {
 public:
  ImplicitStepper(StepperProblem& problem, const IntegratorOptions& options, const Eigen::VectorXd& tolerance)
      : SundialsStepper(problem, tolerance) {
    memory_ = CVodeCreate(options.method == Integrator::cvode_adams ? CV_ADAMS : CV_BDF, context_);
    if (!memory_) throw SolverError("CVODE could not be set up");
    check(CVodeSetErrHandlerFn(memory_, annulus_complaint, &complaint_), 0);
    check(CVodeInit(memory_, annulus_rhs, 0.0, y_), 0);
    check(CVodeSetUserData(memory_, &problem_), 0);
    check(CVodeSVtolerances(memory_, options.relative_tolerance, tolerance_), 0);
    check(CVodeSetMaxNumSteps(memory_, options.max_steps), 0);
    if (options.method == Integrator::cvode_adams) {
      // Where Adams' methods are of use, steps are short enough for the fixed point, at a third of Newton's time.
      iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      check(CVodeSetNonlinearSolver(memory_, iteration_), 0);
    } else {
      matrix_ = SUNDenseMatrix(problem.size(), problem.size(), context_);
      solver_ = SUNLinSol_Dense(y_, matrix_, context_);
      check(CVodeSetLinearSolver(memory_, solver_, matrix_), 0);
      check(CVodeSetJacFn(memory_, annulus_jacobian), 0);
    }
    if (!problem_.rooted.empty())
      check(CVodeRootInit(memory_, static_cast<int>(2 * problem_.rooted.size()), annulus_roots), 0);
  }
  ~ImplicitStepper() override {
    CVodeFree(&memory_);
    if (iteration_) SUNNonlinSolFree(iteration_);
    if (solver_) SUNLinSolFree(solver_);
    if (matrix_) SUNMatDestroy(matrix_);
  }
  ImplicitStepper(const ImplicitStepper&) = delete;
  ImplicitStepper& operator=(const ImplicitStepper&) = delete;

  void restart(double t, double stop) override {
    close();
    check(CVodeReInit(memory_, t, y_), t);
    check(CVodeSetStopTime(memory_, stop), t);
    counting_ = true;
  }

  Reached advance(double out) override {
    double t = out;
    const int flag = CVode(memory_, out, y_, &t, CV_NORMAL);
    check(flag, t);
    if (flag == root_return) check(CVodeGetRootInfo(memory_, roots_.data()), t);
    return {t, flag == root_return};
  }

  void close() override {
    if (!counting_) return;
    long steps = 0;
    check(CVodeGetNumSteps(memory_, &steps), 0);
    problem_.statistics.steps += steps;
    counting_ = false;
  }

 private:
  void* memory_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
  bool counting_ = false;
};

/// Diagonally implicit Runge-Kutta method of order 5, L-stable: steps follow the motion that is there, not the fast one
/// that might be, however lightly that is damped (BDF is unstable there).
class DiagonallyImplicitStepper final : public SundialsStepper {
 public:
  DiagonallyImplicitStepper(StepperProblem& problem, const IntegratorOptions& options, const Eigen::VectorXd& tolerance)
      : SundialsStepper(problem, tolerance) {
    memory_ = ARKStepCreate(nullptr, annulus_rhs, 0.0, y_, context_);
    if (!memory_) throw SolverError("ARKODE could not be set up");
    check(ARKStepSetErrHandlerFn(memory_, annulus_complaint, &complaint_), 0);
    check(ARKStepSetUserData(memory_, &problem_), 0);
    check(ARKStepSVtolerances(memory_, options.relative_tolerance, tolerance_), 0);
    check(ARKStepSetMaxNumSteps(memory_, options.max_steps), 0);
    check(ARKStepSetTableNum(memory_, ARKODE_ESDIRK547L2SA_7_4_5, ARKODE_ERK_NONE), 0);
    // Hermite interpolation multiplies what is left of fast motions by their rates.
    check(ARKStepSetInterpolantType(memory_, ARK_INTERP_LAGRANGE), 0);
    matrix_ = SUNDenseMatrix(problem.size(), problem.size(), context_);
    solver_ = SUNLinSol_Dense(y_, matrix_, context_);
    check(ARKStepSetLinearSolver(memory_, solver_, matrix_), 0);
    check(ARKStepSetJacFn(memory_, annulus_jacobian), 0);
    // What Newton's method leaves, stiffness and step multiply into velocities: with the usual tenth of the tolerance
    // the step control would answer to that. The problem is nearly linear: an iteration more gets there.
    check(ARKStepSetNonlinConvCoef(memory_, 1e-5), 0);
    if (!problem_.rooted.empty())
      check(ARKStepRootInit(memory_, static_cast<int>(2 * problem_.rooted.size()), annulus_roots), 0);
  }
  ~DiagonallyImplicitStepper() override {
    ARKStepFree(&memory_);
    if (solver_) SUNLinSolFree(solver_);
    if (matrix_) SUNMatDestroy(matrix_);
  }
  DiagonallyImplicitStepper(const DiagonallyImplicitStepper&) = delete;
  DiagonallyImplicitStepper& operator=(const DiagonallyImplicitStepper&) = delete;

  void restart(double t, double) override {
    close();
    check(ARKStepReInit(memory_, nullptr, annulus_rhs, t, y_), t);
    counting_ = true;
  }

  /// Steps end at `out`: what is asked for is a state of the method, not an interpolated one.
  Reached advance(double out) override {
    double t = out;
    check(ARKStepSetStopTime(memory_, out), t);
    const int flag = ARKStepEvolve(memory_, out, y_, &t, ARK_NORMAL);
    check(flag, t);
    if (flag == root_return) check(ARKStepGetRootInfo(memory_, roots_.data()), t);
    return {t, flag == root_return};
  }

  void close() override {
    if (!counting_) return;
    long steps = 0;
    check(ARKStepGetNumSteps(memory_, &steps), 0);
    problem_.statistics.steps += steps;
    counting_ = false;
  }

 private:
  void* memory_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  bool counting_ = false;
};

}  // namespace

std::unique_ptr<Stepper> make_stepper(StepperProblem& problem, const IntegratorOptions& options,
                                      const Eigen::VectorXd& tolerance) {
  require(options.method != Integrator::automatic, "the integrator is chosen before the stepper is made");
  if (options.method == Integrator::arkode_implicit)
    return std::make_unique<DiagonallyImplicitStepper>(problem, options, tolerance);
  if (options.method == Integrator::cvode_adams || options.method == Integrator::cvode_bdf)
    return std::make_unique<ImplicitStepper>(problem, options, tolerance);
  return std::make_unique<ExplicitStepper>(problem, options, tolerance);
}

}  // namespace annulus::dynamics
