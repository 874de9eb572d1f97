#!/usr/bin/env bash
# Makes docs/verification.md with its plots from what the tests record while they run; about ten minutes.
#   scripts/verification_manual.sh [options of ctest]    default: all unit and verification tests
# With options only the tests they name run; the rest is taken from earlier runs.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset release -DANNULUS_BUILD_TESTS=ON
cmake --build --preset release
records=build/release/verification
if [ $# -eq 0 ]; then
  rm -rf "$records"
  mkdir -p "$records"
  set -- --label-regex '^(unit|verification)$'
fi
# Not the tests of the manual itself, which is about to be made.
ctest --preset release --parallel "$(nproc)" --exclude-regex '^manual\.' "$@"
build/release/tests/manual/verification_manual write --entries build/release/tests/entries.txt --records "$records" \
  --introduction tests/manual/introduction.md --docs docs
echo "docs/verification.md"
