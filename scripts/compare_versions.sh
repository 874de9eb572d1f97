#!/usr/bin/env bash
# What users wait for, by an earlier version and by this one, side by side: clean builds, then whole commands (processor
# time, wall time, memory; tests/benchmarks/waiting_benchmark.cc).
#   scripts/compare_versions.sh [commit]           default: b36f476, the version that the goals of docs/benchmarks.md refer to
#   scripts/compare_versions.sh commit --works ring_types pinned_dynamics
#   scripts/compare_versions.sh commit --figures [scene ...]     figures of the shipped scenes instead of times
set -euo pipefail
cd "$(dirname "$0")/.."
commit=b36f476
if [ $# -gt 0 ]; then commit=$1; shift; fi
folder=${ANNULUS_COMPARED:-build/compared}
mkdir -p "$folder"
folder=$(realpath "$folder")

# Builds the program of a tree from nothing and prints how long it took; one that was built before is left alone.
build() {
  local name=$1 tree=$2
  [ ! -x "$folder/$name/app/annulus" ] || return 0
  cmake -S "$tree" -B "$folder/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DANNULUS_BUILD_TESTS=OFF >/dev/null
  TIMEFORMAT="clean build of the $name program: %R s, %U s of processor time"
  time cmake --build "$folder/$name" --target annulus_cli >/dev/null
}

git worktree prune
[ -d "$folder/source" ] || git worktree add --detach --force "$folder/source" "$commit" >/dev/null
build earlier "$folder/source"
build later .
if [ "${1:-}" = --figures ]; then
  shift
  exec scripts/compare_figures.py "$folder/earlier/app/annulus" "$folder/source/data/scenes" "$folder/later/app/annulus" \
    data/scenes "$folder/figures" "$@"
fi
cmake -S . -B "$folder/later" -DANNULUS_BUILD_TESTS=ON >/dev/null
cmake --build "$folder/later" --target waiting_benchmark >/dev/null
exec "$folder/later/tests/benchmarks/waiting_benchmark" --earlier "$folder/earlier/app/annulus" "$folder/source/data/scenes" \
  --later "$folder/later/app/annulus" data/scenes --folder "$folder/runs" "$@"
