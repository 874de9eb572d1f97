#pragma once

namespace annulus::app {

/// MB that a limit of the address space (ulimit -v) leaves to this process; infinite without a limit.
[[nodiscard]] double free_address_space_MB();

/// Gives this thread and those that it starts the stack that computing needs. Throws SolverError when the system's
/// limit (ulimit -s) does not permit it. Before threads are started.
void ensure_stack();

/// Has OpenBLAS map the buffers of so many threads now, where the address space is limited: when it is refused one
/// later on, it tries again for ever. Throws SolverError when the limit is too small. Before threads are started.
void reserve_blas_memory(int threads);

}  // namespace annulus::app
