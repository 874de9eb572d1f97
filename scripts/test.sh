#!/usr/bin/env bash
# Installs the packages, builds everything and runs tests; ends with CTest's summary.
#   scripts/test.sh          the quick tests: all suites but those above 20 s of processor time
#   scripts/test.sh --all    all suites, and the benchmarks as far as they check an accuracy
# Further options are passed to ctest: scripts/test.sh --all -L '^fem$' runs the suites of fem/.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=quick
packages=--tests
benchmarks=OFF
if [ "${1:-}" = --all ]; then
  preset=release
  packages=--all
  benchmarks=ON
  shift
fi

scripts/install_packages.sh "$packages"
cmake --preset release -DANNULUS_BUILD_TESTS=ON -DANNULUS_BUILD_BENCHMARKS=$benchmarks
cmake --build --preset release
ctest --preset "$preset" --parallel "$(nproc)" "$@"
