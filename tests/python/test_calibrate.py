# SPDX-License-Identifier: Apache-2.0
"""Calibration: the fit, its intervals and its page."""
import html.parser
import pathlib
import tempfile
import unittest
from unittest import mock

import numpy as np

import navvy
from navvy import _calibrate

SCENE = "bucket_path"
TIMES = np.arange(0.1, 4.05, 0.1)
NAMES = list(_calibrate.SOIL)


def theory(scene, outputs, times):
    """Forces as a wedge of soil gives them, which grow and shrink along a dig, in place of a run of
    the scene; with the scatter of a few percent that simulated windows have.
    """
    friction, cohesion = scene.soil.friction_angle_deg, scene.soil.cohesion_pa
    passive = np.tan(np.radians(45 + friction / 2)) ** 2
    random = np.random.default_rng(int(1e6 * friction) + int(cohesion))
    depth = 0.3 * np.sin(np.pi * times / times[-1])
    force = 0.8 * (8000 * depth**2 * passive + 2 * cohesion * depth * np.sqrt(passive))
    rows = np.stack([-force, force * np.tan(np.radians(20 + 20 * depth))], axis=1)
    return rows * random.normal(1, 0.02, rows.shape)


class Fit(unittest.TestCase):
    def fit(self, friction, cohesion, seed, **options):
        scene = navvy.Scene(SCENE)
        scene.update(_calibrate.settings_of(scene, NAMES, (friction, cohesion)))
        outputs = ["bucket/bucket/force_x", "bucket/bucket/force_z"]
        rows = theory(scene, outputs, TIMES)
        rows *= np.random.default_rng(seed).normal(1, 0.03, rows.shape)
        with mock.patch.object(_calibrate, "simulate", theory):
            return navvy.calibrate(
                navvy.Scene(SCENE),
                TIMES,
                dict(zip(outputs, rows.T)),
                noise=0.015,
                workers=1,
                **options
            )

    def test_holds_the_truth_in_nearly_all_intervals(self):
        random, inside, errors = np.random.default_rng(4), [], []
        for trial in range(20):
            truth = np.array([random.uniform(24, 38), random.uniform(1500, 8000)])
            found = self.fit(*truth, seed=trial)
            inside += [(found.low <= truth) & (truth <= found.high)]
            errors += [np.abs(found.best - truth) / (1, truth[1])]
        # 95 % intervals miss one in twenty on average; wanted are at most two of twenty.
        self.assertTrue((np.sum(inside, axis=0) >= 18).all(), np.sum(inside, axis=0))
        self.assertLess(np.median(errors, axis=0)[0], 2)
        self.assertLess(np.median(errors, axis=0)[1], 0.15)

    def test_writes_a_page_that_needs_no_network(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "fit.html"
            found = self.fit(30, 6000, seed=1, html=page)
            text = page.read_text(encoding="utf-8")
        html.parser.HTMLParser().feed(text)
        self.assertNotRegex(text, "http|src=|href=")
        self.assertEqual(text.count("<svg"), 3)
        self.assertIn("%.4g" % found.best[0], text)
        self.assertIn("soil.cohesion_pa", str(found))

    def test_uses_scenes_of_an_earlier_fit_again(self):
        first = self.fit(30, 6000, seed=1)
        again = self.fit(30, 6000, seed=2, earlier=first.simulated)
        self.assertLess(again.runs, first.runs / 2)
        self.assertEqual(len(again.simulated.points), len(first.simulated.points) + again.runs - 1)
        self.assertTrue((again.low < (30, 6000)).all() and (again.high > (30, 6000)).all())
        box = {NAMES[0]: (20.0, 42.0)}
        with self.assertRaisesRegex(ValueError, "earlier"):
            self.fit(30, 6000, seed=2, earlier=first.simulated, parameters=box)

    def test_reports_a_truth_outside_the_searched_box(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "fit.html"
            box = {NAMES[0]: (34.0, 42.0), NAMES[1]: (500.0, 10000.0)}
            self.fit(28, 6000, seed=1, html=page, parameters=box)
            self.assertIn("widen it", page.read_text(encoding="utf-8"))

    def test_refuses_series_that_cannot_be_compared(self):
        good = np.zeros(len(TIMES))
        for times, values in ((TIMES[::-1], good), (TIMES, good[:-1]), (TIMES, good * np.nan)):
            with self.assertRaises(ValueError):
                navvy.calibrate(SCENE, times, {"bucket/bucket/force_x": values})
        with self.assertRaisesRegex(ValueError, "samples"):
            navvy.calibrate(SCENE, TIMES, {"bucket/bucket/force_x": good}, samples=5)
        box = {"soil.friction_angle_deg": (40.0, 40.0)}
        with self.assertRaisesRegex(ValueError, "lower value first"):
            navvy.calibrate(SCENE, TIMES, {"bucket/bucket/force_x": good}, parameters=box)


class Simulation(unittest.TestCase):
    def test_samples_the_scene_at_the_given_times(self):
        names = ["bucket/bucket/force_x", "bucket/slide_x/position"]
        scene = navvy.Scene(SCENE)
        scene.update({"solver.cell_m": 0.2})
        rows = _calibrate.simulate(scene, names, np.array([0.5, 1.0, 1.7]))
        self.assertEqual(rows.shape, (3, 2))
        self.assertLess(rows[2, 0], rows[0, 0])
        self.assertAlmostEqual(rows[2, 1], -1.0, delta=0.05)


if __name__ == "__main__":
    unittest.main()
