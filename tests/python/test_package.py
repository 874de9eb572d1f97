"""The Python package: scenes, runs, tables, studies and searches, against what the program itself writes."""

import json
import math
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import annulus
import numpy
import stage
from annulus import _program


class WithStage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = stage.write(folder.name)
        self.scene = annulus.Scene.load(self.file)


class Scenes(WithStage):
    def test_changes_leave_the_scene_as_it_was(self):
        other = self.scene.set({"supports.sun_N_per_m": 2e7, "accuracy": 0.02}).set("ring.outside_diameter_mm", 670)
        self.assertEqual(self.scene.changes, {})
        self.assertEqual(len(other.changes), 3)
        self.assertEqual(self.scene.tables()["supports"]["sun_N_per_m"], 1e7)
        tables = other.tables()
        self.assertEqual(tables["supports"]["sun_N_per_m"], 2e7)
        self.assertEqual(tables["accuracy"], 0.02)
        self.assertEqual(tables["ring"][0]["outside_diameter_mm"], 670)

    def test_what_is_set_last_holds(self):
        scene = self.scene.set("ring.held.mass_kg", 8).set("ring.mass_kg", 12).set("ring.held.mass_kg", 9)
        self.assertEqual(scene.tables()["ring"][0]["mass_kg"], 9)

    def test_values_of_all_types_reach_the_program(self):
        other = self.scene.set(
            {
                "title": 'With "quotes" and µ',
                "errors.planet_eccentricity_um": [1, 2.5, 3, 4, 5],
                "supports.sun_N_per_m": "floating",
                "stage.planets": numpy.int64(5),
                "stage.module_mm": numpy.float64(3.8),
            }
        )
        tables = other.tables()
        self.assertEqual(tables["title"], 'With "quotes" and µ')
        self.assertEqual(tables["errors"]["planet_eccentricity_um"], [1, 2.5, 3, 4, 5])
        self.assertEqual(tables["supports"]["sun_N_per_m"], "floating")
        self.assertRaises(TypeError, self.scene.set, "accuracy", object())
        one = other.set("errors.planet_eccentricity_um[4]", 0.5)
        self.assertEqual(one.tables()["errors"]["planet_eccentricity_um"], [1, 2.5, 3, 0.5, 5])

    def test_a_saved_scene_is_the_same(self):
        copy = self.folder / "copy.toml"
        self.scene.save(copy)
        self.assertEqual(copy.read_text(), self.file.read_text())  # with its comments
        other = self.scene.set("mesh.sun_planet.ripple", 0.1)
        other.save(copy)
        self.assertEqual(annulus.Scene.load(copy).tables(), other.tables())
        figures = annulus.run(copy).figures
        self.assertTrue(figures.equals(annulus.run(other).figures))

    def test_scenes_to_start_from(self):
        self.assertEqual(annulus.Scene.new("helical_pair").tables()["stage"]["kind"], "helical_pair")
        shipped = annulus.Scene.new("ring_types")
        self.assertGreater(len(shipped.tables()["ring"]), 1)
        self.assertGreater(shipped.plan()["predicted_s"], 1)
        self.assertEqual(list(shipped.check().columns), ["key", "severity", "where", "text"])

    def test_messages_of_the_program_are_those_of_the_exceptions(self):
        self.assertRaisesRegex(annulus.InputError, "no_such.toml", annulus.Scene.load, "no_such.toml")
        self.assertRaisesRegex(annulus.InputError, "module_mm", self.scene.set("stage.module_mm", -1).check)
        self.assertRaisesRegex(annulus.InputError, "modul_mm.*module_mm", self.scene.set("stage.modul_mm", 1).check)
        self.assertRaisesRegex(annulus.InputError, "there is no such example", annulus.Scene.new, "no_such_scene")
        with self.assertRaises(annulus.Refused):
            annulus.run(self.scene, max_time="1ms")


