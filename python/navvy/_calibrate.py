# SPDX-License-Identifier: Apache-2.0
"""Fits soil parameters of a scene to measured forces or pressures.

    found = navvy.calibrate("bucket_path", times, {"bucket/bucket/force_x": forces}, html="x.html")
    print(found)

The motion must be prescribed by the scene: its programs repeat what the machine did while it was
measured. Each round simulates a batch of scenes whose parameters spread over a box, and fits a
quadratic surface to the mean of each output in each time window. The scatter around that surface is
the uncertainty of a window. With it every point of the box gets a likelihood (multivariate t) of
having made the measurement; the intervals hold its stated share. The next round spreads over the
part of the box that is left.
"""
from __future__ import annotations

import concurrent.futures
import contextlib
import dataclasses
import multiprocessing
import os
from typing import Mapping, Sequence

import numpy as np

from ._page import write_page
from ._scene import Scene
from ._world import Session

#: Parameters that are fitted by default, with the box that is searched.
SOIL = {"soil.friction_angle_deg": (20.0, 42.0), "soil.cohesion_pa": (500.0, 10000.0)}


@dataclasses.dataclass
class Simulated:
    """Scenes that were simulated for a calibration."""

    scene: str  #: the scene and its changes
    names: list[str]  #: settings in which the scenes differ
    outputs: list[str]  #: outputs that were read
    times: np.ndarray  #: when [s]
    points: np.ndarray  #: values of `names`, shape (n, names)
    rows: np.ndarray  #: outputs of each scene, shape (n, times, outputs)

    def fits(self, other: "Simulated") -> bool:
        """Returns true if the scenes of both can be used together."""
        same = (self.scene, self.names, self.outputs) == (other.scene, other.names, other.outputs)
        return same and np.array_equal(self.times, other.times)

    def inside(self, box: np.ndarray) -> np.ndarray:
        """Returns true for each scene whose values are in a box."""
        return ((self.points >= box[:, 0]) & (self.points <= box[:, 1])).all(axis=1)

    def add(self, points: np.ndarray, rows: Sequence[np.ndarray]) -> None:
        """Adds scenes."""
        self.points = np.vstack([self.points, points])
        self.rows = np.concatenate([self.rows, np.reshape(rows, (-1,) + self.rows.shape[1:])])


@dataclasses.dataclass
class Calibration:
    """Result of `calibrate`."""

    names: list[str]  #: settings of the scene that were fitted; each ends in its unit
    best: np.ndarray  #: mean of the likelihood, one value per name
    low: np.ndarray  #: lower end of each interval
    high: np.ndarray  #: upper end
    level: float  #: share of the likelihood that an interval holds
    misfit: float  #: squared deviation of the best fit per free window; about 1 for a good fit
    runs: int  #: number of scenes simulated for it
    times: np.ndarray  #: time of each sample [s]
    measured: dict[str, np.ndarray]  #: measured series by output, in the unit of the output
    fitted: dict[str, np.ndarray]  #: the same outputs of the scene with the best values
    points: np.ndarray  #: parameters of the scenes inside the last box, shape (n, names)
    likely: np.ndarray  #: parameters drawn by their likelihood, shape (n, names)
    simulated: Simulated  #: all simulated scenes, for a later calibration of the same motion

    def __str__(self) -> str:
        rows = [
            "%s = %.4g (%d %%: %.4g to %.4g)" % (name, best, round(100 * self.level), low, high)
            for name, best, low, high in zip(self.names, self.best, self.low, self.high)
        ]
        return "\n".join(rows + ["misfit %.2g, %d runs" % (self.misfit, self.runs)])


def settings_of(scene: Scene, names: Sequence[str], values: Sequence[float]) -> dict[str, float]:
    """Returns the settings that give a scene these values. Cohesion of all soils takes that of
    remoulded soil with it, in the ratio of the first soil, as the schema wants it to be the smaller
    one; unless that is among the names, too.
    """
    out = {name: float(value) for name, value in zip(names, values)}
    if "soil.cohesion_pa" in out:
        soil = scene.soil[0]
        ratio = soil.residual_cohesion_pa / soil.cohesion_pa if soil.cohesion_pa > 0 else 0.0
        out.setdefault("soil.residual_cohesion_pa", ratio * out["soil.cohesion_pa"])
    return out


def simulate(scene: Scene, outputs: Sequence[str], times: np.ndarray) -> np.ndarray:
    """Returns the outputs of a scene at `times` [s], shape (times, outputs)."""
    with Session(scene) as world:
        keys = [world.output(name) for name in outputs]
        rows = np.empty((len(times), len(keys)))
        for row, time in zip(rows, times):
            world.step(max(0, round(time / world.dt) - world.steps))
            world.observe(row, keys)
    return rows


