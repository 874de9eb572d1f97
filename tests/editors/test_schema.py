"""The JSON Schema of scenes, by a validator that is not ours: all shipped scenes are valid, wrong values are not.

    test_schema.py PROGRAM SOURCE_FOLDER
"""

import copy
import json
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema

program, source = sys.argv[1], Path(sys.argv[2])
schema = json.loads(subprocess.run([program, "explain", "--json-schema"], capture_output=True, check=True).stdout)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)

files = sorted([*source.glob("data/scenes/*.toml"), *source.glob("data/cases/*/*.toml")])
files = [f for f in files if "[stage]" in f.read_text() or "stage" in tomllib.loads(f.read_text())]
assert len(files) > 20, files
failed = 0


def problems(scene):
    return [f"{'.'.join(map(str, e.absolute_path))}: {e.message[:150]}" for e in validator.iter_errors(scene)]


for file in files:
    for problem in problems(tomllib.loads(file.read_text())):
        print(f"{file.name}: {problem}")
        failed += 1

# Every key of the reference has its place, and a meaning.
keys = subprocess.run([program, "explain"], capture_output=True, text=True, check=True).stdout
named = [line for line in keys.splitlines() if line and not line.startswith(" ")]
assert len(named) > 300, len(named)


def place(key):
    at = schema
    for name in key.split("."):
        at = at.get("items", at)["properties"][name]
    return at


for key in named:
    try:
        found = place(key)
    except KeyError:
        print(f"{key}: is not in the schema")
        failed += 1
        continue
    if len(found.get("description", "")) < 10:
        print(f"{key}: has no description")
        failed += 1

# A value outside its range, of a wrong type, or of an unknown key is found at its place.
scene = tomllib.loads((source / "data/scenes/ring_types.toml").read_text())
wrong = {
    ("stage", "module_mm"): [-1, "3.8", [3.8], 1e9],
    ("stage", "planets"): [2.5, 0, "five"],
    ("stage", "kind"): ["planetory"],
    ("accuracy",): [0, 1, "high"],
    ("ring", 0, "structure"): ["welded"],
    ("ring", 0, "outside_diameter_mm"): [0],
    ("supports", "sun_N_per_m"): ["stiff", -1],
    ("errors", "planet_eccentricity_um"): ["ten", 10],
    ("sun", "tooth"): [48],
    ("no_such_table",): [{}],
}
tried = 0
for path, values in wrong.items():
    for value in values:
        changed = copy.deepcopy(scene)
        at = changed
        for part in path[:-1]:
            at = at.setdefault(part, {}) if isinstance(at, dict) else at[part]
        at[path[-1]] = value
        tried += 1
        if not problems(changed):
            print(f"{'.'.join(map(str, path))} = {value!r}: is not found to be wrong")
            failed += 1
# What a kind requires.
for table, key in [("stage", "module_mm"), ("sun", "teeth"), ("stage", "face_width_mm")]:
    changed = copy.deepcopy(scene)
    del changed[table][key]
    tried += 1
    if not problems(changed):
        print(f"{table} without {key}: is not found to be wrong")
        failed += 1
# An unfinished scene is told what it lacks, and nothing of other kinds.
for unfinished in [{}, {"stage": {}}, {"stage": {"module_mm": 2}}]:
    found = problems(unfinished)
    tried += 1
    if len(found) != 1 or not ("stage" in found[0] or "kind" in found[0]):
        print(f"{unfinished}: {found}")
        failed += 1
print(f"{len(files)} scenes, {len(named)} keys, {tried} wrong values: {failed} problems")
sys.exit(1 if failed else 0)
