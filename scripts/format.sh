#!/bin/sh
# Formats all sources with clang-format; with --check only tells which ones differ, and fails if any does.
set -eu
cd "$(dirname "$0")/.."
mode="-i"
[ "${1:-}" = "--check" ] && mode="--dry-run --Werror"
# shellcheck disable=SC2086 # one or two words
git ls-files -z '*.h' '*.cc' | xargs -0 -r clang-format $mode
