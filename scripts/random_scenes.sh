#!/usr/bin/env bash
# Random scenes of every kind and model: relations that have to hold between their results, coverage of their stated
# errors, predicted against actual cost.
#   scripts/random_scenes.sh 1000 --jobs 2     the tables go to standard output; --help lists the options
# Scenes that break a relation stay in the folder random_scenes.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset release -DANNULUS_BUILD_TESTS=ON
cmake --build --preset release --target random_scenes
exec build/release/tests/random/random_scenes "$@"
