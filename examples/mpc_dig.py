#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Digs by trying bucket paths in copies of the running world and taking the best one.

    python3 examples/mpc_dig.py --seeds 10

An excavator begins a scoop under its built-in operator. A copy of the running world shows the path
that the operator would take. Variants of it (deeper or shallower, another angle of the bucket, a
quicker dig or carry) are tried in further copies, two rounds of them, the second around the best of
the first. The world then follows the path with the most soil per energy that takes no longer than
the operator's; that is the operator's own where no variant is better. The copies are exact, so a
path does what its trial did. With --blind the copies have the soil of the scene file, while that
of the world differs by its seed: the planner then does not know the soil it digs.

Each seed has its own soil (cohesion +-30 %, friction angle +-15 %) and stance. A cycle is counted
from the first touch until the bucket is empty.
"""
from __future__ import annotations

import argparse
import concurrent.futures
import os
import time
from typing import NamedTuple

import numpy as np

import navvy
from navvy.digging import MACHINE, joint_channels, vary_scene

STEPS = 30  # base steps per row of a path
DIG = ("penetrate", "drag", "curl")
# Standard deviations of the first round: boom [rad], bucket [rad], pace of dig and of carry (log).
SPREAD = np.array([0.015, 0.1, 0.15, 0.15])


class Path(NamedTuple):
    """A path of the arm: one row per STEPS base steps."""

    joints: np.ndarray  #: positions of the joints of `joint_channels` [rad], shape (rows, 4)
    digs: np.ndarray  #: true while the bucket digs, shape (rows,)
    dump: int  #: row in which the bucket begins to open


class Cycle(NamedTuple):
    """What a path has done."""

    kilograms: float  #: soil that left the bucket where it opened
    kilojoules: float  #: work of drives and cylinders
    seconds: float  #: until the bucket was empty

    @property
    def yield_(self) -> float:
        """Soil per energy [kg/kJ]."""
        return self.kilograms / self.kilojoules


def scene_of(seed: int, cell: float, known_soil: bool) -> navvy.Scene:
    """Returns the scene of a seed; with `known_soil` with the soil of the scene file."""
    scene = navvy.Scene("trench")
    scene.update(
        {
            "solver.cell_m": cell,
            "machine[%s].pose" % MACHINE: (-4, 0, 0, 0, 0, 0),
            "machine[%s].program.dig.max_cycles" % MACHINE: 1,
        }
    )
    share = 0.0 if known_soil else 0.3
    return vary_scene(scene, np.random.default_rng(seed), share, (0.1, 0.1, 0.02))


class Arm:
    """Inputs and outputs of the machine's arm in a world."""

    def __init__(self, world: navvy.World) -> None:
        self.world = world
        self._targets = [world.input(name) for name in joint_channels("position")]
        bounds = [world.inputs[i] for i in self._targets]
        self._low = np.array([one.low for one in bounds])
        self._high = np.array([one.high for one in bounds])
        self._joints = [world.output(name) for name in joint_channels("position")]
        self._payload = world.output(MACHINE + "/bucket/payload")

    def joints(self) -> np.ndarray:
        """Returns the positions of the joints [rad]."""
        return self.world.observe(outputs=self._joints)

    def payload(self) -> float:
        """Returns the mass in the bucket [kg]."""
        return self.world.get(self._payload)

    def aim(self, joints: np.ndarray) -> None:
        """Sets the targets of the joints [rad], within their limits."""
        for index, value in zip(self._targets, np.clip(joints, self._low, self._high)):
            self.world.set(index, value)


def measure(arm: Arm, advance, dump_begins, limit: float) -> Cycle:
    """Steps a world by `advance(row)` until the bucket has been emptied, or for `limit` seconds.
    `dump_begins(row)` returns true when it opens.
    """
    world = arm.world
    begin, energy, load, row = world.time, world.energy, None, 0
    while world.time - begin < limit:
        if load is None and dump_begins(row):
            load = arm.payload()
        if load is not None and arm.payload() <= max(20.0, 0.05 * load):
            break
        advance(row)
        row += 1
    dumped = max(0.0, (load or 0.0) - arm.payload())
    return Cycle(dumped, 1e-3 * (world.energy - energy), world.time - begin)


def watch_operator(world: navvy.Session) -> tuple[Path, Cycle]:
    """Lets the operator dig one cycle in `world`; returns its path and result."""
    arm, joints, phases = Arm(world), [], []

    def advance(row):
        joints.append(arm.joints())
        phases.append(world.phase(MACHINE))
        world.step(STEPS)

    found = measure(arm, advance, lambda row: world.phase(MACHINE) == "dump", 40)
    digs = np.array([phase in DIG for phase in phases])
    dump = next((i for i, phase in enumerate(phases) if phase == "dump"), len(phases))
    # The bucket stays open at the end of the path.
    joints.append(arm.joints())
    return Path(np.array(joints), np.append(digs, False), dump), found


