#!/usr/bin/env bash
# Runs a small stage under valgrind (memcheck), from the scene to the report; an error if the program reads or writes
# what is not its own, or decides by what was never set.
#   scripts/valgrind.sh [program]    default build/release/app/annulus
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/app/annulus}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp tests/analysis/small_set.toml "$folder"
# What a run takes here is not what runs take on this machine: no costs are kept.
ANNULUS_CACHE="" OPENBLAS_NUM_THREADS=1 valgrind --quiet --error-exitcode=9 --num-callers=20 \
  "$program" run "$folder/small_set.toml" -o "$folder/out" --threads 1
