#!/usr/bin/env bash
# Builds everything with the address and undefined-behaviour sanitizers (clang) and runs tests of it:
#   scripts/sanitize.sh [options of ctest]    default: all unit and pipeline tests
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang++ >/dev/null || { echo "sanitize.sh: needs clang (scripts/install_packages.sh --tests)" >&2; exit 2; }
mkdir -p build
cmake --preset checked >build/checked.log 2>&1 || { cat build/checked.log >&2; exit 1; }
cmake --build --preset checked
[ $# -gt 0 ] || set -- --label-regex '^(unit|pipeline)$'
ctest --preset checked --parallel "$(nproc)" "$@"
