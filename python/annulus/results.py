"""Results of a run as tables with values, errors and units."""

import json
import zlib
from pathlib import Path

import pandas
import xarray

from . import _program
from .scene import Scene

# Units at the ends of names; those that end like others stand before them.
_units = {
    "_N_s_per_m": "N s/m", "_N_per_m": "N/m", "_m_per_N": "m/N", "_m_per_s2": "m/s²", "_m_per_s": "m/s",
    "_N_per_mm": "N/mm", "_N_per_um": "N/µm", "_Nm_per_rad": "N m/rad", "_per_sqrt_kg": "", "_kg_m2": "kg m²",
    "_N_m": "N m", "_deg": "°", "_rad": "rad", "_MPa": "MPa", "_Pa": "Pa", "_Hz": "Hz", "_rpm": "r/min", "_um": "µm",
    "_mm": "mm", "_kg": "kg", "_J": "J", "_W": "W", "_N": "N", "_m": "m", "_s": "s", "_relative": "1",
}  # fmt: skip


def unit_of(name):
    """Unit of a column or a result by its name: "N/m" of "stiffness_N_per_m"; empty where the name states none."""
    return next((unit for ending, unit in _units.items() if name.endswith(ending)), "")


# Columns of texts: names of rings stay texts, also "12" and "NA".
_texts = {"variant", "key", "symbol", "unit", "title", "name", "ring", "kind"}


def read_table(file):
    """A CSV table of a run. Its header lines are in `attrs`, units of its columns in `attrs["units"]`."""
    header = {}
    with open(file, encoding="utf-8") as lines:
        for line in lines:
            if not line.startswith("#"):
                break
            key, _, value = line[1:].partition(":")
            header[key.strip()] = value.strip()
    columns = pandas.read_csv(file, skiprows=len(header), nrows=0).columns
    table = pandas.read_csv(
        file,
        skiprows=len(header),
        float_precision="round_trip",
        dtype={name: str for name in columns if name in _texts},
        keep_default_na=False,
        na_values={name: ["", "nan"] for name in columns if name not in _texts},
    )
    table.attrs = {**header, "units": {name: unit_of(name) for name in table.columns if unit_of(name)}}
    return table


def read_stiffness(file):
    """A stiffness table as labelled arrays over ring_angle_deg × mesh_phase × load_N, with `units` of each array."""
    axes = ["ring_angle_deg", "mesh_phase", "load_N"]
    table = read_table(file)
    if not {"stiffness_secant_N_per_m", *axes} <= set(table.columns):
        raise _program.InputError(f"{file}: is not a stiffness table (stiffness_<mesh>.csv)")
    # A position lies a mesh phase further at each row: its angle is that of phase 0.
    position = (table["mesh_phase"].diff() < 0).cumsum()
    table["ring_angle_deg"] = table.groupby(position)["ring_angle_deg"].transform("first")
    arrays = table.set_index(axes).to_xarray()
    for name in [*arrays.data_vars, *axes]:
        arrays[name].attrs["units"] = unit_of(name)
    arrays.attrs = {key: value for key, value in table.attrs.items() if key != "units"}
    return arrays


def _checksum(file):
    """Size and CRC-32 as run.json has them; "missing" where there is no such file."""
    if not file.is_file():
        return "missing"
    data = file.read_bytes()
    return f"{len(data)} bytes, {zlib.crc32(data):08x}"


def _checksums_of_run(folder):
    """Checksums of the files that a whole run left in a folder, by name."""
    file = folder / "run.json"
    if not file.is_file():
        raise _program.InputError(f"{folder}: has no run.json, so that no run has ended there")
    try:
        note = json.loads(file.read_text(encoding="utf-8"))
        stated, files = note.pop("checksum"), dict(note["files"])
    except (ValueError, KeyError, TypeError, AttributeError):
        raise _program.InputError(f"{file}: is damaged; run the scene again") from None
    text = json.dumps(note, indent=2, ensure_ascii=False).encode() + b"\n"
    if stated != f"{len(text)} bytes, {zlib.crc32(text):08x}":
        raise _program.InputError(f"{file}: is damaged; run the scene again")
    return files


