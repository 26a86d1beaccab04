# SPDX-License-Identifier: Apache-2.0
"""Gymnasium environment of a dig, registered as "Navvy/Dig-v0" when this module is imported.

    env = gymnasium.make("Navvy/Dig-v0")
    envs = gymnasium.make_vec("Navvy/Dig-v0", num_envs=4)      # steps its members on threads
"""
from __future__ import annotations

import concurrent.futures
import os
import threading
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv

from ._errors import SimulationError
from ._scene import Scene
from ._world import World
from .digging import MACHINE, joint_channels, vary_scene

_SITE = os.path.join(os.path.dirname(__file__), "dig.sdf")
#: Largest changes of a world's stance: forward and to the left [m], yaw [rad].
_STANCE = (0.5, 0.5, 0.1)
#: Time in which a machine comes to rest before its world is a start [s].
_SETTLE = 1.0


def scene_of(number: int, share: float) -> Scene:
    """Returns the scene of a world. Number 0 is the scene file; others differ in soil, as by
    `vary_scene` with `share`, in stance and hills.
    """
    scene = Scene(_SITE)
    if number == 0:
        return scene
    random = np.random.default_rng(number)
    scene = vary_scene(scene, random, share, _STANCE)
    height = scene.ground.shape[0].height_m * random.uniform(0.25, 1)
    scene.update({"ground.hills.seed": number, "ground.hills.height_m": height})
    return scene


class Worlds:
    """Worlds at their start, by number. Several environments may share them; each world is used by
    one of them at a time.
    """

    def __init__(self, vary: float) -> None:
        self._vary = vary
        self._starts: dict[int, tuple[Scene, bytes]] = {}
        self._free: dict[int, list[World]] = {}
        self._lock = threading.Lock()

    def take(self, number: int) -> World:
        """Returns a world at its start; loads a snapshot, or builds the first one of its number."""
        with self._lock:
            free = self._free.setdefault(number, [])
            world = free.pop() if free else None
            if number not in self._starts:
                scene = scene_of(number, self._vary)
                world = World(scene)
                world.step(round(_SETTLE / world.dt))
                self._starts[number] = scene, world.save()
            scene, start = self._starts[number]
        world = world or World(scene)
        world.load(start)
        return world

    def give(self, number: int, world: World) -> None:
        """Takes a world back."""
        with self._lock:
            self._free[number].append(world)

    def close(self) -> None:
        """Closes all worlds that are not in use."""
        with self._lock:
            for free in self._free.values():
                for world in free:
                    world.close()
                free.clear()


