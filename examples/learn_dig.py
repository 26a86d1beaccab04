#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Learns to fill a bucket with NumPy alone, in the environment Navvy/Dig-v0.

    python3 examples/learn_dig.py --minutes 10

A policy is a table of joint speeds at equal times, linear in between. The cross-entropy method
draws tables from a normal distribution, tries each for an episode, and moves the distribution to
the best ones. In the end the best table is compared with random actions, which change five times a
second, in worlds that it has not seen.
"""
import argparse
import os
import time

import gymnasium
import numpy as np

import navvy.env  # noqa: F401  registers the environment

DURATION, RATE, KNOTS, JOINTS = 8, 5, 5, 4
ROWS = DURATION * RATE


def actions_of(table):
    """Returns the actions of an episode, shape (rows, joints), of a table (knots, joints)."""
    at = np.linspace(0, KNOTS - 1, ROWS)
    return np.column_stack([np.interp(at, np.arange(KNOTS), column) for column in table.T])


def returns_of(envs, plans, worlds):
    """Returns the sum of rewards of each plan of actions in each world, shape (plans, worlds).
    A plan has the shape (rows, joints); the members of `envs` work on one each.
    """
    totals = np.zeros((len(plans), len(worlds)))
    for column, world in enumerate(worlds):
        for first in range(0, len(plans), envs.num_envs):
            batch = plans[first : first + envs.num_envs]
            rows = np.zeros((envs.num_envs, ROWS, JOINTS))
            rows[: len(batch)] = np.clip(batch, -1, 1)
            envs.reset(seed=0, options={"world": world})
            alive = np.ones(envs.num_envs)
            for row in range(ROWS):
                _, rewards, terminated, _, _ = envs.step(rows[:, row].astype(np.float32))
                totals[first : first + len(batch), column] += (alive * rewards)[: len(batch)]
                alive *= ~terminated
    return totals


def interval(values):
    """Returns the mean with its 95 % interval (bootstrap)."""
    draws = np.random.default_rng(0).choice(values, (10000, len(values))).mean(axis=1)
    return "%.3f (%.3f to %.3f)" % (np.mean(values), *np.percentile(draws, (2.5, 97.5)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--minutes", type=float, default=10, help="time to learn")
    parser.add_argument("--members", type=int, default=8, help="tables per round")
    parser.add_argument("--workers", type=int, default=0, help="threads; 0: one per processor")
    parser.add_argument("--unseen", type=int, default=10, help="worlds of the comparison")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    settings = {"duration": DURATION + 1, "rate": RATE, "workers": options.workers}
    count = options.workers or os.cpu_count() or 1
    envs = gymnasium.make_vec("Navvy/Dig-v0", num_envs=count, **settings)
    # The swing is left out at the start: a scoop is in the plane of the arm.
    mean, spread = np.zeros((KNOTS, JOINTS)), np.full((KNOTS, JOINTS), 0.5) * [1, 1, 1, 0.1]
    tables, scores = np.empty((0, KNOTS, JOINTS)), np.empty(0)
    begin, turn = time.monotonic(), 0
    while time.monotonic() - begin < 60 * options.minutes:
        drawn = mean + spread * random.standard_normal((options.members, KNOTS, JOINTS))
        world = [turn % 4]  # worlds 0 to 3 are for learning
        found = returns_of(envs, [actions_of(table) for table in drawn], world)[:, 0]
        # The best so far stay in the race, so that one lucky round is not forgotten.
        tables, scores = np.concatenate([tables, drawn]), np.concatenate([scores, found])
        best = np.argsort(-scores)[: options.members]
        tables, scores, turn = tables[best], scores[best], turn + 1
        elite = tables[: max(2, options.members // 2)]
        mean, spread = elite.mean(axis=0), np.maximum(elite.std(axis=0), 0.1 * spread + 0.02)
        text = "%4.0f s  round %3d  best %6.3f  mean of the round %6.3f"
        print(text % (time.monotonic() - begin, turn, scores[0], found.mean()), flush=True)
    learned, chance = [], []
    for world in range(4, 4 + options.unseen):
        noise = random.uniform(-1, 1, (ROWS, JOINTS))
        found = returns_of(envs, [actions_of(tables[0]), noise], [world])[:, 0]
        learned.append(found[0])
        chance.append(found[1])
    print("%d unseen worlds, mean reward of an episode with its 95 %% interval:" % options.unseen)
    print("learned %s, random actions %s" % (interval(learned), interval(chance)))
    print("gain %s" % interval(np.subtract(learned, chance)))
    envs.close()


if __name__ == "__main__":
    main()
