#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the dumper's meshes (Wavefront OBJ, metres, z up, each in its link's frame) into meshes/.

The shapes are our own, drawn after no product; pins and frames repeat model.sdf. Run again after a change:
python3 vehicles/dumper/make_meshes.py
"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from obj_mesh import Mesh, arc, write_all  # noqa: E402

RADIUS, WIDTH = 0.50, 0.40  # of a tyre
# The bed's inside in its link's frame (the hinge): front board, floor, tail, as (x, z), and its half width at z.
TOP, FRONT, REAR, LIP = (3.02, 1.00), (2.80, 0.22), (0.65, 0.22), (-0.45, 0.60)
RIM_FRONT, RIM_REAR = (2.964, 0.80), (0.40, 0.80)
PLATE = 0.065  # box walls: clods that lie on a side do not show outside


def half_width(z):
    return 0.95 + 0.13 * min(1.0, (z - 0.22) / 0.58)


def wheel():
    m = Mesh()
    h = 0.5 * WIDTH
    m.lathe("rubber", [(0.255, -0.80 * h), (0.30, -0.94 * h), (0.37, -0.99 * h), (0.43, -0.97 * h), (0.462, -0.84 * h),
                       (0.474, -0.5 * h), (0.478, 0), (0.474, 0.5 * h), (0.462, 0.84 * h), (0.43, 0.97 * h), (0.37, 0.99 * h),
                       (0.30, 0.94 * h), (0.255, 0.80 * h), (0.255, -0.80 * h)], n=32)
    # Lugs in a herringbone, from either shoulder to the middle.
    for i in range(36):
        left = i % 2 == 0
        a = 2 * math.pi * i / 36
        blocks = []
        for radius, half in ((0.44, 0.055), (RADIUS, 0.042)):
            for y, lead in ((-h * 0.97 if left else h * 0.97, -0.10), (h * 0.12 if left else -h * 0.12, 0.10)):
                r = radius - (0.022 if abs(y) > 0.8 * h and radius > 0.46 else 0)
                for s in (-half, half):
                    b = a + s + lead
                    blocks.append((r * math.sin(b), y, r * math.cos(b)))
        faces = [[4, 5, 7, 6], [0, 2, 3, 1], [0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]]
        m.add("rubber", blocks, faces if left else [f[::-1] for f in faces])
    for side in (-1, 1):
        rim = [(0.09, side * 0.04), (0.20, side * 0.02), (0.225, side * 0.10), (0.245, side * 0.165), (0.262, side * 0.172),
               (0.258, side * 0.150)]
        m.lathe("rim", rim[::side], n=28)
        m.cylinder("dark", (0, 0, 0), "y", 0.105, min(side * 0.02, side * 0.13), max(side * 0.02, side * 0.13), 18, 0.02)
        for i in range(8):
            b = 2 * math.pi * i / 8
            y0, y1 = sorted((side * 0.02, side * 0.055))
            m.cylinder("steel", (0.15 * math.sin(b), 0, 0.15 * math.cos(b)), "y", 0.017, y0, y1, 6, 0)
    return m


def front_axle():
    m = Mesh()
    m.prism("dark", [(-0.70, -0.08), (0.70, -0.08), (0.70, 0.08), (0.22, 0.13), (-0.22, 0.13), (-0.70, 0.08)], -0.10, 0.10, "x")
    m.cylinder("dark", (0, 0, 0), "x", 0.16, -0.19, 0.19, 20, 0.04)
    m.cylinder("steel", (-0.17, 0, 0.02), "y", 0.03, -0.60, 0.60, 10)
    return m


def knuckle():
    m = Mesh()
    m.cylinder("dark", (0, 0, 0), "z", 0.085, -0.17, 0.17, 18, 0.03)
    m.cylinder("dark", (0, 0, 0), "y", 0.12, -0.13, 0.13, 18, 0.03)
    m.box("dark", (-0.20, -0.05, -0.05), (0.0, 0.05, 0.05))
    return m


