#!/usr/bin/env bash
# Installs the packages, builds a release and compares the three ring structures of the base scene.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh
cmake --preset release -DANNULUS_BUILD_TESTS=OFF
cmake --build --preset release
build/release/app/annulus run data/scenes/ring_types.toml -o out/ring_types --threads "$(nproc)"
echo
echo "The report: $PWD/out/ring_types/report.html"