class DigEnv(gymnasium.Env):
    """Fill the bucket of an excavator and lift it.

    Action, 4 numbers from -1 to 1: velocities of boom, arm, bucket and swing as shares of the
    joints' limits, held for `1 / rate` seconds. Observation, 16 numbers: positions [rad] and
    velocities [rad/s] of the joints in this order, place of the bucket's tip relative to its start
    [m] and force of the soil on the bucket [100 kN], both in axes of the world, payload [t], and
    height of the tip over the columns under it, without loose soil [m].

    `rate` is in actions per second, `duration` in seconds. Worlds differ in strength by at most the
    share `vary`. `shared` are worlds that several environments use.

    Reward: what the payload held above the tip's start has grown by [t] (soil counts when it is
    lifted, and is lost when it falls), less 0.01 per megajoule of work.

    `terminated`: the machine tipped over, was buried, or a step failed (`info["failure"]`); the
    state has no future. `truncated`: `duration` seconds are over; the state has one. After either
    the next call must be `reset`.

    `reset(seed=...)` draws one of `worlds` worlds, which differ in soil, stance and hills, and
    loads a snapshot of the machine at rest; `reset(options={"world": 3})` chooses one. A world is
    built when it is drawn for the first time, in about half a second, and kept.
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        rate: float = 10,
        duration: float = 20,
        vary: float = 0.3,
        worlds: int = 8,
        shared: Worlds | None = None,
    ) -> None:
        if not rate > 0 or not duration > 0 or not 0 <= vary < 1 or worlds < 1:
            raise ValueError("rate and duration must be above 0, vary 0 to 1, worlds 1 or more")
        self._rate, self._duration, self._count = rate, duration, worlds
        self._worlds = shared or Worlds(vary)
        self._owns = shared is None
        self._number, self._world = 0, None
        self.action_space = spaces.Box(-1, 1, (4,), np.float32)
        self.observation_space = spaces.Box(-1e4, 1e4, (16,), np.float64)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        super().reset(seed=seed)
        number = int(self.np_random.integers(self._count))
        if options and "world" in options:
            number = int(options["world"])
        self._give()
        self._number, self._world = number, self._worlds.take(number)
        self._begin_episode(self._world)
        return self._observation(), {"world": number}

    @property
    def world(self) -> World | None:
        """World of the episode; None before the first reset."""
        return self._world

    def _give(self) -> None:
        if self._world is not None:
            self._worlds.give(self._number, self._world)
            self._world = None

    def _begin_episode(self, world: World) -> None:
        bucket = MACHINE + "/bucket/"
        names = joint_channels("position") + joint_channels("velocity")
        names += [bucket + name for name in ("tip_x", "tip_y", "tip_z")]
        names += [bucket + name for name in ("force_x", "force_y", "force_z", "payload")]
        self._outputs = [world.output(name) for name in names]
        self._inputs = [world.input(name) for name in joint_channels("velocity")]
        channels = world.inputs
        self._limits = np.array([channels[i].high for i in self._inputs])
        self._grid = world.grid
        self._steps = max(1, round(1 / (self._rate * world.dt)))
        # Half an action early, as actions are whole steps.
        self._end = world.time + self._duration - 0.5 / self._rate
        self._values = np.empty(len(self._outputs))
        self._held = 0.0
        self._start = world.observe(self._values, self._outputs)[8:11].copy()

    def _observation(self) -> np.ndarray:
        values = self._world.observe(self._values, self._outputs)
        tip = values[8:11].copy()
        out = np.append(values, tip[2] - self._ground_at(tip[0], tip[1]))
        out[8:11] -= self._start
        out[11:14] *= 1e-5
        out[14] *= 1e-3
        return out

    def _ground_at(self, x: float, y: float) -> float:
        """Returns the height of the columns at a place; beyond the site that of its edge."""
        columns, grid = self._world.columns, self._grid
        ix = int((x - grid["origin"][0]) / grid["cell"])
        iy = int((y - grid["origin"][1]) / grid["cell"])
        return columns[min(max(iy, 0), grid["ny"] - 1), min(max(ix, 0), grid["nx"] - 1)]

    def step(self, action):
        world = self._world
        if world is None:
            raise RuntimeError("call reset before step")
        action = np.asarray(action, dtype=np.float64)
        if action.shape != (4,) or not np.isfinite(action).all():
            raise ValueError("an action is 4 finite numbers from -1 to 1")
        work = world.energy
        for index, value in zip(self._inputs, np.clip(action, -1, 1) * self._limits):
            world.set(index, value)
        info: dict[str, Any] = {}
        failed = False
        try:
            world.step(self._steps)
        except SimulationError as error:
            info["failure"], failed = str(error), True
        found = self._observation()
        held = found[14] if found[10] > 0 else 0.0
        reward = held - self._held - 1e-8 * (world.energy - work)
        self._held = held
        fallen = world.phase(MACHINE) in ("tipped", "buried")
        return found, float(reward), failed or fallen, world.time >= self._end, info

    def close(self) -> None:
        self._give()
        if self._owns:
            self._worlds.close()


class DigVectorEnv(VectorEnv):
    """Several DigEnv whose members step at the same time, on `workers` threads (one per processor
    with 0). The results do not depend on their number. Members share their worlds: at most one per
    member is in use. `settings` are those of DigEnv.

    Each member has a world of its own, which keeps its state from step to step. `navvy.rollout`
    starts from snapshots and returns no states, so a step by it would need a snapshot to be saved
    and loaded, and could not go on (python/README.md has the times).

    A member that ended is reset by the next step (`AutoresetMode.NEXT_STEP`): its action is
    ignored, its reward is 0 and its observation is the first of the new episode.
    """

    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(self, num_envs: int = 1, workers: int = 0, vary: float = 0.3, **settings) -> None:
        shared = Worlds(vary)
        self._shared = shared
        #: The single environments.
        self.members = [DigEnv(vary=vary, shared=shared, **settings) for _ in range(num_envs)]
        self._pool = concurrent.futures.ThreadPoolExecutor(workers or os.cpu_count() or 1)
        self._ended = [False] * num_envs
        self.num_envs = num_envs
        self.single_action_space = self.members[0].action_space
        self.single_observation_space = self.members[0].observation_space
        batch = gymnasium.vector.utils.batch_space
        self.action_space = batch(self.single_action_space, num_envs)
        self.observation_space = batch(self.single_observation_space, num_envs)

    def _infos(self, infos) -> dict[str, Any]:
        out: dict[str, Any] = {}
        for index, info in enumerate(infos):
            out = self._add_info(out, info, index)
        return out

    def reset(self, *, seed=None, options: dict[str, Any] | None = None):
        if seed is None or isinstance(seed, int):
            seed = [None if seed is None else seed + i for i in range(self.num_envs)]
        pairs = zip(self.members, seed)
        found = list(self._pool.map(lambda one: one[0].reset(seed=one[1], options=options), pairs))
        self._ended = [False] * self.num_envs
        return np.stack([one for one, _ in found]), self._infos(info for _, info in found)

    @staticmethod
    def _advance(env: DigEnv, ended: bool, action):
        if not ended:
            return env.step(action)
        observation, info = env.reset()
        return observation, 0.0, False, False, info

    def step(self, actions):
        found = list(self._pool.map(self._advance, self.members, self._ended, actions))
        observations, rewards, terminated, truncated, infos = zip(*found)
        self._ended = [a or b for a, b in zip(terminated, truncated)]
        return (
            np.stack(observations),
            np.array(rewards),
            np.array(terminated),
            np.array(truncated),
            self._infos(infos),
        )

    def close_extras(self, **settings) -> None:
        for env in self.members:
            env.close()
        self._shared.close()
        self._pool.shutdown()


gymnasium.register(
    id="Navvy/Dig-v0",
    entry_point="navvy.env:DigEnv",
    vector_entry_point="navvy.env:DigVectorEnv",
)
