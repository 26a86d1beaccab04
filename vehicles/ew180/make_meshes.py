#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the EW180's meshes (Wavefront OBJ, metres, z up, each in its link's frame) into meshes/.

The shapes are our own, drawn after no product; pins and frames repeat model.sdf. Run again after a change:
python3 vehicles/ew180/make_meshes.py
"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from obj_mesh import Mesh, arc, beam, lug, write_all  # noqa: E402


def wheel_pair():
    m = Mesh()
    for k, y in enumerate((-0.16, 0.16)):
        side = 1 if y > 0 else -1
        # Tyre: bead, side wall, shoulder, crown, back along the rim; then tread blocks up to the full radius.
        m.lathe("rubber", [(0.285, y - 0.115), (0.33, y - 0.135), (0.40, y - 0.140), (0.46, y - 0.137),
                           (0.492, y - 0.118), (0.502, y - 0.06), (0.504, y), (0.502, y + 0.06),
                           (0.492, y + 0.118), (0.46, y + 0.137), (0.40, y + 0.140), (0.33, y + 0.135),
                           (0.285, y + 0.115), (0.285, y - 0.115)], n=32)
        for i in range(40):
            left = i % 2 == 0
            a = 2 * math.pi * (i + 0.5 * k) / 40
            ys = (y - 0.137, y + 0.012) if left else (y - 0.012, y + 0.137)
            skew = 0.05 if left else -0.05
            blocks = []
            for radius in (0.47, 0.525):
                for yy, turn in ((ys[0], -skew if left else skew), (ys[1], skew if left else -skew)):
                    half = 0.050 if radius < 0.5 else 0.040
                    r = radius - (0.02 if abs(yy - y) > 0.1 and radius > 0.5 else 0)
                    for s in (-half, half):
                        b = a + s + turn * 0.6
                        blocks.append((r * math.sin(b), yy, r * math.cos(b)))
            m.add("rubber", blocks, [[4, 5, 7, 6], [0, 2, 3, 1], [0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]])
        # Rim: flange outside, dish towards the axle.
        flange = y + side * 0.125
        rim = [(0.10, y - side * 0.115), (0.285, y - side * 0.115), (0.292, flange), (0.272, flange),
               (0.250, y + side * 0.085), (0.235, y + side * 0.02), (0.10, y + side * 0.03), (0.10, y - side * 0.115)]
        m.lathe("rim", rim[::side], n=28)
    for side in (-1, 1):
        m.cylinder("dark", (0, 0, 0), "y", 0.13, min(side * 0.17, side * 0.26), max(side * 0.17, side * 0.26), 20, 0.02)
        for i in range(10):
            a = 2 * math.pi * i / 10
            m.cylinder("steel", (0.175 * math.sin(a), 0, 0.175 * math.cos(a)), "y", 0.018,
                       min(side * 0.17, side * 0.215), max(side * 0.17, side * 0.215), 6, 0)
    m.cylinder("dark", (0, 0, 0), "y", 0.24, -0.12, 0.12, 20)
    return m


