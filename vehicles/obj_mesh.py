#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the vehicles' make_meshes.py share: materials, solids of simple shapes, Wavefront OBJ files (metres, z up)."""
import math
import os

MATERIALS = {  # diffuse, specular, shininess, opacity
    "yellow": ((0.86, 0.58, 0.05), 0.25, 40, 1),
    "dark": ((0.19, 0.195, 0.20), 0.12, 20, 1),
    "grey": ((0.38, 0.39, 0.40), 0.15, 20, 1),
    "black": ((0.07, 0.07, 0.075), 0.05, 8, 1),
    "rubber": ((0.095, 0.092, 0.09), 0.03, 4, 1),
    "rim": ((0.80, 0.79, 0.74), 0.20, 30, 1),
    "steel": ((0.62, 0.63, 0.65), 0.50, 60, 1),
    "worn": ((0.42, 0.40, 0.37), 0.25, 30, 1),
    "glass": ((0.16, 0.24, 0.30), 0.80, 100, 0.55),
    "seat": ((0.12, 0.12, 0.14), 0.03, 4, 1),
    "red": ((0.65, 0.06, 0.05), 0.30, 30, 1),
    "lamp": ((0.95, 0.94, 0.86), 0.60, 80, 1),
}


def cross2(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def area(polygon):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(polygon, polygon[1:] + polygon[:1]))


def ear_clip(polygon):
    """Triangles (indices) of a simple counter-clockwise polygon."""
    left, out = list(range(len(polygon))), []
    while len(left) > 3:
        for k in range(len(left)):
            i, j, l = left[k - 1], left[k], left[(k + 1) % len(left)]
            a, b, c = polygon[i], polygon[j], polygon[l]
            if cross2(a, b, c) <= 1e-12:
                continue
            if any(m not in (i, j, l) and min(cross2(a, b, polygon[m]), cross2(b, c, polygon[m]),
                                              cross2(c, a, polygon[m])) >= -1e-12 for m in left):
                continue
            out.append((i, j, l))
            left.pop(k)
            break
        else:  # only slivers remain
            left.pop(0)
    out.append(tuple(left))
    return out


def inset(polygon, d):
    """A counter-clockwise polygon moved inwards by d (mitred)."""
    out, n = [], len(polygon)
    for i in range(n):
        a, b, c = polygon[i - 1], polygon[i], polygon[(i + 1) % n]
        u, v = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
        lu, lv = math.hypot(*u) or 1, math.hypot(*v) or 1
        n1, n2 = (-u[1] / lu, u[0] / lu), (-v[1] / lv, v[0] / lv)
        s = 1 + n1[0] * n2[0] + n1[1] * n2[1]
        s = max(s, 0.4)
        out.append((b[0] + d * (n1[0] + n2[0]) / s, b[1] + d * (n1[1] + n2[1]) / s))
    return out


class Mesh:
    def __init__(self):
        self.points, self.faces = [], {}

    def face(self, material, corners):
        first = len(self.points)
        self.points += corners
        self.faces.setdefault(material, []).append(list(range(first + 1, first + 1 + len(corners))))

    def add(self, material, points, faces):
        first = len(self.points) + 1
        self.points += points
        self.faces.setdefault(material, []).extend([[first + k for k in f] for f in faces])

    def rings(self, material, rings, closed=True, cap_low=None, cap_high=None):
        """Skin over rings of equally many points; caps are triangles over the first and last ring."""
        n = len(rings[0])
        points, faces = [p for ring in rings for p in ring], []
        for r in range(len(rings) - 1):
            for i in range(n if closed else n - 1):
                a, b = r * n + i, r * n + (i + 1) % n
                faces.append([a, b, b + n, a + n])
        if cap_low:
            faces += [list(reversed(t)) for t in cap_low]
        if cap_high:
            last = (len(rings) - 1) * n
            faces += [[last + k for k in t] for t in cap_high]
        self.add(material, points, faces)

    def prism(self, material, polygon, low, high, axis="y", bevel=0.02):
        """A polygon pushed along an axis. Polygon in (x, z) for y, (x, y) for z, (y, z) for x."""
        if area(polygon) < 0:
            polygon = polygon[::-1]
        place = {"y": lambda p, h: (p[0], h, p[1]), "z": lambda p, h: (p[0], p[1], h),
                 "x": lambda p, h: (h, p[0], p[1])}[axis]
        small = inset(polygon, bevel) if bevel else polygon
        levels = [(small, low), (polygon, low + bevel), (polygon, high - bevel), (small, high)] if bevel else \
            [(polygon, low), (polygon, high)]
        caps = ear_clip(small)
        rings = [[place(p, h) for p in poly] for poly, h in levels]
        if axis == "y":  # (x, z, y) is left-handed
            rings.reverse()
        self.rings(material, rings, True, caps, caps)

    def box(self, material, low, high, bevel=0.02):
        self.prism(material, [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])], low[2],
                   high[2], "z", bevel)

    def lathe(self, material, profile, center=(0, 0, 0), axis="y", n=28):
        """Profile of (radius, along) turned about an axis through center."""
        rings = []
        for radius, along in profile:
            ring = []
            for i in range(n):
                a = 2 * math.pi * i / n
                u, v = radius * math.cos(a), radius * math.sin(a)
                p = {"x": (along, u, v), "y": (v, along, u), "z": (u, v, along)}[axis]
                ring.append(tuple(c + q for c, q in zip(center, p)))
            rings.append(ring)
        self.rings(material, rings)

    def cylinder(self, material, center, axis, radius, low, high, n=20, bevel=0.01):
        self.lathe(material, [(0, low), (radius - bevel, low), (radius, low + bevel), (radius, high - bevel),
                              (radius - bevel, high), (0, high)], center, axis, n)

    def tube(self, material, path, radius, n=8):
        """A round bar along a line of points."""
        rings = []
        for i, p in enumerate(path):
            q, r = path[max(0, i - 1)], path[min(len(path) - 1, i + 1)]
            d = [b - a for a, b in zip(q, r)]
            length = math.sqrt(sum(c * c for c in d)) or 1
            d = [c / length for c in d]
            side = (0, 0, 1) if abs(d[2]) < 0.9 else (1, 0, 0)
            u = [d[1] * side[2] - d[2] * side[1], d[2] * side[0] - d[0] * side[2], d[0] * side[1] - d[1] * side[0]]
            length = math.sqrt(sum(c * c for c in u))
            u = [c / length for c in u]
            v = [d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]]
            rings.append([tuple(p[k] + radius * (math.cos(t) * u[k] + math.sin(t) * v[k]) for k in range(3))
                          for t in (2 * math.pi * j / n for j in range(n))])
        caps = [(0, i, i + 1) for i in range(1, n - 1)]
        self.rings(material, rings, True, caps, caps)

    def write(self, folder, name, library):
        with open(os.path.join(folder, name + ".obj"), "w", encoding="ascii") as out:
            out.write("# SPDX-License-Identifier: Apache-2.0\n# Written by make_meshes.py\nmtllib %s.mtl\n" % library)
            index, lines, where = {}, [], []
            for p in self.points:  # equal points are one vertex, so that edges can be drawn round
                key = "v %.4f %.4f %.4f" % tuple(c + 0.0 for c in p)
                if key not in index:
                    index[key] = len(index) + 1
                    lines.append(key)
                where.append(index[key])
            out.write("\n".join(lines) + "\n")
            count = 0
            for material in sorted(self.faces):
                out.write("usemtl %s\n" % material)
                for face in self.faces[material]:
                    ids = []
                    for k in face:
                        if where[k - 1] not in ids:
                            ids.append(where[k - 1])
                    if len(ids) >= 3:
                        out.write("f " + " ".join(map(str, ids)) + "\n")
                        count += len(ids) - 2
            return len(lines), count


