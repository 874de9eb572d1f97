#!/usr/bin/env bash
# Builds the program and its tests with the address and undefined-behaviour sanitizers (clang) and runs tests.
#   scripts/sanitize.sh [options of ctest]
# Default: unit and pipeline tests, without the whole scene of three rings (half an hour), without reuse, tradeoff and
# optimisation, which repeat the runs of other tests (a quarter of an hour), without limits of memory, which the
# sanitizers exceed by themselves, and without packages, browser and manual.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang++ >/dev/null || { echo "sanitize.sh: needs clang (scripts/install_packages.sh --nightly)" >&2; exit 2; }
mkdir -p build
cmake --preset checked >build/checked.log 2>&1 || { cat build/checked.log >&2; exit 1; }
cmake --build --preset checked --target annulus_cli test_core test_geometry test_fem test_dynamics test_app test_verification test_skeleton test_random random_scenes
[ $# -gt 0 ] || set -- --label-regex '^(unit|pipeline)$' \
  --exclude-regex '^(verification\.ring_types|package\.debian|app\.(report_page|reuse|tradeoff|optimisation|held_limits)|manual\..*)$'
ctest --preset checked --parallel "$(nproc)" "$@"
