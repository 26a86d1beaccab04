#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a scene that digs a plan map: the arrays `images`, `occupancy` and `dumpability` that
excavation planners of the Terra kind read and `navvy map --format terra` writes.

Each patch of cells to be dug becomes a dig_area; with steep sides each rectangle of it, as these
are dug from beside them. The spoil goes to a windrow beside it, on cells that may be dumped on. Of
those that `navvy check` accepts it is one whose stations stand clear of what has been dug, and of
these the one for which the machine stands least often. Occupied cells become walls.

    python3 dig_plan_map.py FOLDER --number 1 --cell 1 --depth 1 --out plan.sdf
    navvy run plan.sdf
"""
import argparse, itertools, os, pathlib, re, subprocess, sys
import numpy

# Distances of a windrow from the edge of its patch, the larger ones behind a machine that digs it
# from beside, and of its ends from the ends of it [m].
ASIDE = (3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 8.0, 8.5, 9.0, 9.5, 10.0, 10.5)
BEHIND = 8.0
# Sides that are steeper are dug square to them [deg].
STEEP = 75
# Free ground around the machine at the start, and between a station and what has been dug [m].
AROUND, APART = 4.0, 2.5


def read(folder, name, number, shape=None):
    path = pathlib.Path(folder, name, f"img_{number}.npy")
    try:
        grid = numpy.load(path)
    except (OSError, ValueError) as error:
        sys.exit(f"{path}: cannot be read as a NumPy array: {error}")
    if grid.ndim != 2 or (shape and grid.shape != shape):
        sys.exit(f"{path}: shape {grid.shape}, must be {shape or 'two numbers'}")
    return grid.astype(int)


def patches(mask):
    """Yields the connected patches of a mask (neighbours share an edge), each as a mask."""
    left = mask.copy()
    while left.any():
        todo, patch = [tuple(numpy.argwhere(left)[0])], numpy.zeros_like(mask)
        left[todo[0]] = False
        while todo:
            y, x = todo.pop()
            patch[y, x] = True
            for at in ((y + 1, x), (y - 1, x), (y, x + 1), (y, x - 1)):
                inside = 0 <= at[0] < mask.shape[0] and 0 <= at[1] < mask.shape[1]
                if inside and left[at]:
                    left[at] = False
                    todo.append(at)
        yield patch


def rectangles(patch):
    """Yields rectangles that cover a patch, the largest first, each as a mask."""

    def within(left):
        for y0, x0 in numpy.argwhere(left):
            width = left.shape[1]
            for y1 in range(y0, left.shape[0]):
                free = left[y1, x0:]
                width = min(width, len(free) if free.all() else int(numpy.argmin(free)))
                if not width:
                    break
                yield width * (y1 + 1 - y0), y0, y1 + 1, x0, x0 + width

    left = patch.copy()
    while left.any():
        _, y0, y1, x0, x1 = max(within(left))
        one = numpy.zeros_like(patch)
        one[y0:y1, x0:x1] = True
        left &= ~one
        yield one


def overlapping(part, done):
    """Returns a rectangle with the row or column of cells beyond each side along which all cells
    have been dug: what falls over that side is dug, too."""
    (y0, x0), (y1, x1) = numpy.argwhere(part).min(0), numpy.argwhere(part).max(0) + 1
    out, grid = part.copy(), numpy.pad(done, 1)
    for rows, columns in (
        (slice(y0 - 1, y0), slice(x0, x1)),
        (slice(y1, y1 + 1), slice(x0, x1)),
        (slice(y0, y1), slice(x0 - 1, x0)),
        (slice(y0, y1), slice(x1, x1 + 1)),
    ):
        if grid[rows.start + 1 : rows.stop + 1, columns.start + 1 : columns.stop + 1].all():
            out[rows, columns] = True
    return out


def outline(patch):
    """Returns the corners (x, y) of a patch in cells, counter-clockwise; refuses one with holes."""
    grid = numpy.pad(patch, 1)
    edges = {}
    for y, x in numpy.argwhere(grid):
        # Each side to an empty cell, with the patch on its left.
        for dy, dx, a, b in (
            (-1, 0, (x, y), (x + 1, y)),
            (0, 1, (x + 1, y), (x + 1, y + 1)),
            (1, 0, (x + 1, y + 1), (x, y + 1)),
            (0, -1, (x, y + 1), (x, y)),
        ):
            if not grid[y + dy, x + dx]:
                edges.setdefault(a, []).append(b)
    if any(len(ends) > 1 for ends in edges.values()):
        sys.exit("cells to be dug meet at a corner only: join or part them")
    start = at = next(iter(edges))
    corners = []
    while True:
        corners.append(at)
        at = edges.pop(at)[0]
        if at == start:
            break
    if edges:
        sys.exit("a patch of cells to be dug has a hole: divide it")
    turns = [
        b
        for a, b, c in zip(corners[-1:] + corners[:-1], corners, corners[1:] + corners[:1])
        if (b[0] - a[0]) * (c[1] - b[1]) != (b[1] - a[1]) * (c[0] - b[0])
    ]
    return [(x - 1, y - 1) for x, y in turns]


def windrows(corners, may_dump, cell):
    """Yields lines (ends in metres) beside a patch over cells that may be dumped on."""
    xs, ys = [x * cell for x, _ in corners], [y * cell for _, y in corners]
    low, high = (min(xs), min(ys)), (max(xs), max(ys))
    for aside, behind, side in itertools.product(ASIDE, (BEHIND, 4, 0), range(8)):
        axis, sign, end = side % 2, 1 if side < 4 else -1, side // 2 % 2
        level = high[1 - axis] + aside if sign > 0 else low[1 - axis] - aside
        # It reaches on behind the end to which the machine backs.
        span = [low[axis], high[axis]]
        span[end] += behind if end else -behind
        line = [(s, level) if axis == 0 else (level, s) for s in span]
        steps = numpy.linspace(line[0], line[1], 2 + int(abs(span[1] - span[0]) / cell * 2))
        cells = numpy.floor(steps / cell).astype(int)
        inside = (cells >= 0).all() and (cells < may_dump.shape[::-1]).all()
        if inside and may_dump[cells[:, 1], cells[:, 0]].all():
            yield line


def free_place(blocked, cell):
    """Returns the place (x, y) [m] of the free cell that is nearest to the map's border."""
    reach = int(numpy.ceil(AROUND / cell))
    best = None
    for y in range(reach, blocked.shape[0] - reach):
        for x in range(reach, blocked.shape[1] - reach):
            if blocked[y - reach : y + reach + 1, x - reach : x + reach + 1].any():
                continue
            edge = min(x, y, blocked.shape[1] - 1 - x, blocked.shape[0] - 1 - y)
            if best is None or edge < best[0]:
                best = (edge, x, y)
    if best is None:
        sys.exit(f"the map has no free place of {2 * AROUND:g} m for the machine: enlarge it")
    return (best[1] + 0.5) * cell, (best[2] + 0.5) * cell