def _one_thread() -> None:
    """Keeps PoCL from starting as many threads in each process as there are processes."""
    os.environ.setdefault("POCL_MAX_PTHREAD_COUNT", "1")


@contextlib.contextmanager
def _pool(workers: int):
    """Provides a function that simulates a list of tasks. Processes share no driver, which threads
    of one process do.
    """
    if workers == 1:
        yield lambda tasks: [simulate(*task) for task in tasks]
        return
    # OpenCL does not survive a fork.
    spawn = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(workers, spawn, _one_thread) as pool:
        yield lambda tasks: [one.result() for one in [pool.submit(simulate, *t) for t in tasks]]


def _windows(rows: np.ndarray, count: int) -> np.ndarray:
    """Returns the mean of each output in `count` windows of equal length, as one vector."""
    return np.concatenate([part.mean(axis=0) for part in np.array_split(rows, count)])


def _spread(count: int, box: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Returns points of a box, spread evenly along each axis (Latin hypercube)."""
    cells = np.array([random.permutation(count) for _ in box]).T
    return box[:, 0] + (cells + random.random(cells.shape)) / count * (box[:, 1] - box[:, 0])


class _Surface:
    """Quadratic surfaces through windows of simulated scenes, with their scatter."""

    def __init__(
        self, points: np.ndarray, windows: np.ndarray, box: np.ndarray, noise: np.ndarray
    ) -> None:
        """Fits the surfaces; `noise` is the variance that the measurement adds to each window."""
        self._middle, self._half = box.mean(axis=1), 0.5 * (box[:, 1] - box[:, 0])
        self._noise = np.diag(noise)
        terms = self._terms(points)
        self._free = len(points) - terms.shape[1]
        self._inverse = np.linalg.pinv(terms.T @ terms)
        self._weights = self._inverse @ terms.T @ windows
        left = windows - terms @ self._weights
        products = left.T @ left
        self._precision = self._invert(products / self._free)
        self._excess = self._find_excess(points, left, products)

    def _terms(self, points: np.ndarray) -> np.ndarray:
        x = (points - self._middle) / self._half
        count = x.shape[1]
        squares = [x[:, i] * x[:, j] for i in range(count) for j in range(i, count)]
        return np.column_stack([np.ones(len(x)), x, *squares])

    def _slopes(self, point: np.ndarray) -> np.ndarray:
        """Returns the slopes of all windows at a point, shape (names, windows)."""
        steps = 1e-3 * np.diag(self._half)
        return 500 * (self._terms(point + steps) - self._terms(point - steps)) @ self._weights

    def _invert(self, scatter: np.ndarray) -> np.ndarray:
        """Returns the inverse covariance of a window's deviation."""
        # Few runs estimate correlations badly: half of each is kept.
        own = np.diag(np.diag(scatter))
        floor = 1e-9 * np.trace(own + self._noise) / len(own) + 1e-300
        return np.linalg.inv(0.5 * (scatter + own) + self._noise + floor * np.eye(len(own)))

    def _find_excess(self, points, left, products) -> float:
        """Returns the factor by which squared errors of fitted parameters exceed those expected.

        Each simulated scene is fitted as if it were the measurement, by surfaces through the other
        ones. The covariance alone promises too little error: it is estimated from few scenes, and
        the surfaces are uncertain themselves.
        """
        terms, errors = self._terms(points), []
        leverage = np.einsum("ij,jk,ik->i", terms, self._inverse, terms)
        for point, row, lever in zip(points, left, np.minimum(leverage, 0.9)):
            # Residual and scatter without this scene, by the formulas of leaving one out.
            others = products - np.outer(row, row) / (1 - lever)
            precision = self._invert(others / max(1, self._free - 1))
            slopes = self._slopes(point)
            gain = precision @ slopes.T
            share = gain @ np.linalg.solve(slopes @ gain, gain.T)
            squared = row @ share @ row / (1 - lever) ** 2 + np.trace(share @ self._noise)
            errors.append(squared / len(slopes))
        return max(1.0, float(np.mean(errors)))

    def deviation(self, points: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """Returns the squared deviation of each point's windows from the measured ones, in units of
        their variance.
        """
        left = wanted - self._terms(points) @ self._weights
        return np.einsum("ij,jk,ik->i", left, self._precision, left)

    def likelihood(self, points: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """Returns the likelihood of each point, with the sum 1."""
        deviation = self.deviation(points, wanted)
        scaled = (deviation - deviation.min()) / (self._excess * self._free)
        weights = np.exp(-0.5 * (self._free + points.shape[1]) * np.log1p(scaled))
        return weights / weights.sum()


def _quantile(values: np.ndarray, weights: np.ndarray, share: float) -> float:
    order = np.argsort(values)
    return float(np.interp(share, np.cumsum(weights[order]), values[order]))


def calibrate(
    scene: Scene | str | os.PathLike,
    times: Sequence[float],
    measured: Mapping[str, Sequence[float]],
    *,
    parameters: Mapping[str, tuple[float, float]] = SOIL,
    windows: int = 8,
    noise: float = 0.0,
    samples: int = 16,
    rounds: int = 2,
    level: float = 0.95,
    workers: int = 0,
    seed: int = 1,
    earlier: Simulated | None = None,
    html: str | os.PathLike | None = None,
) -> Calibration:
    """Fits `parameters` (settings such as "soil.cohesion_pa", with the box to search) to series.

    `measured` holds a series per output of the scene, such as the force on a bucket or the force of
    a cylinder, at increasing `times` [s] after the scene's start. Means over `windows` parts of the
    series are compared; `noise` is the standard deviation of such a mean that the measurement
    adds, as a share of the largest sample of its output. Each of the `rounds` simulates scenes
    until `samples` are in its box, in as many processes as `workers` (one per processor with 0, in
    this process with 1); a script that calls it needs the usual `if __name__ == "__main__":`.
    `earlier` holds the scenes simulated for another series of the same motion, which are used, too.
    `html` names a page that shows the result.

    Raises ValueError for series, boxes or counts that do not fit, InputError for an unknown output
    or a value that the schema refuses, SimulationError if one of the scenes fails.
    """
    scene = scene.copy() if isinstance(scene, Scene) else Scene(scene)
    times = np.asarray(times, dtype=float)
    series = {name: np.asarray(values, dtype=float) for name, values in measured.items()}
    outputs, names = list(series), list(parameters)
    count = len(names)
    least = (count + 1) * (count + 2) // 2 + 4
    if times.ndim != 1 or len(times) < windows or (np.diff(times) <= 0).any() or times[0] < 0:
        raise ValueError("times must increase from 0 or later, at least one per window")
    for name, values in series.items():
        if values.shape != times.shape or not np.isfinite(values).all():
            raise ValueError("%s must have one finite number per time" % name)
    if not outputs or not names or samples < least or rounds < 1 or not 0 < level < 1:
        raise ValueError("give outputs, parameters, at least %d samples and a round" % least)
    random = np.random.default_rng(seed)
    wanted = _windows(np.column_stack(list(series.values())), windows)
    largest = np.array([np.abs(values).max() for values in series.values()])
    variance = np.tile(np.square(noise * largest), windows)
    bounds = np.array([parameters[name] for name in names], dtype=float)
    if (bounds[:, 0] >= bounds[:, 1]).any():
        raise ValueError("a box must have its lower value first")
    box = bounds
    empty = np.empty((0, count)), np.empty((0, len(times), len(outputs)))
    known = Simulated(repr(scene), names, outputs, times, *empty)
    if earlier is not None:
        if not earlier.fits(known):
            raise ValueError("earlier: other scene, parameters, outputs or times")
        known.add(earlier.points, earlier.rows)
    before = len(known.points)

    def scene_at(point):
        changed = scene.copy()
        changed.update(settings_of(scene, names, point))
        return changed

    with _pool(workers or os.cpu_count() or 1) as each:
        for turn in range(rounds):
            missing = max(0, samples - int(known.inside(box).sum()))
            more = _spread(missing, box, random)
            known.add(more, each([(scene_at(point), outputs, times) for point in more]))
            # Far from the present box the surfaces need not be quadratic.
            near = known.inside(box)
            found = np.array([_windows(one, windows) for one in known.rows[near]])
            surface = _Surface(known.points[near], found, box, variance)
            tried = _spread(40000, box, random)
            weights = surface.likelihood(tried, wanted)
            best = weights @ tried
            spread = np.sqrt(weights @ np.square(tried - best))
            if turn + 1 < rounds:
                # Over the wide box a quadratic surface is off, and so is the place of the next one.
                half = np.maximum(5 * spread, 0.3 * (box[:, 1] - box[:, 0]))
                box = np.column_stack(
                    [np.maximum(bounds[:, 0], best - half), np.minimum(bounds[:, 1], best + half)]
                )
        tails = 0.5 * (1 - level)
        low = [_quantile(tried[:, i], weights, tails) for i in range(count)]
        high = [_quantile(tried[:, i], weights, 1 - tails) for i in range(count)]
        fitted = simulate(scene_at(best), outputs, times)
    result = Calibration(
        names,
        best,
        np.array(low),
        np.array(high),
        level,
        float(surface.deviation(tried, wanted).min()) / max(1, len(wanted) - count),
        len(known.points) - before + 1,
        times,
        series,
        dict(zip(outputs, fitted.T)),
        known.points[near],
        tried[random.choice(len(tried), 400, p=weights)],
        known,
    )
    if html is not None:
        write_page(html, result, scene._data.name, bounds)
    return result