def frame(m):
    """Two rails with cross members, rear axle, hinge brackets, tanks."""
    for side in (-1, 1):
        y0, y1 = sorted((side * 0.28, side * 0.40))
        m.prism("dark", [(-1.15, 0.70), (-0.75, 0.58), (2.0, 0.58), (2.35, 0.70), (3.50, 0.70), (3.50, 0.92), (2.30, 0.92),
                         (2.10, 0.88), (-1.15, 0.88)], y0, y1)
        m.prism("dark", [(-1.16, 0.80), (-0.84, 0.80)] + arc(-1.0, 0.90, 0.11, 0, 180, 8), y0 - 0.03, y1 + 0.03, "y", 0.008)
        m.cylinder("steel", (-1.0, 0, 0.90), "y", 0.045, min(side * 0.20, side * 0.48), max(side * 0.20, side * 0.48), 14)
        # Tank and tool box between the axles.
        y0, y1 = sorted((side * 0.42, side * 0.90))
        if side > 0:
            m.cylinder("grey", (0, side * 0.68, 0.72), "x", 0.21, 0.75, 1.75, 22, 0.03)
            for x in (0.95, 1.55):
                m.box("black", (x, y0, 0.50), (x + 0.05, y0 + 0.05, 0.92), 0.008)
        else:
            m.box("grey", (0.75, y0, 0.54), (1.75, y1, 0.92), 0.03)
            m.box("dark", (0.83, y0 - 0.006, 0.60), (1.67, y0 + 0.004, 0.86), 0.002)
        # Rear lamps and mudguards in front of and behind the rear wheel.
        m.box("red", (-1.19, side * 0.34 - 0.05, 0.76), (-1.15, side * 0.34 + 0.05, 0.83), 0.004)
        y0, y1 = sorted((side * 0.72, side * 1.08))
        m.prism("black", arc(0, 0.50, 0.575, 10, 50, 5) + arc(0, 0.50, 0.555, 50, 10, 5), y0, y1, "y", 0.0)
        # Foot of the telescopic ram.
        y0, y1 = sorted((side * 0.09, side * 0.15))
        m.box("dark", (-0.38, y0, 0.42), (-0.22, y1, 0.80), 0.02)
    for x in (-0.95, -0.45, 0.6, 1.4, 2.2, 3.0):
        m.box("dark", (x, -0.30, 0.64), (x + 0.10, 0.30, 0.84), 0.02)
    m.cylinder("dark", (0, 0, 0.50), "y", 0.11, -0.72, 0.72)
    m.cylinder("dark", (0, 0, 0.50), "y", 0.20, -0.18, 0.18, 20, 0.06)
    m.cylinder("dark", (0, 0, 0.55), "x", 0.045, 0.1, 2.6, 12)


def front_end(m):
    """Hood with grille, bumper, fenders over the steered wheels, steps."""
    m.prism("yellow", [(2.10, 0.86), (3.62, 0.86), (3.74, 0.98), (3.70, 1.44), (3.56, 1.56), (3.22, 1.60), (2.10, 1.60)], -0.52, 0.52,
            "y", 0.05)
    for k in range(6):
        z = 0.99 + 0.075 * k
        m.box("black", (3.70 - 0.008 * k, -0.36, z), (3.745 - 0.008 * k, 0.36, z + 0.04), 0.006)
    for side in (-1, 1):
        y0, y1 = sorted((side * 0.515, side * 0.53))
        for k in range(5):
            m.box("black", (3.28, y0, 1.00 + 0.075 * k), (3.52, y1, 1.035 + 0.075 * k), 0.003)
        y0, y1 = sorted((side * 0.50, side * 1.12))
        outer, inner = arc(2.70, 0.50, 0.68, 30, 150, 10), arc(2.70, 0.50, 0.645, 150, 30, 10)
        m.prism("yellow", outer + inner, y0, y1, "y", 0.0)
        m.box("lamp", (3.66, side * 0.44 - 0.06, 1.28), (3.73, side * 0.44 + 0.06, 1.38), 0.01)
        for z in (0.42, 0.66):
            y0, y1 = sorted((side * 0.72, side * 1.02))
            m.box("black", (1.86, y0, z), (2.06, y1, z + 0.035), 0.008)
        m.tube("black", [(1.96, side * 1.0, 0.42), (1.96, side * 1.0, 1.06)], 0.015)
        m.tube("black", [(3.22, side * 1.05, 1.05), (3.40, side * 1.20, 1.40), (3.40, side * 1.22, 1.62)], 0.014)
        y0, y1 = sorted((side * 1.14, side * 1.30))
        m.box("black", (3.38, y0, 1.52), (3.43, y1, 1.86), 0.015)
    m.box("dark", (3.50, -0.85, 0.62), (3.80, 0.85, 0.86), 0.04)
    m.cylinder("steel", (3.78, 0, 0.60), "z", 0.03, -0.04, 0.22, 10)
    m.cylinder("black", (2.22, -0.66, 0), "z", 0.05, 1.55, 2.18, 16)
    m.cylinder("steel", (2.22, -0.66, 0), "z", 0.04, 2.16, 2.28, 16)