def arc(cx, cy, radius, start, end, n):
    return [(cx + radius * math.cos(math.radians(start + (end - start) * i / n)),
             cy + radius * math.sin(math.radians(start + (end - start) * i / n))) for i in range(n + 1)]


def beam(line):
    """Outline (x, z) of a beam from (x, z, height) along its middle, rounded by Catmull-Rom steps."""
    dense = []
    for i in range(len(line) - 1):
        p0, p1, p2, p3 = line[max(0, i - 1)], line[i], line[i + 1], line[min(len(line) - 1, i + 2)]
        for s in range(4):
            t = s / 4
            dense.append([0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t
                                 + (3 * b - a - 3 * c + d) * t ** 3) for a, b, c, d in zip(p0, p1, p2, p3)])
    dense.append(list(line[-1]))
    top, bottom = [], []
    for i, (x, z, h) in enumerate(dense):
        a, b = dense[max(0, i - 1)], dense[min(len(dense) - 1, i + 1)]
        dx, dz = b[0] - a[0], b[1] - a[1]
        length = math.hypot(dx, dz)
        top.append((x - dz / length * h / 2, z + dx / length * h / 2))
        bottom.append((x + dz / length * h / 2, z - dx / length * h / 2))
    return bottom + top[::-1]


def lug(mesh, material, x, z, radius, foot, half_width, thickness=0.04):
    """Two plates with a pin between them at (x, z), standing on the line `foot` of two (x, z) points."""
    outline = [foot[0]] + arc(x, z, radius, -20, 200, 10) + [foot[1]] if foot[0][0] > foot[1][0] else \
        [foot[1]] + arc(x, z, radius, -20, 200, 10) + [foot[0]]
    for side in (-1, 1):
        y0, y1 = sorted((side * half_width, side * (half_width - thickness)))
        mesh.prism(material, outline, y0, y1, "y", 0.006)
    mesh.cylinder("steel", (x, 0, z), "y", 0.6 * radius, -half_width - 0.02, half_width + 0.02, 14)


def write_all(script, library, parts):
    """Writes meshes/<library>.mtl and one OBJ file for each (name, function) beside `script`; prints their sizes."""
    folder = os.path.join(os.path.dirname(os.path.abspath(script)), "meshes")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, library + ".mtl"), "w", encoding="ascii") as out:
        out.write("# SPDX-License-Identifier: Apache-2.0\n# Written by make_meshes.py\n")
        for name, (kd, ks, ns, d) in sorted(MATERIALS.items()):
            out.write("newmtl %s\nKd %.3f %.3f %.3f\nKs %.3f %.3f %.3f\nNs %d\nd %.2f\n" % (name, *kd, ks, ks, ks, ns, d))
    total = [0, 0]
    for name, make in parts:
        points, triangles = make().write(folder, name, library)
        total = [total[0] + points, total[1] + triangles]
        print("%-11s %5d vertices %5d triangles" % (name, points, triangles))
    print("%-11s %5d vertices %5d triangles" % ("all", *total))
