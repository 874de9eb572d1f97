"""Studies that Python steers: all combinations of inputs, and searches by any optimiser."""

import itertools
from concurrent.futures import ThreadPoolExecutor
from numbers import Integral

import numpy
import pandas

from . import _program
from .results import run
from .scene import Scene


# What a point may end with; anything else, a missing program say, ends the study.
_refusals = (_program.InputError, _program.Refused, _program.LimitReached)


def _row(results, variant, figures):
    found = results.figures.loc[variant]
    row = {}
    for key in figures if figures is not None else found.index:
        at = found.loc[key] if key in found.index else {"value_SI": numpy.nan, "error_SI": numpy.nan}
        row[key], row[key + "_error"] = float(at["value_SI"]), float(at["error_SI"])
    return row


def study(scene, inputs, *, figures=None, workers=1, **options):
    """Runs all combinations of values of some inputs: study(scene, {"ring.pins": [8, 12], "accuracy": [0.01]}).

    Returns a data frame in SI units with the results and their errors (`<key>_error`), by variant and inputs. `figures`:
    keys of the wanted results; all without. A point that the program refuses has its message in the column `failure`.
    `workers` runs go on at a time; `options` are those of `run` but `out`. What points share is computed once.
    """
    if "out" in options:
        raise TypeError("points of a study share no folder: leave out `out`")
    if not isinstance(scene, Scene):
        scene = Scene.load(scene)
    names = list(inputs)
    values = [list(inputs[name]) for name in names]
    if not names or not all(values):
        raise ValueError("a study needs inputs, each with one value at least")
    points = list(itertools.product(*values))

    def rows_of(point):
        scene_at = scene.set(dict(zip(names, point, strict=True)))
        # Lists are no labels of a row.
        at = {n: tuple(v) if numpy.ndim(v) else v for n, v in zip(names, point, strict=True)}
        try:
            results = run(scene_at, **options)
        except _refusals as error:
            return [{"variant": "", **at, "failure": str(error)}]
        return [{"variant": v, **at, "failure": "", **_row(results, v, figures)} for v in results.variants]

    # What all points share is found by the first one; the others read it.
    rows = rows_of(points[0])
    with ThreadPoolExecutor(workers) as pool:
        for more in pool.map(rows_of, points[1:]):
            rows += more
    table = pandas.DataFrame(rows).set_index(["variant", *names])
    unknown = [key for key in figures or [] if key in table and table[key].isna().all()]
    if unknown and (table["failure"] == "").any():
        raise KeyError(f"{', '.join(unknown)}: no point has this result; Results.figures lists those of a run")
    return table


class Search:
    """The objective of a search for inputs, for any optimiser.

    search = Search(scene, {"ring.rim_mm": (10, 40)}, "sun_planet_dynamic_factor"); search(x) is the objective at x, one
    value per input. An optimiser with `ask` and `tell` is driven by `drive`; a function that takes an objective, such as
    scipy.optimize.minimize, takes the search itself. A point that was evaluated before, in any run, is not computed
    again. An input whose bounds are whole numbers (int) takes whole numbers: its values are rounded.
    """

    def __init__(self, scene, inputs, objective, *, goal="smallest", variant=None, failed=numpy.inf, **options):
        """inputs: bounds by key. objective: key of a result, or a function of Results. goal: "smallest" or "largest",
        whose objective has the other sign. failed: the objective where the program refuses a point. options: of run.
        """
        if goal not in ("smallest", "largest"):
            raise ValueError(f"goal = {goal!r}: is smallest or largest")
        self.scene = scene if isinstance(scene, Scene) else Scene.load(scene)
        self.names = list(inputs)
        self.bounds = [tuple(map(float, inputs[name])) for name in self.names]
        self._whole = [all(isinstance(bound, Integral) for bound in inputs[name]) for name in self.names]
        for name, (low, high) in zip(self.names, self.bounds, strict=True):
            if not low < high:
                raise ValueError(f"{name}: the bounds {low} and {high} do not rise")
        self._objective = objective
        self._sign = 1.0 if goal == "smallest" else -1.0
        self._variant = variant
        self._failed = failed
        self._options = options
        self._rows = []

    def __call__(self, x):
        x = [float(value) for value in numpy.atleast_1d(x)]
        x = [round(value) if whole else value for value, whole in zip(x, self._whole, strict=False)]
        if len(x) != len(self.names):
            raise ValueError(f"{len(x)} values for {len(self.names)} inputs ({', '.join(self.names)})")
        at = dict(zip(self.names, x, strict=True))
        failure = ""
        try:
            results = run(self.scene.set(at), **self._options)
            key = self._objective
            value = float(key(results) if callable(key) else results.value(key, self._variant))
            if not numpy.isfinite(value):
                value, failure = None, f"the objective is {value}"
        except _refusals as error:
            value, failure = None, str(error)
        self._rows.append({**at, "objective": numpy.nan if value is None else value, "failure": failure})
        return self._failed if value is None else self._sign * value

    @property
    def history(self):
        """Every evaluated point: inputs, objective (without sign), failure."""
        return pandas.DataFrame(self._rows, columns=[*self.names, "objective", "failure"])

    @property
    def best(self):
        """The best evaluated point; raises ValueError where none has an objective."""
        found = self.history.dropna(subset="objective")
        if found.empty:
            raise ValueError(f"none of {len(self._rows)} points has an objective")
        return found.loc[(self._sign * found["objective"]).idxmin()]

    def drive(self, optimiser, evaluations):
        """Asks an optimiser for points and tells it their objectives until so many are evaluated.

        optimiser.ask() returns a point or a list of points, optimiser.tell(asked, objectives) takes both back.
        """
        done = 0
        while done < evaluations:
            asked = optimiser.ask()
            if len(asked) == 0:
                raise ValueError(f"the optimiser asks for no point after {done} evaluations")
            several = numpy.ndim(asked) > 1
            values = [self(x) for x in (asked if several else [asked])]
            optimiser.tell(asked, values if several else values[0])
            done += len(values)
        return self.best
