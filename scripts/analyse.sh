#!/usr/bin/env bash
# Formatting and clang-tidy over all sources; an error with what they found if they find anything.
#   scripts/analyse.sh [build folder]    whose compile commands are used; default build/release
# A unity build's commands take a quarter of the time: every file of such a source is looked at.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath "${1:-build/release}")
scripts/format.sh --check
run-clang-tidy -quiet -p "$folder" -j "$(nproc)" -checks=-bugprone-suspicious-include -header-filter="$PWD/(core|geometry|fem|dynamics|app)/.*" \
  "$folder/(core|geometry|fem|dynamics|app)/.*|$PWD/(core|geometry|fem|dynamics|app)/.*" 2>/dev/null
