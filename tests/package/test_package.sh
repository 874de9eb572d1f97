#!/usr/bin/env bash
# The Debian package: made, unpacked into a folder of its own, its program and libraries used from there.
#   tests/package/test_package.sh <build folder>
set -euo pipefail
build=$(realpath "$1")
source=$(realpath "$(dirname "$0")/../..")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cd "$folder"
cpack --config "$build/CPackConfig.cmake" -G DEB -B "$folder/made" >/dev/null
package=$(echo "$folder"/made/annulus_*.deb)
dpkg-deb --field "$package" Package Version Architecture Depends
# Everything it depends on can be had; nothing is installed.
apt-get install --simulate --no-install-recommends "$package" >/dev/null
dpkg-deb --extract "$package" root
for file in usr/bin/annulus usr/share/man/man1/annulus.1 usr/share/bash-completion/completions/annulus \
  usr/share/zsh/vendor-completions/_annulus usr/share/fish/vendor_completions.d/annulus.fish \
  usr/share/annulus/scenes/ring_types.toml usr/share/doc/annulus/README.md usr/share/doc/annulus/copyright; do
  [ -e "root/$file" ] || [ -e "root/$file.gz" ] || { echo "the package has no $file" >&2; exit 1; }
done

program=root/usr/bin/annulus
"$program" --version
"$program" new planetary >my.toml
"$program" check my.toml
"$program" check root/usr/share/annulus/scenes/ring_types.toml
zcat -f root/usr/share/man/man1/annulus.1* | grep -q "annulus tradeoff\|tradeoff"

# The Python package finds the program's libraries.
export PYTHONPATH="$folder/root/usr/lib/python3/dist-packages" ANNULUS="$folder/root/usr/bin/annulus"
/usr/bin/python3 -c "
import annulus
system = annulus.lumped(annulus.Scene.new('lin_parker_1999/four_planets'))
assert len(system.M) == len(system.dofs) > 10, system
print('Python', annulus.version(), system)"

# The example finds the libraries by their package files.
cmake -S "$source/examples" -B example -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$folder/root/usr" >/dev/null
cmake --build example >/dev/null
example/ring_stiffness | tee stiffness.txt
[ "$(grep -c 'N/um' stiffness.txt)" = 9 ]
