#!/usr/bin/env bash
# Writes docs/verification.md and its plots from the records of the tests.
#   scripts/verification_manual.sh [options of ctest]    default: all unit and verification tests, about ten minutes
# With options only the selected tests run; the other records are those of earlier runs.
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
# Without the tests that read the manual, and without the one that removes old records.
ctest --preset release --parallel "$(nproc)" --exclude-regex '^(manual\.|documents\.sentences)' --fixture-exclude-setup '^verification_records$' "$@"
build/release/tests/manual/verification_manual write --entries build/release/tests/entries.txt --records "$records" \
  --introduction tests/manual/introduction.md --docs docs
echo "docs/verification.md"
