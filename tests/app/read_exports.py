"""Reads exported files with readers that are not annulus' own and compares them with the native table.

usage: read_exports.py table stiffness.csv FOLDER | matrix ring_compliance.csv FOLDER | rexs FILE KEY=VALUE ... | vtu FILE
Ends with an error where anything differs; prints how many numbers were compared.
"""
import base64
import csv
import itertools
import re
import sys
import xml.etree.ElementTree
import zlib

import h5py
import numpy

QUANTITIES = ["unloaded_te_m", "lte_m", "stiffness_secant_N_per_m", "stiffness_tangent_N_per_m"]


def native(path):
    with open(path) as file:
        lines = [line for line in file if not line.startswith("#")]
    return list(csv.DictReader(lines))


def same(found, expected, digits, what):
    found, expected = numpy.asarray(found, dtype=float), numpy.asarray(expected, dtype=float)
    assert found.shape == expected.shape, f"{what}: shape {found.shape} where {expected.shape} is expected"
    assert numpy.allclose(found, expected, rtol=10.0**-digits, atol=0), f"{what}: {found} where {expected} is expected"
    return found.size


class Table:
    """The native table as arrays over ring position, phase and load."""

    def __init__(self, path):
        rows = native(path)
        unique = lambda name: list(dict.fromkeys(float(row[name]) for row in rows))
        self.phases, self.angles, self.loads = unique("mesh_phase"), unique("ring_angle_deg"), unique("load_N")
        shape = (len(self.angles), len(self.phases), len(self.loads))
        self.values = {q: numpy.array([float(row[q]) for row in rows]).reshape(shape) for q in QUANTITIES}
        self.cycles = [r + p for r in range(len(self.angles)) for p in self.phases] + [len(self.angles)]

    def over_cycles(self, quantity):
        """Mesh cycles x loads, closed over the period."""
        values = self.values[quantity].reshape(-1, len(self.loads))
        return numpy.vstack([values, values[:1]])


def check_hdf5(table, path):
    count = 0
    with h5py.File(path, "r") as file:
        count += same(file["mesh_phase"], table.phases, 15, "mesh_phase")
        count += same(file["load_N"], table.loads, 15, "load_N")
        for q in QUANTITIES:
            count += same(file[q], table.values[q], 15, q)
            axes = [dimension[0].name for dimension in file[q].dims]
            assert axes == ["/ring_angle_deg", "/mesh_phase", "/load_N"], axes
        assert file["stiffness_secant_N_per_m"].attrs["units"].decode() == "N/m"
        assert [d.label for d in file["stiffness_secant_N_per_m"].dims] == ["ring_angle_deg", "mesh_phase", "load_N"]
        assert file.attrs["mesh"].decode() == "ring_planet"
    return count


def modelica_matrices(path):
    """As the Modelica Standard Library's reader does: '#1', comments, then 'double name(rows, columns)' and numbers."""
    with open(path) as file:
        text = file.read()
    assert text.startswith("#1\n")
    text = re.sub(r"#.*", "", text)
    matrices = {}
    for match in re.finditer(r"double\s+(\w+)\s*\(\s*(\d+)\s*,\s*(\d+)\s*\)([^a-z]*(?:[0-9.e+\- \n]|e)*)", text):
        rows, columns = int(match[2]), int(match[3])
        numbers = [float(x) for x in match[4].split()]
        assert len(numbers) == rows * columns, match[1]
        matrices[match[1]] = numpy.array(numbers).reshape(rows, columns)
    return matrices


def check_modelica(table, path):
    matrices, count = modelica_matrices(path), 0
    for q in QUANTITIES:
        m = matrices[q]
        count += same(m[0, 1:], table.loads, 15, q) + same(m[1:, 0], table.cycles, 15, q)
        count += same(m[1:, 1:], table.over_cycles(q), 15, q)
        assert (numpy.diff(m[1:, 0]) > 0).all(), "CombiTable needs a rising first column"
    for i in range(len(table.loads)):
        m = matrices[f"curves_{i + 1}"]
        for column, q in enumerate(QUANTITIES):
            count += same(m[:, column + 1], table.over_cycles(q)[:, i], 15, f"curves_{i + 1}")
        assert (m[0, 1:] == m[-1, 1:]).all(), "Extrapolation.Periodic needs a closed curve"
    return count


def check_adams(table, path):
    with open(path) as file:
        lines = [line.rstrip("\n") for line in file if not line.startswith("!")]
    assert max(map(len, lines)) <= 80
    # A statement goes on in lines that start with a comma.
    text = "".join(line if line.startswith(",") else "\n" + line for line in lines)
    count = 0
    statements = [line for line in text.split("\n") if line]
    assert len(statements) == len(QUANTITIES)
    for id, (statement, q) in enumerate(zip(statements, QUANTITIES), 1):
        head, *words = statement.split(",")
        assert head.strip() == f"SPLINE/{id}"
        groups = []
        for word in (w.strip() for w in words):
            if "=" in word:
                name, word = word.split("=")
                groups.append((name, []))
            groups[-1][1].append(float(word))
        assert [name for name, _ in groups] == ["X"] + ["Y"] * len(table.loads)
        count += same(groups[0][1], table.cycles, 11, "X")
        assert len(groups[0][1]) >= 4
        for i, (_, numbers) in enumerate(groups[1:]):
            if len(table.loads) > 1:
                count += same(numbers.pop(0), table.loads[i], 11, "z")
            count += same(numbers, table.over_cycles(q)[:, i], 11, q)
    return count


