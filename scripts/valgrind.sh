#!/usr/bin/env bash
# Runs a small stage under valgrind (memcheck), from the scene to the report; an error if the program reads or writes
# memory that it does not own, or branches on memory that was never set.
#   scripts/valgrind.sh [program]    default build/release/app/annulus
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/app/annulus}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp tests/analysis/small_set.toml "$folder"
# No costs are stored: a run under valgrind is not representative of this machine.
ANNULUS_CACHE="" OPENBLAS_NUM_THREADS=1 valgrind --quiet --error-exitcode=9 --num-callers=20 \
  "$program" run "$folder/small_set.toml" -o "$folder/out" --threads 1
