#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the robot's belt (Wavefront OBJ, metres, z up) into meshes/. Our own shape; numbers repeat model.sdf. Run again
after a change: python3 vehicles/tracked_robot/make_meshes.py
"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from crawler_mesh import track  # noqa: E402
from obj_mesh import write_all  # noqa: E402


def belt():
    return track(0.32, 0.11, 0.08, 0.01, 0.08, [-0.2, -0.1, 0, 0.1, 0.2], 0.03, 60)


def main():
    write_all(__file__, "tracked_robot", (("track", belt),))


if __name__ == "__main__":
    main()
