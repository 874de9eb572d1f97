#!/usr/bin/env bash
# Formats all sources with clang-format; with --check reports which ones differ, and fails if any does.
set -euo pipefail
cd "$(dirname "$0")/.."
mode=(-i)
[ "${1:-}" = --check ] && mode=(--dry-run --Werror)
find core geometry fem dynamics app tests examples \( -name '*.h' -o -name '*.cc' \) -print0 | xargs -0 -r clang-format "${mode[@]}"
