#!/usr/bin/env python3
"""Figures of the shipped scenes by two versions of the program, side by side, as Markdown.

compare_figures.py EARLIER SCENES LATER SCENES FOLDER [NAME ...]: programs, each with the folder of its own scenes, and a
folder for the runs. A run that FOLDER has already is not repeated. Figures are all members of summary.json that have a
value and an error and the same place in both.
"""

import json
import os
import pathlib
import subprocess
import sys

ROUNDING = 1e-6  # of motions, whose integration has tolerances of 1e-6 to 1e-9


def figures(node, place=""):
    """(place, value, error) of all figures; an error of None is not known."""
    if isinstance(node, list):
        for i, item in enumerate(node):
            yield from figures(item, f"{place}/{i}")
    if not isinstance(node, dict):
        return
    value = node.get("value")
    if isinstance(value, (int, float)) and ("error" in node or "error_relative" in node):
        error = node.get("error")
        if error is None and node.get("error_relative") is not None:
            error = abs(value * node["error_relative"])
        yield place, value, error
        return
    for key, item in node.items():
        yield from figures(item, f"{place}/{key}")


def results(program, scene, out):
    """The figures of a run by their places; a message where it failed."""
    if not (out / "summary.json").exists():
        done = subprocess.run(
            [program, "run", str(scene), "--quiet", "--out", str(out)],
            env=dict(os.environ, ANNULUS_CACHE=""),
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            return done.stderr.strip().splitlines()[-1]
    found = figures(json.loads((out / "summary.json").read_text(encoding="utf-8")))
    return {place: (value, error) for place, value, error in found}


def main(earlier, earlier_scenes, later, later_scenes, folder, *names):
    folder = pathlib.Path(folder)
    scenes = [pathlib.Path(later_scenes) / f"{name}.toml" for name in names] or sorted(pathlib.Path(later_scenes).glob("*.toml"))
    print("| scene | figures of both | equal to rounding | within their errors | beyond |\n|---|---|---|---|---|")
    beyond = []
    for scene in scenes:
        before_scene = pathlib.Path(earlier_scenes) / scene.name
        if not before_scene.exists():
            continue
        before = results(earlier, before_scene, folder / f"earlier_{scene.stem}")
        after = results(later, scene, folder / f"later_{scene.stem}")
        if isinstance(before, str) or isinstance(after, str):
            print(f"| `{scene.stem}` | {before if isinstance(before, str) else after} | | | |")
            continue
        equal = within = 0
        both = [place for place in before if place in after]
        for place in both:
            (x, x_error), (y, y_error) = before[place], after[place]
            if abs(x - y) <= ROUNDING * max(abs(x), abs(y)):
                equal += 1
            elif None not in (x_error, y_error) and abs(x - y) <= x_error + y_error:
                within += 1
            else:
                beyond.append(f"- `{scene.stem}{place}`: {x:.6g} ± {x_error}, now {y:.6g} ± {y_error}")
        print(f"| `{scene.stem}` | {len(both)} | {equal} | {within} | {len(both) - equal - within} |", flush=True)
    print("\n" + "\n".join(beyond))


if __name__ == "__main__":
    main(*sys.argv[1:])
