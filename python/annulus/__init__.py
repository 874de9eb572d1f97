"""Planetary gear sets with flexible rings: annulus for Python.

    import annulus

    scene = annulus.Scene.new("ring_types").set("accuracy", 0.03)
    results = annulus.run(scene)
    results.figures                              # every result: value, error, unit
    results.stiffness("ring_planet", "pinned")   # labelled arrays
    annulus.study(scene, {"supports.sun_N_per_m": [1e7, 1e8]})
    annulus.lumped(scene, "pinned").M            # matrices; .rhs for SciPy

Everything is computed by the program `annulus`: the one on the path, or $ANNULUS.
"""

from ._program import AnnulusError, InputError, LimitReached, Refused, example, explain, version
from .results import Results, read_stiffness, read_table, run
from .scene import Scene
from .studies import Search, study

__all__ = [
    "AnnulusError", "InputError", "LimitReached", "Refused", "Results", "Scene", "Search", "example", "explain",
    "lumped", "read_stiffness", "read_table", "run", "study", "version",
]  # fmt: skip


def lumped(scene, variant="", *, threads=None):
    """The lumped system of a scene, a `Lumped`: matrices, state space, equations of motion (annulus.systems.Lumped)."""
    from .systems import lumped as solve  # loads the libraries of the program

    return solve(scene, variant, threads=threads)
