#pragma once

#include <string>

namespace annulus::app {

/// Identity of the program as it was built: its version and the build identities of the program and of annulus's
/// libraries, loaded or not. Results of another build are computed again.
[[nodiscard]] const std::string& program_identity();

}  // namespace annulus::app