def varied(path: Path, change: np.ndarray) -> Path:
    """Returns a path changed by [boom, bucket, log of the pace of the dig, of the carry]."""
    rows = len(path.joints)
    # Fades in and out over eight rows, so that no target jumps.
    weight = np.convolve(np.pad(path.digs.astype(float), 8, "edge"), np.ones(9) / 9, "same")[8:-8]
    weight *= np.minimum(1, np.arange(rows) / 8)
    joints = path.joints.copy()
    joints[:, 0] += change[0] * weight
    joints[:, 2] += change[1] * weight
    pace = np.exp(np.where(path.digs, change[2], change[3]))
    # When each row is due, in rows of the changed path.
    due = np.concatenate([[0], np.cumsum(1 / pace[:-1])])
    at = np.arange(int(np.ceil(due[-1])) + 1)
    joints = np.column_stack([np.interp(at, due, joints[:, j]) for j in range(joints.shape[1])])
    digs = np.interp(at, due, path.digs.astype(float)) > 0.5
    return Path(joints, digs, int(round(np.interp(path.dump, np.arange(rows), due))))


def follow(world: navvy.World, path: Path) -> Cycle:
    """Follows a path by targets of the joints."""
    arm, last = Arm(world), len(path.joints) - 1

    def advance(row):
        # A servo is a row late: in the middle of a row it shall be where the path is.
        ahead = 0.5 * (path.joints[min(row + 1, last)] + path.joints[min(row + 2, last)])
        arm.aim(ahead)
        world.step(STEPS)

    return measure(arm, advance, lambda row: row >= path.dump, STEPS * world.dt * last + 3)


def score(found: Cycle, operator: Cycle) -> float:
    """Returns the soil per energy, less for a cycle that takes longer than the operator's."""
    late = max(1.0, found.seconds / operator.seconds)
    return found.yield_ / late**3


def search(models, state, path, operator, rounds, tries, random):
    """Returns the best path; None if the operator's own is better. `models` are worlds to try paths
    in, one per thread.
    """
    free = list(models)

    def attempt(change):
        world = free.pop()
        world.load(state, anyway=True)
        try:
            return follow(world, varied(path, change))
        except navvy.SimulationError:
            return Cycle(0.0, 1.0, 1e3)
        finally:
            free.append(world)

    tried = []
    mean, spread = np.zeros(len(SPREAD)), SPREAD
    with concurrent.futures.ThreadPoolExecutor(len(models)) as pool:
        for _ in range(rounds):
            changes = mean + spread * random.standard_normal((tries, len(mean)))
            tried += zip(changes, pool.map(attempt, changes))
            tried.sort(key=lambda one: -score(one[1], operator))
            elite = np.array([change for change, _ in tried[: max(3, tries // 3)]])
            mean, spread = elite.mean(axis=0), elite.std(axis=0) + 0.2 * SPREAD
    change, found = tried[0]
    if score(found, operator) <= score(operator, operator):
        return None
    return varied(path, change)


def dig(seed: int, options) -> tuple[Cycle, Cycle]:
    """Returns the cycles of the operator and of the planner in the world of a seed."""
    world = navvy.Session(scene_of(seed, options.cell, False))
    while world.phase(MACHINE) != "penetrate" and world.time < 30:
        world.step(STEPS)
    state = world.save()
    if options.blind:
        first = navvy.Session(scene_of(seed, options.cell, True))
        first.load(state, anyway=True)
    else:
        first = world.fork()
    models = [first] + [first.fork() for _ in range(options.workers - 1)]
    path, expected = watch_operator(first)
    random = np.random.default_rng(seed)
    best = search(models, state, path, expected, options.rounds, options.tries, random)
    for model in models:
        model.close()
    # Without --blind, the fork that was watched did what the operator does in this world.
    operator = expected
    if options.blind:
        with world.fork() as twin:
            _, operator = watch_operator(twin)
    planned = operator if best is None else follow(world, best)
    world.close()
    return operator, planned


def interval(values: np.ndarray) -> str:
    """Returns the mean with its 95 % interval (bootstrap)."""
    random = np.random.default_rng(0)
    means = random.choice(values, (10000, len(values))).mean(axis=1)
    return "%.3g (%.3g to %.3g)" % (values.mean(), *np.percentile(means, (2.5, 97.5)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", type=int, default=10, help="number of worlds")
    parser.add_argument("--first", type=int, default=100, help="seed of the first world")
    parser.add_argument("--rounds", type=int, default=2, help="rounds of trials")
    parser.add_argument("--tries", type=int, default=8, help="paths tried per round")
    parser.add_argument("--cell", type=float, default=0.2, help="edge of the soil's cells [m]")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="threads")
    parser.add_argument("--blind", action="store_true", help="plan with the soil of the scene file")
    options = parser.parse_args()
    print("seed  operator: kg/kJ   kg   kJ    s | planned: kg/kJ   kg   kJ    s | wall s")
    found = []
    for seed in range(options.first, options.first + options.seeds):
        begin = time.perf_counter()
        cycles = dig(seed, options)
        found.append(cycles)
        texts = ["%6.2f %4.0f %4.0f %4.1f" % (c.yield_, *c) for c in cycles]
        took = time.perf_counter() - begin
        print("%4d           %s |        %s | %4.0f" % (seed, *texts, took), flush=True)
    yields = np.array([[one.yield_ for one in pair] for pair in found])
    times = np.array([[one.seconds for one in pair] for pair in found])
    print("operator: kg/kJ %s, s %s" % (interval(yields[:, 0]), interval(times[:, 0])))
    print("planned:  kg/kJ %s, s %s" % (interval(yields[:, 1]), interval(times[:, 1])))
    print("ratio:    kg/kJ %s, s %s" % tuple(interval(a[:, 1] / a[:, 0]) for a in (yields, times)))


if __name__ == "__main__":
    main()