def chassis():
    m = Mesh()
    # Main frame: a box that is deeper between the axles.
    m.prism("dark", [(-0.75, 0.66), (0.35, 0.66), (0.55, 0.52), (2.15, 0.52), (2.35, 0.70), (3.55, 0.70), (3.62, 0.98),
                     (3.2, 1.02), (2.0, 1.06), (0.2, 1.06), (-0.7, 1.0)], -0.42, 0.42)
    m.cylinder("dark", (1.25, 0, 0), "z", 0.74, 0.98, 1.10, 36)
    m.cylinder("steel", (1.25, 0, 0), "z", 0.66, 1.08, 1.17, 36)
    # Rear axle with its differential.
    m.cylinder("dark", (0, 0, 0.525), "y", 0.125, -0.78, 0.78)
    m.cylinder("dark", (0, 0, 0.525), "y", 0.24, -0.20, 0.20, 20, 0.06)
    m.cylinder("dark", (0, 0, 0.56), "x", 0.05, 0.1, 2.75, 12)
    m.box("dark", (-0.22, -0.30, 0.60), (0.22, 0.30, 0.75))
    # Boxes and steps between the axles on either side.
    for side in (-1, 1):
        y0, y1 = sorted((side * 0.44, side * 1.16))
        m.box("grey", (0.66, y0, 0.58), (2.06, y1, 0.98), 0.035)
        y0, y1 = sorted((side * 1.158, side * 1.168))
        m.box("dark", (0.74, y0, 0.64), (1.33, y1, 0.92), 0.004)
        m.box("dark", (1.39, y0, 0.64), (1.98, y1, 0.92), 0.004)
        for z in (0.30, 0.46):
            y0, y1 = sorted((side * 0.98, side * 1.22))
            m.box("black", (1.05, y0, z), (1.65, y1, z + 0.035), 0.008)
        for x in (1.05, 1.65):
            m.tube("black", [(x, side * 1.2, 0.31), (x, side * 1.2, 0.62)], 0.016)
        # Mudguards over the wheels.
        for x, front in ((0, False), (2.8, True)):
            y0, y1 = sorted((side * 0.70, side * 1.20))
            outer = arc(x, 0.525, 0.62, 52, 118, 6)
            inner = arc(x, 0.525, 0.60, 118, 52, 6)
            if not front:
                m.prism("black", outer + inner, y0, y1, "y", 0.0)
        m.box("red", (-0.79, side * 0.38 - 0.07, 0.84), (-0.76, side * 0.38 + 0.07, 0.91), 0.004)
        m.box("lamp", (3.60, side * 0.30 - 0.06, 0.83), (3.65, side * 0.30 + 0.06, 0.91), 0.008)
    # Blade-less front: bumper with tow pin; plate at the rear.
    m.box("yellow", (3.45, -0.62, 0.62), (3.60, 0.62, 0.80), 0.03)
    m.box("yellow", (-0.84, -0.62, 0.62), (-0.70, 0.62, 0.80), 0.03)
    m.cylinder("steel", (3.62, 0, 0.62), "z", 0.03, -0.06, 0.24, 10)
    return m


def front_axle():
    m = Mesh()
    m.prism("dark", [(-0.80, -0.09), (0.80, -0.09), (0.80, 0.09), (0.25, 0.15), (-0.25, 0.15), (-0.80, 0.09)], -0.12, 0.12,
            "x")
    m.cylinder("dark", (0, 0, 0), "x", 0.19, -0.22, 0.22, 20, 0.04)
    m.cylinder("steel", (-0.20, 0, 0.02), "y", 0.035, -0.62, 0.62, 10)
    return m


def knuckle():
    m = Mesh()
    m.cylinder("dark", (0, 0, 0), "z", 0.10, -0.20, 0.20, 18, 0.03)
    m.cylinder("dark", (0, 0, 0), "y", 0.15, -0.16, 0.16, 18, 0.03)
    m.box("dark", (-0.24, -0.06, -0.05), (0.0, 0.06, 0.05))
    return m


def counterweight_outline(radius, half_width):
    """Plan of the tail: straight sides, round back about the swing centre."""
    a = math.degrees(math.asin(half_width / radius))
    return arc(0, 0, radius, 180 - a, 180 + a, 14)


