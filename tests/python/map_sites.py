# SPDX-License-Identifier: Apache-2.0
"""Scenes on maps that every build reads, for the tests of the package and of its wheel."""
import pathlib
import struct
import zlib

import numpy as np

CELL = 0.5
# Rise per metre along x and along y: no two corners of the site are alike.
SLOPES = (0.25, 0.5)
LOW, HIGH = 2.0, 12.0

SCENE = """<sdf version="1.9" xmlns:navvy="navvy"><world name="site">
<navvy:soil ref="loam"/>
<navvy:ground>
<file>%s</file>%s
<size_m>4 2</size_m><depth_m>1</depth_m>
</navvy:ground>
</world></sdf>
"""


def heights():
    """Returns the heights of the map, 20 x 12 cells, its southern row first."""
    y, x = np.mgrid[0:12, 0:20] * CELL
    return 3 + SLOPES[0] * x + SLOPES[1] * y


def png(gray):
    """Returns a PNG of 16-bit gray values, its northern row first."""

    def chunk(name, data):
        check = struct.pack(">I", zlib.crc32(name + data))
        return struct.pack(">I", len(data)) + name + data + check

    rows, columns = gray.shape
    header = struct.pack(">IIBBBBB", columns, rows, 16, 0, 0, 0, 0)
    lines = b"".join(b"\0" + line.astype(">u2").tobytes() for line in gray)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(lines))
        + chunk(b"IEND", b"")
    )


def write_sites(folder):
    """Writes one map in three formats and a scene on each; returns the paths of the scenes."""
    folder = pathlib.Path(folder)
    z = heights()
    np.save(folder / "map.npy", z.astype("<f4"))
    gray = np.rint((z[::-1] - LOW) / (HIGH - LOW) * 65535)
    (folder / "map.png").write_bytes(png(gray))
    text = "ncols 20\nnrows 12\nxllcorner 1000\nyllcorner 2000\ncellsize %g\n" % CELL
    text += "\n".join(" ".join("%.6f" % value for value in row) for row in z[::-1]) + "\n"
    (folder / "map.asc").write_text(text)
    cell = "<map_cell_m>%g</map_cell_m>" % CELL
    span = "<map_heights_m>%g %g</map_heights_m>" % (LOW, HIGH)
    more = {"asc": "", "npy": cell, "png": cell + span}
    for ending, elements in more.items():
        (folder / (ending + ".sdf")).write_text(SCENE % ("map." + ending, elements))
    return [folder / (ending + ".sdf") for ending in more]


def check_sites(navvy, folder):
    """Loads the scenes of `write_sites` and raises AssertionError if a ground is not the plane."""
    for path in write_sites(folder):
        columns = np.asarray(navvy.World(navvy.Scene(path)).columns, dtype=float)
        cell = 4 / columns.shape[1]
        y, x = np.mgrid[0 : columns.shape[0], 0 : columns.shape[1]] * cell
        wanted = SLOPES[0] * x + SLOPES[1] * y
        # A gray value is 0.15 mm.
        np.testing.assert_allclose(columns - columns[0, 0], wanted, atol=5e-4, err_msg=str(path))
