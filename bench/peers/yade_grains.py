# SPDX-License-Identifier: Apache-2.0
"""A block of grains of 5 cm collapses on level ground, run by `yade -x -n yade_grains.py`."""
import json
import os
import time

from yade import O, utils
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_MindlinPhys_Mindlin,
    NewtonIntegrator,
)

along = int(os.environ["PEER_ALONG"])
steps = int(os.environ["PEER_STEPS"])
SPACING, RADIUS = 0.049, 0.025
sand = O.materials.append(FrictMat(young=1e7, poisson=0.3, frictionAngle=0.46, density=2600))
for n in range(along**3):
    place = (n % along, n // along % along, n // along**2)
    O.bodies.append(utils.sphere([SPACING * (0.5 + k) for k in place], RADIUS, material=sand))
O.bodies.append(utils.wall(0, axis=2, material=sand))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys()],
        [Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.1),
]
O.dt = 2e-5
began = time.perf_counter()
O.run(5, True)
first = time.perf_counter() - began
wall, processor = time.perf_counter(), time.process_time()
O.run(steps, True)
wall, processor = time.perf_counter() - wall, time.process_time() - processor
result = {
    "particles": along**3,
    "steps": steps,
    "step_ms": 1e3 * O.dt,
    "wall_s": wall,
    "processor_s": processor,
    "first_steps_s": first,
}
print("PEER " + json.dumps(result), flush=True)