def upper():
    m = Mesh()
    # Deck, counterweight, engine hood.
    m.prism("dark", counterweight_outline(1.90, 1.20) + [(1.20, -1.20), (1.20, 1.20)], 0.0, 0.16, "z")
    back = counterweight_outline(2.05, 1.24)
    m.prism("yellow", back + [(-1.22, -1.24), (-1.22, 1.24)], 0.10, 0.94, "z", 0.07)
    m.prism("dark", counterweight_outline(2.055, 0.80) + [(-1.5, -0.80), (-1.5, 0.80)], 0.28, 0.36, "z", 0.004)
    m.prism("yellow", [(-1.86, 0.90), (-0.42, 0.90), (-0.42, 1.12), (-0.50, 1.20), (-1.62, 1.20), (-1.80, 1.10)], -1.12, 1.12,
            "y", 0.05)
    m.box("yellow", (-1.24, -1.23, 0.14), (-0.36, 1.23, 0.98), 0.03)
    for side in (-1, 1):  # doors with louvres
        y0, y1 = sorted((side * 1.225, side * 1.240))
        for k in range(7):
            m.box("black", (-1.12, y0, 0.34 + 0.07 * k), (-0.56, y1, 0.375 + 0.07 * k), 0.003)
    for k in range(6):  # grille on the hood
        m.box("black", (-1.45 + 0.13 * k, -0.45, 1.195), (-1.38 + 0.13 * k, 0.45, 1.210), 0.003)
    m.cylinder("black", (-1.30, -0.78, 0), "z", 0.065, 1.15, 1.52, 16)
    m.cylinder("steel", (-1.30, -0.78, 0), "z", 0.05, 1.50, 1.60, 16)
    # Right side: tank and tool box with steps and a rail.
    m.box("yellow", (-0.36, -1.23, 0.14), (0.52, -0.50, 0.92), 0.05)
    m.box("yellow", (0.54, -1.23, 0.14), (1.22, -0.52, 0.58), 0.05)
    m.box("black", (0.60, -1.20, 0.575), (1.16, -0.56, 0.59), 0.004)
    m.box("black", (-0.30, -1.18, 0.915), (0.46, -0.56, 0.93), 0.004)
    m.tube("black", [(1.16, -1.16, 0.55), (1.16, -1.16, 1.10), (0.50, -1.16, 1.42), (-0.30, -1.16, 1.42), (-0.30, -1.16, 0.9)],
           0.02)
    m.tube("black", [(0.50, -1.16, 0.9), (0.50, -1.16, 1.42)], 0.02)
    # Boom foot: two cheeks with the pin, cylinder brackets in front.
    for y in (-0.34, 0.34):
        m.prism("yellow", [(-0.55, 0.14), (1.05, 0.14), (0.95, 0.26), (0.55, 0.50), (0.43, 0.86)] +
                arc(0.25, 0.80, 0.17, 20, 150, 8) + [(-0.10, 0.72)], y - 0.035, y + 0.035, "y", 0.01)
    m.cylinder("steel", (0.25, 0, 0.80), "y", 0.07, -0.40, 0.40)
    for y in (-0.47, -0.21, 0.21, 0.47):
        m.prism("yellow", [(0.45, 0.14), (0.95, 0.14)] + arc(0.70, 0.20, 0.12, 0, 180, 8), y - 0.02, y + 0.02, "y", 0.005)
    m.cylinder("steel", (0.70, 0, 0.20), "y", 0.045, -0.50, 0.50)
    cab(m)
    return m


