# SPDX-License-Identifier: Apache-2.0
"""Gymnasium environment of a dig: `gymnasium.make("Navvy/Dig-v0")` after `import navvy.env`."""
from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from ._errors import SimulationError
from ._scene import Scene
from ._world import World

_JOINTS = ("boom_joint", "arm_joint", "bucket_joint", "swing_joint")


class DigEnv(gymnasium.Env):
    """Fill the bucket of an excavator and lift it.

    Action, 4 numbers from -1 to 1: velocities of boom, arm, bucket and swing as shares of the
    joints' limits, held for `1 / rate` seconds. Observation, 15 numbers: positions and velocities
    of the four joints, place of the bucket's tip relative to its start [m], force on the bucket
    [100 kN], and payload [t].

    Reward: 1 for each tonne of payload that was gained while the tip is above its start, less 0.01
    per megajoule of work. An episode is `terminated` when the machine tips over or a step fails
    (`info["failure"]`), and `truncated` after `duration` seconds. `reset(seed=...)` draws one of
    `soils` soils, whose cohesion and friction lie within the share `vary` of the scene's, and loads
    a snapshot of a machine that has come to rest. One world is kept for each soil that was drawn.
    """

    metadata = {"render_modes": []}
    scene = "trench"
    machine = "excavator"

    def __init__(
        self, rate: float = 10, duration: float = 20, vary: float = 0.3, soils: int = 4
    ) -> None:
        if not rate > 0 or not duration > 0 or not 0 <= vary < 1 or soils < 1:
            raise ValueError("rate and duration must be above 0, vary 0 to 1, soils 1 or more")
        self._rate, self._duration, self._vary, self._soils = rate, duration, vary, soils
        self._worlds: dict[int, tuple[World, bytes]] = {}
        self._world: World | None = None
        self.action_space = spaces.Box(-1, 1, (4,), np.float32)
        self.observation_space = spaces.Box(-1e4, 1e4, (15,), np.float64)

    def _make(self, number: int) -> tuple[World, bytes]:
        """Returns the world of a soil and its start, in which the bucket is near the ground."""
        scene = Scene(self.scene)
        draw = np.random.default_rng(number).uniform(1 - self._vary, 1 + self._vary, 2)
        if number > 0:
            scene.soil.cohesion_pa = float(scene.soil[0].cohesion_pa * draw[0])
            scene.soil.friction_angle_deg = float(
                min(scene.soil[0].friction_angle_deg * draw[1], 44)
            )
        world = World(scene)
        world.step(int(1.0 / world.dt))
        return world, world.save()

    def _names(self, quantity: str) -> list[str]:
        return ["%s/%s/%s" % (self.machine, joint, quantity) for joint in _JOINTS]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        super().reset(seed=seed)
        number = int(self.np_random.integers(self._soils))
        if number not in self._worlds:
            self._worlds[number] = self._make(number)
        self._world, start = self._worlds[number]
        self._world.load(start)
        world = self._world
        bucket = self.machine + "/bucket/"
        self._outputs = [
            world.output(name)
            for name in self._names("position")
            + self._names("velocity")
            + [bucket + "tip_x", bucket + "tip_y", bucket + "tip_z"]
            + [bucket + "force_x", bucket + "force_y", bucket + "force_z", bucket + "payload"]
        ]
        self._inputs = [world.input(name) for name in self._names("velocity")]
        self._limits = np.array([world.inputs[i].high for i in self._inputs])
        self._steps = max(1, round(1 / (self._rate * world.dt)))
        # Half an action early, as actions are whole steps.
        self._end = world.time + self._duration - 0.5 / self._rate
        self._values = np.empty(len(self._outputs))
        self._begin = world.observe(self._values, self._outputs)[8:11].copy()
        return self._observation(), {"soil": number}

    def _observation(self) -> np.ndarray:
        values = self._world.observe(self._values, self._outputs).copy()
        values[8:11] -= self._begin
        values[11:14] *= 1e-5
        values[14] *= 1e-3
        return values

    def step(self, action):
        world = self._world
        if world is None:
            raise RuntimeError("call reset before step")
        action = np.asarray(action, dtype=np.float64)
        if action.shape != (4,) or not np.isfinite(action).all():
            raise ValueError("an action is 4 finite numbers from -1 to 1")
        before, work = self._values[14] * 1e-3, world.energy
        for index, value in zip(self._inputs, np.clip(action, -1, 1) * self._limits):
            world.set(index, value)
        info: dict[str, Any] = {}
        failed = False
        try:
            world.step(self._steps)
        except SimulationError as error:
            info["failure"], failed = str(error), True
        found = self._observation()
        lifted = found[10] > 0
        reward = (found[14] - before if lifted else 0.0) - 1e-8 * (world.energy - work)
        fallen = world.phase(self.machine) in ("tipped", "buried")
        return found, float(reward), failed or fallen, world.time >= self._end, info

    def close(self) -> None:
        for world, _ in self._worlds.values():
            world.close()
        self._worlds, self._world = {}, None


gymnasium.register(id="Navvy/Dig-v0", entry_point="navvy.env:DigEnv")
