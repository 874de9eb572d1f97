#!/usr/bin/env bash
# Installs the packages, builds everything and runs all tests; ends with CTest's summary.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh --tests
cmake --preset release -DANNULUS_BUILD_TESTS=ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
