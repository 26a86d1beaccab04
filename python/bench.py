# SPDX-License-Identifier: Apache-2.0
"""Measures what calls from Python cost; prints the table of python/README.md.

    python3 python/bench.py                     # calls, arrays, snapshots, memory, rollouts
    python3 python/bench.py --environments      # steps per second of the environment Navvy/Dig-v0
"""
import argparse
import os
import sys
import time

import numpy as np

# The sources of the package stand beside this file; the installed one has the extension.
sys.path.pop(0)
import navvy  # noqa: E402
from navvy.digging import MACHINE, joint_channels  # noqa: E402


def best(call, count=1, rounds=7):
    """Returns the shortest time of `call` [s] over some rounds of `count` calls each."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        for _ in range(count):
            call()
        times.append((time.perf_counter() - start) / count)
    return min(times)


def row(name, seconds, wanted=""):
    scale, unit = (1e6, "us") if seconds < 1e-3 else (1e3, "ms")
    print("| %s | %.3g %s | %s |" % (name, scale * seconds, unit, wanted), flush=True)


def main(until):
    start = time.perf_counter()
    world = navvy.Session("trench")
    row("first session of the process", time.perf_counter() - start)
    scene = navvy.Scene("trench")
    row("a second session in the process", best(lambda: navvy.Session(scene).close()), "10 ms")
    row("one call: `world.time`", best(lambda: world.time, 10000), "1 us")
    row("`world[7]`", best(lambda: world[7], 10000))
    name = world.outputs[7].name
    row("`world[name]`", best(lambda: world[name], 10000))
    row("`world.step(0)`", best(lambda: world.step(0), 10000), "1 us")
    while world.time < until:
        world.step(50)
    print("| digging: time, particles | %.1f s, %d | |" % (world.time, world.particle_count))
    dig(world)
    memory(world)
    rollouts(world)


def dig(world):
    out = np.empty(len(world.outputs))
    heights, columns, first, steps = [], [], [], []
    for _ in range(40):
        for into, call in (
            (steps, world.step),
            (first, lambda: world.observe(out)),
            (columns, lambda: world.columns),
            (heights, lambda: world.heights),
        ):
            start = time.perf_counter()
            call()
            into.append(time.perf_counter() - start)
    row("one step", float(np.median(steps)))
    row("all %d outputs after a step" % len(out), float(np.median(first)), "10 us")
    row("height view after a step, columns", float(np.median(columns)), "20 us")
    row("height view after a step, loose soil included", float(np.median(heights)), "300 us")
    snapshot = world.save()
    row("save (%.1f MB)" % (len(snapshot) / 1e6), best(world.save), "1 ms")
    row("load", best(lambda: world.load(snapshot)), "2 ms")
    row("fork", best(lambda: world.fork().close()), "5 ms")
    other = world.fork()
    row("fork into a world", best(lambda: world.fork(into=other)), "2.5 ms")
    row("state_hash", best(world.state_hash))


def rollouts(world, members=8, rows=10, steps=10):
    inputs = [one.name for one in world.inputs if one.name.endswith("joint/velocity")][:4]
    controls = np.random.default_rng(1).uniform(-0.2, 0.2, (members, rows, len(inputs)))
    for workers in (1, 2, 4):
        call = lambda: navvy.rollout(world, controls, inputs=inputs, steps=steps, workers=workers)
        call()
        seconds = best(call, rounds=2)
        print(
            "| rollout, %d workers: steps per second | %.0f | |"
            % (workers, members * rows * steps / seconds),
            flush=True,
        )


def resident():
    """Returns the resident memory of the process [bytes]."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def memory(world, count=64):
    """Prints what copies of a world take."""
    before = resident()
    copies = world.fork(count)
    # Memory that is never written does not count, so each takes a step.
    for one in copies:
        one.step()
    print(
        "| %d more worlds | %.2f GiB, the process %.2f GiB | 2 GiB |"
        % (count, (resident() - before) / 2**30, resident() / 2**30),
        flush=True,
    )
    for one in copies:
        one.close()


DOWN, PULL, AIR = (-0.5, 0, 0, 0), (-0.1, -0.6, -0.1, 0), (0.1, 0, 0, 0)


def repeat(envs, action, steps):
    """Steps all members by one action; returns their steps per second."""
    actions = np.tile(np.float32(action), (envs.num_envs, 1))
    start = time.perf_counter()
    for _ in range(steps):
        envs.step(actions)
    return envs.num_envs * steps / (time.perf_counter() - start)


def by_rollout(envs, steps):
    """Returns how many steps per second a rollout takes from the states of all members, which are
    saved for each step. A rollout returns outputs and no states, so that it could not carry the
    environment.
    """
    members = [one.world for one in envs.members]
    limits = [one.high for one in members[0].inputs]
    inputs = [members[0].input(name) for name in joint_channels("velocity")]
    row = np.array(PULL) * [limits[i] for i in inputs]
    controls = np.tile(row, (len(members), 1, 1))
    outputs = [members[0].output(MACHINE + "/bucket/payload")]
    start = 0.0
    for turn in range(steps + 1):
        states = [one.save() for one in members]
        navvy.rollout(
            members[0],
            controls,
            inputs=inputs,
            outputs=outputs,
            steps=round(0.1 / members[0].dt),
            states=states,
        )
        # The first one builds the worlds that the others use again.
        start = start or time.perf_counter()
    return len(members) * steps / (time.perf_counter() - start)


def environments():
    """Prints steps per second of environments, in the air and in soil."""
    import gymnasium

    import navvy.env  # noqa: F401  registers the environment

    print("| worlds | in the air | in soil | in soil, each step a rollout | reset of one |")
    print("|---|---|---|---|---|")
    for count in (1, 2, 4):
        envs = gymnasium.make_vec("Navvy/Dig-v0", num_envs=count, worlds=1)
        envs.reset(seed=0)
        air, soil, rolled = [], [], []
        for _ in range(3):
            resets = best(lambda: envs.reset(seed=0), rounds=3) / count
            air.append(repeat(envs, AIR, 20))
            envs.reset(seed=0)
            repeat(envs, DOWN, 9)
            soil.append(repeat(envs, PULL, 20))
            envs.reset(seed=0)
            repeat(envs, DOWN, 9)
            repeat(envs, PULL, 10)
            rolled.append(by_rollout(envs, 10))
        cells = tuple(np.median(one) for one in (air, soil, rolled))
        print("| %d | %.1f | %.1f | %.1f | %.1f ms |" % (count, *cells, 1e3 * resets), flush=True)
        envs.close()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--environments", action="store_true", help="measure environments only")
    parser.add_argument("--until", type=float, default=20, help="time of the digging world [s]")
    arguments = parser.parse_args()
    if arguments.environments:
        environments()
    else:
        print("| measure | measured | at most |\n|---|---|---|")
        main(arguments.until)