def cab(m):
    """Cab on the left: frame of posts, glass in between, seat inside."""
    y0, y1 = 0.50, 1.24
    outline = [(-0.36, 0.16), (1.10, 0.16), (1.30, 0.48), (1.24, 1.15), (0.98, 1.86), (-0.32, 1.86), (-0.36, 1.0)]
    inner = [(-0.22, 1.02), (0.44, 1.02), (0.44, 1.74), (-0.20, 1.74)]
    door = [(0.53, 0.36), (1.06, 0.36), (1.20, 0.56), (1.14, 1.12), (0.90, 1.74), (0.53, 1.74)]
    m.prism("yellow", [(-0.36, 0.16), (1.10, 0.16), (1.30, 0.48), (1.29, 0.58), (0.50, 0.32), (0.50, 0.96), (-0.36, 0.98)], y0, y1,
            "y", 0.02)
    # Roof.
    m.prism("yellow", [(-0.38, 1.80), (1.04, 1.80), (0.98, 1.90), (0.86, 1.94), (-0.30, 1.94), (-0.38, 1.90)], y0 - 0.02, y1 + 0.02,
            "y", 0.03)
    m.box("glass", (0.10, y0 + 0.12, 1.935), (0.72, y1 - 0.12, 1.95), 0.004)
    # Posts on either side and the panes between them.
    for y in (y0, y1):
        a, b = (y, y + 0.05) if y < 1 else (y - 0.05, y)
        m.prism("dark", [(-0.36, 0.9), (-0.26, 0.9), (-0.24, 1.84), (-0.34, 1.84)], a, b, "y", 0.008)
        m.prism("dark", [(0.44, 0.3), (0.53, 0.3), (0.53, 1.84), (0.44, 1.84)], a, b, "y", 0.008)
        m.prism("dark", [(1.06, 0.34), (1.30, 0.48), (1.24, 1.15), (0.98, 1.86), (0.90, 1.82), (1.16, 1.13), (1.22, 0.56)], a, b,
                "y", 0.006)
        pane = (y + 0.02, y + 0.03) if y < 1 else (y - 0.03, y - 0.02)
        m.prism("glass", inner, pane[0], pane[1], "y", 0)
        m.prism("glass", door, pane[0], pane[1], "y", 0)
    m.rings("glass", [[(1.285, y0 + 0.05, 0.52), (1.285, y1 - 0.05, 0.52)], [(1.225, y0 + 0.05, 1.15), (1.225, y1 - 0.05, 1.15)],
                      [(0.975, y0 + 0.05, 1.84), (0.975, y1 - 0.05, 1.84)]], False)
    m.rings("glass", [[(-0.33, y0 + 0.05, 1.02), (-0.33, y1 - 0.05, 1.02)], [(-0.30, y0 + 0.05, 1.80), (-0.30, y1 - 0.05, 1.80)]],
            False)
    m.tube("dark", [(1.235, y0 + 0.03, 1.15), (1.235, y1 - 0.03, 1.15)], 0.018)
    # Operator's seat, console, wiper, mirrors, lamps, hand rail.
    m.box("seat", (-0.02, 0.68, 0.55), (0.42, 1.06, 0.70), 0.04)
    m.prism("seat", [(-0.04, 0.65), (0.10, 0.65), (0.0, 1.42), (-0.12, 1.42)], 0.70, 1.04, "y", 0.03)
    m.box("black", (0.30, 0.58, 0.60), (0.70, 0.66, 0.86), 0.02)
    m.box("black", (0.30, 1.08, 0.60), (0.70, 1.16, 0.86), 0.02)
    m.tube("black", [(0.95, 0.87, 0.35), (0.86, 0.87, 0.98)], 0.03)
    m.lathe("black", [(0.17, 0.99), (0.19, 1.01), (0.17, 1.03), (0.17, 0.99)], (0.86, 0.87, 0), "z", 18)
    m.tube("black", [(1.25, y1, 0.8), (1.36, y1 + 0.12, 1.1), (1.34, y1 + 0.15, 1.5)], 0.013)
    m.box("black", (1.30, y1 + 0.06, 1.28), (1.35, y1 + 0.22, 1.58), 0.015)
    m.tube("black", [(1.16, -1.16, 0.62), (1.28, -1.26, 0.95), (1.28, -1.28, 1.2)], 0.013)
    m.box("black", (1.24, -1.36, 1.02), (1.29, -1.20, 1.30), 0.015)
    for y in (y0 + 0.12, y1 - 0.12):
        m.box("lamp", (0.99, y - 0.07, 1.86), (1.05, y + 0.07, 1.93), 0.01)
    m.tube("black", [(0.50, y1 + 0.03, 0.60), (0.47, y1 + 0.05, 0.9), (0.47, y1 + 0.05, 1.4)], 0.015)
    m.cylinder("lamp", (0.2, 0.62, 0), "z", 0.05, 1.93, 2.04, 12)


