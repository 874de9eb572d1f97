#!/usr/bin/env bash
# Installs the packages that annulus needs on Debian 12, as root or with sudo; a second call takes no time.
#   scripts/install_packages.sh              to build and run it
#   scripts/install_packages.sh --tests      for scripts/test.sh too
#   scripts/install_packages.sh --all        for scripts/test.sh --all too (twice as much)
#   scripts/install_packages.sh --nightly    for scripts/nightly.sh too
#   scripts/install_packages.sh --site       for scripts/site.sh alone
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
  g++ cmake ninja-build pkg-config help2man dpkg-dev file
  libdeal.ii-dev libgmsh-dev libeigen3-dev libsundials-dev libsuitesparse-dev libfftw3-dev libtbb-dev libpagmo-dev
  libboost-dev libboost-test-dev
  libopenblas-dev libopenblas0-pthread
  libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libspdlog-dev libfmt-dev
  pybind11-dev python3-dev python3-pandas python3-xarray
  zlib1g-dev libhdf5-dev libmatio-dev libpugixml-dev librsvg2-dev libjs-chart.js libjs-three node-pako
)
tests=(python3 python3-jsonschema clang-format
  parallel slurmctld slurmd slurm-client munge)  # they start the workers of a study
all=(
  calculix-ccx octave    # benchmarks compare with them
  python3-h5py python3-vtk9 chromium  # they read exports and reports
)
site=(mkdocs mkdocs-material doxygen
  python3-scipy python3-matplotlib python3-nbconvert python3-ipykernel  # of the notebooks
)
npm_packages=()
nightly=(clang libclang-rt-dev libomp-dev clang-tidy valgrind)
case "${1:-}" in
  "") ;;
  --tests) packages+=("${tests[@]}") ;;
  --site) packages+=("${site[@]}") ;;
  --all) packages+=("${tests[@]}" "${all[@]}" "${site[@]}"); npm_packages=(axe-core@4.14.1 @taplo/cli@0.7.0) ;;
  --nightly) packages+=("${tests[@]}" "${all[@]}" "${site[@]}" "${nightly[@]}"); npm_packages=(axe-core@4.14.1 @taplo/cli@0.7.0) ;;
  *) echo "install_packages.sh: unknown option $1" >&2; exit 2 ;;
esac

if [ ${#npm_packages[@]} -gt 0 ] && ! command -v npm >/dev/null; then packages+=(npm); fi

missing=()
for package in "${packages[@]}"; do
  if ! dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed; then
    missing+=("$package")
  fi
done

if [ ${#missing[@]} -gt 0 ]; then
  root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "install_packages.sh: run as root or install sudo; missing: ${missing[*]}" >&2
      exit 1
    fi
    root=(sudo)
  fi
  echo "Installing: ${missing[*]}"
  "${root[@]}" apt-get update -qq
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# Reports are checked by axe-core, the schema of scenes by taplo, which Debian does not have.
if [ ${#npm_packages[@]} -gt 0 ] && { [ ! -f node_modules/axe-core/axe.min.js ] || [ ! -e node_modules/.bin/taplo ]; }; then
  npm install --silent --no-save --no-package-lock "${npm_packages[@]}"
fi

# The reference BLAS is three to eight times slower in the factorisations.
blas=$(readlink -f "/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || gcc -print-multiarch)/libblas.so.3" || true)
case "$blas" in
  *openblas*) ;;
  *) echo "warning: the active BLAS is ${blas:-unknown}, not OpenBLAS: annulus will be slow" >&2 ;;
esac