def cab(m):
    """A frame of posts with glass between, seat and wheel inside."""
    half = 0.60
    m.prism("yellow", [(2.18, 1.10), (3.24, 1.10), (3.24, 1.66), (2.18, 1.66)], -half, half, "y", 0.03)
    m.prism("yellow", [(2.14, 2.40), (3.14, 2.40), (3.10, 2.50), (2.98, 2.54), (2.24, 2.54), (2.14, 2.50)], -half - 0.03, half + 0.03,
            "y", 0.03)
    for side in (-1, 1):
        y0, y1 = sorted((side * half, side * (half - 0.06)))
        m.prism("dark", [(2.18, 1.62), (2.26, 1.62), (2.26, 2.44), (2.18, 2.44)], y0, y1, "y", 0.008)
        m.prism("dark", [(2.66, 1.62), (2.73, 1.62), (2.73, 2.44), (2.66, 2.44)], y0, y1, "y", 0.008)
        m.prism("dark", [(3.16, 1.62), (3.24, 1.62), (3.10, 2.44), (3.02, 2.44)], y0, y1, "y", 0.008)
        y0, y1 = sorted((side * (half - 0.025), side * (half - 0.035)))
        m.prism("glass", [(2.24, 1.64), (2.68, 1.64), (2.68, 2.42), (2.24, 2.42)], y0, y1, "y", 0)
        m.prism("glass", [(2.71, 1.64), (3.18, 1.64), (3.05, 2.42), (2.71, 2.42)], y0, y1, "y", 0)
        y0, y1 = sorted((side * (half + 0.005), side * (half + 0.025)))
        m.box("black", (2.58, y0, 1.52), (2.64, y1, 1.57), 0.005)
        m.box("lamp", (3.05, side * 0.42 - 0.07, 2.54), (3.11, side * 0.42 + 0.07, 2.61), 0.01)
    m.rings("glass", [[(3.20, -half + 0.05, 1.66), (3.20, half - 0.05, 1.66)], [(3.06, -half + 0.05, 2.42), (3.06, half - 0.05, 2.42)]],
            False)
    m.rings("glass", [[(2.20, half - 0.05, 1.66), (2.20, -half + 0.05, 1.66)], [(2.20, half - 0.05, 2.42), (2.20, -half + 0.05, 2.42)]],
            False)
    m.box("seat", (2.36, -0.24, 1.52), (2.78, 0.24, 1.72), 0.04)
    m.prism("seat", [(2.34, 1.66), (2.46, 1.66), (2.40, 2.26), (2.30, 2.26)], -0.22, 0.22, "y", 0.03)
    m.tube("black", [(3.10, 0, 1.60), (2.98, 0, 1.84)], 0.03)
    m.lathe("black", [(0.17, 1.84), (0.19, 1.86), (0.17, 1.88), (0.17, 1.84)], (2.96, 0, 0), "z", 18)
    m.cylinder("lamp", (2.60, 0, 0), "z", 0.06, 2.53, 2.66, 14)
    m.tube("black", [(2.10, -0.50, 1.55), (2.10, -0.50, 2.45), (2.10, 0.50, 2.45), (2.10, 0.50, 1.55)], 0.03)


def chassis():
    m = Mesh()
    frame(m)
    front_end(m)
    cab(m)
    return m


