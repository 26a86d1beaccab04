#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the cost of reading large files: limits.py NAVVY ROWS.csv [FOLDER [PART]].

Makes one file of 64 MB of each kind that Navvy reads, and maps of the largest allowed size, lets
`navvy check` read each, and writes one row per file: wall time and processor time [s], peak memory
and the message. The limits are 5 s of processor time and 1 GB. Needs 1 GB of space in FOLDER (a
temporary one by default), and gdal-bin for the maps. With PART, only files whose name contains it
are made; their rows replace the old ones. Standard library only.
"""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import time

# total size of the largest allowed input
SIZE = (64 << 20) - (64 << 10)
# largest scene or machine file
XML = (16 << 20) - (64 << 10)
HEAD = '<sdf version="1.9" xmlns:navvy="navvy">'
WORLD = (
    HEAD
    + '<world name="w"><navvy:soil ref="loam"/><navvy:ground><size_m>40'
    ' 40</size_m></navvy:ground>%s</world></sdf>'
)
GRID = "ncols %d\nnrows %d\nxllcorner 0\nyllcorner 0\ncellsize 0.1\n"
DRAWN = (
    '<model name="m"><static>1</static><link name="a"><visual'
    ' name="v"><geometry><mesh><uri>%s</uri></mesh></geometry></visual></link></model>'
)
# Stands for a bed of stones: visual and collision shapes take different code paths.
HIT = (
    '<model name="m"><static>1</static><link name="a"><collision'
    ' name="v"><geometry><mesh><uri>%s</uri></mesh></geometry></collision></link></model>'
)


def filled(path, head, piece, size, tail=""):
    """Makes a file of `size` bytes: head, then `piece` (a text, or a function of its number)
    repeated, then tail."""
    with open(path, "w", encoding="ascii", buffering=1 << 20) as file:
        file.write(head)
        written, number = len(head) + len(tail), 0
        while written < size:
            text = piece(number) if callable(piece) else piece
            file.write(text)
            written += len(text)
            number += 1
        file.write(tail)
    return path


def obj(path, size=SIZE):
    """Vertices and faces of a bumpy sheet, as many as fit."""
    side, lines, written = 1000, [], 0
    row = 0
    with open(path, "w", encoding="ascii", buffering=1 << 20) as file:
        while written < size:
            lines = [
                "v %d.%03d %d.5 %d.25\n" % (i, (i * 7 + row) % 1000, row, (i * row) % 7)
                for i in range(side)
            ]
            if row > 0:
                base = (row - 1) * side + 1
                lines += [
                    "f %d %d %d\n" % (base + i, base + i + 1, base + side + i)
                    for i in range(side - 1)
                ]
            text = "".join(lines)
            file.write(text)
            written += len(text)
            row += 1
    return path


def gdal(path, columns, rows, *options):
    """A map of zeros: compressed it is small, plain as large as its cells."""
    arguments = [
        "gdal_create",
        "-q",
        "-of",
        "GTiff",
        "-ot",
        "Float32",
        "-burn",
        "1",
        "-outsize",
        str(columns),
        str(rows),
        "-a_ullr",
        "0",
        str(0.1 * rows),
        str(0.1 * columns),
        "0",
    ]
    for option in options:
        arguments += ["-co", option]
    subprocess.run(arguments + [path], check=True)
    return path


def cases(folder):
    """Yields (name, function that makes the files and returns the arguments of `navvy check`).

    The files are made one by one, because together they would fill a disk."""

    def at(name):
        return os.path.join(folder, name)

    def scene(body):
        path = at("scene.sdf")
        with open(path, "w", encoding="utf-8") as file:
            file.write(WORLD % body)
        return [path]

    def with_mesh(make, kind=DRAWN):
        return lambda: scene(kind % make(at("mesh.obj")))

    def on_map(path, *site):
        return scene("") + ["--terrain", path, *site]

    head, tail = (WORLD % "|").split("|")
    yield "scene: 64 MB", lambda: [filled(at("s.sdf"), head, "<light name='l'/>\n", SIZE, tail)]
    yield "scene: elements", lambda: [filled(at("s.sdf"), head, "<light name='l'/>\n", XML, tail)]
    yield "scene: a comment", lambda: [
        filled(at("s.sdf"), head + "<!--", "x" * 4096, XML, "-->" + tail)
    ]
    yield "scene: spaces", lambda: [filled(at("s.sdf"), head, " " * 4096, XML, tail)]
    yield "scene: nesting", lambda: [filled(at("s.sdf"), head, "<a>", XML)]
    yield "scene: an attribute", lambda: [
        filled(at("s.sdf"), head + "<a b='", "x" * 4096, XML, "'/>" + tail)
    ]
    yield "scene: attributes", lambda: [
        filled(at("s.sdf"), head + "<a", lambda i: " a%d=''" % i, XML, "/>" + tail)
    ]
    yield "scene: steps", lambda: [
        filled(
            at("s.sdf"),
            head + "<include><uri>model://ew180</uri><navvy:program>",
            "<wait><duration_s>1</duration_s></wait>\n",
            XML,
            "</navvy:program></include>" + tail,
        )
    ]
    yield "scene: 499 models and 96 000 unknown elements", lambda: [
        filled(
            at("s.sdf"),
            head,
            lambda i: (
                "<model name='m%d'><static>1</static><link name='a'/></model>\n" % i
                if i < 499
                else "<thing/>\n"
            ),
            900_000,
            tail,
        )
    ]
    yield "machine: links", lambda: [
        filled(
            at("m.sdf"),
            HEAD + "<model name='m'>",
            lambda i: "<link name='l%d'/>\n" % i,
            XML,
            "</model></sdf>",
        )
    ]
    yield "machine: joints", lambda: [
        filled(
            at("m.sdf"),
            HEAD + "<model name='m'><link name='a'/>",
            lambda i: "<joint name='j%d' type='fixed'><parent>a</parent><child>a</child></joint>\n"
            % i,
            XML,
            "</model></sdf>",
        )
    ]
    yield "OBJ: a sheet, drawn", with_mesh(obj)
    yield "OBJ: a sheet, drawn, at its limits", with_mesh(lambda path: obj(path, 30 << 20))
    yield "OBJ: a sheet, colliding", with_mesh(obj, HIT)
    yield "OBJ: one line", with_mesh(lambda path: filled(path, "v ", "1" * 4096, SIZE))
    yield "OBJ: groups", with_mesh(lambda path: filled(path, "", "g a\n", SIZE))
    yield "OBJ: corners", with_mesh(
        lambda path: filled(path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf", " 1 2 3", SIZE)
    )

    def material(path):
        filled(at("m.mtl"), "newmtl a\n", "Kd 1 1 1\n", SIZE)
        with open(path, "w", encoding="ascii") as file:
            file.write("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n")
        return path

    yield "MTL beside an OBJ", with_mesh(material)
    # A header of sixty bytes, then numbers of five bytes.
    yield "ESRI ASCII", lambda: on_map(
        filled(at("g.asc"), GRID % (3500, 3800), "5.25 " * 3499 + "5.25\n", SIZE)
    )
    yield "ESRI ASCII: one word", lambda: on_map(
        filled(at("g.asc"), GRID % (3500, 3800), "5" * 4096, SIZE)
    )
    yield "ESRI ASCII: a header", lambda: on_map(
        filled(at("g.asc"), "ncols 5\n", "nrows 5\n", SIZE)
    )
    yield "GeoTIFF", lambda: on_map(gdal(at("g.tif"), 4096, 4096))
    yield "GeoTIFF: a thousandth in bytes", lambda: on_map(
        gdal(at("g.tif"), 20000, 20000, "COMPRESS=DEFLATE", "BLOCKYSIZE=3000")
    )
    yield "GeoTIFF: junk", lambda: on_map(filled(at("g.tif"), "II*\0", "junk" * 1024, SIZE))

    def beside(name):
        def make():
            gdal(at("g.tif"), 100, 100)
            filled(at(name), "", "<a>" * 1000, SIZE)
            return on_map(at("g.tif"))

        return make

    for name in ("g.prj", "g.tif.aux.xml", "g.tfw"):
        yield "beside a map: " + name[1:], beside(name)
    # Maps at their full size: the largest map allowed under a site, and the last row of the largest
    # text file.
    yield "largest text: ESRI ASCII of 1000 MB, site in its last row", lambda: on_map(
        filled(at("g.asc"), GRID % (14000, 14900), "5.25 " * 13999 + "5.25\n", 995 << 20),
        "--at",
        "local:700,30",
        "--size",
        "40,40",
    )
    yield "full size: ESRI ASCII, 25 million cells under the site", lambda: on_map(
        filled(at("g.asc"), GRID % (4990, 4990), "5.25 " * 4989 + "5.25\n", 4990 * 4990 * 5),
        "--size",
        "490,490",
        "--set",
        "solver.cell_m=0.4",
    )
    yield "full size: GeoTIFF, 25 million cells under the site", lambda: on_map(
        gdal(at("g.tif"), 4990, 4990), "--size", "490,490", "--set", "solver.cell_m=0.4"
    )
    yield "full size: GeoTIFF of 40000 x 40000 cells, compressed", lambda: on_map(
        gdal(at("g.tif"), 40000, 40000, "COMPRESS=DEFLATE", "SPARSE_OK=TRUE")
    )


def measure(navvy, arguments):
    """Returns wall and processor time [s], peak memory [MB], exit status and last lines of `navvy
    check`."""
    with tempfile.TemporaryFile("w+") as said:
        begun = time.monotonic()
        child = subprocess.Popen(
            [navvy, "check", *arguments], stdout=said, stderr=subprocess.STDOUT
        )
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        wall = time.monotonic() - begun
        said.seek(0)
        lines = [line for line in said.read().splitlines() if "error: " in line] or [""]
    return wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, child.returncode, lines[0]


def kept(rows, part):
    """Rows of an earlier run that this one does not measure."""
    if not part or not os.path.exists(rows):
        return []
    with open(rows, newline="", encoding="utf-8") as file:
        return [row for row in list(csv.reader(file))[1:] if part not in row[0]]


def main():
    if not 3 <= len(sys.argv) <= 5:
        sys.exit(__doc__)
    navvy, rows = os.path.abspath(sys.argv[1]), sys.argv[2]
    part = sys.argv[4] if len(sys.argv) > 4 else ""
    beyond, old = [], kept(rows, part)
    with open(rows, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["file", "mib", "wall_s", "processor_s", "peak_mib", "status", "said"])
        out.writerows(old)
        folder = tempfile.mkdtemp(dir=sys.argv[3] if len(sys.argv) > 3 and sys.argv[3] else None)
        try:
            for name, make in cases(folder):
                if part not in name:
                    continue
                arguments = make()
                largest = max(
                    os.path.getsize(os.path.join(folder, one)) for one in os.listdir(folder)
                )
                wall, processor, peak, status, said = measure(navvy, arguments)
                words = said.replace(folder + "/", "").split("error: ")[-1][:110]
                out.writerow(
                    [
                        name,
                        round(largest / 2**20),
                        "%.1f" % wall,
                        "%.1f" % processor,
                        "%.0f" % peak,
                        status,
                        words,
                    ]
                )
                file.flush()
                print(
                    "%-58s %5.1f s of processor, %4.0f MiB, status %d  %s"
                    % (name, processor, peak, status, words)
                )
                if processor > 5 or peak > 1024 or status not in (0, 2):
                    beyond.append(name)
                for one in os.listdir(folder):
                    os.remove(os.path.join(folder, one))
        finally:
            shutil.rmtree(folder)
    if beyond:
        print(
            "beyond 5 s of processor or 1 GiB, or neither checked nor refused: " + "; ".join(beyond)
        )


main()
