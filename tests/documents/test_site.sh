#!/usr/bin/env bash
# The documentation site is built, its links lead somewhere, and its search knows the words of the field.
#   tests/documents/test_site.sh PROGRAM PYTHON_FOLDER SOURCE_FOLDER FOLDER
set -euo pipefail
export ANNULUS=$1 PYTHONPATH=$2
source=$3
site=$4
"$source/scripts/site.sh" "$site"
/usr/bin/python3 "$source/tests/documents/site_links.py" "$site/html"
for word in "load-sharing factor" "profile_shift_from" "harmonic balance"; do
  grep -q "$word" "$site/html/search/search_index.json"
done
for run in "$site"/html/live/*/; do
  [ -s "$run/report.html" ]
  grep -q "live/$(basename "$run")/report.html" "$site/html/gallery.html"
done
