# SPDX-License-Identifier: Apache-2.0
"""Worlds: scenes that run."""
from __future__ import annotations

import os
import warnings
from typing import Iterable, Sequence

import numpy as np

from . import _navvy
from ._scene import Scene


class World(_navvy.Runner):
    """A running scene whose machines follow inputs only; `Session` runs the programs, too.

    One thread may use a world at a time (BusyError). A step releases Python's lock, so threads
    with a world each run at the same time. The same scene, seed, inputs and device give
    bit-identical results.
    """

    _programs = False

    def __init__(
        self,
        scene: Scene | str | os.PathLike,
        *,
        seed: int | None = None,
        device: str = "",
        watch: Iterable[str] = (),
    ) -> None:
        """Builds the world of a scene, given as a Scene, a file or the name of a shipped scene.

        `seed` replaces that of the scene. `device` selects the OpenCL device as `navvy devices`
        lists them. `watch` adds pose and velocities of links ("machine/link") to the outputs.
        """
        scene = scene.copy() if isinstance(scene, Scene) else Scene(scene)
        if seed is not None:
            scene.seed = seed
        super().__init__(scene._data, device, list(watch), self._programs)

    def observe(
        self, out: np.ndarray | None = None, outputs: Sequence[str | int] | None = None
    ) -> np.ndarray:
        """Writes all outputs, or those in `outputs`, into the float64 array `out` and returns it;
        makes a new array without `out`.
        """
        if out is None:
            out = np.empty(self.output_count if outputs is None else len(outputs))
        self._observe(out, outputs)
        return out

    def fork(self, n: int | None = None, *, into: "World | None" = None):
        """Returns a world that goes on from the present state, bit-identical with this one; a list
        of `n` such worlds with `n`. With `into`, a world of the same scene takes the state instead,
        which is several times faster.
        """
        if into is not None:
            self._copy_to(into)
            return into
        if n is not None:
            return [self.fork() for _ in range(n)]
        copy = type(self).__new__(type(self))
        _navvy.Runner.__init__(copy, self)
        return copy

    def __enter__(self):
        return self

    def __exit__(self, *error) -> None:
        self.close()

    def __reduce__(self):
        raise TypeError(
            "a world cannot be pickled; send its scene and save() to the other process, "
            "and load() there"
        )


class Session(World):
    """A running scene whose machines carry out the programs of the scene, as in `navvy run`. A
    machine leaves its program when one of its inputs is set.
    """

    _programs = True


def rollout(
    world: World,
    controls: np.ndarray,
    *,
    inputs: Sequence[str | int] | None = None,
    outputs: Sequence[str | int] | None = None,
    steps: int = 1,
    workers: int = 0,
    states: Sequence[bytes] | None = None,
    failures: list | None = None,
) -> np.ndarray:
    """Runs n copies of `world` with controls[n, t, k]; returns their outputs[n, t, m].

    Row t of a copy's controls is set on the k `inputs` (all without them), `steps` base steps are
    taken, and the m `outputs` (all without them) are recorded. Copies begin with the state of
    `world`, which does not change, or with one snapshot of `states` each. `workers` threads (one
    per processor with 0) compute them; the results do not depend on their number.

    A copy whose simulation fails keeps the outputs of its last state; it is appended to `failures`
    as (member, row, message), or without that list reported as a RuntimeWarning.
    """
    controls = np.asarray(controls)
    if controls.dtype.kind not in "fiu":
        raise TypeError("controls must be numbers, not %s" % controls.dtype)
    if controls.ndim != 3:
        raise ValueError("controls must have the shape (n, t, k), not %s" % (controls.shape,))
    controls = np.ascontiguousarray(controls, dtype=np.float64)
    chosen = world.output_count if outputs is None else len(outputs)
    results = np.zeros(controls.shape[:2] + (chosen,))
    failed = world._rollout(
        controls, inputs, results, outputs, steps, workers, list(states or ())
    )
    if failures is not None:
        failures.extend(failed)
    else:
        for member, row, text in failed:
            warnings.warn(
                "member %d failed in row %d: %s" % (member, row, text), RuntimeWarning, stacklevel=2
            )
    return results
