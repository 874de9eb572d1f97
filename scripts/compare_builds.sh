#!/usr/bin/env bash
# Runs a small stage with the optimised program and with the checked one (clang, -O1, assertions, sanitizers) and compares
# all results; an error if they differ by more than rounding.
#   scripts/compare_builds.sh [program]    default build/release/app/annulus
set -euo pipefail
cd "$(dirname "$0")/.."
program=$(realpath "${1:-build/release/app/annulus}")
command -v clang++ >/dev/null || { echo "compare_builds.sh: needs clang (scripts/install_packages.sh --nightly)" >&2; exit 2; }
mkdir -p build
cmake --preset checked >build/checked.log 2>&1 || { cat build/checked.log >&2; exit 1; }
cmake --build build/checked --target annulus_cli

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp tests/analysis/small_set.toml "$folder"
export ANNULUS_CACHE="" ASAN_OPTIONS=detect_leaks=0
"$program" run "$folder/small_set.toml" -o "$folder/optimised" --quiet
build/checked/app/annulus run "$folder/small_set.toml" -o "$folder/checked" --quiet
/usr/bin/python3 tests/analysis/compare_runs.py "$folder/optimised" "$folder/checked"
