"""Compares the results of two runs of one scene number by number: compare_runs.py OUT OTHER

Numbers of a column count by its largest one, numbers of the summary by themselves. What may differ is rounding, times,
memory, and what is rounding itself (balances that are zero in exact arithmetic).
"""

import csv
import json
import pathlib
import sys

# Rounding of some 1e-16 grows by the condition of the bodies (1e7) and, of motions, of the steps that a tolerance of
# 1e-6 to 1e-9 leaves: 1e-9 and 1e-6 stand a hundred times above what two compilers differ by.
SOLVED, MOVED = 1e-9, 1e-6
ROUNDING = ("invariants", "condensation", "_balance_relative", "closure_relative", "reciprocity_relative", "max_penetration")
NOT_OF_THE_RESULT = ("timings_s", "memory", "cost", "seconds", "reuse", "computed", "_id", "inputs_hash", "wall_s", "steps", "evaluations")


def skipped(name):
    return any(part in name for part in ROUNDING + NOT_OF_THE_RESULT)


def columns(file):
    with open(file, encoding="utf-8") as lines:
        rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def table_difference(one, other):
    """Largest difference over the columns, relative to the largest number of each."""
    a, b = columns(one), columns(other)
    if a.keys() != b.keys():
        return float("inf")
    worst = 0.0
    for name in a:
        if skipped(name):
            continue
        if len(a[name]) != len(b[name]):
            return float("inf")
        pairs = [(number(x), number(y), x, y) for x, y in zip(a[name], b[name])]
        if any(x is None or y is None for x, y, _, _ in pairs):
            worst = max(worst, max((0.0 if s == t else float("inf") for _, _, s, t in pairs), default=0.0))
            continue
        scale = max((abs(x) for x, _, _, _ in pairs), default=0.0)
        difference = max((abs(x - y) for x, y, _, _ in pairs), default=0.0)
        if difference > 0:
            worst = max(worst, difference / scale if scale > 0 else float("inf"))
    return worst


def summary_difference(a, b, name=""):
    if skipped(name):
        return 0.0
    if isinstance(a, dict) and isinstance(b, dict):
        if a.keys() != b.keys():
            return float("inf")
        # An error bar counts by the value it belongs to.
        if "value" in a and isinstance(a["value"], (int, float)) and isinstance(b["value"], (int, float)):
            scale = max(abs(a["value"]), 1e-300)
            parts = [abs(a["value"] - b["value"]) / scale]
            if isinstance(a.get("error"), (int, float)) and isinstance(b.get("error"), (int, float)):
                parts.append(abs(a["error"] - b["error"]) / scale)
            return max(parts)
        return max((summary_difference(a[key], b[key], key) for key in a), default=0.0)
    if isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            return float("inf")
        return max((summary_difference(x, y, name) for x, y in zip(a, b)), default=0.0)
    if isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool):
        return abs(a - b) / max(abs(a), abs(b)) if a != b else 0.0
    return 0.0 if a == b else float("inf")


def main(one, other):
    one, other = pathlib.Path(one), pathlib.Path(other)
    files = sorted(path.relative_to(one) for path in one.rglob("*.csv"))
    if not files or files != sorted(path.relative_to(other) for path in other.rglob("*.csv")):
        sys.exit("the two runs did not write the same tables")
    failed = False
    for file in files:
        difference = table_difference(one / file, other / file)
        limit = MOVED if "dynamics" in file.parts else SOLVED
        failed |= not difference <= limit
        print(f"{difference:9.1e}  {file}{'' if difference <= limit else '   more than ' + str(limit)}")
    summaries = [json.loads((folder / "summary.json").read_text()) for folder in (one, other)]
    difference = summary_difference(*summaries)
    failed |= not difference <= MOVED
    print(f"{difference:9.1e}  summary.json")
    sys.exit(failed)


main(*sys.argv[1:])
