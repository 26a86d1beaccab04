# SPDX-License-Identifier: Apache-2.0
"""Worlds in which an excavator digs: what the environment Navvy/Dig-v0 and
`examples/mpc_dig.py` share.
"""
from __future__ import annotations

from typing import Sequence

import numpy as np

from ._calibrate import settings_of
from ._scene import Scene

#: Name of the machine.
MACHINE = "excavator"
#: Joints of its arm, in the order of actions and observations.
JOINTS = ("boom_joint", "arm_joint", "bucket_joint", "swing_joint")


def joint_channels(quantity: str) -> list[str]:
    """Returns the names of a quantity of JOINTS, such as "position", as inputs or outputs."""
    return ["%s/%s/%s" % (MACHINE, joint, quantity) for joint in JOINTS]


def vary_scene(
    scene: Scene, random: np.random.Generator, soil: float, stance: Sequence[float]
) -> Scene:
    """Returns a copy of a scene with another soil and stance, drawn from `random`.

    Cohesion changes by the share `soil` at most, the friction angle by half of that, up to 44 deg.
    The machine moves by `stance` at most: along x and y [m] and in yaw [rad].
    """
    shares = 1 + soil * np.array([1, 0.5]) * random.uniform(-1, 1, 2)
    values = settings_of(
        scene,
        ("soil.cohesion_pa", "soil.friction_angle_deg"),
        (
            scene.soil.cohesion_pa * shares[0],
            min(44.0, scene.soil.friction_angle_deg * shares[1]),
        ),
    )
    pose = np.array(scene.machine[MACHINE].pose)
    pose[[0, 1, 5]] += np.asarray(stance) * random.uniform(-1, 1, 3)
    values["machine[%s].pose" % MACHINE] = pose
    out = scene.copy()
    out.update(values)
    return out