class Runs(WithStage):
    def setUp(self):
        super().setUp()
        self.results = annulus.run(self.scene, out=self.folder / "out")

    def test_figures_are_those_of_the_summary(self):
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        figures = summary["variants"][0]["figures"]
        self.assertEqual(self.results.variants, ["held"])
        self.assertGreater(len(figures), 20)
        for key, expected in figures.items():
            if expected["value"] is not None:
                self.assertEqual(self.results.value(key), expected["value"])
                self.assertEqual(self.results.value(key, "held"), expected["value"])
            error = self.results.error(key)
            self.assertEqual(None if math.isnan(error) else error, expected["error"])
        row = self.results.figures.loc[("held", "sun_planet_mean_stiffness_N_per_m")]
        self.assertEqual(row["unit"], "kN/µm")
        self.assertAlmostEqual(row["value"], 1.364, places=12)
        self.assertAlmostEqual(row["value_SI"], 1.364e9, delta=1)
        parts = self.results.error_parts
        sums = parts.sum(axis=1, skipna=False).dropna()
        self.assertGreater(len(sums), 5)
        for (variant, key), total in sums.items():
            self.assertAlmostEqual(total, self.results.error(key, variant), delta=1e-9 * abs(total))
        self.assertRaisesRegex(KeyError, "no_such_result", self.results.value, "no_such_result")
        self.assertRaisesRegex(KeyError, "held", self.results.value, "sun_planet_dynamic_factor", "other")

    def test_tables_have_units(self):
        modes = self.results.table("held/dynamics/modes")
        self.assertEqual(modes.attrs["units"]["frequency_Hz"], "Hz")
        self.assertTrue((modes["frequency_Hz"].diff().dropna() >= 0).all())
        self.assertIn("annulus_version", modes.attrs)
        for name in self.results.tables:
            self.assertGreater(self.results.table(name).shape[1], 0, name)
        self.assertTrue(self.results.report.is_file())
        self.assertRaisesRegex(KeyError, "no_such", self.results.table, "no_such")

    def test_warnings_are_told(self):
        told = annulus.run(self.scene.set("dynamics.half_backlash_um", 50)).warnings
        self.assertIn("backlash_beyond_geometry", set(told["key"]))

    def test_names_of_rings_stay_texts(self):
        for name in ["NA", "12", "1.50"]:
            results = annulus.run(self.scene.set("ring.name", name))
            self.assertEqual(results.variants, [name])
            self.assertGreater(results.value("sun_planet_dynamic_factor", name), 1)

    def test_units_are_those_of_the_names(self):
        from annulus.results import unit_of

        self.assertEqual(unit_of("closing_1_per_sqrt_kg"), "")
        self.assertEqual(unit_of("acceleration_x_m_per_s2"), "m/s²")
        self.assertEqual(unit_of("tilt_Nm_per_rad"), "N m/rad")
        self.assertEqual(unit_of("index"), "")

    def test_results_of_a_folder(self):
        again = annulus.Results(self.folder / "out")
        self.assertTrue(again.figures.equals(self.results.figures))
        self.assertRaisesRegex(annulus.InputError, "run.json", annulus.Results, self.folder)

    def test_results_that_were_changed_are_refused(self):
        copy = self.folder / "changed"
        for name in ["figures.csv", "summary.json", "run.json", "held/dynamics/modes.csv"]:
            shutil.copytree(self.folder / "out", copy)
            file = copy / name
            text = file.read_text(encoding="utf-8")
            place = max(text.rfind(digit) for digit in "123456789")
            file.write_text(text[:place] + str((int(text[place]) + 1) % 10) + text[place + 1 :], encoding="utf-8")
            with self.assertRaisesRegex(annulus.InputError, name):
                annulus.Results(copy).table("held/dynamics/modes")
            shutil.rmtree(copy)