def boom():
    m = Mesh()
    outline = beam([(-0.02, 0, 0.34), (0.5, 0.19, 0.42), (1.2, 0.44, 0.54), (1.8, 0.61, 0.62), (2.3, 0.62, 0.63), (2.9, 0.49, 0.56),
                    (3.7, 0.30, 0.48), (4.5, 0.13, 0.40), (4.82, 0.06, 0.36)])
    m.prism("yellow", outline, -0.21, 0.21, "y", 0.025)
    # Foot boss, boom cylinder bosses, fork at the tip, lug of the stick cylinder.
    m.cylinder("yellow", (0, 0, 0), "y", 0.19, -0.30, 0.30, 28, 0.02)
    m.cylinder("yellow", (2.2, 0, 0.55), "y", 0.14, -0.26, 0.26, 24, 0.015)
    m.cylinder("steel", (2.2, 0, 0.55), "y", 0.055, -0.46, 0.46, 16)
    for side in (-1, 1):
        y0, y1 = sorted((side * 0.16, side * 0.21))
        m.prism("yellow", [(4.6, -0.10), (4.9, -0.14)] + arc(5.10, 0, 0.17, -70, 90, 10) + [(4.6, 0.29)], y0, y1, "y", 0.008)
        y0, y1 = sorted((side * 0.19, side * 0.24))
        m.cylinder("yellow", (5.10, 0, 0), "y", 0.14, y0, y1, 20)
    m.cylinder("steel", (5.10, 0, 0), "y", 0.065, -0.27, 0.27, 16)
    lug(m, "yellow", 2.9, 0.9, 0.10, ((3.15, 0.68), (2.55, 0.80)), 0.13)
    # Hoses along the top and a work lamp.
    for y in (-0.10, -0.04):
        m.tube("black", [(0.4, y, 0.40), (1.2, y, 0.735), (1.8, y, 0.945), (2.25, y, 0.96), (2.5, y + 0.03, 0.93)], 0.018)
    for y in (-0.16, 0.16):
        m.tube("black", [(2.6, y, 0.865), (3.0, y, 0.765), (3.7, y, 0.56), (4.5, y, 0.35)], 0.016)
    m.box("black", (1.55, 0.21, 0.70), (1.68, 0.30, 0.80), 0.015)
    m.box("lamp", (1.67, 0.22, 0.715), (1.69, 0.29, 0.785), 0.004)
    return m


def stick():
    m = Mesh()
    m.prism("yellow", [(-0.80, 0.06), (-0.55, -0.02), (-0.16, -0.18), (0.16, -0.20), (0.8, -0.15), (1.9, -0.11), (2.40, -0.10),
                       (2.40, 0.10), (1.9, 0.14), (1.1, 0.24), (0.3, 0.33), (-0.05, 0.33), (-0.45, 0.31), (-0.78, 0.26)],
            -0.15, 0.15, "y", 0.02)
    m.cylinder("yellow", (0, 0, 0), "y", 0.15, -0.158, 0.158, 24)
    m.cylinder("yellow", (2.45, 0, 0), "y", 0.12, -0.17, 0.17, 20)
    m.cylinder("steel", (2.45, 0, 0), "y", 0.055, -0.36, 0.36, 16)
    m.cylinder("yellow", (2.084, 0, 0), "y", 0.09, -0.19, 0.19, 18)
    m.cylinder("steel", (2.084, 0, 0), "y", 0.04, -0.23, 0.23, 14)
    for side in (-1, 1):  # tail fork of the stick cylinder
        y0, y1 = sorted((side * 0.09, side * 0.14))
        m.prism("yellow", [(-0.62, 0.03)] + arc(-0.68, 0.17, 0.13, 60, 270, 10)[::1], y0, y1, "y", 0.006)
    m.cylinder("steel", (-0.68, 0, 0.17), "y", 0.05, -0.19, 0.19, 14)
    lug(m, "yellow", -0.097, 0.40 - 0.086, 0.10, ((0.20, 0.26), (-0.40, 0.26)), 0.19)
    for y in (-0.12, 0.12):
        m.tube("black", [(-0.2, y, 0.345), (0.3, y, 0.35), (1.1, y, 0.262), (1.7, y, 0.18)], 0.014)
    return m


PROFILE = [(1.40, 0.0), (1.19, 0.20), (0.99, 0.37), (0.79, 0.49), (0.58, 0.545), (0.38, 0.525), (0.22, 0.43), (0.12, 0.28),
           (0.09, 0.10)]


def half_width(x):
    return 0.525 - 0.035 * min(1.0, max(0.0, (1.40 - x) / 0.83))


