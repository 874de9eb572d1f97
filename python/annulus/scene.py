"""Scenes: a file, and values that differ from it."""

import json
import tomllib
from collections.abc import Mapping
from numbers import Integral, Real
from pathlib import Path

import pandas

from . import _program


def toml_value(value):
    """A value as a scene file has it."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        return repr(float(value))
    try:
        return "[" + ", ".join(toml_value(v) for v in value) + "]"
    except TypeError:
        raise TypeError(f"{value!r} is neither a number, a text, true or false, nor a list of these") from None


class Scene:
    """A scene of annulus. It does not change: `set` makes another one.

    Keys are paths as `annulus run --set` takes them: "accuracy", "supports.sun_N_per_m", "ring.pins" (of every ring that
    gives it), "ring.pinned.pins" (of the ring 'pinned'), "errors.planet_eccentricity_um[2]" (of planet 2, in a list that
    the scene has).
    `annulus.explain(key)` says what a key means.
    """

    def __init__(self, file, changes=None, folder=None):
        self._file = Path(file).expanduser().absolute()
        self._changes = dict(changes or {})
        self._folder = folder  # a temporary one lives as long as its scenes
        if not self._file.is_file():
            raise _program.InputError(f"{file}: there is no such scene file")

    @classmethod
    def load(cls, file):
        """The scene of a file (TOML)."""
        return cls(file)

    @classmethod
    def new(cls, name="planetary"):
        """A scene to start from: of a kind ("planetary", "helical_pair", ...) or a shipped one ("ring_types", ...)."""
        folder = _program.TemporaryFolder()
        file = Path(folder.path) / (name.replace("/", "_") + ".toml")
        file.write_text(_program.example(name))
        return cls(file, folder=folder)

    @property
    def file(self):
        """The file below all changes."""
        return self._file

    @property
    def changes(self):
        """Values that differ from the file, by their keys."""
        return dict(self._changes)

    def set(self, changes, value=None):
        """The same scene with other values: set("ring.pins", 12) or set({"ring.pins": 12, "accuracy": 0.01})."""
        if not isinstance(changes, Mapping):
            changes = {changes: value}
        for key, new in changes.items():
            toml_value(new)
            if not isinstance(key, str):
                raise TypeError(f"{key!r} is not a key of a scene")
        kept = {key: old for key, old in self._changes.items() if key not in changes}  # the last one said holds
        return Scene(self._file, {**kept, **changes}, self._folder)

    def tables(self):
        """The tables of the file with the changes, as tomllib reads them."""
        return tomllib.loads(self.text())

    def text(self):
        """The scene as the text of a file. Comments remain where nothing was changed."""
        if not self._changes:
            return self._file.read_text()
        return _program.call("new", "--scene", self._file, *self.settings())

    def save(self, file):
        """Writes the scene. Files that it names are looked for beside `file`."""
        Path(file).expanduser().write_text(self.text())

    def settings(self):
        """The changes as arguments of the program."""
        arguments = []
        for key, value in self._changes.items():
            arguments += ["--set", f"{key}={toml_value(value)}"]
        return arguments

    def arguments(self):
        """File and changes as arguments of the program."""
        return [str(self._file), *self.settings()]

    def check(self):
        """Warnings of the scene as a table: severity, text, where. Raises InputError if it is wrong."""
        found = _program.call_json("check", *self.arguments())["warnings"]
        return pandas.DataFrame(found, columns=["key", "severity", "where", "text"])

    def plan(self):
        """What a run would model, and its predicted time and memory, as `annulus plan --json` states them."""
        return _program.call_json("plan", *self.arguments())

    def __repr__(self):
        changes = "".join(f", {key} = {toml_value(value)}" for key, value in self._changes.items())
        return f"<annulus scene {self._file.name}{changes}>"
