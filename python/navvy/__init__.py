# SPDX-License-Identifier: Apache-2.0
"""Navvy: excavation with soil, machines and sensors.

    world = navvy.Session("trench")
    world.step(1000)
    print(world.time, world["excavator/bucket/payload"], world.heights.min())
"""
import os as _os

# A wheel brings the shipped scenes and machines along.
_data = _os.path.join(_os.path.dirname(__file__), "data")
if _os.path.isdir(_data) and not _os.environ.get("NAVVY_DATA_DIR"):
    _os.environ["NAVVY_DATA_DIR"] = _data

from ._opencl import find_driver as _find_driver  # noqa: E402

_find_driver()

from ._calibrate import Calibration, calibrate  # noqa: E402
from ._errors import (  # noqa: E402
    BusyError,
    ClosedError,
    DeviceError,
    Error,
    Fault,
    FileError,
    InputError,
    SimulationError,
)
from ._navvy import Channel, __version__, devices, layers, scenes, schema  # noqa: E402
from ._scene import Scene  # noqa: E402
from ._world import Session, World, rollout  # noqa: E402

__all__ = [
    "BusyError",
    "Calibration",
    "Channel",
    "ClosedError",
    "DeviceError",
    "Error",
    "Fault",
    "FileError",
    "InputError",
    "Scene",
    "Session",
    "SimulationError",
    "World",
    "__version__",
    "calibrate",
    "devices",
    "layers",
    "rollout",
    "scenes",
    "schema",
]
