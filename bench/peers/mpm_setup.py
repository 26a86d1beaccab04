# SPDX-License-Identifier: Apache-2.0
"""The block of sand that every peer simulates: the same particles, law and time step."""
import argparse
import json
import math
import time

CELL = 0.1
DENSITY = 1600.0
YOUNG, POISSON = 1e6, 0.3
FRICTION_DEG = 35.0
GRAVITY = 9.81
COURANT = 0.5
# Cells between the block and the grid's sides.
MARGIN = 10

LAME_MU = YOUNG / (2 * (1 + POISSON))
LAME_LAMBDA = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
# Drucker-Prager cone through the compression corners of Mohr-Coulomb's surface.
SIN_PHI = math.sin(math.radians(FRICTION_DEG))
CONE = math.sqrt(2.0 / 3.0) * 2 * SIN_PHI / (3 - SIN_PHI)
SOUND = math.sqrt((LAME_LAMBDA + 2 * LAME_MU) / DENSITY)
STEP = COURANT * CELL / SOUND


class Block:
    """A cube of sand on level ground, two particles along each axis of a cell."""

    def __init__(self, particles):
        self.along = max(2, round(particles ** (1 / 3)))
        self.count = self.along**3
        cells = math.ceil(self.along / 2)
        self.nodes = (cells + 2 * MARGIN, cells + 2 * MARGIN, cells + 8)
        self.volume = (CELL / 2) ** 3
        self.mass = DENSITY * self.volume

    def position(self, index):
        """Returns the position of a particle at the start; z = 3 cells is the ground."""
        place = (index % self.along, index // self.along % self.along, index // self.along**2)
        low = (MARGIN, MARGIN, 3)
        return tuple(CELL * (low[k] + 0.25 + 0.5 * place[k]) for k in range(3))


def arguments():
    """Returns the options that every peer takes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--particles", type=int, default=27000)
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--threads", type=int, default=1)
    return parser.parse_args()


def measure(name, version, options, count, step, run):
    """Times `run(steps)` after a warm-up and prints the result as a line of JSON."""
    began = time.perf_counter()
    run(3)
    first = time.perf_counter() - began
    wall, processor = time.perf_counter(), time.process_time()
    run(options.steps)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    result = {
        "code": name,
        "version": version,
        "threads": options.threads,
        "particles": count,
        "steps": options.steps,
        "step_ms": 1e3 * step,
        "wall_s": wall,
        "processor_s": processor,
        "first_steps_s": first,
    }
    print("PEER " + json.dumps(result), flush=True)
