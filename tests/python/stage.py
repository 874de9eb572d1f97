"""The quick scene of the tests of the application without errors and backlash, whose runs take tenths of a second."""

from pathlib import Path

_changes = {
    "[sun]\n": "[sun]\nbore_diameter_mm = 130\n",
    "[planet]\n": "[planet]\nbore_diameter_mm = 172\n",
    "[errors]\n": "",
    "planet_eccentricity_um = [15, 36, 17, 38, 19]\n": "",
    "planet_eccentricity_phase_deg = [0, 0, 0, 0, 0]\n": "",
    "half_backlash_um = 50": "half_backlash_um = 0",
    "mesh_cycles = 110\n": "",
}


def write(folder):
    """The file of the stage in a folder."""
    text = (Path(__file__).parents[1] / "app/quick_scene.toml").read_text()
    for old, new in _changes.items():
        if old not in text:
            raise ValueError(f"the quick scene has no {old!r}")
        text = text.replace(old, new)
    file = Path(folder) / "small.toml"
    file.write_text("# A comment.\n" + text)
    return file
