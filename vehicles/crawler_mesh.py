# SPDX-License-Identifier: Apache-2.0
"""A crawler's belt with its rollers and frame, for make_meshes.py of tracked vehicles."""
import math

from obj_mesh import Mesh, arc


def track(half_span, wheel_z, radius, thickness, width, run, roller_radius, shoes):
    """`run`: the rollers' x; the belt's outside lies at z = 0 under them and rises to both wheels."""
    m = Mesh()
    outer = radius + thickness
    first, last = min(run), max(run)

    def outline(r, ground):
        points = arc(half_span, wheel_z, r, -70, 90, 14) + arc(-half_span, wheel_z, r, 90, 250, 14)
        return points + [(first - 0.5 * roller_radius, ground), (last + 0.5 * roller_radius, ground)]

    belt = outline(outer, 0.0)
    # The belt as a ring: outside and inside quads of one strip, with both edges.
    inside = outline(radius, thickness)
    n, half = len(belt), 0.5 * width
    points, faces = [], []
    for (xo, zo), (xi, zi) in zip(belt, inside):
        points += [(xo, -half, zo), (xo, half, zo), (xi, -half, zi), (xi, half, zi)]
    for i in range(n):
        a, b = 4 * i, 4 * ((i + 1) % n)
        faces += [[a, a + 1, b + 1, b], [a + 2, b + 2, b + 3, a + 3]]
        faces += [[a, b, b + 2, a + 2], [a + 1, a + 3, b + 3, b + 1]]
    m.add("dark", points, faces)
    # Grousers: bars across the belt, evenly along it.
    lengths = [math.dist(belt[i], belt[(i + 1) % n]) for i in range(n)]
    total, at, i = sum(lengths), 0.0, 0
    for k in range(shoes):
        s = total * k / shoes
        while s > at + lengths[i]:
            at += lengths[i]
            i += 1
        (x0, z0), (x1, z1) = belt[i], belt[(i + 1) % n]
        f = (s - at) / lengths[i]
        x, z = x0 + f * (x1 - x0), z0 + f * (z1 - z0)
        ux, uz = (x1 - x0) / lengths[i], (z1 - z0) / lengths[i]
        w, h = 0.12 * total / shoes, 0.25 * thickness
        corners = [(x - w * ux, z - w * uz), (x + w * ux, z + w * uz), (x + w * ux - h * -uz, z + w * uz - h * ux),
                   (x - w * ux - h * -uz, z - w * uz - h * ux)]
        m.prism("worn", corners, -half, half, "y", 0)
    for x in run:
        m.cylinder("grey", (x, 0, thickness + roller_radius), "y", roller_radius, -0.42 * width, 0.42 * width, 16)
    m.cylinder("grey", (half_span, 0, wheel_z), "y", 0.96 * radius, -0.2 * width, 0.2 * width, 24)
    m.prism("dark", [(first, thickness + roller_radius), (last, thickness + roller_radius),
                     (half_span, wheel_z - 0.3 * radius), (half_span, wheel_z + 0.3 * radius),
                     (-half_span, wheel_z + 0.3 * radius), (-half_span, wheel_z - 0.3 * radius)],
            -0.36 * width, 0.36 * width, "y", 0)
    return m