def bucket():
    m = Mesh()
    # A plate 25 mm thick around the shell of model.sdf, outside painted, inside worn bright.
    line, half, thick = PROFILE, 0.55, 0.025
    inside = []
    for i, p in enumerate(line):
        a, b = line[max(0, i - 1)], line[min(len(line) - 1, i + 1)]
        dx, dz = b[0] - a[0], b[1] - a[1]
        length = math.hypot(dx, dz)
        inside.append((p[0] + dz / length * -thick * -1, p[1] - dx / length * thick * -1))
    for i in range(len(line) - 1):
        (ax, az), (bx, bz) = line[i], line[i + 1]
        (cx, cz), (dx, dz) = inside[i], inside[i + 1]
        m.face("grey", [(ax, -half, az), (ax, half, az), (bx, half, bz), (bx, -half, bz)])
        m.face("worn", [(cx, half, cz), (cx, -half, cz), (dx, -half, dz), (dx, half, dz)])
    for side in (-1, 1):  # side plates with a reinforced edge
        y0, y1 = sorted((side * half, side * (half - 0.025)))
        rim = [(0.09, 0.10), (0.40, 0.02), (0.745, 0.05), (1.10, 0.03), (1.40, 0.0)]
        m.prism("grey", line + rim[:-1], y0, y1, "y", 0)
        y0, y1 = sorted((side * (half + 0.02), side * (half - 0.03)))
        m.prism("worn", [(0.62, 0.06), (1.05, 0.035), (1.30, 0.02), (1.36, 0.05), (1.16, 0.16), (0.72, 0.16)], y0, y1, "y", 0.006)
    # Cutting edge and five teeth; their points reach the tip.
    m.prism("worn", [(1.33, 0.02), (1.36, 0.055), (1.12, 0.275), (1.09, 0.25)], -half - 0.01, half + 0.01, "y", 0.006)
    for k in range(5):
        y = -0.46 + 0.23 * k
        root = [(1.22, 0.13), (1.28, 0.19)]
        m.add("steel", [(root[0][0], y - 0.05, root[0][1]), (root[0][0], y + 0.05, root[0][1]), (root[1][0], y + 0.05, root[1][1]),
                        (root[1][0], y - 0.05, root[1][1]), (1.405, y - 0.03, -0.012), (1.405, y + 0.03, -0.012),
                        (1.42, y + 0.03, 0.004), (1.42, y - 0.03, 0.004)],
              [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7], [3, 2, 1, 0]])
        m.prism("worn", [(1.10, 0.22), (1.25, 0.10), (1.31, 0.16), (1.16, 0.30)], y - 0.06, y + 0.06, "y", 0.01)
    # Wear strips on the back, torsion tube along the top.
    for y in (-0.30, 0.0, 0.30):
        strip = [(p[0] + 0.0, p[1]) for p in line[1:7]]
        outer = [(x + 0.02 * (x - 0.6), z + 0.022) for x, z in strip]
        m.prism("worn", strip + outer[::-1], y - 0.04, y + 0.04, "y", 0)
    m.cylinder("grey", (0.10, 0, 0.10), "y", 0.045, -half, half, 14)
    # PROFILE is drawn flatter than the shell is deep; the outside lies outside the shell, or clods show through.
    m.points = [(x, y, 1.19 * z if z > 0 else z) for x, y, z in m.points]
    # Ears: from the back to the stick pin and the coupler pin.
    for y in (-0.30, -0.24, 0.24, 0.30):
        m.prism("grey", [(0.42, 0.53), (-0.2907 + 0.03, 0.3294 + 0.085)] + arc(-0.2907, 0.3294, 0.085, 100, 235, 8) +
                arc(0, 0, 0.10, 215, 330, 8) + [(0.12, 0.08), (0.13, 0.28), (0.23, 0.43)], y - 0.018, y + 0.018, "y", 0)
    for x, z in ((0, 0), (-0.2907, 0.3294)):
        for side in (-1, 1):
            m.cylinder("steel", (x, side * 0.27, z), "y", 0.075, -0.055, 0.055, 18)
    m.cylinder("steel", (-0.2907, 0, 0.3294), "y", 0.045, -0.3, 0.3, 14)
    # Side clearance, as in model.sdf: 35 mm narrower on either side from the heel on.
    m.points = [(x, y * half_width(x) / half_width(1.40) if abs(y) > 0.35 else y, z) for x, y, z in m.points]
    return m


def main():
    write_all(__file__, "ew180",
              (("chassis", chassis), ("front_axle", front_axle), ("knuckle", knuckle), ("wheel_pair", wheel_pair),
               ("upper", upper), ("boom", boom), ("stick", stick), ("bucket", bucket)))


if __name__ == "__main__":
    main()
