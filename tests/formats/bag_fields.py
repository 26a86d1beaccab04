# SPDX-License-Identifier: Apache-2.0
"""Prints as JSON every field of the last message of each topic of a ROS bag.

Messages are decoded with the definitions of ROS 2 Humble that rosbags ships. Arrays are lists, and
numbers that are not finite are texts.
"""

import json
import math
import pathlib
import sys

import numpy as np
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore


def plain(value):
    if isinstance(value, np.ndarray):
        return [plain(x) for x in value.tolist()]
    if isinstance(value, list):
        return [plain(x) for x in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, (int, float, str, bool)):
        return value
    # Constants of a type are in capitals, unlike its fields.
    fields = {name: x for name, x in vars(value).items() if name != "__msgtype__"}
    return {name: plain(x) for name, x in fields.items() if not name.isupper()}


store = get_typestore(Stores.ROS2_HUMBLE)
messages = {}
with Reader(pathlib.Path(sys.argv[1])) as reader:
    for connection, _, raw in reader.messages():
        if connection.msgtype in store.fielddefs:
            messages[connection.topic] = plain(store.deserialize_cdr(raw, connection.msgtype))
print(json.dumps(messages))
