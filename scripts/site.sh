#!/usr/bin/env bash
# The documentation site: documents, finished runs, notebooks and the reference of the libraries in build/site/html.
#   scripts/site.sh [FOLDER]                  installs its packages, builds annulus, writes FOLDER/html (build/site)
#   ANNULUS=annulus scripts/site.sh FOLDER    with an installed program; installs and builds nothing
#   python3 -m http.server -d build/site/html      shows it with its search
set -euo pipefail
cd "$(dirname "$0")/.."
site=$(realpath -m "${1:-build/site}")
if [ -z "${ANNULUS:-}" ]; then
  scripts/install_packages.sh --site
  cmake --preset release -DANNULUS_BUILD_TESTS=OFF
  cmake --build --preset release
  export ANNULUS=$PWD/build/release/app/annulus PYTHONPATH=$PWD/build/release/python
fi
ANNULUS=$(realpath "$(command -v "$ANNULUS")")
/usr/bin/python3 -c 'import annulus' || { echo "site.sh: PYTHONPATH has to name the folder of the package" >&2; exit 1; }
source=$site/source
rm -rf "$source" "$site/html"
mkdir -p "$source/live" "$source/notebooks"

# Documents and what they refer to, each in its place.
cp -r README.md CONTRIBUTING.md CHANGELOG.md CITATION.cff docs data "$source"
find core geometry fem dynamics app examples tests -name '*.h' -o -name ring_stiffness.cc -o -name README.md |
  tar -c -T - | tar -x -C "$source"

# Reports as a run writes them, with their pictures.
runs=(data/scenes/minimal.toml data/scenes/ring_types.toml data/cases/car_splined_ring/five_planets.toml
  data/scenes/helical_pair_in_bearings.toml data/scenes/arc_tooth_2kv.toml)
for scene in "${runs[@]}"; do
  name=$(basename "$scene" .toml)
  echo "$name ..."
  "$ANNULUS" run "$scene" -o "$site/runs/$name" --threads "$(nproc)" --quiet >/dev/null
  mkdir "$source/live/$name"
  cp -r "$site/runs/$name"/{report.html,pictures} "$source/live/$name"
done
/usr/bin/python3 scripts/site_gallery.py "$site/runs" "${runs[@]}" >"$source/gallery.md"

/usr/bin/python3 -m nbconvert --to markdown --execute --log-level ERROR --output-dir "$source/notebooks" python/notebooks/*.ipynb
(cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = \"$source/reference\"") | doxygen -

ANNULUS_SITE_SOURCE=$source mkdocs build --strict --quiet --site-dir "$site/html"
echo "The site: $site/html/index.html"
