#!/usr/bin/env bash
# The JSON Schema in a TOML language tool: shipped scenes pass, a wrong value is found.
#   tests/editors/test_taplo.sh PROGRAM SOURCE_FOLDER
set -euo pipefail
program=$1
source=$2
taplo=$source/node_modules/.bin/taplo
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" explain --json-schema >"$folder/schema.json"
lint() { "$taplo" lint --schema "file://$folder/schema.json" "$@"; }

lint "$source"/data/scenes/*.toml "$source"/data/cases/*/[a-z]*.toml
sed 's/^module_mm .*/module_mm = -1/' "$source/data/scenes/ring_types.toml" >"$folder/wrong.toml"
if lint "$folder/wrong.toml" 2>"$folder/messages"; then
  echo "module_mm = -1 is not found" >&2
  exit 1
fi
grep -q "module_mm\|minimum" "$folder/messages"
