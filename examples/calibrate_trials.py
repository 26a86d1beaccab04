# SPDX-License-Identifier: Apache-2.0
"""Tries navvy.calibrate on soils that are known; prints errors and how often intervals hold them.

    python3 examples/calibrate_trials.py [trials] [noise of a sample, share of the largest] [seed]

The series are forces on the bucket of the scene bucket_path with cells of 0.2 m, with white noise.
Simulations of the first round are the same in all trials and are made once.
"""
import sys
import time
from unittest import mock

import numpy as np

import navvy
from navvy import _calibrate

OUTPUTS = ["bucket/bucket/force_x", "bucket/bucket/force_z"]
TIMES = np.arange(0.5, 4.0, 0.05)
NAMES = list(_calibrate.SOIL)


def main(trials=20, noise=0.05, seed=3):
    scene = navvy.Scene("bucket_path")
    scene.update({"solver.cell_m": 0.2})
    simulate, known = _calibrate.simulate, {}

    def once(changed, outputs, times):
        key = changed.soil[0].cohesion_pa, changed.soil[0].friction_angle_deg
        if key not in known:
            known[key] = simulate(changed, outputs, times)
        return known[key]

    random, errors, inside = np.random.default_rng(seed), [], []
    print("trial  phi [deg]: true  fitted (interval)    c [Pa]: true  fitted (interval)   misfit")
    for trial in range(trials):
        begun = time.perf_counter()
        truth = np.array([random.uniform(24, 38), random.uniform(1500, 8000)])
        measured = scene.copy()
        measured.update(_calibrate.settings_of(scene, NAMES, truth))
        rows = simulate(measured, OUTPUTS, TIMES)
        largest = np.abs(rows).max(axis=0)
        rows = rows + noise * largest * random.standard_normal(rows.shape)
        share = noise / np.sqrt(len(TIMES) / 8)
        with mock.patch.object(_calibrate, "simulate", once):
            series = dict(zip(OUTPUTS, rows.T))
            found = navvy.calibrate(scene, TIMES, series, noise=share, workers=1)
        inside.append((found.low <= truth) & (truth <= found.high))
        errors.append(np.abs(found.best - truth) / (1, truth[1]))
        text = "%5d  %15.1f %7.1f (%.1f to %.1f)  %13.0f %7.0f (%.0f to %.0f) %7.2f  %.0f s"
        phi, c = (
            (truth[i], found.best[i], found.low[i], found.high[i]) for i in range(len(truth))
        )
        print(text % (trial, *phi, *c, found.misfit, time.perf_counter() - begun), flush=True)
    errors, inside = np.array(errors), np.sum(inside, axis=0)
    print("phi: largest error %.2f deg, held %d of %d" % (errors[:, 0].max(), inside[0], trials))
    print("c: largest error %.0f %%, held %d of %d" % (100 * errors[:, 1].max(), inside[1], trials))


if __name__ == "__main__":
    main(*(kind(word) for kind, word in zip((int, float, int), sys.argv[1:])))
