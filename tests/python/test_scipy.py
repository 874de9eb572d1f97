"""The equations of motion in SciPy's integrator, against the steady state that the program finds; exported matrices in
SciPy's and h5py's readers; the plots."""

import tempfile
import unittest
from pathlib import Path

import annulus
import h5py
import matplotlib
import numpy
import scipy.integrate
import scipy.io
import scipy.linalg
import stage
from annulus import _program

matplotlib.use("Agg")


class Motion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scene = annulus.Scene.load(stage.write(folder.name))
        self.folder = Path(folder.name)

    def test_scipy_reaches_the_steady_state_of_the_program(self):
        system = annulus.lumped(self.scene)
        n = len(system.dofs)
        # Static deflection at the mean stiffness; the free rotation stays where it is.
        start = numpy.concatenate([scipy.linalg.lstsq(system.K, system.load)[0], numpy.zeros(n)])
        cycle = 1 / system.mesh_frequency_Hz
        cycles = 120  # the slowest vibration, of the sun on its support, has died out to 1e-5
        times = (cycles + numpy.arange(64) / 64) * cycle
        solution = scipy.integrate.solve_ivp(
            system.rhs, (0, times[-1]), start, method="DOP853", rtol=1e-8, atol=1e-13, t_eval=times
        )
        self.assertTrue(solution.success)
        forces = numpy.array([system.mesh_forces(t, y) for t, y in zip(times, solution.y.T, strict=True)])
        results = annulus.run(self.scene)
        series = results.table("held/dynamics/time_series")
        columns = [name for name in series.columns if name.endswith("_force_N")]
        self.assertEqual(len(columns), forces.shape[1])
        found = series[columns].to_numpy()[:64]
        # Without errors the motion has the period of a mesh cycle, and the series begins at one.
        self.assertAlmostEqual((series["time_s"].iloc[0] / cycle) % 1, 0, places=6)
        largest = numpy.abs(found - forces).max() / forces.mean()
        error = max(
            results.error(f"{mesh}_planet_dynamic_factor") / results.value(f"{mesh}_planet_dynamic_factor")
            for mesh in ["sun", "ring"]
        )
        # What is stated, the vibration that has not died out, and six digits of the table.
        self.assertLess(largest, error + 2e-4)
        self.assertGreater(numpy.ptp(forces, axis=0).max() / forces.mean(), 0.05)  # it vibrates at all

    def test_jacobian_is_the_derivative(self):
        system = annulus.lumped(self.scene)
        n = len(system.dofs)
        state = numpy.concatenate([scipy.linalg.lstsq(system.K, system.load)[0], numpy.zeros(n)])
        jacobian = system.jacobian(0.001, state)
        step = 1e-9
        for i in [0, n // 2, n, 2 * n - 1]:
            moved = numpy.array(state)
            moved[i] += step
            slope = (system.rhs(0.001, moved) - system.rhs(0.001, state)) / step
            size = numpy.abs(jacobian).max()
            self.assertLess(numpy.abs(slope - jacobian[:, i]).max(), 1e-5 * size)

    def test_systems_of_every_kind(self):
        scenes = ["helical_pair", "helical_pair_in_bearings", "arc_tooth_2kv", "grc_750kw/in_space"]
        for name in scenes:
            scene = annulus.Scene.new(name).set({"model": "closed_form", "accuracy": 0.1})
            try:
                scene.check()
            except annulus.InputError:
                scene = annulus.Scene.new(name).set("accuracy", 0.1)
            system = annulus.lumped(scene)
            n = len(system.dofs)
            self.assertGreater(n, 4, name)
            mass = system.M.to_numpy()
            self.assertTrue(numpy.allclose(mass, mass.T), name)
            self.assertGreater(numpy.linalg.eigvalsh(mass).min(), 0, name)
            rate = system.rhs(0.0, numpy.zeros(2 * n))
            self.assertTrue(numpy.isfinite(rate).all(), name)
            file = self.folder / (name.replace("/", "_") + ".toml")
            scene.save(file)
            _program.call("export", file, "--to", "hdf5")
            with h5py.File(file.with_suffix(".h5")) as hdf5:
                frame = hdf5.attrs["frame"].decode()
                for suffix in {dof.rsplit("_", 1)[1] for dof in hdf5.attrs["coordinates"].decode().split()}:
                    self.assertIn(suffix, frame.replace(",", " ").replace(";", " ").split(), name)

    def test_exported_matrices_are_those_of_the_system(self):
        system = annulus.lumped(self.scene)
        file = self.folder / "scene.toml"
        self.scene.save(file)
        expected = {
            "M_kg": system.M,
            "C_N_s_per_m": system.C,
            "G_N_s_per_m": system.G,
            "K_N_per_m": system.K,
            "K_rotation_N_per_m": system.K_rotation,
            "B": system.B,
            "K_mesh_N_per_m": system.mesh_stiffness,
            "load_N": system.load,
        }
        for format in ["matlab", "hdf5", "mtx"]:
            _program.call("export", file, "--to", format)
        matlab = scipy.io.loadmat(self.folder / "scene.mat")
        with h5py.File(self.folder / "scene.h5") as hdf5:
            for name, matrix in expected.items():
                market = scipy.io.mmread(self.folder / f"scene_{name}.mtx")
                for found in [market, matlab[name], hdf5[name][()]]:
                    self.assertTrue(numpy.array_equal(numpy.squeeze(found), matrix.to_numpy()), name)
            self.assertEqual(hdf5["K_N_per_m"].attrs["units"].decode(), "N/m")
            self.assertEqual(hdf5["C_N_s_per_m"].attrs["units"].decode(), "N s/m")
            self.assertEqual(hdf5.attrs["coordinates"].decode().split(), system.dofs)
            self.assertIn("carrier", hdf5.attrs["frame"].decode())
            again = self.folder / "again.toml"
            again.write_text(hdf5["scene"][()].decode())
        self.assertTrue(annulus.lumped(annulus.Scene.load(again)).K.equals(system.K))
        self.assertEqual(str(matlab["provenance"]["meshes"][0, 0][0]).split(), system.meshes)
        self.assertIn("% coordinates: sun_x", (self.folder / "scene_M_kg.mtx").read_text())
        rings = annulus.Scene.new("ring_types")
        self.assertRaisesRegex(annulus.InputError, "traditional", _program.call, "export", rings.file, "--to", "mtx")

    def test_plots(self):
        from annulus import plots

        results = annulus.run(self.scene)
        axes = plots.plot_figure(results, "sun_planet_dynamic_factor")
        self.assertIn("Dynamic factor", axes.get_ylabel())
        table = annulus.study(
            self.scene, {"supports.sun_N_per_m": [1e7, 3e7]}, figures=["sun_planet_dynamic_factor"]
        )
        axes = plots.plot_study(table, "sun_planet_dynamic_factor")
        self.assertEqual(len(axes.lines[0].get_xdata()), 2)
        self.assertRaisesRegex(ValueError, "one varied input", plots.plot_study, table.iloc[:1], "x")


if __name__ == "__main__":
    unittest.main()
