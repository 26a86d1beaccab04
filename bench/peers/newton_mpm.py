# SPDX-License-Identifier: Apache-2.0
"""Implicit MPM of Newton (SolverImplicitMPM) on the processor: the same block collapses.

Its grains are rigid-plastic, as in its own example of sand, which costs it less than an elastic
law. Its step is that example's, too: ten times ours, with which the pile has the same shape as with
5 ms. The grid is dense, which is faster here than a sparse one; all else is as Newton sets it.
"""
import math

import mpm_setup as setup
import newton
import numpy as np
import warp as wp
from newton.solvers import SolverImplicitMPM

STEP = 1 / 60
GROUND = 3 * setup.CELL
# Newton bounds sqrt(J2) by this times the pressure; CONE belongs to a norm of the strain.
FRICTION = 3 / math.sqrt(2) * setup.CONE
# Above the sand's own, so that soil shears over the ground as over the rough one of the others.
GROUND_FRICTION = 1.0

options = setup.arguments()
# Warp runs kernels of the processor in one thread.
options.threads = 1
block = setup.Block(options.particles)
N = block.count
wp.set_device("cpu")

builder = newton.ModelBuilder()
SolverImplicitMPM.register_custom_attributes(builder)
builder.add_particles(
    pos=[block.position(index) for index in range(N)],
    vel=[(0.0, 0.0, 0.0)] * N,
    mass=[block.mass] * N,
    radius=[setup.CELL / 4] * N,
)
ground = newton.ModelBuilder.ShapeConfig(mu=GROUND_FRICTION)
builder.add_ground_plane(height=GROUND, cfg=ground)
model = builder.finalize()
model.set_gravity((0.0, 0.0, -setup.GRAVITY))
model.mpm.friction.fill_(FRICTION)
config = SolverImplicitMPM.Config(voxel_size=setup.CELL, grid_type="dense")
solver = SolverImplicitMPM(model, config=config)
# The state now, and the one that the next step fills.
states = [model.state(), model.state()]


def run(steps):
    """Advances by `steps` time steps."""
    for _ in range(steps):
        now, then = states
        solver.step(now, then, None, None, STEP)
        solver.project_outside(then, then, STEP)
        states.reverse()
    wp.synchronize()


setup.measure("Newton", newton.__version__, options, N, STEP, run)
positions = states[0].particle_q.numpy()
if not np.isfinite(positions).all():
    raise SystemExit("newton_mpm.py: a position is not finite")
if positions[:, 2].min() < GROUND - setup.CELL / 2:
    raise SystemExit("newton_mpm.py: soil fell through the ground")