class Results:
    """A finished run. Its files stay as long as the object, or for good in a folder of one's own."""

    def __init__(self, folder, temporary=None):
        self.folder = Path(folder)
        self._temporary = temporary
        self._checksums = _checksums_of_run(self.folder)
        self.summary = json.loads(self._checked("summary.json").read_text(encoding="utf-8"))
        #: Every result: symbol, value, error, unit and title; value_SI and error_SI in SI units. By variant and key.
        self.figures = self._figures()

    def _checked(self, name):
        """A file of the folder. Those of the run have to be as it left them."""
        file = self.folder / name
        if self._checksums.get(name, _checksum(file)) != _checksum(file):
            raise _program.InputError(
                f"{file}: is missing or has changed since the run that wrote it; run the scene again to restore it"
            )
        return file

    def _figures(self):
        table = read_table(self._checked("figures.csv"))
        table = table.rename(
            columns={"value": "value_SI", "error": "error_SI", "shown_value": "value", "shown_error": "error"}
        )
        columns = ["symbol", "value", "error", "unit", "title", "value_SI", "error_SI"]
        drawn = ["quantile_05", "median", "quantile_95"]
        if table[drawn].notna().any(axis=None):
            columns += drawn
        return table.set_index(["variant", "key"])[columns]

    @property
    def variants(self):
        """Names of the lumped models: the rings of a planetary stage, else one without a name."""
        return list(dict.fromkeys(self.figures.index.get_level_values("variant")))

    def variant(self, name=None):
        """The name of a variant, which may be left out where there is one."""
        if name is None and len(self.variants) == 1:
            return self.variants[0]
        if name not in self.variants:
            raise KeyError(f"{name!r} is not a variant of this run; they are {', '.join(self.variants)}")
        return name

    def value(self, key, variant=None):
        """A result in SI units."""
        return float(self._row(key, variant)["value_SI"])

    def error(self, key, variant=None):
        """Its estimated error in SI units; NaN where it is not known."""
        return float(self._row(key, variant)["error_SI"])

    def _row(self, key, variant):
        name = self.variant(variant)
        try:
            return self.figures.loc[(name, key)]
        except KeyError:
            raise KeyError(f"{key} is not a result of this run; Results.figures lists them") from None

    @property
    def error_parts(self):
        """Parts of the errors in SI units (discretisation, ...), by variant and key."""
        rows = {
            (variant["name"], key): result["error_parts"]
            for variant in self.summary["variants"]
            for key, result in variant["figures"].items()
            if "error_parts" in result
        }
        table = pandas.DataFrame.from_dict(rows, orient="index", dtype=float)
        if rows:
            table.index.names = ["variant", "key"]
        return table

    @property
    def warnings(self):
        """What a user must know before using the results: key, severity, where, text."""
        return pandas.DataFrame(self.summary["warnings"], columns=["key", "severity", "where", "text"])

    @property
    def tables(self):
        """Names of all tables (CSV) of the run, as `table` takes them."""
        return sorted(str(file.relative_to(self.folder).with_suffix("")) for file in self.folder.rglob("*.csv"))

    def table(self, name):
        """A table as a data frame: table("traditional/dynamics/modes"). Units are in its `attrs`."""
        file = self.folder / (name + ".csv")
        if not file.is_file():
            raise KeyError(f"{name!r} is not a table of this run; Results.tables lists them")
        return read_table(self._checked(name + ".csv"))

    def stiffness(self, mesh, variant=None):
        """Stiffness of a computed mesh ("sun_planet", "ring_planet", ...) as labelled arrays (read_stiffness)."""
        name = f"stiffness_{mesh}"
        found = [t for t in self.tables if t == name or t.endswith("/" + name)]
        if len(found) > 1:
            found = [t for t in found if t.split("/")[0] == self.variant(variant)]
        if not found:
            raise KeyError(f"{mesh!r} has no stiffness table in this run; Results.tables lists all tables")
        return read_stiffness(self._checked(found[0] + ".csv"))

    @property
    def report(self):
        """Path of the report, a page for a browser."""
        return self.folder / "report.html"

    def _repr_html_(self):
        return self.figures[["title", "value", "error", "unit"]]._repr_html_()

    def __repr__(self):
        return f"<annulus results of {', '.join(v or 'one stage' for v in self.variants)}: {len(self.figures)} figures>"


def run(
    scene,
    *,
    accuracy=None,
    out=None,
    threads=None,
    budget=None,
    max_time=None,
    max_memory=None,
    cache=None,
):
    """Runs a scene (a Scene, or the path of a file) and returns its Results.

    accuracy: wanted relative accuracy, instead of that of the scene. out: folder of the files; a temporary one without.
    budget, max_time: "30s", "2min"; max_memory: "2GB"; as options of `annulus run`. cache: folder of cached results.
    Raises InputError, Refused and LimitReached with the message of the program.
    """
    if not isinstance(scene, Scene):
        scene = Scene.load(scene)
    if accuracy is not None:
        scene = scene.set("accuracy", accuracy)
    temporary = _program.TemporaryFolder() if out is None else None
    folder = temporary.path if temporary else out
    arguments = ["run", *scene.arguments(), "--out", folder, "--quiet"]
    options = {
        "--threads": threads,
        "--budget": budget,
        "--max-time": max_time,
        "--max-memory": max_memory,
        "--cache": cache,
    }
    for option, value in options.items():
        if value is not None:
            arguments += [option, value]
    _program.call(*arguments)
    return Results(folder, temporary)
