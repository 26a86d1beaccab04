#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of the tracked undercarriage (Wavefront OBJ, metres, z up, each in its link's frame) into meshes/.

The shapes are our own, drawn after no product; numbers repeat model.sdf. The upper structure is the ew180's. Run again
after a change: python3 vehicles/ex180_tracked/make_meshes.py
"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from crawler_mesh import track  # noqa: E402
from obj_mesh import Mesh, write_all  # noqa: E402


def belt():
    return track(1.72, 0.46, 0.34, 0.06, 0.6, [-1.2, -0.8, -0.4, 0, 0.4, 0.8, 1.2], 0.08, 46)


def frame():
    m = Mesh()
    # Middle frame under the swing bearing, and two legs to each side.
    m.box("dark", (-0.85, -0.62, 0.50), (0.85, 0.62, 0.92))
    for x in (-0.72, 0.72):
        m.box("dark", (x - 0.16, -1.0, 0.45), (x + 0.16, 1.0, 0.75))
    m.cylinder("steel", (0, 0, 0), "z", 0.66, 0.92, 1.10, 36)
    return m


def sprocket():
    m = Mesh()
    m.cylinder("steel", (0, 0, 0), "y", 0.31, -0.06, 0.06, 24)
    for side in (-1, 1):
        m.cylinder("dark", (0, 0, 0), "y", 0.2, min(side * 0.06, side * 0.30), max(side * 0.06, side * 0.30), 20)
    for i in range(21):
        a, half = 2 * math.pi * i / 21, 0.05
        corners = [(0.30 * math.cos(a - half), 0.30 * math.sin(a - half)), (0.36 * math.cos(a), 0.36 * math.sin(a)),
                   (0.30 * math.cos(a + half), 0.30 * math.sin(a + half))]
        m.prism("steel", corners, -0.05, 0.05, "y", 0)
    for i in range(8):
        a = 2 * math.pi * i / 8
        for side in (-1, 1):
            m.cylinder("steel", (0.15 * math.sin(a), 0, 0.15 * math.cos(a)), "y", 0.018,
                       min(side * 0.30, side * 0.33), max(side * 0.30, side * 0.33), 6, 0)
    return m


def main():
    write_all(__file__, "ex180_tracked", (("track", belt), ("frame", frame), ("sprocket", sprocket)))


if __name__ == "__main__":
    main()
