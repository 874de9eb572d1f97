#!/usr/bin/env bash
# Runs clang-tidy over all sources; an error with its findings if there are any.
#   scripts/analyse.sh [build folder]    whose compile commands are used; default build/release
# The commands of a unity build take a quarter of the time, and each source in a batch is checked.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath "${1:-build/release}")
run-clang-tidy -quiet -p "$folder" -j "$(nproc)" -checks=-bugprone-suspicious-include -header-filter="$PWD/(core|geometry|fem|dynamics|app)/.*" \
  "$folder/(core|geometry|fem|dynamics|app)/.*|$PWD/(core|geometry|fem|dynamics|app)/.*" 2>/dev/null
