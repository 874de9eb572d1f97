#pragma once

struct _generic_N_Vector;  // of SUNDIALS; NOLINT(bugprone-reserved-identifier)

namespace annulus::dynamics {

/// Replaces linear combination and weighted norm of a serial vector, and of all vectors cloned from it. The new ones
/// add all terms in one pass and use the vector unit of the processor. For states of some dozen entries those of
/// SUNDIALS take longer than the right-hand side.
void use_fast_kernels(_generic_N_Vector* vector);

}  // namespace annulus::dynamics
