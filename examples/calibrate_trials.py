# SPDX-License-Identifier: Apache-2.0
"""Tries navvy.calibrate on soils that are known; prints errors and how often intervals hold them.

    python3 examples/calibrate_trials.py --trials 20

The series are forces on the bucket of the scene bucket_path with cells of 0.2 m, with white noise.
The bucket cuts 0.13 m deep, then 0.35 m deep: cohesion resists in proportion to the depth, friction
to its square, so that two depths separate them. All trials repeat this motion, and each
uses the scenes that were simulated for those before it.
"""
import argparse
import time

import numpy as np

import navvy

OUTPUTS = ["bucket/bucket/force_x", "bucket/bucket/force_z"]
TIMES = np.arange(0.4, 4.0, 0.01)
WINDOWS = 8
# At -70 deg the cutting edge is 0.367 m below the hinge.
MOTION = {
    "times_s": (0, 0.4, 1.0, 2.0, 2.5, 4.0),
    "joint[slide_x].positions_m": (-1.6, -1.6, -1.4, -0.8, -0.6, 0.3),
    "joint[slide_z].positions_m": (0.6, 0.4, 0.24, 0.24, 0.02, 0.02),
    "joint[curl].positions_deg": (-70,) * 6,
}


def soil_of(scene, friction, cohesion):
    """Returns a copy of a scene with another soil."""
    out, soil = scene.copy(), scene.soil
    ratio = soil.residual_cohesion_pa / soil.cohesion_pa
    out.update(
        {
            "soil.friction_angle_deg": friction,
            "soil.cohesion_pa": cohesion,
            "soil.residual_cohesion_pa": ratio * cohesion,
        }
    )
    return out


def measure(scene):
    """Returns the forces of a scene at TIMES, shape (times, outputs)."""
    with navvy.Session(scene) as world:
        rows = []
        for at in TIMES:
            world.step(round(at / world.dt) - world.steps)
            rows.append(world.observe(outputs=OUTPUTS))
    return np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--noise", type=float, default=0.05, help="of a sample, of the largest one")
    parser.add_argument("--samples", type=int, default=32, help="scenes in the box of a round")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--html", help="page of the last trial")
    options = parser.parse_args()
    scene = navvy.Scene("bucket_path")
    scene.update({"machine.program.trajectory." + name: row for name, row in MOTION.items()})
    scene.update({"solver.cell_m": 0.2})
    random, errors, inside = np.random.default_rng(options.seed), [], []
    share = options.noise / np.sqrt(len(TIMES) / WINDOWS)
    known = None
    print("trial  phi [deg]: true  fitted (interval)    c [Pa]: true  fitted (interval)   misfit")
    for trial in range(options.trials):
        begun = time.perf_counter()
        truth = np.array([random.uniform(24, 38), random.uniform(1500, 8000)])
        rows = measure(soil_of(scene, *truth))
        rows += options.noise * np.abs(rows).max(axis=0) * random.standard_normal(rows.shape)
        found = navvy.calibrate(
            scene,
            TIMES,
            dict(zip(OUTPUTS, rows.T)),
            windows=WINDOWS,
            noise=share,
            samples=options.samples,
            rounds=options.rounds,
            earlier=known,
            html=options.html if trial + 1 == options.trials else None,
        )
        known = found.simulated
        inside.append((found.low <= truth) & (truth <= found.high))
        errors.append(np.abs(found.best - truth) / (1, truth[1]))
        phi, c = (
            (truth[i], found.best[i], found.low[i], found.high[i]) for i in range(len(truth))
        )
        text = "%5d  %15.1f %7.1f (%.1f to %.1f)  %13.0f %7.0f (%.0f to %.0f) %7.2f"
        text += "  %d runs, %.0f s"
        took = time.perf_counter() - begun
        print(text % (trial, *phi, *c, found.misfit, found.runs, took), flush=True)
    text = "%s: error median %.2g, largest %.2g %s; %d of %d intervals hold the truth"
    for name, unit, column, scale in (("phi", "deg", 0, 1), ("c", "%", 1, 100)):
        one = scale * np.array(errors)[:, column]
        held = np.array(inside)[:, column].sum()
        print(text % (name, np.median(one), one.max(), unit, held, options.trials))
    good = (np.array(errors) <= (2, 0.15)).sum(axis=0)
    print("phi within 2 deg in %d trials, c within 15 %% in %d" % tuple(good))


if __name__ == "__main__":
    main()