def walls(occupied, cell):
    """Returns boxes on the occupied cells, one for each run of cells along x."""
    text = []
    for y, row in enumerate(occupied):
        for filled, run in itertools.groupby(enumerate(row), lambda item: bool(item[1])):
            xs = [x for x, _ in run]
            if not filled:
                continue
            size, middle = len(xs) * cell, (xs[0] + len(xs) / 2) * cell
            shape = f"<geometry><box><size>{size:g} {cell:g} 2</size></box></geometry>"
            text.append(
                f'  <model name="wall_{len(text)}"><static>true</static>'
                f"<pose>{middle:g} {(y + 0.5) * cell:g} 0.9 0 0 0</pose><link name=\"wall\">"
                f'<collision name="c">{shape}</collision><visual name="v">{shape}</visual>'
                "</link></model>\n"
            )
    return "".join(text)


def scene(shape, steps, start, boxes, options):
    size = f"{shape[1] * options.cell:g} {shape[0] * options.cell:g}"
    jobs = "".join(
        "      <dig_area><polygon_m>"
        + " ".join(f"{x * options.cell:g} {y * options.cell:g}" for x, y in corners)
        + f"</polygon_m><depth_m>{options.depth:g}</depth_m>"
        f"<batter_deg>{options.batter:g}</batter_deg>"
        f"<dump_at_m>{a[0]:g} {a[1]:g}</dump_at_m><dump_to_m>{b[0]:g} {b[1]:g}</dump_to_m>"
        "</dig_area>\n"
        for corners, (a, b) in steps
    )
    return f"""<?xml version="1.0"?>
<!-- Digs plan map {options.number} of {pathlib.Path(options.folder).name}. -->
<sdf version="1.9" xmlns:navvy="navvy"><world name="plan_map">
  <navvy:soil ref="{options.soil}"/>
  <navvy:ground>
    <size_m>{size}</size_m><origin_m>0 0</origin_m><depth_m>{options.depth + 2:g}</depth_m>
  </navvy:ground>
  <include>
    <uri>model://{options.machine}</uri><name>excavator</name>
    <pose>{start[0]:g} {start[1]:g} 0 0 0 0</pose>
    <navvy:program>
{jobs}    </navvy:program>
  </include>
{boxes}  <navvy:goals><completion>0.95</completion><coverage>0.98</coverage></navvy:goals>
  <navvy:camera name="overview">
    <position_m>1 -1 1</position_m><target_m>0 0 0</target_m>
    <frame>all</frame><rate_hz>0.02</rate_hz>
  </navvy:camera>
  <navvy:recording><duration_s>14400</duration_s><settle_s>5</settle_s></navvy:recording>
</world></sdf>
"""


