#include "dynamics/steady_state/newton_krylov.h"

#include <fmt/format.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_spgmr.h>

#include <exception>
#include <sundials/sundials_context.hpp>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Data of the callbacks of KINSOL.
struct Iteration {
  const Equations& equations;
  Eigen::VectorXd at, result, direction;  ///< `at`: where the residual was evaluated last
  std::exception_ptr failure{};           ///< of a callback: it must not pass through KINSOL
};

template <class Call>
int guarded(Iteration& p, Call call) {
  constexpr int unrecoverable = -1;
  try {
    return call();
  } catch (...) {
    p.failure = std::current_exception();
    return unrecoverable;
  }
}

Eigen::Map<Eigen::VectorXd> values(N_Vector v) { return {N_VGetArrayPointer(v), NV_LENGTH_S(v)}; }

extern "C" {

static int annulus_equations(N_Vector u, N_Vector result, void* data) {
  auto& p = *static_cast<Iteration*>(data);
  return guarded(p, [&] {
    p.at = values(u);
    p.equations.residual(p.at, p.result);
    values(result) = p.result;
    return p.result.allFinite() ? 0 : 1;
  });
}

static int annulus_equations_derivative(N_Vector v, N_Vector result, N_Vector u, booleantype* new_u, void* data) {
  auto& p = *static_cast<Iteration*>(data);
  // The line search may have evaluated another point last.
  if (*new_u && p.at != values(u)) annulus_equations(u, result, data);
  *new_u = SUNFALSE;
  return guarded(p, [&] {
    p.direction = values(v);
    p.equations.derivative(p.direction, p.result);
    values(result) = p.result;
    return 0;
  });
}

/// Most of the time of GMRES at this size; the loop of SUNDIALS does one product at a time.
static realtype annulus_equations_product(N_Vector a, N_Vector b) { return values(a).dot(values(b)); }

/// KINSOL prints its messages; here they go to `trouble`.
static void annulus_equations_complaint(int, const char*, const char*, char* message, void* data) {
  *static_cast<std::string*>(data) = message;
}

}  // extern "C"

/// Owns what KINSOL allocates.
class Solver {
 public:
  Solver(Iteration& iteration, const Eigen::VectorXd& start, const NewtonKrylovOptions& options) {
    u_ = N_VNew_Serial(start.size(), context_);
    u_->ops->nvdotprod = annulus_equations_product;  // clones inherit it
    weights_ = N_VClone(u_);
    N_VConst(options.weight, weights_);
    values(u_) = start;
    constexpr int directions = 50;
    solver_ = SUNLinSol_SPGMR(u_, SUN_PREC_NONE, directions, context_);
    memory_ = KINCreate(context_);
    if (!memory_) throw SolverError(fmt::format("KINSOL could not be set up for {} unknowns", start.size()));
    KINSetErrHandlerFn(memory_, annulus_equations_complaint, &complaint_);
    KINInit(memory_, annulus_equations, u_);
    KINSetUserData(memory_, &iteration);
    KINSetFuncNormTol(memory_, options.tolerance);
    KINSetScaledStepTol(memory_, 1e-3 * options.tolerance);
    KINSetNumMaxIters(memory_, options.max_iterations);
    // A linear problem (no contact lost) then takes two or three Newton iterations, of few directions each.
    KINSetEtaForm(memory_, KIN_ETACONSTANT);
    KINSetEtaConstValue(memory_, 1e-2);
    KINSetLinearSolver(memory_, solver_, nullptr);
    KINSetJacTimesVecFn(memory_, annulus_equations_derivative);
  }
  ~Solver() {
    KINFree(&memory_);
    SUNLinSolFree(solver_);
    N_VDestroy(weights_);
    N_VDestroy(u_);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  void solve(NewtonKrylovResult& result) {
    const int flag = KINSol(memory_, u_, KIN_LINESEARCH, weights_, weights_);
    long newton = 0, linear = 0;
    KINGetNumNonlinSolvIters(memory_, &newton);
    KINGetNumLinIters(memory_, &linear);
    result.newton_iterations = static_cast<int>(newton);
    result.linear_iterations = static_cast<int>(linear);
    result.trouble = flag < 0 ? complaint_ : "the steps became too small";
    result.u = values(u_);
  }

 private:
  sundials::Context context_;
  std::string complaint_;
  N_Vector u_ = nullptr, weights_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace

NewtonKrylovResult solve_newton_krylov(const Equations& equations, const Eigen::VectorXd& start,
                                       const NewtonKrylovOptions& options) {
  NewtonKrylovResult result;
  result.u = start;
  Iteration iteration{equations, start, start, start};
  if (options.max_iterations > 0) Solver(iteration, start, options).solve(result);
  if (iteration.failure) std::rethrow_exception(iteration.failure);
  // KINSOL may have evaluated another point last.
  equations.residual(result.u, iteration.result);
  result.residual = iteration.result.cwiseAbs().maxCoeff() * options.weight;
  result.converged = options.max_iterations > 0 && result.residual <= options.tolerance;
  if (result.converged) result.trouble.clear();
  return result;
}

}  // namespace annulus::dynamics
