"""The lumped system of a scene: its matrices, and its equations of motion for other solvers."""

import os

import numpy
import pandas

from . import _lumped
from .scene import Scene


def _square(name, meaning):
    """A matrix over the coordinates, as a data frame."""
    return property(lambda self: pandas.DataFrame(getattr(self._linear, name), self.dofs, self.dofs), doc=meaning)


class Lumped:
    """M q'' + (C + G) q' + (K + K_rotation) q = load, at the operating point, with mean mesh stiffnesses.

    Coordinates are lengths in metres; rotations and tilts are multiplied by the base radius (for a carrier by the centre
    distance). Those of a stage turn with its carrier. Matrices are data frames with the names of the coordinates, in SI units: mass kg,
    damping N s/m, stiffness N/m. `rhs`, `jacobian` and `mesh_forces` are those of the whole system, with tables,
    backlash and errors, at a time in s and a state (q, q').
    """

    def __init__(self, system):
        self._system = system
        self._linear = system.linear()
        #: Names of the coordinates.
        self.dofs = list(self._linear.dofs)
        #: Names of the meshes, shafts and bearings.
        self.meshes = list(self._linear.meshes)
        #: Mesh cycles per second.
        self.mesh_frequency_Hz = system.mesh_frequency_Hz
        #: Time after which the excitation repeats, s.
        self.period_s = system.period_in_cycles / system.mesh_frequency_Hz

    M = _square("mass", "Mass, kg.")
    C = _square("damping", "Damping with that of the meshes, N s/m.")
    G = _square("gyroscopic", "Gyroscopic matrix, skew, N s/m.")
    K = _square("stiffness", "Stiffness with the mean tangents of the meshes, N/m.")
    K_rotation = _square("rotating_stiffness", "Centripetal and circulatory terms, N/m.")

    @property
    def B(self):
        """Mesh vectors: approach of the flanks along the line of action = B' q, one column per mesh. A column of the tilt
        of a mesh is what its flanks approach further at the end of the face."""
        return pandas.DataFrame(self._linear.mesh_vectors, self.dofs, self.meshes)

    @property
    def mesh_stiffness(self):
        """Force of each mesh per deflection of each, N/m. Meshes on one elastic body act on each other."""
        return pandas.DataFrame(self._linear.mesh_stiffness, self.meshes, self.meshes)

    @property
    def mesh_damping(self):
        """Dampers of the meshes, N s/m."""
        return pandas.Series(self._linear.mesh_damping, self.meshes)

    @property
    def load(self):
        """Load at time 0, N."""
        return pandas.Series(self._linear.load, self.dofs)

    def state_space(self):
        """A and B of (q, q')' = A (q, q') + B u, where u are forces on the coordinates in N."""
        mass = self._linear.mass
        n = len(self.dofs)
        stiffness = self._linear.stiffness + self._linear.rotating_stiffness
        damping = self._linear.damping + self._linear.gyroscopic
        a = numpy.zeros((2 * n, 2 * n))
        a[:n, n:] = numpy.eye(n)
        a[n:, :n] = -numpy.linalg.solve(mass, stiffness)
        a[n:, n:] = -numpy.linalg.solve(mass, damping)
        b = numpy.vstack([numpy.zeros((n, n)), numpy.linalg.inv(mass)])
        names = self.dofs + [name + "'" for name in self.dofs]
        return pandas.DataFrame(a, names, names), pandas.DataFrame(b, names, self.dofs)

    def rhs(self, time, state):
        """(q', q'') of a state (q, q'): what scipy.integrate.solve_ivp takes."""
        return self._system.rhs(time, numpy.asarray(state, float))

    def jacobian(self, time, state):
        """d rhs / d state."""
        return self._system.jacobian(time, numpy.asarray(state, float))

    def mesh_forces(self, time, state):
        """Forces of the meshes, N: positive where the flanks press on each other."""
        return pandas.Series(self._system.mesh_forces(time, numpy.asarray(state, float)), self.meshes)

    def __repr__(self):
        return f"<annulus lumped system: {len(self.dofs)} coordinates, {len(self.meshes)} meshes>"


def lumped(scene, variant="", *, threads=None):
    """The lumped system of a scene (of one of its rings, `variant`), on its stiffness tables, which are solved or cached."""
    if not isinstance(scene, Scene):
        scene = Scene.load(scene)
    settings = scene.settings()[1::2]
    return Lumped(_lumped.solve(str(scene.file), settings, variant, threads or os.cpu_count() or 1))
