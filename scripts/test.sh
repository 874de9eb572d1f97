#!/usr/bin/env bash
# Installs the packages, builds everything and runs all tests, those with sanitizers and clang-tidy (analysis.*) too, for
# which everything is compiled once more; ends with CTest's summary. Options are passed to ctest:
#   scripts/test.sh -LE analysis    a quarter of an hour less
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh --tests
cmake --preset release -DANNULUS_BUILD_TESTS=ON -DANNULUS_ANALYSIS=ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
