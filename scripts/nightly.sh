#!/usr/bin/env bash
# Runs the checks that take hours: sanitizers, a second build with another compiler, clang-tidy, fuzzing, valgrind, the
# full benchmarks and random scenes; ends with CTest's summary. Options are passed to ctest: scripts/nightly.sh -R sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh --nightly
cmake --preset release -DANNULUS_BUILD_TESTS=ON
cmake --build --preset release
ctest --preset nightly "$@"
