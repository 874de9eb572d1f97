#include "dynamics/steady_state/real_transform.h"

#include <fmt/format.h>

#include <fftw3.h>

#include <mutex>
#include <vector>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Making and destroying plans is all of FFTW that threads must not do at once.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

fftw_complex* fftw(std::complex<double>* lines) { return reinterpret_cast<fftw_complex*>(lines); }

}  // namespace

struct RealTransform::Plans {
  fftw_plan forward = nullptr, inverse = nullptr;

  explicit Plans(int samples) {
    std::vector<double> values(static_cast<std::size_t>(samples));
    std::vector<std::complex<double>> lines(static_cast<std::size_t>(samples / 2 + 1));
    // No timing and no assumption on alignment: the same plan, and the same rounding, in every run.
    constexpr unsigned flags = FFTW_ESTIMATE | FFTW_UNALIGNED;
    const std::scoped_lock lock(planner());
    forward = fftw_plan_dft_r2c_1d(samples, values.data(), fftw(lines.data()), flags);
    inverse = fftw_plan_dft_c2r_1d(samples, fftw(lines.data()), values.data(), flags | FFTW_DESTROY_INPUT);
    require(forward && inverse, fmt::format("FFTW made no plan for {} samples", samples));
  }
  ~Plans() {
    const std::scoped_lock lock(planner());
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;
};

RealTransform::RealTransform(int samples) {
  require(samples > 0, fmt::format("a transform needs samples, not {}", samples));
  plans_ = std::make_shared<const Plans>(samples);
}

void RealTransform::forward(const double* values, std::complex<double>* lines) const {
  fftw_execute_dft_r2c(plans_->forward, const_cast<double*>(values), fftw(lines));  // the input is preserved
}

void RealTransform::inverse(std::complex<double>* lines, double* values) const {
  fftw_execute_dft_c2r(plans_->inverse, fftw(lines), values);
}

}  // namespace annulus::dynamics