def near(place, mask, cell):
    """Returns true if a cell of a mask is closer than APART to the place [m]."""
    cells = numpy.argwhere(mask)[:, ::-1] * cell
    gaps = numpy.maximum(numpy.maximum(cells - place, place - cells - cell), 0)
    return bool((numpy.hypot(*gaps.T) < APART).any())


def stations(text, options):
    """Writes the scene and asks `navvy check`. Returns the places where the machine stands, step by
    step, and what is said if that is an error."""
    pathlib.Path(options.out).write_text(text)
    done = subprocess.run(
        [options.navvy, "check", options.out], capture_output=True, text=True, check=False
    )
    said = done.stdout + done.stderr
    found = re.findall(r"step (\d+) .*: station \d+ at \(([-0-9.]+), ([-0-9.]+)\)", said)
    places = {}
    for step, x, y in found:
        places.setdefault(int(step), []).append((float(x), float(y)))
    return places, "" if done.returncode == 0 else said


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", help="folder with images/, occupancy/ and dumpability/")
    parser.add_argument("--number", type=int, default=1, help="number of the map (1)")
    parser.add_argument("--cell", type=float, default=1, help="edge of a cell [m] (1)")
    parser.add_argument("--depth", type=float, default=1, help="depth of the digs [m] (1)")
    parser.add_argument("--batter", type=float, default=90, help="angle of their sides [deg] (90)")
    parser.add_argument("--soil", default="loam", help="soil of the site (loam)")
    parser.add_argument("--machine", default="ex180_tracked", help="model (ex180_tracked)")
    parser.add_argument("--out", default="plan_map.sdf", help="scene file to write")
    parser.add_argument("--navvy", default=os.environ.get("NAVVY", "navvy"), help="the program")
    options = parser.parse_args()
    image = read(options.folder, "images", options.number)
    occupied = read(options.folder, "occupancy", options.number, image.shape) == 1
    may_dump = (read(options.folder, "dumpability", options.number, image.shape) == 1) & ~occupied
    dig = image == -1
    if not dig.any():
        sys.exit("no cell of the map is to be dug (-1 in images)")
    # Where the map names places for the spoil, it goes nowhere else.
    may_dump &= (image == 1) if (image == 1).any() else ~dig
    boxes, steps = walls(occupied, options.cell), []
    start = free_place(occupied | dig | (image == 1), options.cell)
    steep = options.batter > STEEP
    for patch in patches(dig):
        outline(patch)  # refuses one with a hole
    dug = numpy.zeros_like(dig)
    for patch in itertools.chain(*(rectangles(p) if steep else [p] for p in patches(dig))):
        corners = outline(overlapping(patch, dug))
        fault, found = "nothing beside it may be dumped on", []
        for line in windrows(corners, may_dump, options.cell):
            text = scene(image.shape, steps + [(corners, line)], start, boxes, options)
            places, fault = stations(text, options)
            if fault:
                continue
            here = places.get(len(steps) + 1, [])
            found.append((sum(near(p, dug, options.cell) for p in here), len(here), line))
            if not steep:
                break
        if not found:
            sys.exit(f"no windrow suits the dig with corners {corners}: {fault}")
        # Of those whose stations stand clear of what has been dug, with the fewest stations, the
        # nearest.
        steps.append((corners, min(found, key=lambda one: one[:2])[2]))
        dug |= patch
    stations(scene(image.shape, steps, start, boxes, options), options)
    print(f"{options.out}: {len(steps)} digs; run it with: {options.navvy} run {options.out}")


if __name__ == "__main__":
    main()