def bed_plate(m, a, b):
    """A plate across the bed between the profile points a and b, outside painted, inside worn."""
    dx, dz = b[0] - a[0], b[1] - a[1]
    length = math.hypot(dx, dz)
    n = (-dz / length * PLATE, dx / length * PLATE)  # to the inside when walking from the front over the floor to the lip
    out = [(p[0] + n[0], p[1] + n[1]) for p in (a, b)]
    ya, yb = half_width(a[1]), half_width(b[1])
    for (p, q), material, flip in (((a, b), "worn", True), ((out[0], out[1]), "yellow", False)):
        corners = [(p[0], ya, p[1]), (p[0], -ya, p[1]), (q[0], -yb, q[1]), (q[0], yb, q[1])]
        m.face(material, corners[::-1] if flip else corners)


def bed_side(m, side):
    outline = [FRONT, REAR, LIP, RIM_REAR, RIM_FRONT]
    for gap, material, flip in ((0.0, "worn", side < 0), (PLATE, "yellow", side > 0)):
        corners = [(x, side * (half_width(z) + gap), z) for x, z in outline]
        m.face(material, corners[::-1] if flip else corners)
    # Rim, and ribs down the outside.
    def along(points, radius):
        m.tube("yellow", [(x, side * (half_width(z) + 0.5 * PLATE), z) for x, z in points], radius, 8)
    along([(3.05, 0.80), RIM_FRONT, RIM_REAR, LIP], 0.055)
    along([(-0.43, 0.56), (0.66, 0.19), (2.82, 0.19), (3.0, 0.80)], 0.05)
    for x in (0.55, 1.10, 1.65, 2.20, 2.72):
        low, high = half_width(0.22) + PLATE, half_width(0.80) + PLATE
        ys = [side * v for v in (low, low + 0.05, high + 0.05, high)]
        corners = [(ys[0], 0.20), (ys[1], 0.20), (ys[2], 0.78), (ys[3], 0.78)]
        m.prism("yellow", corners, x - 0.045, x + 0.045, "x", 0.006)


def bed():
    m = Mesh()
    for a, b in ((TOP, FRONT), (FRONT, REAR), (REAR, LIP)):
        bed_plate(m, a, b)
    for side in (-1, 1):
        bed_side(m, side)
    w = half_width(1.0)
    m.tube("yellow", [(TOP[0] + 0.03, -w - 0.02, TOP[1]), (TOP[0] + 0.03, w + 0.02, TOP[1])], 0.055, 8)
    for side in (-1, 1):
        m.tube("yellow", [(TOP[0] + 0.03, side * (w + 0.02), TOP[1]), (3.01, side * (w + 0.02), 0.78)], 0.05, 8)
    m.tube("worn", [(LIP[0], -half_width(0.6), LIP[1]), (LIP[0], half_width(0.6), LIP[1])], 0.03, 8)
    for y in (-0.55, 0.0, 0.55):  # ribs of the front board
        m.prism("yellow", [(2.85, 0.24), (2.94, 0.20), (3.14, 0.98), (3.07, 1.0)], y - 0.04, y + 0.04, "y", 0.006)
    for x in (0.30, 0.85, 1.40, 1.95, 2.50):  # cross members under the floor
        low = 0.08 if x > 0.6 else 0.11
        m.box("dark", (x - 0.05, -0.92, low), (x + 0.05, 0.92, 0.18 if x > 0.6 else 0.28), 0.01)
    for side in (-1, 1):
        y0, y1 = sorted((side * 0.26, side * 0.42))
        m.prism("dark", [(-0.06, -0.02), (0.06, -0.04), (2.70, 0.02), (2.70, 0.14), (0.60, 0.16), (-0.02, 0.36), (-0.12, 0.10)], y0, y1,
                "y", 0.015)
        m.cylinder("steel", (0, 0, 0), "y", 0.08, y0, y1, 18)
        y0, y1 = sorted((side * 0.09, side * 0.15))
        m.box("dark", (1.02, y0, 0.04), (1.18, y1, 0.20), 0.02)
    return m


def main():
    write_all(__file__, "dumper", (("chassis", chassis), ("front_axle", front_axle), ("knuckle", knuckle), ("wheel", wheel),
                                   ("bed", bed)))


if __name__ == "__main__":
    main()