def check_simpack(table, path):
    with open(path) as file:
        lines = [line.split("!")[0].strip() for line in file]
    blocks, stack = {}, []
    for line in filter(None, lines):
        if line.endswith(".begin"):
            stack.append(line[: -len(".begin")])
        elif line.endswith(".end"):
            assert stack.pop() == line[: -len(".end")]
        elif "=" not in line:
            blocks.setdefault(stack[-1], []).append([float(x) for x in line.split()])
    assert not stack
    count = same(list(itertools.chain(*blocks["x"])), table.cycles, 15, "x")
    count += same(list(itertools.chain(*blocks["y"])), table.loads, 15, "y")
    for k, q in enumerate(QUANTITIES, 1):
        count += same(blocks[f"z({k})"], table.over_cycles(q), 15, q)
    return count


def check_plain(source, path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    expected = native(source)
    assert rows == expected
    return len(rows) * len(rows[0])


def check_matrix(source, folder):
    rows = native(source)
    compliance = numpy.array([[float(v) for k, v in row.items() if k != "tooth"] for row in rows])
    with h5py.File(f"{folder}/ring.h5", "r") as file:
        count = same(file["compliance_m_per_N"], compliance, 14, "compliance")
        product = file["stiffness_N_per_m"][:] @ compliance
    with open(f"{folder}/ring.csv") as file:
        stiffness = numpy.array([[float(v) for v in row[1:]] for row in list(csv.reader(file))[1:]])
    for p in (product, stiffness @ compliance):
        assert numpy.abs(p - numpy.eye(len(rows))).max() < 1e-9
    return count + 2 * product.size


def check_rexs(path, wanted):
    """Every attribute of the file as TYPE.ATTRIBUTE[ UNIT], of the first component of that type that has it."""
    model = xml.etree.ElementTree.parse(path).getroot()
    assert model.tag == "model" and model.get("version") == "1.4" and model.get("applicationId") and model.get("date")
    components = {c.get("id"): c for c in model.find("components")}
    relations = model.find("relations")
    assert len({r.get("id") for r in relations}) == len(relations)
    for relation in relations:
        for ref in relation:
            assert components[ref.get("id")].get("type") == ref.get("hint")
    found = {}
    for c in components.values():
        for a in c:
            name = f"{c.get('type')}.{a.get('id')}"
            found.setdefault(name, (a.text, a.get("unit")))
    for text in wanted:
        key, value = text.split("=")
        name, _, unit = key.partition("@")
        assert found[name][1] == (unit.replace("_", " ") or None), f"{name} in {found[name][1]}"
        same(float(found[name][0]), float(value), 12, name)
    types = [c.get("type") for c in components.values()]
    return len(wanted), {t: types.count(t) for t in set(types)}


def check_vtu(path):
    """A field: sizes, and von Mises' stress of the tensor that stands beside it."""
    file = xml.etree.ElementTree.parse(path).getroot()
    assert file.get("compressor") == "vtkZLibDataCompressor"
    piece = file.find("UnstructuredGrid/Piece")
    points, cells = int(piece.get("NumberOfPoints")), int(piece.get("NumberOfCells"))
    kinds = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}

    def read(array):
        assert array.get("format") == "binary"
        text = array.text.strip()
        # 16 bytes of a header for one block make 24 digits: blocks, bytes of each, of a partial one, compressed bytes.
        blocks, size, partial, packed = numpy.frombuffer(base64.b64decode(text[:24], validate=True), dtype="<u4")
        data = base64.b64decode(text[24:], validate=True)
        assert blocks == 1 and partial == 0 and packed == len(data)
        raw = zlib.decompress(data)
        assert len(raw) == size
        return numpy.frombuffer(raw, dtype=kinds[array.get("type")])

    data = {a.get("Name"): read(a).reshape(points, -1).astype(float) for a in piece.find("PointData")}
    places = read(piece.find("Points/DataArray")).reshape(points, 3)
    assert numpy.isfinite(places).all() and 1e-3 < numpy.linalg.norm(places, axis=1).max() < 1
    connectivity, offsets, types = (read(piece.find(f"Cells/DataArray[@Name='{n}']")) for n in ("connectivity", "offsets", "types"))
    corners = {9: 4, 12: 8}[int(types[0])]  # quadrilaterals or hexahedra
    assert len(types) == cells and (types == types[0]).all()
    assert (offsets == corners * numpy.arange(1, cells + 1)).all()
    assert connectivity.size == corners * cells and connectivity.min() == 0 and connectivity.max() == points - 1
    assert len(read(piece.find("CellData/DataArray[@Name='region']"))) == cells
    xx, yy, zz, xy, yz, zx = data["stress_Pa"].T
    mises = numpy.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy**2 + yz**2 + zx**2))
    assert numpy.allclose(mises, data["von_mises_Pa"][:, 0], rtol=1e-5, atol=1e-5 * mises.max())
    largest = numpy.linalg.norm(data["displacement_m"], axis=1).max()
    assert 1e-7 < largest < 1e-3, largest
    return points


def main(kind, source, *rest):
    if kind == "vtu":
        print(check_vtu(source))
        return
    if kind == "rexs":
        count, types = check_rexs(source, rest)
        print(count, " ".join(f"{t}:{n}" for t, n in sorted(types.items())))
        return
    if kind == "matrix":
        print(check_matrix(source, rest[0]))
        return
    table, folder = Table(source), rest[0]
    count = check_plain(source, f"{folder}/table.csv") + check_hdf5(table, f"{folder}/table.h5")
    count += check_modelica(table, f"{folder}/table.txt") + check_adams(table, f"{folder}/table.adm")
    count += check_simpack(table, f"{folder}/table.afs")
    print(count)


main(*sys.argv[1:])