class Stiffness(WithStage):
    def test_arrays_are_those_of_the_table(self):
        scene = self.scene.set({"accuracy": 0.05, "model": "closed_form"})
        file = self.folder / "computed.toml"
        text = scene.text()
        for mesh in ["sun_planet", "ring_planet"]:  # computed instead of prescribed
            start = text.index(f"[mesh.{mesh}]") if f"[mesh.{mesh}]" in text else -1
            self.assertGreaterEqual(start, 0)
            end = text.find("\n[", start)
            text = text[:start] + text[end + 1 if end >= 0 else len(text) :]
        file.write_text(text)
        results = annulus.run(file)
        table = results.table("held/stiffness_ring_planet")
        arrays = results.stiffness("ring_planet")
        self.assertEqual(set(arrays.dims), {"ring_angle_deg", "mesh_phase", "load_N"})
        self.assertEqual(arrays["stiffness_secant_N_per_m"].attrs["units"], "N/m")
        self.assertEqual(arrays["lte_m"].size, len(table))
        self.assertFalse(bool(arrays["lte_m"].isnull().any()))
        phases, loads = arrays.sizes["mesh_phase"], arrays.sizes["load_N"]
        for row in range(len(table)):  # positions, phases and loads follow each other in the table
            at = {"ring_angle_deg": row // (phases * loads), "mesh_phase": row // loads % phases, "load_N": row % loads}
            found = arrays.isel(at)
            self.assertEqual(float(found["lte_m"]), table["lte_m"][row])
            self.assertEqual(float(found["load_N"]), table["load_N"][row])
        self.assertEqual(results.stiffness("sun_planet").attrs["mesh"], "sun_planet")
        self.assertRaisesRegex(KeyError, "no_mesh", results.stiffness, "no_mesh")


class Studies(WithStage):
    def test_points_are_runs(self):
        inputs = {"supports.sun_N_per_m": [1e7, 3e7], "mesh.sun_planet.ripple": [0.1, 0.2]}
        table = annulus.study(self.scene, inputs, figures=["sun_planet_dynamic_factor"], workers=2)
        self.assertEqual(table.index.names, ["variant", *inputs])
        self.assertEqual(len(table), 4)
        alone = annulus.run(self.scene.set({"supports.sun_N_per_m": 3e7, "mesh.sun_planet.ripple": 0.1}))
        row = table.loc[("held", 3e7, 0.1)]
        self.assertEqual(row["sun_planet_dynamic_factor"], alone.value("sun_planet_dynamic_factor"))
        self.assertEqual(row["sun_planet_dynamic_factor_error"], alone.error("sun_planet_dynamic_factor"))

    def test_a_refused_point_has_its_message(self):
        table = annulus.study(self.scene, {"stage.module_mm": [3.8, -1]}, figures=["sun_planet_dynamic_factor"])
        self.assertEqual(table["failure"].iloc[0], "")
        self.assertIn("module_mm", table["failure"].iloc[1])

    def test_lists_and_missing_results(self):
        errors = "errors.planet_eccentricity_um"
        table = annulus.study(self.scene, {errors: [[0] * 5, [10] * 5]}, figures=["sun_planet_dynamic_factor"])
        self.assertEqual(table.index.get_level_values(errors)[1], (10,) * 5)
        self.assertRaisesRegex(
            KeyError, "no_such", annulus.study, self.scene, {"accuracy": [0.01]}, figures=["no_such"]
        )
        self.assertRaisesRegex(ValueError, "one value", annulus.study, self.scene, {"accuracy": []})
        self.assertRaisesRegex(TypeError, "out", annulus.study, self.scene, {"accuracy": [0.01]}, out="x")

    def test_whole_numbers_and_objectives_without_a_value(self):
        search = annulus.Search(self.scene, {"stage.planets": (3, 5)}, "sun_planet_dynamic_factor")
        self.assertEqual(search([4.6]), annulus.run(self.scene).value("sun_planet_dynamic_factor"))
        nothing = annulus.Search(self.scene, {"accuracy": (0.01, 0.1)}, lambda results: math.nan, failed=7.0)
        self.assertEqual(nothing([0.02]), 7.0)
        self.assertIn("nan", nothing.history["failure"].iloc[0])

    def test_searches_ask_and_tell(self):
        search = annulus.Search(
            self.scene, {"supports.sun_N_per_m": (1e6, 1e8)}, "sun_planet_dynamic_factor", goal="largest"
        )

        class Grid:
            """Asks for three points at once."""

            told = []

            def ask(self):
                return [[1e6], [1e7], [1e8]]

            def tell(self, points, values):
                self.told += zip(points, values, strict=True)

        optimiser = Grid()
        best = search.drive(optimiser, 3)
        self.assertEqual(len(search.history), 3)
        self.assertEqual(len(optimiser.told), 3)
        factors = search.history["objective"]
        self.assertEqual(best["objective"], factors.max())
        self.assertEqual([value for _, value in optimiser.told], list(-factors))
        direct = annulus.run(self.scene.set("supports.sun_N_per_m", 1e8)).value("sun_planet_dynamic_factor")
        self.assertEqual(factors.iloc[2], direct)
        refused = annulus.Search(self.scene, {"stage.module_mm": (-2, 4)}, "sun_planet_dynamic_factor", failed=9.0)
        self.assertEqual(refused([-1]), 9.0)
        self.assertIn("module_mm", refused.history["failure"].iloc[0])
        self.assertRaisesRegex(ValueError, "none of 1 points", lambda: refused.best)
        self.assertRaisesRegex(ValueError, "do not rise", annulus.Search, self.scene, {"accuracy": (1, 0)}, "x")


class Lumped(WithStage):
    def setUp(self):
        super().setUp()
        self.system = annulus.lumped(self.scene)

    def test_matrices_have_the_natural_frequencies_of_the_run(self):
        system = self.system
        for matrix in [system.M, system.C, system.K]:
            self.assertTrue(numpy.allclose(matrix, matrix.T, rtol=1e-12, atol=1e-12 * numpy.abs(matrix).max().max()))
        self.assertTrue(numpy.allclose(system.G, -system.G.T))
        squares = numpy.linalg.eigvals(numpy.linalg.solve(system.M, system.K)).real
        found = numpy.sqrt(numpy.sort(numpy.abs(squares))) / (2 * math.pi)
        modes = annulus.run(self.scene).table("held/dynamics/modes")["frequency_Hz"]
        self.assertEqual(len(found), len(modes))
        # Six digits of the table; the free rotation is zero to rounding.
        self.assertTrue(numpy.allclose(found, modes, rtol=1e-5, atol=1e-3 * modes.max()))
        self.assertTrue(numpy.allclose(found[1:], modes[1:], rtol=1e-5))

    def test_stiffness_is_that_of_its_parts(self):
        system = self.system
        expected = system.B @ system.mesh_stiffness @ system.B.T
        rest = system.K - expected  # the supports: on the sun and on the planets' bearings
        self.assertLess(abs(rest.loc["sun_u", "sun_u"]), 1e-6 * system.K.loc["sun_u", "sun_u"])
        self.assertAlmostEqual(rest.loc["sun_x", "sun_x"] / 1e7, 1, places=6)

    def test_state_space_has_the_damped_vibrations(self):
        a, b = self.system.state_space()
        n = len(self.system.dofs)
        self.assertEqual(a.shape, (2 * n, 2 * n))
        self.assertEqual(b.shape, (2 * n, n))
        self.assertLess(numpy.linalg.eigvals(a).real.max(), 1e-3 * numpy.abs(numpy.linalg.eigvals(a)).max())
        # The equations of motion about the state without load: their slope at a mean stiffness is A.
        rate = self.system.rhs(0.0, numpy.zeros(2 * n))
        self.assertEqual(rate.shape, (2 * n,))
        slope = self.system.jacobian(0.0, numpy.zeros(2 * n))
        self.assertTrue(numpy.allclose(slope[:n], a.to_numpy()[:n]))

    def test_wrong_inputs_are_named(self):
        self.assertRaisesRegex(annulus.InputError, "entries", self._short_state)
        self.assertRaisesRegex(annulus.InputError, "other.*held", annulus.lumped, self.scene, "other")
        self.assertRaisesRegex(annulus.InputError, "module_mm", annulus.lumped, self.scene.set("stage.module_mm", -1))

    def _short_state(self):
        return self.system.rhs(0.0, [0.0])


class Program(unittest.TestCase):
    def test_a_missing_program_is_no_refusal_of_a_point(self):
        import os
        from unittest import mock

        with mock.patch.dict(os.environ, {"ANNULUS": "/no/such/program"}):
            with self.assertRaisesRegex(annulus.AnnulusError, "/no/such/program"):
                annulus.version()

    def test_the_package_speaks_of_its_program(self):
        version = subprocess.run([_program.program(), "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(annulus.version(), version.split()[-1])
        self.assertIn("N/m", annulus.explain("supports.sun_N_per_m"))


if __name__ == "__main__":
    unittest.main()
