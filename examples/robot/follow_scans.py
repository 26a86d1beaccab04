#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Follows the sensors of a run while it goes on, and prints what each reading is.

    navvy run paper/diff_physics --publish-sensors tcp:7001 &
    python3 follow_scans.py 7001 robot/laser/ranges
"""
import json, socket, sys
import numpy


def readings(port):
    """Yields (header, array) for every reading until the run ends."""
    stream = socket.create_connection(("127.0.0.1", port)).makefile("rb")
    for line in stream:
        head = json.loads(line)
        if "bytes" in head:
            data = numpy.frombuffer(stream.read(head["bytes"]), head["type"])
            yield head, data.reshape(head["shape"])
        elif "end" in head:
            return
    raise ConnectionError("the run was cut off")


if __name__ == "__main__":
    for head, values in readings(int(sys.argv[1])):
        if head["name"] in sys.argv[2:]:
            seen = values[numpy.isfinite(values)]
            nearest = f"{seen.min():.2f} {head['unit']}" if seen.size else "nothing"
            print(f"{head['time']:8.3f} s  {head['name']} {head['sequence']}: nearest {nearest}")
